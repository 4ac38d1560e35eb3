//! What the user can do, and what else happens to the workbench.

mod keys;
mod table;

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::layout::{Position, Size};
use tui_input::InputRequest;

use super::app::Progress;
use super::browser::Sight;
use super::errands::Explained;
use super::measurer::Measured;
use super::pane::Pane;
use super::recents::Recent;
use super::recovery::Claim;
use super::solver::Answer;
use super::store::SaveFault;
use super::store::below::Below;
use super::store::folder::Listing;
use super::store::preview::Preview;
use crate::case::Document;
use crate::report::digest::Digest;

pub use keys::{Chord, Place};
pub use table::BINDINGS;

/// Something that happened: from a key, the mouse, the clock, the worker, or an effect that is done.
#[derive(Debug, Clone)]
pub enum Action {
    /// A command of the table.
    Do(Command),
    /// A character typed.
    Insert(char),
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
    /// The worker failed on the request of that serial.
    SolverFailed(u64),
    /// Long work goes on, or is over.
    Progress(Option<Progress>),
    /// A file was read, or its faults were found.
    Loaded(PathBuf, Result<Box<Document>, Vec<String>>),
    /// A file was written, or not; and what comes next.
    Saved(PathBuf, Next, Result<Box<Document>, SaveFault>),
    /// What stands in a folder.
    Listed(Box<Listing>),
    /// Which cases stand below a folder.
    Found(Box<Below>),
    /// What a file or a folder holds.
    Previewed(Sight, Box<Preview>),
    /// What was found out about a case that was opened.
    Claimed(Box<Claim>),
    /// The cases that were open last, the latest first.
    Recents(Vec<Recent>),
    /// What the examples are, in their order.
    Examples(Vec<Digest>),
    /// Where a result comes from.
    Explained(Box<Explained>),
    /// Something that was asked for, or that keeps what is typed, did not succeed.
    Failed(String),
}

/// What comes after a save or a decision to lose the edits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// Go on with this case.
    Stay,
    /// Leave the workbench.
    Quit,
    /// Save what else is unsaved, then leave the workbench.
    SaveRest,
    /// Close this case.
    Close,
    /// Open this file in place of the case.
    Load(PathBuf),
}

/// A command of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each has its sentence in the table of bindings")]
pub enum Command {
    Help,
    Palette,
    SearchField,
    Save,
    SaveAs,
    Open,
    Recent,
    FolderUp,
    New,
    Example,
    NextTab,
    PreviousTab,
    Tab(usize),
    CloseTab,
    ToggleRung,
    Undo,
    Redo,
    Show(Pane),
    NextPane,
    PreviousPane,
    CycleLower,
    Zoom,
    ResultsUp,
    ResultsDown,
    Explain,
    Measure,
    TakeSetting,
    Notes,
    NextReason,
    PreviousReason,
    PinBaseline,
    CopyValue,
    CopyResults,
    CursorBy(i16),
    CursorToD,
    CursorToE,
    CursorTo,
    CursorAway,
    Play,
    ChartBy(isize),
    Chart(usize),
    ChartZoom(i32),
    ChartWhole,
    ChartStrike,
    ChartTime,
    TeethBy(i32),
    TeethAnew,
    TeethCentre,
    TeethGap,
    CycleMarker,
    ShowCost,
    CycleTheme,
    ToggleAscii,
    CycleUnits,
    ToggleMouse,
    Redraw,
    Suspend,
    Cancel,
    Quit,
    Next,
    Previous,
    NextGroup,
    PreviousGroup,
    First,
    Last,
    FirstField,
    LastField,
    Step(i32),
    Material,
    Limit,
    NextChoice,
    PreviousChoice,
    StartEdit,
    Complete,
    Accept,
    Leave,
    Edit(InputRequest),
}

