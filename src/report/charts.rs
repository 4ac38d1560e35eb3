//! The charts of solved cases as pictures.

use super::Report;
use super::graphs::Graph;
use super::stations::{Column, Row, rows};
use super::svg::{Chart, Kind, Labelled, Series, chart};
use crate::case::units;
use crate::model::compliance::model_of;
use crate::model::dynamic::speeds::SpeedCurve;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::spacing::Spacing;
use crate::model::{Inputs, Outcome, Refusal, Solution, contact_state};
use crate::study::stiffness::{PATH_POINTS, compare_path};

/// A longer interval between stations, in requested intervals, is a gap in the curve.
const LEFT_OUT: f64 = 1.5;

/// A solved case, by a name in the legend.
#[derive(Debug, Clone, Copy)]
pub struct SolvedCase<'a> {
    /// The name of the case; empty for a single case.
    pub name: &'a str,
    /// The solve by the method of the case and, for charts that this method lacks, a solve by
    /// another method.
    pub reports: &'a [Report],
    /// The dynamic factor over speed, if computed.
    pub speeds: Option<&'a SpeedCurve>,
}

/// A point of a curve: the driver's roll angle after E in deg, and the value.
pub type Point = (f64, f64);

/// Draws the chart; `None` if no case has a curve.
#[must_use]
pub fn picture(graph: &Graph, cases: &[SolvedCase]) -> Option<String> {
    if let Some(column) = graph.by_model {
        return stiffness(graph, column, cases);
    }
    let found: Vec<_> = cases
        .iter()
        .filter_map(|case| {
            let mut reports = case.reports.iter();
            reports.find_map(|report| Some((label(case, report), report, curve(graph, report)?)))
        })
        .collect();
    let (_, first, _) = found.first()?;
    let column = graph.column(first.solution.method)?;
    let unit = shown_unit(column.shown);
    let marks = marks(&first.solution);
    let bound = if found.len() == 1 { bound(graph, first) } else { None };
    let series =
        found.into_iter().map(|(name, _, pieces)| Series { name, pieces, kind: Kind::Curve });
    Some(chart(&Chart {
        title: graph.label.to_owned(),
        across: Labelled::linear("driver roll angle after E, deg"),
        up: Labelled::linear(if unit.is_empty() {
            format!("{} {}", graph.label, column.symbol)
        } else {
            format!("{} {}, {unit}", graph.label, column.symbol)
        }),
        series: series.chain(bound).collect(),
        marks,
    }))
}

/// Why a chart has no curve for a case.
pub(super) fn absence(graph: &Graph, reports: &[Report]) -> String {
    let has = |method: Method| graph.column(method).is_some();
    match reports.first().filter(|_| graph.by_model.is_some()) {
        Some(own) => match compare_path(&own.inputs, PATH_POINTS) {
            Err(refusal) => refusal.to_string(),
            Ok(_) => "no compliance model covers the pair".to_owned(),
        },
        None => absent_of_methods(has, reports),
    }
}

/// Why a case lacks values that only some methods compute.
pub(super) fn absent_of_methods(has: impl Fn(Method) -> bool, reports: &[Report]) -> String {
    let Some(own) = reports.first() else {
        return "no case is solved".to_owned();
    };
    let solved = reports.iter().find(|report| has(report.solution.method));
    match solved {
        Some(report) if report.solution.outcome == Outcome::NoCornerContact => {
            "no corner contact is found".to_owned()
        }
        Some(report) => format!("method {} finds no values", report.solution.method.name()),
        None => match solve_by_other_method(own) {
            Err(refusal) => format!("method {} refuses the case: {refusal}", other(own).name()),
            Ok(_) => format!("method {} has no such values", own.solution.method.name()),
        },
    }
}

/// The mesh stiffness: by every compliance model for one case, by the model of each case for
/// several.
fn stiffness(graph: &Graph, column: &Column, cases: &[SolvedCase]) -> Option<String> {
    let factor = units::factor(column.shown).unwrap_or(1.0);
    let mut series = Vec::new();
    for case in cases {
        let Some(report) = case.reports.first() else {
            continue;
        };
        let Ok(found) = compare_path(&report.inputs, PATH_POINTS) else {
            continue;
        };
        let own = model_of(&report.inputs);
        for (at, model) in found.models.iter().enumerate() {
            let points: Vec<_> = found.mesh_curve(at).collect();
            if points.len() < 2 || (cases.len() > 1 && *model != own) {
                continue;
            }
            let name = stiffness_name(*model, own);
            series.push(Series {
                name: if case.name.is_empty() {
                    name
                } else {
                    format!("{}, {}", case.name, model.name())
                },
                pieces: vec![
                    points
                        .into_iter()
                        .map(|(angle, value)| (angle.to_degrees(), value / factor))
                        .collect(),
                ],
                kind: Kind::Curve,
            });
        }
    }
    let unit = shown_unit(column.shown);
    (!series.is_empty()).then(|| {
        chart(&Chart {
            title: graph.label.to_owned(),
            across: Labelled::linear("driver roll angle after E, deg"),
            up: Labelled::linear(format!("{} {}, {unit}", graph.label, column.symbol)),
            series,
            marks: vec![(0.0, "E")],
        })
    })
}

