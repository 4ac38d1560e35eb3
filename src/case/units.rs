//! Conversion between text with a unit and SI.

pub mod system;
mod table;

use super::sanitize::{cut, quoted};
use super::{Problem, suggest};
pub use system::{System, converted};
use table::{FAMILIES, Scale, Unit, family_of, units_of};

/// The physical dimension of a field or a quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A bare number.
    Number,
    /// m.
    Length,
    /// rad.
    Angle,
    /// Pa.
    Pressure,
    /// kg/m³.
    Density,
    /// W.
    Power,
    /// N m.
    Torque,
    /// rad/s.
    AngularVelocity,
    /// N.
    Force,
    /// s.
    Time,
    /// m/s.
    Velocity,
    /// kg.
    Mass,
    /// J.
    Energy,
    /// kg m².
    Inertia,
    /// m²/N.
    Compliance,
    /// N/m.
    Stiffness,
    /// Hz.
    Frequency,
    /// 1/m.
    DiametralPitch,
}

impl Dimension {
    /// The dimension of a unit. "1" and "" are the bare number.
    #[must_use]
    pub fn of_unit(unit: &str) -> Option<Dimension> {
        if matches!(unit, "" | "1") {
            return Some(Dimension::Number);
        }
        known(unit).map(|(dimension, _)| dimension)
    }

    /// The name of a value with its article, such as "a length".
    #[must_use]
    pub fn name(self) -> &'static str {
        family_of(self).name
    }

    /// The SI unit; empty for the bare number.
    #[must_use]
    pub fn si_unit(self) -> &'static str {
        let mut units = units_of(self).iter();
        units.find(|unit| matches!(unit.scale, Scale::Ten(0))).map_or("", |unit| unit.symbol)
    }

    /// The symbols of its units, common units first.
    pub fn symbols(self) -> impl Iterator<Item = &'static str> {
        units_of(self).iter().map(|unit| unit.symbol)
    }
}

/// The usual spelling of a unit. `None` for an unknown unit.
#[must_use]
pub fn symbol(unit: &str) -> Option<&'static str> {
    known(unit).map(|(_, unit)| unit.symbol)
}

/// The SI value of one unit. `None` for an unknown unit. "1" and "" have the factor 1.
#[must_use]
pub fn factor(unit: &str) -> Option<f64> {
    if matches!(unit, "" | "1") {
        return Some(1.0);
    }
    Some(match known(unit)?.1.scale {
        Scale::Ten(exponent) if exponent < 0 => 1.0 / 10f64.powi(-exponent),
        Scale::Ten(exponent) => 10f64.powi(exponent),
        Scale::Times(factor, _) => factor,
    })
}

/// The value in SI of a text such as "16 um": the nearest f64 if the unit is a power of ten of SI,
/// otherwise within one unit in the last place.
///
/// `usual` is the unit of the examples in errors.
///
/// # Errors
/// If the text is not one finite number with a unit of the dimension.
pub fn parse(text: &str, dimension: Dimension, usual: &str) -> Result<f64, Problem> {
    let (number, unit) = split_number(text.trim(), usual)?;
    let scale = match (dimension, unit) {
        (Dimension::Number, "") => Scale::Ten(0),
        (Dimension::Number, _) => return Err(unit_unwanted(number, unit)),
        (_, "") => return Err(unit_missing(number, dimension, usual)),
        _ => find(unit, units_of(dimension)).ok_or_else(|| unit_wrong(unit, dimension))?.scale,
    };
    let value = match scale {
        Scale::Ten(exponent) => shifted(number, exponent),
        Scale::Times(factor, rest) => times(shifted(number, 0), factor, rest),
    };
    held(number, value)
}

/// The number and the unit of a text such as "16 um", as written. The unit is empty for a bare
/// number.
///
/// # Errors
/// If the text is not one number with at most one unit.
pub fn split<'t>(text: &'t str, usual: &str) -> Result<(&'t str, &'t str), Problem> {
    split_number(text.trim(), usual)
}

/// The shortest text in the unit that [`parse`] converts to the same value, or to the nearest value
/// possible in this unit.
#[must_use]
pub fn text(value: f64, unit: &str) -> String {
    let number = match known(unit).map(|(_, unit)| unit.scale) {
        None => plain(value, 0),
        Some(Scale::Ten(exponent)) => plain(value, -exponent),
        Some(Scale::Times(factor, rest)) => {
            let near = plain(value / factor, 0);
            (12..17)
                .map(|digits| format!("{:.digits$e}", value / factor))
                .find(|short| times(shifted(short, 0), factor, rest).to_bits() == value.to_bits())
                .map_or(near, |short| plain(shifted(&short, 0), 0))
        }
    };
    if matches!(unit, "" | "1") { number } else { format!("{number} {unit}") }
}

