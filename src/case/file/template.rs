//! The text of a new case: every field with its help. Optional fields are comments.

use std::fmt::Write;

use super::FORMAT;
use crate::case::fields::{Absent, FIELDS, FLAG, Field, GROUPS, index_of};
use crate::case::sanitize::{is_hidden, sanitize};
use crate::case::units::{self, Dimension};
use crate::case::{Case, Override, Variant, check};

/// A key and its value as written in a file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Entry {
    /// The table, empty for the top level.
    pub(super) table: &'static str,
    /// The key within the table.
    pub(super) name: String,
    /// The value in TOML.
    pub(super) value: String,
}

impl Entry {
    pub(super) fn line(&self) -> String {
        format!("{} = {}", self.name, self.value)
    }
}

/// All entries of a case, in the order of a new file.
pub(super) fn entries(case: &Case) -> Vec<Entry> {
    let fields = FIELDS.iter().enumerate().filter_map(|(index, field)| {
        let value = value(field, case.text(index)?);
        Some(Entry { table: field.table(), name: field.name().to_owned(), value })
    });
    let limits = case.limits.iter().filter(|limit| !limit.text.is_empty()).map(|limited| Entry {
        table: "limits",
        name: limited.quantity.to_owned(),
        value: limit(&limited.text),
    });
    let spread = case.spread.iter().map(|spread| Entry {
        table: "spread",
        name: format!("\"{}\"", spread.field),
        value: distribution(spread.shape.name(), &spread.text),
    });
    fields.chain(limits).chain(spread).collect()
}

/// An override of a variant as written in its table: the quoted key and the value.
pub(super) fn override_entry(change: &Override) -> (String, String) {
    let (key, text) = (&change.key, &change.text);
    let field = index_of(key).map(|field| &FIELDS[field]);
    let name = if field.is_some_and(|field| field.table().is_empty()) {
        key.clone()
    } else {
        format!("\"{}\"", key.replace('"', ""))
    };
    let value = match (field, text.split_once(' ')) {
        _ if text.is_empty() => string(""),
        (Some(field), _) => value(field, text),
        (None, Some((shape, width))) if key.starts_with("spread.") => distribution(shape, width),
        _ => limit(text),
    };
    (name, value)
}

fn limit(text: &str) -> String {
    if units::parse(text, Dimension::Number, "").is_ok() { number(text) } else { string(text) }
}

fn distribution(shape: &str, width: &str) -> String {
    format!("{{ {shape} = {} }}", limit(width))
}

/// A commented case, valid if the case is valid. `comments` are additional comments by key.
pub(super) fn text(case: &Case, comments: &[(&str, String)]) -> String {
    let entries = entries(case);
    let mut text = format!(
        "# A gear pair for tipstrike.\n# A value with a dimension is a string with its unit; any \
            unit of the dimension is valid.\nformat = {FORMAT}\n"
    );
    for (table, title) in GROUPS {
        if !table.is_empty() {
            let _ = write!(text, "\n# {title}\n[{table}]\n");
        }
        for (index, field) in FIELDS.iter().enumerate() {
            if field.table() == table {
                let written =
                    entries.iter().find(|entry| entry.table == table && entry.name == field.name());
                let line = written.map_or_else(|| unwritten(case, index), Entry::line);
                let comments = comments.iter().filter(|(key, _)| *key == field.key);
                let comments = comments.map(|(_, comment)| comment.as_str());
                text.push_str(&described(field, &line, comments));
            }
        }
    }
    text.push_str(&rest(
        &entries,
        "limits",
        "Greatest allowed value of any quantity of the results.",
        "impact_force = \"2500 N\"",
    ));
    text.push_str(&rest(
        &entries,
        "spread",
        "Distribution of a field around its value, for tolerance.",
        "\"deviations.base_pitch\" = { normal = \"4 um\" }",
    ));
    text.push_str(&variants(&case.variants));
    text
}

