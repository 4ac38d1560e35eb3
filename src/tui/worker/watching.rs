//! Watches the files of the open cases for changes by other programs.

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{self, Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use super::Send;
use crate::system::changes::{Bell, Changes, Places};
use crate::system::files;
use crate::tui::app::actions::Action;
use crate::tui::store::{self, WatchedFile};

/// A file is read once its mark has not changed for this time, or after [`LOOKS`] checks.
const QUIET: Duration = Duration::from_millis(60);
const LOOKS: usize = 20;
/// Greatest number of symbolic links to follow.
const MOST_LINKS: usize = 40;

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
        let watched = Arc::new(Watched { list: Mutex::default(), bell: Bell::new()? });
        let theirs = Arc::clone(&watched);
        thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || theirs.look(&mut changes, &send))?;
        Ok(Watcher { watched })
    }

    /// Watches these files and no others.
    pub(super) fn watch(&self, files: Vec<WatchedFile>) {
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
    files: Vec<WatchedFile>,
    is_closed: bool,
}

impl Watched {
    fn look(&self, changes: &mut Changes, send: &Send) {
        let mut seen: HashMap<PathBuf, Option<Mark>> = HashMap::new();
        while let Some(files) = self.files() {
            seen.retain(|path, _| files.iter().any(|file| file.path == *path));
            changes.follow(&places(&files));
            for file in files {
                let mark = Mark::of(&file.path);
                let before = seen.insert(file.path.clone(), mark);
                // A deleted file has no content; a new file may replace it.
                let Some(mark) = mark.filter(|_| before != Some(mark)) else {
                    continue;
                };
                let settled = settled(&file.path, mark);
                seen.insert(file.path.clone(), settled);
                let found = store::load(&file.path);
                // A later change may restore the known content.
                let is_first = before.is_none();
                let is_known = matches!(&found, Ok(document) if file.is_of(document));
                let is_news = settled.is_some() && !(is_first && is_known);
                if is_news && !send(Action::FileChanged(file.path, found)) {
                    return;
                }
            }
            changes.wait(&self.bell);
        }
    }

    /// The files; `None` once the watcher is dropped.
    fn files(&self) -> Option<Vec<WatchedFile>> {
        let list = self.list();
        (!list.is_closed).then(|| list.files.clone())
    }

    fn list(&self) -> MutexGuard<'_, List> {
        self.list.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The places whose changes may change the content of the files.
fn places(files: &[WatchedFile]) -> Places {
    let mut places = Places::default();
    for file in files {
        let mut next = path::absolute(&file.path).ok();
        for _ in 0..MOST_LINKS {
            let Some(path) = next else { break };
            let above = || path.ancestors().skip(1).map(Path::to_owned);
            // A missing folder may appear again.
            places.folders.extend(above().find(|folder| folder.is_dir()));
            places.parts.extend(above());
            next = fs::read_link(&path).ok().and_then(|target| Some(path.parent()?.join(target)));
        }
        places.parts.extend(file.target.ancestors().skip(1).map(Path::to_owned));
    }
    places
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
