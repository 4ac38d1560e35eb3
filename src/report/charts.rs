//! The charts of solved cases as pictures.

use std::f64::consts::PI;

use super::Report;
use super::digest::rounded;
use super::graphs::Graph;
use super::stations::{Column, Row, rows};
use super::stiffness::no_field;
use super::svg::{Chart, Kind, Labelled, Series, chart};
use crate::case::units;
use crate::model::compliance::model_of;
use crate::model::dynamic::speeds::{AtSpeed, SpeedCurve};
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::spacing::Spacing;
use crate::model::static_spectrum::Spectrum;
use crate::model::{Inputs, Outcome, Refusal, Solution, contact_state};
use crate::numeric::decimal::significant;
use crate::study::stiffness::{
    FIELD, FLANK_POINTS, Flanks, GearComparison, PATH_POINTS, Point as FlankPoint, compare_flanks,
    compare_path,
};

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

/// The key of the chart of harmonics.
pub const SPECTRUM: &str = "spectrum";
/// The key of the chart over speed.
pub const SPEED: &str = "speed";

/// A curve over speed with the name of its case; the name is empty for a single case.
pub type NamedCurve<'a> = (&'a str, &'a SpeedCurve);

/// Spectra by their names in the legend.
pub type NamedSpectra = Vec<(String, Spectrum)>;

/// Draws the harmonics of the transmission error at rest and in steady motion; `None` if no case
/// has them.
#[must_use]
pub fn spectrum(cases: &[SolvedCase]) -> Option<String> {
    let all: NamedSpectra = cases.iter().flat_map(of_case).collect();
    spectrum_chart(all).map(|drawn| chart(&drawn))
}

/// The chart of harmonics; `None` without a spectrum.
#[must_use]
pub fn spectrum_chart(all: NamedSpectra) -> Option<Chart> {
    let slots = all.len();
    let bars = all.into_iter().enumerate().map(|(slot, (name, spectrum))| {
        let amplitudes = (1..).zip(spectrum.amplitudes);
        let points = amplitudes.map(|(order, amplitude)| (f64::from(order), amplitude * 1e6));
        Series { name, pieces: vec![points.collect()], kind: Kind::Bars(slot, slots) }
    });
    (slots > 0).then(|| Chart {
        title: "Harmonics of the transmission error".to_owned(),
        across: Labelled::linear("harmonic of the mesh frequency"),
        up: Labelled::linear("amplitude, µm"),
        series: bars.collect(),
        marks: Vec::new(),
    })
}

fn of_case(case: &SolvedCase) -> NamedSpectra {
    let has_mesh = |report: &&Report| matches!(report.solution.static_spectrum, Some(Ok(_)));
    let report = case.reports.iter().find(has_mesh);
    report.map_or_else(Vec::new, |report| spectra(case.name, &report.solution))
}

/// The spectra of a case: at rest and, if the motion is steady, in motion. A named case has only
/// the last of them.
#[must_use]
pub fn spectra(case: &str, solution: &Solution) -> NamedSpectra {
    let at_rest =
        solution.static_spectrum.and_then(Result::ok).map(|found| ("at rest", found.spectrum));
    let moving = in_motion(solution).map(|spectrum| ("in steady motion", spectrum));
    if case.is_empty() {
        let both = at_rest.into_iter().chain(moving);
        return both.map(|(name, spectrum)| (name.to_owned(), spectrum)).collect();
    }
    let one = moving.or(at_rest).into_iter();
    one.map(|(name, spectrum)| (format!("{case}, {name}"), spectrum)).collect()
}

fn in_motion(solution: &Solution) -> Option<Spectrum> {
    Some(solution.steady.as_ref()?.as_ref().ok()?.spectrum)
}

/// Draws the dynamic factor of a tooth over speed; `None` without a curve.
#[must_use]
pub fn speed(curves: &[NamedCurve]) -> Option<String> {
    speed_chart(curves).map(|drawn| chart(&drawn))
}

