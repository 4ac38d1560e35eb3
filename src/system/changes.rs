//! Reports changes in the folders of the watched files, on Linux without periodic wake-ups.

use std::collections::BTreeSet;
use std::io;
use std::path::PathBuf;
use std::thread;

/// The watched places.
#[derive(Debug, Default)]
pub(crate) struct Places {
    /// Folders whose files are watched.
    pub(crate) folders: BTreeSet<PathBuf>,
    /// Folders and links that another folder or link may replace.
    pub(crate) parts: BTreeSet<PathBuf>,
}

#[cfg(target_os = "linux")]
pub(crate) use linux::Changes;
#[cfg(not(target_os = "linux"))]
pub(crate) use periodic::Changes;

/// Starts a thread that runs `wait` and `report` until one of them returns false.
fn start(
    mut wait: impl FnMut() -> bool + Send + 'static,
    report: impl Fn() -> bool + Send + 'static,
) -> io::Result<()> {
    let repeat = move || while wait() && report() {};
    thread::Builder::new().name("changes".to_owned()).spawn(repeat).map(drop)
}

#[cfg(target_os = "linux")]
mod linux {
    use std::collections::BTreeSet;
    use std::io;
    use std::os::fd::OwnedFd;
    use std::path::PathBuf;
    use std::sync::Arc;

    use rustix::fs::inotify::{self, CreateFlags, WatchFlags};
    use rustix::io::{read, retry_on_intr};

    use super::Places;

    /// The watched places.
    #[derive(Debug)]
    pub(crate) struct Changes {
        inotify: Arc<OwnedFd>,
        watches: BTreeSet<i32>,
    }

    impl Changes {
        /// Runs `report` after each change, in a thread, until it returns false.
        pub(crate) fn start(report: impl Fn() -> bool + Send + 'static) -> io::Result<Changes> {
            let inotify = Arc::new(inotify::init(CreateFlags::CLOEXEC)?);
            let events = Arc::clone(&inotify);
            let wait = move || retry_on_intr(|| read(&events, &mut [0; 4096])).is_ok();
            super::start(wait, report)?;
            Ok(Changes { inotify, watches: BTreeSet::new() })
        }

        /// Watches these places and no others. Skips a place that cannot be watched.
        pub(crate) fn follow(&mut self, places: &Places) {
            let content = WatchFlags::CLOSE_WRITE | WatchFlags::MOVED_TO | WatchFlags::CREATE;
            // Of a link itself, not of its target.
            let place = WatchFlags::MOVE_SELF | WatchFlags::DELETE_SELF | WatchFlags::DONT_FOLLOW;
            // A path that leads to another folder than before gets a new watch.
            let watch = |path: &PathBuf, events| {
                inotify::add_watch(&self.inotify, path, events | WatchFlags::MASK_ADD).ok()
            };
            let folders = places.folders.iter().filter_map(|path| watch(path, content));
            let parts = places.parts.iter().filter_map(|path| watch(path, place));
            let watches = folders.chain(parts).collect();
            for &unused in self.watches.difference(&watches) {
                // The folder may be deleted, and its watch with it.
                let _ = inotify::remove_watch(&self.inotify, unused);
            }
            self.watches = watches;
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod periodic {
    use std::io;
    use std::thread;
    use std::time::Duration;

    /// Polling interval.
    const PERIOD: Duration = Duration::from_secs(1);

    /// Without folder events, every second counts as a change.
    #[derive(Debug)]
    pub(crate) struct Changes;

    impl Changes {
        pub(crate) fn start(report: impl Fn() -> bool + Send + 'static) -> io::Result<Changes> {
            let wait = || {
                thread::sleep(PERIOD);
                true
            };
            super::start(wait, report)?;
            Ok(Changes)
        }

        pub(crate) fn follow(&mut self, _: &super::Places) {}
    }
}
