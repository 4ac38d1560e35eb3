//! The prompt for the cursor: a line of text, and the angle that it means.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::{boxes, text};
use crate::tui::app::App;
use crate::tui::cursor_range::{HOW, describe, ending, parse_cursor};
use crate::tui::line::Line;

/// The width at which the instruction has two lines.
const WIDTH: u16 = 62;

/// Draws the prompt over the screen. Returns the place of the text cursor.
pub fn draw(app: &App, input: &Line, screen: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = app.look.theme;
    let how = text::wrap(
        HOW,
        usize::from(WIDTH.min(boxes::room(screen.as_size()).width)),
    );
    let inner = boxes::frame(
        "Cursor to",
        Size::new(WIDTH, how.len() as u16 + 2),
        screen,
        theme,
        buffer,
    );
    let (meant, style) = match parse_cursor(app, input.value()) {
        _ if input.value().trim().is_empty() => (String::new(), theme.faint),
        Ok(angle) => (format!("= {}", describe(app, angle)), theme.note),
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
    let line = Rect {
        height: inner.height.min(1),
        ..inner
    };
    let cursor = text::edited(input, line, theme.focus, buffer);
    text::ending(
        ending(app, input.value()).as_deref(),
        input.value().width(),
        line,
        theme,
        buffer,
    );
    cursor
}
