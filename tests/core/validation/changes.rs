//! What inertia and tooth compliance change in three pairs.

use std::fmt::Write as _;

use tipstrike::model::inputs::{InertiaModel, Method, ToothCompliance};
use tipstrike::model::{Inputs, Outcome, Quantity, Solution, Stages, solve};
use tipstrike::numeric::decimal::significant;

use super::{inputs, with_model};

const PAIRS: [(&str, &str); 3] = [
    ("Table 1", "cases/zhou-chen-2014.toml"),
    ("FZG type C", "cases/fzg-type-c.toml"),
    ("NASA 28/28", "cases/nasa-lewis-28-28.toml"),
];

const INERTIAS: [(InertiaModel, &str); 2] = [
    (InertiaModel::BaseCircle, "base-circle"),
    (InertiaModel::Outline, "outline"),
];

fn shown(solution: &Solution, key: &str, factor: f64) -> String {
    let value = Quantity::find(key).and_then(|quantity| (quantity.value)(solution));
    value.map_or("-".to_owned(), |value| significant(factor * value, 4))
}

fn row(inputs: &Inputs) -> String {
    let degree = 1f64.to_degrees();
    match solve(inputs, Stages::EVERY) {
        Ok(solution) if solution.outcome == Outcome::NoCornerContact => {
            format!(
                "no contact before E | - | {} | {}",
                shown(&solution, "dynamic_peak_force", 1.0),
                shown(&solution, "clearing_relief", 1e6)
            )
        }
        Ok(solution) => [
            shown(&solution, "dynamic_first_contact_angle_driver", degree),
            shown(&solution, "dynamic_peak_approach_force", 1.0),
            shown(&solution, "dynamic_peak_force", 1.0),
            shown(&solution, "clearing_relief", 1e6),
        ]
        .join(" | "),
        Err(refusal) => format!("{refusal} | - | - | -"),
    }
}

/// The section of the page.
pub(super) fn section() -> String {
    let mut text = "\n## What inertia and tooth compliance change\n\nMethod `dynamic`: first contact \
        before E in degrees of the driver, peak force before E and overall in N, and required \
        additional tip relief in um. `base-circle` is the disc of Eq. 47, `outline` the true inertia. \
        `kuang-yang` and `beam` take neighbouring teeth as independent springs; \
        `finite-element` adds the field and the coupling of neighbours together.\n"
        .to_owned();
    for (name, file) in PAIRS {
        let pair = Inputs {
            method: Method::Dynamic,
            ..inputs(file)
        };
        write!(
            text,
            "\n{name} (`{file}`):\n\n| tooth compliance | inertia | first contact | peak before E | \
             peak | relief |\n|---|---|---|---|---|---|\n"
        )
        .unwrap();
        for model in ToothCompliance::ALL {
            for (inertia, word) in INERTIAS {
                let inputs = Inputs {
                    inertia,
                    ..with_model(&pair, model)
                };
                writeln!(text, "| {} | {word} | {} |", model.name(), row(&inputs)).unwrap();
            }
        }
    }
    text
}
