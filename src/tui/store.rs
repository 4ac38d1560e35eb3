//! Files that the workbench reads: cases, folders, and the list of recent cases.

pub(crate) mod folder;
pub(crate) mod recents;
pub(crate) mod state;

use std::env;
use std::path::{Path, PathBuf};

use crate::case::file::ReadError;
use crate::case::sanitize::sanitize;
use crate::case::stamp::Stamp;
use crate::case::{Document, rexs};

/// The case that the workbench opens at the start.
#[derive(Debug)]
pub(crate) struct Opening {
    pub(crate) document: Document,
    /// The file of the case.
    pub(crate) path: Option<PathBuf>,
    /// Why the requested file was not opened.
    pub(crate) trouble: Option<Trouble>,
}

/// A file that could not be opened, and its faults.
#[derive(Debug)]
pub(crate) struct Trouble {
    pub(crate) path: PathBuf,
    /// The faults, one per line.
    pub(crate) faults: Vec<String>,
    /// Whether the user named the file; otherwise it is the last case.
    pub(crate) was_asked: bool,
}

/// The file of an open case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct WatchedFile {
    /// The path of the case.
    pub(crate) path: PathBuf,
    /// The file that was read, after resolution of links.
    pub(crate) target: PathBuf,
    /// The stamp of the text that was read.
    pub(crate) stamp: Stamp,
}

impl WatchedFile {
    /// Whether the document is the content that was read.
    pub(crate) fn is_of(&self, document: &Document) -> bool {
        document.stamp() == self.stamp && document.path() == Some(&self.target)
    }
}

/// The document of the built-in case.
#[must_use]
pub fn built_in() -> Document {
    Document::table_1()
}

/// The case that the user named, otherwise the last case, otherwise the built-in case.
#[must_use]
pub(crate) fn opening(asked: Option<PathBuf>) -> Opening {
    let was_asked = asked.is_some();
    let Some(path) = asked.or_else(recents::last) else {
        return Opening { document: built_in(), path: None, trouble: None };
    };
    match load(&path) {
        Ok(document) => {
            recents::add(&path);
            Opening { document: *document, path: Some(rexs::case_path(&path)), trouble: None }
        }
        Err(faults) => {
            let trouble = Trouble { path, faults, was_asked };
            Opening { document: built_in(), path: None, trouble: Some(trouble) }
        }
    }
}

pub(super) fn load(path: &Path) -> Result<Box<Document>, Vec<String>> {
    // The keyboard is the standard input: reading a case from it would block.
    if path == Path::new("-") {
        return Err(vec![
            "the workbench does not read standard input: name a file, or use tipstrike solve -"
                .to_owned(),
        ]);
    }
    let document =
        if rexs::is_model(path) { rexs::read_document(path) } else { Document::read_draft(path) };
    let document = match document {
        Err(ReadError::NewerFormat(_)) => Document::read_newer(path),
        document => document,
    };
    let document = document.map_err(|error| error.to_string());
    document
        .map(Box::new)
        .map_err(|faults| faults.lines().map(|fault| without_name(path, fault)).collect())
}

// The title above the faults already has the name.
fn without_name(path: &Path, fault: &str) -> String {
    let name = format!("{}:", sanitize(&path.display().to_string()));
    fault.strip_prefix(&name).unwrap_or(fault).trim_start().to_owned()
}

pub(super) fn at_home(path: &Path) -> PathBuf {
    let home = env::var_os("HOME").map(PathBuf::from).filter(|home| home.is_absolute());
    match (path.strip_prefix("~"), home) {
        (Ok(rest), Some(home)) => home.join(rest),
        _ => path.to_owned(),
    }
}
