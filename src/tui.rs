//! The workbench: a form, its results and a chart, in the terminal.
//!
//! The state is plain data ([`app::App`]); [`update::update`] alone changes it and says what is to
//! be done about it; [`view::draw`] makes a screen of it and nothing else. Keys, signals and the
//! worker's answers come through one channel; the loop takes what has come, changes the state,
//! draws once and sleeps.

// Public for the tests of the screens, which are programs of their own.
#[doc(hidden)]
pub mod actions;
#[doc(hidden)]
pub mod app;
#[doc(hidden)]
pub mod ascii;
#[doc(hidden)]
pub mod benchmark;
#[doc(hidden)]
pub mod commands;
#[doc(hidden)]
pub mod dialogs;
#[doc(hidden)]
pub mod effects;
#[doc(hidden)]
pub mod events;
#[doc(hidden)]
pub mod form_aids;
#[doc(hidden)]
pub mod help;
#[doc(hidden)]
pub mod jobs;
#[doc(hidden)]
pub mod layout;
#[doc(hidden)]
pub mod pane;
#[doc(hidden)]
pub mod panes;
#[doc(hidden)]
pub mod rows;
#[doc(hidden)]
pub mod session;
#[doc(hidden)]
pub mod settings;
#[doc(hidden)]
pub mod solver;
#[doc(hidden)]
pub mod store;
#[doc(hidden)]
pub mod study;
#[doc(hidden)]
pub mod tab;
#[doc(hidden)]
pub mod theme;
#[doc(hidden)]
pub mod update;
#[doc(hidden)]
pub mod variants;
#[doc(hidden)]
pub mod view;
#[doc(hidden)]
pub mod worker;

mod baseline;
mod capped_backend;
mod cursor_range;
mod ending;
mod fault;
mod header;
mod history;
mod input;
mod keys;
mod line;
mod scale;
mod terminal;
mod text;

use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGCONT, SIGTSTP, SIGWINCH};

use actions::{Action, Effect};
use app::App;
use effects::{claimed, perform};
use ending::TERMINAL_LOST;
use events::{Event, Events};
use session::autosave::Autosave;
use session::journal_writer::JournalWriter;
use settings::Settings;
use store::state::State;
use store::{Opening, Trouble};
use tab::Origin;
use terminal::Screen;
use theme::Look;
use update::update;
use worker::Workers;

const NO_TERMINAL: u8 = 2;
const PANICKED: u8 = 101;
/// Time between two pictures of what plays.
const TICK: Duration = Duration::from_millis(83);

/// The workbench while it runs.
struct Workbench {
    app: App,
    screen: Screen,
    events: Events,
    workers: Workers,
    autosave: Autosave,
    /// When the next picture of what plays is due.
    alarm: Option<Instant>,
    /// The settings that are to be kept once all that has come is done.
    chosen: Option<Settings>,
}

/// How the workbench came to its end.
enum End {
    /// The user left: nothing is unsaved that is wanted.
    Left,
    /// The terminal is gone.
    Lost,
    Signal(i32),
}

/// Open the workbench on a case, else on the last one, else on the built-in one, and stay until the
/// user quits.
#[must_use]
pub fn run(case: Option<PathBuf>) -> ExitCode {
    if let Some(reason) = terminal::missing(|name| std::env::var_os(name)) {
        tell(&format!(
            "no terminal for the workbench ({reason}); without one: tipstrike solve CASE"
        ));
        return ExitCode::from(NO_TERMINAL);
    }
    terminal::hold_panics();
    // Memory for the picture is taken before any thread takes some: the picture then shrinks to the
    // memory that there is.
    let screen = match Screen::new() {
        Ok(screen) => screen,
        Err(error) => return no_answer(&error),
    };
    let events = Events::new();
    let journal_writer = match begin(&events) {
        Ok(journal_writer) => journal_writer,
        Err(error) => {
            return fail(
                TERMINAL_LOST,
                &format!("the system gives no thread: {error}"),
            );
        }
    };
    let ended = catch_unwind(AssertUnwindSafe(|| {
        session(case, events, screen, &journal_writer)
    }));
    if matches!(ended, Ok(Ok(End::Left))) {
        return ExitCode::SUCCESS;
    }
    keep_what_is_left(&journal_writer);
    match ended {
        Ok(Ok(End::Signal(signal))) => ending::die_of(signal),
        Ok(Ok(End::Left | End::Lost)) => ExitCode::from(TERMINAL_LOST),
        Ok(Err(error)) => no_answer(&error),
        Err(_) => fail(
            PANICKED,
            &format!(
                "a fault of the program: {}",
                terminal::last_panic().unwrap_or_default()
            ),
        ),
    }
}

