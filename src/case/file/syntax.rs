//! Syntax errors of TOML: describes each error in terms of a case and recovers the valid lines.

use toml::de::{DeTable, Error};

use super::fault::{Found, Lines};
use crate::case::fields::{AUTO, FIELDS, Field, Kind, index_of};
use crate::case::sanitize::{cut, quoted};
use crate::case::units::{self, Dimension};
use crate::case::{Problem, check};

/// Limit of the rounds in which broken lines are blanked.
const ROUNDS: usize = 8;

/// Limit of the described errors.
const MOST: usize = 200;

/// A text after removal of its broken lines.
pub(super) struct Recovered {
    /// The text with broken lines blanked. All other bytes keep their places.
    pub(super) text: String,
    pub(super) faults: Vec<Found>,
    /// Number of further errors.
    pub(super) more: usize,
    pub(super) broken: String,
    /// Whether every table header is readable, so that the table of each key is known.
    pub(super) tables_known: bool,
}

/// Finds and blanks the lines that are not TOML.
pub(super) fn recover(source: &str) -> Recovered {
    let mut recovered = Recovered {
        text: source.to_owned(),
        faults: Vec::new(),
        more: 0,
        broken: String::new(),
        tables_known: true,
    };
    let lines = Lines::of(source);
    for round in 0..ROUNDS {
        let (_, errors) = DeTable::parse_recoverable(&recovered.text);
        let mut errors: Vec<(usize, Error)> =
            errors.into_iter().map(|error| (start(&error, source), error)).collect();
        errors.sort_by_key(|(at, _)| *at);
        // One broken line can have several errors, and a broken key can occur twice.
        errors.dedup_by(|(at, error), (before, other)| {
            let is_same = lines.around(*at).start == lines.around(*before).start
                && !(is_double(error) && is_double(other));
            if is_same && is_double(other) {
                std::mem::swap(error, other);
                std::mem::swap(at, before);
            }
            is_same
        });
        let beyond = errors.len().saturating_sub(MOST);
        errors.truncate(MOST);
        let (doubles, slips): (Vec<_>, Vec<_>) =
            errors.into_iter().partition(|(_, error)| is_double(error));
        if round == 0 {
            recovered.faults = first_of_each_line(&slips, &lines, source);
        }
        if slips.is_empty() || beyond > 0 || round + 1 == ROUNDS {
            recovered.more = beyond;
            recovered.tables_known &= slips.is_empty();
            recovered
                .faults
                .extend(doubles.iter().map(|(at, error)| double(*at, error, &lines, source)));
            break;
        }
        for (at, _) in &slips {
            recovered.blank(lines.around(*at), source);
        }
    }
    recovered
}

impl Recovered {
    fn blank(&mut self, line: std::ops::Range<usize>, source: &str) {
        let text = &source[line.clone()];
        self.tables_known &= !text.trim_start().starts_with('[');
        self.broken.push_str(text);
        self.broken.push('\n');
        self.text.replace_range(line.clone(), &" ".repeat(line.len()));
    }
}

/// Whether the lines name the key.
pub(super) fn names(lines: &str, key: &str) -> bool {
    lines.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == key)
}

fn start(error: &Error, source: &str) -> usize {
    error.span().map_or(source.len(), |span| span.start)
}

fn first_of_each_line(errors: &[(usize, Error)], lines: &Lines<'_>, source: &str) -> Vec<Found> {
    let mut last = usize::MAX;
    let mut found = Vec::new();
    for (at, error) in errors {
        let line = lines.around(*at);
        if line.start != last {
            last = line.start;
            found.push(fault(*at, error, source, line));
        }
    }
    found
}

