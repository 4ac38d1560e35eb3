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
use ratatui::text::Line;
use unicode_width::UnicodeWidthStr;

use super::layout::Pane;
use super::text;
use super::theme::Theme;

/// Least width of a pane that shows the keys of hidden panes, and of a title beside their names.
const LEAST_WIDTH: u16 = 30;
const BESIDE_NAMES: usize = 44;

/// Draws the lines of a table below each other: the headers, then the rows, of which one may be
/// selected.
pub(crate) fn draw_table(
    lines: &[String],
    marked: Option<usize>,
    theme: &Theme,
    area: Rect,
    buffer: &mut Buffer,
) {
    let style = |at: usize| match at.checked_sub(1) {
        None => theme.title,
        row if row == marked => theme.focus,
        _ => Style::new(),
    };
    let line = |line: &String| text::cut(line, area.width.into());
    let lines = lines.iter().enumerate().map(|(at, text)| Line::styled(line(text), style(at)));
    text::draw_lines(&lines.collect::<Vec<_>>(), area, buffer);
}

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
        let (theme, names, width) = (self.theme, self.names(area.width), usize::from(area.width));
        let room = width.saturating_sub(text::width(&names) + 4);
        let title = text::cut(&format!("{}{words}", self.key()), room);
        let style = if self.has_focus { theme.key } else { theme.title };
        let below = text::titled(&title, style, area, theme, buffer);
        if !area.is_empty() {
            let mark = if self.has_focus { "▸" } else { "" };
            text::put(mark, area, 1, theme.title, buffer);
            let start = area.right().saturating_sub(text::width(&names) as u16 + 1).max(area.x);
            text::put(&names, (start, area.y), width, Style::new(), buffer);
        }
        below
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
            (true, Pane::Form) => String::new(),
            (_, pane) => format!("{}{} ", self.leave(), pane.number()),
        }
    }

    /// The prefix of a letter key: a field takes letters as text.
    pub(crate) fn leave(&self) -> &'static str {
        if self.is_editing { "Esc " } else { "" }
    }

    // Keys and names of the hidden panes; only the keys beside a long title or in a pane alone.
    fn names(&self, width: u16) -> String {
        if self.hidden.is_empty() || width < LEAST_WIDTH {
            return String::new();
        }
        let leave = if self.is_editing { " Esc" } else { "" };
        let name = |pane: &Pane| format!(" {} {} ", pane.number(), pane.name());
        let names = leave.to_owned() + &self.hidden.iter().map(name).collect::<String>();
        let is_alone = self.hidden.len() + 1 == Pane::ALL.len();
        if !is_alone && names.width() + BESIDE_NAMES <= width.into() {
            return names;
        }
        let key = |pane: &Pane| format!(" {}", pane.number());
        format!("{leave}{} ", self.hidden.iter().map(key).collect::<String>())
    }
}
