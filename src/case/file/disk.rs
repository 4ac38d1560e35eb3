//! Files on disk: what is no case is refused without waiting, and a save leaves the old file or the
//! new one.

use std::borrow::Cow;
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};
use std::time::Duration;

use thiserror::Error;

use super::{Document, Fault, FaultKind, MOST_BYTES, about};
use crate::case::Case;
use crate::case::journal::Stamp;
use crate::case::sanitize::sanitize;

/// Symbolic links that are followed, one after the other.
const MOST_LINKS: usize = 40;
/// How the name of a file begins that is not yet in its place; the number of the process follows.
const TEMPORARY: &str = ".tipstrike-";
/// No save takes so long.
const STALE: Duration = Duration::from_secs(60);

/// Why a file cannot be opened as a case.
#[derive(Debug, Error)]
pub enum ReadError {
    /// There is no such file.
    #[error("{0}: there is no such file")]
    NotFound(String),
    /// It is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// It is longer than [`MOST_BYTES`].
    #[error("{0}: the file is longer than 1024 KiB, so it is no case")]
    TooLarge(String),
    /// The system refuses to read it.
    #[error("{0}: cannot be read: {1}")]
    Unreadable(String, io::Error),
    /// Its text is no valid case.
    #[error("{}", one_a_line(.0))]
    Bad(Vec<Fault>),
    /// It is of a newer format.
    #[error("{0}")]
    NewerFormat(Fault),
}

/// Why a document was not saved. The file on disk is then as it was.
#[derive(Debug, Error)]
pub enum SaveError {
    /// Someone else changed the file after it was read.
    #[error("{0}: the file was changed by someone else since it was read")]
    ChangedOnDisk(String),
    /// Another file is there already.
    #[error("{0}: there is a file of that name already")]
    AlreadyThere(String),
    /// It is of a newer format, of which not everything is understood.
    #[error(
        "{0}: this case is of a newer format, and saving it here would lose what this version does not know"
    )]
    NewerFormat(String),
    /// It is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// It is a folder.
    #[error("{0}: this is a folder: add the name of a file to it, such as {0}/case.toml")]
    IsAFolder(String),
    /// The folder of the file is not there.
    #[error("{0}: there is no folder {1}: make it first (mkdir -p {1}), or take another name")]
    NoFolder(String, String),
    /// The file may not be written.
    #[error("{0}: the file is read-only: save under another name, or make it writable (chmod u+w)")]
    ReadOnly(String),
    /// The file has other names, which a save would part from it.
    #[error(
        "{0}: the file has {1} names (hard links), which saving would part: save under another name"
    )]
    HardLinked(String, u64),
    /// The system refuses to write it.
    #[error("{0}: cannot be written: {1}: {mend}", mend = mend(.1))]
    Unwritable(String, io::Error),
}

/// Write a file that is no case, such as a report or a template, by the way of a save: whatever
/// happens, the old file stays or the new one is whole. `over` says whether a file of that name may
/// be replaced.
///
/// # Errors
/// Where nothing was written.
pub fn write(path: &Path, bytes: &[u8], over: bool) -> Result<(), SaveError> {
    let target = target_of(path)?;
    if target.old.is_some() && !over {
        return Err(SaveError::AlreadyThere(shown(path)));
    }
    target.replace(bytes, path)
}

impl Document {
    /// Read a complete case from a file, or from standard input where the path is `-`.
    ///
    /// # Errors
    /// Where the file cannot be read, or is no valid case.
    pub fn read(path: &Path) -> Result<Document, ReadError> {
        Document::read_draft(path)?.complete().map_err(refused)
    }

    /// Read a case in which required values may be missing from a file, or from standard input
    /// where the path is `-`.
    ///
    /// # Errors
    /// Where the file cannot be read, or has other faults.
    pub fn read_draft(path: &Path) -> Result<Document, ReadError> {
        let name = shown(path);
        let (bytes, origin) = if path == Path::new("-") {
            (capped(io::stdin().lock(), &name)?, None)
        } else {
            let file = open(path, &name)?;
            (capped(file, &name)?, followed(path).ok())
        };
        let mut document = Document::parse_draft_bytes(&name, &bytes).map_err(refused)?;
        document.origin = origin;
        Ok(document)
    }

