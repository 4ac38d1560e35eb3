//! Reads and saves case files: a case together with its source text.

mod read;
mod save;

use super::{Case, NEWER_FORMAT, Problem};
use crate::case::sanitize::{cut, sanitize};
use crate::system::files;
pub use save::{Draft, followed, write};
use save::{are_same, render, target_of, template};
use siphasher::sip::SipHasher24;
use std::fmt;
use std::fs::{self, File};
use std::hash::Hasher;
use std::io::{self, ErrorKind, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use thiserror::Error;
use toml_edit::{Item, Key, RawString, Table, TomlError};

/// The format of case files that this version reads and writes.
pub const FORMAT: u32 = 1;

/// Greatest size of a case file, in bytes.
pub const MOST_BYTES: usize = 1 << 20;

/// Greatest size of a model of another program, packed or unpacked, in bytes.
pub const MOST_MODEL_BYTES: usize = 16 << 20;

const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");

/// A case and the text of its file. Saving keeps comments, order, spacing and line ends.
#[derive(Debug, Clone)]
pub struct Document {
    /// The case. Edits change it directly.
    pub case: Case,
    name: String,
    /// The text of the file.
    text: String,
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
    /// Reads a complete case from its text, or from bytes that may not be text. Each fault begins
    /// with `name`.
    ///
    /// # Errors
    /// All faults of the text and all missing required values, sorted by place. A syntax error, and
    /// the first byte that is not UTF-8, is reported alone.
    pub fn parse(name: &str, text: impl AsRef<[u8]>) -> Result<Document, Vec<Fault>> {
        Document::of(name, text.as_ref(), false)?.complete()
    }

    /// Reads a case that can lack required values. [`Case::inputs`] names the missing values.
    ///
    /// # Errors
    /// All faults of the text, sorted by place.
    pub fn parse_draft(name: &str, text: &str) -> Result<Document, Vec<Fault>> {
        Document::of(name, text.as_bytes(), false)
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
        let reading = read::read(text, is_newer);
        if !is_newer && !reading.is_draft() {
            return Err(Fault::placed(name, text, reading.faults));
        }
        Ok(Document { is_newer, ..Document::with(name.to_owned(), reading.case, text) })
    }

    /// A document of a case and its text, without a file.
    fn with(name: String, case: Case, text: &str) -> Document {
        Document {
            loaded: case.clone(),
            case,
            name,
            text: text.to_owned(),
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
    pub fn new(case: Case) -> Document {
        Document::commented("new case".to_owned(), case, &[])
    }

    /// A document without a file, with additional comments at the named fields.
    pub fn commented(name: String, case: Case, comments: &[(&str, String)]) -> Document {
        let text = template(&case, comments);
        Document::with(name, case, &text)
    }

    /// Table 1 of the paper, from its file in `cases/`.
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
    pub fn is_newer(&self) -> bool {
        self.is_newer
    }

    /// The file name of the document.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The file that the document was read from or saved to, after resolution of links.
    pub fn path(&self) -> Option<&Path> {
        self.origin.as_deref()
    }

    /// The stamp of the text that was read or saved last.
    pub fn stamp(&self) -> Stamp {
        self.stamp
    }

    /// The case of the text that was read or saved last.
    pub fn loaded(&self) -> &Case {
        &self.loaded
    }

    /// Whether the case differs from the text that was read or saved last.
    pub fn is_changed(&self) -> bool {
        self.case != self.loaded
    }

    /// The text to save: the original text with only the changed values replaced.
    pub fn render(&self) -> String {
        if self.is_changed() {
            render(&self.text, &self.loaded, &self.case)
        } else {
            self.text.clone()
        }
    }

    /// Line and column, from 1, of a field's value. If the text does not have the field, the place
    /// of its table or the end.
    pub fn place(&self, key: &str) -> (usize, usize) {
        place(&self.text, Layout::of(&self.text).unwrap_or_default().place(key))
    }

    /// A later problem, such as a refusal of the model, at its place in the file.
    pub fn fault(&self, problem: Problem) -> Fault {
        Fault::new(&self.name, self.place(&problem.field), problem)
    }

    /// Later problems at their places in the file, sorted by place.
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
        let reading = read::read(&text, false);
        if self.case.inputs().is_ok() && !are_same(&reading.case, &self.case) {
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
        (self.stamp, self.text) = (Stamp::of(text.as_bytes()), text);
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
    let kind = fs::metadata(path).map_err(failed)?;
    if kind.is_dir() {
        return Err(ReadError::IsAFolder(name.to_owned()));
    }
    if !kind.is_file() {
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

/// Greatest number of faults shown for one file.
const MOST: usize = 100;

/// A fault at one place of a file. Prints as `file:line:column: field: cause: fix`, on one line and
/// without control characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The file's name.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The problem. Its field is `toml` if the text is not TOML.
    pub problem: Problem,
}

impl Fault {
    fn new(file: &str, (line, column): (usize, usize), problem: Problem) -> Fault {
        Fault { file: file.to_owned(), line, column, problem }
    }

    /// The first problems at bytes of a text, in the order of their places.
    fn placed(file: &str, text: &str, mut problems: Vec<(usize, Problem)>) -> Vec<Fault> {
        problems.sort_by_key(|(at, _)| *at);
        let more = problems.get(MOST).map(|_| problems[MOST - 1].0);
        problems.truncate(MOST);
        let more =
            more.map(|at| (at, Problem::new("toml", "and more faults", "fix those above first")));
        let all = problems.into_iter().chain(more);
        all.map(|(at, problem)| Fault::new(file, place(text, at), problem)).collect()
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { file, line, column, problem: Problem { field, cause, fix, .. } } = self;
        let (file, field, cause) = (sanitize(file), cut(field), sanitize(cause));
        write!(f, "{file}:{line}:{column}: {field}: {cause}: {}", sanitize(fix))
    }
}

impl std::error::Error for Fault {}

/// The first byte after a byte order mark.
fn first_byte(text: &str) -> usize {
    const MARK: &str = "\u{feff}";
    if text.starts_with(MARK) { MARK.len() } else { 0 }
}

/// The start of the line of a byte, after a byte order mark.
fn line_start(text: &str, at: usize) -> usize {
    text[..at].rfind('\n').map_or_else(|| first_byte(text), |end| end + 1)
}

/// Line and column of a byte, both from 1, the column in characters.
fn place(text: &str, at: usize) -> (usize, usize) {
    let ends = || text.match_indices('\n').map(|(end, _)| end).take_while(|&end| end < at);
    let start = ends().last().map_or_else(|| first_byte(text), |end| end + 1);
    let column = text[start..].char_indices().take_while(|&(offset, _)| start + offset < at);
    (ends().count() + 1, column.count() + 1)
}

/// The reason why a file cannot be opened as a case.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The file does not exist.
    #[error("{0}: {why}", why = not_found(.0))]
    NotFound(String),
    /// The path is a folder.
    #[error("{0}: this is a folder: name a case in it, such as {0}/case.toml")]
    IsAFolder(String),
    /// The path is a pipe or a device.
    #[error("{0}: this is not a regular file: copy the content to a file")]
    NotAFile(String),
    /// The file is longer than the limit in KiB.
    #[error("{0}: the file is longer than {1} KiB, the limit for a case")]
    TooLarge(String, usize),
    /// The system refuses to read the file.
    #[error("{0}: {why}", why = unread(.1))]
    Unreadable(String, io::Error),
    /// The text is not a valid case.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))]
    Bad(Vec<Fault>),
    /// A model of another program cannot be converted to a case.
    #[error("{0}")]
    Model(String),
    /// The file has a newer format.
    #[error("{0}")]
    NewerFormat(Box<Fault>),
}

/// The reason why a document was not saved. The file on disk is unchanged.
#[derive(Debug, Error)]
pub enum SaveError {
    /// Another program changed the file after it was read.
    #[error("{0}: the file has changed on disk since it was read")]
    ChangedOnDisk(String),
    /// The system refuses to read the file, so that a change by another program cannot be excluded.
    #[error(
        "{0}: cannot be read to check for changes by others: {1}: try again, or save under another \
            name"
    )]
    Unreadable(String, io::Error),
    /// Another file exists with this name.
    #[error("{0}: the file exists already")]
    AlreadyThere(String),
    /// The file has a newer format, which this version reads only in part.
    #[error(
        "{0}: the case has a newer format; saving it would lose fields that this version does not \
            know"
    )]
    NewerFormat(String),
    /// The new text does not give the edited case.
    #[error(
        "{0}: the layout of the file does not accept the edits: write them with an editor, then \
            reload the file"
    )]
    OtherCase(String),
    /// The path is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// The path is a folder. The second text is an example of a file in the folder.
    #[error("{0}: this is a folder: add the name of a file to it, such as {1}")]
    IsAFolder(String, String),
    /// The folder of the file is missing.
    #[error(
        "{0}: the folder {1} does not exist: create the folder (mkdir -p '{quoted}'), or choose \
            another name", quoted = .1.replace('\'', r"'\''")
    )]
    NoFolder(String, String),
    /// A part of the path is a file instead of a folder.
    #[error("{0}: {1} is not a folder: choose another name")]
    NotAFolder(String, String),
    /// The file is read-only.
    #[error("{0}: the file is read-only: save under another name, or make it writable (chmod u+w)")]
    ReadOnly(String),
    /// The file has other hard links, which a save would separate from it.
    #[error(
        "{0}: the file has {1} names (hard links), which a save would separate: save under another \
            name"
    )]
    HardLinked(String, u64),
    /// The system refuses to write the file.
    #[error("{0}: cannot be written: {1}: {fix}", fix = fix(.1))]
    Unwritable(String, io::Error),
    /// A result cannot replace its target, for the first reason. The second text is the file that has
    /// the complete result.
    #[error("{0}; the complete result is in {1}")]
    Kept(Box<SaveError>, String),
}

