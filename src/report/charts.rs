//! The charts of solved cases, and the table of pictures: every chart and the teeth.

use super::{Report, shown, shown_in, svg};
use crate::case::units;
use crate::case::units::System;
use crate::model::compliance::model_of;
use crate::model::face::FaceInputs;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::quantities::conditions::helical;
use crate::model::slices::load::LinePeak;
use crate::model::speeds::{AtSpeed, SpeedCurve};
use crate::model::static_load::Spectrum;
use crate::model::stations::Spacing;
use crate::model::{FaceLoad, Inputs, Quantity, Refusal, Solution, Station, contact_state};
use crate::numeric::decimal::significant;
use crate::report::chart::{Axis, Cell, Chart, Kind, Map, Point, Series, Span};
use crate::report::relief::{RELIEF, relief_chart, tolerances};
use crate::report::solve::{Part, Subject, Unsolved};
use crate::report::stations::{Column, GRAPHS, Graph};
use crate::report::table::Named;
use crate::study::stiffness::{FIELD, Flanks, GearComparison, Point as FlankPoint};
use std::f64::consts::PI;
use std::fmt;

/// The pictures that are not charts of [`GRAPHS`]; they follow those charts.
const OTHERS: [Picture; 7] = [
    Picture {
        is_on_page: false,
        ..of_one(TOOTH_KEYS[0], Part::Flanks, |cases, _| tooth(0, cases))
    },
    Picture {
        is_on_page: false,
        ..of_one(TOOTH_KEYS[1], Part::Flanks, |cases, _| tooth(1, cases))
    },
    Picture {
        is_of_one_case: false,
        ..of_one(SPECTRUM, Part::Stations, |cases, _| spectrum_chart(cases))
    },
    Picture { is_of_one_case: false, ..of_one(SPEED, Part::Speeds, speed) },
    of_one(RELIEF, Part::Stations, reliefs),
    of_one(PATTERN, Part::Stations, pattern),
    Picture { drawing: Drawing::Teeth, ..of_one(TEETH, Part::Stations, pattern) },
];

/// A picture of solved cases.
#[derive(Debug, Clone, Copy)]
pub struct Picture {
    /// The key, as in `plot --chart`.
    pub key: &'static str,
    /// The results that the picture shows.
    pub part: Part,
    /// Whether each case has a separate picture.
    pub is_of_one_case: bool,
    /// Whether the page of a report includes the picture.
    pub is_on_page: bool,
    drawing: Drawing,
}

/// The chart of solved cases.
type Draw = fn(&[NamedCase], System) -> Result<Chart, String>;

#[derive(Debug, Clone, Copy)]
enum Drawing {
    Graph(&'static Graph),
    Chart(Draw),
    Teeth,
}

const fn of_one(key: &'static str, part: Part, draw: Draw) -> Picture {
    let drawing = Drawing::Chart(draw);
    Picture { key, part, is_of_one_case: true, is_on_page: true, drawing }
}

fn first<'a>(cases: &[NamedCase<'a>]) -> Result<(&'a Subject, &'a Report), String> {
    let case = cases.first().map(|(_, case)| *case);
    case.and_then(|case| Some((case, case.own()?))).ok_or_else(|| "no case is solved".to_owned())
}

fn tooth(gear: usize, cases: &[NamedCase]) -> Result<Chart, String> {
    let (case, report) = first(cases)?;
    match &case.flanks {
        Some(Ok(flanks)) => tooth_chart(gear, flanks, model_of(&report.inputs)),
        Some(Err(refusal)) => Err(refusal.to_string()),
        None => Err("it is not computed".to_owned()),
    }
}

fn speed(cases: &[NamedCase], _: System) -> Result<Chart, String> {
    let named = cases.iter().filter_map(|(name, case)| Some((*name, case.speeds.as_ref()?)));
    speed_chart(&named.collect::<Vec<_>>())
}

fn reliefs(cases: &[NamedCase], _: System) -> Result<Chart, String> {
    let (_, report) = first(cases)?;
    let (reliefs, geometry) = (report.inputs.reliefs(), &report.solution.geometry);
    relief_chart(&reliefs, geometry, tolerances(&report.case))
}

