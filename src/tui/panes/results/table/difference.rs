//! The difference of a quantity from the baseline.

use super::value;
use crate::case::units::system::counted;
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report;
use crate::report::difference::{UNCHANGED, in_percent, is_unchanged, percent};
use crate::tui::panes::results::pane::Results;
use crate::tui::panes::results::words::shown_in;
use crate::tui::solver::Answer;

/// Columns of a difference.
pub(super) const WIDTH: usize = UNCHANGED.len();

// The difference of the active method's value from the baseline by the same method: in percent, or
// the value of the baseline.
pub(super) fn difference(
    pane: &Results<'_>,
    answer: &Answer,
    quantity: &Quantity,
    unit: &str,
    room: usize,
) -> String {
    let now = value(answer, answer.active, quantity);
    match (now, base(pane, answer, quantity).and_then(|(_, base)| base)) {
        (Some(now), Some(base)) => {
            against(quantity, now, base).unwrap_or_else(|| was(base, unit, room))
        }
        (Some(_), None) => "was none".to_owned(),
        (None, Some(base)) => was(base, unit, room),
        (None, None) => String::new(),
    }
}

// The value of the baseline in the unit of the line, with as many digits as fit.
fn was(base: f64, unit: &str, room: usize) -> String {
    let words = (1..=3).rev().map(|digits| format!("was {}", counted(base, unit, digits)));
    words.into_iter().find(|words| words.len() <= room).unwrap_or_else(|| "was other".to_owned())
}

/// The value of the quantity and the value of the baseline, with the method of the baseline if it
/// differs.
pub(in crate::tui::panes::results) fn compared(
    pane: &Results<'_>,
    answer: &Answer,
    quantity: &Quantity,
) -> Option<String> {
    let (method, base) = base(pane, answer, quantity)?;
    let printed = |value: Option<f64>| {
        value.map_or_else(|| "none".to_owned(), |value| shown_in(pane, quantity, value).to_string())
    };
    let whose =
        if method == answer.active { String::new() } else { format!(" ({})", method.name()) };
    Some(format!(
        "{}; baseline{whose}: {}.",
        printed(value(answer, answer.active, quantity)),
        printed(base)
    ))
}

// The method and the value of the baseline.
fn base(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> Option<(Method, Option<f64>)> {
    let base = &pane.baseline?.answer;
    let method = base.beside(answer.active);
    Some((method, report::value_as_in(quantity, base.of(method)?, answer.active)))
}

// The difference in percent, if a percentage has a meaning.
fn against(quantity: &Quantity, now: f64, base: f64) -> Option<String> {
    if is_unchanged(now, base) {
        return Some(UNCHANGED.to_owned());
    }
    percent(quantity, now, base).map(in_percent)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_many_times_the_baseline_or_that_may_be_negative_shows_the_baseline() {
        let force = Quantity::find("impact_force").expect("a quantity");
        for (now, base, worded) in [
            (1.0, 0.0, "was 0"),
            (18.0, 0.0169, "was 0.017"),
            (1e9, 1.0, "was 1.00"),
            (500.0, 47.3, "was 47.3"),
        ] {
            assert_eq!(against(force, now, base), None, "{now} {base}");
            assert_eq!(was(base, "1", WIDTH), worded);
        }
        let deviation = Quantity::find("total_deviation").expect("a quantity");
        assert_eq!(against(deviation, 2e-6, 1e-6), None);
        assert_eq!(against(force, 2.0, 2.0).as_deref(), Some(UNCHANGED));
    }
}
