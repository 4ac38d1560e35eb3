//! Faults, outcome, limits, figures and notes as sentences.

use std::collections::BTreeSet;

use ratatui::style::Style;

use super::Results;
use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity, Solution, Stage};
use crate::report;
use crate::report::digest::{self, differing, whine};
use crate::report::verdict::{Verdict, verdicts};
use crate::tui::ascii::symbol;
use crate::tui::keys::NEXT_FAULT;
use crate::tui::rows;
use crate::tui::solver::Answer;

/// A sentence with its style.
type Sentence = (String, Style);

/// The sentences that are always visible (the fault, or the outcome below the first limit that is
/// not met), and the others, the most important first.
pub(super) fn of(pane: &Results<'_>) -> (Vec<Sentence>, Vec<Sentence>) {
    let theme = pane.look.theme;
    let mut first: Vec<Sentence> =
        faults(pane).into_iter().zip([theme.problem, Style::new()]).collect();
    let Some(answer) = pane.answer else { return (first, Vec::new()) };
    let fresh = |style: Style| if pane.is_stale { theme.faint } else { style };
    let mut outcome = Vec::new();
    if let Some(solution) = answer.of(answer.active) {
        outcome.extend(warning(pane, solution).map(|warning| (warning, theme.problem)));
        outcome.push((sentence(pane, solution), fresh(theme.focus)));
    }
    let figures = figures(pane, answer).into_iter().map(|figure| (figure, fresh(Style::new())));
    let notes = notes(pane, answer).into_iter().map(|note| (note, fresh(theme.note)));
    if first.is_empty() {
        first.append(&mut outcome);
    }
    (first, outcome.into_iter().chain(figures).chain(notes).collect())
}

/// The faults, the outcome, the limits, the figures and the notes in full, one per line.
#[must_use]
pub(crate) fn in_full(pane: &Results<'_>) -> Vec<String> {
    let mut lines = faults(pane);
    if let Some(answer) = pane.answer {
        if let Some(solution) = answer.of(answer.active) {
            let age = if pane.shows_last_valid() { "LAST VALID: " } else { "" };
            lines.push(format!("{age}{}", sentence(pane, solution)));
            lines.extend(limits(pane, solution));
            if pane.case.limits.is_empty() {
                lines.push("No limits.".to_owned());
            }
        }
        lines.extend(figures(pane, answer).into_iter().map(|figure| figure + "."));
        lines.extend(notes(pane, answer));
    }
    lines.into_iter().flat_map(|line| [line, String::new()]).collect()
}

/// The outcome of a solve.
fn sentence(pane: &Results<'_>, solution: &Solution) -> String {
    symbol(&digest::sentence(solution, pane.units), pane.look.ascii).into_owned()
}

/// Why the results belong to an earlier state of the form: the cause, then the fix.
fn faults(pane: &Results<'_>) -> Vec<String> {
    let key = NEXT_FAULT;
    if let Some(refusal) = pane.refusal {
        return vec![
            format!("! Not solved: {refusal}."),
            format!("Correction: {} ({key}).", refusal.fix()),
        ];
    }
    let rows: BTreeSet<usize> = pane.problems.iter().map(|(row, _)| *row).collect();
    let Some((row, problem)) = pane.problems.iter().min_by_key(|(row, _)| *row) else {
        return Vec::new();
    };
    if rows.len() > 1 && rows.iter().all(|&row| rows::lacks(pane.case, row)) {
        return vec![format!("! {} required values are missing ({key})", rows.len())];
    }
    let name = [
        symbol(rows::symbol(pane.case, *row), pane.look.ascii).as_ref(),
        rows::label(pane.case, *row),
    ]
    .join(" ");
    let more = if rows.len() > 1 { format!("; {} more", rows.len() - 1) } else { String::new() };
    vec![format!("! {}: {}{more} ({key})", name.trim_start(), problem.cause)]
}

/// The notes on the answer, and one for each variant that the model refuses.
fn notes(pane: &Results<'_>, answer: &Answer) -> Vec<String> {
    let notes = answer.notes.iter().map(|note| format!("Note: {}.", note.message));
    let variants = pane.variants.into_iter().flat_map(|(variants, _)| &variants.columns);
    let refused = variants.filter_map(|(name, found)| {
        let reason = found.as_ref().err()?;
        Some(format!("Note: variant {name} is refused: {reason}."))
    });
    notes.chain(refused).collect()
}