fn variants(variants: &[Variant]) -> String {
    let mut text =
        "\n# Overrides of the case, for compare, --variant and the workbench.\n".to_owned();
    if variants.is_empty() {
        text.push_str("# [variants.relieved]\n# \"driven.tip_relief\" = \"48 um\"\n");
    }
    for (at, variant) in variants.iter().enumerate() {
        let blank = if at > 0 { "\n" } else { "" };
        let _ = writeln!(text, "{blank}[variants.{}]", key_of(&variant.name));
        for change in &variant.overrides {
            let (name, value) = override_entry(change);
            let _ = writeln!(text, "{name} = {value}");
        }
    }
    text
}

/// A name as a key, with quotes if TOML needs them.
pub(super) fn key_of(name: &str) -> String {
    let is_bare = |byte: u8| byte.is_ascii_alphanumeric() || b"-_".contains(&byte);
    if name.bytes().all(is_bare) { name.to_owned() } else { string(name) }
}

fn described<'a>(field: &Field, line: &str, comments: impl Iterator<Item = &'a str>) -> String {
    let symbol =
        if field.symbol.is_empty() { String::new() } else { format!("{}: ", field.symbol) };
    let range = field.range_text();
    let range = if range.is_empty() { range } else { format!(" [{range}]") };
    let absent = match field.absent {
        Absent::Without(words) => format!(" Left out: {words}."),
        _ => String::new(),
    };
    let comments = comments.fold(String::new(), |mut lines, comment| {
        let _ = writeln!(lines, "# {}", sanitize(comment));
        lines
    });
    format!("# {symbol}{}{range}{absent}\n{comments}{line}\n", field.help)
}

/// A field without a value: an empty text if required, otherwise an example as a comment.
fn unwritten(case: &Case, index: usize) -> String {
    let field = &FIELDS[index];
    let (name, assignment) = (field.name(), check::assignment(field));
    let example = assignment.split_once(" = ").map_or("", |(_, value)| value);
    let other = field.partner();
    if !case.lacks(index) || other.is_some_and(|other| other < index) {
        return format!("# {assignment}");
    }
    let unless = other
        .map_or_else(String::new, |other| format!(" unless {} is given", FIELDS[other].name()));
    format!("{name} = \"\"  # required{unless}, such as {example}")
}

fn rest(entries: &[Entry], table: &str, help: &str, example: &str) -> String {
    let mut text = format!("\n# {help}\n[{table}]\n");
    let lines: Vec<String> =
        entries.iter().filter(|entry| entry.table == table).map(Entry::line).collect();
    let lines = if lines.is_empty() { format!("# {example}") } else { lines.join("\n") };
    let _ = writeln!(text, "{lines}");
    text
}

/// The text of a field as a TOML value.
fn value(field: &Field, text: &str) -> String {
    if field.is_flag() && FLAG.contains(&text) {
        text.to_owned()
    } else if field.is_bare() {
        number(text)
    } else {
        string(text)
    }
}

/// A bare number if the text is a number, otherwise the text in quotes.
fn number(text: &str) -> String {
    let bare = text.trim();
    if is_toml_number(bare) {
        return bare.to_owned();
    }
    match units::parse(bare, Dimension::Number, "") {
        Ok(value) => units::text(value, ""),
        Err(_) => string(text),
    }
}

fn is_toml_number(text: &str) -> bool {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    let (mantissa, exponent) =
        unsigned.split_once(['e', 'E']).map_or((unsigned, None), |(a, b)| (a, Some(b)));
    let (whole, fraction) =
        mantissa.split_once('.').map_or((mantissa, None), |(a, b)| (a, Some(b)));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let exponent = exponent.map(|text| text.strip_prefix(['+', '-']).unwrap_or(text));
    digits(whole)
        && (whole == "0" || !whole.starts_with('0'))
        && fraction.is_none_or(digits)
        && exponent.is_none_or(digits)
}

/// A TOML string on one line without hidden characters: a line end in a string would look like a
/// line end of the file, and a control character would reach the terminal.
fn string(text: &str) -> String {
    if !text.contains(is_hidden) {
        return toml_edit::Value::from(text).to_string();
    }
    let mut quoted = String::new();
    for c in serde_json::Value::from(text).to_string().chars() {
        if is_hidden(c) {
            let _ = write!(quoted, "\\U{:08x}", u32::from(c));
        } else {
            quoted.push(c);
        }
    }
    quoted
}
