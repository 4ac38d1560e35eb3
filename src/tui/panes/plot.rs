//! Parts of every plot: axes and marks.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

/// Draws the lines left of the cells and below them. Returns their column and their row.
pub(crate) fn draw_axes(cells: Rect, rule: Style, buffer: &mut Buffer) -> (u16, u16) {
    let (left, bottom) = (cells.x - 1, cells.bottom());
    for y in cells.top()..bottom {
        buffer.set_string(left, y, "│", rule);
    }
    buffer.set_string(left, bottom, "└", rule);
    buffer.set_string(cells.x, bottom, "─".repeat(cells.width.into()), rule);
    (left, bottom)
}

/// Writes into a blank cell.
pub(crate) fn put_where_free(at: (u16, u16), symbol: &str, style: Style, buffer: &mut Buffer) {
    if buffer.cell(at).is_some_and(|cell| cell.symbol() == " ") {
        buffer.set_string(at.0, at.1, symbol, style);
    }
}
