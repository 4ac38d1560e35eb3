//! The table of units, conversion between text with a unit and SI, and metric or inch units of shown
//! values.

use std::f64::consts::TAU;

use super::Problem;
use super::sanitize::{cut, nearest, quoted};
use crate::model::explanation::tidy;
use crate::numeric::decimal::significant;

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
    pub fn of_unit(unit: &str) -> Option<Dimension> {
        if matches!(unit, "" | "1") {
            return Some(Dimension::Number);
        }
        known(unit).map(|(dimension, _)| dimension)
    }

    /// The name of a value with its article, such as "a length".
    pub fn name(self) -> &'static str {
        UNITS[self as usize].1
    }

    /// The SI unit; empty for the bare number.
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
pub fn symbol(unit: &str) -> Option<&'static str> {
    known(unit).map(|(_, unit)| unit.symbol)
}

/// Whether the unit is a power of ten of the SI unit.
pub fn is_metric(unit: &str) -> bool {
    known(unit).is_some_and(|(_, unit)| matches!(unit.scale, Scale::Ten(_)))
}

/// The SI value of one unit. `None` for an unknown unit. "1" and "" have the factor 1.
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
        (Dimension::Number, _) => return Err(unit_unwanted(text, unit)),
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
pub fn text(value: f64, unit: &str) -> String {
    let number = number(value, unit);
    if matches!(unit, "" | "1") { number } else { format!("{number} {unit}") }
}

/// A value in SI as a number of a unit, without the rounding error of a division: 0.0508, not
/// 0.050800000000000005.
pub fn in_unit(value: f64, unit: &str) -> f64 {
    number(value, unit).parse().unwrap_or(value)
}

fn number(value: f64, unit: &str) -> String {
    match known(unit).map(|(_, unit)| unit.scale) {
        None => plain(value, 0),
        Some(Scale::Ten(exponent)) => plain(value, -exponent),
        Some(Scale::Times(factor, rest)) => {
            let short = (12..17).map(|digits| format!("{:.digits$e}", value / factor));
            let mut same = short.map(|short| shifted(&short, 0));
            let same = same.find(|&short| times(short, factor, rest).to_bits() == value.to_bits());
            plain(same.unwrap_or(value / factor), 0)
        }
    }
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
    spelled(unit, |text| units.iter().find(|unit| unit.is_spelled(text)))
}

/// A unit of any dimension.
fn known(unit: &str) -> Option<(Dimension, &'static Unit)> {
    let own = |text: &str, units: &'static [Unit]| units.iter().find(|unit| unit.is_spelled(text));
    spelled(unit, |text| {
        UNITS.iter().find_map(|(dimension, _, units)| Some((*dimension, own(text, units)?)))
    })
}

/// What is found by a unit as it is written, or else by its plain spelling.
fn spelled<T>(unit: &str, found: impl Fn(&str) -> Option<T>) -> Option<T> {
    let short = Some(unit).filter(|unit| unit.len() <= LONGEST)?;
    found(short).or_else(|| found(&plain_spelling(short)))
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

fn unit_unwanted(text: &str, unit: &str) -> Problem {
    let cause = match known(unit) {
        Some(_) => format!("this value has no unit such as {}", quoted(unit)),
        None => format!("{} is not a number", quoted(text.trim())),
    };
    Problem::new("", cause, example(""))
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
    let spellings = units_of(dimension)
        .iter()
        .flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases))
        .copied();
    let near =
        nearest(&plain_spelling(unit), spellings).and_then(|near| find(near, units_of(dimension)));
    let fix = near.map(|near| near.symbol).map_or_else(
        || format!("use one of {fitting}"),
        |near| format!("did you mean {near}? Units here: {fitting}"),
    );
    Problem::new("", format!("unknown unit {}", quoted(unit)), fix)
}

