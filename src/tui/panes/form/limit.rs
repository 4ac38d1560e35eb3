//! A limit as a row of the form, with its verdict.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::Form;
use super::line::{MARK, SYMBOL, draw_mark, draw_name, draw_text, label_width};
use crate::case::Limit;
use crate::model::Quantity;
use crate::report::verdict::verdict;
use crate::tui::ascii;
use crate::tui::rows;

/// Text between the symbol of a quantity and its limit, if the label does not fit.
const AT_MOST: &str = " <= ";

/// The sign of a free impact within the limit while the impact of the method exceeds it.
const ABOVE_BESIDE: &str = " (!)";

// Draws the limit as it is written, with its verdict.
pub(super) fn draw_limit(
    pane: &Form<'_>,
    index: usize,
    limit: &Limit,
    line: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = pane.look.theme;
    let style = if pane.focus == index { theme.focus } else { Style::new() };
    draw_mark(pane, index, line, buffer);
    let name = Rect { x: line.x + MARK, width: line.width.saturating_sub(MARK), ..line };
    let symbol = Quantity::find(limit.quantity).map_or("", |quantity| quantity.symbol);
    let symbol = ascii::symbol(symbol, pane.look.ascii);
    let label = rows::label(pane.case, index);
    let (words, of_word) = standing(pane, limit);
    let usual = label_width(name);
    let needed = limit.text.width() + words.get(1).map_or(0, |word| word.width() + 2);
    let is_whole = symbol.width() < SYMBOL.into()
        && label.width() <= usual.into()
        && usize::from(MARK + SYMBOL + 1) + label.width() + needed <= line.width.into();
    let offset = if is_whole {
        draw_name(&symbol, label, name, usual, style, buffer)
    } else {
        let named = format!("{symbol} {label}{AT_MOST}");
        let has_room = usize::from(MARK) + named.width() + needed <= line.width.into();
        let brief = if has_room { named } else { format!("{symbol}{AT_MOST}") };
        buffer.set_stringn(name.x, name.y, &brief, name.width.into(), style);
        (MARK + brief.width() as u16).min(line.width)
    };
    let left = usize::from(line.width - offset).saturating_sub(limit.text.width() + 2);
    // The label gives its unused columns to the verdict, so that a word fits rather than a sign.
    let spare = if is_whole { usize::from(usual).saturating_sub(label.width()) } else { 0 };
    let in_words = words.iter().take(2).find(|word| word.width() <= left + spare);
    let word = in_words
        .or_else(|| words.iter().find(|word| word.width() <= left))
        .cloned()
        .unwrap_or_default();
    let offset = offset - word.width().saturating_sub(left).min(spare) as u16;
    let room = line.width.saturating_sub(offset);
    let width = word.width() as u16;
    buffer.set_string(line.right() - width, line.y, &word, of_word);
    let value = Rect {
        x: line.x + offset,
        width: room.saturating_sub(width + u16::from(width > 0)),
        ..line
    };
    draw_text(
        pane,
        index,
        Some(&limit.text).filter(|text| !text.is_empty()).map(String::as_str),
        "(no limit)",
        value,
        style,
        buffer,
    )
}

// The verdict of the last valid result, from the full text to a sign, with its style.
fn standing(pane: &Form<'_>, limit: &Limit) -> (Vec<String>, Style) {
    let theme = pane.look.theme;
    let is_known = !pane.is_stale && !limit.text.is_empty();
    let solution = pane.answer.and_then(|answer| answer.of(answer.active)).filter(|_| is_known);
    let Some(verdict) = solution.map(|solution| verdict(limit, solution)) else {
        return (Vec::new(), Style::new());
    };
    let is_above_beside = verdict.is_exceeded_beside();
    let style =
        if verdict.standing.holds() && !is_above_beside { theme.note } else { theme.problem };
    let part = verdict.part().map_or_else(String::new, |part| format!(" {:.0} %", 100.0 * part));
    let beside = if is_above_beside { ABOVE_BESIDE } else { "" };
    let word = verdict.standing.word();
    let sign = if verdict.standing.holds() { word } else { "!" };
    (
        vec![
            format!("{word}{part}{beside}"),
            format!("{word}{beside}"),
            format!("{sign}{part}{beside}"),
            sign.to_owned(),
        ],
        style,
    )
}