fn pattern(cases: &[NamedCase], units: System) -> Result<Chart, String> {
    let (case, report) = first(cases)?;
    let solutions = case.reports.iter().map(|report| &report.solution);
    pattern_chart(&report.inputs, &solutions.collect::<Vec<_>>(), units)
}

/// Every picture: the charts of the stations, the charts with their own axes, the teeth.
pub fn pictures() -> impl Iterator<Item = Picture> + Clone {
    let graph = |graph: &'static Graph| Picture {
        key: graph.key,
        part: if graph.by_model.is_some() { Part::Path } else { Part::Stations },
        is_of_one_case: false,
        is_on_page: graph.is_on_page,
        drawing: Drawing::Graph(graph),
    };
    GRAPHS.iter().map(graph).chain(OTHERS)
}

/// The picture with a key.
pub fn find(key: &str) -> Option<Picture> {
    pictures().find(|picture| picture.key == key)
}

impl Picture {
    /// Draws solved cases with a caption; a picture of one case draws the first.
    ///
    /// # Errors
    /// The reason if no case has values for the picture.
    pub fn draw(self, cases: &[NamedCase], caption: &str, units: System) -> Result<String, String> {
        let chart = match self.drawing {
            Drawing::Graph(graph) => graph_chart(graph, cases)?,
            Drawing::Chart(chart) => chart(cases, units)?,
            Drawing::Teeth => {
                let (_, report) = first(cases)?;
                return Ok(svg::teeth(&report.inputs, &report.solution, caption, units));
            }
        };
        Ok(svg::draw(&chart.in_units(units), caption))
    }

    /// Solves a case and draws it. `go_on` receives the number of computed parts and their total,
    /// and stops the computation by returning false.
    ///
    /// # Errors
    /// Outside, the refusal of the model; inside, the reason why the case has no such picture.
    pub fn of_case(
        self,
        source: Unsolved<'_>,
        units: System,
        go_on: &dyn Fn(usize, usize) -> bool,
    ) -> Result<Result<String, String>, Refusal> {
        let fix = if self.part == Part::Speeds { "" } else { ": choose another chart" };
        let pair = Named { name: source.name, title: source.case.title() }.caption();
        let drawn = self.draw(&[("", &source.part(self.part, go_on)?)], &pair, units);
        Ok(drawn.map_err(|reason| format!("{self} has no curve: {reason}{fix}")))
    }
}

/// The name of the picture in a sentence.
impl fmt::Display for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.key {
            TEETH => f.write_str("the teeth"),
            key => write!(f, "the chart {key}"),
        }
    }
}

/// The unit of the roll angles, with its remark.
const ANGLE: &str = "deg; negative before E";

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
    let middle = if chart.marks.len() > 2 { " in mid-face" } else { "" };
    chart.across = Axis::new(format!("driver roll angle after E{middle}"), ANGLE);
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
    let (up, mut marks) = (axis_of(graph, column), marks(first));
    // Each of several cases has its own D.
    marks.retain(|(_, name)| cases.len() == 1 || *name == "E");
    Ok(Chart { up, series, marks, ..Chart::default() })
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
            let section = if helical(&report.inputs) { ", transverse section" } else { "" };
            let name = match *case {
                "" => format!("{}{is_own}{section}", model.name()),
                case => of(case, model.name()) + section,
            };
            // The model of a single case is the strong line.
            let place = if model == own && case.is_empty() { 0 } else { series.len() };
            series.insert(place, Series { name, pieces: vec![points], kind: Kind::Curve });
        }
    }
    let none = || absence.unwrap_or_else(|| "no compliance model covers the pair".to_owned());
    if series.is_empty() { Err(none()) } else { Ok(series) }
}

