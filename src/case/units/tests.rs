//! Tests of the units.
#![expect(clippy::approx_constant, reason = "a value is read to the last bit, whatever it is")]

use super::*;
use proptest::prelude::*;

fn length(text: &str) -> Result<f64, Problem> {
    parse(text, Dimension::Length, "mm")
}

#[track_caller]
fn refused(text: &str, dimension: Dimension, usual: &str, cause: &str, fix: &str) {
    match parse(text, dimension, usual) {
        Ok(value) => panic!("{text} was read as {value}"),
        Err(misread) => {
            assert!(misread.cause.contains(cause), "{text}: {}", misread.cause);
            assert!(misread.fix.to_string().contains(fix), "{text}: {}", misread.fix);
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
        assert_eq!(ended(typed, Dimension::Length, "um"), whole);
    }
    assert_eq!(ended("71.6 N", Dimension::Torque, "N m"), "71.6 N m");
    assert_eq!(ended("71.6 N ", Dimension::Torque, "N m"), "71.6 N m");
    assert_eq!(ended("300 r", Dimension::AngularVelocity, "rpm"), "300 rpm");
    assert_eq!(ended("300 ra", Dimension::AngularVelocity, "rpm"), "300 rad/s");
    assert_eq!(ended("20 h", Dimension::Power, "kW"), "20 hp");
}

#[test]
fn an_ambiguous_unit_or_an_invalid_number_is_not_completed() {
    for (typed, dimension, usual) in [
        ("48 M", Dimension::Pressure, "GPa"),
        ("48 x", Dimension::Length, "um"),
        ("48 m ", Dimension::Length, "mm"),
        ("-", Dimension::Length, "um"),
        ("", Dimension::Length, "um"),
        ("4,8", Dimension::Length, "um"),
        ("0.3", Dimension::Number, ""),
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
        assert_eq!(open(typed, Dimension::Length), None, "{typed}");
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
    assert_eq!(metric("30000 ksi", Dimension::Pressure, "GPa").as_deref(), Some("= 206.843 GPa"));
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
