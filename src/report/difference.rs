//! The difference of two values of a quantity.

use crate::case::units::system::counted;
use crate::model::Quantity;

/// A difference below this fraction of the reference is rounding.
const NO_DIFFERENCE: f64 = 5e-6;
/// A value above this multiple of its reference has no difference in percent.
const MOST_TIMES: f64 = 10.0;
/// Text of a value equal to its reference.
pub const UNCHANGED: &str = "unchanged";

/// Whether two values differ only by rounding.
#[must_use]
pub fn is_unchanged(now: f64, base: f64) -> bool {
    now.to_bits() == base.to_bits() || ((now - base) / base).abs() < NO_DIFFERENCE
}

/// The difference in percent of the reference. `None` if the quantity can be negative, or if the
/// reference is close to 0 compared with the value.
#[must_use]
pub fn percent(quantity: &Quantity, now: f64, base: f64) -> Option<f64> {
    let part = (now - base) / base;
    let has_meaning = !quantity.is_signed && !quantity.is_flag() && base > 0.0 && now >= 0.0;
    (has_meaning && part.is_finite() && now <= MOST_TIMES * base).then_some(100.0 * part)
}

/// A percentage with its sign, at most nine characters wide.
#[must_use]
pub fn in_percent(percent: f64) -> String {
    match percent.abs() {
        size if size >= 100.0 => format!("{percent:+.0} %"),
        size if size >= 1.0 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.3} %"),
    }
}

/// The difference of two values: in percent, otherwise with its sign in the unit of the values.
#[must_use]
pub fn difference(quantity: &Quantity, now: f64, base: f64, unit: &'static str) -> String {
    if is_unchanged(now, base) {
        return UNCHANGED.to_owned();
    }
    if quantity.is_flag() {
        return "changed".to_owned();
    }
    if let Some(percent) = percent(quantity, now, base) {
        return in_percent(percent);
    }
    let number = counted((now - base).abs(), unit, 3);
    let sign = if now < base { '-' } else { '+' };
    let named = crate::case::units::system::named(unit);
    format!("{sign}{number} {named}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worded(key: &str, now: f64, base: f64) -> String {
        let quantity = Quantity::find(key).expect("a quantity");
        difference(quantity, now, base, quantity.shown)
    }

    #[test]
    fn a_difference_is_in_percent_and_fits_its_column() {
        for (now, base, expected) in [
            (110.0, 100.0, "+10.0 %"),
            (99.99, 100.0, "-0.010 %"),
            (0.0, 100.0, "-100 %"),
            (1.0, 1.0, UNCHANGED),
            (0.0, 0.0, UNCHANGED),
        ] {
            assert_eq!(worded("impact_force", now, base), expected, "{now} {base}");
            assert!(expected.len() <= UNCHANGED.len());
        }
    }

    #[test]
    fn a_value_that_may_be_negative_or_starts_near_zero_has_no_percentage() {
        assert_eq!(worded("total_deviation", -2e-6, 1e-6), "-3.00 um");
        assert_eq!(worded("total_deviation", 16e-6, 15e-6), "+1.00 um");
        assert_eq!(worded("impact_force", 500.0, 0.0), "+500 N");
        assert_eq!(worded("impact_force", 500.0, 4.0), "+496 N");
        assert_eq!(worded("dynamic_contact_lost", 1.0, 0.0), "changed");
    }
}
