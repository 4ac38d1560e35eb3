//! The locks of the open cases.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::holder::Holder;
use super::lock::{Lock, LockOutcome};
use crate::case::file::followed;
use crate::case::sanitize::sanitize;

/// The locks by the canonical places of the cases.
#[derive(Debug, Default)]
pub(super) struct Locks(BTreeMap<PathBuf, Held>);

/// A lock of this session.
#[derive(Debug)]
struct Held {
    /// The lock file, with the full path of its folder: two paths may name one file.
    place: PathBuf,
    _lock: Lock,
}

impl Locks {
    /// Takes the lock of a case. Returns the process that has the case open, or `None` if this
    /// session now has the lock. The error is the reason why the case has no lock.
    pub(super) fn take(&mut self, path: &Path) -> Result<Option<Holder>, String> {
        let Some(named) = lock_of(path).filter(|named| !self.0.contains_key(named)) else {
            return Ok(None);
        };
        let whole = followed(path).ok().and_then(|path| lock_of(&path));
        let place = whole.unwrap_or_else(|| named.clone());
        if self.0.values().any(|held| held.place == place) {
            return Ok(None);
        }
        let hold = |lock: Lock| {
            let place = place.clone();
            self.0.insert(named, Held { place, _lock: lock });
        };
        match Lock::take(&place) {
            Ok(LockOutcome::Held(holder)) => Ok(Some(holder)),
            Ok(LockOutcome::Ours(lock)) => {
                hold(lock);
                Ok(None)
            }
            Ok(LockOutcome::Unguarded(lock, error)) => {
                hold(lock);
                Err(format!(
                    "{}: the lock is valid on this machine only: {}: do not open this case on \
                        another machine",
                    name_of(path),
                    brief(&error)
                ))
            }
            Err(error) => Err(unlocked(path, &place, &error)),
        }
    }

    /// Whether this session has the lock of the case.
    pub(super) fn has(&self, path: &Path) -> bool {
        lock_of(path).is_some_and(|place| self.0.contains_key(&place))
    }

    /// Releases the locks of all other cases.
    pub(super) fn keep_only<'a>(&mut self, cases: impl Iterator<Item = &'a Path>) {
        let wanted: Vec<_> = cases.filter_map(lock_of).collect();
        self.0.retain(|named, _| wanted.contains(named));
    }
}

// The lock file is beside the case, so that other users and other machines also see it: whoever may
// save there may lock there.
fn lock_of(path: &Path) -> Option<PathBuf> {
    let mut name = OsString::from(".");
    name.push(path.file_name()?);
    name.push(".tipstrike");
    Some(path.with_file_name(name))
}

/// Why a case has no lock, and the fix.
fn unlocked(path: &Path, place: &Path, error: &io::Error) -> String {
    let lock = name_of(place);
    let (cause, fix) = match error.kind() {
        ErrorKind::PermissionDenied if place.symlink_metadata().is_ok() => (
            format!("another user created its lock {lock}, which you cannot read"),
            "ask whether that user has the case open",
        ),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            ("its folder is read-only".to_owned(), "save it elsewhere")
        }
        ErrorKind::IsADirectory => (format!("{lock} is a folder"), "remove that"),
        ErrorKind::Other => (format!("{lock} {error}"), "remove that"),
        _ => (format!("{lock}: {}", brief(error)), "open it only once"),
    };
    let name = name_of(path);
    format!("{name} is not locked, so other sessions may save it too: {cause}: {fix}")
}

/// The error text of the system without the error number.
fn brief(error: &io::Error) -> String {
    let words = error.to_string();
    let end = words.find(" (os error").unwrap_or(words.len());
    words[..end].to_owned()
}

fn name_of(path: &Path) -> String {
    sanitize(&path.file_name().unwrap_or_default().to_string_lossy())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lock_that_cannot_be_read_is_not_called_a_read_only_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let case = folder.path().join("case.toml");
        let lock = lock_of(&case).expect("a name");
        let denied = io::Error::from(ErrorKind::PermissionDenied);
        assert!(unlocked(&case, &lock, &denied).contains("its folder is read-only"));
        std::fs::write(&lock, "").expect("room on the disk");
        let words = unlocked(&case, &lock, &denied);
        assert!(!words.contains("read-only"), "{words}");
        assert!(words.contains("created its lock .case.toml.tipstrike"), "{words}");
    }
}
