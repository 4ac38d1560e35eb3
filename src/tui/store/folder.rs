//! The content of a folder: its folders and cases, with any names.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use super::at_home;
use crate::case::rexs;
use crate::case::sanitize::sanitize;

/// Greatest number of listed entries.
const MOST: usize = 50_000;

/// An entry of a folder.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Folders sort after cases.
    pub(crate) is_folder: bool,
    /// Its name as text.
    pub(crate) name: String,
    /// The name in lower case.
    pub(crate) folded: String,
    /// Its name, which need not be valid text.
    pub(crate) file: OsString,
}

/// The content of a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// The folder of the browser, and the folders typed after it.
    pub asked: (PathBuf, String),
    /// The full path of the folder.
    pub(crate) folder: PathBuf,
    /// The entries, including hidden ones; or the error of reading.
    pub entries: Result<Vec<Entry>, String>,
    /// Whether the list is incomplete.
    pub(crate) is_cut: bool,
}

/// Lists a folder.
#[must_use]
pub fn list(base: PathBuf, typed: String) -> Listing {
    let place = place_of(&base, &typed);
    let folder = fs::canonicalize(&place).or_else(|_| std::path::absolute(&place)).unwrap_or(place);
    let found = entries(&folder);
    let is_cut = found.as_ref().is_ok_and(|entries| entries.len() >= MOST);
    Listing { asked: (base, typed), folder, entries: found, is_cut }
}

/// The typed folder; by default the present folder.
pub(crate) fn place_of(base: &Path, typed: &str) -> PathBuf {
    let place = at_home(&beneath(base, typed));
    if place.as_os_str().is_empty() { PathBuf::from(".") } else { place }
}

/// The path of a text typed into a browser of `base`; `~` and `/` make it absolute.
#[must_use]
pub fn beneath(base: &Path, typed: &str) -> PathBuf {
    if typed.starts_with('~') { PathBuf::from(typed) } else { base.join(typed) }
}

/// The folders and cases of a folder, sorted by name.
///
/// # Errors
/// The error of reading, as text.
pub(crate) fn entries(folder: &Path) -> Result<Vec<Entry>, String> {
    let found =
        fs::read_dir(folder).map_err(|error| format!("This folder cannot be read: {error}."))?;
    let mut entries: Vec<_> =
        found.flatten().filter_map(|entry| Entry::of(&entry)).take(MOST).collect();
    entries.sort();
    Ok(entries)
}

impl Entry {
    /// Whether a file with this name is a case, or a model that can be imported as a case.
    #[must_use]
    pub(crate) fn is_case(file: &Path) -> bool {
        let is_toml = |ending: &std::ffi::OsStr| ending.eq_ignore_ascii_case("toml");
        file.extension().is_some_and(is_toml) || rexs::is_model(file)
    }

    fn of(entry: &fs::DirEntry) -> Option<Entry> {
        let file = entry.file_name();
        let kind = entry.file_type().ok()?;
        // Only a link needs another system call.
        let is_folder = kind.is_dir() || kind.is_symlink() && entry.path().is_dir();
        let is_case = !is_folder && Entry::is_case(Path::new(&file));
        let name = sanitize(&file.to_string_lossy());
        (is_folder || is_case).then(|| Entry { is_folder, folded: name.to_lowercase(), name, file })
    }
}
