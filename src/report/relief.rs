//! The tip relief that stops the corner contact, in figures that can be typed in as they stand.

use super::value;
use crate::case::units::{self, System};
use crate::model::{Quantity, Solution};

/// No digit of a relief is told below this one behind the point, a nanometre or a quarter of a
/// hundred of them.
const LEAST_DIGIT: [(System, i32); 2] = [(System::Metric, 3), (System::Inch, 4)];
/// Significant digits of the relief that is to be added.
const DIGITS: i32 = 3;

/// The tip relief of the driven gear that stops it, in words, in fewer and in the fewest; where the
/// tooth strikes and it is known.
#[must_use]
pub fn relief(solution: &Solution, system: System) -> Option<[String; 3]> {
    let quantity = Quantity::find("clearing_relief")?;
    let least = value(quantity, solution)?;
    let given = solution.clearing?.given;
    let unit = system.unit(quantity.shown);
    let [more, all] =
        rounded_up(least, given, unit, system).map(|number| format!("{number} {unit}"));
    Some(if given > 0.0 {
        [
            format!("{more} more tip relief of the driven gear ({all} in all) stops it"),
            format!("+{more} driven tip relief ({all} in all) stops it"),
            format!("Ca2 {all} stops it"),
        ]
    } else {
        [
            format!("{all} of tip relief of the driven gear stops it"),
            format!("{all} driven tip relief stops it"),
            format!("Ca2 {all} stops it"),
        ]
    })
}

/// The relief to be added and the one to be typed in: the latter up to a digit, the former to the
/// same digit, so that the sum of what there is and what is told is no less.
fn rounded_up(least: f64, given: f64, unit: &str, system: System) -> [String; 2] {
    /// What the factor of the unit and the sum may have rounded off.
    const ROUNDING: f64 = 1.0 + 4.0 * f64::EPSILON;
    /// A part of a digit that is rounding, where the sum has no more digits.
    const NONE: f64 = 1e-9;
    let factor = units::factor(unit).unwrap_or(1.0);
    let last = LEAST_DIGIT
        .iter()
        .find(|(own, _)| *own == system)
        .map_or(3, |&(_, last)| last);
    let before_point = (least / factor).log10().floor() as i32 + 1;
    let digits = (DIGITS - before_point).clamp(0, last);
    let scale = 10f64.powi(digits);
    let all = ((least + given) * ROUNDING / factor * scale).ceil();
    let more = (all - given / factor * scale - NONE).ceil();
    let digits = usize::try_from(digits).unwrap_or(0);
    [more, all].map(|number| format!("{:.digits$}", number / scale))
}

#[cfg(test)]
mod tests {
    use super::{System, rounded_up};

    #[test]
    fn what_is_told_is_no_less_and_adds_up() {
        let told = |least: f64, given: f64| {
            rounded_up(least * 1e-6, given * 1e-6, "um", System::Metric).join(" ")
        };
        assert_eq!(told(23.01, 25.0), "23.1 48.1");
        assert_eq!(told(23.01, 25.03), "23.1 48.1");
        assert_eq!(told(47.327, 0.0), "47.4 47.4");
        assert_eq!(told(0.672_57, 48.0), "0.673 48.673");
        assert_eq!(told(1e-9, 25.0), "0.001 25.001");
        assert_eq!(told(1234.1, 0.0), "1235 1235");
        assert_eq!(
            rounded_up(22.328e-6, 25e-6, "thou", System::Inch).join(" "),
            "0.880 1.864"
        );
    }
}
