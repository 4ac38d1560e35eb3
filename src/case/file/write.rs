//! Writes a case: as a new commented text, or as changed values in the original text, where every
//! line without a change keeps its bytes.

use std::fmt::Write;
use std::iter;
use std::ops::Range;

use super::FORMAT;
use super::layout::{Entry, Layout, Value};
use crate::case::fields::{Absent, FIELDS, FLAG, Field, GROUPS, index_of};
use crate::case::sanitize::{is_hidden, sanitize};
use crate::case::units::{self, Dimension};
use crate::case::{Case, check, spread};

/// A value of a case as written in a file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Written {
    /// The keys of its table.
    table: Vec<String>,
    /// The key in TOML.
    name: String,
    /// The value in TOML.
    value: String,
}

impl Written {
    /// The key with its table, as [`Entry::key`].
    fn key(&self) -> String {
        let names = self.table.iter().map(String::as_str);
        let names: Vec<_> = names.chain([self.name.trim_matches('"')]).collect();
        names.join(".")
    }

    fn line(&self) -> String {
        format!("{} = {}", self.name, self.value)
    }
}

/// All values of a case, in the order of a new file.
fn written(case: &Case) -> Vec<Written> {
    let top = |table: &str| Vec::from_iter((!table.is_empty()).then(|| table.to_owned()));
    let fields = FIELDS.iter().enumerate().filter_map(|(index, field)| {
        let value = value(field, case.text(index)?);
        Some(Written { table: top(field.table()), name: field.name().to_owned(), value })
    });
    let limits = case.limits.iter().filter(|limit| !limit.text.is_empty()).map(|limit| Written {
        table: top("limits"),
        name: limit.quantity.to_owned(),
        value: limit_value(&limit.text),
    });
    let spreads = case.spread.iter().map(|spread| Written {
        table: top("spread"),
        name: format!("\"{}\"", spread.field),
        value: distribution(spread.shape.name(), &spread.text),
    });
    let overrides = case.variants.iter().flat_map(|variant| {
        variant.overrides.iter().map(|change| {
            let (key, text) = (&change.key, &change.text);
            let field = index_of(key).map(|field| &FIELDS[field]);
            let is_top = field.is_some_and(|field| field.table().is_empty());
            let name = key.replace('"', "");
            Written {
                table: vec!["variants".to_owned(), variant.name.clone()],
                name: if is_top { name } else { format!("\"{name}\"") },
                value: match (field, text.split_once(' ')) {
                    _ if text.is_empty() => string(""),
                    (Some(field), _) => value(field, text),
                    (None, Some((shape, width))) if key.starts_with(spread::PREFIX) => {
                        distribution(shape, width)
                    }
                    _ => limit_value(text),
                },
            }
        })
    });
    fields.chain(limits).chain(spreads).chain(overrides).collect()
}

fn limit_value(text: &str) -> String {
    if units::parse(text, Dimension::Number, "").is_ok() { number(text) } else { string(text) }
}

fn distribution(shape: &str, width: &str) -> String {
    format!("{{ {shape} = {} }}", limit_value(width))
}

/// Whether two cases have the same values, in any order.
pub(super) fn are_same(one: &Case, other: &Case) -> bool {
    let sorted = |case: &Case| {
        let mut all = written(case);
        all.sort();
        all
    };
    sorted(one) == sorted(other)
}

