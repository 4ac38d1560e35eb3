//! The workbench: a form, its results and a chart, in the terminal.
//!
//! The state is plain data ([`app::App`]); [`update::update`] alone changes it and says what is to
//! be done about it; [`view::draw`] makes a screen of it and nothing else. Keys, signals and the
//! worker's answers come through one channel; the loop takes what has come, changes the state,
//! draws once and sleeps.

mod actions;
mod app;
mod ascii;
mod benchmark;
mod commands;
mod dialogs;
mod effects;
mod events;
mod form_aids;
mod help;
mod jobs;
mod layout;
mod pane;
mod panes;
mod rows;
mod session;
mod settings;
mod solver;
mod store;
mod study;
mod tab;
mod theme;
mod update;
mod variants;
mod view;
mod whine;
mod worker;

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
#[doc(hidden)]
pub mod testing;
mod text;
mod workbench;

use std::io::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use crate::system::signals;
use actions::Action;
use ending::TERMINAL_LOST;
use events::Events;
use session::journal_writer::JournalWriter;
use terminal::Screen;
use workbench::{End, session};

const NO_TERMINAL: u8 = 2;
const PANICKED: u8 = 101;

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
        Ok(Ok(End::Signal(signal))) => signals::die_of(signal),
        Ok(Ok(End::Left | End::Lost)) => ExitCode::from(TERMINAL_LOST),
        Ok(Err(error)) => no_answer(&error),
        Err(_) => fail(
            PANICKED,
            &format!(
                "internal error: {}",
                terminal::last_panic().unwrap_or_default()
            ),
        ),
    }
}

// Signals before any other thread starts, and before the terminal is taken: none of them must leave
// the terminal in our modes.
fn begin(events: &Events) -> io::Result<Arc<JournalWriter>> {
    let signals = signals::hold()?;
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
