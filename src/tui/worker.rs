//! Threads beside the loop: the solver, the watcher of files, and one for each kind of work.

pub(crate) mod solving;
mod watching;

use std::collections::BTreeMap;
use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::app::actions::{Action, Work};
use super::jobs::Slot;
use super::solver::Request;
use super::store::WatchedFile;

use watching::Watcher;

/// The worker threads. The solver and the file watcher start at once, the others with their first
/// work.
pub struct Workers {
    send: Send,
    solver: Worker<Request>,
    others: BTreeMap<Slot, Worker<(u64, Work)>>,
    watcher: Watcher,
}

impl Workers {
    /// Starts the solver and the watcher of files.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(send: Send) -> io::Result<Workers> {
        Ok(Workers {
            solver: solving::start(Send::clone(&send))?,
            others: BTreeMap::new(),
            watcher: Watcher::start(Send::clone(&send))?,
            send,
        })
    }

    /// Requests a solve; replaces a waiting request.
    pub(crate) fn solve(&self, request: Request) {
        self.solver.request(request);
    }

    /// Stops the running solve. A waiting request still runs.
    pub(crate) fn stop_solve(&self) {
        self.solver.stop_running();
    }

    /// Watches these files for changes by other programs.
    pub(super) fn watch(&self, files: Vec<WatchedFile>) {
        self.watcher.watch(files);
    }

    /// Runs work with a number; it replaces other work of its slot.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn work(&mut self, number: u64, work: Work) -> io::Result<()> {
        let slot = work.slot;
        if !self.others.contains_key(&slot) {
            let send = Send::clone(&self.send);
            let worker =
                Worker::start(&slot.to_string(), send, |(number, work), is_wanted, send| {
                    Work::run(work, number, is_wanted, send);
                })?;
            self.others.insert(slot, worker);
        }
        self.others[&slot].request((number, work));
        Ok(())
    }

    /// Stops the work of a slot.
    pub(crate) fn cancel(&self, slot: Slot) {
        if let Some(worker) = self.others.get(&slot) {
            worker.stop();
        }
    }
}

/// Sends an action to the workbench. Returns false once the receiver is closed.
pub(crate) type Send = Arc<dyn Fn(Action) -> bool + std::marker::Send + Sync>;

/// The thread; dropping this ends the thread.
#[derive(Debug)]
pub(crate) struct Worker<R> {
    requests: Arc<LatestRequest<R>>,
}

impl<R: std::marker::Send + 'static> Worker<R> {
    /// Starts the thread. `work` serves a request while it is wanted, and sends its results.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn start(
        name: &str,
        send: Send,
        mut work: impl FnMut(R, &dyn Fn() -> bool, &dyn Fn(Action)) + std::marker::Send + 'static,
    ) -> io::Result<Worker<R>> {
        let requests = Arc::new(LatestRequest::default());
        let theirs: Arc<LatestRequest<R>> = Arc::clone(&requests);
        let serve = move || {
            let send = |action| {
                if !send(action) {
                    theirs.close();
                }
            };
            while let Some(request) = theirs.take() {
                work(request, &|| theirs.is_wanted(), &send);
            }
        };
        thread::Builder::new().name(name.to_owned()).spawn(serve)?;
        Ok(Worker { requests })
    }

    /// Requests work; replaces a waiting request.
    pub(crate) fn request(&self, request: R) {
        self.requests.put(request);
    }

    /// Stops the running request. A waiting request still runs.
    pub(crate) fn stop_running(&self) {
        self.requests.state().is_stopped = true;
    }

    /// Stops the running request and drops a waiting one.
    pub(crate) fn stop(&self) {
        let mut state = self.requests.state();
        (state.is_stopped, state.next) = (true, None);
    }
}

impl<R> Drop for Worker<R> {
    fn drop(&mut self) {
        self.requests.close();
    }
}

/// Panics or blocks forever if a test requests a fault at this place.
#[cfg(debug_assertions)]
#[expect(clippy::panic, reason = "a test requests the fault")]
pub(super) fn on_demand(place: &str) {
    match std::env::var("TIPSTRIKE_FAULT").unwrap_or_default() {
        asked if asked == place => panic!("a fault on demand"),
        asked if asked.strip_prefix("stuck ") == Some(place) => loop {
            std::thread::park();
        },
        _ => {}
    }
}

/// Does nothing.
#[cfg(not(debug_assertions))]
pub(super) fn on_demand(_place: &str) {}

