//! Errors of reading and of saving a case file.

use std::io::{self, ErrorKind};
use std::path::Path;

use thiserror::Error;

use super::Fault;
use crate::case::sanitize::sanitize;

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
    #[error("{}", one_a_line(.0))]
    Bad(Vec<Fault>),
    /// A model of another program cannot be converted to a case.
    #[error("{0}")]
    Model(String),
    /// The file has a newer format.
    #[error("{0}")]
    NewerFormat(Fault),
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

fn one_a_line(faults: &[Fault]) -> String {
    faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
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
