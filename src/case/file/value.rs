//! Converts a TOML value to the text of a field.

use toml::de::DeValue;

use crate::case::fields::Kind;
use crate::case::sanitize::quoted;
use crate::case::units::ParseError;

/// The text of a string. `Err(None)` for a value of another kind.
pub(super) fn words(value: &DeValue<'_>) -> Result<String, Option<ParseError>> {
    value.as_str().map(str::to_owned).ok_or(None)
}

/// The text of a boolean.
pub(super) fn flag(value: &DeValue<'_>) -> Result<String, Option<ParseError>> {
    match value {
        DeValue::Boolean(value) => Ok(value.to_string()),
        _ => Err(Some(ParseError::new(
            format!("expected true or false, found {}", kind_of(value)),
            "write true or false without quotes",
        ))),
    }
}

/// The text of a value with its unit. A bare number is accepted here, because the unit parser
/// reports the missing unit.
pub(super) fn measure(value: &DeValue<'_>) -> Result<String, Option<ParseError>> {
    scalar(value).ok_or(None)
}

/// The text of a number without quotes. `example` shows the notation.
pub(super) fn bare_number(
    value: &DeValue<'_>,
    example: &str,
) -> Result<String, Option<ParseError>> {
    match value.as_str() {
        Some(text) => {
            let cause = format!("{} is in quotes, and a number is not", quoted(text));
            let is_number = text.trim().parse::<f64>().is_ok();
            let fix = if is_number {
                "write the number without quotes".to_owned()
            } else {
                format!("write {example}, without quotes")
            };
            Err(Some(ParseError::new(cause, fix)))
        }
        None => scalar(value).ok_or(None),
    }
}

/// The text of a string or a number.
pub(super) fn scalar(value: &DeValue<'_>) -> Option<String> {
    match value {
        DeValue::String(text) => Some(text.to_string()),
        DeValue::Integer(number) if number.radix() == 10 => Some(number.as_str().to_owned()),
        DeValue::Integer(number) => i128::from_str_radix(number.as_str(), number.radix())
            .ok()
            .map(|number| number.to_string()),
        DeValue::Float(number) => Some(number.as_str().to_owned()),
        _ => None,
    }
}

pub(super) fn untaken(value: &DeValue<'_>, kind: Kind, example: &str) -> ParseError {
    let due = match kind {
        Kind::Text | Kind::Choice(..) => "a text in quotes",
        Kind::Number(..) | Kind::Count(..) => "a value",
    };
    misplaced(value, due, example)
}

pub(super) fn misplaced(value: &DeValue<'_>, due: &str, example: &str) -> ParseError {
    ParseError::new(format!("expected {due}, found {}", kind_of(value)), format!("write {example}"))
}

pub(super) fn kind_of(value: &DeValue<'_>) -> &'static str {
    const KINDS: [(&str, &str); 7] = [
        ("string", "a string"),
        ("integer", "a number"),
        ("float", "a number"),
        ("boolean", "true or false"),
        ("datetime", "a date"),
        ("array", "an array"),
        ("table", "a table"),
    ];
    KINDS
        .iter()
        .find(|(kind, _)| *kind == value.type_str())
        .map_or("something else", |(_, words)| words)
}
