//! Actions change the state of the workbench; effects are its requests to files, threads and the
//! terminal.

use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use ratatui::layout::{Position, Size};

use super::App;
use crate::case::Document;
use crate::tui::layout::Place;
use crate::tui::session::{Claim, Next, SaveFault, Saving, Written};
use crate::tui::settings::Settings;

/// A command with its keys: a row of the table of commands.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The names of the keys, separated by blanks; empty if only the palette runs it. `l/h` are two
    /// keys of opposite directions, `Alt-1..9` are nine keys.
    pub keys: &'static str,
    /// The places in which the keys work.
    pub places: Place,
    /// One or two words for status line and palette, the same in every row of the command; empty if
    /// neither shows it.
    pub name: &'static str,
    /// One sentence for palette and help.
    pub sentence: &'static str,
    /// The places in which the status line shows it.
    pub(crate) status: Place,
    /// Whether it works while the terminal is too small to show the panes.
    pub(crate) works_unseen: bool,
    pub(crate) run: Run,
}

/// The function of a command.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Run {
    Once(fn(&mut App)),
    /// With the direction 1 or -1, or with a number.
    Way(fn(&mut App, isize)),
}

impl Binding {
    /// The row with its name in the status line of all its places.
    pub(crate) const fn shown(self) -> Binding {
        self.shown_in(self.places)
    }

    /// The row with its name in the status line of these places.
    pub(crate) const fn shown_in(self, status: Place) -> Binding {
        Binding { status, ..self }
    }

    /// The row that also works while the terminal is too small.
    pub(crate) const fn unseen(self) -> Binding {
        Binding { works_unseen: true, ..self }
    }

    /// The direction or number of a key; `None` if it is not a key of this row.
    pub fn way(&self, key: &str) -> Option<isize> {
        self.keys.split(' ').find_map(|item| match both(item) {
            (forth, _) if key == forth => Some(1),
            (_, back) if key == back => Some(-1),
            _ => key.strip_prefix(item.strip_suffix("1..9")?)?.parse().ok().filter(|way| *way > 0),
        })
    }

    /// The name of the first key.
    pub(crate) fn first_key(&self) -> &'static str {
        both(self.keys.split(' ').next().unwrap_or_default()).0
    }

    /// The keys as text, without Ctrl-H.
    pub fn keys(&self) -> String {
        self.keys.replace(" Ctrl-H", "").replace(' ', ", ")
    }

    pub(crate) fn run(&self, app: &mut App, way: isize) {
        match self.run {
            Run::Once(run) => run(app),
            Run::Way(run) => run(app, way),
        }
    }
}

// The keys of both directions; a key without the opposite one has itself.
fn both(item: &'static str) -> (&'static str, &'static str) {
    item.split_once('/').filter(|(forth, _)| !forth.is_empty()).unwrap_or((item, item))
}

/// An event for the state: from a key, the mouse, the clock, a worker, or a completed effect.
#[derive(Debug)]
pub enum Action {
    /// A command of the table, with its direction or number.
    Do(&'static Binding, isize),
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
    /// Runs work with this number.
    Work(u64, Work),
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

/// A change of the state that a dialog offers.
#[derive(Clone)]
pub(crate) struct Choice(Arc<dyn Fn(&mut App) + Send + Sync>);

impl Choice {
    pub(crate) fn of(run: impl Fn(&mut App) + Send + Sync + 'static) -> Choice {
        Choice(Arc::new(run))
    }

    /// No change.
    pub(crate) fn none() -> Choice {
        Choice::of(|_| ())
    }

    /// The choice as a change.
    pub(crate) fn change(&self) -> Change {
        let run = Arc::clone(&self.0);
        Change::of(move |app| run(app))
    }
}

impl fmt::Debug for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Choice")
    }
}

/// A kind of work beside the loop. It has a thread, in which the latest request wins.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[expect(missing_docs, reason = "each is named after its work")]
pub enum Slot {
    Solve,
    Folder,
    Search,
    Preview,
    Recents,
    Model,
    Explanation,
    Report,
    Export,
    Variants,
    Relief,
    Study,
    Chart,
    Benchmark,
}

impl fmt::Display for Slot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&format!("{self:?}").to_lowercase())
    }
}

/// Work beside the loop.
pub struct Work {
    /// The kind.
    pub slot: Slot,
    /// The file or folder of the work, which a test redirects; empty without one.
    pub path: PathBuf,
    run: Box<dyn FnOnce(&Running<'_>) + Send>,
    failed: Change,
}

/// Running work.
pub(crate) struct Running<'a> {
    pub(crate) path: &'a Path,
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
        Work { slot, path: PathBuf::new(), run: Box::new(run), failed }
    }

    /// The same work on a file or folder.
    pub(crate) fn at(self, path: PathBuf) -> Work {
        Work { path, ..self }
    }

    /// The same work with another change of the state if it panics.
    pub(crate) fn or(self, failed: impl FnOnce(&mut App) + Send + 'static) -> Work {
        Work { failed: Change::of(failed), ..self }
    }

    /// Runs the work with a number and sends its results and its end.
    pub fn run(self, number: u64, is_wanted: &dyn Fn() -> bool, send: &dyn Fn(Action)) {
        let Work { slot, path, run, failed } = self;
        let step = |change| send(Action::Worked(slot, number, change));
        let running = Running { path: &path, is_wanted, send: &step };
        if catch_unwind(AssertUnwindSafe(|| run(&running))).is_err() {
            step(failed);
        }
        send(Action::WorkEnded(slot, number));
    }
}

/// What an export writes, once it is computed.
pub(crate) type Content = Box<dyn FnOnce(&Running<'_>) -> Result<String, String> + Send>;

impl fmt::Debug for Work {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Work").field("slot", &self.slot).finish_non_exhaustive()
    }
}
