//! Tests of the units.
#![expect(clippy::approx_constant, reason = "a value is read to the last bit, whatever it is")]

use super::Dimension::{
    Angle, AngularVelocity, Compliance, Density, Length, Number, Power, Pressure, Torque,
};
use super::*;
use proptest::prelude::*;

#[test]
fn powers_of_ten_are_exact() {
    for (text, dimension, si) in [
        ("16 um", Length, 16e-6),
        ("24.7 µm", Length, 24.7e-6),
        ("24.7 μm", Length, 24.7e-6),
        ("5mm", Length, 5e-3),
        ("90.171 mm", Length, 90.171e-3),
        ("1.5e3 mm", Length, 1.5),
        ("+.5 m", Length, 0.5),
        ("205 GPa", Pressure, 205e9),
        ("210000 N/mm²", Pressure, 210e9),
        ("7.85 g/cm^3", Density, 7850.0),
        ("7800 kg/m³", Density, 7800.0),
        ("115.766 kW", Power, 115766.0),
        ("71.6 N·m", Torque, 71.6),
        ("71600 N mm", Torque, 71.6),
        ("12.3 um mm/N", Compliance, 12.3e-9),
        ("-0.25", Number, -0.25),
    ] {
        assert_eq!(parse(text, dimension, "").map_err(|misread| misread.cause), Ok(si), "{text}");
    }
}

/// Nearest f64 to the exact product, from 50-digit arithmetic.
#[test]
fn other_units_are_right_to_the_last_place() {
    for (text, dimension, si) in [
        ("20 deg", Angle, 0.3490658503988659),
        ("22.5°", Angle, 0.39269908169872414),
        ("30 arcmin", Angle, 0.008726646259971648),
        ("2000 rpm", AngularVelocity, 209.43951023931956),
        ("1450 1/min", AngularVelocity, 151.84364492350667),
        ("1450 1 / min", AngularVelocity, 151.84364492350667),
        ("1450 min^-1", AngularVelocity, 151.84364492350667),
        ("1450 min⁻¹", AngularVelocity, 151.84364492350667),
        ("0.3125 in", Length, 0.0079375),
        ("30000 ksi", Pressure, 206842718795.05084),
        ("0.284 lb/in3", Density, 7861.0929376976865),
        ("20 hp", Power, 14913.997431645405),
        ("635 lbf in", Torque, 71.7453664325366),
    ] {
        let read = parse(text, dimension, "").map_err(|misread| misread.cause);
        let ulp = read.as_ref().map(|value| (value - si).abs() <= si.abs() * f64::EPSILON);
        assert_eq!(ulp, Ok(true), "{text}: {read:?} for {si}");
    }
}

/// Further refusals are in `tests/cli/bad_files.rs`.
#[test]
fn invalid_values_are_refused_with_a_fix() {
    for (text, dimension, usual, cause, fix) in [
        ("", Length, "mm", "value is missing", "\"20 mm\""),
        ("1,000.5 mm", Length, "mm", "comma", "write 1000.5"),
        ("1e-310 m", Length, "mm", "too close to zero", "write 0"),
        ("1e-99999999999999999999 m", Length, "mm", "too close to zero", "write 0"),
        ("16 mn", Length, "mm", "unknown unit `mn`", "did you mean"),
        ("16 furlong", Length, "mm", "unknown unit `furlong`", "use one of mm"),
        ("5 m m", Length, "mm", "unknown unit `m m`", "did you mean mm"),
        ("5 mm 2.5", Length, "mm", "unknown unit `mm 2.5`", "mm"),
        ("5 5 mm", Length, "mm", "not one number", "20 mm"),
        ("5.5.5 mm", Length, "mm", "not one number", "20 mm"),
        ("1_000 mm", Length, "mm", "not one number", "20 mm"),
        ("0.3 mm", Number, "", "has no unit such as `mm`", "such as 0.5"),
        ("1e", Number, "", "`1e` is not a number", "such as 0.5"),
        ("2 kNm", Power, "kW", "unit of torque, not of power", "use one of kW"),
        ("3 RPm", AngularVelocity, "rpm", "unknown unit", "did you mean rpm"),
    ] {
        let misread = parse(text, dimension, usual).unwrap_err();
        assert!(misread.cause.contains(cause), "{text}: {}", misread.cause);
        assert!(misread.fix.contains(fix), "{text}: {}", misread.fix);
    }
}

#[test]
fn a_shown_value_is_short() {
    for (value, unit, shown) in [
        (0.005, "mm", "5 mm"),
        (16e-6, "um", "16 um"),
        (205e9, "GPa", "205 GPa"),
        (0.3490658503988659, "deg", "20 deg"),
        (209.43951023931956, "rpm", "2000 rpm"),
        (-0.25, "1", "-0.25"),
        (0.0, "mm", "0 mm"),
    ] {
        assert_eq!(text(value, unit), shown);
    }
}

