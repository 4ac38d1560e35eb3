//! What stands in a folder: the folders and the cases, however they are called and however many.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use super::at_home;
use crate::case::rexs;
use crate::case::sanitize::sanitize;

/// So many are listed; a folder with more is not for looking through.
const MOST: usize = 50_000;

/// An entry of a folder.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Folders stand after the cases.
    pub(crate) is_folder: bool,
    /// Its name as a person reads it.
    pub(crate) name: String,
    /// The same in small letters.
    pub(crate) folded: String,
    /// Its name, which need not be text.
    pub(crate) file: OsString,
}

/// What stands in a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// Where the browser was, and the folders that were typed after it.
    pub asked: (PathBuf, String),
    /// The folder, in full.
    pub(crate) folder: PathBuf,
    /// What stands in it, hidden entries too; or why it cannot be read.
    pub entries: Result<Vec<Entry>, String>,
    /// Whether there are more than are listed.
    pub(crate) is_cut: bool,
}

/// Look into a folder.
#[must_use]
pub fn list(base: PathBuf, typed: String) -> Listing {
    let place = place_of(&base, &typed);
    let folder = fs::canonicalize(&place)
        .or_else(|_| std::path::absolute(&place))
        .unwrap_or(place);
    let found = entries(&folder);
    let is_cut = found.as_ref().is_ok_and(|entries| entries.len() >= MOST);
    Listing {
        asked: (base, typed),
        folder,
        entries: found,
        is_cut,
    }
}

/// The folder that is meant, the present one where nothing is said.
pub(crate) fn place_of(base: &Path, typed: &str) -> PathBuf {
    let place = at_home(&beneath(base, typed));
    if place.as_os_str().is_empty() {
        PathBuf::from(".")
    } else {
        place
    }
}

/// The path of a text typed into a browser of `base`; `~` and `/` make it absolute.
#[must_use]
pub fn beneath(base: &Path, typed: &str) -> PathBuf {
    if typed.starts_with('~') {
        PathBuf::from(typed)
    } else {
        base.join(typed)
    }
}

/// The folders and cases of a folder in the order of their names.
///
/// # Errors
/// In words, where it cannot be read.
pub(crate) fn entries(folder: &Path) -> Result<Vec<Entry>, String> {
    let found =
        fs::read_dir(folder).map_err(|error| format!("This folder cannot be read: {error}."))?;
    let mut entries: Vec<_> = found
        .flatten()
        .filter_map(|entry| Entry::of(&entry))
        .take(MOST)
        .collect();
    entries.sort();
    Ok(entries)
}

impl Entry {
    /// Whether a file of that name is taken for a case, or for a model that becomes one.
    #[must_use]
    pub(crate) fn is_case(file: &Path) -> bool {
        let is_toml = |ending: &std::ffi::OsStr| ending.eq_ignore_ascii_case("toml");
        file.extension().is_some_and(is_toml) || rexs::is_model(file)
    }

    fn of(entry: &fs::DirEntry) -> Option<Entry> {
        let file = entry.file_name();
        let kind = entry.file_type().ok()?;
        // Only a link has to be followed to know.
        let is_folder = kind.is_dir() || kind.is_symlink() && entry.path().is_dir();
        let is_case = !is_folder && Entry::is_case(Path::new(&file));
        let name = sanitize(&file.to_string_lossy());
        (is_folder || is_case).then(|| Entry {
            is_folder,
            folded: name.to_lowercase(),
            name,
            file,
        })
    }
}
