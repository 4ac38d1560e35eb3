//! Describes a syntax error of TOML in terms of a case.

use toml_edit::TomlError;

use crate::case::fields::{AUTO, FIELDS, Field, index_of};
use crate::case::sanitize::{cut, quoted};
use crate::case::units::{self, Dimension};
use crate::case::{Problem, check};

/// The first syntax error of a text: in terms of a case if its line belongs to a field, otherwise in
/// terms of TOML.
pub(super) fn fault(error: &TomlError, source: &str) -> (usize, Problem) {
    let span = error.span().unwrap_or(source.len()..source.len());
    let at = (0..=span.start).rev().find(|&at| source.is_char_boundary(at)).unwrap_or_default();
    let start = source[..at].rfind('\n').map_or(0, |end| end + 1);
    let (above, text) = (&source[..start], source[start..].lines().next().unwrap_or_default());
    let named = key_and_value(text);
    let field = named.and_then(|(key, _)| field_of(above, key));
    let name = field.map_or("toml", |field| field.key);
    let is_control = |c: &char| c.is_control() && !matches!(c, '\t' | '\r');
    if let Some((offset, control)) = text.char_indices().find(|(_, c)| is_control(c)) {
        let cause = format!("control character {} in the text", quoted(&control.to_string()));
        return (start + offset, Problem::new(name, cause, "remove it"));
    }
    let message = error.message();
    if message == "duplicate key" {
        return (at, twice(above, text, source.get(span).unwrap_or_default()));
    }
    if let (Some(field), Some((_, value))) = (field, named)
        && let Some(problem) = mistaken(field, value)
    {
        let offset = value.as_ptr() as usize - text.as_ptr() as usize;
        return (start + offset, problem);
    }
    if let (None, Some((key, _))) = (field, text.split_once(':'))
        && let Some(field) = field_of(above, key.trim())
    {
        let problem = Problem::new(field.key, "`:` instead of `=`", written(field));
        return (start + key.len(), problem);
    }
    let cause = message.split(", expected").next().unwrap_or(message);
    let known = FIXES.iter().find(|(part, _)| message.contains(part));
    (at, Problem::new(name, cause, known.map_or("write valid TOML", |(_, fix)| *fix)))
}

fn written(field: &Field) -> String {
    format!("write {}", check::assignment(field))
}

/// The key and the value of a line without its comment.
fn key_and_value(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once('=')?;
    let comment = value.find(" #").unwrap_or(value.len());
    Some((key.trim(), value[..comment].trim()))
}

/// The field of a key below these lines.
fn field_of(above: &str, key: &str) -> Option<&'static Field> {
    let header = above.lines().rev().find_map(|line| line.trim().strip_prefix('['));
    let table = header.map_or("", |rest| rest.split(']').next().unwrap_or_default().trim());
    let table = match table.strip_prefix("variants.") {
        Some(variant) => variant.split_once('.').map_or("", |(_, table)| table),
        None => table,
    };
    let key = key.trim_matches('"');
    let path = if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") };
    index_of(&path).map(|index| &FIELDS[index])
}

/// The most likely mistake in a field's value: missing quotes, a missing point, or a missing value.
fn mistaken(field: &Field, value: &str) -> Option<Problem> {
    let problem = |cause: String, fix: String| Some(Problem::new(field.key, cause, fix));
    if value.is_empty() {
        return problem("no value after `=`".to_owned(), written(field));
    }
    if value.contains(['"', '\'', '[', '{']) {
        return None;
    }
    let index = index_of(field.key)?;
    match (check::field_value(index, value), units::parse(value, Dimension::Number, "")) {
        _ if field.is_flag() => problem(
            format!("{} is neither true nor false", quoted(value)),
            "write true or false".to_owned(),
        ),
        (Ok(_), Ok(number)) if field.is_bare() && value != AUTO => problem(
            format!("{} is not how TOML writes a number", quoted(value)),
            format!("write {}", units::text(number, "")),
        ),
        (Err(problem), _) if !field.is_choice() => Some(problem),
        _ if value.starts_with(|c: char| c.is_ascii_digit()) && field.is_choice() => None,
        _ => problem(
            format!("{} is not in quotes", quoted(value)),
            format!("write \"{}\"", cut(value)),
        ),
    }
}

/// Fixes of TOML errors, by a part of the error message.
const FIXES: [(&str, &str); 17] = [
    ("overflowed", "write a smaller number"),
    ("unclosed table", "close the table's name with ]"),
    ("unclosed array", "close it with ]"),
    ("recurse", "a case has no nested arrays"),
    ("recursion", "a case has no nested arrays"),
    ("unclosed inline table", "close it with }"),
    ("key with no value", "write key = value, or # in front of a comment"),
    ("extra `=`", "leave a single ="),
    ("invalid unquoted key", "a key has only letters, digits, - and _"),
    ("string values must be quoted", "put the value between quotes"),
    ("multi-line basic string", "close the string with \"\"\""),
    ("multi-line literal string", "close the string with '''"),
    ("invalid basic string", "close the string with \" on its line"),
    ("invalid literal string", "close the string with ' on its line"),
    ("escape", "write \\\\ for a backslash, or put the text between single quotes"),
    ("carriage return", "end lines with LF or CR LF"),
    ("unexpected key or value", "only a # comment may follow a value on its line"),
];

/// A key or table that occurs twice.
fn twice(above: &str, line: &str, name: &str) -> Problem {
    if line.trim_start().starts_with('[') {
        let cause = format!("the table {} appears twice", quoted(name));
        return Problem::new(name, cause, "put its keys under one header");
    }
    let field = field_of(above, name).map_or(name, |field| field.key);
    let cause = format!("the key {} appears twice", quoted(name));
    Problem::new(field, cause, "keep one of the two")
}
