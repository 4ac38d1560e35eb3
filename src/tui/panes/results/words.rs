//! Outcome, gauges and notes in words.

use super::gauges::{self, Gauge};
use super::pane::Results;
use crate::model::{Quantity, Solution};
use crate::report::{self, Shown, digest};
use crate::tui::ascii::symbol;

/// Stands before a note.
pub(super) const NOTE: &str = "Note: ";

/// The outcome of a solve, in a sentence.
#[must_use]
pub(crate) fn sentence(pane: &Results<'_>, solution: &Solution) -> String {
    let sentence = digest::sentence(solution, pane.units);
    symbol(&sentence, pane.look.ascii).into_owned()
}

/// The outcome, the gauges and the notes in full, a line each.
#[must_use]
pub(crate) fn in_full(pane: &Results<'_>) -> Vec<String> {
    let Some(answer) = pane.answer else {
        return Vec::new();
    };
    let outcome = answer
        .of(answer.active)
        .map(|solution| sentence(pane, solution));
    let gauges = gauges::gauges(pane, answer).into_iter().map(Gauge::in_full);
    let notes = answer
        .notes
        .iter()
        .map(|note| format!("{NOTE}{}.", note.message));
    let lines = outcome
        .into_iter()
        .chain(gauges)
        .chain(notes)
        .chain(refused_variants(pane));
    lines.flat_map(|line| [line, String::new()]).collect()
}

/// A line for each variant that the model refuses.
pub(super) fn refused_variants<'a>(pane: &Results<'a>) -> impl Iterator<Item = String> + use<'a> {
    let columns = pane
        .variants
        .into_iter()
        .flat_map(|variants| &variants.columns);
    columns.filter_map(|(name, found)| {
        let reason = found.as_ref().err()?;
        Some(format!("{NOTE}variant {name} is refused: {reason}."))
    })
}

pub(super) fn shown_in(pane: &Results<'_>, quantity: &Quantity, value: f64) -> Shown {
    report::shown_in(quantity, value, pane.units)
}
