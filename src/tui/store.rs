//! Files that the workbench reads: cases, folders, and the list of recent cases in the state
//! folder, the latest first.

pub(crate) mod folder;
pub(crate) mod state;

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::case::file::ReadError;
use crate::case::sanitize::sanitize;
use crate::case::stamp::Stamp;
use crate::case::{Document, rexs};
use crate::system::sharing;

use folder::{Entry, Target};
use state::State;

/// Greatest number of recent cases.
const MOST_RECENTS: usize = 20;
/// Greatest size of the file.
const MOST_BYTES: u64 = 256 * 1024;
/// Separator of paths: the only byte that no path contains.
const END: u8 = 0;

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
    let Some(path) = asked.or_else(last_recent) else {
        return Opening { document: built_in(), path: None, trouble: None };
    };
    match load(&path) {
        Ok(document) => {
            add_recent(&path);
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

pub(super) fn at_home(path: &Path) -> PathBuf {
    let home = env::var_os("HOME").map(PathBuf::from).filter(|home| home.is_absolute());
    match (path.strip_prefix("~"), home) {
        (Ok(rest), Some(home)) => home.join(rest),
        _ => path.to_owned(),
    }
}

/// Recent cases as lines of the browser, and whether their files still exist.
#[must_use]
pub fn looked_at(paths: Vec<PathBuf>) -> Vec<Entry> {
    let look = |path: PathBuf| {
        let is_missing =
            fs::metadata(&path).is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
        let text = |name: &OsStr| name.to_string_lossy().into_owned();
        let mut name = path.file_name().map(text).unwrap_or_default();
        if is_missing {
            name += "  (missing)";
        }
        if let Some(folder) = path.parent().and_then(Path::file_name) {
            name = format!("{name}  in {}/", text(folder));
        }
        let whole = sanitize(&path.to_string_lossy());
        Entry::new(name, &whole, Target::File(path))
    };
    paths.into_iter().map(look).collect()
}

/// The recent cases.
#[must_use]
pub(crate) fn recents() -> Vec<PathBuf> {
    let Some(file) = list_file() else {
        return Vec::new();
    };
    let is_ours =
        fs::metadata(&file).is_ok_and(|about| about.is_file() && about.len() <= MOST_BYTES);
    if is_ours { parse_list(&fs::read(file).unwrap_or_default()) } else { Vec::new() }
}

/// Adds a case as the latest.
pub(crate) fn add_recent(path: &Path) {
    let write = || -> io::Result<()> {
        let file = list_file().ok_or(io::ErrorKind::NotFound)?;
        let folder = file.parent().ok_or(io::ErrorKind::NotFound)?;
        state::make(folder)?;
        let mut new = NamedTempFile::new_in(folder)?;
        new.write_all(&render_list(&with_latest(recents(), std::path::absolute(path)?)))?;
        new.persist(&file).map_err(|error| error.error).map(drop)
    };
    // An error is ignored, because the list is only a convenience.
    drop(write());
}

// The title above the faults already has the name.
fn without_name(path: &Path, fault: &str) -> String {
    let name = format!("{}:", sanitize(&path.display().to_string()));
    fault.strip_prefix(&name).unwrap_or(fault).trim_start().to_owned()
}

/// The latest case.
#[must_use]
fn last_recent() -> Option<PathBuf> {
    recents().into_iter().next()
}

fn with_latest(mut paths: Vec<PathBuf>, latest: PathBuf) -> Vec<PathBuf> {
    paths.retain(|path| *path != latest);
    paths.insert(0, latest);
    paths.truncate(MOST_RECENTS);
    paths
}

fn parse_list(bytes: &[u8]) -> Vec<PathBuf> {
    let paths = bytes.split(|&byte| byte == END).filter(|path| !path.is_empty());
    paths.map(|path| sharing::path_from_bytes(path.to_vec())).take(MOST_RECENTS).collect()
}

fn render_list(paths: &[PathBuf]) -> Vec<u8> {
    paths.iter().flat_map(|path| sharing::path_bytes(path).iter().copied().chain([END])).collect()
}

fn list_file() -> Option<PathBuf> {
    // Earlier versions stored the last case as a single path without a separator.
    State::find().folder.map(|folder| folder.join("last-case"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_case_is_first_and_no_case_is_listed_twice() {
        let paths = ["a", "b", "c"].map(PathBuf::from).to_vec();
        assert_eq!(with_latest(paths.clone(), "c".into()), ["c", "a", "b"].map(PathBuf::from));
        let many: Vec<PathBuf> =
            (0..MOST_RECENTS).map(|number| number.to_string().into()).collect();
        let more = with_latest(many, "new".into());
        assert_eq!((more.len(), &more[0]), (MOST_RECENTS, &PathBuf::from("new")));
    }

    #[test]
    fn every_path_is_saved_and_read() {
        let odd = sharing::path_from_bytes(vec![b'/', 0xff, b'\n', b' ']);
        let paths = vec![odd, "/plain.toml".into()];
        assert_eq!(parse_list(&render_list(&paths)), paths);
        assert_eq!(parse_list(b"/kept/before.toml"), [PathBuf::from("/kept/before.toml")]);
        assert!(parse_list(b"").is_empty());
    }
}