// Signals before any other thread starts, and before the terminal is taken: none of them must leave
// the terminal in our modes.
fn begin(events: &Events) -> io::Result<Arc<JournalWriter>> {
    let signals = ending::hold_signals()?;
    let send = events.action_sender();
    let journal_writer = JournalWriter::open(move |reason| {
        send(Action::Failed(reason));
    })?;
    let last_words = Arc::clone(&journal_writer);
    ending::listen(signals, &events.sender(), move || {
        drop(last_words.write(false));
    })?;
    Ok(journal_writer)
}

fn session(
    case: Option<PathBuf>,
    events: Events,
    mut screen: Screen,
    journal_writer: &Arc<JournalWriter>,
) -> io::Result<End> {
    let is_last_case = case.is_none();
    let Opening {
        document,
        path,
        trouble,
    } = store::opening(case);
    screen.enter()?;
    events.listen()?;
    let settings = Settings::read();
    let look = Look::of(|name| std::env::var_os(name));
    let look = settings.look(look, |name| {
        std::env::var_os(name).is_some_and(|value| !value.is_empty())
    });
    let mut app = App {
        settings,
        ..App::at_start(document, path, look, screen.size()?)
    };
    if is_last_case && app.tab.path.is_some() {
        app.tab.origin = Origin::LastCase;
    }
    update::settle(&mut app);
    screen.take_mouse(settings.mouse)?;
    if let Some(trouble) = trouble {
        report(&mut app, trouble);
    }
    screen.draw(&app)?;
    let workers = Workers::start(Arc::new(events.action_sender()))?;
    if let Some(request) = app.unanswered() {
        workers.solve(request);
    }
    let autosave = Autosave::new(State::find(), Arc::clone(journal_writer));
    Workbench {
        app,
        screen,
        events,
        workers,
        autosave,
        alarm: None,
        chosen: None,
    }
    .stay()
}

fn report(app: &mut App, trouble: Trouble) {
    app.tab.in_place_of = Some(trouble.path.clone());
    if trouble.was_asked {
        update(app, Action::Loaded(trouble.path, Err(trouble.faults)));
    } else {
        let reason = trouble.faults.into_iter().next().unwrap_or_default();
        app.complain(format!("the last case cannot be opened: {reason}"));
    }
}

impl Workbench {
    fn stay(mut self) -> io::Result<End> {
        // What is found out about the case on which it opens comes after the first frame.
        let mut batch = Vec::new();
        let end = loop {
            if let Some(end) = self.take(batch)? {
                break end;
            }
            batch = self.events.batch(self.alarm, self.autosave.deadline());
        };
        self.keep_settings();
        if matches!(end, End::Left) {
            self.autosave.end();
        }
        Ok(end)
    }

