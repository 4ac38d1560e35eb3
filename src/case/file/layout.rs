//! Every header, key and value in the text of a case with its place, for reading and for edits that
//! keep every other byte.

use std::ops::Range;

use toml_edit::{Document, Item, Key, RawString, Table, TomlError};

use crate::case::sanitize::sanitize;

/// A value as a case reads it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Value {
    String(String),
    /// A number in decimal digits.
    Number(String),
    Flag(bool),
    /// As in the text.
    Date(String),
    /// The numbers of an array with commas between them; `None` if it has other values.
    Array(Option<String>),
    Table,
}

impl Value {
    /// The kind of the value with its article.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Value::String(_) => "a string",
            Value::Number(_) => "a number",
            Value::Flag(_) => "true or false",
            Value::Date(_) => "a date",
            Value::Array(_) => "an array",
            Value::Table => "a table",
        }
    }
}

/// The place of a header or of a key with its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Header,
    Line,
    /// In an inline table, between these commas.
    Inline {
        before: Option<usize>,
        after: Option<usize>,
    },
}

/// A header such as `[variants.relieved]`, or a key with its value.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// The keys from the top level.
    pub(super) path: Vec<String>,
    /// The place where each key begins, of a shared key the first one.
    keys: Vec<usize>,
    /// Number of keys that the header above or the inline table around gives.
    pub(super) given: usize,
    /// The first byte of its keys, or of the header.
    pub(super) start: usize,
    /// The last key.
    pub(super) name: Range<usize>,
    /// The value, or the header from bracket to bracket.
    pub(super) span: Range<usize>,
    pub(super) value: Value,
    pub(super) place: Place,
}

impl Entry {
    /// The keys joined by points, however the text quotes or nests them.
    pub(super) fn key(&self) -> String {
        self.path.join(".")
    }

    /// The keys of its table.
    pub(super) fn table(&self) -> &[String] {
        &self.path[..self.path.len() - 1]
    }

    /// The place of the key at a depth from 1.
    pub(super) fn key_at(&self, depth: usize) -> usize {
        self.keys[depth - 1]
    }
}

/// Headers and keys in the order of the text. An inline table is before its members.
#[derive(Debug, Clone, Default)]
pub(super) struct Layout {
    pub(super) entries: Vec<Entry>,
    end: usize,
}

impl Layout {
    /// # Errors
    /// The first syntax error.
    pub(super) fn of(text: &str) -> Result<Layout, TomlError> {
        let document = Document::parse(text)?;
        let mut reader = Reader { text, entries: Vec::new() };
        reader.table(document.as_table(), &[]);
        let mut entries = reader.entries;
        entries.sort_by_key(|entry| entry.start);
        Ok(Layout { entries, end: text.len() })
    }

    /// The value of a key.
    pub(super) fn value(&self, key: &str) -> Option<&Entry> {
        self.values().find(|entry| entry.key() == key)
    }

    pub(super) fn values(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| entry.place != Place::Header)
    }

    pub(super) fn headers(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| entry.place == Place::Header)
    }

    /// The place to report for a key: its value, its table, or the end.
    pub(super) fn place(&self, key: &str) -> usize {
        let key = key.replace('"', "");
        let table = key.split('.').next().unwrap_or_default();
        let of_table = |entry: &&Entry| entry.path[0] == table;
        match (self.value(&key), self.entries.iter().find(of_table)) {
            (Some(own), _) => own.span.start,
            (None, Some(own)) if own.path.len() == 1 => own.span.start,
            (None, Some(own)) => own.start,
            (None, None) => self.end,
        }
    }
}

/// A key and the place where it begins.
type Named = (String, usize);

struct Reader<'t> {
    text: &'t str,
    entries: Vec<Entry>,
}