/// A path as messages show it.
fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

/// The fix for a file that does not exist, which `tipstrike new` writes if it is a case.
fn not_found(name: &str) -> String {
    let is_case = Path::new(name).extension().is_some_and(|ending| ending == "toml");
    let new = if is_case { ", or `tipstrike new` writes a case" } else { "" };
    format!("file not found: check the path{new}")
}

/// Why the system refuses to read a file, and the fix.
pub(crate) fn unread(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => not_found(""),
        ErrorKind::NotADirectory => {
            "cannot be read: a part of the path is a file: check the path".to_owned()
        }
        ErrorKind::PermissionDenied => {
            "cannot be read: permission denied: make the file readable (chmod u+r)".to_owned()
        }
        _ => format!("cannot be read: {}: copy the file to another folder", brief(error)),
    }
}

/// The error text of the system without the error number.
pub(crate) fn brief(error: &io::Error) -> String {
    let words = error.to_string();
    let end = words.find(" (os error").unwrap_or(words.len());
    words[..end].to_owned()
}

/// The fix for a file that the system refuses to write.
fn fix(error: &io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "make room on the disk, or save elsewhere"
        }
        ErrorKind::FileTooLarge => "raise the limit on the size of files (ulimit -f)",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "save into a folder that may be written"
        }
        ErrorKind::InvalidFilename => "choose a shorter name",
        ErrorKind::Unsupported => "save under another name",
        _ => "save elsewhere",
    }
}

