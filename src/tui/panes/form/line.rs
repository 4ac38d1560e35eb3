//! The parts of a row of the form: its mark, its name and its text.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use unicode_width::UnicodeWidthStr;

use super::Form;
use crate::tui::ascii;
use crate::tui::rows;
use crate::tui::text;

pub(super) const MARK: u16 = 2;
/// The mark of a field that differs from the file.
const EDITED: &str = "*";
pub(super) const SYMBOL: u16 = 6;
const LABEL: u16 = 20;
const VALUE: u16 = 15;
/// The width of a value on a narrow screen.
const NARROW_VALUE: u16 = 11;
const WHOLE: u16 = MARK + SYMBOL + LABEL + 1 + VALUE;

pub(super) fn draw_mark(pane: &Form<'_>, index: usize, line: Rect, buffer: &mut Buffer) {
    let theme = pane.look.theme;
    if rows::differs(pane.case, pane.saved, index) {
        buffer.set_stringn(line.x + 1, line.y, EDITED, usize::from(line.width > 1), theme.note);
    }
    // The reason below the row has a mark of its own.
    if pane.focus == index {
        buffer.set_stringn(line.x, line.y, "▸", 1, theme.focus);
    } else if pane.is_faulty(index) {
        buffer.set_stringn(line.x, line.y, "!", 1, theme.problem);
    }
}

// Width of the labels beside values of the default width.
pub(super) fn label_width(area: Rect) -> u16 {
    let value = if area.width + MARK < WHOLE { NARROW_VALUE } else { VALUE };
    LABEL.min(area.width.saturating_sub(SYMBOL + 1 + value))
}

// Draws symbol and label. Returns their width.
pub(super) fn draw_name(
    symbol: &str,
    label: &str,
    area: Rect,
    width: u16,
    style: Style,
    buffer: &mut Buffer,
) -> u16 {
    let name = text::cut(symbol, usize::from(SYMBOL) - 1);
    buffer.set_stringn(area.x, area.y, name, SYMBOL.into(), style);
    buffer.set_stringn(
        area.x + SYMBOL,
        area.y,
        text::cut(label, width.into()),
        width.into(),
        style,
    );
    MARK + SYMBOL + width + 1
}

// Draws the text of a row: an input line if the row is edited, otherwise its value or its default.
pub(super) fn draw_text(
    pane: &Form<'_>,
    index: usize,
    written: Option<&str>,
    unwritten: &str,
    area: Rect,
    style: Style,
    buffer: &mut Buffer,
) -> Option<Position> {
    let width = usize::from(area.width);
    let line = pane.line.filter(|_| pane.focus == index);
    if let Some(line) = line.filter(|_| written.is_some()) {
        let style = style.add_modifier(Modifier::UNDERLINED);
        let cursor = text::edited(line, area, style, buffer);
        text::ending(pane.ending.as_deref(), line.value().width(), area, pane.look.theme, buffer);
        return cursor;
    }
    let shown = written.map_or(unwritten.into(), ascii::printable);
    let faint = if written.is_none() && !pane.lacks(index) { pane.look.theme.faint } else { style };
    buffer.set_stringn(area.x, area.y, text::cut(&shown, width), width, faint);
    line.is_some().then_some(Position::new(area.x, area.y))
}
