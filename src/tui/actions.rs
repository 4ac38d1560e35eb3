//! What the user can do: one table of keys, names and sentences, from which key map, status line and help are derived.

use std::path::PathBuf;

use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use ratatui::layout::Size;
use tui_input::InputRequest;

use super::recovery::Claim;
use super::solver::Answer;
use super::store::{Entry, SaveFault};
use crate::case::Document;

/// Something that happened: from a key, the worker, or an effect that is done.
#[derive(Debug, Clone)]
pub enum Action {
    /// A command of the table.
    Do(Command),
    /// A character typed.
    Insert(char),
    /// Text pasted, which never presses a button.
    Paste(String),
    /// The terminal has another size.
    Resize(Size),
    /// The worker has an answer.
    Solved(Box<Answer>),
    /// The worker failed on the request of that serial.
    SolverFailed(u64),
    /// A file was read, or its faults were found.
    Loaded(PathBuf, Result<Box<Document>, Vec<String>>),
    /// A file was written, or not; and what comes next.
    Saved(PathBuf, Next, Result<Box<Document>, SaveFault>),
    /// What stands in a folder.
    Listed(String, Vec<Entry>),
    /// What was found out about a case that was opened.
    Claimed(Box<Claim>),
    /// Something that the user must know goes wrong.
    Warned(String),
}

/// What comes after a save or a decision to lose the edits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// Go on with this case.
    Stay,
    /// Leave the workbench.
    Quit,
    /// Ask for a file to open.
    Browse,
    /// Open this file.
    Load(PathBuf),
    /// Start from the built-in case.
    Fresh,
}

/// A command of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each has its sentence in the table of bindings")]
pub enum Command {
    Help,
    Save,
    SaveAs,
    Open,
    New,
    ToggleRung,
    Undo,
    Redo,
    CyclePanes,
    ResultsUp,
    ResultsDown,
    CycleMarker,
    Redraw,
    Suspend,
    Cancel,
    Quit,
    Next,
    Previous,
    NextGroup,
    PreviousGroup,
    FirstField,
    LastField,
    NextChoice,
    PreviousChoice,
    Complete,
    Accept,
    Leave,
    Edit(InputRequest),
}

/// Where keys go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place(u8);

/// A key with the modifiers held.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chord(KeyCode, KeyModifiers);

/// A line of the table.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The keys that call it.
    pub chords: &'static [Chord],
    /// What they call.
    pub command: Command,
    /// The places where they do.
    pub places: Place,
    /// One or two words for the status line; empty where it does not stand there.
    pub name: &'static str,
    /// One sentence for the help.
    pub sentence: &'static str,
}

impl Place {
    /// A field of words or of a value.
    pub const TEXT: Place = Place(1);
    /// A field of a few names.
    pub const CHOICE: Place = Place(2);
    /// A prompt for a path with a list.
    pub const BROWSE: Place = Place(4);
    /// A prompt for a path.
    pub const PATH: Place = Place(8);
    /// A question with buttons.
    pub const ASK: Place = Place(16);
    /// A page to read.
    pub const READ: Place = Place(32);
    const FORM: Place = Place::TEXT.or(Place::CHOICE);
    const LINE: Place = Place::TEXT.or(Place::BROWSE).or(Place::PATH);
    const PROMPT: Place = Place::BROWSE.or(Place::PATH).or(Place::ASK).or(Place::READ);
    const ALL: Place = Place::FORM.or(Place::PROMPT);

    /// Whether the two have a place in common.
    #[must_use]
    pub const fn meets(self, other: Place) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether letters go into a line of text.
    #[must_use]
    pub const fn is_line(self) -> bool {
        self.meets(Place::LINE)
    }

    const fn or(self, other: Place) -> Place {
        Place(self.0 | other.0)
    }
}

const fn key(code: KeyCode) -> Chord {
    Chord(code, KeyModifiers::NONE)
}

const fn function(number: u8) -> Chord {
    key(KeyCode::F(number))
}

const fn ctrl(letter: char) -> Chord {
    Chord(KeyCode::Char(letter), KeyModifiers::CONTROL)
}

const fn alt(letter: char) -> Chord {
    Chord(KeyCode::Char(letter), KeyModifiers::ALT)
}

const fn with(modifiers: KeyModifiers, code: KeyCode) -> Chord {
    Chord(code, modifiers)
}

const fn bind(places: Place, chords: &'static [Chord], command: Command, name: &'static str, sentence: &'static str) -> Binding {
    Binding { chords, command, places, name, sentence }
}

const CTRL: KeyModifiers = KeyModifiers::CONTROL;
const ALT: KeyModifiers = KeyModifiers::ALT;

