//! The path to save to.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use super::boxes::{WIDEST, frame, room};
use super::{Dialog, Outcome, Surroundings};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::session::save::Next;
use crate::tui::text;

/// How a name is given.
const NAMING: &str = "A name or a path, ~ is the home folder; without an ending it gets .toml. What is there already is asked about.";

/// The path to save to.
#[derive(Debug, Clone)]
pub struct SaveAs {
    /// The typed path.
    pub input: Line,
    /// The step after the save.
    pub next: Next,
}

impl Dialog for SaveAs {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        Outcome::SaveAs(self.input.value().to_owned(), self.next.clone())
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let how = text::wrap(NAMING, usize::from(room(area.as_size()).width));
        let size = Size::new(WIDEST, how.len() as u16 + 1);
        let inner = frame("Save as", size, area, theme, buffer);
        for (line, y) in how.iter().zip(inner.top() + 1..inner.bottom()) {
            buffer.set_stringn(inner.x, y, line, inner.width.into(), theme.faint);
        }
        let line = Rect {
            height: inner.height.min(1),
            ..inner
        };
        text::edited(&self.input, line, theme.focus, buffer)
    }
}
