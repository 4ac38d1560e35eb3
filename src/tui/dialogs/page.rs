//! A page of text.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;

use super::boxes::{extent, frame, page_height, room};
use super::{Dialog, Outcome, Surroundings};
use crate::tui::keys::Place;
use crate::tui::text;
use crate::tui::theme::Theme;

/// A page of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// The title.
    pub(crate) title: String,
    pub(crate) lines: Vec<String>,
    /// The first visible line.
    pub(crate) top: usize,
    /// Whether it shows the outcome of the open case.
    pub(crate) is_of_results: bool,
}

impl Page {
    /// A page that shows its first line.
    #[must_use]
    pub(crate) fn new(title: impl Into<String>, lines: Vec<String>) -> Page {
        Page { title: title.into(), lines, top: 0, is_of_results: false }
    }

    fn scroll(&mut self, by: isize, screen: Size) {
        let last = wrapped(self, screen).len().saturating_sub(room(screen).height.into());
        self.top = self.top.saturating_add_signed(by).min(last);
    }
}

impl Dialog for Page {
    fn place(&self) -> Place {
        Place::READ
    }

    fn step(&mut self, by: isize, around: &Surroundings<'_>) {
        self.scroll(by, around.screen);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        self.scroll(by * page_height(around.screen), around.screen);
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        Outcome::none()
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw_page(self, area, around.look.theme, buffer);
        None
    }
}

// The lines of a page wrapped for its box; continuation lines are indented.
fn wrapped(page: &Page, screen: Size) -> Vec<String> {
    let width = usize::from(room(screen).width);
    let wrap = |line: &String| {
        let indent = hanging(line);
        let (head, text) = line.split_at(indent);
        let pieces = text::wrap(text, width.saturating_sub(indent));
        let head = head.to_owned();
        pieces.into_iter().enumerate().map(move |(index, piece)| {
            if index == 0 { head.clone() + &piece } else { " ".repeat(indent) + &piece }
        })
    };
    page.lines.iter().flat_map(wrap).collect()
}

// The indent of continuation lines: the second column of the line, if it has one.
fn hanging(line: &str) -> usize {
    let lead = line.len() - line.trim_start().len();
    let gap = line[lead..].find("  ").map(|at| lead + at);
    let column = gap.map(|gap| line.len() - line[gap..].trim_start().len());
    column.filter(|_| line.is_ascii()).unwrap_or(lead)
}

fn draw_page(page: &Page, screen: Rect, theme: &Theme, buffer: &mut Buffer) {
    let lines = wrapped(page, screen.as_size());
    let inner = frame(&page.title, extent(&lines, 0), screen, theme, buffer);
    for (line, y) in lines.iter().skip(page.top).zip(inner.top()..inner.bottom()) {
        buffer.set_stringn(inner.x, y, line, inner.width.into(), Style::new());
    }
    text::scroll_bar_beside(page.top, lines.len(), inner, buffer);
}
