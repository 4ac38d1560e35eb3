//! JSON whose members keep their order and whose text is safe to print on a terminal.

use std::borrow::Cow;
use std::io::{self, Write};

use serde::{Serialize, Serializer};
use serde_json::ser::Formatter;

use crate::case::Problem;
use crate::case::sanitize::is_hidden;
use crate::model::Quantity;

/// A JSON value.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Json {
    /// No value; an object omits the member.
    Absent,
    /// A truth value.
    Flag(bool),
    /// A whole number.
    Count(u64),
    /// A finite number.
    Number(f64),
    /// A text.
    Text(String),
    /// A list.
    List(Vec<Json>),
    /// An object.
    Object(#[serde(serialize_with = "members")] Vec<(Cow<'static, str>, Json)>),
}

fn members<S: Serializer>(
    members: &[(Cow<'static, str>, Json)],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let given = members.iter().filter(|(_, value)| *value != Json::Absent);
    serializer.collect_map(given.map(|(key, value)| (key, value)))
}

impl From<bool> for Json {
    fn from(flag: bool) -> Json {
        Json::Flag(flag)
    }
}

impl From<usize> for Json {
    fn from(count: usize) -> Json {
        Json::Count(count as u64)
    }
}

impl From<u32> for Json {
    fn from(count: u32) -> Json {
        Json::Count(count.into())
    }
}

impl From<u64> for Json {
    fn from(count: u64) -> Json {
        Json::Count(count)
    }
}

impl From<f64> for Json {
    fn from(number: f64) -> Json {
        if number.is_finite() { Json::Number(number) } else { Json::Absent }
    }
}

impl From<&str> for Json {
    fn from(text: &str) -> Json {
        Json::Text(text.to_owned())
    }
}

impl From<String> for Json {
    fn from(text: String) -> Json {
        Json::Text(text)
    }
}

impl From<&String> for Json {
    fn from(text: &String) -> Json {
        Json::Text(text.clone())
    }
}

impl<T: Into<Json>> From<Option<T>> for Json {
    fn from(value: Option<T>) -> Json {
        value.map_or(Json::Absent, Into::into)
    }
}

/// A list becomes a list, so that an iterator ends in `collect`.
impl<T: Into<Json>> FromIterator<T> for Json {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Json {
        Json::List(values.into_iter().map(Into::into).collect())
    }
}

/// An object.
pub fn object<K: Into<Cow<'static, str>>>(members: impl IntoIterator<Item = (K, Json)>) -> Json {
    Json::Object(members.into_iter().map(|(key, value)| (key.into(), value)).collect())
}

impl Json {
    /// The object with further members.
    #[must_use]
    pub fn with<const N: usize>(mut self, more: [(&'static str, Json); N]) -> Json {
        if let Json::Object(members) = &mut self {
            members.extend(more.map(|(key, value)| (key.into(), value)));
        }
        self
    }
}

/// An object with its members in the order of their names.
pub fn sorted<K: Into<Cow<'static, str>>>(members: impl IntoIterator<Item = (K, Json)>) -> Json {
    let members = members.into_iter().map(|(key, value)| (key.into(), value));
    object(members.collect::<std::collections::BTreeMap<Cow<'static, str>, Json>>())
}

/// A text; absent if it is empty.
#[must_use]
pub fn unless_empty(text: &str) -> Json {
    Some(text).filter(|text| !text.is_empty()).into()
}

/// A value of a quantity in SI with its unit. `of` names the subject of the value, if it differs
/// from the result of the method.
#[must_use]
pub fn measured(quantity: &Quantity, value: f64, of: Option<&'static str>) -> Json {
    let number = if quantity.is_flag() { Json::Flag(value != 0.0) } else { value.into() };
    object([("value", number), ("unit", quantity.unit.into()), ("of", of.into())])
}

/// Why a case or a point has no result.
#[must_use]
pub fn reason(Problem { field, cause, fix, .. }: &Problem) -> Json {
    object([("field", field.into()), ("cause", cause.into()), ("fix", fix.to_string().into())])
}

/// Writes a value as one line of JSON that is safe to print on a terminal.
///
/// # Errors
/// Errors of the writer.
pub fn write_line(value: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    value.serialize(&mut serde_json::Serializer::with_formatter(&mut *out, Safe))?;
    out.write_all(b"\n")
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
        let line = object([
            ("z", 1usize.into()),
            ("b", f64::NAN.into()),
            ("a", ["x"].into_iter().collect()),
            ("none", Json::from(None::<f64>)),
            ("half", 0.5.into()),
        ]);
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
