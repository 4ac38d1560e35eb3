//! The values at the cursor, as a person reads them.

use std::fmt;

use unicode_width::UnicodeWidthStr;

use crate::case::units::system::{self, System};
use crate::model::Moment;
use crate::report;
use crate::report::stations::{COLUMNS, Column, Row};

/// Significant digits of the opening.
const GAP_DIGITS: usize = 4;

/// What the charts tell and no picture shows.
const CHARTS_ALONE: [&str; 2] = ["pair_compliance", "impact_energy"];

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

/// Every value that the moment has, as a station tells it, and the opening; the driven angle last, which is only the ratio off.
#[must_use]
pub fn readings(moment: &Moment) -> Vec<Reading> {
    let (last, first): (Vec<_>, Vec<_>) = COLUMNS.iter().partition(|column| column.key == "roll_angle_driven");
    let told = moment.told.as_ref().map(Row::from);
    let reading = |column: &&Column| {
        if CHARTS_ALONE.contains(&column.key) {
            return None;
        }
        let value = told.and_then(|row| column.of(row)).or_else(|| without_contact(moment, column.key))?;
        let digits = moment.told.as_ref().map_or(column.digits, |told| column.digits_of(told));
        let (number, unit) = system::shown(value, column.shown, digits, System::Metric);
        Some(Reading { symbol: column.symbol, number, unit })
    };
    let open = Reading { symbol: "open", number: report::number(moment.opening, "um", GAP_DIGITS), unit: "um" };
    first.iter().filter_map(reading).chain([open]).chain(last.iter().filter_map(reading)).collect()
}

/// What the involutes do where the rung tells nothing.
fn without_contact(moment: &Moment, key: &str) -> Option<f64> {
    match key {
        "roll_angle_driver" => Some(moment.roll_angle_driver),
        "roll_angle_driven" => Some(moment.roll_angle_driven),
        "radius_driver" => Some(moment.radius_driver),
        "normal_velocity" => Some(moment.normal_velocity),
        "sliding_velocity" => Some(moment.sliding_velocity),
        "gap" => Some(moment.gap),
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
