//! The limits of the case in the results: a warning above the table, and every verdict in full.

use super::pane::Results;
use crate::model::{Quantity, Solution};
use crate::report::shown_in;
use crate::report::verdict::{Verdict, verdicts};
use crate::tui::ascii::symbol;

/// The first limit that is not met, in two lengths, with the number of further ones.
pub(super) fn warning(pane: &Results<'_>, solution: &Solution) -> Option<Vec<String>> {
    let unmet: Vec<Verdict<'_>> =
        written(pane, solution).into_iter().filter(|verdict| !is_met(verdict)).collect();
    let words = unmet.first().and_then(|first| words(pane, first))?;
    let more = match unmet.len() {
        1 => String::new(),
        count => format!("; {} more", count - 1),
    };
    let lines = words.into_iter().map(|words| format!("! {words}{more}"));
    Some(lines.map(|line| symbol(&line, pane.look.ascii).into_owned()).collect())
}

/// The verdict on each limit as a sentence.
pub(super) fn sentences(pane: &Results<'_>, solution: &Solution) -> Vec<String> {
    if pane.is_stale {
        return Vec::new();
    }
    let verdicts = written(pane, solution);
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

fn written<'a>(pane: &Results<'a>, solution: &Solution) -> Vec<Verdict<'a>> {
    let mut verdicts = verdicts(pane.case, solution);
    verdicts.retain(|verdict| !verdict.limit.text.is_empty());
    verdicts
}

/// Whether the limit is met; also by the method's own quantity, unless that quantity has a limit.
fn is_met(verdict: &Verdict<'_>) -> bool {
    let is_own_limited = verdict.beside.is_some_and(|beside| beside.is_limited);
    verdict.standing.holds() && (is_own_limited || !verdict.is_exceeded_beside())
}

fn words(pane: &Results<'_>, verdict: &Verdict<'_>) -> Option<[String; 2]> {
    let limit = &verdict.limit.text;
    let limited = Quantity::find(verdict.limit.quantity)?;
    let shown = |quantity: &Quantity, value| shown_in(quantity, value, pane.units);
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
