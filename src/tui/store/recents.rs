//! The list of recent cases, the latest first, in the state folder. Its errors are ignored, because
//! the list is only a convenience.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::state::{self, State};
use crate::case::sanitize::sanitize;
use crate::system::paths;

/// Greatest number of recent cases.
const MOST: usize = 20;
/// Greatest size of the file.
const MOST_BYTES: u64 = 256 * 1024;
/// Separator of paths: the only byte that no path contains.
const END: u8 = 0;

/// A case that was opened before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Recent {
    pub(crate) path: PathBuf,
    /// The path as text in lower case.
    pub(crate) folded: String,
    /// Whether the file is missing.
    pub(crate) is_missing: bool,
}

/// Checks which files still exist.
#[must_use]
pub fn looked_at(paths: Vec<PathBuf>) -> Vec<Recent> {
    let look = |path: PathBuf| {
        let is_missing =
            fs::metadata(&path).is_err_and(|error| error.kind() == io::ErrorKind::NotFound);
        Recent { folded: sanitize(&path.to_string_lossy()).to_lowercase(), is_missing, path }
    };
    paths.into_iter().map(look).collect()
}

/// The recent cases.
#[must_use]
pub(crate) fn list() -> Vec<PathBuf> {
    let Some(file) = file() else {
        return Vec::new();
    };
    let is_ours =
        fs::metadata(&file).is_ok_and(|about| about.is_file() && about.len() <= MOST_BYTES);
    if is_ours { parse(&fs::read(file).unwrap_or_default()) } else { Vec::new() }
}

/// The latest case.
#[must_use]
pub(crate) fn last() -> Option<PathBuf> {
    list().into_iter().next()
}

/// Adds a case as the latest.
pub(crate) fn add(path: &Path) {
    let write = || -> io::Result<()> {
        let file = file().ok_or(io::ErrorKind::NotFound)?;
        let folder = file.parent().ok_or(io::ErrorKind::NotFound)?;
        state::make(folder)?;
        let mut new = NamedTempFile::new_in(folder)?;
        new.write_all(&render(&with(list(), std::path::absolute(path)?)))?;
        new.persist(&file).map_err(|error| error.error).map(drop)
    };
    drop(write());
}

fn with(mut paths: Vec<PathBuf>, latest: PathBuf) -> Vec<PathBuf> {
    paths.retain(|path| *path != latest);
    paths.insert(0, latest);
    paths.truncate(MOST);
    paths
}

fn parse(bytes: &[u8]) -> Vec<PathBuf> {
    let paths = bytes.split(|&byte| byte == END).filter(|path| !path.is_empty());
    paths.map(|path| paths::from_bytes(path.to_vec())).take(MOST).collect()
}

fn render(paths: &[PathBuf]) -> Vec<u8> {
    paths.iter().flat_map(|path| paths::bytes(path).iter().copied().chain([END])).collect()
}

fn file() -> Option<PathBuf> {
    // Earlier versions stored the last case as a single path without a separator.
    State::find().folder.map(|folder| folder.join("last-case"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_case_is_first_and_no_case_is_listed_twice() {
        let paths = ["a", "b", "c"].map(PathBuf::from).to_vec();
        assert_eq!(with(paths.clone(), "c".into()), ["c", "a", "b"].map(PathBuf::from));
        let many: Vec<PathBuf> = (0..MOST).map(|number| number.to_string().into()).collect();
        let more = with(many, "new".into());
        assert_eq!((more.len(), &more[0]), (MOST, &PathBuf::from("new")));
    }

    #[test]
    fn every_path_is_saved_and_read() {
        let odd = paths::from_bytes(vec![b'/', 0xff, b'\n', b' ']);
        let paths = vec![odd, "/plain.toml".into()];
        assert_eq!(parse(&render(&paths)), paths);
        assert_eq!(parse(b"/kept/before.toml"), [PathBuf::from("/kept/before.toml")]);
        assert!(parse(b"").is_empty());
    }
}
