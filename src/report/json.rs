//! JSON whose members keep their order and whose text is safe to print on a terminal.

use std::collections::BTreeMap;
use std::io::{self, Write};

use serde::Serialize;
use serde_json::ser::Formatter;
pub use serde_json::{Value as Json, json};

use crate::case::Problem;
use crate::case::sanitize::is_hidden;
use crate::model::Quantity;

/// An object, whose members [`write_line`] omits if they are null.
pub fn object<K: Into<String>>(members: impl IntoIterator<Item = (K, Json)>) -> Json {
    members.into_iter().collect()
}

/// An object with its members in the order of their names.
pub fn sorted<K: Into<String>>(members: impl IntoIterator<Item = (K, Json)>) -> Json {
    let members = members.into_iter().map(|(key, value)| (key.into(), value));
    object(members.collect::<BTreeMap<String, Json>>())
}

/// A value of a quantity in SI with its unit. `of` names the subject of the value, if it differs
/// from the result of the method.
#[must_use]
pub fn measured(quantity: &Quantity, value: f64, of: Option<&'static str>) -> Json {
    let number = if quantity.is_flag() { json!(value != 0.0) } else { json!(value) };
    json!({"value": number, "unit": quantity.unit, "of": of})
}

/// Why a case or a point has no result.
#[must_use]
pub fn reason(Problem { field, cause, fix, .. }: &Problem) -> Json {
    json!({"field": field, "cause": cause, "fix": fix.to_string()})
}

/// Writes a value as one line of JSON that is safe to print on a terminal. Members without a value
/// are omitted; a number that is not finite has none.
///
/// # Errors
/// Errors of the writer.
pub fn write_line(value: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    let mut value = serde_json::to_value(value)?;
    omit_absent(&mut value);
    value.serialize(&mut serde_json::Serializer::with_formatter(&mut *out, Safe))?;
    out.write_all(b"\n")
}

fn omit_absent(value: &mut Json) {
    match value {
        Json::Object(members) => {
            members.retain(|_, member| !member.is_null());
            members.values_mut().for_each(omit_absent);
        }
        Json::Array(values) => values.iter_mut().for_each(omit_absent),
        _ => {}
    }
}

/// Compact JSON that also escapes the characters that a terminal interprets or hides.
struct Safe;

impl Formatter for Safe {
    fn write_string_fragment<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        fragment: &str,
    ) -> io::Result<()> {
        let mut written = 0;
        for (at, hidden) in fragment.match_indices(is_hidden) {
            writer.write_all(&fragment.as_bytes()[written..at])?;
            hidden.encode_utf16().try_for_each(|unit| write!(writer, "\\u{unit:04x}"))?;
            written = at + hidden.len();
        }
        writer.write_all(&fragment.as_bytes()[written..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_keep_their_order_and_absent_values_are_omitted() {
        let mut out = Vec::new();
        let line = json!({"z": 1, "b": f64::NAN, "a": ["x"], "none": None::<f64>, "half": 0.5});
        write_line(&line, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "{\"z\":1,\"a\":[\"x\"],\"half\":0.5}\n");
    }

    #[test]
    fn control_characters_are_escaped_and_parse_to_the_same_text() {
        let text = "a\u{1b}[2J\u{7f}\u{9b}\u{202e}\u{e0041}\"\\\n é";
        let mut out = Vec::new();
        write_line(&text, &mut out).unwrap();
        let line = String::from_utf8(out).unwrap();
        assert_eq!(line, "\"a\\u001b[2J\\u007f\\u009b\\u202e\\udb40\\udc41\\\"\\\\\\n é\"\n");
        assert_eq!(serde_json::from_str::<String>(&line).unwrap(), text);
    }
}
