//! Threads beside the loop: the solver, whose slow requests a later one interrupts, the watcher of files,
//! and one thread for each kind of work.

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{self, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::SeqCst};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use super::app::actions::{Action, Slot, Work};
use super::solver::{Answer, Request, solve};
use super::store::{self, WatchedFile};
use crate::case::Evaluator;
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

/// A thread in which the latest request wins; dropping this ends the thread.
struct Worker<R> {
    requests: Sender<(u64, R)>,
    /// The number of the last request.
    last: AtomicU64,
    numbers: Arc<Numbers>,
}

#[derive(Default)]
struct Numbers {
    /// The request whose results are wanted; 0 if there is none.
    wanted: AtomicU64,
    /// The running request.
    begun: AtomicU64,
}

impl<R: std::marker::Send + 'static> Worker<R> {
    /// Starts the thread. `work` serves a request while it is wanted, and sends its results.
    fn start(
        name: &str,
        send: Send,
        mut work: impl FnMut(R, &dyn Fn() -> bool, &dyn Fn(Action)) + std::marker::Send + 'static,
    ) -> io::Result<Worker<R>> {
        let (requests, received) = channel::<(u64, R)>();
        let numbers = Arc::<Numbers>::default();
        let theirs = Arc::clone(&numbers);
        let serve = move || {
            for (number, request) in received {
                let is_wanted = || theirs.wanted.load(SeqCst) == number;
                theirs.begun.store(number, SeqCst);
                if is_wanted() {
                    // Without a receiver the workbench has ended, and its process ends soon.
                    work(request, &is_wanted, &|action| {
                        send(action);
                    });
                }
            }
        };
        thread::Builder::new().name(name.to_owned()).spawn(serve)?;
        Ok(Worker { requests, last: AtomicU64::new(0), numbers })
    }
}

impl<R> Worker<R> {
    /// Requests work; replaces a waiting request.
    fn request(&self, request: R) {
        let number = self.last.fetch_add(1, SeqCst) + 1;
        self.numbers.wanted.store(number, SeqCst);
        let _ = self.requests.send((number, request));
    }

    /// Stops the running request. A waiting request still runs.
    fn stop_running(&self) {
        let running = self.numbers.begun.load(SeqCst);
        let _ = self.numbers.wanted.compare_exchange(running, 0, SeqCst, SeqCst);
    }

    /// Stops the running request and drops a waiting one.
    fn stop(&self) {
        self.numbers.wanted.store(0, SeqCst);
    }
}

impl<R> Drop for Worker<R> {
    fn drop(&mut self) {
        self.stop();
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

/// A solve that takes longer shows its progress.
const LONG: Duration = Duration::from_millis(400);
/// Time between two reports of the progress.
const PROGRESS_STEP: Duration = Duration::from_millis(200);

fn start_solver(send: Send) -> io::Result<Worker<Request>> {
    let mut evaluator = Evaluator::default();
    Worker::start("solver", send, move |request: Request, is_wanted, send| {
        let show = |answer: &Answer| send(Action::Solved(Box::new(answer.clone())));
        let next = Cell::new(Instant::now() + LONG);
        let go_on = |part| {
            let now = Instant::now();
            if now > next.get() {
                next.set(now + PROGRESS_STEP);
                send(Action::Solving(request.serial, part));
            }
            is_wanted()
        };
        let found = catch_unwind(AssertUnwindSafe(|| {
            on_demand("solver");
            solve(&mut evaluator, &request, &mut |answer: &Answer| show(answer), &go_on)
        }));
        match found {
            Ok(Some(answer)) => show(&answer),
            Ok(None) => (),
            Err(_) => send(Action::SolverFailed(request.serial)),
        }
    })
}

/// A file is read once its mark has not changed for this time, or after [`LOOKS`] checks.
const QUIET: Duration = Duration::from_millis(60);
const LOOKS: usize = 20;
/// Greatest number of symbolic links to follow.
const MOST_LINKS: usize = 40;

/// The thread that watches the files, and sleeps until one changes; dropping this ends the thread.
struct Watcher {
    /// Sends the files to watch, or a change of any.
    sender: Arc<Sender<Option<Vec<WatchedFile>>>>,
    files: RefCell<Vec<WatchedFile>>,
}

impl Watcher {
    fn start(send: Send) -> io::Result<Watcher> {
        let (sender, messages) = channel();
        let sender = Arc::new(sender);
        let bell = Arc::downgrade(&sender);
        let changes =
            Changes::start(move || bell.upgrade().is_some_and(|bell| bell.send(None).is_ok()))?;
        let look = move || look(&messages, changes, &send);
        thread::Builder::new().name("watch".to_owned()).spawn(look)?;
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
    for message in messages {
        files = message.unwrap_or(files);
        seen.retain(|path, _| files.iter().any(|file| file.path == *path));
        changes.follow(&places(&files));
        for WatchedFile { path, target, stamp } in &files {
            let mark = mark_of(path);
            let before = seen.insert(path.clone(), mark);
            // A deleted file has no content; a new file may replace it.
            let Some(mark) = mark.filter(|_| before != Some(mark)) else {
                continue;
            };
            let settled = settled(path, mark);
            seen.insert(path.clone(), settled);
            let found = store::load(path);
            // A later change may restore the known content.
            let is_known = before.is_none()
                && found.as_ref().is_ok_and(|document| {
                    document.stamp() == *stamp && document.path() == Some(target.as_path())
                });
            let is_news = settled.is_some() && !is_known;
            if is_news && !send(Action::FileChanged(path.clone(), found)) {
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

/// The time, the length and the number of a file, which change when it is written or replaced.
type Mark = (SystemTime, u64, u64);

fn mark_of(path: &Path) -> Option<Mark> {
    let metadata = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    Some((metadata.modified().ok()?, metadata.len(), files::number(&metadata)))
}

/// The mark of a file once no program writes it any more.
fn settled(path: &Path, mark: Mark) -> Option<Mark> {
    let mut last = Some(mark);
    for _ in 0..LOOKS {
        thread::sleep(QUIET);
        let now = mark_of(path);
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
    use crate::model::inputs::Method;
    use crate::model::{Stage, Stages};

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
