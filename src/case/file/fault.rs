//! Faults of a file, each with its place and on one line, and errors of reading and saving.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::Path;

use thiserror::Error;

use crate::case::Problem;
use crate::case::sanitize::{cut, sanitize};

/// Greatest number of faults shown for one file.
pub(super) const MOST: usize = 100;

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
    pub(super) fn new(file: &str, (line, column): (usize, usize), problem: Problem) -> Fault {
        Fault { file: file.to_owned(), line, column, problem }
    }

    /// The first problems at bytes of a text, in the order of their places.
    pub(super) fn placed(
        file: &str,
        text: &str,
        mut problems: Vec<(usize, Problem)>,
    ) -> Vec<Fault> {
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
        write!(f, "{file}:{line}:{column}: {field}: {cause}: {}", sanitize(&fix.to_string()))
    }
}

impl std::error::Error for Fault {}

/// Line and column of a byte, both from 1, the column in characters.
pub(super) fn place(text: &str, at: usize) -> (usize, usize) {
    let ends = || text.match_indices('\n').map(|(end, _)| end).take_while(|&end| end < at);
    let start = ends().last().map_or(0, |end| end + 1);
    let column = text[start..].char_indices().take_while(|&(offset, _)| start + offset < at);
    (ends().count() + 1, column.count() + 1)
}

/// The reason why a file cannot be opened as a case.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The file does not exist.
    #[error("{0}: file not found: check the path, or `tipstrike new` writes a case")]
    NotFound(String),
    /// The path is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// The file is longer than the limit in KiB.
    #[error("{0}: the file is longer than {1} KiB, the limit for a case")]
    TooLarge(String, usize),
    /// The system refuses to read the file.
    #[error("{0}: cannot be read: {1}")]
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
    /// The folder of the file is missing. The third text is its name quoted for a shell.
    #[error(
        "{0}: the folder {1} does not exist: create the folder (mkdir -p {2}), or choose \
        another name"
    )]
    NoFolder(String, String, String),
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
pub(super) fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
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