/// A value as a case reads it.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Value {
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
    fn is_empty(&self) -> bool {
        matches!(self, Value::String(text) if text.is_empty())
    }

    /// The kind of the value with its article.
    fn kind(&self) -> &'static str {
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
enum Place {
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
struct Entry {
    /// The keys from the top level.
    path: Vec<String>,
    /// The place where each key begins, of a shared key the first one.
    keys: Vec<usize>,
    /// Number of keys that the header above or the inline table around gives.
    given: usize,
    /// The first byte of its keys, or of the header.
    start: usize,
    /// The last key.
    name: Range<usize>,
    /// The value, or the header from bracket to bracket.
    span: Range<usize>,
    value: Value,
    place: Place,
}

impl Entry {
    /// The keys joined by points, however the text quotes or nests them.
    fn key(&self) -> String {
        self.path.join(".")
    }

    /// The keys of its table.
    fn table(&self) -> &[String] {
        &self.path[..self.path.len() - 1]
    }

    /// The place of the key at a depth from 1.
    fn key_at(&self, depth: usize) -> usize {
        self.keys[depth - 1]
    }
}

/// Headers and keys in the order of the text. An inline table is before its members.
#[derive(Debug, Clone, Default)]
struct Layout {
    entries: Vec<Entry>,
    end: usize,
}

impl Layout {
    /// # Errors
    /// The first syntax error.
    fn of(text: &str) -> Result<Layout, TomlError> {
        let document = toml_edit::Document::parse(text)?;
        let mut reader = Reader { text, entries: Vec::new() };
        reader.table(document.as_table(), &[]);
        let mut entries = reader.entries;
        entries.sort_by_key(|entry| entry.start);
        Ok(Layout { entries, end: text.len() })
    }

