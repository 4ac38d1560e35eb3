//! The excitation of a pair for other solvers as text, CSV and JSON.

use super::json::{Json, json, object};
use super::layout::item;
use super::results::{Named, Results};
use super::table::{Cell, Column, Table};
use crate::study::excitation::{Excitation, STIFFNESS, Sample, VALUES};

/// The values of a sample: name, unit, title in text, and unit and digits in text.
#[rustfmt::skip]
const COLUMNS: [(&str, &str, &str, &str, usize); VALUES] = [
    ("mesh_stiffness", "N/m", "k", "N/um", 5),
    ("transmission_error", "m", "x", "um", 5),
    ("displacement_excitation", "m", "e", "um", 5),
    ("mesh_force", "N", "ΣF", "N", 5),
    ("tooth_stiffness", "N/m", "k_0", "N/um", 5),
    ("tooth_force", "N", "F_0", "N", 5),
];

/// The excitation of a case.
#[derive(Debug, Clone, Copy)]
pub struct ExcitationReport<'a>(pub &'a Excitation);

impl ExcitationReport<'_> {
    /// The values of the equation of motion: name, unit and value.
    fn constants(self) -> [(&'static str, &'static str, f64); 14] {
        let Excitation { base_radii, inertias, mass, damping, stiffness, force, speed, .. } =
            *self.0;
        let period = self.0.mesh_period();
        [
            ("mesh_period", "s", period),
            ("mesh_frequency", "Hz", period.recip()),
            ("base_pitch", "m", self.0.base_pitch),
            ("speed_driver", "rad/s", speed),
            ("base_radius_driver", "m", base_radii[0]),
            ("base_radius_driven", "m", base_radii[1]),
            ("inertia_driver", "kg m2", inertias[0]),
            ("inertia_driven", "kg m2", inertias[1]),
            ("reduced_mass", "kg", mass),
            ("damping", "N s/m", damping),
            ("mean_stiffness", "N/m", stiffness),
            ("mean_torsional_stiffness", "N m/rad", stiffness * base_radii[0] * base_radii[0]),
            ("mesh_force", "N", force),
            ("torque_driver", "N m", force * base_radii[0]),
        ]
    }

    /// Time and driver angle since E, and the values at each place of a part.
    fn samples(self, part: &'static str, samples: &[Sample]) -> Table {
        let speed = self.0.speed;
        let base = self.0.base_radii[0];
        let mean = self.0.harmonics[0].map(|[mean, _]| mean);
        let row = |Sample { way, values, springs }: &Sample| {
            let place = [way / (speed * base), way / base, *way];
            let exciting = self.0.stiffness * (values[1] - mean[1]);
            let torsional = values[STIFFNESS] * base * base;
            let numbers = place.into_iter().chain(*values).chain([exciting, torsional]);
            let numbers = numbers.chain([self.0.damping]);
            let numbers = numbers.chain(springs.as_flattened().iter().copied());
            std::iter::once(part.into()).chain(numbers.map(Cell::Number)).collect()
        };
        let place = [("time", "s"), ("angle_driver", "rad"), ("way", "m")];
        let values = COLUMNS.map(|(key, unit, ..)| (key, unit));
        let more =
            [("exciting_force", "N"), ("torsional_stiffness", "N m/rad"), ("damping", "N s/m")];
        let numbers = place.into_iter().chain(values).chain(more);
        let numbers = numbers.map(|(key, unit)| Column::si(key, unit));
        let springs = self.0.pairs.iter().flat_map(|&pair| {
            let of = match pair {
                0 => "incoming".to_owned(),
                behind if behind < 0 => format!("behind_{}", -behind),
                ahead => format!("ahead_{ahead}"),
            };
            [("gap", "m"), ("stiffness", "N/m"), ("tooth_stiffness", "N/m")]
                .map(|(key, unit)| Column::si(format!("{key}_{of}"), unit))
        });
        let columns =
            std::iter::once(Column::text("part", "")).chain(numbers).chain(springs).collect();
        Table::new("", columns).with(samples.iter().map(row))
    }

    /// Mean, and coefficients of cosine and sine of each order.
    fn harmonics(self) -> Table {
        let mut columns = vec![Column::number("order", "n", "", ("1", 0)).wide(0, 3)];
        for (key, unit, title, shown, digits) in COLUMNS {
            for (of, sign) in [("cosine", "cos"), ("sine", "sin")] {
                let title = format!("{title} {sign}");
                columns.push(
                    Column::number(format!("{key}_{of}"), title, unit, (shown, digits)).wide(1, 10),
                );
            }
        }
        let row = |(order, values): (usize, &[[f64; 2]; VALUES])| {
            let order = Cell::Shown(order as f64, order.to_string());
            let values = values.as_flattened().iter().map(|&value| Cell::Number(value));
            std::iter::once(order).chain(values).collect()
        };
        Table::new("", columns).with(self.0.harmonics.iter().enumerate().map(row))
    }
}

impl Results for ExcitationReport<'_> {
    fn lines(&self, case: Named) -> Vec<String> {
        /// Orders in text.
        const SHOWN: usize = 10;
        /// Columns of k, x and e.
        const OF_TEXT: [usize; 7] = [0, 1, 2, 3, 4, 5, 6];
        let mut lines = case.headings("excitation for other solvers, by static");
        let notes = [
            "m x'' + c x' + sum of k_j max(0, x - g_j) = F_0, or linear about the balance at rest \
             m x'' + c x' + k(t) (x - e(t)) = F_0; x = rb1 phi1 - rb2 phi2 is positive where the \
             driver is ahead, the force of the mesh pushes the driven gear forwards and \
             brakes the driver.",
            "Both angles count in the direction of rotation of their gear; t = 0 where a tooth \
             pair is at E.",
        ];
        lines.push(String::new());
        lines.extend(notes.iter().flat_map(|note| item("", note)));
        lines.push(String::new());
        let constant = |(key, unit, value): (&str, &str, f64)| {
            format!("{key:26}{:>12} {unit}", super::number(value, "1", 6))
        };
        lines.extend(self.constants().map(constant));
        lines.push(String::new());
        lines.push("Fourier series of k in N/um, of x and e in um, n = 0 is the mean".to_owned());
        let mut table = self.harmonics();
        table.rows.truncate(1 + SHOWN);
        lines.extend(table.of(&OF_TEXT).lines());
        lines
    }

    fn json(&self) -> Json {
        let constants = self.constants().map(|(key, unit, value)| {
            let measured: Json = json!({"value": value, "unit": unit});
            (key, measured)
        });
        let rows = |part: &'static str, samples: &[Sample]| {
            let table = self.samples(part, samples);
            let columns: Vec<usize> = (1..table.columns.len()).collect();
            table.of(&columns).objects()
        };
        json!({
            "method": "static",
            "constants": object(constants),
            "period": rows("period", &self.0.period),
            "passage": rows("passage", &self.0.passage),
            "harmonics": self.harmonics().objects(),
        })
    }

    /// One row per place: the base pitch of equal pairs, then the passage of the incoming tooth.
    fn table(&self) -> Table {
        let mut table = self.samples("period", &self.0.period);
        table.rows.extend(self.samples("passage", &self.0.passage).rows);
        table
    }
}
