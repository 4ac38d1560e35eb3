//! The main loop of the workbench, which takes events, changes the state, carries out the effects and
//! draws; and the threads beside it: the watcher of files, and one thread for each kind of work.

use std::cell::RefCell;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::io;
use std::path::{self, Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::SeqCst};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::{Duration, Instant, SystemTime};

use super::app::App;
use super::app::actions::{Action, Effect, Slot, Work};
use super::app::tab::Origin;
use super::input::{self, Event, Events};
use super::session::journal::JournalWriter;
use super::session::{Autosave, Claim};
use super::settings::{Look, Settings};
use super::solver::on_demand;
use super::store::{self, State, WatchedFile};
use super::terminal::Screen;
use super::update::update;
use crate::case::rexs;
use crate::model::{Stage, Stages};
use crate::system::changes::{Changes, Places};
use crate::system::files;
use crate::system::terminal::{SIGCONT, SIGTSTP, SIGWINCH};

/// Time between two frames of the animation.
const TICK: Duration = Duration::from_millis(83);

/// Results that arrive within this time are drawn with the edit, in one frame.
const QUICK: Duration = Duration::from_millis(8);

/// How the workbench ended.
pub(super) enum End {
    /// The user quit; no unsaved edits are to be kept.
    Left,
    /// The terminal is closed.
    Lost,
    Signal(i32),
}

pub(super) fn session(
    named: Option<PathBuf>,
    events: Events,
    mut screen: Screen,
    journal_writer: &Arc<JournalWriter>,
) -> io::Result<End> {
    let is_named = named.is_some();
    let path = named.or_else(|| store::recents().into_iter().next());
    let loaded = path.as_deref().map(store::load).transpose();
    screen.enter()?;
    events.listen()?;
    let settings = Settings::read();
    let look = Look::of(&settings, |name| std::env::var_os(name));
    let (document, faults) = match loaded {
        Ok(document) => (document, None),
        Err(faults) => (None, Some(faults)),
    };
    let case_path = path.as_deref().filter(|_| document.is_some()).map(rexs::case_path);
    let is_last = case_path.is_some() && !is_named;
    let document = document.map_or_else(store::built_in, |document| *document);
    let mut app = App::new(document, case_path, look, screen.size()?);
    app.settings = settings;
    app.tab.origin = if is_last { Origin::LastCase } else { Origin::Given };
    app.tab.in_place_of = path.clone().filter(|_| faults.is_some());
    screen.take_mouse(settings.mouse)?;
    // The form is there before threads, locks and results are.
    screen.draw(&app)?;
    let threads = Workers::start(Arc::new(events.action_sender()))?;
    let autosave = Autosave::new(State::find(), Arc::clone(journal_writer));
    let mut workbench = Workbench { app, screen, events, threads, autosave, alarm: None };
    match (path, faults) {
        (Some(path), None) => store::add_recent(&path),
        (Some(path), Some(faults)) if is_named => {
            workbench.act(Action::Loaded(path, Err(faults)))?;
        }
        (_, faults) => {
            if let Some(reason) = faults.and_then(|faults| faults.into_iter().next()) {
                workbench.app.complain(format!("the last case cannot be opened: {reason}"));
            }
        }
    }
    workbench.stay()
}

/// Carries out an effect on files and returns its result as an action. Ignores other effects.
pub fn perform(effect: Effect, autosave: &mut Autosave) -> Option<Action> {
    match effect {
        Effect::Load(path) => {
            let path = store::at_home(&path);
            let result = store::load(&path);
            return Some(Action::Loaded(path, result));
        }
        Effect::Save(saving, next) => {
            let result = autosave.save(&saving);
            return Some(Action::Saved(saving.path, next, result));
        }
        Effect::Adopt(journal) => autosave.adopt(journal),
        Effect::Remember(path) => store::add_recent(&path),
        Effect::Keep(settings) => {
            let reason = settings.keep().err()?;
            return Some(Action::Failed(format!("the settings are not saved: {reason}")));
        }
        // A journal that cannot be deleted is offered again at the next start.
        Effect::Forget(journals) => {
            for journal in &journals {
                drop(fs::remove_file(journal));
            }
        }
        Effect::Journals => return Some(Action::Journals(autosave.ended_sessions())),
        _ => {}
    }
    None
}

/// The result of opening a case under autosave, as an action.
pub fn claimed(claim: Result<Claim, String>) -> Action {
    claim.map_or_else(Action::Failed, |claim| Action::Claimed(Box::new(claim)))
}

