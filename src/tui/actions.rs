//! Actions change the state of the workbench; effects are its requests to files, workers and the
//! terminal.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::layout::{Position, Size};

use super::commands::{self, Command};
use super::jobs::{
    BenchmarkProgress, ChartPart, ChartRequest, Explained, ExportFault, Job, Measuring,
    ReliefAnswer,
};
use super::keys::{Chord, Place};
use super::session::save::{Claim, Next, SaveFault, Saving, Written};
use super::settings::Settings;
use super::solver::{Answer, Request, Variants};
use super::store::Recent;
use super::store::folder::{Listing, Preview, SearchResult, Viewport};
use super::study::{StudyPart, StudyRequest};
use crate::case::Document;
use crate::report::digest::Digest;

/// An event for the state: from a key, the mouse, the clock, the worker, or a completed effect.
#[derive(Debug, Clone)]
pub enum Action {
    /// A command of the table.
    Do(Command),
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
    /// The answer of the worker.
    Solved(Box<Answer>),
    /// Progress of the solve with this serial, from 0 to 1.
    Solving(u64, f64),
    /// New results of a benchmark.
    Measured(Box<BenchmarkProgress>),
    /// The solved variants of a case.
    Compared(Box<Variants>),
    /// The next results of a study.
    Studied(Box<StudyPart>),
    /// The next values of a chart that a worker computes.
    Charted(Box<ChartPart>),
    /// The worker failed on the request with this serial.
    SolverFailed(u64),
    /// Progress of long work; `None` at its end.
    Progress(Option<Progress>),
    /// The content of a file, or its faults.
    Loaded(PathBuf, Result<Box<Document>, Vec<String>>),
    /// Another program may have changed the file of an open case: its present content, or its
    /// faults.
    FileChanged(PathBuf, Result<Box<Document>, Vec<String>>),
    /// The result of a save, with the step after it.
    Saved(PathBuf, Next, Result<Box<Written>, SaveFault>),
    /// The result of an export.
    Exported(PathBuf, Result<(), ExportFault>),
    /// The content of a folder.
    Listed(Box<Listing>),
    /// The cases in the folders below a folder.
    Found(Box<SearchResult>),
    /// The preview of a file or a folder.
    Previewed(Viewport, Box<Preview>),
    /// The access and the kept edits of an opened case.
    Claimed(Box<Claim>),
    /// The journals of ended sessions, each with its description.
    Journals(Vec<(PathBuf, String)>),
    /// The recent cases, the latest first.
    Recents(Vec<Recent>),
    /// The digests of the examples, in their order.
    Examples(Vec<Digest>),
    /// The explanation of a result.
    Explained(Box<Explained>),
    /// The tip relief to specify.
    Relieved(Box<ReliefAnswer>),
    /// The report of the results, for the clipboard.
    Reported(String),
    /// A failed request, or a failed journal.
    Failed(String),
}

/// A request of the state to the outside.
#[derive(Debug, Clone)]
pub enum Effect {
    /// Solves a case; replaces a waiting request.
    Solve(Box<Request>),
    /// Reads a case and returns [`Action::Loaded`].
    Load(PathBuf),
    /// Writes a case and returns [`Action::Saved`] with the next step.
    Save(Box<Saving>, Next),
    /// Runs a job without blocking the screen.
    Job(Job),
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
    /// Runs a benchmark and returns its results as [`Action::Measured`].
    Measure(Box<Measuring>),
    /// Stops the long work.
    CancelWork,
    /// Computes a study and returns its results as [`Action::Studied`].
    Study(Box<StudyRequest>),
    /// Computes a chart in a worker and returns its values as [`Action::Charted`].
    Chart(Box<ChartRequest>),
    /// Stops the computation of a chart.
    CancelChart,
    /// Stop the search for the tip relief to specify.
    CancelRelief,
    /// Stop the study.
    CancelStudy,
    /// Stops the running solve.
    CancelSolve,
    /// Redraws every cell.
    Redraw,
    /// Suspends the process and returns the terminal to the shell until the user resumes it.
    Suspend,
    /// Quits the workbench.
    Quit,
}

/// Progress of running work.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// The name of the work.
    pub what: String,
    /// The completed part, from 0 to 1.
    pub part: f64,
}

/// The action of a key in a place.
#[must_use]
pub fn of_key(event: KeyEvent, place: Place) -> Option<Action> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let chord = Chord::of(event);
    commands::called(chord, place).map(Action::Do).or_else(|| typed(chord, place))
}

fn typed(chord: Chord, place: Place) -> Option<Action> {
    match chord {
        Chord(KeyCode::Char(letter), KeyModifiers::NONE) if place.meets(Place::TYPED) => {
            Some(Action::Insert(letter))
        }
        Chord(KeyCode::Char(letter), KeyModifiers::NONE) if place.meets(Place::OUTSIDE) => {
            Some(Action::Stray(letter))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(letter: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE)
    }

    #[test]
    fn letters_are_text_and_not_commands_inside_a_field() {
        for letter in ('a'..='z').chain(['?', ' ', 'Q', ':', '/', '1']) {
            for place in [Place::TEXT, Place::PATH, Place::PICK] {
                assert!(
                    matches!(of_key(plain(letter), place), Some(Action::Insert(typed)) if typed == letter),
                    "{letter}"
                );
            }
        }
    }

    #[test]
    fn outside_a_field_no_letter_is_text() {
        for place in [
            Place::FIELD,
            Place::RESULTS,
            Place::CHART,
            Place::TEETH,
            Place::TRADE,
            Place::STUDY,
            Place::TOLERANCE,
            Place::READ,
        ] {
            for letter in '!'..='~' {
                assert!(
                    !matches!(of_key(plain(letter), place), Some(Action::Insert(_))),
                    "{letter}"
                );
            }
        }
    }
}
