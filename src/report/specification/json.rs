//! The relief to specify as one JSON object.

use std::io::{self, Write};

use serde::Serialize;

use super::numbers::shape;
use crate::report::json::write_line;
use crate::study::relief::{Choice, MapPoint, Specification, TipReliefs};

/// Writes the specification on one line.
///
/// # Errors
/// Errors of the writer.
pub(super) fn line(
    name: &str,
    title: &str,
    found: &Specification,
    out: &mut dyn Write,
) -> io::Result<()> {
    let line = Line {
        case: name,
        title,
        version: env!("CARGO_PKG_VERSION"),
        method: found.method.name(),
        torque: found.torque,
        loads: &found.loads,
        tolerance: found.demand.tolerance,
        relief: Reliefs::of(&found.chosen().reliefs),
        margin: found.chosen().margin,
        greatest_load: found.greatest_load,
        unloaded_contact_ratio: found.unloaded_contact_ratio,
        choices: found.choices.iter().map(JsonChoice::of).collect(),
        map: found.map.iter().flatten().map(JsonPoint::of).collect(),
        tries: found.tries,
        is_complete: !found.is_cut,
    };
    write_line(&line, out)
}

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    method: &'a str,
    torque: f64,
    loads: &'a [f64],
    tolerance: f64,
    relief: Reliefs,
    margin: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    greatest_load: Option<f64>,
    unloaded_contact_ratio: f64,
    choices: Vec<JsonChoice<'a>>,
    map: Vec<JsonPoint>,
    tries: u64,
    is_complete: bool,
}

#[derive(Serialize)]
struct Reliefs {
    shape: &'static str,
    driver: OneRelief,
    driven: OneRelief,
}

#[derive(Serialize)]
struct OneRelief {
    tip_relief: f64,
    tip_relief_length: f64,
}

impl Reliefs {
    fn of(reliefs: &TipReliefs) -> Reliefs {
        let one = |at: usize| OneRelief {
            tip_relief: reliefs.amounts[at],
            tip_relief_length: reliefs.lengths[at],
        };
        Reliefs { shape: shape(reliefs.shape), driver: one(0), driven: one(1) }
    }
}

#[derive(Serialize)]
struct JsonChoice<'a> {
    name: &'a str,
    relief: Reliefs,
    transmission_errors: &'a [f64],
    margin: f64,
}

impl JsonChoice<'_> {
    fn of(choice: &Choice) -> JsonChoice<'_> {
        JsonChoice {
            name: choice.name,
            relief: Reliefs::of(&choice.reliefs),
            transmission_errors: &choice.errors,
            margin: choice.margin,
        }
    }
}

#[derive(Serialize)]
struct JsonPoint {
    relief: Reliefs,
    transmission_error: f64,
    margin: f64,
}

impl JsonPoint {
    fn of(point: &MapPoint) -> JsonPoint {
        JsonPoint {
            relief: Reliefs::of(&point.reliefs),
            transmission_error: point.error,
            margin: point.margin,
        }
    }
}