/// The running workbench.
struct Workbench {
    app: App,
    screen: Screen,
    events: Events,
    threads: Workers,
    autosave: Autosave,
    /// Time of the next frame of the animation.
    alarm: Option<Instant>,
}

impl Workbench {
    fn stay(mut self) -> io::Result<End> {
        let mut batch = vec![Event::Tick];
        let end = loop {
            if let Some(end) = self.take(batch)? {
                break end;
            }
            batch = self.events.batch(self.alarm, self.autosave.deadline());
        };
        if matches!(end, End::Left) {
            self.autosave.end();
        }
        Ok(end)
    }

    // Applies all waiting events and draws one frame if the state changed. Returns how the
    // workbench ended, if it has ended.
    fn take(&mut self, mut batch: Vec<Event>) -> io::Result<Option<End>> {
        let (mut has_changed, quick) = (false, Instant::now() + QUICK);
        while !batch.is_empty() {
            match self.apply(batch)? {
                Ok(changed) => has_changed |= changed,
                Err(end) => return Ok(Some(end)),
            }
            // The run over the speed takes many frames.
            let has_results = self.app.has_results(Stages::NONE.with(Stage::SpeedRun));
            let waits = self.app.is_busy(Slot::Solve) && !has_results && Instant::now() < quick;
            batch = if waits { self.events.batch(None, Some(quick)) } else { Vec::new() };
        }
        if self.keep()? || has_changed {
            self.screen.draw(&self.app)?;
        }
        self.autosave.keep_if_due(Instant::now());
        self.threads.watch(self.app.files());
        Ok(None)
    }

    // Applies events and returns whether the state changed, or how the workbench ended.
    fn apply(&mut self, batch: Vec<Event>) -> io::Result<Result<bool, End>> {
        let mut events = batch.into_iter().peekable();
        let mut has_changed = false;
        while let Some(event) = events.peek() {
            match *event {
                Event::Lost => return Ok(Err(End::Lost)),
                Event::Tick => self.alarm = Some(Instant::now() + TICK),
                Event::Signal(signal) => {
                    has_changed = true;
                    match signal {
                        SIGTSTP => self.suspend()?,
                        SIGCONT | SIGWINCH => {
                            if signal == SIGCONT {
                                self.screen.resume()?;
                            }
                            // A terminal that is resized during a stop sends no signal later.
                            let size = self.screen.size()?;
                            if signal == SIGWINCH || size != self.app.layout.size {
                                self.act(Action::Resize(size))?;
                            }
                        }
                        _ => return Ok(Err(End::Signal(signal))),
                    }
                }
                _ => {}
            }
            let Some(action) = input::take_action(&mut events, self.app.place()) else {
                continue;
            };
            // Its results are shown, and its end is not.
            has_changed |= !matches!(action, Action::WorkEnded(Slot::Solve, _));
            if self.act(action)? {
                return Ok(Err(End::Left));
            }
            self.keep()?;
        }
        Ok(Ok(has_changed))
    }

    // Returns whether the workbench ends.
    fn act(&mut self, action: Action) -> io::Result<bool> {
        let mut actions = vec![action];
        while let Some(action) = actions.pop() {
            for effect in update(&mut self.app, action) {
                match effect {
                    Effect::Quit => return Ok(true),
                    Effect::Redraw => {
                        on_demand("screen");
                        self.screen.clear(self.app.layout.size)?;
                    }
                    Effect::Suspend => self.suspend()?,
                    Effect::Work(number, work) => self.threads.work(number, work)?,
                    Effect::Cancel(slot) => self.threads.cancel(slot),
                    Effect::Copy(text) => self.screen.copy(&text)?,
                    Effect::Mouse(takes) => self.screen.take_mouse(takes)?,
                    Effect::Play(plays) => self.alarm = plays.then(|| Instant::now() + TICK),
                    other => actions.extend(perform(other, &mut self.autosave)),
                }
            }
        }
        Ok(false)
    }

    // Returns whether there were claims.
    fn keep(&mut self) -> io::Result<bool> {
        let claims = self.autosave.follow(&self.app.sheets(), Instant::now());
        let has_changed = !claims.is_empty();
        for claim in claims {
            self.act(claimed(claim))?;
        }
        Ok(has_changed)
    }

    // The journal is written first, because the suspension may last long.
    fn suspend(&mut self) -> io::Result<()> {
        self.keep()?;
        self.autosave.keep();
        self.screen.suspend()
    }
}

/// The worker threads. The file watcher starts at once, a thread of work with its first work.
pub struct Workers {
    send: Send,
    threads: BTreeMap<Slot, Worker>,
    watcher: Watcher,
}

