//! Why a file cannot be read as a case, and why a save fails.

use std::io::{self, ErrorKind};
use std::path::Path;

use thiserror::Error;

use super::Fault;
use crate::case::sanitize::sanitize;

/// Why a file cannot be opened as a case.
#[derive(Debug, Error)]
pub enum ReadError {
    /// There is no such file.
    #[error("{0}: file not found: check the path, or `tipstrike new` writes a case")]
    NotFound(String),
    /// It is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// It is longer than so many KiB.
    #[error("{0}: the file is longer than {1} KiB, the limit for a case")]
    TooLarge(String, usize),
    /// The system refuses to read it.
    #[error("{0}: cannot be read: {1}")]
    Unreadable(String, io::Error),
    /// Its text is no valid case.
    #[error("{}", one_a_line(.0))]
    Bad(Vec<Fault>),
    /// It is a model of another program that cannot become a case.
    #[error("{0}")]
    Model(String),
    /// It is of a newer format.
    #[error("{0}")]
    NewerFormat(Fault),
}

/// Why a document was not saved. The file on disk is then as it was.
#[derive(Debug, Error)]
pub enum SaveError {
    /// Someone else changed the file after it was read.
    #[error("{0}: the file has changed on disk since it was read")]
    ChangedOnDisk(String),
    /// The system refuses to read the file, so that a change by someone else would go unseen.
    #[error(
        "{0}: cannot be read to check for changes by others: {1}: try again, or save under another \
            name"
    )]
    Unreadable(String, io::Error),
    /// Another file is there already.
    #[error("{0}: the file exists already")]
    AlreadyThere(String),
    /// It is of a newer format, of which not everything is understood.
    #[error(
        "{0}: the case has a newer format; saving it would lose fields that this version does not \
            know"
    )]
    NewerFormat(String),
    /// It is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// It is a folder; the second text is a file in it, by example.
    #[error("{0}: this is a folder: add the name of a file to it, such as {1}")]
    IsAFolder(String, String),
    /// The folder of the file is missing; the third text is its name as a shell reads it.
    #[error(
        "{0}: the folder {1} does not exist: create the folder (mkdir -p {2}), or choose \
        another name"
    )]
    NoFolder(String, String, String),
    /// The path leads through a file as if it were a folder.
    #[error("{0}: {1} is not a folder: choose another name")]
    NotAFolder(String, String),
    /// The file may not be written.
    #[error("{0}: the file is read-only: save under another name, or make it writable (chmod u+w)")]
    ReadOnly(String),
    /// The file has other names, which a save would separate from it.
    #[error(
        "{0}: the file has {1} names (hard links), which a save would separate: save under another \
            name"
    )]
    HardLinked(String, u64),
    /// The system refuses to write it.
    #[error("{0}: cannot be written: {1}: {fix}", fix = fix(.1))]
    Unwritable(String, io::Error),
}

/// A path as messages show it.
pub(super) fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

fn one_a_line(faults: &[Fault]) -> String {
    faults
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n")
}

/// What to do about a file that the system does not let us write.
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
