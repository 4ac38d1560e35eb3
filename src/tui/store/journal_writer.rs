//! What is to be kept in journals, and the thread that writes it: the workbench never waits for a
//! disk.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::clock;
use super::journals::Journals;
use crate::case::journal::Journal;

/// The name of the thread that writes journals.
pub const THREAD: &str = "journal";

/// Journals as they should stand on the disk, shared by all who may have to write them.
#[derive(Debug, Default)]
pub struct JournalWriter {
    shelf: Mutex<Shelf>,
    bell: Condvar,
    /// One writer at a time.
    pen: Mutex<()>,
}

#[derive(Debug, Default)]
struct Shelf {
    pages: BTreeMap<PathBuf, Page>,
    is_due: bool,
    is_closed: bool,
}

#[derive(Debug, Default)]
struct Page {
    wanted: Option<Journal>,
    written: Option<Journal>,
}

impl JournalWriter {
    /// A journal_writer, and its thread, which tells when a journal cannot be written, and sleeps
    /// until it is method for.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn open(tell: impl Fn(String) + Send + 'static) -> io::Result<Arc<JournalWriter>> {
        let journal_writer = Arc::new(JournalWriter::default());
        let theirs = Arc::clone(&journal_writer);
        thread::Builder::new()
            .name(THREAD.to_owned())
            .spawn(move || {
                while theirs.wait() {
                    if let Err(error) = theirs.write(true) {
                        tell(format!(
                            "unsaved edits cannot be kept for a crash: {error}: save soon"
                        ));
                    }
                }
            })?;
        Ok(journal_writer)
    }

    /// What a journal should say; `None` where it should not be there.
    pub fn put(&self, path: &Path, journal: Option<Journal>) {
        self.shelf()
            .pages
            .entry(path.to_owned())
            .or_default()
            .wanted = journal;
    }

    /// Have all that has changed written, by the thread.
    pub fn ring(&self) {
        self.shelf().is_due = true;
        self.bell.notify_all();
    }

    /// Write all that has changed, here and now. Only a `lasting` journal outlives a power cut,
    /// which takes the disk's time; any outlives the process.
    ///
    /// # Errors
    /// The first one; the other journals are written all the same.
    pub fn write(&self, lasting: bool) -> io::Result<()> {
        let pen = self.pen.lock().unwrap_or_else(PoisonError::into_inner);
        let changed: Vec<_> = self.shelf().changed();
        let mut result = Ok(());
        for (path, wanted) in changed {
            let written = match &wanted {
                Some(journal) => Journals::write(
                    &path,
                    &Journal {
                        written: clock::now(),
                        ..journal.clone()
                    },
                    lasting,
                ),
                None => fs::remove_file(&path).or_else(|error| {
                    if error.kind() == io::ErrorKind::NotFound {
                        Ok(())
                    } else {
                        Err(error)
                    }
                }),
            };
            if written.is_ok() {
                self.shelf().settle(&path, wanted);
            }
            result = result.and(written);
        }
        drop(pen);
        result
    }

    /// Whether there are edits that only a journal holds.
    #[must_use]
    pub fn is_needed(&self) -> bool {
        self.shelf()
            .pages
            .values()
            .any(|page| page.wanted.is_some())
    }

    /// End the thread.
    pub fn close(&self) {
        self.shelf().is_closed = true;
        self.bell.notify_all();
    }

    fn shelf(&self) -> MutexGuard<'_, Shelf> {
        self.shelf.lock().unwrap_or_else(PoisonError::into_inner)
    }

    // Whether there is something to do, rather than an end.
    fn wait(&self) -> bool {
        let mut shelf = self.shelf();
        while !shelf.is_due && !shelf.is_closed {
            shelf = self
                .bell
                .wait(shelf)
                .unwrap_or_else(PoisonError::into_inner);
        }
        shelf.is_due = false;
        !shelf.is_closed
    }
}

impl Shelf {
    fn changed(&self) -> Vec<(PathBuf, Option<Journal>)> {
        let differs = |(_, page): &(&PathBuf, &Page)| page.wanted != page.written;
        self.pages
            .iter()
            .filter(differs)
            .map(|(path, page)| (path.clone(), page.wanted.clone()))
            .collect()
    }

    fn settle(&mut self, path: &Path, written: Option<Journal>) {
        if let Some(page) = self.pages.get_mut(path) {
            page.written = written;
        }
        self.pages
            .retain(|_, page| page.wanted.is_some() || page.written.is_some());
    }
}