/// The product with a factor in two parts, rounded once.
fn times(number: f64, factor: f64, rest: f64) -> f64 {
    let high = number * factor;
    let low = number.mul_add(factor, -high) + number * rest;
    if high.is_finite() { high + low } else { high }
}

/// Length limit of a unit.
const LONGEST: usize = 64;

fn find(unit: &str, units: &'static [Unit]) -> Option<&'static Unit> {
    if unit.len() > LONGEST {
        return None;
    }
    let spelled =
        |text: &str| units.iter().find(|unit| unit.symbol == text || unit.aliases.contains(&text));
    spelled(unit).or_else(|| spelled(&plain_spelling(unit)))
}

/// A unit of any dimension.
fn known(unit: &str) -> Option<(Dimension, &'static Unit)> {
    FAMILIES.iter().find_map(|family| Some((family.dimension, find(unit, family.units)?)))
}

/// Normalizes spellings such as `N·m`, `N*m`, `N-m`; `kg/m³`, `kg / m^3`; `µm`, `μm`.
fn plain_spelling(unit: &str) -> String {
    let mut plain = String::with_capacity(unit.len());
    for c in unit.chars() {
        match c {
            'µ' | 'μ' => plain.push('u'),
            '²' => plain.push('2'),
            '³' => plain.push('3'),
            '^' => {}
            '/' => {
                plain.truncate(plain.trim_end().len());
                plain.push('/');
            }
            ' ' | '\u{a0}' | '\u{202f}' | '·' | '⋅' | '*' | '-' => {
                if !plain.ends_with([' ', '/']) {
                    plain.push(' ');
                }
            }
            other => plain.push(other),
        }
    }
    plain
}

fn unit_unwanted(number: &str, unit: &str) -> Problem {
    Problem::new(
        "",
        format!("unit {} is not allowed here", quoted(unit)),
        format!("write {}", cut(number)),
    )
}

fn unit_missing(number: &str, dimension: Dimension, usual: &str) -> Problem {
    let number = cut(number);
    Problem::new(
        "",
        format!("{number} has no unit, and {} needs one", dimension.name()),
        format!("write \"{number} {usual}\""),
    )
}

fn unit_wrong(unit: &str, dimension: Dimension) -> Problem {
    let fitting = dimension.symbols().collect::<Vec<_>>().join(", ");
    if let Some(other) = Dimension::of_unit(unit) {
        let cause =
            format!("{} is a unit of {}, not of {}", quoted(unit), bare(other), bare(dimension));
        return Problem::new("", cause, format!("use one of {fitting}"));
    }
    let (known, after) =
        unit.split_at(unit.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.').len());
    if !after.is_empty() && find(known.trim_end(), units_of(dimension)).is_some() {
        return Problem::new(
            "",
            format!("{after} after the unit"),
            format!("write all digits before {}", known.trim_end()),
        );
    }
    let spellings = units_of(dimension)
        .iter()
        .flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases))
        .copied();
    let near = suggest::nearest(&plain_spelling(unit), spellings)
        .and_then(|near| find(near, units_of(dimension)));
    let fix = near.map(|near| near.symbol).map_or_else(
        || format!("use one of {fitting}"),
        |near| format!("did you mean {near}? Units here: {fitting}"),
    );
    Problem::new("", format!("unknown unit {}", quoted(unit)), fix)
}

fn bare(dimension: Dimension) -> &'static str {
    let name = dimension.name();
    name.split_once(' ').map_or(name, |(_, bare)| bare)
}

/// The number and the unit after it.
fn split_number<'t>(text: &'t str, usual: &str) -> Result<(&'t str, &'t str), Problem> {
    let length = number_length(text);
    let (number, rest) = text.split_at(length);
    if length == 0 {
        return Err(no_number(text, usual));
    }
    if rest.starts_with(',') {
        return Err(comma(text));
    }
    let unit = rest.trim_start();
    let run_on = rest.starts_with(['.', '_', '\'']) || unit.starts_with(['+', '-']);
    let second_number = unit.starts_with(|c: char| c.is_ascii_digit()) && !is_reciprocal(unit);
    if run_on || second_number {
        return Err(Problem::new(
            "",
            format!("{} is not one number and its unit", quoted(text)),
            example(usual),
        ));
    }
    Ok((number, unit))
}

/// Whether the unit is a reciprocal: 1/min, 1 / min.
fn is_reciprocal(unit: &str) -> bool {
    unit.strip_prefix('1').is_some_and(|rest| rest.trim_start().starts_with('/'))
}

