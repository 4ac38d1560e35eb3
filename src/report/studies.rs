//! Sweeps, crossings, excitation and stiffness as text, CSV, JSON and charts.

use super::charts::{MICRON_MILLIMETRE, MILLIMETRE};
use super::table::{
    Cell, Column, Json, Named, Results, Table, item, json, measured, object, reason, sorted,
    write_line,
};
use super::tolerance::ToleranceReport;
use super::{number, shown};
use crate::case::fields::FIELDS;
use crate::case::sanitize::sanitize;
use crate::model::explanation::tidy;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::{Quantity, Stage};
use crate::numeric::decimal::{shortest, significant};
use crate::study::axis::{AxisRange, Grid};
use crate::study::batch::{PointOutcome, Points, Refusals, Row, with_unit};
use crate::study::excitation::{self, Excitation, STIFFNESS, VALUES};
use crate::study::seek::{Condition, Found, Sample, State};
use crate::study::shard::{Format, Kind, Study};
use crate::study::stiffness::{
    FIELD, FieldPoint, Flanks, GearComparison, PathComparison, PathPoint, Point,
};
use crate::study::tolerance::Samples;
use std::io::{self, Write};

/// A search and its result.
pub struct SeekReport {
    /// The name of the method.
    pub method: &'static str,
    /// The searched range.
    pub range: AxisRange,
    /// The condition.
    pub condition: Condition,
    /// The result.
    pub found: Found,
}

impl SeekReport {
    /// The result in one word.
    fn answer(&self) -> &'static str {
        match self.found.segments()[..] {
            [[Sample { state: State::Met, .. }, _]] => "always",
            [[Sample { state: State::NotMet, .. }, _]] => "never",
            [[Sample { state: State::Unknown(_), .. }, _]] => "unknown",
            _ => "crossings",
        }
    }

    fn value(&self, number: f64) -> String {
        with_unit(&shortest(number), &self.range.unit)
    }

    /// The values of the quantity of the condition on both sides of a crossing.
    fn values(&self, lower: &Sample, upper: &Sample) -> String {
        let Some(quantity) = self.condition.quantity() else { return String::new() };
        let [from, to] = [lower, upper].map(|sample| match sample.value {
            Some(value) => shown(quantity, value).to_string(),
            None => "no value".to_owned(),
        });
        let to = if from == to { String::new() } else { format!(" to {to}") };
        format!("; {} {from}{to}", quantity.symbol)
    }
}

impl Results for SeekReport {
    fn lines(&self, case: Named) -> Vec<String> {
        let AxisRange { field, from, to, .. } = self.range;
        let (key, from, to) = (FIELDS[field].key, self.value(from), self.value(to));
        let (condition, method) = (sanitize(&self.condition.text), self.method);
        let first = format!("{condition} by method {method}, {key} from {from} to {to}:");
        let mut lines = vec![case.heading(), first];
        match self.answer() {
            "crossings" => {}
            "unknown" => {
                let line = "  unknown: the condition is unknown at every point of the range";
                lines.push(line.to_owned());
            }
            answer => {
                lines.push(format!("  {answer}"));
                return lines;
            }
        }
        // JSON has every digit.
        let rounded = |number: f64| self.value(format!("{number:.5e}").parse().unwrap_or(number));
        // Several crossings at one number are rounding errors of the quantity.
        let mut parts: Vec<[&Sample; 2]> = Vec::new();
        for [first, last] in self.found.segments() {
            let is_known = !matches!(first.state, State::Unknown(_));
            let is_narrow = is_known && rounded(first.at) == rounded(last.at);
            match parts.last_mut() {
                Some(before) if before[0].state.is_like(&first.state) => before[1] = last,
                Some(_) if is_narrow => {}
                _ => parts.push([first, last]),
            }
        }
        for pair in parts.windows(2) {
            let [lower, upper] = [pair[0][1], pair[1][0]];
            let middle = rounded(lower.at + 0.5 * (upper.at - lower.at));
            let (below, above) = (word(&lower.state), word(&upper.state));
            let values = self.values(lower, upper);
            lines.push(format!("  crossing at {middle}: {below} below, {above} above{values}"));
        }
        for [first, last] in parts {
            let reason = match &first.state {
                State::Unknown(problem) => format!(": {problem}"),
                _ => String::new(),
            };
            let [from, to] = [first, last].map(|sample| rounded(sample.at));
            lines.push(format!("  {} from {from} to {to}{reason}", word(&first.state)));
        }
        lines
    }

