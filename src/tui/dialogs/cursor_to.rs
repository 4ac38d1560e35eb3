//! The dialog for the roll angle, time or point of the cursor.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::{Dialog, Outcome, Surroundings, boxes};
use crate::tui::cursor_range::{HOW, describe, ending, parse_cursor};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::text;

/// The width at which the instruction has two lines.
const WIDTH: u16 = 62;

/// The dialog with its typed text.
#[derive(Debug, Clone, Default)]
pub struct CursorTo {
    /// The typed text.
    pub(crate) input: Line,
}

impl Dialog for CursorTo {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, around: &Surroundings<'_>) -> Outcome {
        let angle = parse_cursor(&around.cursor, self.input.value());
        if angle.is_err() {
            // Typing replaces the invalid text.
            self.input.select_all();
        }
        Outcome::CursorTo(angle)
    }

    fn draw(
        &self,
        around: &Surroundings<'_>,
        screen: Rect,
        buffer: &mut Buffer,
    ) -> Option<Position> {
        let (input, scope) = (&self.input, &around.cursor);
        let theme = around.look.theme;
        let how = text::wrap(HOW, usize::from(WIDTH.min(boxes::room(screen.as_size()).width)));
        let inner = boxes::frame(
            "Cursor to",
            Size::new(WIDTH, how.len() as u16 + 2),
            screen,
            theme,
            buffer,
        );
        let (meant, style) = match parse_cursor(scope, input.value()) {
            _ if input.value().trim().is_empty() => (String::new(), theme.faint),
            Ok(angle) => (format!("= {}", describe(scope, angle)), theme.note),
            Err(reason) => (reason, theme.faint),
        };
        let lines =
            std::iter::once((meant, style)).chain(how.into_iter().map(|line| (line, Style::new())));
        for ((line, style), y) in lines.zip(inner.top() + 1..inner.bottom()) {
            buffer.set_stringn(
                inner.x,
                y,
                text::cut(&line, inner.width.into()),
                inner.width.into(),
                style,
            );
        }
        let line = Rect { height: inner.height.min(1), ..inner };
        let cursor = text::edited(input, line, theme.focus, buffer);
        text::ending(
            ending(scope, input.value()).as_deref(),
            input.value().width(),
            line,
            theme,
            buffer,
        );
        cursor
    }
}
