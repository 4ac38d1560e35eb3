//! Outcome, gauges and notes as sentences.

use std::collections::BTreeSet;

use super::gauges::{self, Gauge};
use super::limits;
use super::pane::Results;
use crate::model::{Quantity, Solution};
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

/// The faults, the outcome, the limits, the gauges and the notes in full, one per line.
#[must_use]
pub(crate) fn in_full(pane: &Results<'_>) -> Vec<String> {
    let faults = faults(pane);
    let of_answer = pane.answer.map(|answer| of_answer(pane, answer));
    let lines = faults.into_iter().chain(of_answer.into_iter().flatten());
    lines.flat_map(|line| [line, String::new()]).collect()
}

fn of_answer(pane: &Results<'_>, answer: &Answer) -> Vec<String> {
    let age = if pane.shows_last_valid { "LAST VALID: " } else { "" };
    let solution = answer.of(answer.active);
    let outcome = solution.map(|solution| format!("{age}{}", sentence(pane, solution)));
    let limits = solution.map(|solution| limits::sentences(pane, solution));
    let gauges = gauges::gauges(pane, answer).into_iter().map(Gauge::in_full);
    let notes = answer.notes.iter().map(|note| format!("{NOTE}{}.", note.message));
    outcome
        .into_iter()
        .chain(limits.into_iter().flatten())
        .chain(gauges)
        .chain(notes)
        .chain(refused_variants(pane))
        .collect()
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