#[test]
fn a_number_of_a_unit_has_no_rounding_error() {
    for (number, unit) in [(0.0508_f64, "mm"), (0.3, "in"), (0.1, "deg"), (0.5131, "")] {
        let dimension = Dimension::of_unit(unit).unwrap();
        let value = parse(&format!("{number} {unit}"), dimension, unit).unwrap();
        assert_eq!(in_unit(value, unit).to_bits(), number.to_bits(), "{number} {unit}");
    }
}

#[test]
fn every_dimension_finds_its_units() {
    for (at, (dimension, ..)) in UNITS.iter().enumerate() {
        assert_eq!(*dimension as usize, at, "{}", dimension.name());
    }
}

proptest! {
    #[test]
    fn a_shown_value_parses_to_the_same_value(value in prop::num::f64::NORMAL, exponent in -9i32..9) {
        let value = value.clamp(-1e200, 1e200) * 10f64.powi(exponent);
        prop_assume!(value.abs() > 1e-200);
        for (dimension, unit) in [(Length, "um"), (Pressure, "GPa"), (Length, "m")] {
            prop_assert_eq!(parse(&text(value, unit), dimension, unit).ok(), Some(value));
        }
    }

    #[test]
    fn a_shown_angle_parses_to_the_same_value_within_the_last_place(value in 1e-6f64..10.0) {
        let read = parse(&text(value, "deg"), Angle, "deg").unwrap_or(f64::NAN);
        prop_assert!((read - value).abs() <= value * f64::EPSILON);
    }

    #[test]
    fn no_text_makes_the_parser_panic(text in ".*") {
        let _ = parse(&text, Length, "mm");
    }
}

fn ended(typed: &str, dimension: Dimension, usual: &str) -> String {
    format!("{typed}{}", ending(typed, dimension, usual).unwrap_or_default())
}

#[test]
fn a_bare_number_takes_the_usual_unit() {
    for (typed, whole) in [
        ("4", "4 um"),
        ("48", "48 um"),
        ("48 ", "48 um"),
        ("-48.5", "-48.5 um"),
        ("1e3", "1e3 um"),
        ("48 u", "48 um"),
        ("48u", "48um"),
        ("48 µ", "48 µm"),
        ("48 um", "48 um"),
        ("48 m", "48 m"),
        ("48 i", "48 in"),
        ("48 inc", "48 inch"),
        ("48 t", "48 thou"),
        ("48 mic", "48 micron"),
    ] {
        assert_eq!(ended(typed, Length, "um"), whole);
    }
    for (typed, dimension, usual, whole) in [
        ("71.6 N", Torque, "N m", "71.6 N m"),
        ("71.6 N ", Torque, "N m", "71.6 N m"),
        ("300 r", AngularVelocity, "rpm", "300 rpm"),
        ("300 ra", AngularVelocity, "rpm", "300 rad/s"),
        ("20 h", Power, "kW", "20 hp"),
    ] {
        assert_eq!(ended(typed, dimension, usual), whole);
    }
}

#[test]
fn an_ambiguous_unit_or_an_invalid_number_is_not_completed() {
    for (typed, dimension, usual) in [
        ("48 M", Pressure, "GPa"),
        ("48 x", Length, "um"),
        ("300 kN", Torque, "N m"),
        ("48 m ", Length, "mm"),
        ("-", Length, "um"),
        ("", Length, "um"),
        ("4,8", Length, "um"),
        ("0.3", Number, ""),
    ] {
        assert_eq!(ending(typed, dimension, usual), None, "{typed}");
    }
}

#[test]
fn every_beginning_of_a_value_is_incomplete_not_invalid() {
    for &(dimension, _, units) in &UNITS {
        let spellings =
            units.iter().flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases));
        for unit in spellings.filter(|spelling| !spelling.starts_with('1')) {
            let whole = format!("-1.5e-3 {unit}");
            for (end, _) in whole.char_indices() {
                let typed = &whole[..end];
                let is_value = parse(typed, dimension, "").is_ok();
                assert!(is_value || open(typed, dimension).is_some(), "{typed}");
            }
        }
    }
    for typed in ["fast", "4,8", "48 x", "48 um", "48 umm", "1.2.3", "e5", "4 8"] {
        assert_eq!(open(typed, Length), None, "{typed}");
    }
}

