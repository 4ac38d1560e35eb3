//! The panes: each file has the state and the drawing of one; and the titles of the panes.

pub(crate) mod chart;
pub(crate) mod cursor;
pub(crate) mod form;
pub(crate) mod plot;
pub(crate) mod results;
pub(crate) mod study;
pub(crate) mod teeth;
pub(crate) mod trade;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use super::App;
use crate::tui::layout::Pane;
use crate::tui::settings::Theme;
use crate::tui::text;

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
    text::draw_lines(lines, area, buffer);
}

impl App {
    /// The area of a pane with its title; empty if the pane is hidden.
    pub(crate) fn area(&self, pane: Pane) -> Rect {
        self.layout.plan().area(pane)
    }

    /// Whether a pane has the focus.
    fn has_focus(&self, pane: Pane) -> bool {
        self.layout.focus == pane && self.prompts.is_empty()
    }

    /// The prefix of a letter key: a field takes letters as text.
    fn leave(&self) -> &'static str {
        if self.has_line() { "Esc " } else { "" }
    }

    // The form has no key while one of its fields is edited.
    fn key_of(&self, pane: Pane) -> String {
        match pane {
            Pane::Form if self.has_line() => String::new(),
            _ => format!("{}{} ", self.leave(), pane.number()),
        }
    }

    /// The keys to type for a command of a pane.
    fn key_to(&self, pane: Pane, command: &str) -> String {
        let key = if self.has_focus(pane) { String::new() } else { self.key_of(pane) };
        key + command
    }

    /// Draws the title line of a pane. Returns the area below it.
    fn draw_title(&self, pane: Pane, words: &str, buffer: &mut Buffer) -> Rect {
        let (area, theme, names) = (self.area(pane), self.look.theme, self.hidden_names(pane));
        let (mark, style) =
            if self.has_focus(pane) { (Some("▸"), theme.key) } else { (None, theme.title) };
        let title = format!("{}{words}", self.key_of(pane));
        let room = area.width.saturating_sub(names.width() as u16);
        let block = text::titled(mark, &title, style, room, theme);
        let names = Line::from_iter([Span::raw(names), Span::styled("─", theme.rule)]);
        text::framed(&block.title(names.right_aligned()), area, buffer)
    }

    /// The hidden pane whose name or key is at a cell of a title.
    pub(crate) fn hidden_at(&self, at: Position) -> Option<Pane> {
        let plan = self.layout.plan();
        let owner = plan.names_hidden()?;
        let (area, names) = (plan.area(owner), self.hidden_names(owner));
        let from = area.right().checked_sub(names.width() as u16 + 1)?;
        let column = usize::from(at.x.checked_sub(from)?);
        let begins = |pane: &Pane| {
            names.find(&format!(" {}", pane.number())).is_some_and(|start| start <= column)
        };
        let named = plan.hidden().filter(begins).last();
        named.filter(|_| at.y == area.y && column < names.width())
    }

    // Keys and names of the hidden panes in the title of a pane; only the keys beside a long title or
    // in a pane alone.
    fn hidden_names(&self, pane: Pane) -> String {
        let plan = self.layout.plan();
        let hidden: Vec<Pane> = plan.hidden().collect();
        let width = plan.area(pane).width;
        if plan.names_hidden() != Some(pane) || hidden.is_empty() || width < LEAST_WIDTH {
            return String::new();
        }
        let leave = if self.has_line() { " Esc" } else { "" };
        let name = |pane: &Pane| format!(" {} {} ", pane.number(), pane.name());
        let names = leave.to_owned() + &hidden.iter().map(name).collect::<String>();
        let is_alone = hidden.len() + 1 == Pane::ALL.len();
        if !is_alone && names.width() + BESIDE_NAMES <= width.into() {
            return names;
        }
        let key = |pane: &Pane| format!(" {}", pane.number());
        format!("{leave}{} ", hidden.iter().map(key).collect::<String>())
    }
}
