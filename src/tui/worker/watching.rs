//! Watches the files of the open cases: another program may write them.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use super::latest::Send;
use crate::tui::actions::Action;
use crate::tui::store;

/// Time between two looks at the files: a second is soon enough for a person, and costs nothing.
const PERIOD: Duration = Duration::from_secs(1);
/// A file is read once its mark has stayed the same for this long, or after [`LOOKS`] looks.
const QUIET: Duration = Duration::from_millis(60);
const LOOKS: usize = 20;

/// The thread that looks at the files. It ends when this is dropped.
#[derive(Debug)]
pub(super) struct Watcher {
    watched: Arc<Watched>,
}

impl Watcher {
    /// Starts the thread, which sleeps until there are files.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub(super) fn start(send: Send) -> io::Result<Watcher> {
        let watched = Arc::new(Watched::default());
        let theirs = Arc::clone(&watched);
        thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || theirs.look(&send))?;
        Ok(Watcher { watched })
    }

    /// Watches these files, and no others.
    pub(super) fn watch(&self, files: Vec<PathBuf>) {
        let mut list = self.watched.list();
        if list.files != files {
            list.files = files;
            self.watched.bell.notify_one();
        }
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        self.watched.list().is_closed = true;
        self.watched.bell.notify_one();
    }
}

#[derive(Debug, Default)]
struct Watched {
    list: Mutex<List>,
    bell: Condvar,
}

#[derive(Debug, Default)]
struct List {
    files: Vec<PathBuf>,
    is_closed: bool,
}

impl Watched {
    fn look(&self, send: &Send) {
        let mut seen: HashMap<PathBuf, Option<Mark>> = HashMap::new();
        while let Some(files) = self.next() {
            seen.retain(|file, _| files.contains(file));
            for file in files {
                let mark = Mark::of(&file);
                let before = seen.insert(file.clone(), mark);
                // A deleted file leaves nothing to read, and a new one may come in its place.
                let Some(mark) = mark.filter(|_| before != Some(mark)) else {
                    continue;
                };
                let settled = settled(&file, mark);
                seen.insert(file.clone(), settled);
                let found = store::load(&file);
                if settled.is_some() && !send(Action::FileChanged(file, found)) {
                    return;
                }
            }
        }
    }

    /// The files at the next look; `None` once the watcher is dropped.
    fn next(&self) -> Option<Vec<PathBuf>> {
        let mut list = self.list();
        let had_files = !list.files.is_empty();
        if had_files && !list.is_closed {
            let (next, _) = self
                .bell
                .wait_timeout(list, PERIOD)
                .unwrap_or_else(PoisonError::into_inner);
            list = next;
        }
        while list.files.is_empty() && !list.is_closed {
            list = self.bell.wait(list).unwrap_or_else(PoisonError::into_inner);
        }
        (!list.is_closed).then(|| list.files.clone())
    }

    fn list(&self) -> MutexGuard<'_, List> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What changes when a file is written: its time, its length, the file itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Mark {
    modified: SystemTime,
    length: u64,
    file: u64,
}

impl Mark {
    fn of(path: &Path) -> Option<Mark> {
        let metadata = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
        Some(Mark {
            modified: metadata.modified().ok()?,
            length: metadata.len(),
            file: number(&metadata),
        })
    }
}

#[cfg(unix)]
fn number(metadata: &fs::Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
fn number(_: &fs::Metadata) -> u64 {
    0
}

/// The mark of a file once nobody writes it any more.
fn settled(path: &Path, mark: Mark) -> Option<Mark> {
    let mut last = Some(mark);
    for _ in 0..LOOKS {
        thread::sleep(QUIET);
        let now = Mark::of(path);
        if now == last {
            break;
        }
        last = now;
    }
    last
}
