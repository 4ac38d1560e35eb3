//! Reads and saves case files: a case together with its source text.

mod fault;
mod layout;
mod read;
mod save;
mod syntax;
mod write;

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::stamp::Stamp;
use super::{Case, NEWER_FORMAT, Problem};
use crate::system::files;
pub use fault::{Fault, ReadError, SaveError};
use fault::{place, shown};
use layout::Layout;
pub use layout::without_comments;
use save::target_of;
pub use save::{Draft, followed, write};

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
    /// Whether the text has a newer format, which this version reads only in part.
    is_newer: bool,
    /// The path of the file after resolution of links.
    origin: Option<PathBuf>,
    /// The mode of the file when it was read or saved, in case it is deleted.
    mode: Option<u32>,
}

/// The effect of a save on the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Saved {
    /// The file has the new text.
    Written,
    /// The file had been deleted, and the save created it again.
    Recreated,
}

impl Document {
    /// Reads a complete case from its text. Each fault begins with `name`.
    ///
    /// # Errors
    /// All faults of the text and all missing required values, sorted by place. A syntax error is
    /// reported alone.
    pub fn parse(name: &str, text: &str) -> Result<Document, Vec<Fault>> {
        Document::parse_draft(name, text)?.complete()
    }

    /// Reads a case that can lack required values. [`Case::inputs`] names the missing values.
    ///
    /// # Errors
    /// All faults of the text, sorted by place.
    pub fn parse_draft(name: &str, text: &str) -> Result<Document, Vec<Fault>> {
        Document::of(name, text.as_bytes(), false)
    }

    /// Reads a complete case from bytes that may not be text.
    ///
    /// # Errors
    /// As [`Document::parse`], and at the first byte that is not UTF-8.
    pub fn parse_bytes(name: &str, bytes: &[u8]) -> Result<Document, Vec<Fault>> {
        Document::of(name, bytes, false)?.complete()
    }

