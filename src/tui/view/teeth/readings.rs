//! The values at the cursor, as a person reads them.

use std::fmt;

use unicode_width::UnicodeWidthStr;

use crate::model::Moment;
use crate::report;
use crate::report::stations::{COLUMNS, Column};

/// Significant digits of the gap.
const GAP_DIGITS: usize = 4;

/// A value at the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// The symbol in the field's writing.
    pub symbol: &'static str,
    /// The number.
    pub number: String,
    /// The unit.
    pub unit: &'static str,
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.symbol, self.number)?;
        if self.unit.is_empty() { Ok(()) } else { write!(f, " {}", self.unit) }
    }
}

/// Every value that the moment has, as a station tells it, and the gap; the driven angle last, which is only the ratio off.
#[must_use]
pub fn readings(moment: &Moment) -> Vec<Reading> {
    let (last, first): (Vec<_>, Vec<_>) = COLUMNS.iter().partition(|column| column.key == "roll_angle_driven");
    let of_station = |column: &Column| {
        let number = report::number(value(moment, column.key)?, column.shown, column.digits);
        Some(Reading { symbol: column.symbol, number, unit: if column.shown == "1" { "" } else { column.shown } })
    };
    let gap = |symbol, value| Reading { symbol, number: report::number(value, "um", GAP_DIGITS), unit: "um" };
    let gaps = [gap("S", moment.gap), gap("open", moment.opening)];
    first.into_iter().filter_map(of_station).chain(gaps).chain(last.into_iter().filter_map(of_station)).collect()
}

fn value(moment: &Moment, key: &str) -> Option<f64> {
    match key {
        "roll_angle_driver" => Some(moment.roll_angle_driver),
        "roll_angle_driven" => Some(moment.roll_angle_driven),
        "radius_driver" => Some(moment.radius_driver),
        "normal_velocity" => Some(moment.normal_velocity),
        "sliding_velocity" => Some(moment.sliding_velocity),
        "impact_force" => moment.impact_force,
        "time" => moment.load?.time,
        "force" => Some(moment.load?.force),
        "load_share" => Some(moment.load?.load_share),
        "transmission_error" => Some(moment.load?.transmission_error),
        _ => None,
    }
}

/// The values in lines of at most a width, two spaces between them.
#[must_use]
pub fn lines(values: impl Iterator<Item = String>, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for value in values {
        match lines.last_mut() {
            Some(line) if line.width() + 2 + value.width() <= width => {
                line.push_str("  ");
                line.push_str(&value);
            }
            _ => lines.push(value),
        }
    }
    lines
}