fn bare(dimension: Dimension) -> &'static str {
    dimension.name().split_once(' ').map_or("", |(_, bare)| bare)
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
    // A whole unit without its second one, such as kN for a torque, is a slip.
    let is_only = |rest: &str| fitting.len() == 1 && !rest.starts_with(' ');
    let own = fitting.iter().find(|(unit, rest)| unit.symbol == usual || is_only(rest));
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

/// The SI value of one unit.
#[derive(Debug, Clone, Copy)]
enum Scale {
    /// A power of ten, applied to the decimal digits and therefore exact.
    Ten(i32),
    /// Another factor: the nearest f64 and the remainder.
    Times(f64, f64),
}

/// One unit of a dimension.
#[derive(Debug, Clone, Copy)]
struct Unit {
    /// The spelling that messages use.
    symbol: &'static str,
    aliases: &'static [&'static str],
    scale: Scale,
}

impl Unit {
    fn is_spelled(&self, text: &str) -> bool {
        self.symbol == text || self.aliases.contains(&text)
    }
}

const fn ten(symbol: &'static str, aliases: &'static [&'static str], exponent: i32) -> Unit {
    Unit { symbol, aliases, scale: Scale::Ten(exponent) }
}

const fn scaled(
    symbol: &'static str,
    aliases: &'static [&'static str],
    factor: f64,
    rest: f64,
) -> Unit {
    Unit { symbol, aliases, scale: Scale::Times(factor, rest) }
}

/// The units of a dimension. Empty for a bare number.
fn units_of(dimension: Dimension) -> &'static [Unit] {
    UNITS[dimension as usize].2
}

