//! Tests of reading texts with units.
#![expect(clippy::approx_constant, reason = "a value is read to the last bit, whatever it is")]

use super::{Dimension, ParseError, factor, parse, text};
use proptest::prelude::*;

fn length(text: &str) -> Result<f64, ParseError> {
    parse(text, Dimension::Length, "mm")
}

#[track_caller]
fn refused(text: &str, dimension: Dimension, usual: &str, cause: &str, fix: &str) {
    match parse(text, dimension, usual) {
        Ok(value) => panic!("{text} was read as {value}"),
        Err(misread) => {
            assert!(misread.cause.contains(cause), "{text}: {}", misread.cause);
            assert!(misread.fix.contains(fix), "{text}: {}", misread.fix);
        }
    }
}

#[test]
fn powers_of_ten_are_exact() {
    for (text, dimension, si) in [
        ("16 um", Dimension::Length, 16e-6),
        ("24.7 µm", Dimension::Length, 24.7e-6),
        ("24.7 μm", Dimension::Length, 24.7e-6),
        ("5mm", Dimension::Length, 5e-3),
        ("90.171 mm", Dimension::Length, 90.171e-3),
        ("1.5e3 mm", Dimension::Length, 1.5),
        ("+.5 m", Dimension::Length, 0.5),
        ("205 GPa", Dimension::Pressure, 205e9),
        ("210000 N/mm²", Dimension::Pressure, 210e9),
        ("7.85 g/cm^3", Dimension::Density, 7850.0),
        ("7800 kg/m³", Dimension::Density, 7800.0),
        ("115.766 kW", Dimension::Power, 115766.0),
        ("71.6 N·m", Dimension::Torque, 71.6),
        ("71600 N mm", Dimension::Torque, 71.6),
        ("12.3 um mm/N", Dimension::Compliance, 12.3e-9),
        ("-0.25", Dimension::Number, -0.25),
    ] {
        assert_eq!(parse(text, dimension, "").map_err(|misread| misread.cause), Ok(si), "{text}");
    }
}

/// Nearest f64 to the exact product, from 50-digit arithmetic.
#[test]
fn other_units_are_right_to_the_last_place() {
    for (text, dimension, si) in [
        ("20 deg", Dimension::Angle, 0.3490658503988659),
        ("22.5°", Dimension::Angle, 0.39269908169872414),
        ("30 arcmin", Dimension::Angle, 0.008726646259971648),
        ("2000 rpm", Dimension::AngularVelocity, 209.43951023931956),
        ("1450 1/min", Dimension::AngularVelocity, 151.84364492350667),
        ("1450 1 / min", Dimension::AngularVelocity, 151.84364492350667),
        ("1450 min^-1", Dimension::AngularVelocity, 151.84364492350667),
        ("1450 min⁻¹", Dimension::AngularVelocity, 151.84364492350667),
        ("0.3125 in", Dimension::Length, 0.0079375),
        ("30000 ksi", Dimension::Pressure, 206842718795.05084),
        ("0.284 lb/in3", Dimension::Density, 7861.0929376976865),
        ("20 hp", Dimension::Power, 14913.997431645405),
        ("635 lbf in", Dimension::Torque, 71.7453664325366),
    ] {
        let read = parse(text, dimension, "").map_err(|misread| misread.cause);
        let ulp = read.as_ref().map(|value| (value - si).abs() <= si.abs() * f64::EPSILON);
        assert_eq!(ulp, Ok(true), "{text}: {read:?} for {si}");
    }
}

#[test]
fn invalid_values_are_refused_with_a_fix() {
    for (text, cause, fix) in [
        ("", "value is missing", "\"20 mm\""),
        ("5", "has no unit", "\"5 mm\""),
        ("4,5 mm", "comma", "write 4.5, not 4,5"),
        ("1,000.5 mm", "comma", "write 1000.5"),
        ("−5 mm", "not the minus sign", "write -5 mm"),
        ("nan mm", "not a finite number", "20 mm"),
        ("-inf mm", "not a finite number", "20 mm"),
        ("mm", "does not begin with a number", "20 mm"),
        ("1e400 mm", "too large", "smaller"),
        ("1e-400 mm", "too close to zero", "write 0"),
        ("1e-310 m", "too close to zero", "write 0"),
        ("1e-99999999999999999999 m", "too close to zero", "write 0"),
        ("16 kg", "is a unit of mass, not of length", "use one of mm"),
        ("16 mn", "unknown unit `mn`", "did you mean"),
        ("16 furlong", "unknown unit `furlong`", "use one of mm"),
        ("5 m m", "unknown unit `m m`", "did you mean mm"),
        ("5 mm1", "1 after the unit", "write all digits before mm"),
        ("5 mm 2.5", "2.5 after the unit", "write all digits before mm"),
        ("5 5 mm", "not one number", "20 mm"),
        ("5.5.5 mm", "not one number", "20 mm"),
        ("1_000 mm", "not one number", "20 mm"),
    ] {
        refused(text, Dimension::Length, "mm", cause, fix);
    }
    refused("0.3 mm", Dimension::Number, "", "is not allowed here", "write 0.3");
    refused("2 kNm", Dimension::Power, "kW", "unit of torque, not of power", "use one of kW");
    refused("3 RPm", Dimension::AngularVelocity, "rpm", "unknown unit", "did you mean rpm");
}

#[test]
fn a_shown_value_is_short() {
    assert_eq!(text(0.005, "mm"), "5 mm");
    assert_eq!(text(16e-6, "um"), "16 um");
    assert_eq!(text(205e9, "GPa"), "205 GPa");
    assert_eq!(text(0.3490658503988659, "deg"), "20 deg");
    assert_eq!(text(209.43951023931956, "rpm"), "2000 rpm");
    assert_eq!(text(-0.25, "1"), "-0.25");
    assert_eq!(text(0.0, "mm"), "0 mm");
}

#[test]
fn factors_convert_results_to_shown_units() {
    assert_eq!(factor("um mm/N"), Some(1e-9));
    assert_eq!(factor("mm"), Some(1e-3));
    assert_eq!(factor("1"), Some(1.0));
    assert_eq!(factor("deg"), Some(std::f64::consts::PI / 180.0));
    assert_eq!(factor("cubit"), None);
    assert_eq!(Dimension::of_unit("um mm/N"), Some(Dimension::Compliance));
}

proptest! {
    #[test]
    fn a_shown_value_parses_to_the_same_value(value in prop::num::f64::NORMAL, exponent in -9i32..9) {
        let value = value.clamp(-1e200, 1e200) * 10f64.powi(exponent);
        prop_assume!(value.abs() > 1e-200);
        for (dimension, unit) in [(Dimension::Length, "um"), (Dimension::Pressure, "GPa"), (Dimension::Length, "m")] {
            prop_assert_eq!(parse(&text(value, unit), dimension, unit).ok(), Some(value));
        }
    }

    #[test]
    fn a_shown_angle_parses_to_the_same_value_within_the_last_place(value in 1e-6f64..10.0) {
        let read = parse(&text(value, "deg"), Dimension::Angle, "deg").unwrap_or(f64::NAN);
        prop_assert!((read - value).abs() <= value * f64::EPSILON);
    }

    #[test]
    fn no_text_makes_the_parser_panic(text in ".*") {
        let _ = length(&text);
    }
}