    fn json(&self) -> Json {
        let AxisRange { field, unit, from, to } = &self.range;
        let quantity = self.condition.quantity();
        let end = |Sample { at, state, value, .. }: &Sample| {
            let value = quantity.and_then(|known| Some(measured(known, (*value)?, None)));
            json!({"at": at, "state": word(state).replace(' ', "-"), "quantity": value})
        };
        let crossings = self.found.crossings().into_iter();
        let crossings =
            crossings.map(|[lower, upper]| json!({"from": end(lower), "to": end(upper)}));
        let segments = self.found.segments().into_iter().map(|[Sample { at, state, .. }, last]| {
            let refusal = match state {
                State::Unknown(problem) => Some(reason(problem)),
                _ => None,
            };
            json!({"from": at, "to": last.at, "state": word(state).replace(' ', "-"), "refusal": refusal})
        });
        json!({
            "method": self.method,
            "vary": FIELDS[*field].key,
            "unit": if unit.is_empty() { "1" } else { unit },
            "from": from,
            "to": to,
            "until": self.condition.text,
            "answer": self.answer(),
            "crossings": crossings.collect::<Json>(),
            "segments": segments.collect::<Json>(),
            "solves": self.found.0.len(),
        })
    }
}

/// A state in the text report.
fn word(state: &State) -> &'static str {
    match state {
        State::Met => "met",
        State::NotMet => "not met",
        State::Unknown(_) => "unknown",
    }
}

/// Receives the rows of a study in order, with the index of the first of them.
pub type Take<'a> = &'a mut dyn FnMut(usize, &[Row]) -> io::Result<()>;

/// Writes the results of a study in its format, rows as they arrive; `rows` passes them. Returns the
/// refused points.
///
/// # Errors
/// Errors of `rows` and of the writer.
pub fn write(
    study: &Study,
    rows: impl FnOnce(Take) -> io::Result<()>,
    out: &mut dyn Write,
) -> io::Result<Refusals> {
    let Study { request, case, inputs, quantities, kind } = study;
    match (kind, request.format) {
        (Kind::Tolerance(study), format) if format != Format::Csv => {
            let mut samples = Samples::of(study);
            rows(&mut |first, rows| {
                samples.add(first, rows);
                Ok(())
            })?;
            let report = ToleranceReport { case, method: inputs.method, study, samples: &samples };
            let case = Named { name: &request.name, title: case.title() };
            case.write(&report, format, out)?;
            Ok(samples.refusals)
        }
        (kind, format) => {
            let table = |first, rows: &[Row]| table_of(study, first, rows);
            if format != Format::Json {
                table(0, &[]).write_csv_header(out)?;
            }
            let mut refusals = Refusals::default();
            rows(&mut |first, rows| {
                refusals.count(first, rows);
                match (kind, format) {
                    (Kind::Sweep(grid), Format::Json) => {
                        (first..).zip(rows).try_for_each(|(index, row)| {
                            write_line(&line(grid, quantities, index, row), out)
                        })
                    }
                    _ => table(first, rows).write_csv_rows(out),
                }
            })?;
            Ok(refusals)
        }
    }
}

/// The rows of a study from an index on.
pub fn table_of(study: &Study, first: usize, rows: &[Row]) -> Table {
    let methods = match &study.kind {
        Kind::Sweep(grid) => grid.methods(&study.inputs),
        Kind::Tolerance(_) => vec![study.inputs.method],
    };
    table((study.points(), &methods), &study.quantities, first, rows)
}

/// The rows of a study by some methods from an index on: the columns of the points, the quantities in SI
/// units, the outcome, the method, and the outcome at the exit if a method computes it.
pub fn table(
    (points, methods): (&dyn Points, &[Method]),
    quantities: &[&Quantity],
    first: usize,
    rows: &[Row],
) -> Table {
    let columns = points.columns().into_iter();
    let columns =
        columns.map(|(key, unit)| Column { unit: unit.to_owned().into(), ..Column::text(key, "") });
    let computed = quantities.iter().map(|known| Column::si(known.key, known.unit));
    let has_exit = |method: &Method| method.stages().has(Stage::Static);
    let count = if methods.iter().any(has_exit) { 3 } else { 2 };
    let names = ["outcome", "method", "exit_outcome"].map(|key| Column::text(key, ""));
    let columns = columns.chain(computed).chain(names.into_iter().take(count)).collect();
    let cells = (first..).zip(rows).map(|(index, row)| {
        let point = points.cells(index).into_iter().map(Cell::Text);
        let computed = row.values.iter().map(|&value| Cell::number(value, ""));
        let exit = row.exit_outcome.map_or("", PointOutcome::name);
        let names = [row.outcome.name(), row.method.name(), exit].map(Cell::from);
        point.chain(computed).chain(names.into_iter().take(count)).collect()
    });
    Table::new("", columns).with(cells)
}

