//! Error of every rung against its time.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::titled;
use crate::tui::app::App;
use crate::tui::pane::Pane;

/// Draw the pane.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let inner = titled(app, Pane::Trade, "Error against time", area, buffer);
    let width = usize::from(inner.width).saturating_sub(1);
    if !inner.is_empty() {
        buffer.set_stringn(inner.x + 1, inner.y, "Nothing is measured yet.", width, Style::new());
    }
}