    /// A draft, or the known part of a text of a newer format.
    fn of(name: &str, bytes: &[u8], is_newer: bool) -> Result<Document, Vec<Fault>> {
        if bytes.len() > MOST_BYTES {
            let cause = format!("the text is longer than {} KiB", MOST_BYTES / 1024);
            let fix = "name a case file; a case needs a few KiB";
            return Err(vec![Fault::new(name, (1, 1), Problem::new("toml", cause, fix))]);
        }
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let at = error.valid_up_to();
            let byte = bytes.get(at).copied().unwrap_or_default();
            let cause = format!("byte 0x{byte:02x} is not UTF-8 text");
            let place = place(&String::from_utf8_lossy(&bytes[..at]), at);
            vec![Fault::new(name, place, Problem::new("toml", cause, "save the file as UTF-8"))]
        })?;
        let unmarked = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        let reading = read::read(unmarked, is_newer);
        if !is_newer && !reading.is_draft() {
            return Err(Fault::placed(name, unmarked, reading.faults));
        }
        Ok(Document { is_newer, ..Document::with(name.to_owned(), reading.case, text) })
    }

    /// A document of a case and its text, without a file.
    fn with(name: String, case: Case, text: &str) -> Document {
        let unmarked = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
        Document {
            loaded: case.clone(),
            case,
            name,
            text: unmarked.to_owned(),
            marked: unmarked.len() < text.len(),
            stamp: Stamp::of(text.as_bytes()),
            is_newer: false,
            origin: None,
            mode: None,
        }
    }

    fn complete(self) -> Result<Document, Vec<Fault>> {
        match self.case.inputs() {
            Ok(_) => Ok(self),
            Err(problems) => Err(self.faults(problems)),
        }
    }

    /// A document without a file: the case as commented text with every field.
    #[must_use]
    pub fn new(case: Case) -> Document {
        Document::commented("new case".to_owned(), case, &[])
    }

    /// A document without a file, with additional comments at the named fields.
    #[must_use]
    pub fn commented(name: String, case: Case, comments: &[(&str, String)]) -> Document {
        let text = write::template(&case, comments);
        Document::with(name, case, &text)
    }

    /// Table 1 of the paper, from its file in `cases/`.
    #[must_use]
    pub fn table_1() -> Document {
        Document::parse("zhou-chen-2014.toml", TABLE_1)
            .unwrap_or_else(|_| Document::new(Case::empty()))
    }

    /// Reads a complete case from a file, or from standard input if the path is `-`.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a valid case.
    pub fn read(path: &Path) -> Result<Document, ReadError> {
        Document::read_draft(path)?.complete().map_err(ReadError::Bad)
    }

    /// Reads a case that can lack required values from a file, or from standard input if the path
    /// is `-`.
    ///
    /// # Errors
    /// If the file cannot be read, or has other faults.
    pub fn read_draft(path: &Path) -> Result<Document, ReadError> {
        Document::read_file(path, false)
    }

    /// Reads the known part of a file of a newer format, for viewing only.
    ///
    /// # Errors
    /// If the file cannot be read, or is not text.
    pub fn read_newer(path: &Path) -> Result<Document, ReadError> {
        Document::read_file(path, true)
    }

    fn read_file(path: &Path, is_newer: bool) -> Result<Document, ReadError> {
        let name = shown(path);
        let parse = |bytes: Vec<u8>| {
            Document::of(&name, &bytes, is_newer).map_err(|mut faults| match &faults[..] {
                [only] if &*only.problem.code == NEWER_FORMAT => {
                    ReadError::NewerFormat(Box::new(faults.remove(0)))
                }
                _ => ReadError::Bad(faults),
            })
        };
        if path == Path::new("-") {
            return parse(read_bytes(path, MOST_BYTES)?);
        }
        let file = open(path, &name)?;
        let mode = file.metadata().ok().and_then(|about| files::mode(&about));
        let document = parse(limited(file, &name, MOST_BYTES)?)?;
        Ok(Document { origin: followed(path).ok(), mode, ..document })
    }

    /// Whether the text has a newer format, which this version reads only in part.
    #[must_use]
    pub fn is_newer(&self) -> bool {
        self.is_newer
    }

    /// The file name of the document.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file that the document was read from or saved to, after resolution of links.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.origin.as_deref()
    }

    /// The stamp of the text that was read or saved last.
    #[must_use]
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// The case of the text that was read or saved last.
    #[must_use]
    pub fn loaded(&self) -> &Case {
        &self.loaded
    }

    /// Whether the case differs from the text that was read or saved last.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.case != self.loaded
    }

    /// The text to save: the original text with only the changed values replaced.
    #[must_use]
    pub fn render(&self) -> String {
        let mark = if self.marked { "\u{feff}" } else { "" };
        if self.is_changed() {
            format!("{mark}{}", write::render(&self.text, &self.loaded, &self.case))
        } else {
            format!("{mark}{}", self.text)
        }
    }

    /// Line and column, from 1, of a field's value. If the text does not have the field, the place
    /// of its table or the end.
    #[must_use]
    pub fn place(&self, key: &str) -> (usize, usize) {
        place(&self.text, Layout::of(&self.text).unwrap_or_default().place(key))
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

    /// Saves to a file. Fails if another file exists there or the file changed since it was read.
    ///
    /// # Errors
    /// If nothing was saved. The file is then unchanged.
    pub fn save(&mut self, path: &Path) -> Result<Saved, SaveError> {
        self.write(path, false)
    }

    /// Saves to a file and replaces any content.
    ///
    /// # Errors
    /// If nothing was saved. The file is then unchanged.
    pub fn save_over(&mut self, path: &Path) -> Result<Saved, SaveError> {
        self.write(path, true)
    }

    fn write(&mut self, path: &Path, over: bool) -> Result<Saved, SaveError> {
        let name = shown(path);
        if self.is_newer {
            return Err(SaveError::NewerFormat(name));
        }
        let target = target_of(path)?;
        if target.old.is_some() && !over {
            self.same_as_read(&target.path, &name)?;
        }
        let is_own = self.origin.as_ref() == Some(&target.path)
            || self.origin.is_some() && self.name == name;
        let text = self.render();
        let unmarked = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(&text);
        let reading = read::read(unmarked, false);
        if self.case.inputs().is_ok() && !write::are_same(&reading.case, &self.case) {
            return Err(SaveError::OtherCase(name));
        }
        let mode = self.mode.filter(|_| is_own);
        target.replace(text.as_bytes(), mode, path, false)?;
        let is_recreated = is_own && target.old.is_none();
        self.mode = fs::metadata(&target.path).ok().and_then(|about| files::mode(&about)).or(mode);
        // The file does not keep spaces around a number.
        if reading.is_draft() {
            self.case = reading.case;
        }
        self.loaded = self.case.clone();
        (self.text, self.stamp) = (unmarked.to_owned(), Stamp::of(text.as_bytes()));
        (self.name, self.origin) = (name, Some(target.path));
        Ok(if is_recreated { Saved::Recreated } else { Saved::Written })
    }

    /// Compares the content, not the time stamp, because a touched file is unchanged.
    fn same_as_read(&self, target: &Path, name: &str) -> Result<(), SaveError> {
        if self.origin.as_deref() != Some(target) {
            return Err(SaveError::AlreadyThere(name.to_owned()));
        }
        match open(target, name).and_then(|file| limited(file, name, MOST_BYTES)) {
            Ok(bytes) if Stamp::of(&bytes) == self.stamp => Ok(()),
            Err(ReadError::Unreadable(name, error)) => Err(SaveError::Unreadable(name, error)),
            _ => Err(SaveError::ChangedOnDisk(name.to_owned())),
        }
    }
}

/// Opens a regular file. Checks the type before opening, because opening a pipe waits for a writer.
fn open(path: &Path, name: &str) -> Result<File, ReadError> {
    let failed = |error: io::Error| match error.kind() {
        ErrorKind::NotFound => ReadError::NotFound(name.to_owned()),
        _ => ReadError::Unreadable(name.to_owned(), error),
    };
    if !fs::metadata(path).map_err(failed)?.is_file() {
        return Err(ReadError::NotAFile(name.to_owned()));
    }
    File::open(path).map_err(failed)
}

/// The bytes of a regular file of at most `most` bytes, or of standard input if the path is `-`.
///
/// # Errors
/// If the file cannot be read, or is too long.
pub fn read_bytes(path: &Path, most: usize) -> Result<Vec<u8>, ReadError> {
    let name = shown(path);
    if path == Path::new("-") {
        return limited(io::stdin().lock(), &name, most);
    }
    limited(open(path, &name)?, &name, most)
}

fn limited(source: impl Read, name: &str, most: usize) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    source
        .take(most as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| ReadError::Unreadable(name.to_owned(), error))?;
    if bytes.len() > most {
        Err(ReadError::TooLarge(name.to_owned(), most >> 10))
    } else {
        Ok(bytes)
    }
}