/// A commented case, valid if the case is valid. `comments` are additional comments by key.
pub(super) fn template(case: &Case, comments: &[(&str, String)]) -> String {
    let values = written(case);
    let of_table = |table: &[&str]| -> Vec<String> {
        let own = values.iter().filter(|own| own.table == table);
        own.map(Written::line).collect()
    };
    let mut text = format!(
        "# A gear pair for tipstrike.\n# A value with a dimension is a string with its unit; any \
            unit of the dimension is valid.\nformat = {FORMAT}\n"
    );
    for (table, title) in GROUPS {
        if !table.is_empty() {
            let _ = write!(text, "\n# {title}\n[{table}]\n");
        }
        for (index, field) in FIELDS.iter().enumerate().filter(|(_, field)| field.table() == table)
        {
            let own = values.iter().find(|own| own.key() == field.key);
            let _ = writeln!(text, "# {}", description(field));
            for (_, comment) in comments.iter().filter(|(key, _)| *key == field.key) {
                let _ = writeln!(text, "# {}", sanitize(comment));
            }
            let line = own.map_or_else(|| unwritten(case, index), Written::line);
            let _ = writeln!(text, "{line}");
        }
    }
    for (table, help, example) in [
        (
            "limits",
            "Greatest allowed value of any quantity of the results.",
            "impact_force = \"2500 N\"",
        ),
        (
            "spread",
            "Distribution of a field around its value, for tolerance.",
            "\"deviations.base_pitch\" = { normal = \"4 um\" }",
        ),
    ] {
        let lines = of_table(&[table]);
        let lines = if lines.is_empty() { format!("# {example}") } else { lines.join("\n") };
        let _ = writeln!(text, "\n# {help}\n[{table}]\n{lines}");
    }
    text.push_str("\n# Overrides of the case, for compare, --variant and the workbench.\n");
    if case.variants.is_empty() {
        text.push_str("# [variants.relieved]\n# \"driven.tip_relief\" = \"48 um\"\n");
    }
    let variants = case.variants.iter().map(|variant| {
        let lines = of_table(&["variants", &variant.name]);
        let head = format!("[variants.{}]", key_of(&variant.name));
        iter::once(head).chain(lines).collect::<Vec<_>>().join("\n") + "\n"
    });
    text + &variants.collect::<Vec<_>>().join("\n")
}

/// Symbol, help and range of a field.
fn description(field: &Field) -> String {
    let symbol =
        if field.symbol.is_empty() { String::new() } else { format!("{}: ", field.symbol) };
    let range = field.range_text();
    let range = if range.is_empty() { range } else { format!(" [{range}]") };
    let absent = match field.absent {
        Absent::Without(words) => format!(" Left out: {words}."),
        _ => String::new(),
    };
    format!("{symbol}{}{range}{absent}", field.help)
}