use Command as Do;
use InputRequest as Line;

/// Every key of the workbench, in the order of the help; the status line shows as many as fit.
#[rustfmt::skip]
pub static BINDINGS: &[Binding] = &[
    bind(Place::FORM, &[function(1), alt('h')], Do::Help, "help", "This page."),
    bind(Place::FORM, &[ctrl('s')], Do::Save, "save", "Save the case; comments and order of the file stay."),
    bind(Place::FORM, &[ctrl('o')], Do::Open, "open", "Open another case."),
    bind(Place::FORM, &[ctrl('q')], Do::Quit, "quit", "Quit; asks when something is unsaved."),
    bind(Place::FORM, &[ctrl('t'), function(6)], Do::ToggleRung, "rung", "Change the rung: paper, exact."),
    bind(Place::FORM, &[ctrl('z')], Do::Undo, "undo", "Undo the edits of the last field."),
    bind(Place::FORM, &[function(5), alt('p')], Do::CyclePanes, "panes", "With the chart, without it, the chart alone."),
    bind(Place::FORM, &[function(4), with(CTRL, KeyCode::Down), with(ALT, KeyCode::Down)], Do::ResultsDown, "results", "Further down in the results."),
    bind(Place::FORM, &[function(3), with(CTRL, KeyCode::Up), with(ALT, KeyCode::Up)], Do::ResultsUp, "", "Back up in the results."),
    bind(Place::FORM, &[function(2), alt('s')], Do::SaveAs, "save as", "Save under another name."),
    bind(Place::FORM, &[ctrl('n')], Do::New, "new", "Start again from the built-in Table 1."),
    bind(Place::FORM, &[ctrl('y'), ctrl('r')], Do::Redo, "redo", "Redo what was undone."),
    bind(Place::FORM, &[function(8), alt('m')], Do::CycleMarker, "marker", "Draw the chart in Braille, blocks or dots."),
    bind(Place::FORM, &[ctrl('l')], Do::Redraw, "", "Draw the screen anew."),
    bind(Place::FORM, &[alt('z')], Do::Suspend, "", "Suspend to the shell; fg comes back."),
    bind(Place::FORM, &[key(KeyCode::Down), key(KeyCode::Tab), key(KeyCode::Enter)], Do::Next, "", "The next field."),
    bind(Place::FORM, &[key(KeyCode::Up), key(KeyCode::BackTab), with(KeyModifiers::SHIFT, KeyCode::BackTab)], Do::Previous, "", "The field before."),
    bind(Place::FORM, &[key(KeyCode::PageDown)], Do::NextGroup, "", "The next group."),
    bind(Place::FORM, &[key(KeyCode::PageUp)], Do::PreviousGroup, "", "The group before."),
    bind(Place::FORM, &[with(CTRL, KeyCode::Home)], Do::FirstField, "", "The first field."),
    bind(Place::FORM, &[with(CTRL, KeyCode::End)], Do::LastField, "", "The last field."),
    bind(Place::CHOICE, &[key(KeyCode::Right), key(KeyCode::Char(' '))], Do::NextChoice, "", "The next of the names."),
    bind(Place::CHOICE, &[key(KeyCode::Left)], Do::PreviousChoice, "", "The name before."),
    bind(Place::CHOICE, &[key(KeyCode::Backspace), key(KeyCode::Delete), ctrl('h')], Do::Edit(Line::DeleteLine), "", "Back to what holds without a choice."),
    bind(Place::BROWSE, &[key(KeyCode::Tab)], Do::Complete, "take over", "Write the marked name into the line."),
    bind(Place::ASK, &[key(KeyCode::Tab), key(KeyCode::Right), key(KeyCode::Down)], Do::Next, "", "The next button."),
    bind(Place::ASK, &[key(KeyCode::BackTab), with(KeyModifiers::SHIFT, KeyCode::BackTab), key(KeyCode::Left), key(KeyCode::Up)], Do::Previous, "", "The button before."),
    bind(Place::BROWSE.or(Place::READ), &[key(KeyCode::Down)], Do::Next, "", "The next line."),
    bind(Place::BROWSE.or(Place::READ), &[key(KeyCode::Up)], Do::Previous, "", "The line before."),
    bind(Place::BROWSE.or(Place::READ), &[key(KeyCode::PageDown)], Do::NextGroup, "next page", "The next page."),
    bind(Place::READ, &[key(KeyCode::Char(' '))], Do::NextGroup, "", "The next page."),
    bind(Place::BROWSE.or(Place::READ), &[key(KeyCode::PageUp)], Do::PreviousGroup, "", "The page before."),
    bind(Place::BROWSE.or(Place::PATH).or(Place::ASK), &[key(KeyCode::Enter)], Do::Accept, "accept", "Do it."),
    bind(Place::READ, &[key(KeyCode::Enter), key(KeyCode::Char('q')), function(1)], Do::Leave, "", "Close the page."),
    bind(Place::PROMPT, &[key(KeyCode::Esc)], Do::Leave, "back", "Close; nothing is lost."),
    bind(Place::ALL, &[ctrl('c')], Do::Cancel, "", "Close a prompt; else ask whether to quit."),
    bind(Place::LINE, &[key(KeyCode::Left)], Do::Edit(Line::GoToPrevChar), "", "A character to the left."),
    bind(Place::LINE, &[key(KeyCode::Right)], Do::Edit(Line::GoToNextChar), "", "A character to the right."),
    bind(Place::LINE, &[with(CTRL, KeyCode::Left), with(ALT, KeyCode::Left)], Do::Edit(Line::GoToPrevWord), "", "A word to the left."),
    bind(Place::LINE, &[with(CTRL, KeyCode::Right), with(ALT, KeyCode::Right)], Do::Edit(Line::GoToNextWord), "", "A word to the right."),
    bind(Place::LINE, &[key(KeyCode::Home), ctrl('a')], Do::Edit(Line::GoToStart), "", "To the start of the text."),
    bind(Place::LINE, &[key(KeyCode::End), ctrl('e')], Do::Edit(Line::GoToEnd), "", "To the end of the text."),
    bind(Place::LINE, &[key(KeyCode::Backspace), ctrl('h')], Do::Edit(Line::DeletePrevChar), "", "Delete the character before."),
    bind(Place::LINE, &[key(KeyCode::Delete), ctrl('d')], Do::Edit(Line::DeleteNextChar), "", "Delete the character after."),
    bind(Place::LINE, &[ctrl('w'), with(ALT, KeyCode::Backspace)], Do::Edit(Line::DeletePrevWord), "", "Delete the word before."),
    bind(Place::LINE, &[ctrl('k')], Do::Edit(Line::DeleteTillEnd), "", "Delete to the end."),
    bind(Place::LINE.or(Place::CHOICE), &[ctrl('u')], Do::Edit(Line::DeleteLine), "", "Empty the field: what then holds is shown in brackets."),
];

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
        Chord(KeyCode::Char('?'), KeyModifiers::NONE) if place == Place::CHOICE => Some(Action::Do(Command::Help)),
        Chord(KeyCode::Char(letter), KeyModifiers::NONE) if place != Place::READ => Some(Action::Insert(letter)),
        _ => None,
    }
}

