//! Reads and saves case files: a case together with its source text.

mod comments;
mod disk;
mod edit;
mod error;
mod excerpt;
mod fault;
mod layout;
mod places;
mod syntax;
mod target;
mod template;
mod tree;
mod unknown;
mod value;

use std::path::PathBuf;

use super::stamp::Stamp;
use super::{Case, Problem};
pub use comments::without_comments;
pub use disk::{Saved, read_bytes};
pub use error::{ReadError, SaveError};
use fault::Lines;
pub use fault::{Fault, FaultKind};
use places::Places;
pub use target::{Draft, followed, write};

/// The format of case files that this version reads and writes.
pub const FORMAT: u32 = 1;

/// Greatest size of a case file, in bytes.
pub const MOST_BYTES: usize = 1 << 20;

/// Greatest size of a model of another program, packed or unpacked, in bytes.
pub const MOST_MODEL_BYTES: usize = 16 << 20;

const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");
const BYTE_ORDER_MARK: char = '\u{feff}';

/// A case and the text of its file. Saving keeps comments, order, spacing and line ends.
#[derive(Debug, Clone)]
pub struct Document {
    /// The case. Edits change it directly.
    pub case: Case,
    name: String,
    /// The text of the file without its byte order mark.
    text: String,
    marked: bool,
    /// The stamp of the whole text of the file.
    stamp: Stamp,
    /// The case of the text.
    loaded: Case,
    places: Places,
    /// Whether the text has a newer format, which this version reads only in part.
    is_newer: bool,
    /// The path of the file after resolution of links.
    origin: Option<PathBuf>,
    /// The mode of the file when it was read or saved, in case it is deleted.
    mode: Option<u32>,
}

impl Document {
    /// Reads a complete case from its text. Each fault begins with `name`.
    ///
    /// # Errors
    /// All faults of the text and all missing required values, sorted by place.
    pub fn parse(name: &str, text: &str) -> Result<Document, Vec<Fault>> {
        Document::parse_draft(name, text).and_then(Document::complete)
    }

    /// Reads a case that can lack required values. [`Case::inputs`] names the missing values.
    ///
    /// # Errors
    /// All faults of the text, sorted by place.
    pub fn parse_draft(name: &str, text: &str) -> Result<Document, Vec<Fault>> {
        if text.len() > MOST_BYTES {
            return Err(vec![fault::too_large(name)]);
        }
        let unmarked = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let reading = tree::read(unmarked);
        if !reading.is_draft() {
            return Err(fault::placed(name, unmarked, reading.faults, reading.more));
        }
        let marked = unmarked.len() < text.len();
        let (case, places) = (reading.case, reading.places);
        let loaded = case.clone();
        Ok(Document {
            case,
            name: name.to_owned(),
            text: unmarked.to_owned(),
            marked,
            stamp: Stamp::of(text.as_bytes()),
            loaded,
            places,
            is_newer: false,
            origin: None,
            mode: None,
        })
    }

    /// Reads a complete case from bytes that may not be text.
    ///
    /// # Errors
    /// As [`Document::parse`], and at the first byte that is not UTF-8.
    pub fn parse_bytes(name: &str, bytes: &[u8]) -> Result<Document, Vec<Fault>> {
        Document::parse_draft_bytes(name, bytes).and_then(Document::complete)
    }

    fn parse_draft_bytes(name: &str, bytes: &[u8]) -> Result<Document, Vec<Fault>> {
        if bytes.len() > MOST_BYTES {
            return Err(vec![fault::too_large(name)]);
        }
        match std::str::from_utf8(bytes) {
            Ok(text) => Document::parse_draft(name, text),
            Err(error) => Err(vec![fault::not_text(name, bytes, error.valid_up_to())]),
        }
    }

    fn complete(self) -> Result<Document, Vec<Fault>> {
        match self.case.inputs() {
            Ok(_) => Ok(self),
            Err(problems) => Err(self.faults(problems)),
        }
    }

    /// The part of a text of a newer format that this version can read.
    fn parse_newer(name: &str, text: &str) -> Document {
        let unmarked = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let reading = tree::read_newer(unmarked);
        let (loaded, name, marked) =
            (reading.case.clone(), name.to_owned(), unmarked.len() < text.len());
        let (case, places) = (reading.case, reading.places);
        Document {
            case,
            name,
            text: unmarked.to_owned(),
            marked,
            stamp: Stamp::of(text.as_bytes()),
            loaded,
            places,
            is_newer: true,
            origin: None,
            mode: None,
        }
    }

    /// Whether the text has a newer format, which this version reads only in part.
    #[must_use]
    pub fn is_newer(&self) -> bool {
        self.is_newer
    }

    /// A document without a file: the case as commented text with every field.
    #[must_use]
    pub fn new(case: Case) -> Document {
        Document::commented("new case".to_owned(), case, &[])
    }

    /// A document without a file, with additional comments at the named fields.
    #[must_use]
    pub fn commented(name: String, case: Case, comments: &[(&str, String)]) -> Document {
        let text = template::text(&case, comments);
        let places = tree::read(&text).places;
        let loaded = case.clone();
        Document {
            loaded,
            case,
            name,
            stamp: Stamp::of(text.as_bytes()),
            text,
            marked: false,
            places,
            is_newer: false,
            origin: None,
            mode: None,
        }
    }

    /// Table 1 of the paper, from its file in `cases/`.
    #[must_use]
    pub fn table_1() -> Document {
        Document::parse("zhou-chen-2014.toml", TABLE_1)
            .unwrap_or_else(|_| Document::new(Case::empty()))
    }

    /// The file name of the document.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether the case differs from the text that was read or saved last.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.case != self.loaded
    }

    /// The text to save: the original text with only the changed values replaced.
    #[must_use]
    pub fn render(&self) -> String {
        let text = if self.is_changed() {
            edit::render(&self.text, &self.loaded, &self.case)
        } else {
            self.text.clone()
        };
        if self.marked { format!("{BYTE_ORDER_MARK}{text}") } else { text }
    }

    /// Line and column, from 1, of a field's value. If the text does not have the field, the place
    /// of its table or the end.
    #[must_use]
    pub fn place(&self, key: &str) -> (usize, usize) {
        Lines::of(&self.text).place(self.places.offset(key))
    }

    /// A later problem, such as a refusal of the model, at its place in the file.
    #[must_use]
    pub fn fault(&self, problem: Problem) -> Fault {
        Fault::new(&self.name, self.place(&problem.field), problem)
    }

    /// Later problems at their places in the file, sorted by place.
    #[must_use]
    pub(crate) fn faults(&self, problems: Vec<Problem>) -> Vec<Fault> {
        let mut faults: Vec<Fault> =
            problems.into_iter().map(|problem| self.fault(problem)).collect();
        faults.sort_by_key(|fault| (fault.line, fault.column));
        faults
    }

    /// Replaces the source by the saved text and the case by its content. The file does not keep
    /// spaces around a number.
    fn settle(&mut self, text: &str, name: String, origin: PathBuf) {
        text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text).clone_into(&mut self.text);
        self.stamp = Stamp::of(text.as_bytes());
        let reading = tree::read(&self.text);
        if reading.is_draft() {
            self.case = reading.case;
        }
        self.loaded = self.case.clone();
        self.places = reading.places;
        self.name = name;
        self.origin = Some(origin);
    }
}