/// The name of the curve of a model; it marks the elastic field and the model of the case.
#[must_use]
pub fn stiffness_name(model: ToothCompliance, own: ToothCompliance) -> String {
    let field = if model.model().has_coupling { ", elastic field" } else { "" };
    let case = if model == own { " (case)" } else { "" };
    format!("{}{field}{case}", model.name())
}

fn label(case: &SolvedCase, report: &Report) -> String {
    let method = report.solution.method.name();
    if case.name.is_empty() {
        format!("method {method}")
    } else {
        format!("{}, method {method}", case.name)
    }
}

fn shown_unit(unit: &'static str) -> String {
    match unit {
        "1" => String::new(),
        other => other.replace("um", "µm"),
    }
}

/// Marks at E and at the first contact D.
fn marks(solution: &Solution) -> Vec<(f64, &'static str)> {
    let contact = contact_state::first_contact_of_driver(solution);
    let contact = contact.filter(|angle| *angle > 0.0);
    let contact = contact.map(|angle| (-angle.to_degrees(), "D"));
    contact.into_iter().chain([(0.0, "E")]).collect()
}

fn curve(graph: &Graph, report: &Report) -> Option<Vec<Vec<Point>>> {
    let column = graph.column(report.solution.method)?;
    lines(report, column.shown, |row| column.of(row))
}

fn bound(graph: &Graph, report: &Report) -> Option<Series> {
    let bound = graph.bound?;
    let solution = &report.solution;
    let column = graph.column(solution.method)?;
    let pieces = lines(report, column.shown, |row| (bound.value)(solution, row))?;
    Some(Series {
        name: bound.symbols[usize::from(solution.method.shares_load())].to_owned(),
        pieces,
        kind: Kind::Bound,
    })
}

/// A curve as line series; empty without a curve.
fn lines(
    report: &Report,
    unit: &'static str,
    value: impl Fn(Row) -> Option<f64>,
) -> Option<Vec<Vec<Point>>> {
    let mut lines = curve_of(&report.inputs, &report.solution, unit, value);
    lines.retain(|piece| piece.len() > 1);
    (!lines.is_empty()).then_some(lines)
}

/// The curve of a column over the stations, in a unit, in pieces.
pub fn curve_of(
    inputs: &Inputs,
    solution: &Solution,
    unit: &str,
    value: impl Fn(Row) -> Option<f64>,
) -> Vec<Vec<Point>> {
    let factor = units::factor(unit).unwrap_or(1.0);
    let points = rows(solution)
        .into_iter()
        .map(|row| (row.angle_after_e(), value(row).map(|value| value / factor)));
    pieces(points, longest_interval(inputs, solution))
}

/// Splits a curve at missing stations and at values that are not finite.
pub fn pieces(points: impl Iterator<Item = (f64, Option<f64>)>, longest: f64) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut follows = false;
    for (x, y) in points {
        let Some(y) = y.filter(|y| y.is_finite() && x.is_finite()) else {
            follows = false;
            continue;
        };
        match pieces
            .last_mut()
            .filter(|piece| follows && piece.last().is_some_and(|last| x - last.0 <= longest))
        {
            Some(piece) => piece.push((x, y)),
            None => pieces.push(vec![(x, y)]),
        }
        follows = true;
    }
    pieces
}

/// The longest interval between two stations without a gap, in deg. The closed forms omit stations
/// whose force cannot be computed; the other methods have every station.
fn longest_interval(inputs: &Inputs, solution: &Solution) -> f64 {
    match solution.position {
        Some(position) if solution.stations_withheld.is_some() => {
            let count = Spacing::of(inputs).count().unwrap_or(Spacing::LOOKS) as f64;
            LEFT_OUT * position.approach_angle_driver.to_degrees() / count
        }
        _ => f64::INFINITY,
    }
}

/// The solve of a case, with a solve by another method for the charts that the method of the case
/// lacks: `static` after a closed form, `exact` after a method that shares the load.
#[must_use]
pub fn with_other_method(report: Report) -> Vec<Report> {
    let beside = solve_by_other_method(&report);
    std::iter::once(report).chain(beside.ok()).collect()
}

fn other(report: &Report) -> Method {
    if report.solution.method.shares_load() { Method::Exact } else { Method::Static }
}

fn solve_by_other_method(report: &Report) -> Result<Report, Refusal> {
    let inputs = Inputs { method: other(report), ..report.inputs.clone() };
    Report::solve(report.name.clone(), report.case.clone(), inputs, report.selection.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces_of(points: &[(f64, Option<f64>)]) -> Vec<Vec<Point>> {
        pieces(points.iter().copied(), 1.5)
    }

    #[test]
    fn a_curve_has_a_gap_at_a_missing_or_invalid_station() {
        let one = Some(1.0);
        assert_eq!(
            pieces_of(&[(0.0, one), (1.0, one), (3.0, one)]),
            [vec![(0.0, 1.0), (1.0, 1.0)], vec![(3.0, 1.0)]]
        );
        assert_eq!(pieces_of(&[(0.0, one), (1.0, None), (2.0, one)]).len(), 2);
        assert_eq!(pieces_of(&[(0.0, one), (1.0, Some(f64::NAN)), (2.0, one)]).len(), 2);
        assert_eq!(pieces_of(&[]), Vec::<Vec<Point>>::new());
    }
}
