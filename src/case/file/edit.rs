//! Writes changed values into the original text. Every line without a change keeps its bytes.

use std::ops::Range;

use super::layout::{Entry, Layout};
use super::template::{entries, key_of, override_entry};
use super::tree;
use crate::case::Case;

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
    /// The keys of its table, then the rest of its path.
    fn key(&self) -> Vec<String> {
        let name = self.name.trim_matches('"').to_owned();
        self.table.iter().cloned().chain([name]).collect()
    }
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

/// Whether reading the text gives the case. An invalid value of the case is only in its text.
pub(super) fn gives(text: &str, case: &Case) -> bool {
    let sorted = |case: &Case| {
        let mut all = written(case);
        all.sort();
        all
    };
    case.inputs().is_err() || sorted(&tree::read(text).case) == sorted(case)
}

fn written(case: &Case) -> Vec<Written> {
    let fields = entries(case).into_iter().map(|entry| Written {
        table: Some(entry.table.to_owned()).filter(|table| !table.is_empty()).into_iter().collect(),
        name: entry.name,
        value: entry.value,
    });
    let overrides = case.variants.iter().flat_map(|variant| {
        variant.overrides.iter().map(|change| {
            let (name, value) = override_entry(change);
            let table = vec!["variants".to_owned(), variant.name.clone()];
            Written { table, name, value }
        })
    });
    fields.chain(overrides).collect()
}

/// The key of a path in the form of [`Written::key`]: fields, limits and distributions can be dotted,
/// quoted or nested.
fn key_of_path(path: &[String]) -> Vec<String> {
    let is_variant = path.first().is_some_and(|first| first == "variants");
    let own = if is_variant { 2 } else { 1 };
    match path.split_at_checked(own) {
        Some((table, rest)) if !rest.is_empty() => {
            table.iter().cloned().chain([rest.join(".")]).collect()
        }
        _ => path.to_vec(),
    }
}

/// Replaces the value at its place, or inserts it.
fn put(text: &mut String, new: &Written) {
    let (layout, key) = (Layout::of(text), new.key());
    let mut members = layout.entries.iter();
    let member = members.find(|entry| key_of_path(entry.table()) == key);
    let distribution = new.value.strip_prefix("{ ");
    let distribution = distribution.and_then(|inner| inner.strip_suffix(" }")?.split_once(" = "));
    if let (Some(member), Some((shape, width))) = (member, distribution) {
        text.replace_range(member.value.clone(), width);
        if member.path.last().is_none_or(|name| name != shape) {
            text.replace_range(member.key.clone(), shape);
        }
        return;
    }
    let mut entries = layout.entries.iter();
    if let Some(own) = entries.find(|entry| key_of_path(&entry.path) == key) {
        return text.replace_range(own.value.clone(), &new.value);
    }
    if member.is_some() {
        remove(text, &key);
        return put(text, new);
    }
    insert(text, &layout, new);
}

/// Removes a value. A comment on another line stays.
fn remove(text: &mut String, key: &[String]) {
    let layout = Layout::of(text);
    let is_it = |path: &[String]| key_of_path(path) == key;
    let mut entries = layout.entries.iter();
    let entry = entries.find(|entry| is_it(&entry.path) || is_it(entry.table()));
    if let Some(entry) = entry {
        take_out(text, entry);
    }
    // The header of a distribution without its value is not a distribution.
    if let Some(header) = layout.headers.iter().find(|header| is_it(&header.path)) {
        let line = line(text, header.span.clone());
        text.replace_range(line, "");
    }
}

fn remove_variant(text: &mut String, name: &str) {
    let of_it = |path: &[String]| path.iter().take(2).eq(["variants", name]);
    while let Some(entry) = Layout::of(text).entries.iter().find(|entry| of_it(&entry.path)) {
        take_out(text, entry);
    }
    while let Some(header) = Layout::of(text).headers.iter().find(|header| of_it(&header.path)) {
        let mut line = line(text, header.span.clone());
        let above = text[..line.start].trim_end_matches([' ', '\t', '\r', '\n']);
        let blank = text[above.len()..line.start].match_indices('\n').nth(1);
        line.start = blank.map_or(line.start, |_| line_start(text, line.start - 1));
        text.replace_range(line, "");
    }
}

/// Removes an entry with the comment after its value.
fn take_out(text: &mut String, entry: &Entry) {
    let own = entry.keys.start..entry.value.end;
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
    for header in &layout.headers {
        if table.starts_with(&header.path) {
            offer((header.path.len(), false, false), Place::Below(header.span.end));
        }
    }
    for entry in &layout.entries {
        let known = shared(entry.table());
        if known >= entry.given {
            // At the top level, other entries can be of other tables.
            let is_neighbour = known > 0 || entry.table().is_empty();
            offer((known, true, is_neighbour), Place::After(entry));
        }
        if entry.is_table && table.starts_with(&entry.path) {
            offer((entry.path.len(), false, false), Place::Inside(entry));
        }
    }
    let assignment = |given: usize, neighbour: Option<&Entry>| {
        let written = neighbour.filter(|entry| entry.table() == table);
        let above = written.map_or_else(
            || table[given..].iter().map(|name| key_of(name) + ".").collect(),
            |entry| text[entry.keys.start..entry.key.start].to_owned(),
        );
        format!("{above}{} = {}", new.name, new.value)
    };
    match best {
        Some((_, Place::After(entry))) if entry.is_inline => {
            let added = assignment(entry.given, Some(entry));
            let start = line_start(text, entry.keys.start);
            let indent = text[start..entry.keys.start].to_owned();
            let comma = entry.comma.filter(|_| indent.trim().is_empty());
            match comma.filter(|comma| ends_line(&text[comma + 1..])) {
                Some(comma) => insert_line(text, comma, &format!("{indent}{added},")),
                None => text.insert_str(entry.value.end, &format!(", {added}")),
            }
        }
        Some((_, Place::Inside(entry))) => {
            let at = entry.value.start + 1;
            let gap = if text[at..].starts_with('}') { " " } else { "" };
            let added = format!(" {}{gap}", assignment(entry.path.len(), None));
            text.insert_str(at, &added);
        }
        Some(((known, ..), Place::After(entry))) if known == table.len() => {
            let start = line_start(text, entry.keys.start);
            let indent = &text[start..entry.keys.start];
            let added = format!("{indent}{}", assignment(entry.given, Some(entry)));
            insert_line(text, entry.value.end, &added);
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
            let mut headers = layout.headers.iter().filter(|_| table.len() > 1);
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
