//! The values at the cursor, with symbol and unit.

use std::fmt;

use unicode_width::UnicodeWidthStr;

use crate::case::units::System;
use crate::case::units::system::{shown, widest_beside};
use crate::model::{ContactState, Inputs, Solution};
use crate::report::graphs::{GRAPHS, Place};
use crate::report::stations::{COLUMNS, Column, Row};

/// Significant digits of the opening.
const GAP_DIGITS: usize = 4;
/// The key of the opening, which is not a column of the stations.
const OPEN: &str = "open";
/// The key of the gap.
const GAP: &str = "gap";
/// The text of a missing number.
const NONE: &str = "–";
/// Cells of a number.
const NUMBER: usize = 7;

/// A value at the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// The symbol.
    pub symbol: &'static str,
    /// The number, if any.
    pub number: Option<String>,
    pub(crate) unit: &'static str,
}

impl Reading {
    /// The width for any number in any unit of its kind, with a symbol of a width.
    #[must_use]
    pub(crate) fn width(&self, symbol: usize) -> usize {
        let unit = if self.unit.is_empty() { 0 } else { 1 + widest_beside(self.unit) };
        symbol + 1 + NUMBER + unit
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.number {
            None => write!(f, "{} {NONE}", self.symbol),
            Some(number) if self.unit.is_empty() => write!(f, "{} {number}", self.symbol),
            Some(number) => write!(f, "{} {number} {}", self.symbol, self.unit),
        }
    }
}

/// Every value of the method at a contact state, and the opening, in a fixed order.
#[must_use]
pub fn readings(
    moment: &ContactState,
    solved: (&Inputs, &Solution),
    system: System,
) -> Vec<Reading> {
    keys()
        .filter_map(|key| {
            if key == OPEN {
                Some(open(moment, system))
            } else {
                reading(moment, key, solved, system)
            }
        })
        .collect()
}

/// The displayed values: the driver's angle, those of the charts in their order, the others. The
/// opening precedes the gap, which includes it.
fn keys() -> impl Iterator<Item = &'static str> {
    let shown = GRAPHS.iter().filter(|graph| graph.is_at(Place::Teeth));
    let of_charts = shown.flat_map(|graph| graph.columns.iter().copied());
    let of_charts = of_charts.flat_map(|key| {
        let before = (key == GAP).then_some(OPEN);
        before.into_iter().chain([key])
    });
    let has_chart = |key: &str| GRAPHS.iter().any(|graph| graph.columns.contains(&key));
    let others = COLUMNS.iter().map(|column| column.key);
    let mut others = others.filter(move |key| !has_chart(key));
    others.next().into_iter().chain(of_charts).chain(others)
}

fn open(moment: &ContactState, system: System) -> Reading {
    let (number, unit) = shown(moment.opening, "um", GAP_DIGITS, system);
    Reading { symbol: OPEN, number: Some(number), unit }
}

fn reading(
    moment: &ContactState,
    key: &str,
    (inputs, solution): (&Inputs, &Solution),
    system: System,
) -> Option<Reading> {
    let column: &Column = COLUMNS.iter().find(|column| column.key == key)?;
    let interpolated = moment.interpolated.as_ref().map(Row::from).and_then(|row| column.of(row));
    let value = interpolated.or_else(|| without_contact(moment, key));
    if value.is_none() && !column.methods.contains(&solution.method) {
        return None;
    }
    let digits = moment
        .interpolated
        .as_ref()
        .map_or(column.digits, |interpolated| column.digits_of(interpolated));
    let usual = if column.shown == "1" { "" } else { system.unit(column.shown) };
    let (number, unit) = value.map_or((None, usual), |value| {
        let (number, unit) =
            shown(column.resolved(value, inputs, solution), column.shown, digits, system);
        (Some(number), unit)
    });
    Some(Reading { symbol: column.symbol, number, unit })
}

/// The value from the involutes, if the method has none.
fn without_contact(moment: &ContactState, key: &str) -> Option<f64> {
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

/// The values in lines of at most a width. Each value has a fixed width, and two blanks separate
/// the values.
#[must_use]
pub(crate) fn lines(values: impl Iterator<Item = (String, usize)>, width: usize) -> Vec<String> {
    let mut lines: Vec<(String, usize)> = Vec::new();
    for (value, cells) in values {
        match lines.last_mut() {
            Some((line, end)) if *end + 2 + cells <= width => {
                // A longer number uses the blanks after it.
                let gap = (*end + 2).saturating_sub(line.width()).max(1);
                line.push_str(&" ".repeat(gap));
                line.push_str(&value);
                *end += 2 + cells;
            }
            _ => lines.push((value, cells)),
        }
    }
    lines.into_iter().map(|(line, _)| line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_keeps_its_place_if_others_change() {
        let line = |numbers: [Option<&str>; 2]| {
            let readings = numbers.map(|number| Reading {
                symbol: "F_S",
                number: number.map(str::to_owned),
                unit: "N",
            });
            lines(readings.iter().map(|reading| (reading.to_string(), reading.width(3))), 40)
        };
        assert_eq!(line([Some("2191.0"), Some("1")]), ["F_S 2191.0 N    F_S 1 N"]);
        assert_eq!(line([None, Some("1")]), ["F_S –           F_S 1 N"]);
        assert_eq!(line([Some("-0.12345"), Some("1")]), ["F_S -0.12345 N  F_S 1 N"]);
    }
}