/// A thread in which the latest work wins, by its number; dropping this ends the thread.
struct Worker {
    works: Sender<(u64, Work)>,
    /// The number of the work whose results are wanted; 0 if there is none.
    wanted: Arc<AtomicU64>,
}

/// Sends an action to the workbench. Returns false once the receiver is closed.
pub(crate) type Send = Arc<dyn Fn(Action) -> bool + std::marker::Send + Sync>;

impl Workers {
    /// Starts the watcher of files.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(send: Send) -> io::Result<Workers> {
        let watcher = Watcher::start(Send::clone(&send))?;
        Ok(Workers { send, threads: BTreeMap::new(), watcher })
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
        let worker = match self.threads.entry(work.slot) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(free) => {
                free.insert(Worker::start(&work.slot.to_string(), Send::clone(&self.send))?)
            }
        };
        worker.wanted.store(number, SeqCst);
        let _ = worker.works.send((number, work));
        Ok(())
    }

    /// Stops the work of a slot.
    pub(crate) fn cancel(&self, slot: Slot) {
        if let Some(worker) = self.threads.get(&slot) {
            worker.wanted.store(0, SeqCst);
        }
    }
}

impl Worker {
    fn start(name: &str, send: Send) -> io::Result<Worker> {
        let (works, received) = channel::<(u64, Work)>();
        let wanted = Arc::<AtomicU64>::default();
        let theirs = Arc::clone(&wanted);
        let serve = move || {
            for (number, work) in received {
                let is_wanted = || theirs.load(SeqCst) == number;
                if is_wanted() {
                    // Without a receiver the workbench has ended, and its process ends soon.
                    work.run(number, &is_wanted, &|action| {
                        send(action);
                    });
                }
            }
        };
        thread::Builder::new().name(name.to_owned()).spawn(serve)?;
        Ok(Worker { works, wanted })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.wanted.store(0, SeqCst);
    }
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
    use std::sync::Mutex;

    use super::*;

    fn threads() -> (Workers, Receiver<Action>) {
        let (sender, actions) = channel();
        let send: Send = Arc::new(move |action| sender.send(action).is_ok());
        (Workers::start(send).expect("threads"), actions)
    }

    #[test]
    fn the_latest_work_wins_and_a_stop_ends_the_running_and_the_waiting_work() {
        let (mut threads, actions) = threads();
        let ((begun, has_begun), (go, gate)) = (channel(), channel::<()>());
        let gate = Arc::new(Mutex::new(gate));
        let request = |threads: &mut Workers, number: u64| {
            let (begun, gate) = (begun.clone(), Arc::clone(&gate));
            let work = Work::in_steps(Slot::Folder, move |running| {
                begun.send(number).expect("the test listens");
                gate.lock().expect("one thread").recv().expect("the test goes on");
                if running.is_wanted() {
                    running.send(|_| ());
                }
            });
            threads.work(number, work).expect("a thread");
        };
        let next = || {
            let wanted = actions.iter().find_map(|action| match action {
                Action::Worked(_, number, _) => Some(number),
                _ => None,
            });
            wanted.expect("a result")
        };
        request(&mut threads, 1);
        assert_eq!(has_begun.recv(), Ok(1));
        (2..=9).for_each(|number| request(&mut threads, number));
        (0..2).for_each(|_| go.send(()).expect("the worker listens"));
        assert_eq!((has_begun.recv(), next()), (Ok(9), 9));
        request(&mut threads, 10);
        assert_eq!(has_begun.recv(), Ok(10));
        request(&mut threads, 11);
        threads.cancel(Slot::Folder);
        request(&mut threads, 12);
        (0..2).for_each(|_| go.send(()).expect("the worker listens"));
        assert_eq!((has_begun.recv(), next()), (Ok(12), 12));
    }

    #[test]
    fn work_that_panics_sends_its_fault_and_its_end() {
        let (mut threads, actions) = threads();
        for (number, panics) in [(1, true), (2, false)] {
            let work = Work::in_steps(Slot::Folder, move |_| assert!(!panics, "planted"));
            threads.work(number, work).expect("a thread");
            let mut sent = actions.recv().expect("an action");
            if panics {
                assert!(matches!(sent, Action::Worked(Slot::Folder, 1, _)), "{sent:?}");
                sent = actions.recv().expect("an action");
            }
            assert!(matches!(sent, Action::WorkEnded(Slot::Folder, of) if of == number));
        }
    }
}
