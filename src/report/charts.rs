//! The charts of solved cases.

use std::f64::consts::PI;

use super::chart::{Axis, Chart, Kind, Point, Series};
use super::graphs::Graph;
use super::solve::Subject;
use super::stations::Column;
use super::stiffness::no_field;
use super::{Report, shown};
use crate::case::units;
use crate::model::compliance::model_of;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::speeds::{AtSpeed, SpeedCurve};
use crate::model::static_load::Spectrum;
use crate::model::stations::Spacing;
use crate::model::{Inputs, Quantity, Solution, Station, contact_state};
use crate::numeric::decimal::significant;
use crate::study::stiffness::{FIELD, Flanks, GearComparison, Point as FlankPoint};

/// A longer interval between stations, in requested intervals, is a gap in the curve.
const LEFT_OUT: f64 = 1.5;

/// A case by its name in the legend; the name is empty for a single case.
pub type NamedCase<'a> = (&'a str, &'a Subject);

/// The chart of a value over the roll angle.
///
/// # Errors
/// The reason why the first case has no curve, if no case has one.
pub fn graph_chart(graph: &Graph, cases: &[NamedCase]) -> Result<Chart, String> {
    let mut chart = match graph.by_model {
        Some(column) => Chart {
            up: axis_of(graph, column),
            series: stiffness(column, cases)?,
            marks: vec![(0.0, "E")],
            ..Chart::default()
        },
        None => stations_chart(graph, cases)?,
    };
    graph.label.clone_into(&mut chart.title);
    chart.across = Axis::new("driver roll angle after E", "deg");
    Ok(chart)
}

/// The chart of a column of the stations.
fn stations_chart<'a>(graph: &Graph, cases: &[NamedCase<'a>]) -> Result<Chart, String> {
    let line = |report: &Report, kind: Kind| {
        let Report { inputs, solution, .. } = report;
        let column = graph.column(solution.method)?;
        let (name, mut pieces) = curve(graph, inputs, solution, (column.shown, kind))?;
        pieces.retain(|piece| piece.len() > 1);
        let name = name.to_owned();
        (!pieces.is_empty()).then_some((column, Series { name, pieces, kind }))
    };
    let of_case = |&(name, case): &NamedCase<'a>| {
        case.reports.iter().find_map(|report| {
            let (column, mut series) = line(report, Kind::Curve)?;
            series.name = of(name, &format!("method {}", report.solution.method.name()));
            Some(((report, column), series))
        })
    };
    let (reports, mut series): (Vec<_>, Vec<_>) = cases.iter().filter_map(of_case).unzip();
    let Some((first, column)) = reports.first() else {
        let absence = |(_, case): &NamedCase| case.absence(|method| graph.column(method).is_some());
        return Err(cases.first().map(absence).unwrap_or_default());
    };
    if series.len() == 1 {
        series.extend(line(first, Kind::Bound).map(|(_, bound)| bound));
    }
    let up = axis_of(graph, column);
    Ok(Chart { up, series, marks: marks(&first.solution), ..Chart::default() })
}

fn axis_of(graph: &Graph, column: &Column) -> Axis {
    Axis::new(format!("{} {}", graph.label, column.symbol), column.shown)
}

/// A name, after the name of its case if there are several.
fn of(case: &str, name: &str) -> String {
    if case.is_empty() { name.to_owned() } else { format!("{case}, {name}") }
}

/// The mesh stiffness: by every compliance model for one case, by the model of each case for
/// several.
fn stiffness(column: &Column, cases: &[NamedCase]) -> Result<Vec<Series>, String> {
    let factor = units::factor(column.shown).unwrap_or(1.0);
    let (mut series, mut absence) = (Vec::new(), None);
    for (case, solved) in cases {
        let (report, found) = match (solved.own(), &solved.path) {
            (Some(report), Some(Ok(found))) => (report, found),
            (_, Some(Err(refusal))) => {
                absence = absence.or(Some(refusal.to_string()));
                continue;
            }
            _ => continue,
        };
        let own = model_of(&report.inputs);
        for (at, &model) in found.models.iter().enumerate() {
            let points = found.mesh_curve(at);
            let points = points.map(|(angle, value)| (angle.to_degrees(), value / factor));
            let points: Vec<Point> = points.collect();
            if points.len() < 2 || (cases.len() > 1 && model != own) {
                continue;
            }
            let is_own = if model == own { " (case)" } else { "" };
            let name = match *case {
                "" => format!("{}{is_own}", model.name()),
                case => of(case, model.name()),
            };
            series.push(Series { name, pieces: vec![points], kind: Kind::Curve });
        }
    }
    let none = || absence.unwrap_or_else(|| "no compliance model covers the pair".to_owned());
    if series.is_empty() { Err(none()) } else { Ok(series) }
}

