//! Files on disk: what is no case is refused without waiting, and a save leaves the old file or the new one.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, Read, Write};
use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
use std::path::{Path, PathBuf};

use thiserror::Error;

use super::{Document, Fault, FaultKind, MOST_BYTES};
use crate::case::visible::visible;

/// Symbolic links that are followed, one after the other.
const MOST_LINKS: usize = 40;

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
    /// It is a folder, a pipe or a device.
    #[error("{0}: this is not a regular file")]
    NotAFile(String),
    /// The file may not be written.
    #[error("{0}: the file is read-only")]
    ReadOnly(String),
    /// The file has other names, which a save would part from it.
    #[error("{0}: the file has {1} names (hard links), which saving would part: save under another name")]
    HardLinked(String, u64),
    /// The system refuses to write it.
    #[error("{0}: cannot be written: {1}")]
    Unwritable(String, io::Error),
}

impl Document {
    /// Read a document from a file, or from standard input where the path is `-`.
    ///
    /// # Errors
    /// Where the file cannot be read, or is no valid case.
    pub fn read(path: &Path) -> Result<Document, ReadError> {
        let name = shown(path);
        let (bytes, origin) = if path == Path::new("-") {
            (capped(io::stdin().lock(), &name)?, None)
        } else {
            let file = open(path, &name)?;
            (capped(file, &name)?, followed(path).ok())
        };
        let mut document = Document::parse_bytes(&name, &bytes).map_err(refused)?;
        document.origin = origin;
        Ok(document)
    }

    /// The file that the document was read from or saved to, links followed.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.origin.as_deref()
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
        let name = shown(path);
        let unwritable = |error| SaveError::Unwritable(shown(path), error);
        let target = followed(path).map_err(unwritable)?;
        let old = match fs::metadata(&target) {
            Ok(old) => Some(old),
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            Err(error) => return Err(unwritable(error)),
        };
        if let Some(old) = &old {
            replaceable(&target, old, &name)?;
            if !over {
                self.same_as_read(&target, &name)?;
            }
        }
        let text = self.render();
        replace(&target, old.as_ref(), text.as_bytes()).map_err(unwritable)?;
        self.settle(&text, name, target);
        Ok(())
    }

    /// The content decides, not the time stamp: a mere touch is no change.
    fn same_as_read(&self, target: &Path, name: &str) -> Result<(), SaveError> {
        if self.origin.as_deref() != Some(target) {
            return Err(SaveError::AlreadyThere(name.to_owned()));
        }
        let read = if self.marked { format!("{}{}", super::BYTE_ORDER_MARK, self.text) } else { self.text.clone() };
        let now = open(target, name).and_then(|file| capped(file, name));
        match now {
            Ok(bytes) if bytes == read.as_bytes() => Ok(()),
            _ => Err(SaveError::ChangedOnDisk(name.to_owned())),
        }
    }
}

fn shown(path: &Path) -> String {
    visible(&path.display().to_string())
}

fn one_a_line(faults: &[Fault]) -> String {
    faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

fn refused(mut faults: Vec<Fault>) -> ReadError {
    match faults.iter().position(|fault| fault.kind == FaultKind::NewerFormat) {
        Some(newer) => ReadError::NewerFormat(faults.swap_remove(newer)),
        None => ReadError::Bad(faults),
    }
}

/// Open a regular file. Anything else is refused before it is opened, since opening a pipe waits for a writer.
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
    source.take(most).read_to_end(&mut bytes).map_err(|error| ReadError::Unreadable(name.to_owned(), error))?;
    if bytes.len() > MOST_BYTES { Err(ReadError::TooLarge(name.to_owned())) } else { Ok(bytes) }
}

/// The path behind every symbolic link, whether or not a file is there.
fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = fs::read_link(&path) else {
            let folder = fs::canonicalize(folder_of(&path))?;
            return Ok(path.file_name().map_or(folder.clone(), |name| folder.join(name)));
        };
        path = folder_of(&path).join(next);
    }
    Err(io::Error::other("too many symbolic links"))
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn replaceable(target: &Path, old: &fs::Metadata, name: &str) -> Result<(), SaveError> {
    if !old.is_file() {
        return Err(SaveError::NotAFile(name.to_owned()));
    }
    if old.nlink() > 1 {
        return Err(SaveError::HardLinked(name.to_owned(), old.nlink()));
    }
    let closed = OpenOptions::new().write(true).open(target).err();
    match closed {
        None if !old.permissions().readonly() => Ok(()),
        Some(error) if error.kind() != ErrorKind::PermissionDenied => Err(SaveError::Unwritable(name.to_owned(), error)),
        _ => Err(SaveError::ReadOnly(name.to_owned())),
    }
}

/// Write beside the target, then rename over it; each step is on disk before the next one.
fn replace(target: &Path, old: Option<&fs::Metadata>, bytes: &[u8]) -> io::Result<()> {
    let folder = folder_of(target);
    // A new file's mode is cut by the umask on creation.
    let mode = Permissions::from_mode(0o666);
    let mut file = tempfile::Builder::new().prefix(".tipstrike-").permissions(mode).tempfile_in(folder)?;
    file.write_all(bytes)?;
    if let Some(old) = old {
        keep_owner_and_mode(file.as_file(), old)?;
    }
    file.as_file().sync_all()?;
    file.persist(target).map_err(|error| error.error)?;
    // The new file is in place, whether or not the folder can be flushed.
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
    Ok(())
}

fn keep_owner_and_mode(file: &File, old: &fs::Metadata) -> io::Result<()> {
    let new = file.metadata()?;
    if (new.uid(), new.gid()) != (old.uid(), old.gid()) {
        // Only the owner may be unable to give a file away; the content matters more.
        let _ = fchown(file, Some(old.uid()), Some(old.gid()));
    }
    file.set_permissions(Permissions::from_mode(old.mode() & 0o7777))
}