    /// Read what this version understands of a file of a newer format, to be looked at and not to
    /// be saved.
    ///
    /// # Errors
    /// Where the file cannot be read, or is no text.
    pub fn read_newer(path: &Path) -> Result<Document, ReadError> {
        let name = shown(path);
        let bytes = capped(open(path, &name)?, &name)?;
        let text = std::str::from_utf8(&bytes);
        let text = text.map_err(|error| {
            ReadError::Bad(vec![super::fault::not_text(
                &name,
                &bytes,
                error.valid_up_to(),
            )])
        })?;
        let mut document = Document::parse_newer(&name, text);
        document.origin = followed(path).ok();
        Ok(document)
    }

    /// The file that the document was read from or saved to, links followed.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.origin.as_deref()
    }

    /// What tells the text that was read or saved last from another one.
    #[must_use]
    pub fn stamp(&self) -> Stamp {
        Stamp::of(self.as_read().as_bytes())
    }

    /// The case as the text that was read or saved last has it.
    #[must_use]
    pub fn loaded(&self) -> &Case {
        &self.loaded
    }

    fn as_read(&self) -> Cow<'_, str> {
        if self.marked {
            Cow::Owned(format!("{}{}", super::BYTE_ORDER_MARK, self.text))
        } else {
            Cow::Borrowed(&self.text)
        }
    }

    /// Save to a file, unless it is not the one that was read or has been changed since.
    ///
    /// # Errors
    /// Where nothing was saved; the file is then as it was.
    pub fn save(&mut self, path: &Path) -> Result<(), SaveError> {
        self.write(path, false)
    }

    /// Save to a file, whatever its content.
    ///
    /// # Errors
    /// Where nothing was saved; the file is then as it was.
    pub fn save_over(&mut self, path: &Path) -> Result<(), SaveError> {
        self.write(path, true)
    }

    fn write(&mut self, path: &Path, over: bool) -> Result<(), SaveError> {
        if self.is_newer {
            return Err(SaveError::NewerFormat(shown(path)));
        }
        let target = target_of(path)?;
        if target.old.is_some() && !over {
            self.same_as_read(&target.path, &shown(path))?;
        }
        let text = self.render();
        target.replace(text.as_bytes(), path)?;
        self.settle(&text, shown(path), target.path);
        Ok(())
    }

    /// The content decides, not the time stamp: a mere touch is no change.
    fn same_as_read(&self, target: &Path, name: &str) -> Result<(), SaveError> {
        if self.origin.as_deref() != Some(target) {
            return Err(SaveError::AlreadyThere(name.to_owned()));
        }
        let now = open(target, name).and_then(|file| capped(file, name));
        match now {
            Ok(bytes) if bytes == self.as_read().as_bytes() => Ok(()),
            _ => Err(SaveError::ChangedOnDisk(name.to_owned())),
        }
    }
}

fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

fn one_a_line(faults: &[Fault]) -> String {
    faults
        .iter()
        .map(ToString::to_string)
        .collect::<Vec<_>>()
        .join("\n")
}

fn refused(mut faults: Vec<Fault>) -> ReadError {
    match faults
        .iter()
        .position(|fault| fault.kind == FaultKind::NewerFormat)
    {
        Some(newer) => ReadError::NewerFormat(faults.swap_remove(newer)),
        None => ReadError::Bad(faults),
    }
}

/// Open a regular file. Anything else is refused before it is opened, since opening a pipe waits
/// for a writer.
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

fn capped(source: impl Read, name: &str) -> Result<Vec<u8>, ReadError> {
    let mut bytes = Vec::new();
    let most = MOST_BYTES as u64 + 1;
    source
        .take(most)
        .read_to_end(&mut bytes)
        .map_err(|error| ReadError::Unreadable(name.to_owned(), error))?;
    if bytes.len() > MOST_BYTES {
        Err(ReadError::TooLarge(name.to_owned()))
    } else {
        Ok(bytes)
    }
}

/// The path behind every symbolic link, whether or not a file is there.
///
/// # Errors
/// When the folder is not there, or the links lead round and round.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else {
            let folder = fs::canonicalize(folder_of(&path))?;
            return Ok(path
                .file_name()
                .map_or(folder.clone(), |name| folder.join(name)));
        };
        path = folder_of(&path).join(next);
    }
    Err(io::Error::other("too many symbolic links"))
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// A file to be written, links followed, and what is there now.
struct Target {
    path: PathBuf,
    old: Option<fs::Metadata>,
}

