//! The workbench: a form, its results and a chart, in the terminal.
//!
//! The state is plain data ([`app::App`]); [`update::update`] alone changes it and says what is to be done about it;
//! [`view::draw`] makes a screen of it and nothing else. Keys, signals and the worker's answers come through one
//! channel; the loop takes what has come, changes the state, draws once and sleeps.

pub mod actions;
pub mod app;
pub mod clean;
pub mod events;
pub mod history;
pub mod pane;
pub mod pick;
pub mod prompt;
pub mod recents;
pub mod rows;
pub mod scale;
pub mod settings;
pub mod solver;
pub mod store;
pub mod tab;
pub mod terminal;
pub mod theme;
pub mod update;
pub mod view;

use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use signal_hook::consts::{SIGCONT, SIGTSTP};

use actions::Action;
use app::App;
use events::{Event, Events};
use settings::Settings;
use solver::Solver;
use store::{Opening, Trouble};
use terminal::Screen;
use theme::Look;
use update::{Effect, update};

const NO_TERMINAL: u8 = 2;
const TERMINAL_LOST: u8 = 5;
const PANICKED: u8 = 101;
/// A program that a signal ends has this and the signal's number as its exit code.
const SIGNALLED: i32 = 128;
/// Time between two pictures of what plays.
const TICK: Duration = Duration::from_millis(83);

/// The workbench while it runs.
struct Workbench {
    app: App,
    screen: Screen,
    events: Events,
    solver: Solver,
    /// When the next picture of what plays is due.
    alarm: Option<Instant>,
}

/// Open the workbench on a case, else on the last one, else on the built-in one, and stay until the user quits.
#[must_use]
pub fn run(case: Option<PathBuf>) -> ExitCode {
    if let Some(reason) = terminal::missing(|name| std::env::var_os(name)) {
        tell(&format!("no terminal for the workbench ({reason}); without one: tipstrike solve CASE"));
        return ExitCode::from(NO_TERMINAL);
    }
    terminal::hold_panics();
    match catch_unwind(AssertUnwindSafe(|| session(case))) {
        Ok(Ok(code)) => ExitCode::from(code),
        Ok(Err(error)) => {
            tell(&format!("the terminal does not answer: {error}"));
            ExitCode::from(TERMINAL_LOST)
        }
        Err(_) => {
            tell(&format!("a fault of the program: {}", terminal::last_panic().unwrap_or_default()));
            ExitCode::from(PANICKED)
        }
    }
}

fn session(case: Option<PathBuf>) -> io::Result<u8> {
    let Opening { document, path, trouble } = store::opening(case);
    // Before the terminal is taken: a signal must never leave it in our modes.
    let events = Events::start()?;
    let mut screen = Screen::open()?;
    let settings = Settings::read();
    let look = Look::of(|name| std::env::var_os(name));
    let look = settings.look(look, |name| std::env::var_os(name).is_some_and(|value| !value.is_empty()));
    let mut app = App { settings, ..App::new(document, path, look, screen.size()?) };
    screen.take_mouse(settings.mouse)?;
    if let Some(trouble) = trouble {
        report(&mut app, trouble);
    }
    screen.draw(&app)?;
    let solver = Solver::start(events.teller())?;
    Workbench { app, screen, events, solver, alarm: None }.stay()
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
    fn stay(mut self) -> io::Result<u8> {
        loop {
            let batch = self.events.batch(self.alarm);
            if let Some(code) = self.take(batch)? {
                return Ok(code);
            }
        }
    }

    // All that has come, and one frame if it changed anything; the exit code when it is over.
    fn take(&mut self, batch: Vec<Event>) -> io::Result<Option<u8>> {
        let mut events = batch.into_iter().peekable();
        let mut has_changed = false;
        while let Some(event) = events.peek() {
            if let Event::Signal(signal) = *event {
                if let Some(code) = self.obey(signal)? {
                    return Ok(Some(code));
                }
                has_changed = true;
            } else if matches!(event, Event::Lost) {
                return Ok(Some(TERMINAL_LOST));
            }
            if matches!(event, Event::Tick) {
                self.alarm = Some(Instant::now() + TICK);
            }
            let Some(action) = events::take_action(&mut events, self.app.place()) else { continue };
            has_changed = true;
            if self.act(action)? {
                return Ok(Some(0));
            }
        }
        if has_changed {
            self.screen.draw(&self.app)?;
        }
        Ok(None)
    }

    fn obey(&mut self, signal: i32) -> io::Result<Option<u8>> {
        match signal {
            SIGTSTP => self.screen.suspend()?,
            SIGCONT => self.screen.resume()?,
            _ => return Ok(Some(u8::try_from(SIGNALLED + signal).unwrap_or(u8::MAX))),
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
                    Effect::Redraw => self.screen.clear()?,
                    Effect::Suspend => self.screen.suspend()?,
                    Effect::Solve(request) => self.solver.ask(*request),
                    Effect::Copy(text) => self.screen.copy(&text)?,
                    Effect::Mouse(takes) => self.screen.take_mouse(takes)?,
                    Effect::Play(plays) => self.alarm = plays.then(|| Instant::now() + TICK),
                    other => actions.extend(store::perform(other)),
                }
            }
        }
        Ok(false)
    }
}

// A terminal or a pipe that is gone hears nothing more.
fn tell(words: &str) {
    drop(writeln!(io::stderr(), "tipstrike: {}", clean::clean(words)));
}
