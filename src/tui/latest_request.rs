//! A place for one request: whoever works takes it, and a later one stands in for one that was not
//! taken.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// The place.
#[derive(Debug)]
pub struct LatestRequest<T> {
    tray: Mutex<Tray<T>>,
    bell: Condvar,
}

#[derive(Debug)]
struct Tray<T> {
    request: Option<T>,
    /// What was taken is not wanted any more.
    is_stopped: bool,
    is_closed: bool,
}

impl<T> Default for LatestRequest<T> {
    fn default() -> LatestRequest<T> {
        LatestRequest {
            tray: Mutex::new(Tray {
                request: None,
                is_stopped: false,
                is_closed: false,
            }),
            bell: Condvar::new(),
        }
    }
}

impl<T> LatestRequest<T> {
    /// Ask, in place of a request that was not taken.
    pub fn put(&self, request: T) {
        self.tray().request = Some(request);
        self.bell.notify_one();
    }

    /// What was taken is not wanted any more; the next request is.
    pub fn stop(&self) {
        self.tray().is_stopped = true;
    }

    /// Nothing more is asked.
    pub fn close(&self) {
        self.tray().is_closed = true;
        self.bell.notify_one();
    }

    /// Sleep until something is asked, and take it; `None` once nothing more is.
    pub fn take(&self) -> Option<T> {
        let mut tray = self.tray();
        loop {
            if tray.is_closed {
                return None;
            }
            if let Some(request) = tray.request.take() {
                tray.is_stopped = false;
                return Some(request);
            }
            tray = self.bell.wait(tray).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Whether what was taken is still wanted: it is not stopped, and nothing later is asked.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        let tray = self.tray();
        tray.request.is_none() && !tray.is_stopped && !tray.is_closed
    }

    fn tray(&self) -> MutexGuard<'_, Tray<T>> {
        self.tray.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_request_is_taken_and_a_closed_place_gives_none() {
        let slot = LatestRequest::default();
        assert!(slot.is_idle());
        slot.put(1);
        slot.put(2);
        assert!(!slot.is_idle());
        assert_eq!(slot.take(), Some(2));
        assert!(slot.is_idle());
        slot.stop();
        assert!(!slot.is_idle());
        slot.put(4);
        assert_eq!((slot.take(), slot.is_idle()), (Some(4), true));
        slot.put(3);
        slot.close();
        assert_eq!((slot.take(), slot.is_idle()), (None, false));
    }
}