// Exact by definition: in = 25.4 mm, lb = 0.45359237 kg, standard gravity 9.80665 m/s2, hp = 550 ft
// lbf/s, PS = 75 kgf m/s. Both parts of each factor come from rational arithmetic, with pi to 80
// digits.
/// Every dimension in the order of [`Dimension`], the name of a value with its article, and its
/// units in the order of messages.
#[rustfmt::skip]
static UNITS: [(Dimension, &str, &[Unit]); 18] = [
    (Dimension::Number, "a number", &[]),
    (Dimension::Length, "a length", &[
        ten("mm", &[], -3),
        ten("um", &["micron", "microns"], -6),
        ten("m", &[], 0),
        ten("cm", &[], -2),
        ten("nm", &[], -9),
        scaled("in", &["inch", "inches"], 0.0254, 1.0325074129013955e-18),
        scaled("thou", &["mil", "mils"], 2.54e-5, -7.564261716996867e-22),
        scaled("ft", &["foot", "feet"], 0.3048, -1.5365486660812166e-17),
    ]),
    (Dimension::Angle, "an angle", &[
        scaled("deg", &["°", "degree", "degrees"], 0.017453292519943295, 2.9486522708701687e-19),
        ten("rad", &[], 0),
        ten("mrad", &[], -3),
        scaled("arcmin", &[], 0.0002908882086657216, 1.5756442176305324e-20),
        scaled("arcsec", &[], 4.84813681109536e-6, 9.320078015422868e-23),
    ]),
    (Dimension::Pressure, "a pressure", &[
        ten("GPa", &["kN/mm2", "N/(mm um)"], 9),
        ten("MPa", &["N/mm2"], 6),
        ten("kPa", &[], 3),
        ten("Pa", &["N/m2"], 0),
        scaled("psi", &["lbf/in2"], 6894.757293168362, -3.476429902321071e-13),
        scaled("ksi", &[], 6894757.293168361, 3.798276331961447e-11),
        scaled("Mpsi", &[], 6894757293.168362, -3.270956859296531e-7),
    ]),
    (Dimension::Density, "a density", &[
        ten("kg/m3", &[], 0),
        ten("g/cm3", &["kg/dm3", "g/cc", "kg/l", "kg/L"], 3),
        scaled("lb/in3", &["lbm/in3"], 27679.90471020312, -6.009765667261031e-13),
    ]),
    (Dimension::Power, "a power", &[
        ten("kW", &[], 3),
        ten("W", &[], 0),
        ten("MW", &[], 6),
        ten("mW", &[], -3),
        scaled("hp", &["HP", "bhp"], 745.6998715822702, -2.7927226591855287e-14),
        scaled("PS", &[], 735.49875, 2.7284841053187846e-14),
    ]),
    (Dimension::Torque, "a torque", &[
        ten("N m", &["Nm"], 0),
        ten("kN m", &["kNm"], 3),
        ten("N mm", &["Nmm", "mN m", "mNm"], -3),
        ten("N cm", &["Ncm"], -2),
        ten("MN m", &["MNm"], 6),
        scaled("lbf in", &["lb in", "in lbf", "in lb", "lbfin"], 0.1129848290276167, 4.448527496788302e-18),
        scaled("lbf ft", &["lb ft", "ft lbf", "ft lb", "lbfft"], 1.3558179483314003, 5.338232996145962e-17),
    ]),
    (Dimension::AngularVelocity, "an angular velocity", &[
        scaled("rpm", &["1/min", "min-1", "min^-1", "min⁻¹", "rev/min", "r/min", "RPM", "U/min"], 0.10471975511965978, -5.1697025413851275e-18),
        ten("rad/s", &[], 0),
        scaled("deg/s", &["°/s"], 0.017453292519943295, 2.9486522708701687e-19),
        scaled("rev/s", &["rps", "r/s"], TAU, 2.4492935982947064e-16),
    ]),
    (Dimension::Force, "a force", &[
        ten("N", &[], 0),
        ten("kN", &[], 3),
        ten("MN", &[], 6),
        ten("mN", &[], -3),
        scaled("lbf", &[], 4.4482216152605, 3.604674457164947e-16),
    ]),
    (Dimension::Time, "a time", &[
        ten("us", &[], -6),
        ten("ms", &[], -3),
        ten("s", &[], 0),
        ten("ns", &[], -9),
    ]),
    (Dimension::Velocity, "a velocity", &[
        ten("m/s", &[], 0),
        ten("mm/s", &[], -3),
        scaled("ft/s", &[], 0.3048, -1.5365486660812166e-17),
        scaled("in/s", &[], 0.0254, 1.0325074129013955e-18),
        scaled("m/min", &[], 0.016666666666666666, 2.312964634635743e-19),
        scaled("ft/min", &["fpm"], 0.00508, -3.1391556021276303e-19),
        scaled("km/h", &[], 0.2777777777777778, -1.2335811384723961e-17),
    ]),
    (Dimension::Mass, "a mass", &[
        ten("kg", &[], 0),
        ten("g", &[], -3),
        ten("mg", &[], -6),
        ten("t", &[], 3),
        scaled("lb", &["lbm"], 0.45359237, -2.2489672346637234e-17),
    ]),
    (Dimension::Energy, "an energy", &[
        ten("J", &[], 0),
        ten("mJ", &[], -3),
        ten("uJ", &[], -6),
        ten("kJ", &[], 3),
        scaled("ft lbf", &["ft lb"], 1.3558179483314003, 5.338232996145962e-17),
        scaled("in lbf", &["in lb"], 0.1129848290276167, 4.448527496788302e-18),
    ]),
    (Dimension::Inertia, "a moment of inertia", &[
        ten("kg m2", &["kgm2"], 0),
        ten("kg cm2", &["kgcm2"], -4),
        ten("kg mm2", &["kgmm2", "g m2"], -6),
        ten("g cm2", &["gcm2"], -7),
        scaled("lb in2", &["lbm in2"], 0.0002926396534292, 8.897395017015697e-21),
        scaled("lb ft2", &["lbm ft2"], 0.0421401100938048, 1.2812248824502604e-18),
    ]),
    (Dimension::Compliance, "a compliance per width", &[
        ten("um mm/N", &["mm um/N"], -9),
        ten("m2/N", &[], 0),
        ten("mm2/N", &[], -6),
        scaled("in2/lbf", &[], 0.0001450377377302092, 4.005255956746474e-21),
    ]),
    (Dimension::Stiffness, "a stiffness", &[
        ten("N/um", &["N/µm", "kN/mm"], 6),
        ten("N/m", &[], 0),
        ten("N/mm", &[], 3),
        scaled("lbf/in", &["lb/in"], 175.1268352464764, -1.1376717116859719e-14),
    ]),
    (Dimension::Frequency, "a frequency", &[
        ten("Hz", &[], 0),
        ten("kHz", &[], 3),
    ]),
    (Dimension::DiametralPitch, "a diametral pitch", &[
        scaled("1/in", &["/in", "1/inch", "in-1", "in^-1", "in⁻¹", "DP"], 39.37007874015748, -1.1189649382048822e-15),
        ten("1/mm", &["/mm", "mm-1", "mm^-1", "mm⁻¹"], 3),
        ten("1/m", &["/m", "m-1", "m^-1", "m⁻¹"], 0),
    ]),
];