/// A name as a key, with quotes if TOML needs them.
pub(super) fn key_of(name: &str) -> String {
    let is_bare = |byte: u8| byte.is_ascii_alphanumeric() || b"-_".contains(&byte);
    if name.bytes().all(is_bare) { name.to_owned() } else { string(name) }
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

/// The text of the case `before` with the values of the case `after`.
pub(super) fn render(text: &str, before: &Case, after: &Case) -> String {
    let mut text = text.to_owned();
    for variant in &before.variants {
        if after.variant(&variant.name).is_err() {
            remove_variant(&mut text, &variant.name);
        }
    }
    let (before, after) = (written(before), written(after));
    for old in &before {
        if !after.iter().any(|new| new.key() == old.key()) {
            remove(&mut text, &old.key());
        }
    }
    for new in after.iter().filter(|new| !before.contains(new)) {
        put(&mut text, new);
    }
    text
}

/// Replaces the value at its place, or inserts it.
fn put(text: &mut String, new: &Written) {
    let (layout, key) = (Layout::of(text), new.key());
    let member = layout.values().find(|entry| entry.table().join(".") == key);
    let distribution = new.value.strip_prefix("{ ");
    let distribution = distribution.and_then(|inner| inner.strip_suffix(" }")?.split_once(" = "));
    if let (Some(member), Some((shape, width))) = (member, distribution) {
        text.replace_range(member.span.clone(), width);
        if member.path.last().is_none_or(|name| name != shape) {
            text.replace_range(member.last_key(), shape);
        }
        return;
    }
    if let Some(own) = layout.value(&key) {
        return text.replace_range(own.span.clone(), &new.value);
    }
    if member.is_some() {
        remove(text, &key);
        return put(text, new);
    }
    insert(text, &layout, new);
}

/// Removes a value. A comment on another line stays.
fn remove(text: &mut String, key: &str) {
    let layout = Layout::of(text);
    let is_it = |entry: &&Entry| entry.key() == key || entry.table().join(".") == key;
    if let Some(entry) = layout.values().find(is_it) {
        take_out(text, entry);
    }
    // The header of a distribution without its value is not a distribution.
    if let Some(header) = layout.headers().find(|header| header.key() == key) {
        let line = line(text, header.span.clone());
        text.replace_range(line, "");
    }
}

fn remove_variant(text: &mut String, name: &str) {
    let of_it = |entry: &&Entry| entry.path.iter().take(2).eq(["variants", name]);
    while let Some(entry) = Layout::of(text).values().find(of_it) {
        take_out(text, entry);
    }
    while let Some(header) = Layout::of(text).headers().find(of_it) {
        let mut line = line(text, header.span.clone());
        let above = text[..line.start].trim_end_matches([' ', '\t', '\r', '\n']);
        let blank = text[above.len()..line.start].match_indices('\n').nth(1);
        line.start = blank.map_or(line.start, |_| line_start(text, line.start - 1));
        text.replace_range(line, "");
    }
}

/// Removes an entry with the comment after its value.
fn take_out(text: &mut String, entry: &Entry) {
    let own = entry.start()..entry.span.end;
    if !entry.is_inline {
        let line = line(text, own);
        return text.replace_range(line, "");
    }
    let is_blank = |range: &Range<usize>| text[range.clone()].bytes().all(|b| b" \t".contains(&b));
    let to_comma = entry.comma.map(|comma| own.end..comma);
    let with_comma =
        own.start..to_comma.clone().filter(is_blank).map_or(own.end, |gap| gap.end + 1);
    let lines = line(text, with_comma.clone());
    if is_blank(&(lines.start..own.start)) && ends_line(&text[with_comma.end..lines.end]) {
        let comma = entry.comma.filter(|comma| *comma >= lines.end);
        if let Some(comma) = comma {
            text.replace_range(comma..=comma, "");
        }
        return text.replace_range(lines, "");
    }
    let before = entry.comma_before.map(|comma| comma..own.start);
    let before = before.filter(|gap| entry.comma.is_none() && is_blank(&(gap.start + 1..gap.end)));
    match (entry.comma, before) {
        (Some(comma), _) if comma >= with_comma.end => text.replace_range(comma..=comma, ""),
        (None, Some(gap)) => return text.replace_range(gap.start..own.end, ""),
        _ => {}
    }
    let rest = &text[with_comma.end..];
    let spaces = rest.len() - rest.trim_start_matches([' ', '\t']).len();
    text.replace_range(with_comma.start..with_comma.end + spaces, "");
}

/// The place for a new entry.
enum Place<'l> {
    After(&'l Entry),
    /// An inline table without entries.
    Inside(&'l Entry),
    /// Below a header without entries.
    Below(usize),
}

/// Inserts an entry after the last entry of its table. A new table is at the end of the text.
fn insert(text: &mut String, layout: &Layout, new: &Written) {
    let table = new.table.as_slice();
    let shared = |path: &[String]| path.iter().zip(table).take_while(|(a, b)| a == b).count();
    let mut best: Option<((usize, bool, bool), Place<'_>)> = None;
    let mut offer = |rank, place| {
        if best.as_ref().is_none_or(|(known, _)| rank >= *known) {
            best = Some((rank, place));
        }
    };
    for header in layout.headers() {
        if table.starts_with(&header.path) {
            offer((header.path.len(), false, false), Place::Below(header.span.end));
        }
    }
    for entry in layout.values() {
        let known = shared(entry.table());
        if known >= entry.given {
            // At the top level, other entries can be of other tables.
            let is_neighbour = known > 0 || entry.table().is_empty();
            offer((known, true, is_neighbour), Place::After(entry));
        }
        if entry.value == Value::Table && table.starts_with(&entry.path) {
            offer((entry.path.len(), false, false), Place::Inside(entry));
        }
    }
    let assignment = |given: usize, neighbour: Option<&Entry>| {
        let written = neighbour.filter(|entry| entry.table() == table);
        let above = written.map_or_else(
            || table[given..].iter().map(|name| key_of(name) + ".").collect(),
            |entry| text[entry.start()..entry.last_key().start].to_owned(),
        );
        format!("{above}{} = {}", new.name, new.value)
    };
    match best {
        Some((_, Place::After(entry))) if entry.is_inline => {
            let added = assignment(entry.given, Some(entry));
            let start = line_start(text, entry.start());
            let indent = text[start..entry.start()].to_owned();
            let comma = entry.comma.filter(|_| indent.trim().is_empty());
            match comma.filter(|comma| ends_line(&text[comma + 1..])) {
                Some(comma) => insert_line(text, comma, &format!("{indent}{added},")),
                None => text.insert_str(entry.span.end, &format!(", {added}")),
            }
        }
        Some((_, Place::Inside(entry))) => {
            let at = entry.span.start + 1;
            let gap = if text[at..].starts_with('}') { " " } else { "" };
            let added = format!(" {}{gap}", assignment(entry.path.len(), None));
            text.insert_str(at, &added);
        }
        Some(((known, ..), Place::After(entry))) if known == table.len() => {
            let start = line_start(text, entry.start());
            let indent = &text[start..entry.start()];
            let added = format!("{indent}{}", assignment(entry.given, Some(entry)));
            insert_line(text, entry.span.end, &added);
        }
        Some(((known, ..), Place::Below(end))) if known == table.len() => {
            let added = assignment(known, None);
            insert_line(text, end, &added);
        }
        _ => {
            let end = line_end(text);
            let names: Vec<String> = table.iter().map(|name| key_of(name)).collect();
            let assignment = assignment(table.len(), None);
            let added = format!("[{}]{end}{assignment}{end}", names.join("."));
            let mut headers = layout.headers().filter(|_| table.len() > 1);
            match headers.find(|header| header.path.starts_with(table)) {
                // Above the other tables of a variant, so that the variants keep their order.
                Some(inner) => {
                    let at = line_start(text, inner.span.start);
                    text.insert_str(at, &format!("{added}{end}"));
                }
                None if text.ends_with('\n') => text.extend([end, &*added]),
                None => text.extend([end, end, &*added]),
            }
        }
    }
}

/// Inserts a line below the line of `at`, with the same line end.
fn insert_line(text: &mut String, at: usize, added: &str) {
    let below = line(text, at..at).end;
    let (above, end) = match text[..below].strip_suffix('\n') {
        Some(above) if above.ends_with('\r') => ("", "\r\n"),
        Some(_) => ("", "\n"),
        None => (line_end(text), line_end(text)),
    };
    text.insert_str(below, &format!("{above}{added}{end}"));
}

/// The lines of a range, with their last line end.
fn line(text: &str, range: Range<usize>) -> Range<usize> {
    let end = text[range.end..].find('\n');
    line_start(text, range.start)..end.map_or(text.len(), |length| range.end + length + 1)
}

fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or(0, |end| end + 1)
}

/// Whether only spaces and a comment are before the line end.
fn ends_line(rest: &str) -> bool {
    let rest = rest.trim_start_matches([' ', '\t']);
    rest.starts_with(['#', '\r', '\n'])
}

/// The first line end of the text.
fn line_end(text: &str) -> &'static str {
    match text.find('\n') {
        Some(at) if text[..at].ends_with('\r') => "\r\n",
        _ => "\n",
    }
}
