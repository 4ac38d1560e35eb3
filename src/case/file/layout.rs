//! The places of all headers, keys and values in the text of a case, for edits that keep every other
//! byte.

use std::borrow::Cow;
use std::ops::Range;

use toml_parser::Source;
use toml_parser::parser::{Event, EventKind, parse_document};

/// A header, such as `[variants.relieved]`.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) path: Vec<String>,
    /// Its place up to the bracket that closes it.
    pub(super) span: Range<usize>,
}

/// A key with its value, on its own line or in an inline table.
#[derive(Debug)]
pub(super) struct Entry {
    /// The keys from the top level.
    pub(super) path: Vec<String>,
    /// Number of keys that its header or its inline table gives.
    pub(super) given: usize,
    /// The keys before the `=`, such as `driver.teeth`.
    pub(super) keys: Range<usize>,
    /// The last key.
    pub(super) key: Range<usize>,
    pub(super) value: Range<usize>,
    /// The comma after the value in an inline table.
    pub(super) comma: Option<usize>,
    /// The comma before the key in an inline table.
    pub(super) comma_before: Option<usize>,
    pub(super) is_inline: bool,
    /// Whether the value is an inline table.
    pub(super) is_table: bool,
}

impl Entry {
    /// The keys of its table.
    pub(super) fn table(&self) -> &[String] {
        &self.path[..self.path.len() - 1]
    }
}

/// Headers and entries in the order of the text. An inline table is before its members.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub(super) headers: Vec<Header>,
    pub(super) entries: Vec<Entry>,
}

impl Layout {
    /// The layout of a text without syntax errors. A case has no arrays.
    pub(super) fn of(text: &str) -> Layout {
        let source = Source::new(text);
        let mut reader = Reader {
            source,
            layout: Layout::default(),
            keys: Vec::new(),
            open: vec![Table::default()],
            header: 0,
        };
        let tokens = source.lex().into_vec();
        parse_document(&tokens, &mut |event: Event| reader.read(&event), &mut ());
        reader.layout
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
    header: usize,
}

impl Reader<'_> {
    fn read(&mut self, event: &Event) {
        let span = event.span().start()..event.span().end();
        match event.kind() {
            EventKind::SimpleKey => {
                let mut name = Cow::Borrowed("");
                if let Some(raw) = self.source.get(event) {
                    raw.decode_key(&mut name, &mut ());
                }
                self.keys.push((name.into_owned(), span));
            }
            EventKind::StdTableOpen => {
                self.keys.clear();
                self.header = span.start;
            }
            EventKind::StdTableClose => {
                let path: Vec<String> = self.keys.drain(..).map(|(name, _)| name).collect();
                self.open = vec![Table { path: path.clone(), ..Table::default() }];
                let span = self.header..span.end;
                self.layout.headers.push(Header { path, span });
            }
            EventKind::KeyValSep => self.entry(),
            EventKind::Scalar => self.end_value(span),
            EventKind::InlineTableOpen => {
                let entry = self.open.last().and_then(|table| table.last);
                let own = entry.and_then(|entry| self.layout.entries.get_mut(entry));
                let path = own.map_or_else(Vec::new, |own| {
                    (own.value, own.is_table) = (span, true);
                    own.path.clone()
                });
                self.open.push(Table { path, entry, ..Table::default() });
            }
            EventKind::InlineTableClose if self.open.len() > 1 => {
                let entry = self.open.pop().and_then(|table| table.entry);
                if let Some(own) = entry.and_then(|entry| self.layout.entries.get_mut(entry)) {
                    own.value.end = span.end;
                }
            }
            EventKind::ValueSep => {
                if let Some(table) = self.open.last_mut() {
                    table.comma = Some(span.start);
                    let last = table.last.and_then(|at| self.layout.entries.get_mut(at));
                    if let Some(own) = last {
                        own.comma = Some(span.start);
                    }
                }
            }
            _ => {}
        }
    }

    /// Adds an entry with the keys before the `=`.
    fn entry(&mut self) {
        let is_inline = self.open.len() > 1;
        let (Some(table), Some(first), Some(last)) =
            (self.open.last_mut(), self.keys.first(), self.keys.last())
        else {
            return;
        };
        let names = self.keys.iter().map(|(name, _)| name);
        self.layout.entries.push(Entry {
            path: table.path.iter().chain(names).cloned().collect(),
            given: table.path.len(),
            keys: first.1.start..last.1.end,
            key: last.1.clone(),
            value: last.1.end..last.1.end,
            comma: None,
            comma_before: table.comma,
            is_inline,
            is_table: false,
        });
        table.last = Some(self.layout.entries.len() - 1);
        self.keys.clear();
    }

    fn end_value(&mut self, span: Range<usize>) {
        let last = self.open.last().and_then(|table| table.last);
        if let Some(own) = last.and_then(|last| self.layout.entries.get_mut(last)) {
            own.value = span;
        }
    }
}
