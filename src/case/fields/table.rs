//! The table of fields: every line of the form, in order.

macro_rules! number {
    ($key:expr, $symbol:expr, $label:expr, $dimension:ident, $from:expr, $to:expr, $unit:expr, $absent:expr, $put:expr, $help:expr) => {
        Field {
            key: $key,
            symbol: $symbol,
            label: $label,
            help: $help,
            kind: Kind::Number(Dimension::$dimension, Range::new($from, $to, $unit), $put),
            absent: $absent,
            ..Field::PLAIN
        }
    };
}

mod gear;
mod model;
mod operation;

use super::Absent::{Default, Either, Without};
use super::reasons::Reason::Beside;
use super::{Field, Kind, Range};
use crate::case::units::Dimension;
use gear::{DRIVEN, DRIVER};
use model::MODEL;
use operation::OPERATION;

const fn text(key: &'static str, label: &'static str, help: &'static str) -> Field {
    Field { key, label, help, ..Field::PLAIN }
}

const PAIR: &[Field] = &[
    text("title", "title", "A name for the case.").reasons(&[Beside("a title for reports")]),
    text("notes", "notes", "Sources of the data.").reasons(&[Beside("notes for the reader")]),
    number!(
        "pair.module",
        "m",
        "module",
        Length,
        0.05,
        50.0,
        "mm",
        Either,
        |inputs, value| inputs.module = value,
        "Module of both gears; give either the module or the diametral pitch."
    )
    .with_example("5 mm")
    .instead_of("pair.diametral_pitch", |inputs| (inputs.module > 0.0).then_some(inputs.module)),
    number!(
        "pair.diametral_pitch",
        "Pd",
        "diametral pitch",
        DiametralPitch,
        0.508,
        508.0,
        "1/in",
        Either,
        |inputs, value| inputs.module = 1.0 / value,
        "Diametral pitch of both gears, the reciprocal of the module; replaces the module."
    )
    .with_example("8 1/in")
    .instead_of("pair.module", |inputs| (inputs.module > 0.0).then(|| 1.0 / inputs.module)),
    number!(
        "pair.pressure_angle",
        "α",
        "pressure angle",
        Angle,
        14.5,
        30.0,
        "deg",
        Default("20 deg"),
        |inputs, value| inputs.pressure_angle = value,
        "Pressure angle of the basic rack."
    ),
    number!(
        "pair.centre_distance",
        "a",
        "centre distance",
        Length,
        0.1,
        100000.0,
        "mm",
        Without("no backlash"),
        |inputs, value| inputs.centre_distance = Some(value),
        "Centre distance; else from the profile shifts, without backlash."
    )
    .with_example("100 mm"),
];

/// The rows by groups, in the order of the form and of a new file.
const PARTS: [&[Field]; 5] = [PAIR, DRIVER, DRIVEN, OPERATION, MODEL];

const COUNT: usize = PAIR.len() + DRIVER.len() + DRIVEN.len() + OPERATION.len() + MODEL.len();

/// Every field, in the order of the form and of a new file.
pub static FIELDS: [Field; COUNT] = {
    let mut all = [Field::PLAIN; COUNT];
    let (mut part, mut at) = (0, 0);
    while part < PARTS.len() {
        let mut row = 0;
        while row < PARTS[part].len() {
            all[at] = PARTS[part][row];
            (at, row) = (at + 1, row + 1);
        }
        part += 1;
    }
    all
};