#[test]
fn the_completed_text_is_a_value() {
    for &(dimension, _, units) in &UNITS {
        for unit in units {
            for end in 1..=unit.symbol.len() {
                let typed = format!("2 {}", &unit.symbol[..end]);
                let whole = ended(&typed, dimension, units[0].symbol);
                let is_open = whole == typed;
                assert!(is_open || parse(&whole, dimension, "").is_ok(), "{typed} becomes {whole}");
            }
        }
    }
}

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
        ("um mm/N", 1e-9),
        ("1", 1.0),
        ("deg", std::f64::consts::PI / 180.0),
    ] {
        let scale = factor(unit).unwrap_or(f64::NAN);
        assert!((scale / si - 1.0).abs() < 4e-16, "{unit}: {scale:e} for {si:e}");
    }
    assert_eq!(factor("cubit"), None);
    assert_eq!(Dimension::of_unit("um mm/N"), Some(Compliance));
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
fn results_read_as_an_engineer_writes_them_without_more_places_than_digits() {
    use System::{Inch, Metric};
    for (value, unit, digits, system, text) in [
        (0.047891485, "mm", 6, Inch, "1.88549 in"),
        (47.327e-6, "um", 5, Inch, "1.8633 thou"),
        (2191.016, "N", 5, Inch, "492.56 lbf"),
        (0.8210639, "m/s", 5, Inch, "2.6938 ft/s"),
        (206e9, "GPa", 5, Inch, "29878 ksi"),
        (15e3, "kW", 5, Inch, "20.115 hp"),
        (71.6197, "N m", 5, Inch, "52.824 lbf ft"),
        (7800.0, "kg/m3", 5, Inch, "0.28179 lb/in3"),
        (2000.0 * factor("rpm").unwrap(), "rpm", 5, Inch, "2000.0 rpm"),
        (1.5568, "1", 5, Inch, "1.5568"),
        (133.9e-6, "us", 4, Inch, "133.9 us"),
        (3e6, "N", 5, Inch, "6.7443e5 lbf"),
        (3.0, "um", 5, Inch, "118.11 in"),
        (47.327e-6, "um", 5, Metric, "47.327 um"),
        (174_558.0, "N", 5, Metric, "174.56 kN"),
        (99_999.4, "N", 5, Metric, "99999 N"),
        (99_999.6, "N", 5, Metric, "100.00 kN"),
        (133_172e-6, "us", 4, Metric, "133.2 ms"),
        (-0.123_456_7, "um", 5, Metric, "-123.46 mm"),
        (3e12, "N", 5, Metric, "3.0000e6 MN"),
        (1_234_567.0, "1", 4, Metric, "1.235e6"),
    ] {
        let (number, unit) = shown(value, unit, digits, system);
        assert_eq!(format!("{number} {unit}").trim_end(), text);
    }
    assert_eq!(System::find("inch").map(System::other), Some(Metric));
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

#[test]
fn a_value_in_another_unit_is_shown_in_the_usual_unit_and_in_si() {
    use System::{Inch, Metric};
    for (typed, dimension, usual, system, hint) in [
        ("20 hp", Power, "kW", Metric, "= 14.914 kW"),
        ("20.000 hp", Power, "kW", Metric, "= 14.914 kW"),
        ("20.00001 hp", Power, "kW", Metric, "= 14.914005 kW"),
        ("15000 W", Power, "kW", Metric, "= 15 kW"),
        ("15 kW", Power, "kW", Metric, ""),
        ("1 in", Length, "mm", Metric, "= 25.4 mm"),
        ("-0.5 thou", Length, "mm", Metric, "= -0.0127 mm"),
        ("5000 µm", Length, "mm", Metric, "= 5 mm"),
        ("1e-9 um", Length, "mm", Metric, "= 1e-12 mm"),
        ("30000 ksi", Pressure, "GPa", Metric, "= 206.843 GPa"),
        ("2000 rpm", AngularVelocity, "rpm", Metric, "= 209.44 rad/s"),
        ("2000 1/min", AngularVelocity, "rpm", Metric, "= 209.44 rad/s"),
        ("10 rev/s", AngularVelocity, "rpm", Metric, "= 600 rpm = 62.832 rad/s"),
        ("100 rad/s", AngularVelocity, "rpm", Metric, "= 954.93 rpm"),
        ("20 deg", Angle, "deg", Metric, "= 0.34907 rad"),
        ("5 mm", Length, "mm", Inch, "= 0.19685 in"),
        ("0.2 in", Length, "mm", Inch, ""),
        ("16 um", Length, "um", Inch, "= 0.62992 thou"),
        ("2000 rpm", AngularVelocity, "rpm", Inch, "= 209.44 rad/s"),
        ("", Length, "mm", Metric, ""),
        ("5", Length, "mm", Metric, ""),
        ("5 kg", Length, "mm", Metric, ""),
        ("0.3", Number, "", Metric, ""),
        ("five mm", Length, "mm", Metric, ""),
    ] {
        let found = converted(typed, dimension, usual, system);
        assert_eq!(found.unwrap_or_default(), hint, "{typed}");
    }
}

proptest! {
    #[test]
    fn the_hint_equals_the_value(number in -1e6f64..1e6, decimals in 0usize..9) {
        let typed = format!("{number:.decimals$} in");
        let value = parse(&typed, Length, "mm").unwrap();
        let text = converted(&typed, Length, "mm", System::Metric).unwrap();
        let read = parse(text.trim_start_matches("= "), Length, "mm").unwrap();
        prop_assert!((read - value).abs() <= 0.51e-4 * value.abs(), "{typed} is text as {text}");
    }
}