/// A line of the table.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The keys that call it; none where only the palette does.
    pub chords: &'static [Chord],
    /// What they call.
    pub command: Command,
    /// The places where they do.
    pub places: Place,
    /// One or two words for status line and palette; empty where it stands in neither.
    pub name: &'static str,
    /// One sentence for palette and help.
    pub sentence: &'static str,
    /// Whether the status line shows it.
    pub in_footer: bool,
}

/// What a key does in a place.
#[must_use]
pub fn of_key(event: KeyEvent, place: Place) -> Option<Action> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let chord = Chord::of(event);
    let bound = BINDINGS.iter().find(|binding| binding.places.meets(place) && binding.chords.contains(&chord));
    bound.map(|binding| Action::Do(binding.command)).or_else(|| typed(chord, place))
}

fn typed(chord: Chord, place: Place) -> Option<Action> {
    match chord {
        Chord(KeyCode::Char(letter), KeyModifiers::NONE) if place.meets(Place::TYPED) => Some(Action::Insert(letter)),
        _ => None,
    }
}

/// The commands of the palette: the first binding of each that has a name and does not belong to a prompt.
pub fn commands() -> impl Iterator<Item = &'static Binding> {
    let is_first =
        |at: usize, command: Command| !BINDINGS[..at].iter().any(|binding| is_listed(binding) && binding.command == command);
    let listed = BINDINGS.iter().enumerate().filter(|(_, binding)| is_listed(binding));
    listed.filter(move |(at, binding)| is_first(*at, binding.command)).map(|(_, binding)| binding)
}

/// Every key that calls the command outside prompts, as a person reads it.
#[must_use]
pub fn keys_of(command: Command) -> String {
    let bound = BINDINGS.iter().filter(|binding| binding.command == command && binding.places.meets(Place::WORK));
    bound.map(Binding::keys).filter(|keys| !keys.is_empty()).collect::<Vec<_>>().join(", ")
}

fn is_listed(binding: &Binding) -> bool {
    !binding.name.is_empty() && binding.places.meets(Place::WORK) && binding.command != Command::Leave
}

impl Binding {
    /// The keys as a person reads them, Ctrl-H left out.
    #[must_use]
    pub fn keys(&self) -> String {
        let names = self.chords.iter().filter(|chord| **chord != keys::ctrl('h')).map(Chord::name);
        names.collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(letter: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE)
    }

    #[test]
    fn no_key_has_two_meanings_in_a_place() {
        for (index, binding) in BINDINGS.iter().enumerate() {
            for other in &BINDINGS[index + 1..] {
                let shared = binding.chords.iter().find(|chord| other.chords.contains(chord));
                assert!(!binding.places.meets(other.places) || shared.is_none(), "{shared:?}: {}", binding.sentence);
            }
        }
    }

    #[test]
    fn letters_type_in_a_text_and_command_nowhere_there() {
        for letter in ('a'..='z').chain(['?', ' ', 'Q', ':', '/', '1']) {
            for place in [Place::TEXT, Place::PATH, Place::PICK] {
                assert!(matches!(of_key(plain(letter), place), Some(Action::Insert(typed)) if typed == letter), "{letter}");
            }
        }
    }

    #[test]
    fn outside_a_field_no_letter_is_text() {
        for place in [Place::FIELD, Place::RESULTS, Place::CHART, Place::TEETH, Place::TRADE, Place::READ] {
            for letter in '!'..='~' {
                assert!(!matches!(of_key(plain(letter), place), Some(Action::Insert(_))), "{letter}");
            }
        }
    }

    #[test]
    fn one_command_has_one_name_and_one_sentence() {
        for binding in BINDINGS.iter().filter(|binding| is_listed(binding)) {
            for other in BINDINGS.iter().filter(|other| is_listed(other)) {
                let same = binding.command == other.command;
                assert_eq!(same, binding.name == other.name, "{} {}", binding.name, other.name);
                assert!(!same || binding.sentence == other.sentence, "{}", binding.name);
            }
        }
    }
}
