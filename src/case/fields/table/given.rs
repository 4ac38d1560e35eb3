//! The fields of a given compliance.

use super::number;
use crate::case::fields::Absent::Without;
use crate::case::fields::{Field, Kind, NO_TABLE};
use crate::case::units::Dimension::{Compliance, Length, Number};
use crate::model::Inputs;
use crate::model::given::{COEFFICIENTS, GivenCompliance};

/// The table of the compliance model `given`, which a case without this table does not have.
fn given(inputs: &mut Inputs) -> &mut GivenCompliance {
    inputs.given_compliance.get_or_insert_default()
}

/// The rows of a curve: its value in the middle and its coefficients.
macro_rules! curve {
    ($name:ident, $symbol:literal, [$label:literal, $coefficients:literal], $help:literal) => {
        [
            number(
                [concat!("compliance.", stringify!($name)), $symbol, $label],
                (Compliance, 1e-6, 1e6, "um mm/N"),
                Without("not given"),
                |inputs, value| given(inputs).$name.middle = value,
                $help,
            )
            .with_example("0.03 um mm/N")
            .reasons(&NO_TABLE),
            Field {
                key: concat!("compliance.", stringify!($name), "_coefficients"),
                symbol: "",
                label: $coefficients,
                help: "Change along the path: times 1 + c1 t + c2 t^2 .., t from -1 at E to 1 at B.",
                kind: Kind::List(|inputs, values| given(inputs).$name.coefficients = values),
                absent: Without("0"),
                example: "0.6, 0.5",
                reasons: &NO_TABLE,
                ..Field::PLAIN
            },
        ]
    };
}

const CURVES: [[Field; 2]; 3] = [
    curve!(
        driver,
        "q1",
        ["given driver compliance", "given driver coefficients"],
        "Compliance of the driver's tooth and body per width without the contact, in the middle of the path."
    ),
    curve!(
        driven,
        "q2",
        ["given driven compliance", "given driven coefficients"],
        "Compliance of the driven tooth and body per width without the contact, in the middle of the path."
    ),
    curve!(
        contact,
        "qH",
        ["given contact compliance", "given contact coefficients"],
        "Compliance of the contact of both flanks per width, in the middle of the path."
    ),
];

pub(super) const COMPLIANCE: &[Field] = &[
    CURVES[0][0],
    CURVES[0][1],
    CURVES[1][0],
    CURVES[1][1],
    CURVES[2][0],
    CURVES[2][1],
    number(
        ["compliance.cross", "q_x", "next pair"],
        (Number, 0.0, 0.45, ""),
        Without("0"),
        |inputs, value| given(inputs).cross = value,
        "Displacement of the next pair over that of the loaded pair, without the contact.",
    )
    .with_example("0.2")
    .reasons(&NO_TABLE),
    number(
        ["compliance.coupling_length", "L", "coupling length"],
        (Length, 0.001, 1000.0, "mm"),
        Without("independent slices"),
        |inputs, value| given(inputs).coupling_length = Some(value),
        "Length along the face over which a force displaces the slices beside it.",
    )
    .with_example("3.9 mm")
    .reasons(&NO_TABLE),
    number(
        ["compliance.end_acute", "c_a", "acute end"],
        (Number, 0.0, 10.0, ""),
        Without("0"),
        |inputs, value| given(inputs).end_acute = value,
        "Softening of the acute end of a tooth, times its compliance.",
    )
    .with_example("0.87")
    .reasons(&NO_TABLE),
    number(
        ["compliance.end_obtuse", "c_o", "obtuse end"],
        (Number, 0.0, 0.9, ""),
        Without("0"),
        |inputs, value| given(inputs).end_obtuse = value,
        "Stiffening of the obtuse end of a tooth, times its compliance.",
    )
    .with_example("0.19")
    .reasons(&NO_TABLE),
    number(
        ["compliance.end_decay", "", "decay of the ends"],
        (Length, 0.001, 1000.0, "mm"),
        Without("0.58 of the depth"),
        |inputs, value| given(inputs).end_decay = Some(value),
        "Length over which the effect of an end decays.",
    )
    .with_example("3.9 mm")
    .reasons(&NO_TABLE),
];

/// Values of a list, unused ones 0.
pub type List = [f64; COEFFICIENTS];
