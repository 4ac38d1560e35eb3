//! The tip relief that prevents corner contact, rounded up for input.

use super::value;
use crate::case::units::{self, System};
use crate::model::inputs::Method;
use crate::model::{Quantity, Solution};

/// Decimal places of a relief, by system of units.
const LEAST_DIGIT: [(System, i32); 2] = [(System::Metric, 3), (System::Inch, 4)];
/// Significant digits of the additional relief.
const DIGITS: i32 = 3;

/// The required tip relief of the driven gear by the governing method and by the others, from the
/// full text to the shortest; `None` without corner contact, or if the relief is unknown.
#[must_use]
pub fn relief(governing: &Solution, others: &[&Solution], system: System) -> Option<[String; 4]> {
    let unit = unit(system)?;
    let (given, figures) = figures(governing, unit, system)?;
    Some(phrases(governing.method, given > 0.0, &figures, others, unit, system))
}

/// The same text while the relief of the governing method is not known yet; `given` is the present
/// relief of the gear, in m.
#[must_use]
pub fn pending(
    method: Method,
    given: f64,
    others: &[&Solution],
    system: System,
) -> Option<[String; 4]> {
    let figures = ["...", "..."].map(str::to_owned);
    Some(phrases(method, given > 0.0, &figures, others, unit(system)?, system))
}

fn unit(system: System) -> Option<&'static str> {
    Some(system.unit(Quantity::find("clearing_relief")?.shown))
}

/// The present relief of the gear, in m, with the additional and the total relief as text.
fn figures(solution: &Solution, unit: &str, system: System) -> Option<(f64, [String; 2])> {
    let least = value(Quantity::find("clearing_relief")?, solution)?;
    let given = solution.clearing?.given;
    Some((given, rounded_up(least, given, unit, system)))
}

fn phrases(
    method: Method,
    has_relief: bool,
    [more, all]: &[String; 2],
    others: &[&Solution],
    unit: &str,
    system: System,
) -> [String; 4] {
    let own = method.name();
    let others = others.iter().filter_map(|other| {
        let (_, [more, _]) = figures(other, unit, system)?;
        Some(format!(", {} {more}", other.method.name()))
    });
    let others: String = others.collect();
    if has_relief {
        [
            format!(
                "Required additional tip relief, driven gear: {own} {more}{others} {unit}; total \
                    {all} {unit}"
            ),
            format!("Relief to add: {own} {more}{others} {unit}; total {all} {unit}"),
            format!("Required relief: +{more}, total {all} {unit}"),
            format!("Required Ca2: {all} {unit}"),
        ]
    } else {
        [
            format!("Required tip relief of the driven gear: {own} {more}{others} {unit}"),
            format!("Required tip relief: {own} {more}{others} {unit}"),
            format!("Required relief: {own} {more} {unit}"),
            format!("Required Ca2: {all} {unit}"),
        ]
    }
}

/// The additional and the total relief, rounded up to the same digit, so that the given and the
/// additional relief add up to at least the total.
fn rounded_up(least: f64, given: f64, unit: &str, system: System) -> [String; 2] {
    /// Rounding error of the factor of the unit and of the sum.
    const ROUNDING: f64 = 1.0 + 4.0 * f64::EPSILON;
    /// The fraction of a digit that is rounding error.
    const NONE: f64 = 1e-9;
    let factor = units::factor(unit).unwrap_or(1.0);
    let last = LEAST_DIGIT.iter().find(|(own, _)| *own == system).map_or(3, |&(_, last)| last);
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
    fn a_relief_is_rounded_up_and_adds_up() {
        let sums = |least: f64, given: f64| {
            rounded_up(least * 1e-6, given * 1e-6, "um", System::Metric).join(" ")
        };
        assert_eq!(sums(23.01, 25.0), "23.1 48.1");
        assert_eq!(sums(23.01, 25.03), "23.1 48.1");
        assert_eq!(sums(47.327, 0.0), "47.4 47.4");
        assert_eq!(sums(0.672_57, 48.0), "0.673 48.673");
        assert_eq!(sums(1e-9, 25.0), "0.001 25.001");
        assert_eq!(sums(1234.1, 0.0), "1235 1235");
        assert_eq!(rounded_up(22.328e-6, 25e-6, "thou", System::Inch).join(" "), "0.880 1.864");
    }
}