/// Marks at E and at the first contact D; of a helical pair also at the E of both ends of the face.
fn marks(Report { inputs, solution, .. }: &Report) -> Vec<(f64, &'static str)> {
    let start = contact_state::first_touch_of_driver(solution).map(|angle| (-angle, "D"));
    let pattern = Pattern::of(inputs, solution).filter(|own| own.face.lead != 0.0);
    let end = |sign: f64| pattern.as_ref().map(|own| -own.ahead(0.5 * sign * own.face.width));
    let ends =
        [end(1.0).map(|at| (at, "E z+")), Some((0.0, "E")), end(-1.0).map(|at| (at, "E z-"))];
    let start = start.filter(|(angle, _)| *angle < 0.0);
    let mut marks: Vec<_> = start.into_iter().chain(ends.into_iter().flatten()).collect();
    marks.sort_by(|one, other| one.0.total_cmp(&other.0));
    marks.into_iter().map(|(angle, name)| (angle.to_degrees(), name)).collect()
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
            let count = inputs.stations.unwrap_or(Spacing::LEAST).max(1) as f64;
            LEFT_OUT * position.approach_angle_driver.to_degrees() / count
        }
        _ => f64::INFINITY,
    }
}

/// The key of the picture of the teeth.
const TEETH: &str = "teeth";
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
        up: Axis::new("Dynamic factor", ""),
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
    let text = |key, value| Some(shown(Quantity::find(key)?, value).to_string());
    let peak = |peak: Option<&AtSpeed>| {
        let factor = text("resonance_peak_factor", peak?.tooth_factor)?;
        Some(format!(": peak {factor} at {}", text("resonance_peak_speed", peak?.speed)?))
    };
    let [rising, falling] = [curve.peak_rising(), curve.peak_falling()].map(peak);
    let falling = falling.filter(|falling| rising.as_ref() != Some(falling));
    let step = curve.speeds[1] - curve.speeds[0];
    let is_other = |near: &AtSpeed| {
        curve.peak_rising().is_none_or(|peak| (near.speed - peak.speed).abs() > step)
    };
    // The names of several cases leave no room for the peak.
    let peak_of = |peak: Option<String>| peak.filter(|_| name.is_empty()).unwrap_or_default();
    let called = |run: &str, peak: Option<String>| of(name, &(run.to_owned() + &peak_of(peak)));
    let jumps: Vec<AtSpeed> = curve.jumps().copied().collect();
    let is_jump = |point: &AtSpeed| jumps.iter().any(|jump| jump == point);
    let way = if jumps.is_empty() { "rising/falling" } else { "speed rising" };
    let down = curve.down.iter().map(|point| point.as_ref().filter(|point| is_jump(point)));
    // Several cases share the room of the legend.
    let fractions = [(1.0, "near N = 1"), (1.0 / 2.0, "near N = 1/2"), (1.0 / 3.0, "near N = 1/3")];
    let fractions = fractions.into_iter().take(if name.is_empty() { fractions.len() } else { 1 });
    let near = fractions.map(|(ratio, run)| {
        let found = curve.peak_near(ratio).filter(|near| is_other(near));
        let pieces = found.map(|near| vec![at(near)]).into_iter().collect();
        Series { name: called(run, peak(found)), pieces, kind: Kind::Marks(None) }
    });
    let all = [
        Series {
            name: called(way, rising),
            pieces: through(curve.up.iter().map(Option::as_ref), step, curve.peak_rising()),
            kind: Kind::Curve,
        },
        Series {
            name: called("speed falling", falling),
            pieces: through(down, step, curve.peak_falling()),
            kind: Kind::Curve,
        },
        Series {
            name: of(name, "contact lost"),
            pieces: lost(curve, &jumps),
            kind: Kind::Marks(None),
        },
    ];
    all.into_iter().chain(near).filter(|series| !series.pieces.is_empty()).collect()
}

/// Every fifth point with loss of contact, so that the curve between them is visible.
fn lost(curve: &SpeedCurve, jumps: &[AtSpeed]) -> Vec<Vec<Point>> {
    const STRIDE: usize = 5;
    let falling = curve.down.iter().flatten().filter(|point| jumps.contains(point));
    let points = curve.up.iter().flatten().chain(falling).filter(|point| point.contact_lost);
    let points = points.step_by(STRIDE);
    points.map(|point| vec![at(point)]).collect()
}

