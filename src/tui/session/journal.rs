//! The text of a journal: unsaved edits, with a checksum that shows whether the text is complete.

use std::path::{Path, PathBuf};

use thiserror::Error;
use toml_edit::{ArrayOfTables, DocumentMut, Item, Table, TableLike, value};

use crate::case::changes::Change;
use crate::case::stamp::{Stamp, hash};
use crate::system::paths;

/// The format of journals that this version reads and writes.
pub(crate) const FORMAT: i64 = 1;

/// Greatest size of a journal to read, in bytes: more than the changes of any case.
pub(crate) const MOST_BYTES: usize = 4 << 20;

const OPENING: &str =
    "# Edits that were not saved. tipstrike offers them when the case is opened again.\n";
const FORMAT_KEY: &str = "format = ";
const CHECKSUM_KEY: &str = "checksum = ";

/// Edits of a case that are not in its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Journal {
    /// The file of the case; `None` if it has none yet.
    pub case: Option<PathBuf>,
    /// Length and hash of the text that was edited.
    pub(crate) base_stamp: Stamp,
    /// When the journal was written, in seconds since 1970.
    pub(crate) written: u64,
    /// The session of the journal.
    pub(crate) session: String,
    /// The edits, each from the value in the file to the typed text, valid or not.
    pub changes: Vec<Change>,
}

/// Why a text is not a valid journal.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum JournalFault {
    /// The text is not a journal.
    #[error("the file is not a journal")]
    NotOne,
    /// The journal has a newer format.
    #[error("the format {0} of the journal is newer than this version")]
    NewerFormat(i64),
    /// The journal was cut or changed after it was written.
    #[error("the journal is damaged")]
    Damaged,
    /// The journal is complete, but its content is invalid.
    #[error("the journal has no valid `{0}`")]
    Misformed(&'static str),
}

impl Journal {
    /// Whether the journal belongs to the case in a file; without a file, to the text with a stamp.
    pub(crate) fn is_of(&self, case: Option<&Path>, stamp: Stamp) -> bool {
        self.case.as_deref() == case && (case.is_some() || self.base_stamp == stamp)
    }

    /// The text of a journal file.
    pub(crate) fn to_text(&self) -> String {
        let body = self.body();
        format!(
            "{OPENING}{FORMAT_KEY}{FORMAT}\n{CHECKSUM_KEY}\"{:016x}\"\n{body}",
            hash(body.as_bytes())
        )
    }

    /// Parses the text of a journal file.
    ///
    /// # Errors
    /// Returns an error if the text is not, byte for byte, an output of [`Journal::to_text`].
    pub fn from_text(text: &str) -> Result<Journal, JournalFault> {
        let rest = text.strip_prefix(OPENING).ok_or(JournalFault::NotOne)?;
        let (format, rest) = line_of(rest, FORMAT_KEY).ok_or(JournalFault::NotOne)?;
        match format.parse() {
            Ok(FORMAT) => {}
            Ok(newer) if newer > FORMAT => return Err(JournalFault::NewerFormat(newer)),
            _ => return Err(JournalFault::NotOne),
        }
        let (checksum, body) = line_of(rest, CHECKSUM_KEY).ok_or(JournalFault::Damaged)?;
        if checksum != format!("\"{:016x}\"", hash(body.as_bytes())) {
            return Err(JournalFault::Damaged);
        }
        let toml: DocumentMut = body.parse().map_err(|_| JournalFault::Damaged)?;
        read(toml.as_table()).map_err(JournalFault::Misformed)
    }

    fn body(&self) -> String {
        let mut toml = DocumentMut::new();
        toml["written"] = value(self.written.cast_signed());
        toml["session"] = value(&self.session);
        toml["length"] = value(self.base_stamp.length.cast_signed());
        toml["hash"] = value(format!("{:016x}", self.base_stamp.hash));
        if let Some(case) = &self.case {
            match case.to_str() {
                Some(path) => toml["case"] = value(path),
                None => toml["case_bytes"] = value(hex(case)),
            }
        }
        let changes: ArrayOfTables = self.changes.iter().map(table_of).collect();
        if !changes.is_empty() {
            toml["change"] = Item::ArrayOfTables(changes);
        }
        toml.to_string()
    }
}

fn line_of<'t>(text: &'t str, key: &str) -> Option<(&'t str, &'t str)> {
    text.strip_prefix(key)?.split_once('\n')
}