    /// The value of a key.
    fn value(&self, key: &str) -> Option<&Entry> {
        self.values().find(|entry| entry.key() == key)
    }

    fn values(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| entry.place != Place::Header)
    }

    fn headers(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| entry.place == Place::Header)
    }

    /// The place to report for a key: its value, its table, or the end.
    fn place(&self, key: &str) -> usize {
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
        let line = line_start(self.text, name.start);
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

/// The file without comments, empty lines, and headers of empty tables. Keeps all lines of a
/// multi-line string.
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
            let values = layout.values().map(|entry| entry.span.end);
            let end = values.filter(|end| (start..start + line.len()).contains(end)).max();
            let comment =
                end.map(|end| end - start).filter(|&end| line[end..].trim_start().starts_with('#'));
            let line = &line[..comment.unwrap_or(line.len())];
            kept.push((sanitize(line.trim_end_matches(['\n', '\r'])), is_header));
        }
        start += line.len();
    }
    let has_lines = |at: usize| kept.get(at + 1).is_some_and(|(_, is_header)| !is_header);
    let said = (0..kept.len()).filter(|&at| !kept[at].1 || has_lines(at));
    let lines: Vec<&str> = said.map(|at| kept[at].0.as_str()).collect();
    lines.join("\n")
}

/// Length and hash of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    /// Length in bytes.
    pub length: u64,
    /// SipHash-2-4 of the bytes.
    pub hash: u64,
}

impl Stamp {
    /// The stamp of a text.
    pub fn of(bytes: &[u8]) -> Stamp {
        Stamp { length: bytes.len() as u64, hash: hash(bytes) }
    }
}

/// SipHash-2-4 with a key of zeros: the same on every machine and in every version.
pub fn hash(bytes: &[u8]) -> u64 {
    let mut hasher = SipHasher24::new();
    hasher.write(bytes);
    hasher.finish()
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
            "format = 1\nnotes = \"\"\"one\n# two\n\n[three]\n\"\"\"\n[driver]\nteeth = 20"
        );
    }

    #[test]
    fn the_hash_never_changes() {
        // SipHash-2-4 (Aumasson & Bernstein 2012) of an empty text with a key of zeros.
        assert_eq!(hash(b""), 0x1e92_4b9d_7377_00d7);
    }
}