    // All that has come, and one frame if it changed anything; how it ended, if it did.
    fn take(&mut self, batch: Vec<Event>) -> io::Result<Option<End>> {
        let mut events = batch.into_iter().peekable();
        let mut has_changed = false;
        while let Some(event) = events.peek() {
            if let Event::Signal(signal) = *event {
                if let Some(end) = self.obey(signal)? {
                    return Ok(Some(end));
                }
                has_changed = true;
            } else if matches!(event, Event::Lost) {
                return Ok(Some(End::Lost));
            }
            if matches!(event, Event::Tick) {
                self.alarm = Some(Instant::now() + TICK);
            }
            let Some(action) = events::take_action(&mut events, self.app.place()) else {
                continue;
            };
            has_changed = true;
            if self.act(action)? {
                return Ok(Some(End::Left));
            }
            self.keep();
        }
        self.keep_settings();
        if self.keep() || has_changed {
            self.screen.draw(&self.app)?;
        }
        self.autosave.keep_if_due(Instant::now());
        Ok(None)
    }

    fn obey(&mut self, signal: i32) -> io::Result<Option<End>> {
        match signal {
            SIGTSTP => self.suspend()?,
            SIGCONT => self.screen.resume()?,
            SIGWINCH => {
                let size = self.screen.size()?;
                self.act(Action::Resize(size))?;
            }
            _ => return Ok(Some(End::Signal(signal))),
        }
        Ok(None)
    }

    // Whether it is over.
    fn act(&mut self, action: Action) -> io::Result<bool> {
        let mut actions = vec![action];
        while let Some(action) = actions.pop() {
            for effect in update(&mut self.app, action) {
                match effect {
                    Effect::Quit => return Ok(true),
                    Effect::Redraw => {
                        fault::on_demand("screen");
                        self.screen.clear()?;
                    }
                    Effect::Suspend => self.suspend()?,
                    Effect::Solve(request) => self.workers.solve(*request),
                    Effect::Measure(measuring) => self.workers.measure(*measuring)?,
                    Effect::CancelWork => self.workers.stop_benchmark(),
                    Effect::Study(request) => self.workers.study(*request)?,
                    Effect::CancelStudy => self.workers.stop_study(),
                    Effect::CancelSolve => self.workers.stop_solve(),
                    Effect::Job(job) => self.workers.job(job)?,
                    Effect::Keep(settings) => self.chosen = Some(settings),
                    Effect::Copy(text) => self.screen.copy(&text)?,
                    Effect::Mouse(takes) => self.screen.take_mouse(takes)?,
                    Effect::Play(plays) => self.alarm = plays.then(|| Instant::now() + TICK),
                    other => actions.extend(perform(other, &mut self.autosave)),
                }
            }
        }
        Ok(false)
    }

    // A flood of choices is written once.
    fn keep_settings(&mut self) {
        let kept = self
            .chosen
            .take()
            .and_then(|settings| perform(Effect::Keep(settings), &mut self.autosave));
        if let Some(action) = kept {
            update(&mut self.app, action);
        }
    }

    // Whether there was something to tell.
    fn keep(&mut self) -> bool {
        let claims = self.autosave.follow(&self.app.sheets(), Instant::now());
        let has_changed = !claims.is_empty();
        for claim in claims {
            update(&mut self.app, claimed(claim));
        }
        has_changed
    }

    // Nobody knows for how long.
    fn suspend(&mut self) -> io::Result<()> {
        self.keep();
        self.autosave.keep();
        self.screen.suspend()
    }
}

// The terminal is given back by now.
fn keep_what_is_left(journal_writer: &JournalWriter) {
    match journal_writer.write(false) {
        Ok(()) if journal_writer.is_needed() => {
            tell("unsaved edits are kept: open the case again to get them back");
        }
        Ok(()) => {}
        Err(error) => tell(&format!("unsaved edits could not be kept: {error}")),
    }
}

fn no_answer(error: &io::Error) -> ExitCode {
    fail(
        TERMINAL_LOST,
        &format!("the terminal does not answer: {error}"),
    )
}

fn fail(code: u8, words: &str) -> ExitCode {
    tell(words);
    ExitCode::from(code)
}

// A terminal or a pipe that is gone hears nothing more.
fn tell(words: &str) {
    drop(writeln!(
        io::stderr(),
        "tipstrike: {}",
        ascii::printable(words)
    ));
}