/// The error in terms of a case if the line belongs to a field, otherwise in terms of TOML.
fn fault(at: usize, error: &Error, source: &str, line: std::ops::Range<usize>) -> Found {
    if let Some(control) =
        source[at..].chars().next().filter(|c| c.is_control() && !matches!(c, '\n' | '\r'))
    {
        let cause = format!("control character {} in the text", quoted(&control.to_string()));
        return Found::new(at, Problem::new(&field_name(source, &line), cause, "remove it"));
    }
    let text = &source[line.clone()];
    let field = key_and_value(text)
        .and_then(|(key, value)| Some((field_of(source, line.start, key)?, value)));
    if let Some((field, value)) = field
        && let Some(problem) = mistaken(field, value)
    {
        let offset = value.as_ptr() as usize - text.as_ptr() as usize;
        return Found::new(line.start + offset, problem);
    }
    if let Some((key, _)) = text.split_once(':').filter(|_| field.is_none())
        && let Some(field) = field_of(source, line.start, key.trim())
    {
        let fix = format!("write {}", check::assignment(field));
        return Found::new(
            line.start + key.len(),
            Problem::new(field.key, "`:` instead of `=`", fix),
        );
    }
    Found::new(at, in_general(error, &field_name(source, &line)))
}

fn field_name(source: &str, line: &std::ops::Range<usize>) -> String {
    key_and_value(&source[line.clone()])
        .and_then(|(key, _)| field_of(source, line.start, key))
        .map_or_else(|| "toml".to_owned(), |field| field.key.to_owned())
}

/// The key and the value of a line without its comment.
fn key_and_value(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once('=')?;
    let comment = value.find(" #").unwrap_or(value.len());
    Some((key.trim(), value[..comment].trim()))
}

fn field_of(source: &str, line: usize, key: &str) -> Option<&'static Field> {
    let header = source[..line].lines().rev().find_map(|line| line.trim().strip_prefix('['));
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
    let inner = value.trim_matches(['"', '\'']);
    let problem = |cause: String, fix: String| Some(Problem::new(field.key, cause, fix));
    if value.is_empty() {
        return problem(
            "no value after `=`".to_owned(),
            format!("write {}", check::assignment(field)),
        );
    }
    if field.takes_auto() && value == AUTO {
        return problem(format!("{} is not in quotes", quoted(value)), format!("write \"{AUTO}\""));
    }
    let read = match field.kind {
        Kind::Number(dimension, ..) => units::parse(inner, dimension, field.usual_unit()),
        Kind::Count(..) => units::parse(inner, Dimension::Number, ""),
        Kind::Text | Kind::Choice(..) => Ok(0.0),
    };
    match read {
        _ if value.contains(['"', '\'', '[', '{']) => None,
        Err(misread)
            if matches!(field.kind, Kind::Count(..)) && misread.fix.contains("such as") =>
        {
            problem(misread.cause, format!("write a whole number, such as {}", field.example()))
        }
        Err(misread) => problem(misread.cause, misread.fix),
        Ok(_) if field.is_flag() => problem(
            format!("{} is neither true nor false", quoted(value)),
            "write true or false".to_owned(),
        ),
        Ok(number) if field.is_bare() => problem(
            format!("{} is not how TOML writes a number", quoted(value)),
            format!("write {}", units::text(number, "")),
        ),
        Ok(_) => problem(
            format!("{} is not in quotes", quoted(value)),
            format!("write \"{}\"", cut(value)),
        ),
    }
}

/// Fixes of TOML errors, by a part of the error message.
const FIXES: [(&str, &str); 16] = [
    ("unclosed table", "close the table's name with ]"),
    ("unclosed array", "close it with ]; a case has no arrays"),
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

fn in_general(error: &Error, field: &str) -> Problem {
    let message = error.message();
    let cause = message.split(", expected").next().unwrap_or(message);
    let fix = FIXES
        .iter()
        .find(|(part, _)| message.contains(part))
        .map_or("write valid TOML", |(_, fix)| fix);
    Problem::new(field, cause, fix)
}

fn is_double(error: &Error) -> bool {
    error.message() == "duplicate key"
}

/// A key or table that occurs twice.
fn double(at: usize, error: &Error, lines: &Lines<'_>, source: &str) -> Found {
    let name = error.span().and_then(|span| source.get(span)).unwrap_or_default();
    let line = lines.around(at);
    if source[line.clone()].trim_start().starts_with('[') {
        let cause = format!("the table {} appears twice", quoted(name));
        return Found::new(at, Problem::new(name, cause, "put its keys under one header"));
    }
    let field = field_of(source, line.start, name).map_or(name, |field| field.key);
    Found::new(
        at,
        Problem::new(
            field,
            format!("the key {} appears twice", quoted(name)),
            "keep one of the two",
        ),
    )
}
