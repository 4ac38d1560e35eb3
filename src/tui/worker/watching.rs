//! Watches the files of the open cases for changes by other programs.

use std::cell::RefCell;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{self, Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, SystemTime};

use super::Send;
use crate::system::changes::{Changes, Places};
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
    /// Sends the files to watch, or a change of any.
    sender: Arc<Sender<Option<Vec<WatchedFile>>>>,
    files: RefCell<Vec<WatchedFile>>,
}

impl Watcher {
    /// Starts the thread, which sleeps until a file changes.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread or has no means to wait.
    pub(super) fn start(send: Send) -> io::Result<Watcher> {
        let (sender, messages) = channel();
        let sender = Arc::new(sender);
        let bell = Arc::downgrade(&sender);
        let changes =
            Changes::start(move || bell.upgrade().is_some_and(|bell| bell.send(None).is_ok()))?;
        thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || look(&messages, changes, &send))?;
        Ok(Watcher { sender, files: RefCell::default() })
    }

    /// Watches these files and no others.
    pub(super) fn watch(&self, files: Vec<WatchedFile>) {
        if *self.files.borrow() != files {
            self.files.replace(files.clone());
            // Without the thread nothing is watched.
            let _ = self.sender.send(Some(files));
        }
    }
}

fn look(messages: &Receiver<Option<Vec<WatchedFile>>>, mut changes: Changes, send: &Send) {
    let (mut files, mut seen) = (Vec::new(), HashMap::<PathBuf, Option<Mark>>::new());
    while let Ok(message) = messages.recv() {
        files = message.unwrap_or(files);
        seen.retain(|path, _| files.iter().any(|file| file.path == *path));
        changes.follow(&places(&files));
        for file in &files {
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
            if is_news && !send(Action::FileChanged(file.path.clone(), found)) {
                return;
            }
        }
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
