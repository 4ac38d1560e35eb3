//! The effect of inertia, finite elements and coupling in three pairs.

use std::fmt::Write as _;

use tipstrike::model::inputs::{InertiaModel, Method, ToothCompliance};
use tipstrike::model::{Inputs, Solution, Stages, solve};
use tipstrike::numeric::decimal::significant;

use super::with_model;
use crate::support::inputs;

const PAIRS: [(&str, &str); 3] = [
    ("Table 1", "cases/zhou-chen-2014.toml"),
    ("FZG type C", "cases/fzg-type-c.toml"),
    ("NASA 28/28", "cases/nasa-lewis-28-28.toml"),
];

const INERTIAS: [(InertiaModel, &str); 2] =
    [(InertiaModel::BaseCircle, "base-circle"), (InertiaModel::Outline, "outline")];

/// First contact in degrees of the driver, peak force before E and overall in N, and required
/// additional tip relief in um.
#[derive(Clone, Copy)]
struct Found([Option<f64>; 4]);

impl Found {
    fn of(inputs: &Inputs) -> Found {
        let solution = solve(inputs, Stages::EVERY).unwrap_or_else(|refusal| panic!("{refusal}"));
        let relief = solution.clearing.and_then(|clearing| clearing.relief);
        let motion = solution.dynamic.as_ref().expect("a motion");
        let angle = motion.first_contact_angle;
        Found([
            angle.map(|angle| driver_degrees(&solution, angle)),
            angle.map(|_| motion.peak_approach_force),
            Some(motion.peak_force),
            relief.map(|relief| 1e6 * relief),
        ])
    }

    fn row(&self) -> String {
        let cells = self.0.map(|value| value.map_or("-".to_owned(), |value| significant(value, 4)));
        cells.join(" | ")
    }

    /// The change from `from` to this result, in %.
    fn change(&self, from: &Found) -> String {
        let mut cells = Vec::new();
        for (to, from) in self.0.iter().zip(from.0) {
            let change = to.zip(from).map(|(to, from)| 100.0 * (to / from - 1.0));
            cells.push(change.map_or("-".to_owned(), |change| format!("{change:+.1} %")));
        }
        cells.join(" | ")
    }
}

fn driver_degrees(solution: &Solution, driven_angle: f64) -> f64 {
    let circles = &solution.geometry;
    (driven_angle * circles.driven.base / circles.driver.base).to_degrees()
}

/// The section of the page.
pub(super) fn section() -> String {
    let mut text = "\n## What inertia, finite elements and coupling change\n\nMethod `dynamic`: first contact \
        before E in degrees of the driver, peak force before E and overall in N, and required \
        additional tip relief in um. `base-circle` is the disc of Eq. 47, `outline` the true inertia. \
        `kuang-yang` and `beam` model neighbouring teeth as independent springs; \
        `finite-element` couples them. The rows without coupling are the same finite elements with \
        independent springs.\n"
        .to_owned();
    for (name, file) in PAIRS {
        text += &pair(name, file);
    }
    text
}

fn pair(name: &str, file: &str) -> String {
    let pair = Inputs { method: Method::Dynamic, ..inputs(file) };
    let mut text = format!(
        "\n{name} (`{file}`):\n\n| tooth compliance | inertia | first contact | peak before E | \
         peak | relief |\n|---|---|---|---|---|---|\n"
    );
    let kinds = [
        (ToothCompliance::KUANG_YANG, true, ""),
        (ToothCompliance::BEAM, true, ""),
        (ToothCompliance::FINITE_ELEMENT, false, " without coupling"),
        (ToothCompliance::FINITE_ELEMENT, true, ""),
    ];
    let found = kinds.map(|(model, tooth_coupling, words)| {
        INERTIAS.map(|(inertia, inertia_name)| {
            let inputs = Inputs { inertia, tooth_coupling, ..with_model(&pair, model) };
            let found = Found::of(&inputs);
            let row = found.row();
            writeln!(text, "| {}{words} | {inertia_name} | {row} |", model.name()).unwrap();
            found
        })
    });
    text += "\n| change | first contact | peak before E | peak | relief |\n|---|---|---|---|---|\n";
    let [_, [_, beam], [_, alone], [disc, whole]] = &found;
    let changes = [
        ("true inertia instead of the disc of Eq. 47, with finite-element", disc, whole),
        ("finite elements instead of the beam, without coupling", beam, alone),
        ("coupling instead of independent springs, with finite-element", alone, whole),
    ];
    for (words, from, to) in changes {
        writeln!(text, "| {words} | {} |", to.change(from)).unwrap();
    }
    text
}