/// A row of a sweep as a JSON object.
fn line(grid: &Grid, quantities: &[&Quantity], index: usize, row: &Row) -> Json {
    let varied = grid.places(index).flat_map(|(axis, at)| {
        let (point, unit) = (&axis.points[at], axis.unit.as_str());
        let unit = if unit.is_empty() { "1" } else { unit };
        let value = match point.number {
            Some(value) => json!({"value": value, "unit": unit}),
            None => json!(point.text),
        };
        axis.fields().map(move |field| (FIELDS[field].key, value.clone()))
    });
    let values = quantities.iter().zip(&row.values);
    let values =
        values.filter_map(|(known, value)| Some((known.key, measured(known, (*value)?, None))));
    json!({
        "varied": object(varied),
        "outcome": row.outcome.name(),
        "method": row.method.name(),
        "exit_outcome": row.exit_outcome.map(PointOutcome::name),
        "quantities": row.refusal.is_none().then(|| object(values)),
        "refusal": row.refusal.as_deref().map(reason),
    })
}

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

impl Excitation {
    /// The values of the equation of motion: name, unit and value.
    fn constants(&self) -> [(&'static str, &'static str, f64); 14] {
        let Excitation { base_radii, inertias, mass, damping, stiffness, force, speed, .. } = *self;
        let period = self.mesh_period();
        [
            ("mesh_period", "s", period),
            ("mesh_frequency", "Hz", period.recip()),
            ("base_pitch", "m", self.base_pitch),
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
    fn samples(&self, part: &'static str, samples: &[excitation::Sample]) -> Table {
        let speed = self.speed;
        let base = self.base_radii[0];
        let mean = self.harmonics[0].map(|[mean, _]| mean);
        let row = |excitation::Sample { way, values, springs }: &excitation::Sample| {
            let place = [way / (speed * base), way / base, *way];
            let exciting = self.stiffness * (values[1] - mean[1]);
            let torsional = values[STIFFNESS] * base * base;
            let numbers = place.into_iter().chain(*values).chain([exciting, torsional]);
            let numbers = numbers.chain([self.damping]);
            let numbers = numbers.chain(springs.as_flattened().iter().copied());
            std::iter::once(part.into()).chain(numbers.map(Cell::Number)).collect()
        };
        let place = [("time", "s"), ("angle_driver", "rad"), ("way", "m")];
        let values = COLUMNS.map(|(key, unit, ..)| (key, unit));
        let more =
            [("exciting_force", "N"), ("torsional_stiffness", "N m/rad"), ("damping", "N s/m")];
        let numbers = place.into_iter().chain(values).chain(more);
        let numbers = numbers.map(|(key, unit)| Column::si(key, unit));
        let springs = self.pairs.iter().flat_map(|&pair| {
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
    fn harmonics(&self) -> Table {
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
        Table::new("", columns).with(self.harmonics.iter().enumerate().map(row))
    }
}

impl Results for Excitation {
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
            "k is the stiffness of a small motion about the balance under load; mean_stiffness is \
             k_m of the pairs on the path of contact without reliefs, which the damping uses.",
        ];
        lines.push(String::new());
        lines.extend(notes.iter().flat_map(|note| item("", note)));
        lines.push(String::new());
        let constant = |(key, unit, value): (&str, &str, f64)| {
            format!("{key:26}{:>12} {unit}", number(value, "1", 6))
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
        let rows = |part: &'static str, samples: &[excitation::Sample]| {
            let table = self.samples(part, samples);
            let columns: Vec<usize> = (1..table.columns.len()).collect();
            table.of(&columns).objects()
        };
        json!({
            "method": "static",
            "constants": object(constants),
            "period": rows("period", &self.period),
            "passage": rows("passage", &self.passage),
            "harmonics": self.harmonics().objects(),
        })
    }

    /// One row per place: the base pitch of equal pairs, then the passage of the incoming tooth.
    fn table(&self) -> Table {
        let mut table = self.samples("period", &self.period);
        table.rows.extend(self.samples("passage", &self.passage).rows);
        table
    }
}

/// A comparison and its case.
#[derive(Debug)]
pub struct StiffnessReport {
    /// The compliances over the flanks.
    pub flanks: Flanks,
    /// The stiffness over the path of contact.
    pub path: PathComparison,
}

impl Results for StiffnessReport {
    fn lines(&self, case: Named) -> Vec<String> {
        let StiffnessReport { flanks, path } = self;
        let mut lines = case.headings("stiffness models against finite elements");
        let gears = flanks.gears.iter().map(|gear| gear_section(flanks, gear));
        let paths = [("one pair", PAIR), ("all pairs in contact", MESH)].map(|(pairs, of)| {
            let title = format!("Stiffness of {pairs} over the path of contact, in N/(um mm):");
            Table { title, ..path_table(path, of) }.lines()
        });
        for section in [legend(flanks)].into_iter().chain(gears).chain(paths) {
            lines.push(String::new());
            lines.extend(section);
        }
        lines
    }

    fn json(&self) -> Json {
        let StiffnessReport { flanks, path } = self;
        let gear = |gear: &GearComparison| {
            let gaps = gear.gaps.iter().map(|gap| (key(gap.model.name()), json!(gap.reason)));
            let points = flank_table(flanks, std::slice::from_ref(gear));
            json!({
                "gear": gear.gear,
                "form_radius": gear.form_radius,
                "tip_radius": gear.tip_radius,
                "twist": gear.twist,
                "refusal": gear.field_refusal(),
                "gaps": (!gear.gaps.is_empty()).then(|| sorted(gaps)),
                "points": objects(&points, &["gear", "contact_half_width"]),
            })
        };
        let [pairs, meshes] = [PAIR, MESH].map(|of| objects(&path_table(path, of), &["way"]));
        let place = |(point, (pair, mesh)): (&PathPoint, (Json, Json))| json!({"way": point.way, "pair_stiffness": pair, "mesh_stiffness": mesh});
        let places = path.points.iter().zip(pairs.into_iter().zip(meshes)).map(place);
        json!({
            "contact_half_width": flanks.contact_half_width,
            "gears": flanks.gears.iter().map(gear).collect::<Json>(),
            "path": places.collect::<Json>(),
        })
    }

    /// One row per gear and radius; an absent value is an empty cell.
    fn table(&self) -> Table {
        flank_table(&self.flanks, &self.flanks.gears)
    }

    fn remarks(&self) -> Vec<String> {
        let gears = self.flanks.gears.iter();
        gears.filter_map(|gear| Some(format!("{}: {}", gear.gear, gear.no_field()?))).collect()
    }
}

fn legend(flanks: &Flanks) -> Vec<String> {
    let names: Vec<_> = flanks.models.iter().map(|model| model.name()).collect();
    let names = names.join(", ");
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 4);
    let notes = [
        "Compliances in um mm/N, per unit face width.",
        &format!("{names}: tooth without contact; in brackets the difference from FE."),
        "FE: finite elements (plane strain, whole gear), without contact. FE, surface, \
         neighbour and the beam leave out the twist of the body.",
        &format!(
            "surface: FE with a contact of half-width {half_width} mm (Hertz, mesh force at the \
             pitch point)."
        ),
        "neighbour: displacement of the next tooth at the same radius; by reciprocity the same \
         ahead and behind.",
    ];
    notes.iter().flat_map(|note| item("", note)).collect()
}

fn gear_section(flanks: &Flanks, gear: &GearComparison) -> Vec<String> {
    let [form, tip] =
        [gear.form_radius, gear.tip_radius].map(|metres| significant(metres / MILLIMETRE, 6));
    let mut lines =
        vec![format!("{}: z {}, form circle {form} mm, tip {tip} mm", gear.gear, gear.teeth)];
    if !gear.points.is_empty() {
        let table = flank_table(flanks, std::slice::from_ref(gear));
        let has_title = |at: &usize| !table.columns[*at].title.is_empty();
        let columns: Vec<usize> = (0..table.columns.len()).filter(has_title).collect();
        lines.extend(table.of(&columns).lines());
    }
    lines.extend(remarks(gear).iter().flat_map(|remark| item("  - ", remark)));
    lines
}

type Compliance = fn(&FieldPoint) -> f64;

/// The compliances of the finite elements: name, title and width in text, value.
const ELASTIC: [(&str, &str, usize, Compliance); 4] = [
    (FIELD, "FE", 10, |field| field.depth),
    ("finite-element-surface", "surface", 10, |field| field.surface),
    ("neighbour-ahead", "neighbour", 11, |field| field.ahead),
    ("neighbour-behind", "", 0, |field| field.behind),
];

fn key(name: &str) -> String {
    name.replace('-', "_")
}

/// One row per gear and radius. Text shows the columns with a title.
fn flank_table(flanks: &Flanks, gears: &[GearComparison]) -> Table {
    let compliance = |name: &str, title: &'static str| Column {
        title: title.into(),
        ..Column::si(key(name), "m2/N")
    };
    let radius = Column::number("radius", "r [mm]", "m", ("mm", 6)).wide(0, 8);
    let mut columns = vec![Column::text("gear", ""), radius];
    let models = flanks.models.iter();
    columns.extend(models.map(|model| compliance(model.name(), model.name()).wide(1, 16)));
    let after_depth = columns.len() + 1;
    columns.extend(ELASTIC.map(|(name, title, least, _)| compliance(name, title).wide(0, least)));
    columns.insert(after_depth, Column::si("contact_half_width", "m"));
    let row = |gear: &GearComparison, point: &Point| {
        let shown = |value: Option<f64>, reference| {
            cell(value, |value| value / MICRON_MILLIMETRE, reference)
        };
        let depth = point.field.map(|field| field.depth);
        let mut cells = vec![gear.gear.into(), Cell::Number(point.radius)];
        cells.extend(point.models.iter().map(|&value| shown(value, depth)));
        cells.extend(ELASTIC.map(|(.., of)| shown(point.field.as_ref().map(of), None)));
        cells.insert(after_depth, Cell::Number(flanks.contact_half_width));
        cells
    };
    let rows = gears.iter();
    let rows = rows.flat_map(|gear| gear.points.iter().map(move |point| row(gear, point)));
    Table::new("", columns).with(rows)
}

type Stiffnesses = fn(&PathPoint) -> &[Option<f64>];
const PAIR: Stiffnesses = |point| &point.pair;
const MESH: Stiffnesses = |point| &point.mesh;

/// Stiffness over the path of contact.
fn path_table(path: &PathComparison, of: Stiffnesses) -> Table {
    let field = path.models.iter().position(|model| model.name() == FIELD);
    let model = |model: &ToothCompliance| {
        let title = model.name().into();
        Column { title, ..Column::si(key(model.name()), "N/m2") }.wide(1, 16)
    };
    let place = Column::number("way", "s [mm]", "m", ("mm", 4)).wide(0, 8);
    let row = |point: &PathPoint| {
        let reference = field.and_then(|field| of(point)[field]);
        let cells = of(point).iter().enumerate().map(|(model, &value)| {
            let other = reference.filter(|_| Some(model) != field);
            cell(value, |value| value * MICRON_MILLIMETRE, other)
        });
        std::iter::once(Cell::Number(point.way)).chain(cells).collect()
    };
    let columns = std::iter::once(place).chain(path.models.iter().map(model));
    Table::new("", columns.collect()).with(path.points.iter().map(row))
}

/// A value with its difference from a reference in brackets, as a factor if the percentage is too
/// wide.
fn cell(value: Option<f64>, in_unit: fn(f64) -> f64, reference: Option<f64>) -> Cell {
    const LARGEST: f64 = 999.0;
    let Some(value) = value else { return Cell::None("-".into()) };
    let difference = reference.map_or_else(String::new, |reference| {
        let (factor, percent) = (value / reference, 100.0 * (value / reference - 1.0));
        if percent > LARGEST { format!(" ({factor:.0} x)") } else { format!(" ({percent:+.0} %)") }
    });
    Cell::Shown(value, significant(in_unit(value), 4) + &difference)
}

/// The twist of the body, and the reasons for missing values.
fn remarks(gear: &GearComparison) -> Vec<String> {
    let body = match gear.twist {
        _ if gear.refusal.is_some() => None,
        Some(twist) => Some(format!(
            "twist of the body about its bore: {} um mm/N for every tooth, at every radius",
            significant(twist / MICRON_MILLIMETRE, 4)
        )),
        None => Some("no bore: FE leaves out the twist and the shift of the body".to_owned()),
    };
    let gaps =
        gear.gaps.iter().map(|gap| format!("no value by {}: {}", gap.model.name(), gap.reason));
    let section = gear.virtual_teeth.map(|teeth| {
        let teeth = tidy(teeth, 4);
        format!(
            "the compliances are those of the virtual gear with {teeth} teeth at the same height"
        )
    });
    gear.no_field().into_iter().chain(section).chain(body).chain(gaps).collect()
}

/// The rows as objects with their members in the order of their names, without some columns.
fn objects(table: &Table, without: &[&str]) -> Vec<Json> {
    let key = |at: usize| table.columns[at].key.as_ref();
    let mut columns: Vec<usize> =
        (0..table.columns.len()).filter(|&at| !without.contains(&key(at))).collect();
    columns.sort_by_key(|&at| key(at));
    table.of(&columns).objects()
}
