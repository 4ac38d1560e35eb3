//! The lines between outcome and table: methods with another outcome, the required relief, mesh
//! frequency and resonance, the spread of the stiffness models, the error of the printed equations.

use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity, Solution, Stage};
use crate::report;
use crate::report::comparison::differing;
use crate::report::whine::whine;
use crate::tui::ascii::symbol;
use crate::tui::panes::results::pane::Results;
use crate::tui::solver::Answer;

/// A statement in several lengths, from the full text to the shortest.
pub(super) struct Gauge(pub(super) Vec<String>);

impl Gauge {
    pub(super) fn fitting(&self, width: usize) -> String {
        let fits = self.0.iter().find(|words| words.chars().count() <= width);
        fits.or(self.0.last()).cloned().unwrap_or_default()
    }

    pub(super) fn in_full(self) -> String {
        self.0.into_iter().next().unwrap_or_default() + "."
    }
}

pub(super) fn gauges(pane: &Results<'_>, answer: &Answer) -> Vec<Gauge> {
    let Some(solution) = answer.of(answer.active) else {
        return Vec::new();
    };
    let ratios =
        (!solution.method.shares_load()).then(|| ratios(answer, pane.look.ascii)).flatten();
    // `paper` is not compared: it repeats `exact` with misprints.
    let others: Vec<&Solution> = (answer.methods.iter().rev())
        .filter(|(method, _)| *method != answer.active && *method != Method::Paper)
        .filter_map(|(_, found)| found.as_ref().ok())
        .collect();
    let differing = other_outcomes(answer, solution, &others);
    let relief = relief(pane, answer, solution, &others);
    let whine = whine(solution).map(|words| Gauge(words.into()));
    [differing, relief, whine, band(pane, solution), ratios].into_iter().flatten().collect()
}

// A slow method is not compared before its own result is present.
fn other_outcomes(answer: &Answer, solution: &Solution, others: &[&Solution]) -> Option<Gauge> {
    let found = differing(solution, others).filter(|_| answer.pending.is_none());
    found.map(|words| Gauge(words.into()))
}

// The required relief, or a placeholder while the worker computes it.
fn relief(
    pane: &Results<'_>,
    answer: &Answer,
    solution: &Solution,
    others: &[&Solution],
) -> Option<Gauge> {
    let (units, given) = (pane.units, answer.inputs.driven.tip_relief);
    let is_to_come = answer.strikes() && answer.lacks(Stage::Clearing);
    let pending = || report::relief::pending(solution.method, given, others, units);
    report::relief::relief(solution, others, units)
        .or_else(|| is_to_come.then(pending).flatten())
        .map(|words| Gauge(words.into()))
}

// The spread of the force over the stiffness models.
fn band(pane: &Results<'_>, solution: &Solution) -> Option<Gauge> {
    if solution.outcome == Outcome::NoCornerContact {
        return None;
    }
    let (band, force) = (solution.band?, solution.impact?.force);
    let percent = |end: f64| 100.0 * (end / force - 1.0) + 0.0;
    // In the unit of the force, with an additional digit if the unit needs it.
    let ends = || [band.low, band.high].into_iter();
    let (few, usual) = (Quantity::find("impact_force_low")?, Quantity::find("impact_force")?);
    let unit = report::common_unit(usual, ends().chain([force]), pane.units);
    let is_enough = report::common_unit(few, ends(), pane.units) == unit;
    let quantity = if is_enough { few } else { usual };
    let (low, high) = (
        report::shown_with(quantity, band.low, unit).number,
        report::shown_with(quantity, band.high, unit),
    );
    let parts = format!("{:+.1} to {:+.1} %", percent(band.low), percent(band.high));
    let (whose, force) = if solution.method.shares_load() {
        ("Free impact with other stiffness models", "free F_S")
    } else {
        ("Other stiffness models", "F_S")
    };
    Some(Gauge(vec![
        format!("{whose}: F_S {low} to {high} ({parts})"),
        format!("{whose}: F_S {parts}"),
        format!("Other stiffness: {force} {parts}"),
        format!("Models: {force} {parts}"),
        format!("Models: {parts}"),
    ]))
}

// The error of the printed equations, if both methods find a contact.
fn ratios(answer: &Answer, ascii: bool) -> Option<Gauge> {
    let (paper, exact) = (answer.of(Method::Paper)?, answer.of(Method::Exact)?);
    let ratio = |key| {
        let quantity = Quantity::find(key)?;
        let (paper, exact) = ((quantity.value)(paper)?, (quantity.value)(exact)?);
        let times = match answer.active {
            Method::Paper => times(exact / paper)?,
            _ => times(paper / exact)?,
        };
        Some((symbol(quantity.symbol, ascii), times))
    };
    let ((angle, of_angle), (force, of_force)) =
        (ratio("approach_angle_driver")?, ratio("impact_force")?);
    let (in_full, method) = match answer.active {
        Method::Paper => ("Method exact gives", "exact"),
        _ => ("The printed equations give", "paper"),
    };
    Some(Gauge(vec![
        format!("{in_full} {of_angle} this angle and {of_force} this force"),
        format!("{method}: {of_angle} {angle}, {of_force} {force}"),
        format!("{method}: {of_force} {force}"),
    ]))
}

// A ratio as a multiple, a fraction or a percentage.
fn times(ratio: f64) -> Option<String> {
    let line = match ratio {
        _ if !ratio.is_finite() || ratio <= 0.0 => return None,
        _ if ratio >= 2.0 => format!("{} times", rounded(ratio)),
        _ if ratio <= 0.5 => format!("1/{} of", rounded(1.0 / ratio)),
        _ => format!("{:.1} % of", 100.0 * ratio),
    };
    Some(line)
}

fn rounded(ratio: f64) -> String {
    let digits = usize::from(ratio < 10.0);
    format!("{ratio:.digits$}")
}
