//! The values of every curve at the cursor.

use super::Charts;
use super::curves::{Curve, CurveSource, curves};
use crate::case::units;
use crate::model::Interpolated;
use crate::model::inputs::Method;
use crate::model::interpolate::DIGITS_BETWEEN;
use crate::numeric::decimal::significant;
use crate::report::graphs::{GRAPHS, Graph};
use crate::report::stations::{Column, Row};
use crate::tui::ascii::symbol;

/// Significant digits of the time since E.
const TIME_DIGITS: usize = 4;

/// A value below this fraction of the greatest value of the curve is a rounding error of 0.
const ROUNDING: f64 = 1e-9;

/// The angle, the visible curves at it, and every other value of the active method.
#[must_use]
pub fn readout(charts: &Charts, cursor: f64) -> String {
    let mut parts = vec![place(charts, cursor)];
    let graphs = charts.shown();
    let chosen = if graphs.is_empty() { vec![charts.pane.graph] } else { graphs };
    let seen: Vec<String> =
        chosen.iter().filter_map(|&graph| all(charts, &GRAPHS[graph], cursor)).collect();
    let rest = (0..GRAPHS.len()).filter(|graph| !chosen.contains(graph));
    let rest: Vec<String> = rest.filter_map(|graph| own(charts, &GRAPHS[graph], cursor)).collect();
    parts.extend(seen);
    parts.extend((!rest.is_empty()).then(|| rest.join(", ")));
    let (angle, values) = parts.split_at(1);
    if values.is_empty() {
        format!("{}.", angle[0])
    } else {
        format!("{}: {}.", angle[0], values.join("; "))
    }
}

fn place(charts: &Charts, cursor: f64) -> String {
    let (side, degrees) =
        (if cursor < 0.0 { "after" } else { "before" }, cursor.abs().to_degrees());
    if degrees > 0.0 {
        format!("{degrees:.4} deg of the driver {side} E{}", time(charts, cursor))
    } else {
        "At E".to_owned()
    }
}

fn time(charts: &Charts, cursor: f64) -> String {
    let speed = charts.answer.map_or(0.0, |answer| answer.inputs.speed);
    let micros = 1e6 * cursor.abs() / speed;
    if charts.pane.by_time && micros.is_finite() {
        format!(", {} us", significant(micros, TIME_DIGITS))
    } else {
        String::new()
    }
}

// The values of every curve of a chart, the active method first, in the unit of the greatest value.
fn all(charts: &Charts, graph: &Graph, cursor: f64) -> Option<String> {
    let curves = curves(charts, graph);
    let readings: Vec<Reading> =
        curves.iter().rev().filter_map(|curve| Reading::of(charts, graph, curve, cursor)).collect();
    in_words(charts, &readings)
}

// The value of the active method only.
fn own(charts: &Charts, graph: &Graph, cursor: f64) -> Option<String> {
    let curves = curves(charts, graph);
    let own = curves.iter().find(|curve| matches!(curve.source, CurveSource::Active(_)))?;
    in_words(charts, &[Reading::of(charts, graph, own, cursor)?])
}

// The value of a curve in SI, with its number of significant digits.
struct Reading {
    name: String,
    column: &'static Column,
    value: f64,
    digits: usize,
}

fn in_words(charts: &Charts, readings: &[Reading]) -> Option<String> {
    let units = readings.iter().map(|reading| {
        let shown = reading.column.shown;
        units::system::unit_for(reading.value.abs(), shown, reading.digits, charts.units)
    });
    let factor = |unit: &&str| units::factor(unit).unwrap_or(1.0);
    let unit = units.max_by(|one, other| factor(one).total_cmp(&factor(other)))?;
    let words = readings.iter().map(|reading| {
        let number = units::system::counted(reading.value, unit, reading.digits);
        let value = format!("{number} {}", units::system::named(unit));
        format!("{} {}", reading.name, value.trim_end())
    });
    Some(words.collect::<Vec<_>>().join(", "))
}

// The value from the same evaluation as in the teeth pane, not from the drawn line, with its number
// of significant digits.
fn value(charts: &Charts, graph: &Graph, curve: &Curve, cursor: f64) -> Option<(f64, usize)> {
    if let CurveSource::Model { .. } = curve.source {
        let factor = units::factor(curve.unit).unwrap_or(1.0);
        let value = curve.at(0.0 - cursor.to_degrees())?;
        return Some((value * factor, curve.column.digits));
    }
    let is_pinned = matches!(curve.source, CurveSource::Pinned(_));
    let answer = if is_pinned { charts.baseline? } else { charts.answer? };
    let method = if let CurveSource::Other(method) | CurveSource::Pinned(method) = curve.source {
        method
    } else {
        answer.active
    };
    let solution = answer.of(method)?;
    let interpolated = Interpolated::at(&answer.inputs, solution, cursor)?;
    if let CurveSource::Bound(_) = curve.source {
        let digits = if matches!(interpolated, Interpolated::Between(_)) {
            DIGITS_BETWEEN
        } else {
            curve.column.digits
        };
        Some(((graph.bound?.value)(solution, Row::from(&interpolated))?, digits))
    } else {
        let value = curve.column.of(Row::from(&interpolated))?;
        Some((
            curve.column.resolved(value, &answer.inputs, solution),
            curve.column.digits_of(&interpolated),
        ))
    }
}

/// The name of the curve of the baseline, with its method if it differs from the active method.
pub(crate) fn base_name(charts: &Charts, method: Method) -> String {
    let is_other = charts.answer.is_some_and(|answer| answer.active != method);
    if is_other { format!("baseline ({})", method.name()) } else { "baseline".to_owned() }
}

impl Reading {
    fn of(charts: &Charts, graph: &Graph, curve: &Curve, cursor: f64) -> Option<Reading> {
        let name = |text: &'static str| symbol(text, charts.look.ascii).into_owned();
        let (value, digits) = value(charts, graph, curve, cursor)?;
        let in_unit = value / units::factor(curve.unit).unwrap_or(1.0);
        let most = curve.pieces.iter().flatten().map(|(_, y)| y.abs()).fold(0.0, f64::max);
        let is_zero = in_unit.abs() < ROUNDING * most;
        Some(Reading {
            name: match curve.source {
                CurveSource::Active(_) => name(curve.column.symbol),
                CurveSource::Other(method) => method.name().to_owned(),
                CurveSource::Pinned(method) => base_name(charts, method),
                CurveSource::Bound(bound) => name(bound),
                CurveSource::Model { model, .. } => model.name().to_owned(),
            },
            column: curve.column,
            value: if is_zero { 0.0 } else { value },
            digits,
        })
    }
}
