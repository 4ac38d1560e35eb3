//! The folder of journals: writes journals, finds those of ended sessions, and moves damaged ones.

use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use super::clock;
use super::journal::{Journal, JournalFault, MOST_BYTES};
use super::lock::Lock;
use crate::case::sanitize::sanitize;
use crate::case::stamp::{Stamp, hash};
use crate::system::paths;
use crate::tui::store::{self, state};

/// The extension of a journal.
const ENDING: &str = "toml";
/// Number of letters of the case's name in the name of its journal.
const MOST_LETTERS: usize = 40;

/// Age in seconds of a journal that is not reported any more.
const RECENT: u64 = 30 * 86400;

/// The folders of journals and of session locks.
#[derive(Debug, Clone)]
pub(super) struct Journals {
    journals: PathBuf,
    sessions: PathBuf,
}

/// The journals of a case.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// Journals of ended sessions, the latest first.
    pub(super) journals: Vec<(PathBuf, Journal)>,
    /// A sentence for each damaged journal.
    pub(super) notices: Vec<String>,
}

impl Journals {
    /// The folders inside a state folder.
    #[must_use]
    pub(super) fn within(state: &Path) -> Journals {
        Journals { journals: state.join("journals"), sessions: state.join("sessions") }
    }

    /// Starts a session: its lock shows others that its journals are still in use.
    ///
    /// # Errors
    /// Returns an error if the disk is full, or if another user could change the folders.
    pub(super) fn begin(&self) -> io::Result<(String, Lock)> {
        for folder in [&self.journals, &self.sessions] {
            state::make(folder)?;
            state::require_private(folder)?;
        }
        Lock::create(&self.sessions)
    }

    /// The path of the journal of a case in a session; `number` distinguishes cases without a file.
    #[must_use]
    pub(super) fn place(&self, case: Option<&Path>, session: &str, number: usize) -> PathBuf {
        self.journals.join(format!("{}{session}-{number}.{ENDING}", stem(case)))
    }

    /// Replaces a journal; a `lasting` write survives a power failure.
    ///
    /// # Errors
    /// Returns an error if the journal cannot be written; the previous one then remains.
    pub(super) fn write(path: &Path, journal: &Journal, lasting: bool) -> io::Result<()> {
        let folder = path.parent().unwrap_or(Path::new("."));
        let mut file = tempfile::Builder::new().prefix(".").tempfile_in(folder)?;
        file.write_all(journal.to_text().as_bytes())?;
        if lasting {
            file.as_file().sync_data()?;
        }
        file.persist(path).map(drop).map_err(|error| error.error)
    }

    /// The journals of a case from ended sessions. A case without a file is identified by the stamp
    /// of its text. Damaged journals are moved, never deleted.
    #[must_use]
    pub(super) fn left_behind(&self, case: Option<&Path>, stamp: Stamp) -> Found {
        let mut found = Found::default();
        for path in self.named(&stem(case)) {
            match read(&path) {
                Ok(journal) if !journal.is_of(case, stamp) || self.is_written(&journal) => {}
                Ok(journal) => found.journals.push((path, journal)),
                Err(Untrusted::Unread(error)) => {
                    found
                        .notices
                        .push(format!("unsaved edits in {} cannot be read: {error}", shown(&path)));
                }
                Err(Untrusted::Fault(fault)) => found.notices.push(set_aside(&path, &fault)),
            }
        }
        found.journals.sort_by_key(|(_, journal)| std::cmp::Reverse(journal.written));
        found
    }

    /// The journals of every case from ended sessions, each with its case, its number of edits and
    /// its age.
    pub(super) fn list(&self) -> Vec<(PathBuf, String)> {
        let journals = self.all_left_behind();
        let described = journals.map(|(path, journal)| {
            let count = journal.changes.len();
            let edits = if count == 1 { "edit" } else { "edits" };
            let missing = if is_missing(&journal) { ", no such file" } else { "" };
            let age = clock::age(age_of(&journal));
            let words = format!("{}: {count} {edits}, {age} old{missing}", name_of(&journal));
            (path, words)
        });
        described.collect()
    }

