//! Where keys, values and tables stand in the text of a case file.

use std::ops::Range;

/// Where a key and its value stand in the text.
#[derive(Debug, Clone)]
pub(super) struct Place {
    /// The field's key, or `limits.…`, `spread."…"` or `variants.…`.
    pub(super) key: String,
    /// The value as written.
    pub(super) value: Range<usize>,
}

/// Where everything stands in the text.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    pub(super) entries: Vec<Place>,
    /// Tables by name, with the header or, where there is none, the first mention.
    pub(super) tables: Vec<(String, Range<usize>)>,
    pub(super) end: usize,
}

impl Places {
    pub(super) fn entry(&self, key: &str) -> Option<&Place> {
        self.entries.iter().find(|place| place.key == key)
    }

    pub(super) fn table(&self, name: &str) -> Option<&Range<usize>> {
        self.tables
            .iter()
            .find(|(table, _)| table == name)
            .map(|(_, span)| span)
    }

    /// Where to point for a key: its value, its table, the end.
    pub(super) fn offset(&self, key: &str) -> usize {
        let table = || {
            self.table(key.split('.').next().unwrap_or_default())
                .map(|span| span.start)
        };
        self.entry(key)
            .map(|place| place.value.start)
            .or_else(table)
            .unwrap_or(self.end)
    }
}
