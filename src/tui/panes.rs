//! The panes as components. Each has its state, commands, update and drawing, and does not depend
//! on the other panes or on the workbench.

pub(crate) mod chart;
pub(crate) mod form;
pub(crate) mod plot;
pub(crate) mod results;
pub(crate) mod study;
pub(crate) mod teeth;
pub(crate) mod trade;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::layout::Pane;
use super::text;
use super::theme::Theme;

/// Least width of a title beside the keys of hidden panes, and beside their names.
const BESIDE_KEYS: usize = 32;
const BESIDE_NAMES: usize = 44;
/// The same beside names in a pane that fills the screen: at least its width among other panes.
const ALONE: usize = 80;
/// Prefix of the number of a pane while a field takes the digits.
const LEAVE: &str = "Esc ";

/// The title line of a pane.
#[derive(Debug, Clone)]
pub(crate) struct Title {
    pub(crate) pane: Pane,
    /// Whether the pane has the focus.
    pub(crate) has_focus: bool,
    /// Whether a field takes the digits.
    pub(crate) is_editing: bool,
    /// The hidden panes, if this title names them.
    pub(crate) hidden: Vec<Pane>,
    /// The colours.
    pub(crate) theme: &'static Theme,
}

impl Title {
    /// Draws the line and returns the area below it.
    pub(crate) fn draw(&self, words: &str, area: Rect, buffer: &mut Buffer) -> Rect {
        let names = self.names(area.width);
        let room = room_beside(&names, area.width);
        let title = text::cut(&format!("{}{words}", self.key()), room.saturating_sub(4));
        let inner = text::titled(&title, area, self.theme, buffer);
        if self.has_focus && area.width > 4 {
            buffer.set_string(area.x, area.y, "▸", self.theme.title);
            buffer.set_stringn(
                area.x + 1,
                area.y,
                format!(" {title} "),
                usize::from(area.width) - 1,
                self.theme.key,
            );
        }
        if !names.is_empty() {
            buffer.set_string(area.x + room as u16, area.y, &names, Style::new());
        }
        inner
    }

    /// The hidden pane whose name or key is at a cell.
    pub(crate) fn hidden_at(&self, area: Rect, at: Position) -> Option<Pane> {
        let names = self.names(area.width);
        let from = area.right().checked_sub(names.width() as u16 + 1)?;
        let column = usize::from(at.x.checked_sub(from)?);
        let begins = |pane: &&Pane| {
            names.find(&format!(" {}", pane.number())).is_some_and(|start| start <= column)
        };
        let named = self.hidden.iter().rfind(begins);
        named.filter(|_| at.y == area.y && column < names.width()).copied()
    }

    /// The keys to type for a command of the pane.
    fn key_to(&self, command: &str) -> String {
        if self.has_focus { command.to_owned() } else { format!("{}{command}", self.key()) }
    }

    // While a field is edited, the key begins with Esc, since digits are part of the value. The
    // form has no key while one of its fields is edited.
    fn key(&self) -> String {
        match (self.is_editing, self.pane) {
            (false, pane) => format!("{} ", pane.number()),
            (true, Pane::Form) => String::new(),
            (true, pane) => format!("{LEAVE}{} ", pane.number()),
        }
    }

    // Keys and names of the hidden panes; only the keys if the names do not fit; empty in a narrow
    // pane.
    fn names(&self, width: u16) -> String {
        if self.hidden.is_empty() {
            return String::new();
        }
        let leave = if self.is_editing { format!(" {}", LEAVE.trim_end()) } else { String::new() };
        let hidden = || self.hidden.iter();
        let names: Vec<String> =
            hidden().map(|pane| format!(" {} {} ", pane.number(), pane.name())).collect();
        let names = names.concat();
        let keys: String =
            hidden().map(|pane| format!(" {}", pane.number())).chain([" ".to_owned()]).collect();
        let is_alone = self.hidden.len() + 1 == Pane::ALL.len();
        let beside_names = if is_alone { ALONE } else { BESIDE_NAMES };
        let sayings =
            [(format!("{leave}{names}"), beside_names), (format!("{leave}{keys}"), BESIDE_KEYS)];
        let fits = sayings.into_iter().find(|(words, least)| room_beside(words, width) >= *least);
        fits.map_or_else(String::new, |(words, _)| words)
    }
}

// The names are at the right end, before one cell of the rule.
fn room_beside(names: &str, width: u16) -> usize {
    let taken = if names.is_empty() { 0 } else { names.width() + 1 };
    usize::from(width).saturating_sub(taken)
}
