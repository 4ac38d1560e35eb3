//! Every header, key and value in the text of a case with its place, for reading and for edits that
//! keep every other byte.

use std::borrow::Cow;
use std::ops::Range;

use toml_parser::Source;
use toml_parser::decoder::{IntegerRadix, ScalarKind};
use toml_parser::parser::{Event, EventKind, parse_document};

/// A value as a case reads it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Value {
    String(String),
    /// A number in decimal digits.
    Number(String),
    Flag(bool),
    Date,
    Array,
    Table,
}

impl Value {
    /// The kind of the value with its article.
    pub(super) fn kind(&self) -> &'static str {
        match self {
            Value::String(_) => "a string",
            Value::Number(_) => "a number",
            Value::Flag(_) => "true or false",
            Value::Date => "a date",
            Value::Array => "an array",
            Value::Table => "a table",
        }
    }
}

/// A header such as `[variants.relieved]`, or a key with its value, on its own line or in an inline
/// table.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    /// The keys from the top level.
    pub(super) path: Vec<String>,
    /// Number of keys that the header above or the inline table around gives.
    pub(super) given: usize,
    /// The places of the other keys.
    pub(super) keys: Vec<Range<usize>>,
    /// The value, or the header from bracket to bracket.
    pub(super) span: Range<usize>,
    pub(super) value: Value,
    pub(super) is_header: bool,
    /// Whether it is in an inline table.
    pub(super) is_inline: bool,
    /// The comma before the key in an inline table.
    pub(super) comma_before: Option<usize>,
    /// The comma after the value in an inline table.
    pub(super) comma: Option<usize>,
}

impl Entry {
    /// The keys joined by points, however the text quotes or nests them.
    pub(super) fn key(&self) -> String {
        self.path.join(".")
    }

    /// The keys of its table.
    pub(super) fn table(&self) -> &[String] {
        &self.path[..self.path.len().saturating_sub(1)]
    }

    /// The start of its first key.
    pub(super) fn start(&self) -> usize {
        self.keys.first().map_or(self.span.start, |key| key.start)
    }

    /// The place of its last key.
    pub(super) fn last_key(&self) -> Range<usize> {
        self.keys.last().cloned().unwrap_or(self.span.clone())
    }

    /// The place of the key at a depth from 1, or of the first key below it.
    pub(super) fn key_at(&self, depth: usize) -> usize {
        let own = self.keys.get(depth.saturating_sub(self.given + 1));
        own.map_or(self.span.start, |key| key.start)
    }
}

/// Headers and keys in the order of the text. An inline table is before its members.
#[derive(Debug, Clone, Default)]
pub(super) struct Layout {
    pub(super) entries: Vec<Entry>,
    end: usize,
}

impl Layout {
    /// The layout of a text without syntax errors.
    pub(super) fn of(text: &str) -> Layout {
        let source = Source::new(text);
        let layout = Layout { entries: Vec::new(), end: text.len() };
        let open = vec![Table::default()];
        let mut reader = Reader { source, layout, keys: Vec::new(), open, start: 0, arrays: 0 };
        let tokens = source.lex().into_vec();
        parse_document(&tokens, &mut |event: Event| reader.read(&event), &mut ());
        reader.layout
    }

    /// The value of a key.
    pub(super) fn value(&self, key: &str) -> Option<&Entry> {
        self.values().find(|entry| entry.key() == key)
    }

    pub(super) fn values(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| !entry.is_header)
    }

    pub(super) fn headers(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| entry.is_header)
    }

    /// The place to report for a key: its value, the header of its table, or the end.
    pub(super) fn place(&self, key: &str) -> usize {
        let key = key.replace('"', "");
        let table = key.split('.').next().unwrap_or_default();
        let own = self.value(&key).map(|entry| entry.span.start);
        own.or_else(|| {
            let mut all = self.entries.iter();
            let of_table = all.find(|entry| entry.path.first().is_some_and(|own| own == table))?;
            let is_value = !of_table.is_header && of_table.path.len() == 1;
            Some(if is_value || of_table.is_header {
                of_table.span.start
            } else {
                of_table.start()
            })
        })
        .unwrap_or(self.end)
    }
}

/// A header's table or an inline table while it is read.
#[derive(Default)]
struct Table {
    path: Vec<String>,
    /// The entry of an inline table.
    entry: Option<usize>,
    /// The last entry of the table.
    last: Option<usize>,
    comma: Option<usize>,
}

struct Reader<'t> {
    source: Source<'t>,
    layout: Layout,
    /// The keys since the last value.
    keys: Vec<(String, Range<usize>)>,
    /// The present header, then the open inline tables.
    open: Vec<Table>,
    /// The start of the present header.
    start: usize,
    /// Number of open arrays, whose content no case reads.
    arrays: usize,
}