/// Length in bytes of the number at the start. 0 without a number.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits =
        |from: usize| bytes.iter().skip(from).take_while(|byte| byte.is_ascii_digit()).count();
    let mut at = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let whole = digits(at);
    at += whole;
    let mut fraction = 0;
    if bytes.get(at) == Some(&b'.') {
        fraction = digits(at + 1);
        at += 1 + fraction;
    }
    if whole + fraction == 0 {
        return 0;
    }
    if let Some(b'e' | b'E') = bytes.get(at) {
        let signed = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        let exponent = digits(at + 1 + signed);
        at += if exponent > 0 { 1 + signed + exponent } else { 0 };
    }
    at
}

/// Quotes of a word processor.
const CURLY: [char; 7] = ['“', '”', '„', '‘', '’', '«', '»'];

fn no_number(text: &str, usual: &str) -> Problem {
    let signless = text.trim_start_matches(['+', '-']);
    let word = signless.get(..3).unwrap_or_default().to_ascii_lowercase();
    if text.is_empty() {
        Problem::new("", "the value is missing", example(usual))
    } else if text.starts_with(['−', '–', '—', '‐', '‑', '－']) {
        let rest: String = text.chars().skip(1).collect();
        let cause = format!("{} begins with a dash that is not the minus sign", quoted(text));
        Problem::new("", cause, format!("write -{}", cut(&rest)))
    } else if text.starts_with(CURLY) {
        let cause = format!("{} has curly quotes", quoted(text));
        Problem::new("", cause, format!("write \"{}\"", cut(text.trim_matches(CURLY))))
    } else if word == "nan" || word == "inf" {
        Problem::new("", format!("{} is not a finite number", quoted(text)), example(usual))
    } else {
        Problem::new("", format!("{} does not begin with a number", quoted(text)), example(usual))
    }
}

fn comma(text: &str) -> Problem {
    let length = text
        .find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',' | '+' | '-')))
        .unwrap_or(text.len());
    let written = &text[..length];
    let with = |decimal: Option<char>| {
        let is_group = |c: char| ",.".contains(c) && Some(c) != decimal;
        cut(&written.replace(is_group, "").replace(',', "."))
    };
    let is_short = written.split(',').nth(1).is_some_and(|rest| rest.len() == 3);
    let meant = match (written.rfind('.'), written.matches(',').count()) {
        (Some(point), _) if Some(point) > written.rfind(',') => with(Some('.')),
        (None, 2..) => with(None),
        (None, _) if is_short => format!("{} or {}", with(None), with(Some(','))),
        _ => with(Some(',')),
    };
    let fix = format!("write {meant}, not {}", cut(written));
    Problem::new("", "a comma inside a number", fix)
}

fn example(usual: &str) -> String {
    if usual.is_empty() {
        "write a number such as 0.5".to_owned()
    } else {
        format!("write a number and its unit, such as \"20 {usual}\"")
    }
}

/// The f64 nearest to the decimal number times a power of ten.
fn shifted(number: &str, exponent: i32) -> f64 {
    let parsed = if exponent == 0 {
        number.parse()
    } else {
        let (digits, written) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
        let written = written.parse::<i64>().unwrap_or(if written.starts_with('-') {
            i64::MIN / 2
        } else {
            i64::MAX / 2
        });
        format!("{digits}e{}", written + i64::from(exponent)).parse()
    };
    parsed.unwrap_or(f64::NAN)
}

/// The value if an f64 can represent it with full precision.
fn held(number: &str, value: f64) -> Result<f64, Problem> {
    let digits = number.split(['e', 'E']).next().unwrap_or_default();
    let nonzero = digits.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if !value.is_finite() {
        Err(Problem::new(
            "",
            format!("{} is too large a number", quoted(number)),
            "write a smaller number",
        ))
    } else if nonzero && !value.is_normal() {
        Err(Problem::new(
            "",
            format!("{} is too close to zero for a floating-point number", quoted(number)),
            "write 0 or a larger number",
        ))
    } else {
        Ok(value)
    }
}

/// The shortest decimal of the value times a power of ten, without an exponent if the number stays
/// readable.
fn plain(value: f64, exponent: i32) -> String {
    let scientific = format!("{value:e}");
    let Some((mantissa, power)) = scientific.split_once('e') else {
        return scientific;
    };
    let power = power.parse::<i32>().unwrap_or(0) + exponent;
    let (sign, mantissa) = mantissa.strip_prefix('-').map_or(("", mantissa), |rest| ("-", rest));
    let digits = mantissa.replace('.', "");
    match usize::try_from(power) {
        _ if digits == "0" => "0".to_owned(),
        Ok(power) if power > 15 => format!("{sign}{mantissa}e{power}"),
        Ok(power) if power + 1 >= digits.len() => {
            format!("{sign}{digits:0<width$}", width = power + 1)
        }
        Ok(power) => format!("{sign}{}.{}", &digits[..=power], &digits[power + 1..]),
        Err(_) if power < -6 => format!("{sign}{mantissa}e{power}"),
        Err(_) => format!("{sign}0.{}{digits}", "0".repeat(power.unsigned_abs() as usize - 1)),
    }
}

