//! Converts a typed value to the units of its reader, for the hint under a field.

use super::{Dimension, System, find, number, parse, text, units_of};
use crate::numeric::decimal::significant;

/// Least number of digits of a hint, as in the results: "20 hp" gives 14.914 kW, not 15 kW.
const LEAST_DIGITS: usize = 5;

/// Greatest number of decimal digits of an f64.
const MOST_DIGITS: usize = 15;

/// Units that are neither decimal multiples of SI nor inch units. Their hint includes the SI value.
const BESIDE: [(&str, &str); 2] = [("rpm", "rad/s"), ("deg", "rad")];

/// The typed value in the field's usual unit, such as `= 14.914 kW` for "20 hp" and kW. If the
/// usual unit is rpm or deg, also in SI: `= 209.44 rad/s`. `None` if no conversion is needed or the
/// text is invalid.
///
/// Shows one digit more than typed, at least five and at most fifteen, rounded and without trailing
/// zeros. A typed number is exact, so that "20 hp" has the digits of a result.
#[must_use]
pub fn converted(
    typed: &str,
    dimension: Dimension,
    usual: &'static str,
    system: System,
) -> Option<String> {
    let value = parse(typed, dimension, usual).ok()?;
    let (digits, unit) = number::split(typed.trim(), usual).ok()?;
    let digits = (typed_digits(digits) + 1).clamp(LEAST_DIGITS, MOST_DIGITS);
    let written = find(unit, units_of(dimension))?.symbol;
    let usual = system.unit(usual);
    let beside = BESIDE.iter().find(|(unit, _)| *unit == usual).map(|(_, si)| *si);
    let text: Vec<String> = std::iter::once(usual)
        .chain(beside)
        .filter(|unit| *unit != written)
        .map(|unit| format!("= {} {unit}", rounded(value, unit, digits)))
        .collect();
    (!text.is_empty()).then(|| text.join(" "))
}

/// Significant digits of a number as typed: 3 in "0.0250", 2 in "20", 1 in "0".
fn typed_digits(number: &str) -> usize {
    let mantissa = number.split(['e', 'E']).next().unwrap_or_default();
    let digits = mantissa.bytes().filter(u8::is_ascii_digit);
    digits.skip_while(|&digit| digit == b'0').count().max(1)
}

/// A value in SI converted to a unit, rounded, without trailing zeros.
fn rounded(value: f64, unit: &str, digits: usize) -> String {
    let exact = text(value, unit);
    let number = exact.split(' ').next().unwrap_or_default();
    let short = significant(number.parse().unwrap_or(f64::NAN), digits);
    let (mantissa, exponent) =
        short.find('e').map_or((short.as_str(), ""), |at| short.split_at(at));
    let plain = if mantissa.contains('.') {
        mantissa.trim_end_matches('0').trim_end_matches('.')
    } else {
        mantissa
    };
    format!("{plain}{exponent}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn metric(typed: &str, dimension: Dimension, usual: &'static str) -> Option<String> {
        converted(typed, dimension, usual, System::Metric)
    }

    #[test]
    fn a_value_in_another_unit_is_shown_in_the_usual_unit() {
        let power = |typed| metric(typed, Dimension::Power, "kW");
        assert_eq!(power("20 hp").as_deref(), Some("= 14.914 kW"));
        assert_eq!(power("20.000 hp").as_deref(), Some("= 14.914 kW"));
        assert_eq!(power("20.00001 hp").as_deref(), Some("= 14.914005 kW"));
        assert_eq!(power("15000 W").as_deref(), Some("= 15 kW"));
        assert_eq!(power("15 kW"), None);
        let length = |typed| metric(typed, Dimension::Length, "mm");
        assert_eq!(length("1 in").as_deref(), Some("= 25.4 mm"));
        assert_eq!(length("-0.5 thou").as_deref(), Some("= -0.0127 mm"));
        assert_eq!(length("5000 µm").as_deref(), Some("= 5 mm"));
        assert_eq!(length("1e-9 um").as_deref(), Some("= 1e-12 mm"));
        assert_eq!(
            metric("30000 ksi", Dimension::Pressure, "GPa").as_deref(),
            Some("= 206.843 GPa")
        );
    }

    #[test]
    fn rpm_and_degrees_are_shown_in_si_too() {
        let speed = |typed| metric(typed, Dimension::AngularVelocity, "rpm");
        assert_eq!(speed("2000 rpm").as_deref(), Some("= 209.44 rad/s"));
        assert_eq!(speed("2000 1/min").as_deref(), Some("= 209.44 rad/s"));
        assert_eq!(speed("10 rev/s").as_deref(), Some("= 600 rpm = 62.832 rad/s"));
        assert_eq!(speed("100 rad/s").as_deref(), Some("= 954.93 rpm"));
        assert_eq!(metric("20 deg", Dimension::Angle, "deg").as_deref(), Some("= 0.34907 rad"));
    }

    #[test]
    fn in_inch_units_the_inch_unit_is_the_usual_one() {
        let inch = |typed, dimension, usual| converted(typed, dimension, usual, System::Inch);
        assert_eq!(inch("5 mm", Dimension::Length, "mm").as_deref(), Some("= 0.19685 in"));
        assert_eq!(inch("0.2 in", Dimension::Length, "mm"), None);
        assert_eq!(inch("16 um", Dimension::Length, "um").as_deref(), Some("= 0.62992 thou"));
        assert_eq!(
            inch("2000 rpm", Dimension::AngularVelocity, "rpm").as_deref(),
            Some("= 209.44 rad/s")
        );
    }

    #[test]
    fn a_value_in_its_usual_unit_gets_no_hint() {
        for (typed, dimension, usual) in [
            ("", Dimension::Length, "mm"),
            ("5", Dimension::Length, "mm"),
            ("5 kg", Dimension::Length, "mm"),
            ("0.3", Dimension::Number, ""),
            ("five mm", Dimension::Length, "mm"),
        ] {
            assert_eq!(metric(typed, dimension, usual), None, "{typed}");
        }
    }

    proptest! {
        #[test]
        fn the_hint_equals_the_value(number in -1e6f64..1e6, decimals in 0usize..9) {
            let typed = format!("{number:.decimals$} in");
            let value = parse(&typed, Dimension::Length, "mm").unwrap();
            let text = metric(&typed, Dimension::Length, "mm").unwrap();
            let read = parse(text.trim_start_matches("= "), Dimension::Length, "mm").unwrap();
            prop_assert!((read - value).abs() <= 0.51e-4 * value.abs(), "{typed} is text as {text}");
        }
    }
}
