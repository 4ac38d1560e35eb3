//! Metric or inch units of shown results and hints. Files keep their units.

use super::{Dimension, factor, find, parse, split_number, units_of};
use crate::numeric::decimal::significant;

/// The units of shown values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum System {
    /// mm, um, N, kW, N m, GPa.
    #[default]
    Metric,
    /// in, thou, lbf, hp, lbf ft, ksi.
    Inch,
}

/// Each shown metric unit and its inch unit. Both systems use units that are not in this list, such
/// as deg, rpm or us.
const PAIRS: [(&str, &str); 20] = [
    ("m", "ft"),
    ("mm", "in"),
    ("um", "thou"),
    ("N", "lbf"),
    ("kN", "lbf"),
    ("N m", "lbf ft"),
    ("W", "hp"),
    ("kW", "hp"),
    ("J", "ft lbf"),
    ("kg", "lb"),
    ("kg m2", "lb in2"),
    ("kg mm2", "lb in2"),
    ("kg/m3", "lb/in3"),
    ("Pa", "psi"),
    ("MPa", "psi"),
    ("GPa", "ksi"),
    ("m/s", "ft/s"),
    ("um mm/N", "in2/lbf"),
    ("m2/N", "in2/lbf"),
    ("N/um", "lbf/in"),
];

impl System {
    /// Both systems, in the order of the key that switches between them.
    pub const ALL: [System; 2] = [System::Metric, System::Inch];

    /// The name in settings and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            System::Metric => "metric",
            System::Inch => "inch",
        }
    }

    /// The system with this name.
    #[must_use]
    pub fn find(name: &str) -> Option<System> {
        System::ALL.into_iter().find(|system| system.name() == name)
    }

    /// The other system.
    #[must_use]
    pub fn other(self) -> System {
        match self {
            System::Metric => System::Inch,
            System::Inch => System::Metric,
        }
    }

    /// The unit of this system that corresponds to a written unit. Other units stay unchanged.
    #[must_use]
    pub fn unit(self, written: &str) -> &str {
        let inch = PAIRS.iter().find(|(from, _)| *from == written);
        match inch {
            Some((_, inch)) if self == System::Inch => inch,
            _ => written,
        }
    }
}

/// The next larger unit for a number with more integer places than digits.
const NEXT: [(&str, &str); 14] = [
    ("N", "kN"),
    ("kN", "MN"),
    ("us", "ms"),
    ("ms", "s"),
    ("um", "mm"),
    ("mm", "m"),
    ("J", "kJ"),
    ("W", "kW"),
    ("kW", "MW"),
    ("N m", "kN m"),
    ("kg", "t"),
    ("kg mm2", "kg m2"),
    ("thou", "in"),
    ("psi", "ksi"),
];