/// The units of shown values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum System {
    /// mm, um, N, kW, N m, GPa
    #[default]
    Metric,
    /// in, thou, lbf, hp, lbf ft, ksi
    Inch,
}

/// Each shown metric unit and its inch unit. Both systems use units that are not in this list, such
/// as deg, rpm or us.
const PAIRS: [(&str, &str); 22] = [
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
    ("N/(mm um)", "psi"),
    ("N/um", "lbf/in"),
    ("N/mm", "lbf/in"),
];

impl System {
    /// Both systems, in the order of the key that switches between them.
    pub const ALL: [System; 2] = [System::Metric, System::Inch];

    /// The name in settings and messages.
    pub fn name(self) -> &'static str {
        ["metric", "inch"][self as usize]
    }

    /// The system with this name.
    pub fn find(name: &str) -> Option<System> {
        System::ALL.into_iter().find(|system| system.name() == name)
    }

    /// The other system.
    pub fn other(self) -> System {
        System::ALL[1 - self as usize]
    }

    /// The system of a unit that only one of them uses.
    pub fn of_unit(unit: &str) -> Option<System> {
        let of = |&(metric, inch): &(_, _)| [metric, inch].iter().position(|own| *own == unit);
        PAIRS.iter().find_map(of).map(|at| System::ALL[at])
    }

    /// The unit of this system that corresponds to a written unit. Other units stay unchanged.
    pub fn unit(self, written: &str) -> &str {
        let inch = PAIRS.iter().find(|(from, _)| *from == written);
        match inch {
            Some((_, inch)) if self == System::Inch => inch,
            _ => written,
        }
    }

    /// A value in SI as a number of the unit that corresponds to a metric unit.
    pub fn number(self, value: f64, metric: &str, digits: usize) -> String {
        tidy(per(value, self.unit(metric)), digits)
    }

    /// The same number with its unit, unless that is empty.
    pub fn text(self, value: f64, metric: &str, digits: usize) -> String {
        let text = format!("{} {}", self.number(value, metric, digits), self.unit(metric));
        text.trim_end().to_owned()
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

/// A value in SI as a number of a unit, with the rounding error of the division.
pub fn per(value: f64, unit: &str) -> f64 {
    value / factor(unit).unwrap_or(1.0)
}

/// A value in SI converted to a unit, with exactly this many significant digits, with an exponent
/// if needed.
pub fn counted(value: f64, unit: &str, digits: usize) -> String {
    let number = per(value, unit);
    if has_more_places(value, unit, digits) {
        format!("{number:.*e}", digits.saturating_sub(1))
    } else {
        significant(number, digits)
    }
}

// Whether the rounded number has more places before its point than digits.
fn has_more_places(value: f64, unit: &str, digits: usize) -> bool {
    let number = per(value, unit).abs();
    let end = 10f64.powi(i32::try_from(digits).unwrap_or(i32::MAX));
    number.is_finite() && number.round() >= end
}

/// A value in SI as this system shows it: the number with this many significant digits, and its
/// unit, empty for a bare number.
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
    let short = significant(per(value, unit), digits);
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
mod tests;
