//! Outcome, limits, gauges and notes as sentences.

use std::collections::BTreeSet;

use super::Results;
use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity, Solution, Stage};
use crate::report::digest::differing;
use crate::report::digest::whine;
use crate::report::verdict::{Verdict, verdicts};
use crate::report::{self, Shown, digest};
use crate::tui::ascii::symbol;
use crate::tui::rows;
use crate::tui::solver::Answer;

/// Prefix of a note.
pub(super) const NOTE: &str = "Note: ";

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

/// The outcome of a solve as a sentence.
#[must_use]
pub(crate) fn sentence(pane: &Results<'_>, solution: &Solution) -> String {
    let sentence = digest::sentence(solution, pane.units);
    symbol(&sentence, pane.look.ascii).into_owned()
}

/// Why the results belong to an earlier state of the form: the cause, then the fix.
pub(super) fn faults(pane: &Results<'_>) -> Vec<String> {
    match pane.refusal {
        Some(refusal) => vec![
            format!("! Not solved: {refusal}."),
            format!("Correction: {} ({}).", refusal.fix(), (pane.next_fault)()),
        ],
        None => wrong(pane).into_iter().collect(),
    }
}

/// The faults, the outcome, the limits, the gauges and the notes in full, one per line.
#[must_use]
pub(crate) fn in_full(pane: &Results<'_>) -> Vec<String> {
    let faults = faults(pane);
    let of_answer = pane.answer.map(|answer| of_answer(pane, answer));
    let lines = faults.into_iter().chain(of_answer.into_iter().flatten());
    lines.flat_map(|line| [line, String::new()]).collect()
}

/// One line for each variant that the model refuses.
pub(super) fn refused_variants<'a>(pane: &Results<'a>) -> impl Iterator<Item = String> + use<'a> {
    let columns = pane.variants.into_iter().flat_map(|variants| &variants.columns);
    columns.filter_map(|(name, found)| {
        let reason = found.as_ref().err()?;
        Some(format!("{NOTE}variant {name} is refused: {reason}."))
    })
}

pub(super) fn shown_in(pane: &Results<'_>, quantity: &Quantity, value: f64) -> Shown {
    report::shown_in(quantity, value, pane.units)
}

/// The first limit that is not met, in two lengths, with the number of further ones.
pub(super) fn limit_warning(pane: &Results<'_>, solution: &Solution) -> Option<Vec<String>> {
    let unmet: Vec<Verdict<'_>> =
        written_verdicts(pane, solution).into_iter().filter(|verdict| !is_met(verdict)).collect();
    let words = unmet.first().and_then(|first| verdict_words(pane, first))?;
    let more = match unmet.len() {
        1 => String::new(),
        count => format!("; {} more", count - 1),
    };
    let lines = words.into_iter().map(|words| format!("! {words}{more}"));
    Some(lines.map(|line| symbol(&line, pane.look.ascii).into_owned()).collect())
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

// The first invalid field in the order of the form with its cause, the number of further ones, and
// the key that goes there.
fn wrong(pane: &Results<'_>) -> Option<String> {
    let (row, problem) = pane.problems.iter().min_by_key(|(row, _)| *row)?;
    let name = format!(
        "{} {}",
        symbol(rows::symbol(pane.case, *row), pane.look.ascii),
        rows::label(pane.case, *row)
    );
    let fields: BTreeSet<usize> = pane.problems.iter().map(|(row, _)| *row).collect();
    let more =
        if fields.len() > 1 { format!("; {} more", fields.len() - 1) } else { String::new() };
    let key = (pane.next_fault)();
    if let Some(missing) = pane.missing.filter(|&missing| missing > 1) {
        return Some(format!("! {missing} required values are missing ({key})"));
    }
    Some(format!("! {}: {}{more} ({key})", name.trim_start(), problem.cause))
}

fn of_answer(pane: &Results<'_>, answer: &Answer) -> Vec<String> {
    let age = if pane.shows_last_valid { "LAST VALID: " } else { "" };
    let solution = answer.of(answer.active);
    let outcome = solution.map(|solution| format!("{age}{}", sentence(pane, solution)));
    let limits = solution.map(|solution| limit_sentences(pane, solution));
    let gauges = gauges(pane, answer).into_iter().map(Gauge::in_full);
    let notes = answer.notes.iter().map(|note| format!("{NOTE}{}.", note.message));
    outcome
        .into_iter()
        .chain(limits.into_iter().flatten())
        .chain(gauges)
        .chain(notes)
        .chain(refused_variants(pane))
        .collect()
}

/// The verdict on each limit as a sentence.
fn limit_sentences(pane: &Results<'_>, solution: &Solution) -> Vec<String> {
    if pane.is_stale {
        return Vec::new();
    }
    let verdicts = written_verdicts(pane, solution);
    if verdicts.is_empty() {
        return vec!["No limits.".to_owned()];
    }
    let sentence = |verdict: &Verdict<'_>| {
        let sign = if is_met(verdict) { "" } else { "! " };
        let (word, sentence) = (verdict.standing.word(), verdict.sentence(pane.units));
        format!("{sign}Limit {word}: {sentence}.")
    };
    verdicts.iter().map(sentence).collect()
}

fn written_verdicts<'a>(pane: &Results<'a>, solution: &Solution) -> Vec<Verdict<'a>> {
    let mut verdicts = verdicts(pane.case, solution);
    verdicts.retain(|verdict| !verdict.limit.text.is_empty());
    verdicts
}

/// Whether the limit is met; also by the method's own quantity, unless that quantity has a limit.
fn is_met(verdict: &Verdict<'_>) -> bool {
    let is_own_limited = verdict.beside.is_some_and(|beside| beside.is_limited);
    verdict.standing.holds() && (is_own_limited || !verdict.is_exceeded_beside())
}

fn verdict_words(pane: &Results<'_>, verdict: &Verdict<'_>) -> Option<[String; 2]> {
    let limit = &verdict.limit.text;
    let limited = Quantity::find(verdict.limit.quantity)?;
    let shown = |quantity: &Quantity, value| report::shown_in(quantity, value, pane.units);
    let beside = verdict.beside.and_then(|beside| beside.own);
    Some(match (verdict.standing.holds(), verdict.value, beside) {
        (true, _, Some((key, Some(value)))) => {
            let own = Quantity::find(key)?;
            let short = format!("{} {} > {limit}", own.symbol, shown(own, value));
            [format!("{short}, the limit of {}", limited.symbol), short]
        }
        (_, Some(value), _) => {
            let short = format!("{} {} > {limit}", limited.symbol, shown(limited, value));
            [format!("{short}, its limit"), short]
        }
        _ => [
            format!("{} has no value; its limit is {limit}", limited.symbol),
            format!("{} has no value", limited.symbol),
        ],
    })
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
    let pending = || digest::pending(solution.method, given, others, units);
    digest::relief(solution, others, units)
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