/// The chart over speed, with the speed and the resonances of a single case; `None` without a
/// curve.
#[must_use]
pub fn speed_chart(curves: &[NamedCurve]) -> Option<Chart> {
    let series: Vec<Series> = curves.iter().flat_map(|curve| runs(*curve)).collect();
    let has_points = series.iter().any(|series| !series.pieces.is_empty());
    has_points.then(|| Chart {
        title: "Dynamic factor of a tooth over speed, torque of the case".to_owned(),
        across: Labelled::linear("speed of the driver, rpm; N = mesh/natural frequency"),
        up: Labelled::linear("largest tooth force / that at rest"),
        series,
        // Each of several cases has its own resonance and speed.
        marks: match curves {
            [(_, only)] => resonance_marks(only),
            _ => Vec::new(),
        },
    })
}

/// The resonance with its fractions, and the speed of the case.
fn resonance_marks(curve: &SpeedCurve) -> Vec<(f64, &'static str)> {
    let ratios = [(1.0, "N=1"), (1.0 / 2.0, "N=1/2"), (1.0 / 3.0, "N=1/3")];
    let mut marks = ratios.map(|(ratio, name)| (rpm(ratio * curve.resonance), name)).to_vec();
    marks.push((rpm(curve.present), "present"));
    marks.sort_by(|one, other| one.0.total_cmp(&other.0));
    marks
}

fn rpm(speed: f64) -> f64 {
    speed * 30.0 / PI
}

/// The run-up, the run-down if its motion differs, and the points with loss of contact.
fn runs((name, curve): NamedCurve) -> Vec<Series> {
    let called = |run: &str, peak: Option<&AtSpeed>| {
        let case = if name.is_empty() { String::new() } else { format!("{name}, ") };
        let peak = peak.map(|peak| {
            let factor = significant(peak.tooth_factor, 3);
            format!(": peak {factor} at {} rpm", rounded(rpm(peak.speed)))
        });
        format!("{case}{run}{}", peak.unwrap_or_default())
    };
    let jumps: Vec<AtSpeed> = curve.jumps().copied().collect();
    let is_jump = |point: &AtSpeed| jumps.iter().any(|jump| jump == point);
    let way = if jumps.is_empty() { "speed rising or falling" } else { "speed rising" };
    let up = called(way, curve.peak_rising());
    let up = Series {
        name: up,
        pieces: unbroken(curve.up.iter().map(Option::as_ref)),
        kind: Kind::Curve,
    };
    let down = curve.down.iter().map(|point| point.as_ref().filter(|point| is_jump(point)));
    let down = Series {
        name: called("speed falling", curve.peak_falling()),
        pieces: unbroken(down),
        kind: Kind::Curve,
    };
    let lost = Series {
        name: "contact lost".to_owned(),
        pieces: lost(curve, &jumps),
        kind: Kind::Marks(None),
    };
    let all = [up, down, lost];
    all.into_iter().filter(|series| !series.pieces.is_empty()).collect()
}

/// The points with loss of contact: of neighbouring points the first and every fifth, so that the
/// curve between them is visible.
fn lost(curve: &SpeedCurve, jumps: &[AtSpeed]) -> Vec<Vec<(f64, f64)>> {
    const STRIDE: usize = 5;
    let of_run = |run: &[Option<AtSpeed>], counts: &dyn Fn(&AtSpeed) -> bool| {
        let is_lost = |point: &&AtSpeed| point.contact_lost && counts(point);
        let points = unbroken(run.iter().map(|point| point.as_ref().filter(is_lost)));
        let kept = points.into_iter().flat_map(|run| run.into_iter().step_by(STRIDE));
        kept.map(|point| vec![point]).collect::<Vec<_>>()
    };
    let mut found = of_run(&curve.up, &|_| true);
    found.extend(of_run(&curve.down, &|point| jumps.contains(point)));
    found
}

fn place(point: &AtSpeed) -> (f64, f64) {
    (rpm(point.speed), point.tooth_factor)
}

/// Groups of neighbouring points.
fn unbroken<'a>(points: impl Iterator<Item = Option<&'a AtSpeed>>) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for point in points {
        match (point, pieces.last_mut()) {
            (Some(point), Some(piece)) => piece.push(place(point)),
            _ => pieces.push(Vec::new()),
        }
    }
    pieces.retain(|piece| !piece.is_empty());
    pieces
}

