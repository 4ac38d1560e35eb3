//! The difference of a quantity from the baseline.

use super::value;
use crate::case::units::system::counted;
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report;
use crate::tui::panes::results::Results;
use crate::tui::panes::results::shown_in;
use crate::tui::solver::Answer;

/// Below this part of the baseline a difference is rounding.
const NO_DIFFERENCE: f64 = 5e-6;
/// A value as in the baseline.
const UNCHANGED: &str = "unchanged";
/// Columns of a difference.
pub(super) const WIDTH: usize = UNCHANGED.len();

// The active method's value against the same method's of the baseline, in percent, or the value of
// the baseline.
pub(super) fn difference(
    pane: &Results<'_>,
    answer: &Answer,
    quantity: &Quantity,
    unit: &str,
    room: usize,
) -> String {
    let now = value(answer, answer.active, quantity);
    match (now, base(pane, answer, quantity).and_then(|(_, base)| base)) {
        (Some(now), Some(base)) => against(now, base).unwrap_or_else(|| was(base, unit, room)),
        (Some(_), None) => "was none".to_owned(),
        (None, Some(base)) => was(base, unit, room),
        (None, None) => String::new(),
    }
}

// What the baseline's value was, in the unit of the line, with as many digits as have room.
fn was(base: f64, unit: &str, room: usize) -> String {
    let words = (1..=3)
        .rev()
        .map(|digits| format!("was {}", counted(base, unit, digits)));
    words
        .into_iter()
        .find(|words| words.len() <= room)
        .unwrap_or_else(|| "was other".to_owned())
}

/// The quantity's value and that of the baseline, with the method of the latter where it is
/// another.
pub(in crate::tui::panes::results) fn compared(
    pane: &Results<'_>,
    answer: &Answer,
    quantity: &Quantity,
) -> Option<String> {
    let (method, base) = base(pane, answer, quantity)?;
    let printed = |value: Option<f64>| {
        value.map_or_else(
            || "none".to_owned(),
            |value| shown_in(pane, quantity, value).to_string(),
        )
    };
    let whose = if method == answer.active {
        String::new()
    } else {
        format!(" ({})", method.name())
    };
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
    Some((
        method,
        report::value_as_in(quantity, base.of(method)?, answer.active),
    ))
}

// In percent, unless the value is more than so many times the baseline's.
fn against(now: f64, base: f64) -> Option<String> {
    const MOST_TIMES: f64 = 10.0;
    let part = (now - base) / base.abs();
    if now.to_bits() == base.to_bits() || part.abs() < NO_DIFFERENCE {
        return Some(UNCHANGED.to_owned());
    }
    if !part.is_finite() || now.abs() > MOST_TIMES * base.abs() {
        return None;
    }
    let percent = 100.0 * part;
    Some(match percent.abs() {
        size if size >= 100.0 => format!("{percent:+.0} %"),
        size if size >= 1.0 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.3} %"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_difference_is_in_percent_of_the_baseline_and_fits() {
        for (now, base, expected) in [
            (110.0, 100.0, "+10.0 %"),
            (99.99, 100.0, "-0.010 %"),
            (-2.0, -1.0, "-100 %"),
            (1.0, 1.0, UNCHANGED),
            (0.0, 0.0, UNCHANGED),
        ] {
            assert_eq!(
                against(now, base).as_deref(),
                Some(expected),
                "{now} {base}"
            );
            assert!(expected.len() <= WIDTH);
        }
    }

    #[test]
    fn a_value_many_times_the_baseline_shows_the_baseline() {
        for (now, base, expected) in [
            (1.0, 0.0, "was 0"),
            (18.0, 0.0169, "was 0.017"),
            (1e9, 1.0, "was 1.00"),
            (500.0, 47.3, "was 47.3"),
        ] {
            assert_eq!(against(now, base), None, "{now} {base}");
            assert_eq!(was(base, "1", WIDTH), expected);
        }
    }
}
