//! Waits for changes in the folders of the watched files without periodic wake-ups.

use std::collections::BTreeSet;
use std::path::PathBuf;

#[cfg(target_os = "linux")]
pub(crate) use linux::{Bell, Changes};
#[cfg(not(target_os = "linux"))]
pub(crate) use periodic::{Bell, Changes};

/// The watched places.
#[derive(Debug, Default)]
pub(crate) struct Places {
    /// Folders whose files are watched.
    pub(crate) folders: BTreeSet<PathBuf>,
    /// Folders and links that another folder or link may replace.
    pub(crate) parts: BTreeSet<PathBuf>,
}

#[cfg(target_os = "linux")]
mod linux {
    use std::collections::BTreeSet;
    use std::io;
    use std::os::fd::OwnedFd;
    use std::path::PathBuf;

    use rustix::event::{EventfdFlags, PollFd, PollFlags, eventfd, poll};
    use rustix::fs::inotify::{self, CreateFlags, WatchFlags};

    use super::Places;

    /// Ends a wait.
    #[derive(Debug)]
    pub(crate) struct Bell(OwnedFd);

    impl Bell {
        pub(crate) fn new() -> io::Result<Bell> {
            Ok(Bell(eventfd(0, EventfdFlags::CLOEXEC)?))
        }

        pub(crate) fn ring(&self) {
            // A full counter ends the wait as well.
            let _ = rustix::io::write(&self.0, &1_u64.to_ne_bytes());
        }
    }

    /// The changes that end a wait.
    #[derive(Debug)]
    pub(crate) struct Changes {
        inotify: OwnedFd,
        watches: BTreeSet<i32>,
    }

    impl Changes {
        pub(crate) fn new() -> io::Result<Changes> {
            Ok(Changes { inotify: inotify::init(CreateFlags::CLOEXEC)?, watches: BTreeSet::new() })
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

        /// Waits for a change in a folder, or for the bell.
        pub(crate) fn wait(&self, bell: &Bell) {
            let mut lines =
                [PollFd::new(&self.inotify, PollFlags::IN), PollFd::new(&bell.0, PollFlags::IN)];
            if poll(&mut lines, None).is_err() {
                return;
            }
            let ready = lines.map(|line| !line.revents().is_empty());
            let mut events = [0; 4096];
            if ready[0] {
                let _ = rustix::io::read(&self.inotify, &mut events);
            }
            if ready[1] {
                let _ = rustix::io::read(&bell.0, &mut events[..8]);
            }
        }
    }
}

#[cfg(not(target_os = "linux"))]
mod periodic {
    use std::io;
    use std::sync::{Condvar, Mutex, PoisonError};
    use std::time::Duration;

    /// Polling interval.
    const PERIOD: Duration = Duration::from_secs(1);

    /// Ends a wait.
    #[derive(Debug, Default)]
    pub(crate) struct Bell {
        rings: Mutex<bool>,
        condition: Condvar,
    }

    impl Bell {
        pub(crate) fn new() -> io::Result<Bell> {
            Ok(Bell::default())
        }

        pub(crate) fn ring(&self) {
            *self.rings.lock().unwrap_or_else(PoisonError::into_inner) = true;
            self.condition.notify_one();
        }
    }

    /// Without folder events, every wait ends after a second.
    #[derive(Debug)]
    pub(crate) struct Changes;

    impl Changes {
        pub(crate) fn new() -> io::Result<Changes> {
            Ok(Changes)
        }

        pub(crate) fn follow(&mut self, _: &super::Places) {}

        pub(crate) fn wait(&self, bell: &Bell) {
            let rings = bell.rings.lock();
            let rings = rings.unwrap_or_else(PoisonError::into_inner);
            let waited = bell.condition.wait_timeout_while(rings, PERIOD, |rings| !*rings);
            *waited.unwrap_or_else(PoisonError::into_inner).0 = false;
        }
    }
}