fn table_of(change: &Change) -> Table {
    let mut table = Table::new();
    table["key"] = value(&change.key);
    for (name, text) in [("from", &change.from), ("to", &change.to)] {
        if let Some(text) = text {
            table[name] = value(text);
        }
    }
    table
}

fn read(toml: &Table) -> Result<Journal, &'static str> {
    let number = |key| {
        toml.get(key)
            .and_then(Item::as_integer)
            .and_then(|number| u64::try_from(number).ok())
            .ok_or(key)
    };
    let hash =
        text_in(toml, "hash").and_then(|text| u64::from_str_radix(text, 16).ok()).ok_or("hash")?;
    let case = match (text_in(toml, "case"), text_in(toml, "case_bytes")) {
        (Some(path), _) => Some(PathBuf::from(path)),
        (None, Some(bytes)) => Some(from_hex(bytes).ok_or("case_bytes")?),
        (None, None) => None,
    };
    let changes = match toml.get("change") {
        Some(changes) => changes
            .as_array_of_tables()
            .ok_or("change")?
            .iter()
            .map(change_of)
            .collect::<Result<_, _>>()?,
        None => Vec::new(),
    };
    Ok(Journal {
        case,
        base_stamp: Stamp { length: number("length")?, hash },
        written: number("written")?,
        session: text_in(toml, "session").ok_or("session")?.to_owned(),
        changes,
    })
}

fn change_of(table: &Table) -> Result<Change, &'static str> {
    let text = |key| text_in(table, key).map(str::to_owned);
    Ok(Change { key: text("key").ok_or("key")?, from: text("from"), to: text("to") })
}

fn text_in<'t>(table: &'t Table, key: &str) -> Option<&'t str> {
    TableLike::get(table, key).and_then(Item::as_str)
}

// In hexadecimal, because a path need not be valid text.
fn hex(path: &Path) -> String {
    paths::bytes(path).iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

fn from_hex(text: &str) -> Option<PathBuf> {
    let pairs = text.as_bytes().chunks(2);
    let bytes = pairs
        .map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok())
        .collect::<Option<Vec<u8>>>()?;
    Some(paths::from_bytes(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn journal() -> Journal {
        let change = |key: &str, from: Option<&str>, to: Option<&str>| Change {
            key: key.to_owned(),
            from: from.map(str::to_owned),
            to: to.map(str::to_owned),
        };
        Journal {
            case: Some("/home/me/äöü \"quoted\"\n\u{1b}[2J.toml".into()),
            base_stamp: Stamp::of(b"format = 1\n"),
            written: 1_795_265_502,
            session: "abc123".to_owned(),
            changes: vec![
                change("pair.module", Some("5 mm"), Some("1 in")),
                change("title", Some("'''\"\"\"\\"), Some("\u{0}\u{7f}\u{9b}\r\n\u{202e}")),
                change("driver.tip_radius", None, Some("0.2 mm")),
                change("notes", Some("x"), None),
            ],
        }
    }

    #[test]
    fn a_journal_is_parsed_from_its_text() {
        let other = Journal { case: Some(paths::from_bytes(vec![b'/', 0xff, b'a'])), ..journal() };
        let fresh = Journal { case: None, changes: Vec::new(), ..journal() };
        for journal in [journal(), other, fresh] {
            assert_eq!(Journal::from_text(&journal.to_text()), Ok(journal));
        }
    }

    #[test]
    fn no_journal_that_is_cut_or_changed_is_trusted() {
        let text = journal().to_text();
        for (at, _) in text.char_indices() {
            assert!(Journal::from_text(&text[..at]).is_err(), "cut at {at}");
            let changed: String = text
                .char_indices()
                .map(|(own, letter)| if own == at { '~' } else { letter })
                .collect();
            assert!(Journal::from_text(&changed).is_err() || changed == text, "changed at {at}");
        }
        assert!(Journal::from_text(&(text.clone() + "\n")).is_err());
        assert!(Journal::from_text(&text.replace('\n', "\r\n")).is_err());
    }

    #[test]
    fn a_newer_journal_is_refused_by_its_version() {
        let newer = journal().to_text().replace("format = 1", "format = 2");
        assert_eq!(Journal::from_text(&newer), Err(JournalFault::NewerFormat(2)));
        assert_eq!(Journal::from_text("format = 1\n"), Err(JournalFault::NotOne));
    }
}
