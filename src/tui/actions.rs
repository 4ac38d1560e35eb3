//! What happens to the workbench, and what it asks of the world in turn.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::layout::{Position, Size};

use super::benchmark::{Measured, Measuring};
use super::commands::{self, Command};
use super::jobs::{Explained, ExportFault, Job, ReliefAnswer};
use super::keys::{Chord, Place};
use super::session::recovery::Claim;
use super::session::save::{Next, SaveFault, Saving, Written};
use super::settings::Settings;
use super::solver::{Answer, Request};
use super::store::case_search::Below;
use super::store::folder::Listing;
use super::store::preview::{Preview, Viewport};
use super::store::recents::Recent;
use super::study::{StudyPart, StudyRequest};
use super::variants::Variants;
use super::whine::{WhinePart, WhineRequest};
use crate::case::Document;
use crate::report::digest::Digest;

/// Something that happened: from a key, the mouse, the clock, the worker, or an effect that is
/// done.
#[derive(Debug, Clone)]
pub enum Action {
    /// A command of the table.
    Do(Command),
    /// A character typed.
    Insert(char),
    /// A letter that is no command where it was typed.
    Stray(char),
    /// Text pasted, which never presses a button.
    Paste(String),
    /// The mouse pressed a cell.
    Click(Position),
    /// The wheel turned over a cell, by so many lines downwards.
    Wheel(Position, isize),
    /// The terminal has another size.
    Resize(Size),
    /// Time for the next picture of what plays.
    Tick,
    /// The worker has an answer.
    Solved(Box<Answer>),
    /// The solve of that serial takes its time; this part of it is done.
    Solving(u64, f64),
    /// More is known of a measurement.
    Measured(Box<Measured>),
    /// The solved variants of a case.
    Compared(Box<Variants>),
    /// The next results of a study.
    Studied(Box<StudyPart>),
    /// The next values of a chart of whine.
    Whined(Box<WhinePart>),
    /// The worker failed on the request of that serial.
    SolverFailed(u64),
    /// Long work goes on, or is over.
    Progress(Option<Progress>),
    /// A file was read, or its faults were found.
    Loaded(PathBuf, Result<Box<Document>, Vec<String>>),
    /// Another program may have changed the file of an open case; its content now, or its faults.
    FileChanged(PathBuf, Result<Box<Document>, Vec<String>>),
    /// A file was written, or not; and what comes next.
    Saved(PathBuf, Next, Result<Box<Written>, SaveFault>),
    /// An export was written, or not.
    Exported(PathBuf, Result<(), ExportFault>),
    /// What stands in a folder.
    Listed(Box<Listing>),
    /// Which cases stand below a folder.
    Found(Box<Below>),
    /// What a file or a folder holds.
    Previewed(Viewport, Box<Preview>),
    /// What was found out about a case that was opened.
    Claimed(Box<Claim>),
    /// The cases that were open last, the latest first.
    Recents(Vec<Recent>),
    /// What the examples are, in their order.
    Examples(Vec<Digest>),
    /// Where a result comes from.
    Explained(Box<Explained>),
    /// The tip relief to specify.
    Relieved(Box<ReliefAnswer>),
    /// The report of the results, for the clipboard.
    Reported(String),
    /// Something that was asked for, or that keeps what is typed, did not succeed.
    Failed(String),
}

/// What the state asks of the world.
#[derive(Debug, Clone)]
pub enum Effect {
    /// Solve, in place of any request that has not begun.
    Solve(Box<Request>),
    /// Read a case, and tell it as [`Action::Loaded`].
    Load(PathBuf),
    /// Write a case, and tell it with what comes next as [`Action::Saved`].
    Save(Box<Saving>, Next),
    /// Look into something, without keeping the screen waiting.
    Job(Job),
    /// Open this case when the workbench starts the next time.
    Remember(PathBuf),
    /// The edits of this journal are in the form now.
    Adopt(PathBuf),
    /// The edits of this journal are not wanted.
    Forget(PathBuf),
    /// Writes the settings.
    Keep(Settings),
    /// Hand a text to the clipboard of the user's own terminal.
    Copy(String),
    /// Take the mouse, or leave it to the terminal.
    Mouse(bool),
    /// Tick, or be silent.
    Play(bool),
    /// Measure, and tell what is known as [`Action::Measured`].
    Measure(Box<Measuring>),
    /// Stop the long work.
    CancelWork,
    /// Compute a study, and send its results as [`Action::Studied`].
    Study(Box<StudyRequest>),
    /// Compute a chart of whine, and send its values as [`Action::Whined`].
    Whine(Box<WhineRequest>),
    /// Stop the chart of whine.
    CancelWhine,
    /// Stop the search for the tip relief to specify.
    CancelRelief,
    /// Stop the study.
    CancelStudy,
    /// Stop what is being solved.
    CancelSolve,
    /// Redraw every cell.
    Redraw,
    /// Give the terminal back to the shell, until it brings us back.
    Suspend,
    /// Leave.
    Quit,
}

/// Long work that runs.
#[derive(Debug, Clone, PartialEq)]
pub struct Progress {
    /// The work, in a few words.
    pub what: String,
    /// The completed part, 0 to 1.
    pub part: f64,
}

/// What a key does in a place.
#[must_use]
pub fn of_key(event: KeyEvent, place: Place) -> Option<Action> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let chord = Chord::of(event);
    commands::called(chord, place)
        .map(Action::Do)
        .or_else(|| typed(chord, place))
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
    fn letters_type_in_a_text_and_command_nowhere_there() {
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
