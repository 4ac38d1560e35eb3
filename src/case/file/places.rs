//! Places of keys, values and tables in the text of a case file.

use std::ops::Range;

/// Place of a key and its value in the text.
#[derive(Debug, Clone)]
pub(super) struct Place {
    /// The field's key, or `limits.…`, `spread."…"` or `variants.…`.
    pub(super) key: String,
    /// The value as written.
    pub(super) value: Range<usize>,
}

/// Places of all keys and tables in the text.
#[derive(Debug, Clone, Default)]
pub(super) struct Places {
    pub(super) entries: Vec<Place>,
    /// Tables by name, with the place of the header or of the first mention.
    pub(super) tables: Vec<(String, Range<usize>)>,
    pub(super) end: usize,
}

impl Places {
    pub(super) fn entry(&self, key: &str) -> Option<&Place> {
        self.entries.iter().find(|place| place.key == key)
    }

    pub(super) fn table(&self, name: &str) -> Option<&Range<usize>> {
        self.tables.iter().find(|(table, _)| table == name).map(|(_, span)| span)
    }

    /// The place to report for a key: its value, its table, or the end.
    pub(super) fn offset(&self, key: &str) -> usize {
        let table = || self.table(key.split('.').next().unwrap_or_default()).map(|span| span.start);
        self.entry(key).map(|place| place.value.start).or_else(table).unwrap_or(self.end)
    }
}