fn at(point: &AtSpeed) -> Point {
    (rpm(point.speed), point.tooth_factor)
}

/// Groups of neighbouring points of a run, through its peak, which is beside its greatest point.
fn through<'a>(
    run: impl Iterator<Item = Option<&'a AtSpeed>>,
    step: f64,
    peak: Option<&'a AtSpeed>,
) -> Vec<Vec<Point>> {
    const ROUNDING: f64 = 1e-6;
    let mut run: Vec<Option<&AtSpeed>> = run.collect();
    let factor = |point: Option<&AtSpeed>| point.map_or(0.0, |point| point.tooth_factor);
    let greatest =
        (0..run.len()).max_by(|one, other| factor(run[*one]).total_cmp(&factor(run[*other])));
    let greatest = greatest.and_then(|at| Some((at, run[at]?.speed)));
    if let (Some(peak), Some((at, speed))) = (peak, greatest) {
        let by = (peak.speed - speed) / step;
        if by != 0.0 && by.abs() < 1.0 + ROUNDING {
            run.insert(at + usize::from(by > 0.0), Some(peak));
        }
    }
    let place = |point: Option<&AtSpeed>| {
        point.map_or((0.0, None), |point| (rpm(point.speed), Some(point.tooth_factor)))
    };
    pieces(run.into_iter().map(place), f64::INFINITY)
}

/// The keys of the charts of the driver and of the driven gear.
pub const TOOTH_KEYS: [&str; 2] = ["tooth_compliance_driver", "tooth_compliance_driven"];

pub(super) const MILLIMETRE: f64 = 1e-3;
/// The factor from um mm/N to m²/N.
pub(super) const MICRON_MILLIMETRE: f64 = 1e-9;

/// The chart of the tooth compliance of a gear, the driver if `gear` is 0: first the finite
/// elements, which the models are compared with. A model without values has an empty curve.
///
/// # Errors
/// The reason if no model has a value.
pub fn tooth_chart(gear: usize, flanks: &Flanks, own: ToothCompliance) -> Result<Chart, String> {
    let (found, name) = (&flanks.gears[gear.min(1)], ["driver", "driven gear"][gear.min(1)]);
    let half_width = significant(flanks.contact_half_width / MILLIMETRE, 3);
    let remark = found.no_field().unwrap_or_else(|| "without contact".to_owned());
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

/// The key of the picture.
pub const PATTERN: &str = "contact_pattern";

/// Places of the map along the path of contact.
const COLUMNS: usize = 120;
/// Greatest number of pairs with a contact line: more of them hide the map.
const PAIRS: i32 = 8;

/// The line load of the incoming tooth over the plane of action.
#[derive(Debug, Clone)]
pub struct Pattern<'a> {
    load: &'a FaceLoad,
    /// Whether it is the load in motion, not at rest.
    is_moving: bool,
    face: FaceInputs,
    /// Length of the path of contact and base pitch, in m.
    length: f64,
    base_pitch: f64,
    /// Base radius of the driver, in m.
    radius: f64,
    /// z of each slice, in m.
    places: Vec<f64>,
}

