//! The charts of whine: harmonics of the transmission error, dynamic factor over speed.

use std::f64::consts::PI;

use super::rounded;
use crate::model::Solution;
use crate::model::dynamic::speeds::{AtSpeed, SpeedCurve};
use crate::model::static_spectrum::Spectrum;
use crate::numeric::decimal::significant;
use crate::report::Report;
use crate::report::charts::SolvedCase;
use crate::report::svg::{Chart, Kind, Labelled, Series, chart};

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
            [(_, only)] => marks(only),
            _ => Vec::new(),
        },
    })
}

/// The resonance with its fractions, and the speed of the case.
fn marks(curve: &SpeedCurve) -> Vec<(f64, &'static str)> {
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
    let up =
        Series { name: up, pieces: pieces(curve.up.iter().map(Option::as_ref)), kind: Kind::Curve };
    let down = curve.down.iter().map(|point| point.as_ref().filter(|point| is_jump(point)));
    let down = Series {
        name: called("speed falling", curve.peak_falling()),
        pieces: pieces(down),
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
        let points = pieces(run.iter().map(|point| point.as_ref().filter(is_lost)));
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
fn pieces<'a>(points: impl Iterator<Item = Option<&'a AtSpeed>>) -> Vec<Vec<(f64, f64)>> {
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
