//! Keys with their modifiers, and the places that receive them.

use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};

const PREFIXES: [(KeyModifiers, &str); 3] = [
    (KeyModifiers::CONTROL, "Ctrl-"),
    (KeyModifiers::ALT, "Alt-"),
    (KeyModifiers::SHIFT, "Shift-"),
];

/// The key of the command that goes to the next error.
pub(in crate::tui) const NEXT_FAULT: &str = "Alt-E";

/// A set of places that receive keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place(u32);

impl Place {
    /// No place.
    pub(crate) const NONE: Place = Place(0);
    /// A field of text or of a value.
    pub(crate) const TEXT: Place = Place(1);
    /// A field with a list of choices.
    pub(crate) const CHOICE: Place = Place(2);
    /// A prompt for a path, with a list.
    pub(crate) const BROWSE: Place = Place(4);
    /// A prompt with a line: a path or an angle.
    pub(crate) const PATH: Place = Place(8);
    /// A question with buttons.
    pub(crate) const ASK: Place = Place(16);
    /// A page of text.
    pub(crate) const READ: Place = Place(32);
    /// A list with a filter.
    pub(crate) const PICK: Place = Place(64);
    /// The form, outside its fields.
    pub(crate) const FIELD: Place = Place(128);
    /// The results.
    pub(crate) const RESULTS: Place = Place(256);
    /// The chart.
    pub(crate) const CHART: Place = Place(512);
    /// The teeth.
    pub(crate) const TEETH: Place = Place(1024);
    /// Accuracy against run time.
    pub(crate) const TRADE: Place = Place(2048);
    /// The explanation of a result.
    pub(crate) const EXPLAIN: Place = Place(4096);
    /// An empty or fully selected field of a value: characters that cannot begin a value are
    /// commands.
    pub(crate) const FRESH: Place = Place(8192);
    /// The study.
    pub(crate) const STUDY: Place = Place(16384);
    /// A chart with its own axes, which has no roll angle.
    pub(crate) const OWN_CHART: Place = Place(32768);
    /// The contact pattern, a chart over roll angle and face width.
    pub(crate) const PATTERN: Place = Place(131_072);
    /// The tolerance, which replaces the study.
    pub(crate) const TOLERANCE: Place = Place(65536);
    /// A field that takes text or a name.
    pub(crate) const FORM: Place = Place::TEXT.or(Place::CHOICE);
    /// The panes in which letters are commands.
    pub(crate) const OUTSIDE: Place = Place::FIELD
        .or(Place::RESULTS)
        .or(Place::CURSOR)
        .or(Place::TRADE)
        .or(Place::STUDY)
        .or(Place::TOLERANCE)
        .or(Place::OWN_CHART)
        .or(Place::PATTERN);
    /// Every place except prompts.
    pub(crate) const WORK: Place = Place::FORM.or(Place::OUTSIDE);
    /// The places where `/` and `:` are commands.
    pub(crate) const COMMANDED: Place = Place::OUTSIDE.or(Place::CHOICE).or(Place::FRESH);
    /// Every chart.
    pub(crate) const CHARTS: Place = Place::CHART.or(Place::OWN_CHART);
    /// The panes with the cursor of the roll angle.
    pub(crate) const CURSOR: Place = Place::CHART.or(Place::TEETH);
    pub(in crate::tui) const PAGE: Place = Place::READ.or(Place::EXPLAIN);
    pub(in crate::tui) const LIST: Place = Place::BROWSE.or(Place::PICK);
    pub(in crate::tui) const LINE: Place = Place::TEXT.or(Place::LIST).or(Place::PATH);
    pub(in crate::tui) const PROMPT: Place =
        Place::LIST.or(Place::PATH).or(Place::ASK).or(Place::PAGE);
    pub(in crate::tui) const ALL: Place = Place::WORK.or(Place::PROMPT);
    /// The places where letters are more than commands of the table.
    pub(in crate::tui) const TYPED: Place = Place::LINE.or(Place::CHOICE).or(Place::ASK);

    /// Whether both sets have a place in common.
    pub const fn meets(self, other: Place) -> bool {
        self.0 & other.0 != 0
    }

    /// Whether this set contains every place of the other set.
    pub(crate) const fn holds(self, other: Place) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether letters go into a line of text.
    pub(crate) const fn is_line(self) -> bool {
        self.meets(Place::LINE)
    }

    pub(in crate::tui) const fn or(self, other: Place) -> Place {
        Place(self.0 | other.0)
    }
}

/// The name of a key with its modifiers, such as `Ctrl-S`, `Shift-Tab` or `x`.
pub(crate) fn name(event: KeyEvent) -> String {
    let (code, mut held) = (event.code, event.modifiers);
    // Shift is part of a letter and of Shift-Tab, and terminals differ in whether they report it.
    if matches!(code, KeyCode::Char(_) | KeyCode::BackTab) {
        held -= KeyModifiers::SHIFT;
    }
    let name = match code {
        // Ctrl-4 and Ctrl-\ are one byte, which the reader decodes as Ctrl-4.
        KeyCode::Char('4') if held == KeyModifiers::CONTROL => "\\".to_owned(),
        KeyCode::Char(' ') => "Space".to_owned(),
        KeyCode::Char(letter) if letter_of(code, held).is_some() => letter.to_string(),
        KeyCode::Char(letter) => letter.to_ascii_uppercase().to_string(),
        KeyCode::F(number) => format!("F{number}"),
        KeyCode::BackTab => "Shift-Tab".to_owned(),
        code => format!("{code:?}"),
    };
    let held = PREFIXES.iter().filter(|(one, _)| held.contains(*one));
    held.map(|(_, prefix)| *prefix).collect::<String>() + &name
}

/// The letter of a key without modifiers.
pub(crate) fn letter(event: KeyEvent) -> Option<char> {
    letter_of(event.code, event.modifiers)
}

fn letter_of(code: KeyCode, held: KeyModifiers) -> Option<char> {
    let is_plain = !held.intersects(KeyModifiers::CONTROL | KeyModifiers::ALT);
    code.as_char().filter(|_| is_plain)
}
