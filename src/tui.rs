//! The workbench: a form, its results and charts, in the terminal.
//!
//! The state is plain data ([`app::App`]). Only [`update::update`] changes the state; it returns
//! the effects to carry out. [`view::draw`] only draws the state. Keys, signals and the results of
//! the worker arrive through one channel. The loop takes all waiting events, changes the state,
//! draws once and sleeps.

mod app;
mod form_aids;
mod input;
mod layout;
mod rows;
mod session;
mod settings;
mod solver;
mod store;
mod terminal;
#[doc(hidden)]
pub mod testing;
mod text;
mod update;
mod view;
mod workbench;

use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;

use crate::system::terminal::{die_of, hold};

use app::actions::Action;
use input::Events;
use session::journal::JournalWriter;
use terminal::{Screen, TERMINAL_LOST};
use workbench::{End, session};

const NO_TERMINAL: u8 = 2;
const PANICKED: u8 = 101;

/// Runs the workbench on a case, otherwise on the last case, otherwise on the built-in case, until
/// the user quits. Returns the exit code.
#[must_use]
pub fn run(case: Option<PathBuf>) -> u8 {
    if let Some(reason) = terminal::missing(|name| std::env::var_os(name)) {
        tell(&format!(
            "no terminal for the workbench ({reason}); without one: tipstrike solve CASE"
        ));
        return NO_TERMINAL;
    }
    terminal::hold_panics();
    // The screen buffer is allocated before any thread starts: it adapts its size to the free
    // memory.
    let screen = match Screen::new() {
        Ok(screen) => screen,
        Err(error) => return no_answer(&error),
    };
    let events = Events::new();
    let journal_writer = match begin(&events) {
        Ok(journal_writer) => journal_writer,
        Err(error) => {
            return fail(TERMINAL_LOST, &format!("the system cannot start a thread: {error}"));
        }
    };
    let ended = catch_unwind(AssertUnwindSafe(|| session(case, events, screen, &journal_writer)));
    if matches!(ended, Ok(Ok(End::Left))) {
        return 0;
    }
    keep_what_is_left(&journal_writer);
    match ended {
        Ok(Ok(End::Signal(signal))) => die_of(signal),
        Ok(Ok(End::Left | End::Lost)) => TERMINAL_LOST,
        Ok(Err(error)) => no_answer(&error),
        Err(_) => fail(
            PANICKED,
            &format!("internal error: {}", terminal::last_panic().unwrap_or_default()),
        ),
    }
}

// The signals are blocked before any other thread starts and before the terminal changes its mode:
// no signal may leave the terminal in raw mode.
fn begin(events: &Events) -> io::Result<Arc<JournalWriter>> {
    let signals = hold()?;
    let send = events.action_sender();
    let journal_writer = JournalWriter::open(move |reason| {
        send(Action::Failed(reason));
    })?;
    let last_words = Arc::clone(&journal_writer);
    terminal::listen(signals, &events.sender(), move || {
        drop(last_words.write(false));
    })?;
    Ok(journal_writer)
}

// Runs after the terminal is restored.
fn keep_what_is_left(journal_writer: &JournalWriter) {
    match journal_writer.write(false) {
        Ok(()) if journal_writer.is_needed() => {
            tell("unsaved edits are kept: open the case again to restore them");
        }
        Ok(()) => {}
        Err(error) => tell(&format!("unsaved edits could not be kept: {error}")),
    }
}

fn no_answer(error: &io::Error) -> u8 {
    fail(TERMINAL_LOST, &format!("the terminal does not answer: {error}"))
}

fn fail(code: u8, words: &str) -> u8 {
    tell(words);
    code
}

// Errors of a closed terminal or pipe are ignored.
fn tell(words: &str) {
    drop(writeln!(io::stderr(), "tipstrike: {}", text::printable(words)));
}
