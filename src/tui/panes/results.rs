//! The results pane: the outcome as a sentence, the gauges, every quantity with the methods side by
//! side, and the notes.

mod gauges;
mod limits;
mod pane;
mod parts;
mod selection;
mod table;
mod title;
mod words;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::model::Quantity;
use crate::tui::text;
pub(crate) use pane::{Results, ResultsState};
use parts::parts;
use selection::line_of;
pub use selection::{count, marked, page};
pub(crate) use selection::{followed, listed, place_of, row_at, scrolled, top_for};
use title::title;
pub(crate) use words::in_full;

pub(crate) fn draw(pane: &Results<'_>, buffer: &mut Buffer) {
    let area = pane.area;
    let parts = parts(pane);
    let words = title(pane, parts.rows, pane.title.room(area.width));
    let inner = pane.title.draw(&words, area, buffer);
    let Some(answer) = pane.answer else {
        text::draw_lines(&parts.head, inner, buffer);
        return;
    };
    let inner =
        Rect { x: inner.x + inner.width.min(1), width: inner.width.saturating_sub(1), ..inner };
    let table = table::lines(pane, answer, inner.width.into());
    let quantities = table.rows.iter().skip(pane.state.top).take(parts.rows);
    let before = parts.head.len() + 2;
    let lines: Vec<Line<'static>> = parts
        .head
        .into_iter()
        .chain([table.heading])
        .chain(quantities.cloned())
        .chain(parts.notes)
        .collect();
    text::draw_lines(&lines, inner, buffer);
    if pane.is_focused
        && let Some(line) = line_of(pane, pane.state.row)
            .checked_sub(pane.state.top)
            .filter(|&line| line < parts.rows)
    {
        let y = area.y + (before + line) as u16;
        buffer.set_stringn(area.x, y, "▸", 1, pane.look.theme.focus);
    }
}

/// The value of the selected quantity with the value of the baseline, if one is pinned.
#[must_use]
pub(crate) fn compared(pane: &Results<'_>, quantity: &Quantity) -> Option<String> {
    table::compared(pane, pane.answer?, quantity)
}

/// The number of variants that fit side by side.
#[must_use]
pub(crate) fn variants_page(pane: &Results<'_>) -> usize {
    table::variants_page(pane, usize::from(pane.area.width.saturating_sub(1)))
}