impl Chord {
    // Shift is part of the letter, and terminals differ in whether they say so.
    fn of(event: KeyEvent) -> Chord {
        let held = event.modifiers & (CTRL | ALT | KeyModifiers::SHIFT);
        match event.code {
            KeyCode::Char(letter) if held.contains(CTRL) => {
                Chord(KeyCode::Char(letter.to_ascii_lowercase()), held - KeyModifiers::SHIFT)
            }
            KeyCode::Char(_) => Chord(event.code, held - KeyModifiers::SHIFT),
            code => Chord(code, held),
        }
    }

    /// The key as a person reads it.
    #[must_use]
    pub fn name(&self) -> String {
        let name = match self.0 {
            KeyCode::Char(' ') => "Space".to_owned(),
            KeyCode::Char(letter) if self.1.is_empty() => letter.to_string(),
            KeyCode::Char(letter) => letter.to_ascii_uppercase().to_string(),
            KeyCode::F(number) => format!("F{number}"),
            KeyCode::BackTab => "Shift-Tab".to_owned(),
            code => format!("{code:?}"),
        };
        let held = [(CTRL, "Ctrl-"), (ALT, "Alt-")].into_iter().filter(|(one, _)| self.1.contains(*one));
        held.map(|(_, prefix)| prefix).collect::<String>() + &name
    }
}

impl Binding {
    /// The keys as a person reads them, Ctrl-H and doubles left out.
    #[must_use]
    pub fn keys(&self) -> String {
        let mut names: Vec<_> = self.chords.iter().filter(|chord| **chord != ctrl('h')).map(Chord::name).collect();
        names.dedup();
        names.join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for letter in ('a'..='z').chain(['?', ' ', 'Q']) {
            let event = KeyEvent::new(KeyCode::Char(letter), KeyModifiers::NONE);
            assert!(matches!(of_key(event, Place::TEXT), Some(Action::Insert(typed)) if typed == letter), "{letter}");
        }
    }
}