    /// Reports recent journals of existing cases other than this one.
    pub(super) fn report(&self, case: Option<&Path>, stamp: Stamp) -> Option<String> {
        let others = self.all_left_behind().filter(|(_, journal)| {
            !journal.is_of(case, stamp) && !is_missing(journal) && age_of(journal) < RECENT
        });
        let mut names: BTreeSet<String> = others.map(|(_, journal)| name_of(&journal)).collect();
        let name = match names.len() {
            0 | 1 => names.pop_first()?,
            count => format!("{count} other cases"),
        };
        Some(format!("{name}: unsaved edits of an ended session; :journals lists them"))
    }

    fn all_left_behind(&self) -> impl Iterator<Item = (PathBuf, Journal)> {
        let paths = self.named("").into_iter();
        let journals = paths.filter_map(|path| read(&path).ok().map(|journal| (path, journal)));
        journals.filter(|(_, journal)| !self.is_written(journal))
    }

    fn is_written(&self, journal: &Journal) -> bool {
        let is_a_name = journal.session.chars().all(|letter| letter.is_ascii_alphanumeric());
        is_a_name && Lock::is_held(&self.sessions.join(&journal.session))
    }

    fn named(&self, start: &str) -> Vec<PathBuf> {
        let entries =
            fs::read_dir(&self.journals).into_iter().flatten().flatten().map(|entry| entry.path());
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
    let is_file = fs::symlink_metadata(path).map_err(Untrusted::Unread)?.is_file();
    if !is_file {
        return Err(Untrusted::Fault(JournalFault::NotOne));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(Untrusted::Unread)?;
    file.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes).map_err(Untrusted::Unread)?;
    if bytes.len() > MOST_BYTES {
        return Err(Untrusted::Fault(JournalFault::NotOne));
    }
    let text = String::from_utf8(bytes).map_err(|_| Untrusted::Fault(JournalFault::Damaged))?;
    Journal::from_text(&text).map_err(Untrusted::Fault)
}

// Returns the message. A journal that cannot be moved remains and is reported again.
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

fn is_missing(journal: &Journal) -> bool {
    journal.case.as_ref().is_some_and(|path| !path.exists())
}

/// In seconds.
fn age_of(journal: &Journal) -> u64 {
    clock::now().saturating_sub(journal.written)
}

fn name_of(journal: &Journal) -> String {
    match &journal.case {
        Some(path) => shown(path),
        None if journal.base_stamp == store::built_in().stamp() => "the built-in case".to_owned(),
        None => "a new case".to_owned(),
    }
}

fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

// The start of the names of a case's journals: a few letters for the reader, and a hash that
// distinguishes cases with the same name.
fn stem(case: Option<&Path>) -> String {
    let Some(case) = case else {
        return "new-".to_owned();
    };
    let name = case.file_stem().unwrap_or_default().to_string_lossy();
    let letters: String =
        name.chars().filter(char::is_ascii_alphanumeric).take(MOST_LETTERS).collect();
    format!("case-{letters}-{:016x}-", hash(paths::bytes(case)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_recent_journals_of_existing_cases_are_reported_and_all_are_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        let journals = Journals::within(folder.path());
        drop(journals.begin().expect("our own folder"));
        let leave = |name: &str, age: u64| {
            let case = folder.path().join(name);
            let journal = Journal {
                case: Some(case.clone()),
                base_stamp: Stamp::of(b""),
                written: clock::now() - age,
                session: "ended".to_owned(),
                changes: Vec::new(),
            };
            let place = journals.place(Some(&case), "ended", 0);
            Journals::write(&place, &journal, false).expect("room on the disk");
            case
        };
        let report =
            |case: Option<&Path>| journals.report(case, Stamp::of(b"")).unwrap_or_default();
        leave("deleted.toml", 60);
        fs::write(leave("old.toml", 40 * 86400), "").expect("room on the disk");
        assert_eq!(report(None), "");
        let one = leave("one.toml", 60);
        fs::write(&one, "").expect("room on the disk");
        assert!(report(None).starts_with(&format!("{}: ", one.display())));
        assert_eq!(report(Some(&one)), "");
        fs::write(leave("two.toml", 60), "").expect("room on the disk");
        assert!(report(None).starts_with("2 other cases: "));
        let list = journals.list();
        assert_eq!(list.len(), 4);
        assert!(list[0].1.ends_with("deleted.toml: 0 edits, 1 min old, no such file"));
    }
}
