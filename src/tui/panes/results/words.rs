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

/// The notes on the answer, and one for each variant that the model refuses.
pub(super) fn notes(pane: &Results<'_>, answer: &Answer) -> Vec<String> {
    let notes = answer.notes.iter().map(|note| format!("{NOTE}{}.", note.message));
    let variants = pane.variants.into_iter().flat_map(|variants| &variants.columns);
    let refused = variants.filter_map(|(name, found)| {
        let reason = found.as_ref().err()?;
        Some(format!("{NOTE}variant {name} is refused: {reason}."))
    });
    notes.chain(refused).collect()
}

pub(super) fn shown_in(pane: &Results<'_>, quantity: &Quantity, value: f64) -> Shown {
    report::shown_in(quantity, value, pane.units)
}

/// The first limit that is not met, with the number of further ones.
pub(super) fn limit_warning(pane: &Results<'_>, solution: &Solution) -> Option<String> {
    let unmet: Vec<Verdict<'_>> =
        written_verdicts(pane, solution).into_iter().filter(|verdict| !is_met(verdict)).collect();
    let words = verdict_words(pane, unmet.first()?);
    let more = match unmet.len() {
        1 => String::new(),
        count => format!("; {} more", count - 1),
    };
    Some(symbol(&format!("! {words}{more}"), pane.look.ascii).into_owned())
}

/// The figures beside the outcome: other methods, required relief, resonance, spread.
pub(super) fn figures(pane: &Results<'_>, answer: &Answer) -> Vec<String> {
    let Some(solution) = answer.of(answer.active) else {
        return Vec::new();
    };
    // `paper` is not compared: it repeats `exact` with misprints.
    let others: Vec<&Solution> = (answer.methods.iter().rev())
        .filter(|(method, _)| *method != answer.active && *method != Method::Paper)
        .filter_map(|(_, found)| found.as_ref().ok())
        .collect();
    // A slow method is not compared before its own result is present.
    let differing = differing(solution, &others).filter(|_| answer.pending.is_none());
    let ratios = if solution.method.shares_load() { None } else { ratios(answer) };
    let figures =
        [relief(pane, answer, solution), differing, whine(solution), band(pane, solution), ratios];
    figures.into_iter().flatten().collect()
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
    let figures = figures(pane, answer).into_iter().map(|figure| figure + ".");
    outcome
        .into_iter()
        .chain(limits.into_iter().flatten())
        .chain(figures)
        .chain(notes(pane, answer))
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

fn verdict_words(pane: &Results<'_>, verdict: &Verdict<'_>) -> String {
    let limit = &verdict.limit.text;
    let limited = verdict.quantity;
    let above = |quantity: &Quantity, value| {
        format!("{} {} > {limit}", quantity.symbol, shown_in(pane, quantity, value))
    };
    let beside = verdict.beside.and_then(|beside| beside.own);
    match (verdict.standing.holds(), verdict.value, beside) {
        (true, _, Some((own, Some(value)))) => {
            format!("{}, the limit of {}", above(own, value), limited.symbol)
        }
        (_, Some(value), _) => format!("{}, its limit", above(limited, value)),
        _ => format!("{} has no value; its limit is {limit}", limited.symbol),
    }
}

// The required relief, or a placeholder while the worker computes it.
fn relief(pane: &Results<'_>, answer: &Answer, solution: &Solution) -> Option<String> {
    let (units, given) = (pane.units, answer.inputs.driven.tip_relief);
    let is_to_come = answer.strikes() && answer.lacks(Stage::Clearing);
    let pending = || digest::pending(solution.method, given, units);
    // The table has the relief by the other methods.
    digest::relief(solution, &[], units).or_else(|| is_to_come.then(pending))
}

// The spread of the force over the stiffness models.
fn band(pane: &Results<'_>, solution: &Solution) -> Option<String> {
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
    let whose = if solution.method.shares_load() {
        "Free impact with other stiffness models"
    } else {
        "Other stiffness models"
    };
    Some(format!("{whose}: F_S {low} to {high} ({parts})"))
}

// The error of the printed equations, if both methods find a contact.
fn ratios(answer: &Answer) -> Option<String> {
    let (paper, exact) = (answer.of(Method::Paper)?, answer.of(Method::Exact)?);
    let ratio = |key| {
        let quantity = Quantity::find(key)?;
        let (paper, exact) = ((quantity.value)(paper)?, (quantity.value)(exact)?);
        times(if answer.active == Method::Paper { exact / paper } else { paper / exact })
    };
    let (of_angle, of_force) = (ratio("approach_angle_driver")?, ratio("impact_force")?);
    let which = if answer.active == Method::Paper {
        "Method exact gives"
    } else {
        "The printed equations give"
    };
    Some(format!("{which} {of_angle} this angle and {of_force} this force"))
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