/// Marks at E and at the first contact D.
fn marks(solution: &Solution) -> Vec<(f64, &'static str)> {
    let contact = contact_state::first_contact_of_driver(solution);
    let contact = contact.filter(|angle| *angle > 0.0);
    let contact = contact.map(|angle| (-angle.to_degrees(), "D"));
    contact.into_iter().chain([(0.0, "E")]).collect()
}

/// A curve over the stations, in a unit and in pieces: the column of the method, or its comparison
/// value, with its symbol.
pub fn curve(
    graph: &Graph,
    inputs: &Inputs,
    solution: &Solution,
    (unit, kind): (&str, Kind),
) -> Option<(&'static str, Vec<Vec<Point>>)> {
    let (factor, column) = (units::factor(unit).unwrap_or(1.0), graph.column(solution.method)?);
    let bound = graph.bound.filter(|_| kind == Kind::Bound);
    let symbol = match bound {
        Some(bound) => bound.symbols[usize::from(solution.method.shares_load())],
        None if kind == Kind::Bound => return None,
        None => column.symbol,
    };
    let value = |station: &Station| match bound {
        Some(bound) => (bound.value)(solution, station),
        None => column.of(solution, station),
    };
    let points = solution.own_stations().iter();
    let points = points.map(|one| (one.angle_after_e(), value(one).map(|value| value / factor)));
    Some((symbol, pieces(points, longest_interval(inputs, solution))))
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

/// The key of the chart of harmonics.
pub const SPECTRUM: &str = "spectrum";
/// The key of the chart over speed.
pub const SPEED: &str = "speed";

/// Spectra by their names in the legend.
pub type NamedSpectra = Vec<(String, Spectrum)>;

/// The chart of the harmonics of the transmission error at rest and in steady motion.
///
/// # Errors
/// The reason why the first case has no spectrum, if no case has one.
pub fn spectrum_chart(cases: &[NamedCase]) -> Result<Chart, String> {
    let has_mesh = |report: &&Report| matches!(report.solution.static_spectrum, Some(Ok(_)));
    let of_case = |(name, case): &NamedCase| {
        let report = case.reports.iter().find(has_mesh);
        report.map_or_else(Vec::new, |report| spectra(name, &report.solution))
    };
    let all: NamedSpectra = cases.iter().flat_map(of_case).collect();
    let absence = || cases.first().map(|(_, case)| case.absence(Method::shares_load));
    if all.is_empty() { Err(absence().unwrap_or_default()) } else { Ok(chart_of_spectra(all)) }
}

/// The chart of harmonics.
#[must_use]
pub fn chart_of_spectra(all: NamedSpectra) -> Chart {
    let bars = all.into_iter().map(|(name, spectrum)| {
        let amplitudes = (1..).zip(spectrum.amplitudes);
        let points = amplitudes.map(|(order, amplitude)| (f64::from(order), amplitude * 1e6));
        Series { name, pieces: vec![points.collect()], kind: Kind::Bars }
    });
    Chart {
        title: "Harmonics of the transmission error".to_owned(),
        across: Axis::new("harmonic of the mesh frequency", ""),
        up: Axis::new("Transmission error, amplitude", "um"),
        series: bars.collect(),
        ..Chart::default()
    }
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

/// The chart of the dynamic factor over speed, with the speed and the resonances of a single case.
///
/// # Errors
/// The reason if no case has a curve.
pub fn speed_chart(curves: &[(&str, &SpeedCurve)]) -> Result<Chart, String> {
    let series: Vec<Series> = curves.iter().flat_map(|curve| runs(*curve)).collect();
    if series.is_empty() {
        return Err("the motion does not become steady: give a greater model.damping_ratio".into());
    }
    Ok(Chart {
        title: "Dynamic factor of a tooth over speed".to_owned(),
        across: Axis::new("speed of the driver", "rpm; N = mesh/natural frequency"),
        up: Axis::new("Dynamic factor: force / that at rest", ""),
        series,
        // Each of several cases has its own resonance and speed.
        marks: match curves {
            [(_, only)] => resonance_marks(only),
            _ => Vec::new(),
        },
        ..Chart::default()
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
fn runs((name, curve): (&str, &SpeedCurve)) -> Vec<Series> {
    let called = |run: &str, peak: Option<&AtSpeed>| {
        let text = |key, value| Some(shown(Quantity::find(key)?, value).to_string());
        let peak = peak.and_then(|peak| {
            let factor = text("resonance_peak_factor", peak.tooth_factor)?;
            Some(format!(": peak {factor} at {}", text("resonance_peak_speed", peak.speed)?))
        });
        of(name, &(run.to_owned() + &peak.unwrap_or_default()))
    };
    let jumps: Vec<AtSpeed> = curve.jumps().copied().collect();
    let is_jump = |point: &AtSpeed| jumps.iter().any(|jump| jump == point);
    let way = if jumps.is_empty() { "rising/falling" } else { "speed rising" };
    let down = curve.down.iter().map(|point| point.as_ref().filter(|point| is_jump(point)));
    let all = [
        Series {
            name: called(way, curve.peak_rising()),
            pieces: unbroken(curve.up.iter().map(Option::as_ref)),
            kind: Kind::Curve,
        },
        Series {
            name: called("speed falling", curve.peak_falling()),
            pieces: unbroken(down),
            kind: Kind::Curve,
        },
        Series {
            name: "contact lost".to_owned(),
            pieces: lost(curve, &jumps),
            kind: Kind::Marks(None),
        },
    ];
    all.into_iter().filter(|series| !series.pieces.is_empty()).collect()
}

/// Every fifth point with loss of contact, so that the curve between them is visible.
fn lost(curve: &SpeedCurve, jumps: &[AtSpeed]) -> Vec<Vec<Point>> {
    const STRIDE: usize = 5;
    let falling = curve.down.iter().flatten().filter(|point| jumps.contains(point));
    let points = curve.up.iter().flatten().chain(falling).filter(|point| point.contact_lost);
    let points = points.step_by(STRIDE);
    points.map(|point| vec![(rpm(point.speed), point.tooth_factor)]).collect()
}

/// Groups of neighbouring points.
fn unbroken<'a>(points: impl Iterator<Item = Option<&'a AtSpeed>>) -> Vec<Vec<Point>> {
    let place = |point: Option<&AtSpeed>| {
        point.map_or((0.0, None), |point| (rpm(point.speed), Some(point.tooth_factor)))
    };
    pieces(points.map(place), f64::INFINITY)
}

/// The keys of the charts of the driver and of the driven gear.
pub const TOOTH_KEYS: [&str; 2] = ["tooth_compliance_driver", "tooth_compliance_driven"];

const MILLIMETRE: f64 = 1e-3;
/// The factor from um mm/N to m²/N.
const MICRON_MILLIMETRE: f64 = 1e-9;

/// The chart of the tooth compliance of a gear, the driver if `gear` is 0: first the finite
/// elements, which the models are compared with. A model without values has an empty curve.
///
/// # Errors
/// The reason if no model has a value.
pub fn tooth_chart(gear: usize, flanks: &Flanks, own: ToothCompliance) -> Result<Chart, String> {
    let (found, name) = (&flanks.gears[gear.min(1)], ["driver", "driven gear"][gear.min(1)]);
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 3);
    let remark = no_field(found).unwrap_or_else(|| "without contact".to_owned());
    let field = named(FIELD, own.name() == FIELD, Some(remark));
    let contact = format!("surface, contact half-width {half_width} mm");
    let mut all = vec![
        series(found, field, |point| point.field.map(|field| field.depth)),
        series(found, contact, |point| point.field.map(|field| field.surface)),
    ];
    for (at, &model) in flanks.models.iter().enumerate() {
        let gap = found.gaps.iter().find(|gap| gap.model == model);
        let is_empty = found.points.iter().all(|point| point.models[at].is_none());
        let missing = if is_empty { "no value" } else { "gaps" };
        let remark = gap.map(|gap| format!("{missing}: {}", gap.reason));
        all.push(series(found, named(model.name(), model == own, remark), |point| {
            point.models[at]
        }));
    }
    if found.points.is_empty() {
        return Err(format!("the {name} has no involute between form circle and tip"));
    }
    if all.iter().all(|series| series.pieces.is_empty()) {
        return Err(format!("no compliance model covers the {name}"));
    }
    Ok(Chart {
        title: format!("Tooth compliance of the {name}"),
        across: Axis::new("radius", "mm"),
        up: Axis::new(format!("Tooth compliance q of the {name}"), "um mm/N"),
        series: all,
        marks: vec![(found.pitch_radius / MILLIMETRE, "C")],
        ..Chart::default()
    })
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