/// The keys of the charts of the driver and of the driven gear.
pub const TOOTH_KEYS: [&str; 2] = ["tooth_compliance_driver", "tooth_compliance_driven"];

const MILLIMETRE: f64 = 1e-3;
/// The factor from um mm/N to m²/N.
const MICRON_MILLIMETRE: f64 = 1e-9;

/// Draws a gear of a pair, the driver if `gear` is 0.
///
/// # Errors
/// The reason why the gear has no chart.
pub fn tooth_picture(gear: usize, inputs: &Inputs) -> Result<String, String> {
    let found = compare_flanks(inputs, FLANK_POINTS);
    let flanks = found.map_err(|refusal| refusal.to_string())?;
    let drawn = tooth_chart(gear, &flanks, model_of(inputs));
    drawn.map_or_else(|| Err(tooth_absence(gear, &flanks)), |drawn| Ok(chart(&drawn)))
}

/// Why a gear has no chart.
#[must_use]
pub fn tooth_absence(gear: usize, flanks: &Flanks) -> String {
    match flanks.gears.get(gear) {
        Some(found) if found.points.is_empty() => {
            format!("the {} has no involute between form circle and tip", gear_name(gear))
        }
        _ => format!("no compliance model covers the {}", gear_name(gear)),
    }
}

/// The chart of a gear of a pair: first the finite elements, which the models are compared with. A
/// model without values has an empty curve. `None` if no model has a value.
#[must_use]
pub fn tooth_chart(gear: usize, flanks: &Flanks, own: ToothCompliance) -> Option<Chart> {
    let found = flanks.gears.get(gear)?;
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 3);
    let depth = |point: &FlankPoint| point.field.map(|field| field.depth);
    let surface = |point: &FlankPoint| point.field.map(|field| field.surface);
    let remark = no_field(found).unwrap_or_else(|| "without contact".to_owned());
    let field = named(FIELD, own.name() == FIELD, Some(remark));
    let contact = format!("surface, {FIELD} with contact of half-width {half_width} mm");
    let field = [series(found, field, depth), series(found, contact, surface)];
    let models = flanks.models.iter().enumerate().map(|(at, &model)| {
        let gap = found.gaps.iter().find(|gap| gap.model == model);
        let is_empty = found.points.iter().all(|point| point.models[at].is_none());
        let missing = if is_empty { "no value" } else { "gaps" };
        let remark = gap.map(|gap| format!("{missing}: {}", gap.reason));
        let name = named(model.name(), model == own, remark);
        series(found, name, move |point| point.models[at])
    });
    let series: Vec<Series> = field.into_iter().chain(models).collect();
    let has_points = series.iter().any(|series| !series.pieces.is_empty());
    has_points.then(|| Chart {
        title: format!("Tooth compliance of the {}", gear_name(gear)),
        across: Labelled::linear("radius, mm"),
        up: Labelled::linear("tooth compliance q, µm mm/N"),
        series,
        marks: vec![(found.pitch_radius / MILLIMETRE, "C")],
    })
}

/// The name of a gear in a sentence.
fn gear_name(gear: usize) -> &'static str {
    ["driver", "driven gear"][gear.min(1)]
}

/// The name of a curve: the model, whether the case uses it, and a remark.
fn named(model: &str, is_own: bool, remark: Option<String>) -> String {
    let case = if is_own { " (case)" } else { "" };
    let remark = remark.map_or_else(String::new, |remark| format!(", {remark}"));
    format!("{model}{case}{remark}")
}

fn series(
    gear: &GearComparison,
    name: String,
    value: impl Fn(&FlankPoint) -> Option<f64>,
) -> Series {
    let points = gear.points.iter().map(|point| {
        let value = value(point).map(|value| value / MICRON_MILLIMETRE);
        (point.radius / MILLIMETRE, value)
    });
    Series { name, pieces: pieces(points, f64::INFINITY), kind: Kind::Curve }
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