/// The first limit that is not met, with the number of further ones.
fn warning(pane: &Results<'_>, solution: &Solution) -> Option<String> {
    let mut unmet = written(pane, solution).into_iter().filter(|verdict| !is_met(verdict));
    let (verdict, more) = (unmet.next()?, unmet.count());
    let (limit, limited) = (&verdict.limit.text, verdict.quantity);
    let above = |quantity: &Quantity, value| {
        let value = report::shown_in(quantity, value, pane.units);
        format!("{} {value} > {limit}", quantity.symbol)
    };
    let beside = verdict.beside.and_then(|beside| beside.own);
    let words = match (verdict.standing.holds(), verdict.value, beside) {
        (true, _, Some((own, Some(value)))) => {
            format!("{}, the limit of {}", above(own, value), limited.symbol)
        }
        (_, Some(value), _) => format!("{}, its limit", above(limited, value)),
        _ => format!("{} has no value; its limit is {limit}", limited.symbol),
    };
    let more = if more > 0 { format!("; {more} more") } else { String::new() };
    Some(symbol(&format!("! {words}{more}"), pane.look.ascii).into_owned())
}

fn written<'a>(pane: &Results<'a>, solution: &Solution) -> Vec<Verdict<'a>> {
    let mut verdicts = if pane.is_stale { Vec::new() } else { verdicts(pane.case, solution) };
    verdicts.retain(|verdict| !verdict.limit.text.is_empty());
    verdicts
}

/// The verdict on each limit; ! precedes a limit that is not met.
fn limits(pane: &Results<'_>, solution: &Solution) -> impl Iterator<Item = String> {
    written(pane, solution).into_iter().map(|verdict| {
        let sign = if is_met(&verdict) { "" } else { "! " };
        let sentence =
            format!("{sign}Limit {}: {}.", verdict.standing.word(), verdict.sentence(pane.units));
        symbol(&sentence, pane.look.ascii).into_owned()
    })
}

/// Whether the limit is met; also by the method's own quantity, unless that quantity has a limit.
fn is_met(verdict: &Verdict<'_>) -> bool {
    let is_own_limited = verdict.beside.is_some_and(|beside| beside.is_limited);
    verdict.standing.holds() && (is_own_limited || !verdict.is_exceeded_beside())
}

/// The figures beside the outcome: required relief, other methods, resonance, spread.
fn figures(pane: &Results<'_>, answer: &Answer) -> Vec<String> {
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
    let figures = [
        relief(pane, answer, solution),
        differing,
        whine(solution),
        band(pane, solution),
        ratios(answer),
    ];
    figures.into_iter().flatten().collect()
}

// The required relief, or a placeholder while the worker computes it.
fn relief(pane: &Results<'_>, answer: &Answer, solution: &Solution) -> Option<String> {
    let relief = digest::relief(solution, &[], pane.units);
    if relief.is_none() && answer.strikes() && answer.lacks(Stage::Clearing) {
        let given = answer.inputs.driven.tip_relief;
        return Some(digest::pending(solution.method, given, pane.units));
    }
    relief
}

// The spread of the force over the stiffness models.
fn band(pane: &Results<'_>, solution: &Solution) -> Option<String> {
    if solution.outcome == Outcome::NoCornerContact {
        return None;
    }
    let (band, force) = (solution.band?, solution.impact?.force);
    let quantity = Quantity::find("impact_force_low")?;
    let unit = report::common_unit(quantity, [band.low, band.high].into_iter(), pane.units);
    let [low, high] = [band.low, band.high].map(|end| report::shown_with(quantity, end, unit));
    let [less, more] = [band.low, band.high].map(|end| 100.0 * (end / force - 1.0) + 0.0);
    let whose = if solution.method.shares_load() {
        "Free impact with other stiffness models"
    } else {
        "Other stiffness models"
    };
    Some(format!("{whose}: F_S {} to {high} ({less:+.1} to {more:+.1} %)", low.number))
}

// The error of the printed equations, if both closed forms find a contact.
fn ratios(answer: &Answer) -> Option<String> {
    let (whose, of, other) = match answer.active {
        Method::Exact => ("The printed equations give", Method::Exact, Method::Paper),
        Method::Paper => ("Method exact gives", Method::Paper, Method::Exact),
        _ => return None,
    };
    let (own, other) = (answer.of(of)?, answer.of(other)?);
    let ratio = |key| {
        let quantity = Quantity::find(key)?;
        times((quantity.value)(other)? / (quantity.value)(own)?)
    };
    let (angle, force) = (ratio("approach_angle_driver")?, ratio("impact_force")?);
    Some(format!("{whose} {angle} this angle and {force} this force"))
}

// A ratio as a multiple, a fraction or a percentage.
fn times(ratio: f64) -> Option<String> {
    let rounded = |ratio: f64| format!("{ratio:.*}", usize::from(ratio < 10.0));
    match ratio {
        _ if !ratio.is_finite() || ratio <= 0.0 => None,
        _ if ratio >= 2.0 => Some(format!("{} times", rounded(ratio))),
        _ if ratio <= 0.5 => Some(format!("1/{} of", rounded(1.0 / ratio))),
        _ => Some(format!("{:.1} % of", 100.0 * ratio)),
    }
}
