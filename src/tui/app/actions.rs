//! Actions change the state of the workbench; effects are its requests to files, threads and the
//! terminal.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

use ratatui::layout::{Position, Size};

use super::App;
use crate::case::Document;
use crate::tui::jobs::{Job, Slot};
use crate::tui::keys::{Chord, Place};
use crate::tui::session::save::{Claim, Next, SaveFault, Saving, Written};
use crate::tui::settings::Settings;
use crate::tui::solver::{Answer, Request};

/// A command with its keys: a row of the table of commands.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The keys of the command; empty if only the palette runs it.
    pub chords: &'static [Chord],
    /// The places in which the keys work.
    pub places: Place,
    /// One or two words for status line and palette, the same in every row of the command; empty if
    /// neither shows it.
    pub name: &'static str,
    /// One sentence for palette and help.
    pub sentence: &'static str,
    /// The places in which the status line shows it.
    pub(crate) footer: Place,
    pub(crate) run: fn(&mut App),
}

/// An event for the state: from a key, the mouse, the clock, a worker, or a completed effect.
#[derive(Debug)]
pub enum Action {
    /// A command of the table.
    Do(&'static Binding),
    /// A typed character.
    Insert(char),
    /// A letter without a command in the present place.
    Stray(char),
    /// Pasted text, which never presses a button.
    Paste(String),
    /// A mouse click on a cell.
    Click(Position),
    /// The mouse wheel over a cell, with the number of lines downwards.
    Wheel(Position, isize),
    /// The new size of the terminal.
    Resize(Size),
    /// Time for the next frame of an animation.
    Tick,
    /// The answer of the solver.
    Solved(Box<Answer>),
    /// Progress of the solve with this serial, from 0 to 1.
    Solving(u64, f64),
    /// The solver failed on the request with this serial.
    SolverFailed(u64),
    /// A result of the work with this number.
    Worked(Slot, u64, Change),
    /// The end of the work with this number.
    WorkEnded(Slot, u64),
    /// The content of a file, or its faults.
    Loaded(PathBuf, Result<Box<Document>, Vec<String>>),
    /// Another program may have changed the file of an open case: its present content, or its
    /// faults.
    FileChanged(PathBuf, Result<Box<Document>, Vec<String>>),
    /// The result of a save, with the step after it.
    Saved(PathBuf, Next, Result<Box<Written>, SaveFault>),
    /// The access and the kept edits of an opened case.
    Claimed(Box<Claim>),
    /// The journals of ended sessions, each with its description.
    Journals(Vec<(PathBuf, String)>),
    /// A failed request, or a failed journal.
    Failed(String),
}

/// A request of the state to the outside.
#[derive(Debug)]
pub enum Effect {
    /// Solves a case; replaces a waiting request.
    Solve(Box<Request>),
    /// Stops the running solve.
    CancelSolve,
    /// Runs work with this number.
    Work(u64, Work),
    /// Runs a job with this number, as work.
    Job(u64, Job),
    /// Stops the work of a slot.
    Cancel(Slot),
    /// Reads a case and returns [`Action::Loaded`].
    Load(PathBuf),
    /// Writes a case and returns [`Action::Saved`] with the next step.
    Save(Box<Saving>, Next),
    /// Stores this case as the one to open at the next start.
    Remember(PathBuf),
    /// Adopts this journal, whose edits are now in the form.
    Adopt(PathBuf),
    /// Deletes these journals, whose edits the user discarded.
    Forget(Vec<PathBuf>),
    /// Lists the journals of ended sessions and returns [`Action::Journals`].
    Journals,
    /// Writes the settings.
    Keep(Settings),
    /// Copies a text to the clipboard of the user's terminal.
    Copy(String),
    /// Turns mouse reports on or off.
    Mouse(bool),
    /// Starts or stops the clock of the animation.
    Play(bool),
    /// Redraws every cell.
    Redraw,
    /// Suspends the process and returns the terminal to the shell until the user resumes it.
    Suspend,
    /// Quits the workbench.
    Quit,
}

/// A change of the state by the result of work.
pub struct Change(Box<dyn FnOnce(&mut App) + Send>);

impl Change {
    /// A change by a function.
    pub(crate) fn of(change: impl FnOnce(&mut App) + Send + 'static) -> Change {
        Change(Box::new(change))
    }

    pub(crate) fn apply(self, app: &mut App) {
        (self.0)(app);
    }
}

impl fmt::Debug for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Change")
    }
}

/// Work beside the loop.
pub struct Work {
    /// The kind.
    pub slot: Slot,
    run: Box<dyn FnOnce(&Running<'_>) + Send>,
    failed: Change,
}

/// Running work.
pub(crate) struct Running<'a> {
    is_wanted: &'a dyn Fn() -> bool,
    send: &'a dyn Fn(Change),
}

impl Running<'_> {
    /// Whether the work is still wanted: nobody has stopped it, and there is no later request.
    pub(crate) fn is_wanted(&self) -> bool {
        (self.is_wanted)()
    }

    /// Sends a result.
    pub(crate) fn send(&self, change: impl FnOnce(&mut App) + Send + 'static) {
        (self.send)(Change::of(change));
    }
}

impl Work {
    /// Work with one result, which `done` brings into the state; without a result if it is stopped.
    pub(crate) fn new<T: Send + 'static>(
        slot: Slot,
        run: impl FnOnce(&Running<'_>) -> Option<T> + Send + 'static,
        done: impl FnOnce(&mut App, T) + Send + 'static,
    ) -> Work {
        Work::in_steps(slot, move |running| {
            if let Some(found) = run(running) {
                running.send(move |app| done(app, found));
            }
        })
    }

    /// Work that sends its results as they arrive.
    pub(crate) fn in_steps(slot: Slot, run: impl FnOnce(&Running<'_>) + Send + 'static) -> Work {
        let failed = Change::of(move |app| {
            app.complain(format!("internal error: the {slot} failed"));
        });
        Work { slot, run: Box::new(run), failed }
    }

    /// The same work with another change of the state if it panics.
    pub(crate) fn or(self, failed: impl FnOnce(&mut App) + Send + 'static) -> Work {
        Work { failed: Change::of(failed), ..self }
    }

    /// Runs the work with a number and sends its results and its end.
    pub fn run(self, number: u64, is_wanted: &dyn Fn() -> bool, send: &dyn Fn(Action)) {
        let Work { slot, run, failed } = self;
        let step = |change| send(Action::Worked(slot, number, change));
        let running = Running { is_wanted, send: &step };
        if catch_unwind(AssertUnwindSafe(|| run(&running))).is_err() {
            step(failed);
        }
        send(Action::WorkEnded(slot, number));
    }
}

impl fmt::Debug for Work {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Work").field("slot", &self.slot).finish_non_exhaustive()
    }
}
