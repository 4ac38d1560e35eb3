//! Case files on disk. Reading accepts only a regular file, and a save leaves the old or the new
//! file complete.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::Path;

use super::error::{ReadError, SaveError, shown};
use super::target::{followed, target_of};
use super::{Document, Fault, FaultKind, MOST_BYTES};
use crate::case::Case;
use crate::case::stamp::Stamp;
use crate::system::files;

/// The effect of a save on the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Saved {
    /// The file has the new text.
    Written,
    /// The file had been deleted, and the save created it again.
    Recreated,
}

impl Document {
    /// Reads a complete case from a file, or from standard input if the path is `-`.
    ///
    /// # Errors
    /// If the file cannot be read, or is not a valid case.
    pub fn read(path: &Path) -> Result<Document, ReadError> {
        Document::read_draft(path)?.complete().map_err(refused)
    }

    /// Reads a case that can lack required values from a file, or from standard input if the path
    /// is `-`.
    ///
    /// # Errors
    /// If the file cannot be read, or has other faults.
    pub fn read_draft(path: &Path) -> Result<Document, ReadError> {
        let name = shown(path);
        if path == Path::new("-") {
            let bytes = capped(io::stdin().lock(), &name)?;
            return Document::parse_draft_bytes(&name, &bytes).map_err(refused);
        }
        let file = open(path, &name)?;
        let mode = file.metadata().ok().and_then(|about| files::mode(&about));
        let bytes = capped(file, &name)?;
        let mut document = Document::parse_draft_bytes(&name, &bytes).map_err(refused)?;
        document.origin = followed(path).ok();
        document.mode = mode;
        Ok(document)
    }

    /// Reads the known part of a file of a newer format, for viewing only.
    ///
    /// # Errors
    /// If the file cannot be read, or is not text.
    pub fn read_newer(path: &Path) -> Result<Document, ReadError> {
        let name = shown(path);
        let bytes = capped(open(path, &name)?, &name)?;
        let text = std::str::from_utf8(&bytes);
        let text = text.map_err(|error| {
            ReadError::Bad(vec![super::fault::not_text(&name, &bytes, error.valid_up_to())])
        })?;
        let mut document = Document::parse_newer(&name, text);
        document.origin = followed(path).ok();
        Ok(document)
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

    fn as_read(&self) -> Cow<'_, str> {
        if self.marked {
            Cow::Owned(format!("{}{}", super::BYTE_ORDER_MARK, self.text))
        } else {
            Cow::Borrowed(&self.text)
        }
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
        if !super::edit::gives(text.trim_start_matches(super::BYTE_ORDER_MARK), &self.case) {
            return Err(SaveError::OtherCase(name));
        }
        let mode = self.mode.filter(|_| is_own);
        target.replace(text.as_bytes(), mode, path, false)?;
        let is_recreated = is_own && target.old.is_none();
        self.mode = fs::metadata(&target.path).ok().and_then(|about| files::mode(&about)).or(mode);
        self.settle(&text, name, target.path);
        Ok(if is_recreated { Saved::Recreated } else { Saved::Written })
    }

    /// Compares the content, not the time stamp, because a touched file is unchanged.
    fn same_as_read(&self, target: &Path, name: &str) -> Result<(), SaveError> {
        if self.origin.as_deref() != Some(target) {
            return Err(SaveError::AlreadyThere(name.to_owned()));
        }
        match open(target, name).and_then(|file| capped(file, name)) {
            Ok(bytes) if bytes == self.as_read().as_bytes() => Ok(()),
            Err(ReadError::Unreadable(name, error)) => Err(SaveError::Unreadable(name, error)),
            _ => Err(SaveError::ChangedOnDisk(name.to_owned())),
        }
    }
}

fn refused(mut faults: Vec<Fault>) -> ReadError {
    match faults.iter().position(|fault| fault.kind == FaultKind::NewerFormat) {
        Some(newer) => ReadError::NewerFormat(faults.swap_remove(newer)),
        None => ReadError::Bad(faults),
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

fn capped(source: impl Read, name: &str) -> Result<Vec<u8>, ReadError> {
    limited(source, name, MOST_BYTES)
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