/// The unit in which this system shows a value in SI: the corresponding unit, or a larger unit if
/// the number would have more integer places than digits.
#[must_use]
pub fn unit_for(value: f64, metric: &'static str, digits: usize, system: System) -> &'static str {
    let mut unit = system.unit(metric);
    while has_more_places(value, unit, digits) {
        let Some((_, next)) = NEXT.iter().find(|(from, _)| *from == unit) else {
            break;
        };
        unit = next;
    }
    unit
}

/// A value in SI converted to a unit, with exactly this many significant digits, with an exponent
/// if needed.
#[must_use]
pub fn counted(value: f64, unit: &str, digits: usize) -> String {
    let number = value / factor(unit).unwrap_or(1.0);
    if has_more_places(value, unit, digits) {
        format!("{number:.*e}", digits.saturating_sub(1))
    } else {
        significant(number, digits)
    }
}

// Whether the rounded number has more places before its point than digits.
fn has_more_places(value: f64, unit: &str, digits: usize) -> bool {
    let number = (value / factor(unit).unwrap_or(1.0)).abs();
    let end = 10f64.powi(i32::try_from(digits).unwrap_or(i32::MAX));
    number.is_finite() && number.round() >= end
}

/// A value in SI as this system shows it: the number with this many significant digits, and its
/// unit, empty for a bare number.
#[must_use]
pub fn shown(
    value: f64,
    metric: &'static str,
    digits: usize,
    system: System,
) -> (String, &'static str) {
    let unit = unit_for(value, metric, digits, system);
    (counted(value, unit, digits), named(unit))
}

/// A unit after a number. Empty for a bare number.
#[must_use]
pub fn named(unit: &'static str) -> &'static str {
    if unit == "1" { "" } else { unit }
}

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
    let (digits, unit) = split_number(typed.trim(), usual).ok()?;
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
    let short = significant(value / factor(unit).unwrap_or(1.0), digits);
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
    use super::super::{Dimension, parse};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn each_unit_has_the_factor_of_its_definition() {
        for (unit, si) in [
            ("in", 25.4e-3),
            ("thou", 25.4e-6),
            ("ft", 0.3048),
            ("lbf", 4.4482216152605),
            ("lbf ft", 1.3558179483314004),
            ("ft lbf", 1.3558179483314004),
            ("hp", 745.699_871_582_270_2),
            ("lb", 0.45359237),
            ("lb/in3", 27679.904710203125),
            ("psi", 6894.757293168361),
            ("ksi", 6894757.293168361),
            ("ft/s", 0.3048),
            ("in2/lbf", 0.00064516 / 4.4482216152605),
        ] {
            let scale = factor(unit).unwrap_or(f64::NAN);
            assert!((scale / si - 1.0).abs() < 4e-16, "{unit}: {scale:e} for {si:e}");
        }
    }

    #[test]
    fn both_units_of_a_pair_are_of_one_dimension() {
        for (metric, inch) in PAIRS {
            let (metric, inch) = (Dimension::of_unit(metric).unwrap(), inch);
            assert!(
                parse(&format!("1 {inch}"), metric, "").is_ok(),
                "{inch} is no unit of {}",
                metric.name()
            );
        }
    }

    #[test]
    fn results_in_inch_units_read_as_an_engineer_writes_them() {
        let text = |value, metric, digits| {
            let (number, unit) = shown(value, metric, digits, System::Inch);
            format!("{number} {unit}").trim_end().to_owned()
        };
        assert_eq!(text(0.047891485, "mm", 6), "1.88549 in");
        assert_eq!(text(47.327e-6, "um", 5), "1.8633 thou");
        assert_eq!(text(2191.016, "N", 5), "492.56 lbf");
        assert_eq!(text(0.8210639, "m/s", 5), "2.6938 ft/s");
        assert_eq!(text(206e9, "GPa", 5), "29878 ksi");
        assert_eq!(text(15e3, "kW", 5), "20.115 hp");
        assert_eq!(text(71.6197, "N m", 5), "52.824 lbf ft");
        assert_eq!(text(7800.0, "kg/m3", 5), "0.28179 lb/in3");
        assert_eq!(text(2000.0 * factor("rpm").unwrap(), "rpm", 5), "2000.0 rpm");
        assert_eq!(text(1.5568, "1", 5), "1.5568");
        assert_eq!(text(133.9e-6, "us", 4), "133.9 us");
    }

    #[test]
    fn no_value_is_shown_with_more_places_than_it_has_digits() {
        let text = |value, metric, digits, system| {
            let (number, unit) = shown(value, metric, digits, system);
            format!("{number} {unit}").trim_end().to_owned()
        };
        assert_eq!(text(174_558.0, "N", 5, System::Metric), "174.56 kN");
        assert_eq!(text(99_999.4, "N", 5, System::Metric), "99999 N");
        assert_eq!(text(99_999.6, "N", 5, System::Metric), "100.00 kN");
        assert_eq!(text(133_172e-6, "us", 4, System::Metric), "133.2 ms");
        assert_eq!(text(-0.123_456_7, "um", 5, System::Metric), "-123.46 mm");
        assert_eq!(text(3e12, "N", 5, System::Metric), "3.0000e6 MN");
        assert_eq!(text(1_234_567.0, "1", 4, System::Metric), "1.235e6");
        assert_eq!(text(3e6, "N", 5, System::Inch), "6.7443e5 lbf");
        assert_eq!(text(3.0, "um", 5, System::Inch), "118.11 in");
    }

    #[test]
    fn metric_units_stay_unchanged() {
        assert_eq!(shown(47.327e-6, "um", 5, System::Metric), ("47.327".to_owned(), "um"));
        assert_eq!(System::find("inch").map(System::other), Some(System::Metric));
    }

    proptest! {
        #[test]
        fn a_shown_number_equals_the_value_within_its_digits(value in 1e-9f64..1e12, pair in 0..PAIRS.len(), inch: bool) {
            let system = if inch { System::Inch } else { System::Metric };
            let metric = PAIRS[pair].0;
            let dimension = Dimension::of_unit(metric).unwrap();
            let (number, unit) = shown(value, metric, 6, system);
            let read = parse(&format!("{number} {unit}"), dimension, unit).unwrap_or(f64::NAN);
            prop_assert!((read / value - 1.0).abs() <= 5.001e-6,
                "{value:e} is shown as {number} {unit}, which is {read:e}");
        }
    }

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
