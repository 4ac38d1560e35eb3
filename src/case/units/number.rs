//! The number before a unit: parsed, scaled by powers of ten, and checked against the range of f64.

use super::ParseError;
use crate::case::sanitize::{cut, quoted};

/// The number and the unit after it.
pub(super) fn split<'t>(text: &'t str, usual: &str) -> Result<(&'t str, &'t str), ParseError> {
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
        return Err(ParseError::new(
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

fn no_number(text: &str, usual: &str) -> ParseError {
    let signless = text.trim_start_matches(['+', '-']);
    let word = signless.get(..3).unwrap_or_default().to_ascii_lowercase();
    if text.is_empty() {
        ParseError::new("the value is missing", example(usual))
    } else if text.starts_with(['−', '–', '—', '‐', '‑', '－']) {
        let rest: String = text.chars().skip(1).collect();
        let cause = format!("{} begins with a dash that is not the minus sign", quoted(text));
        ParseError::new(cause, format!("write -{}", cut(&rest)))
    } else if text.starts_with(CURLY) {
        let cause = format!("{} has curly quotes", quoted(text));
        ParseError::new(cause, format!("write \"{}\"", cut(text.trim_matches(CURLY))))
    } else if word == "nan" || word == "inf" {
        ParseError::new(format!("{} is not a finite number", quoted(text)), example(usual))
    } else {
        ParseError::new(format!("{} does not begin with a number", quoted(text)), example(usual))
    }
}

fn comma(text: &str) -> ParseError {
    let length = text
        .find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ',' | '+' | '-')))
        .unwrap_or(text.len());
    let written = &text[..length];
    let point_last = written.rfind('.') > written.rfind(',');
    let groups = written.contains('.') || written.matches(',').count() > 1;
    if !groups && written.split(',').nth(1).is_some_and(|rest| rest.len() == 3) {
        let (plain, point) = (written.replace(',', ""), written.replace(',', "."));
        return ParseError::new(
            "a comma inside a number",
            format!("write {} or {}, not {}", cut(&plain), cut(&point), cut(written)),
        );
    }
    if written.contains('.') && !point_last {
        let meant = written.replace('.', "").replace(',', ".");
        return ParseError::new(
            "a comma inside a number",
            format!("write {}, not {}", cut(&meant), cut(written)),
        );
    }
    let meant = if groups { written.replace(',', "") } else { written.replace(',', ".") };
    ParseError::new(
        "a comma inside a number",
        format!("write {}, not {}", cut(&meant), cut(written)),
    )
}

fn example(usual: &str) -> String {
    if usual.is_empty() {
        "write a number such as 0.5".to_owned()
    } else {
        format!("write a number and its unit, such as \"20 {usual}\"")
    }
}

/// The f64 nearest to the decimal number times a power of ten.
pub(super) fn shifted(number: &str, exponent: i32) -> f64 {
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
pub(super) fn held(number: &str, value: f64) -> Result<f64, ParseError> {
    let digits = number.split(['e', 'E']).next().unwrap_or_default();
    let nonzero = digits.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
    if !value.is_finite() {
        Err(ParseError::new(
            format!("{} is too large a number", quoted(number)),
            "write a smaller number",
        ))
    } else if nonzero && !value.is_normal() {
        Err(ParseError::new(
            format!("{} is too close to zero for a floating-point number", quoted(number)),
            "write 0 or a larger number",
        ))
    } else {
        Ok(value)
    }
}

/// The shortest decimal of the value times a power of ten, without an exponent if the number stays
/// readable.
pub(super) fn plain(value: f64, exponent: i32) -> String {
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
