//! The folder of journals: writes them, finds those of ended sessions, and sets damaged ones aside.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::journal::{Journal, JournalFault, MOST_BYTES};
use super::lock::Lock;
use crate::case::sanitize::sanitize;
use crate::case::stamp::{Stamp, hash};
use crate::system::paths;
use crate::tui::store::state;

/// What a journal's name ends with.
const ENDING: &str = "toml";
/// Letters of a case's name in that of its journal.
const MOST_LETTERS: usize = 40;

/// The folders of journals, and of the sessions that write them.
#[derive(Debug, Clone)]
pub(super) struct Journals {
    journals: PathBuf,
    sessions: PathBuf,
}

/// The journals of a case.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// Those of ended sessions, the latest first.
    pub(super) journals: Vec<(PathBuf, Journal)>,
    /// What happened to damaged ones, one sentence each.
    pub(super) notices: Vec<String>,
}

impl Journals {
    /// In a folder of state.
    #[must_use]
    pub(super) fn within(state: &Path) -> Journals {
        Journals {
            journals: state.join("journals"),
            sessions: state.join("sessions"),
        }
    }

    /// A new session: a lock that tells others that its journals are still being written.
    ///
    /// # Errors
    /// When there is no room for it, or another user could change the folders.
    pub(super) fn begin(&self) -> io::Result<(String, Lock)> {
        for folder in [&self.journals, &self.sessions] {
            state::make(folder)?;
            state::require_private(folder)?;
        }
        Lock::create(&self.sessions)
    }

    /// Where a session keeps the edits of a case; `number` tells its cases without a file apart.
    #[must_use]
    pub(super) fn place(&self, case: Option<&Path>, session: &str, number: usize) -> PathBuf {
        self.journals
            .join(format!("{}{session}-{number}.{ENDING}", stem(case)))
    }

    /// Write a journal over the one before; `lasting` where it must outlive a power cut as well.
    ///
    /// # Errors
    /// When it cannot be written; the one before is then still there.
    pub(super) fn write(path: &Path, journal: &Journal, lasting: bool) -> io::Result<()> {
        let folder = path.parent().unwrap_or(Path::new("."));
        let mut file = tempfile::Builder::new().prefix(".").tempfile_in(folder)?;
        file.write_all(journal.to_text().as_bytes())?;
        if lasting {
            file.as_file().sync_data()?;
        }
        file.persist(path).map(drop).map_err(|error| error.error)
    }

    /// The journals of a case whose sessions have ended. A case without a file is recognised by the
    /// stamp of its text. Damaged journals are set aside, never deleted.
    #[must_use]
    pub(super) fn left_behind(&self, case: Option<&Path>, stamp: Stamp) -> Found {
        let mut found = Found::default();
        for path in self.named(&stem(case)) {
            match read(&path) {
                Ok(journal) if !journal.is_of(case, stamp) || self.is_written(&journal) => {}
                Ok(journal) => found.journals.push((path, journal)),
                Err(Untrusted::Unread(error)) => {
                    found.notices.push(format!(
                        "unsaved edits in {} cannot be read: {error}",
                        shown(&path)
                    ));
                }
                Err(Untrusted::Fault(fault)) => found.notices.push(set_aside(&path, &fault)),
            }
        }
        found
            .journals
            .sort_by_key(|(_, journal)| std::cmp::Reverse(journal.written));
        found
    }

    /// The journals of every case that ended sessions left behind.
    pub(super) fn all_left_behind(&self) -> impl Iterator<Item = Journal> {
        let journals = self
            .named("")
            .into_iter()
            .filter_map(|path| read(&path).ok());
        journals.filter(|journal| !self.is_written(journal))
    }

    fn is_written(&self, journal: &Journal) -> bool {
        let is_a_name = journal
            .session
            .chars()
            .all(|letter| letter.is_ascii_alphanumeric());
        is_a_name && Lock::is_held(&self.sessions.join(&journal.session))
    }

    fn named(&self, start: &str) -> Vec<PathBuf> {
        let entries = fs::read_dir(&self.journals)
            .into_iter()
            .flatten()
            .flatten()
            .map(|entry| entry.path());
        let fits = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            !name.starts_with('.')
                && name.starts_with(start)
                && path.extension().is_some_and(|ending| ending == ENDING)
        };
        let mut paths: Vec<_> = entries.filter(fits).collect();
        paths.sort();
        paths
    }
}

enum Untrusted {
    Unread(io::Error),
    Fault(JournalFault),
}

fn read(path: &Path) -> Result<Journal, Untrusted> {
    let is_file = fs::symlink_metadata(path)
        .map_err(Untrusted::Unread)?
        .is_file();
    if !is_file {
        return Err(Untrusted::Fault(JournalFault::NotOne));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(Untrusted::Unread)?;
    file.take(MOST_BYTES as u64 + 1)
        .read_to_end(&mut bytes)
        .map_err(Untrusted::Unread)?;
    if bytes.len() > MOST_BYTES {
        return Err(Untrusted::Fault(JournalFault::NotOne));
    }
    let text = String::from_utf8(bytes).map_err(|_| Untrusted::Fault(JournalFault::Damaged))?;
    Journal::from_text(&text).map_err(Untrusted::Fault)
}

// Returns the report. A journal that cannot be moved stays, and is reported again.
fn set_aside(path: &Path, fault: &JournalFault) -> String {
    let free = (1..100)
        .map(|number| path.with_extension(format!("damaged-{number}")))
        .find(|name| fs::symlink_metadata(name).is_err());
    let moved = free.and_then(|name| fs::rename(path, &name).ok().map(|()| name));
    let place = moved.unwrap_or_else(|| path.to_owned());
    format!(
        "unsaved edits of this case cannot be restored: {fault}; the file is now {}",
        shown(&place)
    )
}

fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

// How the journals of a case begin: a few letters for a person, and a hash that tells cases of one
// name apart.
fn stem(case: Option<&Path>) -> String {
    let Some(case) = case else {
        return "new-".to_owned();
    };
    let name = case.file_stem().unwrap_or_default().to_string_lossy();
    let letters: String = name
        .chars()
        .filter(char::is_ascii_alphanumeric)
        .take(MOST_LETTERS)
        .collect();
    format!("case-{letters}-{:016x}-", hash(paths::bytes(case)))
}