#[derive(Debug)]
struct LatestRequest<R> {
    state: Mutex<RequestState<R>>,
    bell: Condvar,
}

#[derive(Debug)]
struct RequestState<R> {
    next: Option<R>,
    /// Whether the running request is no longer wanted.
    is_stopped: bool,
    is_closed: bool,
}

impl<R> Default for LatestRequest<R> {
    fn default() -> LatestRequest<R> {
        LatestRequest {
            state: Mutex::new(RequestState { next: None, is_stopped: false, is_closed: false }),
            bell: Condvar::new(),
        }
    }
}

impl<R> LatestRequest<R> {
    fn put(&self, request: R) {
        self.state().next = Some(request);
        self.bell.notify_one();
    }

    fn close(&self) {
        self.state().is_closed = true;
        self.bell.notify_one();
    }

    // Sleeps until there is a request; `None` at the end.
    fn take(&self) -> Option<R> {
        let mut state = self.state();
        loop {
            if state.is_closed {
                return None;
            }
            if let Some(request) = state.next.take() {
                state.is_stopped = false;
                return Some(request);
            }
            state = self.bell.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn is_wanted(&self) -> bool {
        let state = self.state();
        state.next.is_none() && !state.is_stopped && !state.is_closed
    }

    fn state(&self) -> MutexGuard<'_, RequestState<R>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::{Receiver, Sender, channel};

    use super::*;

    /// A worker that starts each request when the test permits, and sends its number back if it is
    /// wanted.
    fn worker() -> (Worker<u64>, Receiver<u64>, Sender<()>, Receiver<Action>) {
        let (begun, has_begun) = channel();
        let (go, gate) = channel::<()>();
        let (sender, actions) = channel();
        let work = move |request: u64, is_wanted: &dyn Fn() -> bool, send: &dyn Fn(Action)| {
            begun.send(request).expect("the test listens");
            gate.recv().expect("the test goes on");
            if is_wanted() {
                send(Action::Solving(request, 1.0));
            }
        };
        let send: Send = Arc::new(move |action| sender.send(action).is_ok());
        let worker = Worker::start("test", send, work).expect("a thread");
        (worker, has_begun, go, actions)
    }

    fn is_answer(action: &Action, to: u64) -> bool {
        matches!(action, Action::Solving(request, _) if *request == to)
    }

    #[test]
    fn the_latest_request_wins() {
        let (worker, has_begun, go, actions) = worker();
        worker.request(1);
        assert_eq!(has_begun.recv(), Ok(1));
        (2..=9).for_each(|request| worker.request(request));
        (0..2).for_each(|_| go.send(()).expect("the worker listens"));
        assert_eq!(has_begun.recv(), Ok(9));
        assert!(is_answer(&actions.recv().expect("an answer"), 9));
    }

    #[test]
    fn a_stop_ends_the_running_request_and_optionally_the_waiting_one() {
        let (worker, has_begun, go, actions) = worker();
        worker.request(1);
        assert_eq!(has_begun.recv(), Ok(1));
        worker.request(2);
        worker.stop_running();
        (0..2).for_each(|_| go.send(()).expect("the worker listens"));
        assert!(is_answer(&actions.recv().expect("an answer"), 2));
        worker.request(3);
        assert_eq!((has_begun.recv(), has_begun.recv()), (Ok(2), Ok(3)));
        worker.request(4);
        worker.stop();
        worker.request(5);
        (0..2).for_each(|_| go.send(()).expect("the worker listens"));
        assert_eq!(has_begun.recv(), Ok(5));
        assert!(is_answer(&actions.recv().expect("an answer"), 5));
    }

    #[test]
    fn work_that_panics_sends_its_fault_and_its_end() {
        let (sender, actions) = channel();
        let send: Send = Arc::new(move |action| sender.send(action).is_ok());
        let mut workers = Workers::start(send).expect("threads");
        for (number, panics) in [(1, true), (2, false)] {
            let work = Work::in_steps(Slot::Folder, move |_| assert!(!panics, "planted"));
            workers.work(number, work).expect("a thread");
            let mut sent = actions.recv().expect("an action");
            if panics {
                assert!(matches!(sent, Action::Worked(Slot::Folder, 1, _)), "{sent:?}");
                sent = actions.recv().expect("an action");
            }
            assert!(matches!(sent, Action::WorkEnded(Slot::Folder, of) if of == number));
        }
    }
}