impl<'a> Pattern<'a> {
    /// The pattern of a solution that has slices.
    pub fn of(inputs: &Inputs, solution: &'a Solution) -> Option<Pattern<'a>> {
        let motion = solution.face_motion.as_deref();
        let (load, face) = (motion.or(solution.face_load.as_deref())?, inputs.face()?);
        let geometry = &solution.geometry;
        let places = face.places(face.count(geometry.base_pitch));
        let is_whole = load.pattern.iter().all(|row| row.len() == places.len());
        is_whole.then(|| Pattern {
            load,
            is_moving: motion.is_some(),
            face,
            length: geometry.end - geometry.start,
            base_pitch: geometry.base_pitch,
            radius: geometry.driver.base,
            places,
        })
    }

    /// The driver's roll angles in the middle of the face, counted from E against the rotation, in rad,
    /// z of the slices, in m, and the line load at each angle and slice, in N/m.
    pub fn grid(&self) -> (Vec<f64>, &[f64], impl Iterator<Item = f64>) {
        let angles = self.load.paths.iter().map(|path| 0.0 - path / self.radius).collect();
        (angles, &self.places, self.load.pattern.iter().flatten().copied())
    }

    /// The driver's angle by which the slice at z is ahead of the middle of the face, in rad.
    pub fn ahead(&self, z: f64) -> f64 {
        self.face.lead * z / self.radius
    }

    /// Gap of the unloaded flanks at z by misalignment and flank lines, in m.
    pub fn gap(&self, z: f64) -> f64 {
        self.face.gap(z)
    }

    /// The driver's angle after E of the tooth in the plane at z, in rad, from its first to its last
    /// contact.
    pub fn span(&self) -> Span {
        let [first, last] = [&self.load.first, &self.load.last].map(|place| place.path);
        Span::new(0.0, self.length).with(first).with(last).scaled(1.0 / self.radius)
    }

    /// z of the slice `by` slices from the one at z, in m.
    pub fn beside(&self, z: f64, by: isize) -> f64 {
        let at = super::chart::nearest(&self.places, z).saturating_add_signed(by);
        self.places[at.min(self.places.len() - 1)]
    }

    /// The line load of the incoming tooth at a driver's angle after E in the plane of the slice
    /// nearest to z, in N/m.
    pub fn line_load(&self, angle: f64, z: f64) -> f64 {
        let slice = super::chart::nearest(&self.places, z);
        let s = angle * self.radius - self.face.lead * self.places[slice];
        let paths = &self.load.paths;
        let after = paths.partition_point(|path| *path < s);
        let Some(before) = after.checked_sub(1).filter(|_| after < paths.len()) else { return 0.0 };
        let [one, next] = [before, after].map(|row| self.load.pattern[row][slice]);
        one + (next - one) * (s - paths[before]) / (paths[after] - paths[before])
    }

    /// The driver's angle after E in the middle of the face at the greatest line load before E, or at
    /// the greatest line load of the tooth, in rad.
    pub fn at_peak(&self) -> f64 {
        self.in_mid_face(self.load.before_start.unwrap_or(self.load.peak))
    }

    /// The driver's angle after E in the middle of the face at the greatest line load in a range of the
    /// angle in each plane, or of the tooth, in rad, and z of this load, in m.
    pub fn greatest(&self, window: Span) -> (f64, f64) {
        let all = [Some(self.load.peak), self.load.before_start, self.load.after_end];
        let angle = |peak: &LinePeak| peak.place.path / self.radius;
        let is_inside = |peak: &LinePeak| window.covers(Span::new(angle(peak), angle(peak)));
        let peak = all.into_iter().flatten().find(is_inside).unwrap_or(self.load.peak);
        (self.in_mid_face(peak), peak.place.z)
    }

    fn in_mid_face(&self, peak: LinePeak) -> f64 {
        peak.place.path / self.radius - self.ahead(peak.place.z)
    }

    /// The pattern in a range of the driver's angle after E in each plane, in deg, with the contact
    /// lines at an angle of the middle of the face, in rad.
    pub fn chart(&self, angle: f64, window: Span, system: System) -> Chart {
        let unit = system.unit("mm");
        let height = |z: f64| units::per(z, unit);
        let step = window.length() / COLUMNS as f64;
        let across: Vec<f64> = (0..=COLUMNS).map(|at| window.from + at as f64 * step).collect();
        let loads = self
            .places
            .iter()
            .flat_map(|z| across.iter().map(|angle| self.line_load(angle.to_radians(), *z)));
        let cell = |load: f64| if load > 0.0 { Cell::Value(load) } else { Cell::Blank };
        let cells = loads.map(cell).collect();
        let words = |load: f64| {
            let known = Quantity::find("static_peak_line_load");
            known.map_or_else(String::new, |known| shown_in(known, load, system).to_string())
        };
        let ends = [0.0, self.load.peak.line_load].map(|load| (load, words(load)));
        let degrees = |path: f64| (path / self.radius).to_degrees();
        let peak = |peak: LinePeak| (degrees(peak.place.path), height(peak.place.z));
        let peaks = [Some(self.load.peak), self.load.before_start, self.load.after_end];
        let mut peaks: Vec<Point> = peaks.into_iter().flatten().map(peak).collect();
        peaks.dedup();
        let lines = |is_outside: bool| {
            let lines = self.lines(angle * self.radius, is_outside);
            let line = |line: [Point; 2]| line.map(|(path, z)| (degrees(path), height(z))).to_vec();
            let name = match self.pairs(angle * self.radius).1 {
                _ if is_outside => "outside E to B".to_owned(),
                1 => "contact lines".to_owned(),
                every => format!("1 in {every} contact lines"),
            };
            Series { name, pieces: lines.into_iter().map(line).collect(), kind: Kind::Curve }
        };
        // No line joins the peaks.
        let pieces = peaks.into_iter().map(|peak| vec![peak]).collect();
        let peaks = Series { name: "peaks".to_owned(), pieces, kind: Kind::Marks(None) };
        let state = if self.is_moving { "in motion" } else { "at rest" };
        let is_drawn = |series: &Series| !series.pieces.is_empty();
        Chart {
            title: format!("Contact pattern: line load of the tooth {state}"),
            across: Axis::new("driver roll angle after E in each plane", ANGLE),
            up: Axis::new("z", unit),
            series: [lines(false), lines(true), peaks].into_iter().filter(is_drawn).collect(),
            marks: vec![(0.0, "E"), (degrees(self.length), "B")],
            map: Some(Map {
                value: Axis::new(format!("Line load {state}"), system.unit("N/mm")),
                places: [across, self.places.iter().map(|z| height(*z)).collect()],
                cells,
                ends: Some(ends),
                limit: None,
            }),
        }
    }

    /// The contact lines with the incoming pair at a path s in the middle of the face: the parts from
    /// E to B, or those outside as far as the tooth touches anywhere, as paths and z, in m.
    fn lines(&self, s: f64, is_outside: bool) -> Vec<[Point; 2]> {
        let (half, span) = (0.5 * self.face.width, self.span().scaled(self.radius));
        let of_pair = |pair: i32| {
            let path = move |z: f64| s + f64::from(pair) * self.base_pitch + self.face.lead * z;
            let z = |to: f64| (to - path(0.0)) / self.face.lead;
            let borders = [span.from, 0.0, self.length, span.to].map(z);
            let inner = borders.into_iter().filter(|z| z.abs() < half);
            let mut ends: Vec<f64> = inner.chain([-half, half]).collect();
            ends.sort_by(f64::total_cmp);
            let parts: Vec<[f64; 2]> = ends.windows(2).map(|ends| [ends[0], ends[1]]).collect();
            let is_drawn = move |[from, to]: &[f64; 2]| {
                let middle = path(f64::midpoint(*from, *to));
                let is_inside = (0.0..=self.length).contains(&middle);
                is_inside != is_outside && (span.from..=span.to).contains(&middle)
            };
            parts.into_iter().filter(is_drawn).map(move |part| part.map(|z| (path(z), z)))
        };
        self.pairs(s).0.into_iter().flat_map(of_pair).collect()
    }

    /// The pairs whose contact line is drawn, one in how many of them.
    fn pairs(&self, s: f64) -> (Vec<i32>, i32) {
        let span = self.span().scaled(self.radius);
        let reach = 0.5 * self.face.width * self.face.lead.abs();
        let [first, last] =
            [span.from - reach, span.to + reach].map(|to| (to - s) / self.base_pitch);
        let (first, last) = (first.ceil() as i32, last.floor() as i32);
        let every = ((last - first) / PAIRS + 1).max(1);
        ((first..=last).filter(|pair| pair.rem_euclid(every) == 0).collect(), every)
    }
}

/// The contact pattern at the greatest line load before E.
///
/// # Errors
/// The reason if the pair has no slices, or the method no line load.
pub fn pattern_chart(
    inputs: &Inputs,
    solutions: &[&Solution],
    units: System,
) -> Result<Chart, String> {
    let found = solutions.iter().find_map(|solution| Pattern::of(inputs, solution));
    match (found, inputs.face()) {
        (Some(pattern), _) => {
            let window = pattern.span().scaled(1f64.to_degrees());
            Ok(pattern.chart(pattern.at_peak(), window, units))
        }
        (None, Some(_)) => Err("no method computed the line load of the pair".to_owned()),
        (None, None) => {
            Err("a spur pair without misalignment and flank line modification has the \
            same load all over its face"
                .to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::examples::Example;
    use crate::model::{Stage, Stages, solve};

    #[test]
    fn every_picture_has_a_key_of_its_own() {
        let keys: Vec<&str> = pictures().map(|picture| picture.key).collect();
        for (at, key) in keys.iter().enumerate() {
            assert_eq!(keys.iter().position(|other| other == key), Some(at), "{key}");
            assert_eq!(find(key).map(|picture| picture.key), Some(*key));
        }
        assert!(["force", "spectrum", "speed", "teeth"].iter().all(|key| keys.contains(key)));
    }

    fn pieces_of(points: &[(f64, Option<f64>)]) -> Vec<Vec<Point>> {
        pieces(points.iter().copied(), 1.5)
    }

    #[test]
    fn a_curve_over_speed_passes_through_its_peak_on_the_side_of_its_branch() {
        let at = |speed: f64, tooth_factor| AtSpeed {
            speed,
            ratio: 1.0,
            tooth_factor,
            peak_to_peak: 0.0,
            contact_lost: false,
        };
        let run = [at(1.0, 1.0), at(2.0, 5.0), at(3.0, 2.0)];
        for (peak, place) in [(at(1.0, 6.0), 1), (at(1.5, 6.0), 1), (at(3.0, 6.0), 2)] {
            let found = &through(run.iter().map(Some), 1.0, Some(&peak))[0];
            assert_eq!((found.len(), found[place].1), (4, 6.0), "{found:?}");
        }
        let behind_gap = [None, Some(&run[1]), None];
        let found = through(behind_gap.into_iter(), 1.0, Some(&at(1.0, 6.0)));
        assert_eq!(found, [vec![(rpm(1.0), 6.0), (rpm(2.0), 5.0)]]);
        assert_eq!(through(run.iter().map(Some), 1.0, Some(&run[1]))[0].len(), 3);
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

    #[test]
    fn the_load_is_on_the_contact_lines_and_the_parts_outside_e_and_b_are_apart() {
        let case = Example::find("helical-20-35").unwrap().document().case;
        let inputs = case.inputs().unwrap();
        let solution = solve(&inputs, Stages::of(Stage::Static)).unwrap();
        let pattern = Pattern::of(&inputs, &solution).unwrap();
        let load = solution.face_load.as_ref().unwrap();
        let peak = load.peak;
        let found = pattern.line_load(peak.place.path / pattern.radius, peak.place.z);
        assert!((found / peak.line_load - 1.0).abs() < 0.05, "{found} {peak:?}");
        for (is_outside, span) in [(false, Span::new(0.0, pattern.length)), (true, pattern.span())]
        {
            let all = (0..20).flat_map(|at| {
                pattern.lines(pattern.base_pitch * f64::from(at) / 20.0, is_outside)
            });
            let all: Vec<_> = all.collect();
            assert!(!all.is_empty());
            let rounding = 1e-9;
            let is_inside = |x: f64| x > -rounding && x < pattern.length + rounding;
            for ends in &all {
                assert!(
                    ends.iter().all(|(x, z)| z.abs() <= 0.5 * pattern.face.width + rounding
                        && (is_outside || is_inside(*x))),
                    "{ends:?} {span:?}"
                );
                let middle = f64::midpoint(ends[0].0, ends[1].0);
                assert_eq!(is_inside(middle), !is_outside);
            }
        }
        let spur = Example::find("zhou-chen-2014").unwrap().document().case.inputs().unwrap();
        assert!(pattern_chart(&spur, &[], System::Metric).is_err());
    }
}
