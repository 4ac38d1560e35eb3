//! Watches the files of the open cases for changes by other programs.

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use crate::system::changes::{Bell, Changes};
use crate::system::files;

use super::latest::Send;
use crate::case::stamp::Stamp;
use crate::tui::actions::Action;
use crate::tui::store;

/// A file is read once its mark has not changed for this time, or after [`LOOKS`] checks.
const QUIET: Duration = Duration::from_millis(60);
const LOOKS: usize = 20;

/// The thread that watches the files; dropping this ends the thread.
#[derive(Debug)]
pub(super) struct Watcher {
    watched: Arc<Watched>,
}

impl Watcher {
    /// Starts the thread, which sleeps until a file changes.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread or has no means to wait.
    pub(super) fn start(send: Send) -> io::Result<Watcher> {
        let mut changes = Changes::new()?;
        let watched = Arc::new(Watched {
            list: Mutex::default(),
            bell: Bell::new()?,
        });
        let theirs = Arc::clone(&watched);
        thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || theirs.look(&mut changes, &send))?;
        Ok(Watcher { watched })
    }

    /// Watches these files, each with the stamp of its known text, and no others.
    pub(super) fn watch(&self, files: Vec<(PathBuf, Stamp)>) {
        let mut list = self.watched.list();
        if list.files != files {
            list.files = files;
            self.watched.bell.ring();
        }
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        self.watched.list().is_closed = true;
        self.watched.bell.ring();
    }
}

#[derive(Debug)]
struct Watched {
    list: Mutex<List>,
    bell: Bell,
}

#[derive(Debug, Default)]
struct List {
    files: Vec<(PathBuf, Stamp)>,
    is_closed: bool,
}

impl Watched {
    fn look(&self, changes: &mut Changes, send: &Send) {
        let mut seen: HashMap<PathBuf, Option<Mark>> = HashMap::new();
        while let Some(files) = self.files() {
            seen.retain(|file, _| files.iter().any(|(path, _)| path == file));
            changes.follow(&folders(&files));
            for (file, known) in files {
                let mark = Mark::of(&file);
                let before = seen.insert(file.clone(), mark);
                // A deleted file has no content; a new file may replace it.
                let Some(mark) = mark.filter(|_| before != Some(mark)) else {
                    continue;
                };
                let settled = settled(&file, mark);
                seen.insert(file.clone(), settled);
                let found = store::load(&file);
                let is_known = matches!(&found, Ok(document) if document.stamp() == known);
                let is_news = settled.is_some() && !is_known;
                if is_news && !send(Action::FileChanged(file, found)) {
                    return;
                }
            }
            changes.wait(&self.bell);
        }
    }

    /// The files; `None` once the watcher is dropped.
    fn files(&self) -> Option<Vec<(PathBuf, Stamp)>> {
        let list = self.list();
        (!list.is_closed).then(|| list.files.clone())
    }

    fn list(&self) -> MutexGuard<'_, List> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The folders of the files and of the targets of links.
fn folders(files: &[(PathBuf, Stamp)]) -> BTreeSet<PathBuf> {
    let parent = |path: &Path| {
        let parent = path.parent()?;
        let is_here = parent.as_os_str().is_empty();
        Some(if is_here { Path::new(".") } else { parent }.to_owned())
    };
    let target = |path: &PathBuf| fs::canonicalize(path).ok().and_then(|path| parent(&path));
    let both = files
        .iter()
        .flat_map(|(path, _)| [parent(path), target(path)]);
    both.flatten().collect()
}

/// Properties that change when a file is written: its time, its length, the file itself.
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
            file: files::number(&metadata),
        })
    }
}

/// The mark of a file once no program writes it any more.
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