impl Reader<'_> {
    fn table(&mut self, table: &Table, above: &[Named]) {
        for (keys, value) in table.get_values() {
            self.value(&keys, value, above, false);
        }
        self.tables_in(table, above);
    }

    /// The tables with headers below a table.
    fn tables_in(&mut self, table: &Table, above: &[Named]) {
        for (name, item) in table {
            let Some(key) = table.key(name) else { continue };
            let path = [above, &[named(key)]].concat();
            match item {
                Item::Table(own) if own.is_dotted() => self.tables_in(own, &path),
                Item::Table(own) => {
                    if !own.is_implicit() {
                        self.header(&path, own.span(), Value::Table);
                    }
                    self.table(own, &path);
                }
                // No case reads the content of an array.
                Item::ArrayOfTables(all) => {
                    for own in all {
                        self.header(&path, own.span(), Value::Array(None));
                    }
                }
                Item::Value(_) | Item::None => {}
            }
        }
    }

    fn header(&mut self, path: &[Named], span: Option<Range<usize>>, value: Value) {
        let span = span.unwrap_or_default();
        let (path, keys): (Vec<_>, Vec<_>) = path.iter().cloned().unzip();
        let (given, start, name, place) = (0, span.start, span.clone(), Place::Header);
        self.entries.push(Entry { path, keys, given, start, name, span, value, place });
    }

    fn value(&mut self, keys: &[&Key], value: &toml_edit::Value, above: &[Named], is_inline: bool) {
        let Some(last) = keys.last() else { return };
        let (name, span) = (last.span().unwrap_or_default(), value.span().unwrap_or_default());
        let own: Vec<Named> = keys.iter().map(|key| named(key)).collect();
        let (path, keys): (Vec<_>, Vec<_>) = above.iter().chain(&own).cloned().unzip();
        let line = self.text[..name.start].rfind('\n').map_or(0, |end| end + 1);
        let gap = last.leaf_decor().prefix().and_then(RawString::span).unwrap_or(line..line);
        let after = value.decor().suffix().and_then(RawString::span);
        let is_comma = |at: &usize| self.text[*at..].starts_with(',');
        let place = if is_inline {
            let before = gap.start.checked_sub(1).filter(is_comma);
            let after = Some(after.map_or(span.end, |gap| gap.end)).filter(is_comma);
            Place::Inline { before, after }
        } else {
            Place::Line
        };
        let (given, start, read) = (above.len(), gap.end, self.read(value, &span));
        self.entries.push(Entry { path, keys, given, start, name, span, value: read, place });
        if let toml_edit::Value::InlineTable(table) = value {
            let above = [above, &own].concat();
            for (keys, value) in table.get_values() {
                self.value(&keys, value, &above, true);
            }
        }
    }

    fn read(&self, value: &toml_edit::Value, span: &Range<usize>) -> Value {
        match value {
            toml_edit::Value::String(text) => Value::String(text.value().clone()),
            toml_edit::Value::Boolean(flag) => Value::Flag(*flag.value()),
            toml_edit::Value::Datetime(_) => Value::Date(self.text[span.clone()].to_owned()),
            toml_edit::Value::Array(all) => {
                let numbers = all.iter().map(|value| {
                    match self.read(value, &value.span().unwrap_or_default()) {
                        Value::Number(number) => Some(number),
                        _ => None,
                    }
                });
                Value::Array(numbers.collect::<Option<Vec<_>>>().map(|all| all.join(", ")))
            }
            toml_edit::Value::InlineTable(_) => Value::Table,
            // Hexadecimal, octal or binary.
            toml_edit::Value::Integer(number) if self.text[span.clone()].starts_with('0') => {
                Value::Number(number.value().to_string())
            }
            toml_edit::Value::Integer(_) | toml_edit::Value::Float(_) => {
                Value::Number(self.text[span.clone()].replace('_', ""))
            }
        }
    }
}

fn named(key: &Key) -> Named {
    (key.get().to_owned(), key.span().unwrap_or_default().start)
}

/// The file without comment lines, empty lines, and headers of empty tables. Keeps all lines of a
/// multi-line string.
#[must_use]
pub fn without_comments(text: &str) -> String {
    let layout = Layout::of(text).unwrap_or_default();
    let strings: Vec<_> = layout
        .values()
        .filter(|entry| matches!(entry.value, Value::String(_)))
        .map(|entry| entry.span.clone())
        .collect();
    let mut kept: Vec<(String, bool)> = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let is_inside = strings.iter().any(|span| span.start < start && start < span.end);
        let trimmed = line.trim();
        if is_inside || !(trimmed.is_empty() || trimmed.starts_with('#')) {
            let is_header = !is_inside && line.starts_with('[');
            kept.push((sanitize(line.trim_end_matches(['\n', '\r'])), is_header));
        }
        start += line.len();
    }
    let has_lines = |at: usize| kept.get(at + 1).is_some_and(|(_, is_header)| !is_header);
    let said = (0..kept.len()).filter(|&at| !kept[at].1 || has_lines(at));
    let lines: Vec<&str> = said.map(|at| kept[at].0.as_str()).collect();
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_are_removed_and_multi_line_strings_are_kept() {
        let text = "# a\nformat = 1\nnotes = \"\"\"one\n# two\n\n[three]\n\"\"\"\n\n[pair]\n# m\n\
                    [driver]\r\nteeth = 20 # z1\n[driven]\n";
        assert_eq!(
            without_comments(text),
            "format = 1\nnotes = \"\"\"one\n# two\n\n[three]\n\"\"\"\n[driver]\nteeth = 20 # z1"
        );
    }
}