/// The rest of a text that makes it a value: the unit after a bare number, or the rest of an
/// incomplete unit. `usual` is the unit of a bare number, and has priority for an incomplete unit;
/// otherwise only one unit may fit. `None` if the text is a value already, or cannot become one in
/// this way.
#[must_use]
pub fn ending(typed: &str, dimension: Dimension, usual: &str) -> Option<String> {
    let begun = begun_unit(typed, dimension)?;
    if begun.trim_end().is_empty() {
        let gap = if typed.ends_with(char::is_whitespace) { "" } else { " " };
        return Some(format!("{gap}{usual}")).filter(|_| !usual.is_empty());
    }
    if parse(typed, dimension, usual).is_ok() {
        return None;
    }
    let fitting = units_of(dimension).iter().filter_map(|unit| Some((unit, rest(unit, begun)?)));
    let fitting: Vec<_> = fitting.collect();
    let own = fitting.iter().find(|(unit, _)| unit.symbol == usual || fitting.len() == 1);
    own.map(|(_, rest)| (*rest).to_owned())
}

/// How further typing can change a text into another value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    /// By more digits or a unit: the text is a number or the beginning of one.
    Number,
    /// By more letters of its unit.
    Unit,
}

/// How further typing can change a text into a value or another value. `None` if it cannot.
#[must_use]
pub fn open(typed: &str, dimension: Dimension) -> Option<Open> {
    let is_begun = |begun: &&str| {
        !begun.is_empty() && units_of(dimension).iter().any(|unit| rest(unit, begun).is_some())
    };
    if is_number_begun(typed.trim()) {
        return Some(Open::Number);
    }
    begun_unit(typed, dimension).filter(is_begun).map(|_| Open::Unit)
}

/// The unit of a value as written. `None` if the text is not a value.
#[must_use]
pub fn written_unit(text: &str, dimension: Dimension) -> Option<&str> {
    parse(text, dimension, "").ok()?;
    split_number(text.trim(), "").ok().map(|(_, unit)| unit).filter(|unit| !unit.is_empty())
}

/// The text after the number, with blanks at its end. `None` if there is no number or no unit is
/// needed.
fn begun_unit(typed: &str, dimension: Dimension) -> Option<&str> {
    let (_, unit) =
        split_number(typed.trim_start(), "").ok().filter(|_| dimension != Dimension::Number)?;
    Some(unit)
}

/// The missing rest of the unit: of its symbol, or of the first matching spelling.
fn rest(unit: &Unit, begun: &str) -> Option<&'static str> {
    let plain = plain_spelling(begun);
    let mut spellings = std::iter::once(unit.symbol).chain(unit.aliases.iter().copied());
    spellings.find_map(|spelling| {
        let rest = spelling.strip_prefix(begun).or_else(|| spelling.strip_prefix(&*plain));
        rest.filter(|rest| !rest.is_empty())
    })
}

/// Whether the text is only a number or the beginning of one, such as `-`, `0.` or `1e`.
fn is_number_begun(text: &str) -> bool {
    let continued = format!("{text}0");
    number_length(&continued) == continued.len()
}

#[cfg(test)]
mod tests {
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
            assert_eq!(
                parse(text, dimension, "").map_err(|misread| misread.cause),
                Ok(si),
                "{text}"
            );
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
    fn every_dimension_finds_its_units() {
        for family in &FAMILIES {
            assert_eq!(family_of(family.dimension).name, family.name);
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
        for family in &FAMILIES {
            let spellings = family
                .units
                .iter()
                .flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases));
            for unit in spellings.filter(|spelling| !spelling.starts_with('1')) {
                let whole = format!("-1.5e-3 {unit}");
                for (end, _) in whole.char_indices() {
                    let typed = &whole[..end];
                    let is_value = parse(typed, family.dimension, "").is_ok();
                    assert!(is_value || open(typed, family.dimension).is_some(), "{typed}");
                }
            }
        }
        for typed in ["fast", "4,8", "48 x", "48 um", "48 umm", "1.2.3", "e5", "4 8"] {
            assert_eq!(open(typed, Dimension::Length), None, "{typed}");
        }
    }

    #[test]
    fn the_completed_text_is_a_value() {
        for family in &FAMILIES {
            for unit in family.units {
                for end in 1..=unit.symbol.len() {
                    let typed = format!("2 {}", &unit.symbol[..end]);
                    let whole = ended(&typed, family.dimension, family.units[0].symbol);
                    let is_open = whole == typed;
                    assert!(
                        is_open || parse(&whole, family.dimension, "").is_ok(),
                        "{typed} becomes {whole}"
                    );
                }
            }
        }
    }
}
