//! The requested journals, and the thread that writes them: the workbench never waits for a disk.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::clock;
use super::journal::Journal;
use super::journals::Journals;

/// The name of the thread that writes journals.
pub(crate) const THREAD: &str = "journal";

/// The requested journals, shared by the threads that may write them.
#[derive(Debug, Default)]
pub struct JournalWriter {
    entries: Mutex<Entries>,
    bell: Condvar,
    /// Locked during a write.
    write_lock: Mutex<()>,
}

#[derive(Debug, Default)]
struct Entries {
    by_path: BTreeMap<PathBuf, Entry>,
    is_due: bool,
    is_closed: bool,
}

#[derive(Debug, Default)]
struct Entry {
    wanted: Option<Journal>,
    written: Option<Journal>,
}

impl JournalWriter {
    /// Starts the writer thread, which sleeps until [`JournalWriter::ring`]. `tell` receives the
    /// reason if a journal cannot be written.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn open(tell: impl Fn(String) + Send + 'static) -> io::Result<Arc<JournalWriter>> {
        let journal_writer = Arc::new(JournalWriter::default());
        let theirs = Arc::clone(&journal_writer);
        thread::Builder::new().name(THREAD.to_owned()).spawn(move || {
            while theirs.wait() {
                if let Err(error) = theirs.write(true) {
                    tell(format!("a crash would lose unsaved edits: {error}: save soon"));
                }
            }
        })?;
        Ok(journal_writer)
    }

    /// Sets the content of a journal; `None` removes it.
    pub(crate) fn put(&self, path: &Path, journal: Option<Journal>) {
        self.entries().by_path.entry(path.to_owned()).or_default().wanted = journal;
    }

    /// Wakes the thread, which writes every changed journal.
    pub(crate) fn ring(&self) {
        self.entries().is_due = true;
        self.bell.notify_all();
    }

    /// Writes every changed journal now. A journal survives the end of the process; a `lasting`
    /// write is flushed to the disk and also survives a power failure.
    ///
    /// # Errors
    /// The first error; the other journals are written nevertheless.
    pub fn write(&self, lasting: bool) -> io::Result<()> {
        let write_lock = self.write_lock.lock().unwrap_or_else(PoisonError::into_inner);
        let changed: Vec<_> = self.entries().changed();
        let mut result = Ok(());
        for (path, wanted) in changed {
            let written = match &wanted {
                Some(journal) => Journals::write(
                    &path,
                    &Journal { written: clock::now(), ..journal.clone() },
                    lasting,
                ),
                None => fs::remove_file(&path).or_else(|error| {
                    if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
                }),
            };
            if written.is_ok() {
                self.entries().settle(&path, wanted);
            }
            result = result.and(written);
        }
        drop(write_lock);
        result
    }

    /// Whether any journal contains edits that no file has.
    #[must_use]
    pub fn is_needed(&self) -> bool {
        self.entries().by_path.values().any(|entry| entry.wanted.is_some())
    }

    /// Ends the thread.
    pub(crate) fn close(&self) {
        self.entries().is_closed = true;
        self.bell.notify_all();
    }

    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    // Returns false at the end.
    fn wait(&self) -> bool {
        let mut entries = self.entries();
        while !entries.is_due && !entries.is_closed {
            entries = self.bell.wait(entries).unwrap_or_else(PoisonError::into_inner);
        }
        entries.is_due = false;
        !entries.is_closed
    }
}

impl Entries {
    fn changed(&self) -> Vec<(PathBuf, Option<Journal>)> {
        let differs = |(_, entry): &(&PathBuf, &Entry)| entry.wanted != entry.written;
        self.by_path
            .iter()
            .filter(differs)
            .map(|(path, entry)| (path.clone(), entry.wanted.clone()))
            .collect()
    }

    // If the case was closed during the write, its entry is gone. The entry is added again, so that
    // the next write deletes the file.
    fn settle(&mut self, path: &Path, written: Option<Journal>) {
        self.by_path.entry(path.to_owned()).or_default().written = written;
        self.by_path.retain(|_, entry| entry.wanted.is_some() || entry.written.is_some());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::stamp::Stamp;

    fn journal(session: &str) -> Journal {
        Journal {
            case: None,
            base_stamp: Stamp::of(b""),
            written: 0,
            session: session.to_owned(),
            changes: Vec::new(),
        }
    }

    #[test]
    fn no_journal_stays_of_a_case_closed_during_a_write() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths: Vec<PathBuf> =
            (0..20).map(|number| folder.path().join(number.to_string())).collect();
        for round in 0..20 {
            let writer = JournalWriter::default();
            for path in &paths {
                writer.put(path, Some(journal("one")));
            }
            std::thread::scope(|scope| {
                let first = scope.spawn(|| writer.write(false));
                while round > 0 && !paths[round % 7].exists() && !first.is_finished() {
                    std::thread::yield_now();
                }
                for path in &paths {
                    writer.put(path, None);
                }
                first.join().expect("no panic").expect("a write");
            });
            writer.write(false).expect("a second write");
            let left = fs::read_dir(folder.path()).expect("the folder").count();
            assert_eq!(left, 0, "round {round}");
        }
    }
}
