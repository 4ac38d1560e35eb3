//! Locks of the open cases: they end with their process, whatever ends it, and name it to others.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::case::file::followed;
use crate::case::sanitize::sanitize;
use crate::system::sharing;
use crate::tui::session;

/// Attempts to lock: another process may delete the lock file between opening and locking it.
const ATTEMPTS: usize = 5;

/// Greatest size of a lock file.
const MOST_BYTES: u64 = 4096;

/// A lock; dropping it releases the lock.
#[derive(Debug)]
struct Lock {
    file: File,
    path: PathBuf,
}

impl Lock {
    /// Takes a lock, or names the running process that has it. The file of an ended process is
    /// reused: the system releases a lock with its process.
    ///
    /// # Errors
    /// Returns an error if the lock file cannot be created or is not a regular file, or if the file
    /// system has no locks.
    fn take(path: &Path) -> io::Result<Result<Lock, Holder>> {
        for _ in 0..ATTEMPTS {
            let mut file = open(path)?;
            let held = file.try_lock();
            if let Err(TryLockError::WouldBlock) = held {
                return Ok(Err(Holder::read(&mut file).unwrap_or_default()));
            }
            let mut lock = Lock { file, path: path.to_owned() };
            if let Err(TryLockError::Error(error)) = held {
                return Err(error);
            }
            if lock.is_in_place() {
                lock.sign();
                return Ok(Ok(lock));
            }
        }
        Err(io::Error::other("changes too often"))
    }

    // The text only names the process: a lock without it still works.
    fn sign(&mut self) {
        let text = Holder::ourselves().to_text();
        let file = &mut self.file;
        // Whatever the umask: a user who cannot read the file cannot find out who has the lock.
        drop(sharing::open_to_readers(file));
        drop(
            file.set_len(0)
                .and_then(|()| file.rewind())
                .and_then(|()| file.write_all(text.as_bytes())),
        );
    }

    // The last holder deletes the file, possibly while this process opens it.
    fn is_in_place(&self) -> bool {
        let both =
            self.file.metadata().and_then(|ours| Ok((ours, fs::symlink_metadata(&self.path)?)));
        both.is_ok_and(|(ours, there)| sharing::is_same_file(&ours, &there))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if self.is_in_place() {
            drop(fs::remove_file(&self.path));
        }
    }
}

/// The holder of a lock; the process is 0 if the file does not name it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
struct Holder {
    /// The host name.
    host: String,
    /// The process id.
    process: u32,
    /// Time of the lock, in seconds since 1970.
    since: u64,
}

impl Holder {
    /// This process.
    fn ourselves() -> Holder {
        Holder { host: sharing::host(), process: std::process::id(), since: session::now() }
    }

    /// The holder as text for a message.
    fn words(&self) -> String {
        let Holder { host, process, since } = self;
        let age = session::age(session::now().saturating_sub(*since));
        match process {
            0 => "an unknown process".to_owned(),
            _ => format!("process {process} on {host} for {age}"),
        }
    }

    fn to_text(&self) -> String {
        let toml = toml::to_string(self).unwrap_or_default();
        format!("# tipstrike has this case open.\n{toml}")
    }

    fn read(file: &mut File) -> Option<Holder> {
        let mut text = String::new();
        file.rewind().ok()?;
        file.take(MOST_BYTES).read_to_string(&mut text).ok()?;
        toml::from_str(&text).ok()
    }
}

/// The locks by the names of the lock files; the path of a lock is that of its folder without links,
/// because two names may lead to one file.
#[derive(Debug, Default)]
pub(super) struct Locks(BTreeMap<PathBuf, Lock>);

impl Locks {
    /// Takes the lock of a case. Returns the process that has the case open, or `None` if this
    /// session now has the lock. The error is the reason why the case has no lock.
    pub(super) fn take(&mut self, path: &Path) -> Result<Option<String>, String> {
        let Some(named) = lock_of(path).filter(|named| !self.0.contains_key(named)) else {
            return Ok(None);
        };
        let whole = followed(path).ok().and_then(|path| lock_of(&path));
        let place = whole.unwrap_or_else(|| named.clone());
        if self.0.values().any(|lock| lock.path == place) {
            return Ok(None);
        }
        match Lock::take(&place).map_err(|error| unlocked(path, &place, &error))? {
            Err(holder) => Ok(Some(holder.words())),
            Ok(lock) => {
                self.0.insert(named, lock);
                Ok(None)
            }
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

// Another user may have created a link or a pipe with that name: the link is not followed, and the
// pipe does not block.
fn open(path: &Path) -> io::Result<File> {
    let is_link = || fs::symlink_metadata(path).is_ok_and(|about| about.is_symlink());
    match sharing::open_lock(path) {
        Err(_) if is_link() => Err(io::Error::other("is a symbolic link")),
        Ok(file) if !file.metadata()?.is_file() => Err(io::Error::other("is not a regular file")),
        other => other,
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
    use std::os::unix::fs::PermissionsExt;

    use super::*;

    fn place() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("lock");
        (folder, path)
    }

    fn ours(path: &Path) -> Lock {
        Lock::take(path).expect("a lock").expect("no holder")
    }

    #[test]
    fn one_session_has_a_lock_which_names_it_and_is_deleted_at_the_end() {
        let (_folder, path) = place();
        let lock = ours(&path);
        let holder = Lock::take(&path).expect("a lock").expect_err("a holder");
        assert_eq!((holder.process, holder.host), (std::process::id(), sharing::host()));
        drop(lock);
        assert!(!path.exists());
        drop(ours(&path));
    }

    #[test]
    fn every_user_can_read_the_lock_of_a_user_with_a_strict_umask() {
        let (_folder, path) = place();
        let file = File::create(&path).expect("room on the disk");
        file.set_permissions(fs::Permissions::from_mode(0o600)).expect("our own file");
        let lock = ours(&path);
        let mode = fs::metadata(&path).expect("it is there").permissions().mode();
        assert_eq!(mode & 0o777, 0o644);
        drop(lock);
    }

    #[test]
    fn the_lock_file_of_an_ended_process_never_blocks() {
        // Nobody has locked the file, so that even the text of a running process has no effect.
        let ourselves = Holder::ourselves();
        let dead = Holder { process: u32::MAX / 4, ..ourselves.clone() };
        let texts = [dead, ourselves].map(|holder| holder.to_text());
        for text in texts.iter().map(String::as_str).chain(["", "\0\u{1b}[2J", "process = -1"]) {
            let (_folder, path) = place();
            fs::write(&path, text).expect("room on the disk");
            drop(ours(&path));
        }
    }

    #[test]
    fn no_link_is_followed_and_no_pipe_waited_for() {
        let (folder, path) = place();
        let other = folder.path().join("other");
        fs::write(&other, "mine").expect("room on the disk");
        std::os::unix::fs::symlink(&other, &path).expect("a link");
        assert!(Lock::take(&path).is_err());
        assert_eq!(fs::read_to_string(&other).expect("it is there"), "mine");
        let pipe = folder.path().join("pipe");
        assert!(
            std::process::Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .is_ok_and(|status| status.success())
        );
        assert!(Lock::take(&pipe).is_err());
        assert!(Lock::take(&folder.path().join("none/lock")).is_err());
    }

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
