//! Threads beside the loop: the solver, whose slow requests a later one interrupts, the watcher of files,
//! and one thread for each kind of work.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{self, Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use super::app::actions::{Action, Slot, Work};
use super::solver::{Answer, PATIENCE, Request, cleared, solved, with_stiffness};
use super::store::{self, WatchedFile};
use crate::case::Evaluator;
use crate::model::Stage;
use crate::system::changes::{Changes, Places};
use crate::system::files;

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
            solver: start_solver(Send::clone(&send))?,
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

/// A solve that takes longer shows its progress.
const LONG: Duration = Duration::from_millis(400);
/// Time between two reports of the progress.
const PROGRESS_STEP: Duration = Duration::from_millis(200);

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
fn start_solver(send: Send) -> io::Result<Worker<Request>> {
    let mut evaluator = Evaluator::default();
    Worker::start("solver", send, move |request: Request, is_wanted, send| {
        let found = catch_unwind(AssertUnwindSafe(|| {
            on_demand("solver");
            solve(&mut evaluator, &request, is_wanted, send)
        }));
        match found {
            Ok(Some(answer)) => send(Action::Solved(Box::new(answer))),
            Ok(None) => (),
            Err(_) => send(Action::SolverFailed(request.serial)),
        }
    })
}

// Sends intermediate answers of a slow solve and returns the last one.
fn solve(
    evaluator: &mut Evaluator,
    request: &Request,
    is_wanted: &dyn Fn() -> bool,
    send: &dyn Fn(Action),
) -> Option<Answer> {
    let begun = Instant::now();
    let (waiting, next_progress) = (Cell::new(Some(begun + PATIENCE)), Cell::new(begun + LONG));
    let go_on = |part: f64, at_once: &dyn Fn() -> Answer| {
        let now = Instant::now();
        if waiting.get().is_some_and(|until| now > until) {
            waiting.set(None);
            send(Action::Solved(Box::new(at_once())));
        } else if now > next_progress.get() {
            next_progress.set(now + PROGRESS_STEP);
            send(Action::Solving(request.serial, part));
        }
        is_wanted()
    };
    let answer = solved(evaluator, request, begun, &go_on)?;
    if request.stiffness {
        // The elastic fields of new gears are slow, and the results must not wait for them.
        send(Action::Solved(Box::new(answer.clone())));
        if !is_wanted() {
            return None;
        }
    }
    let mut answer = with_stiffness(request, answer);
    // The other results do not wait for the motion over the speed.
    let has_speeds = answer.active.stages().has(Stage::SpeedRun);
    let first = has_speeds.then(|| request.stages.without(Stage::SpeedRun));
    for stages in first.into_iter().chain([request.stages]) {
        if answer.stages.covers(stages) || answer.refusal().is_some() {
            continue;
        }
        send(Action::Solved(Box::new(answer.clone())));
        let request = Request { stages, ..request.clone() };
        answer = cleared(evaluator, &request, answer, begun, &|_| is_wanted())?;
    }
    Some(Answer { stages: request.stages, ..answer })
}

/// A file is read once its mark has not changed for this time, or after [`LOOKS`] checks.
const QUIET: Duration = Duration::from_millis(60);
const LOOKS: usize = 20;
/// Greatest number of symbolic links to follow.
const MOST_LINKS: usize = 40;

/// The thread that watches the files; dropping this ends the thread.
#[derive(Debug)]
struct Watcher {
    /// Sends the files to watch, or a change of any.
    sender: Arc<Sender<Option<Vec<WatchedFile>>>>,
    files: RefCell<Vec<WatchedFile>>,
}

impl Watcher {
    /// Starts the thread, which sleeps until a file changes.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread or has no means to wait.
    fn start(send: Send) -> io::Result<Watcher> {
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
    fn watch(&self, files: Vec<WatchedFile>) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::model::Stages;
    use crate::model::inputs::Method;

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

    fn request(serial: u64) -> Request {
        let case = Case::table_1();
        Request {
            serial,
            inputs: case.inputs().expect("Table 1 is valid"),
            case,
            stages: Stages::EVERY,
            stiffness: false,
        }
    }

    fn started() -> (Worker<Request>, Receiver<Action>) {
        let (sender, actions) = channel();
        let worker = start_solver(Arc::new(move |action| sender.send(action).is_ok()));
        (worker.expect("a thread"), actions)
    }

    #[test]
    fn a_later_request_interrupts_a_slow_method_which_shows_the_closed_form() {
        let (solver, replies) = started();
        let mut slow = request(1);
        (slow.inputs.method, slow.inputs.tolerance, slow.inputs.warmup_cycles) =
            (Method::Dynamic, 1e-12, 10_000);
        // Without damping the motion never becomes steady.
        slow.inputs.damping_ratio = 0.0;
        solver.request(slow);
        let first = replies.recv().expect("an answer");
        assert!(
            matches!(&first, Action::Solved(answer) if answer.pending == Some(Method::Dynamic) && answer.active == Method::Exact)
        );
        solver.request(request(2));
        let second = replies.recv().expect("an answer");
        assert!(
            matches!(&second, Action::Solved(answer) if answer.serial == 2 && answer.pending.is_none()),
            "{second:?}"
        );
    }

    #[test]
    fn the_required_relief_follows_an_answer_that_is_already_shown() {
        let (solver, replies) = started();
        for (serial, method, expected) in [
            (1, Method::Exact, vec![true]),
            (2, Method::Static, vec![false, true]),
            (3, Method::Auto, vec![false, true]),
        ] {
            let mut asked = request(serial);
            asked.inputs.method = method;
            solver.request(asked);
            let mut found = Vec::new();
            while found.last() != Some(&true) {
                let Ok(Action::Solved(answer)) = replies.recv() else {
                    continue;
                };
                // A surplus answer to the previous request would fail here.
                assert_eq!(answer.serial, serial);
                let clearing = answer.of(answer.active).and_then(|solution| solution.clearing);
                if answer.pending.is_none() {
                    assert_eq!(clearing.is_none(), answer.lacks(Stage::Clearing));
                    found.push(clearing.is_some_and(|clearing| clearing.relief.is_some()));
                }
            }
            assert_eq!(found, expected, "{}", method.name());
        }
    }

    #[test]
    fn the_relief_at_rest_is_present_during_the_search_in_motion() {
        let (solver, replies) = started();
        let mut asked = request(1);
        asked.inputs.method = Method::Dynamic;
        solver.request(asked);
        let first = replies.iter().find_map(|reply| match reply {
            Action::Solved(answer) if answer.pending.is_none() => Some(answer),
            _ => None,
        });
        let answer = first.expect("an answer");
        let relief = |method| answer.of(method).and_then(|solution| solution.clearing);
        assert!(answer.lacks(Stage::Clearing) && relief(Method::Dynamic).is_none());
        assert!(relief(Method::Static).is_some_and(|clearing| clearing.relief.is_some()));
    }
}
