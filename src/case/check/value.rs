//! The value of one field from its text, checked against the range of the field.

use std::sync::LazyLock;

use super::problem::Problem;
use crate::case::fields::{AUTO, FIELDS, Field, Kind, Range, Value};
use crate::case::sanitize::quoted;
use crate::case::suggest;
use crate::case::units::{self, Dimension};
use crate::numeric::decimal::shortest;

/// The value of a field from its text, checked against the range of the field.
///
/// # Errors
/// If the text is not a value of the field, or the value is outside the range.
pub fn field_value(field: usize, text: &str) -> Result<Value, Problem> {
    read_value(&FIELDS[field], field, text)
}

fn read_value(known: &Field, field: usize, text: &str) -> Result<Value, Problem> {
    match known.kind {
        Kind::Text => Ok(Value::Text),
        Kind::Number(dimension, range, _) => {
            number(known, field, text, dimension, range).map(Value::Number)
        }
        Kind::Count(from, to, _) => count(known, text, from, to).map(Value::Count),
        Kind::Choice(names, _) => choice(known, text, names).map(Value::Choice),
    }
}

/// The least and the greatest value of a number field, in SI.
#[must_use]
pub fn field_range(field: usize) -> (f64, f64) {
    ENDS[field]
}

/// The ends of every range in SI, converted like a value, so that the ends themselves are inside.
static ENDS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let end = |value: f64, dimension, unit| {
        units::parse(&format!("{value} {unit}"), dimension, unit).unwrap_or(f64::NAN)
    };
    FIELDS
        .iter()
        .map(|field| match field.kind {
            Kind::Number(dimension, range, _) => {
                (end(range.from, dimension, range.unit), end(range.to, dimension, range.unit))
            }
            _ => (0.0, 0.0),
        })
        .collect()
});

fn number(
    known: &Field,
    field: usize,
    text: &str,
    dimension: Dimension,
    range: Range,
) -> Result<f64, Problem> {
    let (from, to) = ENDS[field];
    let value = units::parse(text, dimension, known.usual_unit()).map_err(|misread| {
        let likely = likely_units(text, known, dimension, (from, to));
        let of_unit = |unit: &str| units::parse(text, dimension, unit).err();
        let [first, others @ ..] = &*likely else {
            return Problem::of(known.key, misread);
        };
        let problem = Problem::of(known.key, of_unit(first).unwrap_or(misread));
        // A bare number may mean several units.
        let fixes = others.iter().filter_map(|unit| of_unit(unit));
        let other = fixes.map(|other| other.fix).find(|fix| *fix != problem.fix);
        let other = other.as_deref().and_then(|fix| fix.strip_prefix("write "));
        let fix = match other {
            Some(other) => format!("{} or {other}", problem.fix),
            None => problem.fix,
        };
        Problem { fix, ..problem }
    })?;
    // The same end in another unit can differ by rounding.
    let slack = 4.0 * f64::EPSILON;
    if value < from - slack * from.abs() {
        return Err(outside(known, text, "below", shortest(range.from), range.unit));
    }
    if value > to + slack * to.abs() {
        return Err(outside(known, text, "above", shortest(range.to), range.unit));
    }
    Ok(value)
}

/// The units that the user most likely meant for a bare number: the usual unit or another one with a
/// value inside the range, and a second common unit if it fits, too.
fn likely_units(
    text: &str,
    known: &Field,
    dimension: Dimension,
    (from, to): (f64, f64),
) -> Vec<&'static str> {
    const COMMON: usize = 2;
    let usual = known.usual_unit();
    let fits = |unit: &&str| {
        let value = units::parse(&format!("{} {unit}", text.trim()), dimension, unit);
        value.is_ok_and(|value| (from..=to).contains(&value))
    };
    let others = || dimension.symbols().filter(|&unit| unit != usual).filter(fits);
    let first = std::iter::once(usual).chain(others()).find(fits);
    let is_common = |unit: &&str| dimension.symbols().take(COMMON).any(|common| common == *unit);
    let second = others().find(|unit| is_common(unit) && Some(*unit) != first);
    first.into_iter().chain(second).collect()
}

fn outside(
    known: &Field,
    text: &str,
    side: &str,
    end: impl std::fmt::Display,
    unit: &str,
) -> Problem {
    let end = format!("{end} {unit}");
    let cause = format!("{} is {side} the limit of {}", quoted(text), end.trim_end());
    Problem::new(known.key, cause, format!("write a value from {}", known.range_text()))
}

fn count(known: &Field, text: &str, from: u32, to: u32) -> Result<u32, Problem> {
    let text = text.trim();
    if known.takes_auto() && text == AUTO {
        return Ok(0);
    }
    let digits = text.strip_prefix('+').unwrap_or(text);
    match digits.parse::<u32>() {
        Ok(value) if value < from => Err(outside(known, text, "below", from, "")),
        Ok(value) if value <= to => Ok(value),
        _ if !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()) => {
            Err(outside(known, text, "above", to, ""))
        }
        _ => Err(not_whole(known, text)),
    }
}

fn not_whole(known: &Field, text: &str) -> Problem {
    let example =
        format!("write a whole number from {}, such as {}", known.range_text(), known.example());
    match units::parse(text, Dimension::Number, "") {
        Ok(value) if value < 0.0 => {
            outside(known, text, "below", known.range_text().split(' ').next().unwrap_or("0"), "")
        }
        Ok(_) => {
            Problem::new(known.key, format!("{} is not a whole number", quoted(text)), example)
        }
        Err(misread) if misread.cause.starts_with("unit") => Problem::of(known.key, misread),
        Err(misread) => Problem::new(known.key, misread.cause, example),
    }
}

fn choice(known: &Field, text: &str, names: &'static [&'static str]) -> Result<usize, Problem> {
    let name = text.trim();
    if let Some(index) = names.iter().position(|&known| known == name) {
        return Ok(index);
    }
    let fix =
        suggest::fix(name, names.iter().copied(), || format!("use one of {}", names.join(", ")));
    Err(Problem::new(known.key, format!("unknown choice {}", quoted(name)), fix))
}