impl Reader<'_> {
    fn read(&mut self, event: &Event) {
        let span = event.span().start()..event.span().end();
        match event.kind() {
            EventKind::ArrayOpen => {
                self.arrays += 1;
                if self.arrays == 1 {
                    self.value(span, Value::Array);
                }
            }
            EventKind::ArrayClose => {
                self.arrays = self.arrays.saturating_sub(1);
                if let (0, Some(own)) = (self.arrays, self.last()) {
                    own.span.end = span.end;
                }
            }
            _ if self.arrays > 0 => {}
            EventKind::SimpleKey => {
                let mut name = Cow::Borrowed("");
                if let Some(raw) = self.source.get(event) {
                    raw.decode_key(&mut name, &mut ());
                }
                self.keys.push((name.into_owned(), span));
            }
            EventKind::StdTableOpen | EventKind::ArrayTableOpen => {
                self.keys.clear();
                self.open.clear();
                self.start = span.start;
            }
            EventKind::StdTableClose | EventKind::ArrayTableClose => {
                let is_array = event.kind() == EventKind::ArrayTableClose;
                let value = if is_array { Value::Array } else { Value::Table };
                self.open = vec![Table::default()];
                self.entry(self.start..span.end, value, true);
                let path = self.layout.entries.last().map(|own| own.path.clone());
                self.open = vec![Table { path: path.unwrap_or_default(), ..Table::default() }];
            }
            EventKind::KeyValSep => self.entry(span.end..span.end, Value::Table, false),
            EventKind::Scalar => {
                let mut text = Cow::Borrowed("");
                let raw = self.source.get(event);
                let kind = raw.map(|raw| raw.decode_scalar(&mut text, &mut ()));
                let text = text.into_owned();
                let radix = |radix| {
                    i128::from_str_radix(&text, radix).map_or(text.clone(), |n| n.to_string())
                };
                self.value(
                    span,
                    match kind {
                        Some(ScalarKind::Boolean(flag)) => Value::Flag(flag),
                        Some(ScalarKind::DateTime) => Value::Date,
                        Some(ScalarKind::Integer(IntegerRadix::Hex)) => Value::Number(radix(16)),
                        Some(ScalarKind::Integer(IntegerRadix::Oct)) => Value::Number(radix(8)),
                        Some(ScalarKind::Integer(IntegerRadix::Bin)) => Value::Number(radix(2)),
                        Some(ScalarKind::Integer(_) | ScalarKind::Float) => Value::Number(text),
                        Some(ScalarKind::String) | None => Value::String(text),
                    },
                );
            }
            EventKind::InlineTableOpen => {
                self.value(span, Value::Table);
                let entry = self.open.last().and_then(|table| table.last);
                let path = self.last().map_or_else(Vec::new, |own| own.path.clone());
                self.open.push(Table { path, entry, ..Table::default() });
            }
            EventKind::InlineTableClose if self.open.len() > 1 => {
                let entry = self.open.pop().and_then(|table| table.entry);
                if let Some(own) = entry.and_then(|entry| self.layout.entries.get_mut(entry)) {
                    own.span.end = span.end;
                }
            }
            EventKind::ValueSep => {
                if let Some(own) = self.last() {
                    own.comma = Some(span.start);
                }
                if let Some(table) = self.open.last_mut() {
                    table.comma = Some(span.start);
                }
            }
            _ => {}
        }
    }

    /// Adds an entry with the keys since the last value.
    fn entry(&mut self, span: Range<usize>, value: Value, is_header: bool) {
        let is_inline = self.open.len() > 1;
        let Some(table) = self.open.last_mut() else { return };
        let (names, keys): (Vec<String>, Vec<_>) = self.keys.drain(..).unzip();
        let (path, given) = ([table.path.clone(), names].concat(), table.path.len());
        if keys.is_empty() {
            return;
        }
        table.last = Some(self.layout.entries.len());
        let (comma_before, comma) = (table.comma, None);
        self.layout.entries.push(Entry {
            path,
            given,
            keys,
            span,
            value,
            is_header,
            is_inline,
            comma_before,
            comma,
        });
    }

    /// The last entry of the present table.
    fn last(&mut self) -> Option<&mut Entry> {
        let last = self.open.last().and_then(|table| table.last);
        last.and_then(|last| self.layout.entries.get_mut(last))
    }

    fn value(&mut self, span: Range<usize>, value: Value) {
        if let Some(own) = self.last() {
            (own.span, own.value) = (span, value);
        }
    }
}
