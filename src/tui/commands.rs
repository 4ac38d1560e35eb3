//! The commands of the user, and the table of their keys, names and sentences.

mod table;

use tui_input::InputRequest;

use super::keys::{self, Chord, Place};
use super::pane::Pane;
use super::panes::chart::ChartCommand;
use super::panes::study::StudyCommand;
use super::panes::teeth::TeethCommand;
use crate::model::inputs::Method;

pub use table::BINDINGS;

/// A command of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "each has its sentence in the table of bindings")]
pub enum Command {
    Help,
    Palette,
    SearchField,
    Save,
    SaveAs,
    Reload,
    Journals,
    Relief,
    Export,
    Open,
    Recent,
    FolderUp,
    New,
    Example,
    BuiltIn,
    NextTab,
    PreviousTab,
    Tab(usize),
    CloseTab,
    ToggleMethod,
    Method(Method),
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
    SwitchTradeView,
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
    Chart(ChartCommand),
    Teeth(TeethCommand),
    Study(StudyCommand),
    Variant,
    NextVariants,
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
    NextFault,
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

/// A row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The keys of the command; empty if only the palette runs it.
    pub chords: &'static [Chord],
    /// The command.
    pub(crate) command: Command,
    /// The places in which the keys work.
    pub places: Place,
    /// One or two words for status line and palette; empty if neither shows it.
    pub name: &'static str,
    /// One sentence for palette and help.
    pub sentence: &'static str,
    /// The places in which the status line shows it.
    pub(crate) footer: Place,
}

/// The command that a key calls in a place.
#[must_use]
pub(crate) fn called(chord: Chord, place: Place) -> Option<Command> {
    let bound = BINDINGS
        .iter()
        .find(|binding| binding.places.meets(place) && binding.chords.contains(&chord));
    bound.map(|binding| binding.command)
}

/// The commands of the palette: the first binding of each that has a name and does not belong to a
/// prompt.
pub fn commands() -> impl Iterator<Item = &'static Binding> {
    let is_first = |at: usize, command: Command| {
        !BINDINGS[..at].iter().any(|binding| is_listed(binding) && binding.command == command)
    };
    let listed = BINDINGS.iter().enumerate().filter(|(_, binding)| is_listed(binding));
    listed.filter(move |(at, binding)| is_first(*at, binding.command)).map(|(_, binding)| binding)
}

/// How a command relates to the focused pane and field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Scope {
    /// The command belongs to the focused pane or field.
    Own,
    /// The command works in every pane.
    Everywhere,
    /// The command belongs to another pane.
    Elsewhere,
}

/// The scope of a command if keys go to `place` and `pane` has the focus.
#[must_use]
pub(crate) fn scope(command: Command, place: Place, pane: Pane) -> Scope {
    let is_of_some = |places: Place| !places.holds(Place::OUTSIDE);
    let scope = |binding: &Binding| {
        let is_shown_here = binding.footer.meets(pane.place()) && is_of_some(binding.footer);
        match binding.places {
            places if is_of_some(places) && !places.meets(place) => Scope::Elsewhere,
            places if is_of_some(places) || is_shown_here => Scope::Own,
            _ => Scope::Everywhere,
        }
    };
    let bound = BINDINGS.iter().filter(|binding| is_listed(binding) && binding.command == command);
    bound.map(scope).min().unwrap_or(Scope::Everywhere)
}

/// Every key of the command outside prompts, as text.
pub(crate) fn keys_of(command: Command) -> String {
    let bound = BINDINGS
        .iter()
        .filter(|binding| binding.command == command && binding.places.meets(Place::WORK));
    bound.map(Binding::keys).filter(|keys| !keys.is_empty()).collect::<Vec<_>>().join(", ")
}

/// The first key of the command in a place, and its name in the palette if it has no key. Esc
/// precedes a key that a field takes as text.
pub(crate) fn key_in(place: Place, command: Command) -> String {
    let bound = || {
        BINDINGS
            .iter()
            .filter(|binding| binding.command == command && binding.places.meets(Place::WORK))
    };
    let key = |binding: &Binding| binding.chords.first().map(Chord::name);
    let mut here = bound().filter(|binding| binding.places.meets(place));
    let after_esc = || bound().find_map(key).map(|key| format!("Esc {key}"));
    here.find_map(key).or_else(after_esc).unwrap_or_else(|| {
        let leave = if place.meets(Place::COMMANDED) { "" } else { "Esc " };
        format!("{leave}:{}", bound().next().map_or("", |binding| binding.name))
    })
}

fn is_listed(binding: &Binding) -> bool {
    !binding.name.is_empty()
        && binding.places.meets(Place::WORK)
        && binding.command != Command::Leave
}

impl Binding {
    /// The keys as text, without Ctrl-H.
    #[must_use]
    pub fn keys(&self) -> String {
        let names = self.chords.iter().filter(|chord| **chord != keys::ctrl('h')).map(Chord::name);
        names.collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::KeyCode;

    #[test]
    fn no_key_has_two_meanings_in_a_place() {
        for (index, binding) in BINDINGS.iter().enumerate() {
            for other in &BINDINGS[index + 1..] {
                let shared = binding.chords.iter().find(|chord| other.chords.contains(chord));
                assert!(
                    !binding.places.meets(other.places) || shared.is_none(),
                    "{shared:?}: {}",
                    binding.sentence
                );
            }
        }
    }

    /// Letters with similar meanings in several panes: move, more or less, start again, other view.
    const ALIKE: &str = "hjklgG+=-0v";

    #[test]
    fn a_letter_has_one_meaning_in_all_panes() {
        for letter in ('!'..='~').filter(|letter| !ALIKE.contains(*letter)) {
            let chord = keys::letter(letter);
            let bound = BINDINGS
                .iter()
                .filter(|one| one.places.meets(Place::OUTSIDE) && one.chords.contains(&chord));
            let mut commands: Vec<_> = bound.map(|one| one.command).collect();
            commands.dedup();
            assert!(commands.len() <= 1, "{letter}: {commands:?}");
        }
    }

    #[test]
    fn the_letters_that_move_do_so_in_every_pane() {
        for place in [
            Place::FIELD,
            Place::RESULTS,
            Place::CHART,
            Place::TEETH,
            Place::TRADE,
            Place::STUDY,
            Place::TOLERANCE,
        ] {
            for (letter, arrow) in [
                ('h', KeyCode::Left),
                ('j', KeyCode::Down),
                ('k', KeyCode::Up),
                ('l', KeyCode::Right),
            ] {
                let moved = called(keys::letter(letter), place);
                assert!(moved.is_some(), "{letter} in {place:?}");
                assert_eq!(moved, called(keys::key(arrow), place), "{letter} in {place:?}");
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