fn target_of(path: &Path) -> Result<Target, SaveError> {
    let name = shown(path);
    let target = followed(path).map_err(|error| no_folder(path, error))?;
    match fs::metadata(&target) {
        Ok(old) => {
            replaceable(&target, &old, &name)?;
            Ok(Target {
                path: target,
                old: Some(old),
            })
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Target {
            path: target,
            old: None,
        }),
        Err(error) => Err(SaveError::Unwritable(name, error)),
    }
}

fn no_folder(path: &Path, error: io::Error) -> SaveError {
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => {
            SaveError::NoFolder(shown(path), shown(folder_of(path)))
        }
        _ => SaveError::Unwritable(shown(path), error),
    }
}

fn replaceable(target: &Path, old: &fs::Metadata, name: &str) -> Result<(), SaveError> {
    if old.is_dir() {
        return Err(SaveError::IsAFolder(name.trim_end_matches('/').to_owned()));
    }
    if !old.is_file() {
        return Err(SaveError::NotAFile(name.to_owned()));
    }
    if old.nlink() > 1 {
        return Err(SaveError::HardLinked(name.to_owned(), old.nlink()));
    }
    let closed = OpenOptions::new().write(true).open(target).err();
    match closed {
        None if !old.permissions().readonly() => Ok(()),
        Some(error) if error.kind() != ErrorKind::PermissionDenied => {
            Err(SaveError::Unwritable(name.to_owned(), error))
        }
        _ => Err(SaveError::ReadOnly(name.to_owned())),
    }
}

impl Target {
    fn replace(&self, bytes: &[u8], path: &Path) -> Result<(), SaveError> {
        self.write(bytes).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists if self.old.is_none() => SaveError::AlreadyThere(shown(path)),
            _ => SaveError::Unwritable(shown(path), error),
        })
    }

    /// Write beside the target, then rename over it; each step is on disk before the next one.
    fn write(&self, bytes: &[u8]) -> io::Result<()> {
        let folder = folder_of(&self.path);
        // A new file's mode is cut by the umask on creation.
        let mode = Permissions::from_mode(0o666);
        let prefix = format!("{TEMPORARY}{}-", std::process::id());
        let mut file = tempfile::Builder::new()
            .prefix(&prefix)
            .permissions(mode)
            .tempfile_in(folder)?;
        file.write_all(bytes)?;
        if let Some(old) = &self.old {
            about::keep(old, &self.path, file.as_file())?;
        }
        file.as_file().sync_all()?;
        match self.old {
            Some(_) => file.persist(&self.path).map_err(|error| error.error)?,
            // A file that someone else made meanwhile is not ours to replace.
            None => file
                .persist_noclobber(&self.path)
                .map_err(|error| error.error)?,
        };
        // The new file is in place, whether or not the folder can be flushed.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        clear(folder);
        Ok(())
    }
}

/// Take away what saves that were killed have left in a folder. That one cannot be taken away is no
/// reason to fail.
fn clear(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_str().is_some_and(is_left_over)) {
        let about = entry.metadata();
        let is_old = |about: &fs::Metadata| {
            about
                .modified()
                .is_ok_and(|time| time.elapsed().is_ok_and(|age| age > STALE))
        };
        if about.is_ok_and(|about| about.is_file() && is_old(&about)) {
            drop(fs::remove_file(entry.path()));
        }
    }
}

// Of a process that is gone. On a shared disk it may live on another machine: hence the age.
fn is_left_over(name: &str) -> bool {
    let process = name
        .strip_prefix(TEMPORARY)
        .and_then(|rest| rest.split_once('-'))
        .and_then(|(process, _)| process.parse().ok());
    process.is_some_and(|process: u32| !Path::new("/proc").join(process.to_string()).exists())
}

/// What to do about a file that the system does not let us write.
fn mend(error: &io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
            "make room on the disk, or save elsewhere"
        }
        ErrorKind::FileTooLarge => "raise the limit on the size of files (ulimit -f)",
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            "save into a folder that may be written"
        }
        ErrorKind::InvalidFilename => "take a shorter name",
        ErrorKind::Unsupported => "save under another name",
        _ => "save elsewhere",
    }
}
