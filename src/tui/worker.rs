//! Long work, each kind in its own thread: solving, the benchmark, studies, charts and jobs.

pub(crate) mod jobs;
pub(crate) mod solving;
pub(crate) mod studying;
mod watching;

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use super::actions::Action;
use super::jobs::{ChartRequest, Job, Measuring};
use super::solver::Request;
use super::store::WatchedFile;
use super::study::StudyRequest;

use watching::Watcher;

/// The worker threads. The solver and the file watcher start at once, the others with their first
/// request.
pub struct Workers {
    send: Send,
    solver: Worker<Request>,
    benchmark: Option<Worker<Measuring>>,
    study: Option<Worker<StudyRequest>>,
    charts: Option<Worker<ChartRequest>>,
    jobs: [Option<Worker<Job>>; Job::KINDS],
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
            benchmark: None,
            study: None,
            charts: None,
            jobs: [const { None }; Job::KINDS],
            watcher: Watcher::start(Send::clone(&send))?,
            send,
        })
    }

    /// Requests a solve; replaces a waiting request.
    pub(crate) fn solve(&self, request: Request) {
        self.solver.request(request);
    }

    /// Stops the running solve.
    pub(crate) fn stop_solve(&self) {
        self.solver.stop_running();
    }

    /// Watches these files for changes by other programs.
    pub(super) fn watch(&self, files: Vec<WatchedFile>) {
        self.watcher.watch(files);
    }

    /// Requests a benchmark; replaces the running one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn measure(&mut self, measuring: Measuring) -> io::Result<()> {
        let worker = match &self.benchmark {
            Some(worker) => worker,
            None => self.benchmark.insert(studying::start_benchmark(Send::clone(&self.send))?),
        };
        worker.request(measuring);
        Ok(())
    }

    /// Requests a study; replaces the running one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn study(&mut self, request: StudyRequest) -> io::Result<()> {
        let worker = match &self.study {
            Some(worker) => worker,
            None => self.study.insert(studying::start(Send::clone(&self.send))?),
        };
        worker.request(request);
        Ok(())
    }

    /// Requests a chart; replaces the running one.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn chart(&mut self, request: ChartRequest) -> io::Result<()> {
        let worker = match &self.charts {
            Some(worker) => worker,
            None => self.charts.insert(studying::start_charts(Send::clone(&self.send))?),
        };
        worker.request(request);
        Ok(())
    }

    pub(crate) fn stop_chart(&self) {
        self.charts.iter().for_each(Worker::stop);
    }

    pub(crate) fn stop_relief(&self) {
        self.jobs[Job::RELIEF].iter().for_each(Worker::stop);
    }

    pub(crate) fn stop_study(&self) {
        self.study.iter().for_each(Worker::stop);
    }

    pub(crate) fn stop_benchmark(&self) {
        self.benchmark.iter().for_each(Worker::stop);
    }

    /// Requests a job; replaces a waiting job of its kind.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn job(&mut self, job: Job) -> io::Result<()> {
        let (kind, name) = job.kind();
        let worker = match &self.jobs[kind] {
            Some(worker) => worker,
            None => self.jobs[kind].insert(jobs::start(name, Send::clone(&self.send))?),
        };
        worker.request(job);
        Ok(())
    }
}

/// Sends an action to the workbench. Returns false once the receiver is closed.
pub(crate) type Send = Arc<dyn Fn(Action) -> bool + std::marker::Send + Sync>;

/// The thread; dropping this ends the thread.
#[derive(Debug)]
pub(crate) struct Worker<R> {
    requests: Arc<LatestRequest<R>>,
}

/// The running request, for the work.
#[derive(Clone, Copy)]
pub struct Running<'a> {
    /// Returns whether the request is still wanted: nobody has stopped it, and there is no later
    /// request.
    pub is_wanted: &'a dyn Fn() -> bool,
    /// Sends an action, such as an intermediate result.
    pub send: &'a dyn Fn(Action),
}

impl<R: std::marker::Send + 'static> Worker<R> {
    /// Starts the thread. `work` serves a request and sends its results. If `work` panics, the
    /// thread sends the action of `failed`.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub(crate) fn start(
        name: &'static str,
        send: Send,
        mut work: impl FnMut(&R, Running<'_>) + std::marker::Send + 'static,
        failed: fn(&R) -> Action,
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
                let running = Running { is_wanted: &|| theirs.is_wanted(), send: &send };
                let done = catch_unwind(AssertUnwindSafe(|| {
                    on_demand(name);
                    work(&request, running);
                }));
                if done.is_err() {
                    send(failed(&request));
                }
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

    /// Stops every request so far. A waiting request still starts, but is not wanted.
    pub(crate) fn stop(&self) {
        let mut state = self.requests.state();
        (state.is_stopped, state.is_next_stopped) = (true, true);
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
    is_next_stopped: bool,
    /// Whether the running request is no longer wanted.
    is_stopped: bool,
    is_closed: bool,
}

impl<R> Default for LatestRequest<R> {
    fn default() -> LatestRequest<R> {
        LatestRequest {
            state: Mutex::new(RequestState {
                next: None,
                is_next_stopped: false,
                is_stopped: false,
                is_closed: false,
            }),
            bell: Condvar::new(),
        }
    }
}

impl<R> LatestRequest<R> {
    fn put(&self, request: R) {
        let mut state = self.state();
        (state.next, state.is_next_stopped) = (Some(request), false);
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
                state.is_stopped = state.is_next_stopped;
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
    /// wanted. Request 0 panics.
    fn worker() -> (Worker<u64>, Receiver<u64>, Sender<()>, Receiver<Action>) {
        let (begun, has_begun) = channel();
        let (go, gate) = channel::<()>();
        let (sender, actions) = channel();
        let work = move |request: &u64, running: Running<'_>| {
            begun.send(*request).expect("the test listens");
            gate.recv().expect("the test goes on");
            assert!(*request != 0, "planted");
            if (running.is_wanted)() {
                (running.send)(Action::Solving(*request, 1.0));
            }
        };
        let send: Send = Arc::new(move |action| sender.send(action).is_ok());
        let failed = |_: &u64| Action::SolverFailed(0);
        let worker = Worker::start("test", send, work, failed).expect("a thread");
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
    fn a_panic_is_reported_and_the_next_request_is_served() {
        let (worker, _begun, go, actions) = worker();
        for (request, is_expected) in [(0, false), (2, true)] {
            worker.request(request);
            go.send(()).expect("the worker listens");
            let action = actions.recv().expect("an answer");
            assert_eq!(is_answer(&action, 2), is_expected);
            assert_eq!(matches!(action, Action::SolverFailed(0)), !is_expected);
        }
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
        (0..2).for_each(|_| go.send(()).expect("the worker listens"));
        assert_eq!(has_begun.recv(), Ok(4));
        worker.request(5);
        go.send(()).expect("the worker listens");
        assert!(is_answer(&actions.recv().expect("an answer"), 5));
    }
}
