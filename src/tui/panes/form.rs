//! The form: every field of the case in its group; below an invalid field the reason.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};
use unicode_width::UnicodeWidthStr;

use super::Title;
use crate::case::fields::{GROUPS, Kind};
use crate::case::{Acting, Case, FIELDS, Limit, Problem, relevance};
use crate::model::{Inputs, Quantity};
use crate::report::verdict::verdict;
use crate::tui::ascii::{self, symbol};
use crate::tui::form_aids::materials;
use crate::tui::line::Line as Text;
use crate::tui::solver::Answer;
use crate::tui::theme::Look;
use crate::tui::{rows, text};

/// The mark of a field without effect.
const IDLE: &str = "-";
/// The least width of a label beside a symbol.
const LEAST_LABEL: u16 = 6;

const MARK: u16 = 2;
/// The mark of a field that differs from the file.
const EDITED: &str = "*";

const SYMBOL: u16 = 6;
const LABEL: u16 = 20;
const VALUE: u16 = 15;
/// The width of a value on a narrow screen.
const NARROW_VALUE: u16 = 11;
const WHOLE: u16 = MARK + SYMBOL + LABEL + 1 + VALUE;

/// Text between the symbol of a quantity and its limit, if the label does not fit.
const AT_MOST: &str = " <= ";

/// The sign of a free impact within the limit while the impact of the method exceeds it.
const ABOVE_BESIDE: &str = " (!)";

/// The state of the pane, separate for each open case.
#[derive(Debug, Clone)]
pub struct FormState {
    /// The focused row.
    pub focus: usize,
    /// Its typed text with the cursor. The case has the text with its unit.
    pub input: Text,
    /// The unit of the row when it got the focus.
    pub(crate) written_unit: Option<String>,
    /// The first visible line.
    pub top: usize,
    /// The lines, computed once per event.
    pub(crate) lines: Lines,
}

impl FormState {
    /// Focus on a row, with the cursor at the end of its text.
    #[must_use]
    pub(crate) fn at(case: &Case, focus: usize) -> FormState {
        FormState {
            focus,
            input: Text::whole(rows::text(case, focus).unwrap_or_default()),
            written_unit: rows::written_unit(case, focus),
            top: 0,
            lines: Lines::default(),
        }
    }
}

/// The form with its case.
#[derive(Debug, Clone)]
pub(crate) struct Form<'a> {
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// The case in the file.
    pub(crate) saved: &'a Case,
    /// The inputs of the valid fields.
    pub(crate) inputs: &'a Inputs,
    /// The invalid rows.
    pub(crate) problems: &'a [(usize, Problem)],
    /// The row that the fix of the model's refusal names first.
    pub(crate) refused: Option<usize>,
    /// The last valid results.
    pub(crate) answer: Option<&'a Answer>,
    /// Whether they are older than the form.
    pub(crate) is_stale: bool,
    /// The focused row.
    pub(crate) focus: usize,
    /// Its text while it is edited.
    pub(crate) line: Option<&'a Text>,
    /// The completion of that text.
    pub(crate) ending: Option<String>,
    /// The first visible line.
    pub(crate) top: usize,
    /// The lines, computed after the last event.
    pub(crate) lines: &'a Lines,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The title line.
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

impl Form<'_> {
    /// Whether the value of a row is only invalid because it is unfinished.
    pub(crate) fn is_unfinished(&self, row: usize) -> bool {
        let line = self.line.filter(|_| self.focus == row);
        line.is_some_and(|line| rows::is_unfinished(self.case, row, line.value()))
    }

    /// Whether a row is invalid, or the model refuses the case because of it.
    fn is_faulty(&self, row: usize) -> bool {
        self.refused == Some(row) || self.problems.iter().any(|(at, _)| *at == row)
    }

    fn lacks(&self, row: usize) -> bool {
        rows::lacks(self.case, row)
    }
}

/// The lines of the form in a pane of a width.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Lines {
    width: u16,
    rows: Vec<Row>,
}

impl Lines {
    /// The lines of the form in its pane.
    pub(crate) fn of(pane: &Form<'_>) -> Lines {
        let width = pane.area.width;
        Lines { width, rows: rows(pane, width) }
    }
}

/// Draws the form. Returns the position of the text cursor.
pub(crate) fn draw(pane: &Form<'_>, buffer: &mut Buffer) -> Option<Position> {
    let area = pane.area;
    // The terminal may have a new size that has not been reported yet.
    let resized = (area.width != pane.lines.width).then(|| Lines::of(pane));
    let rows = &resized.as_ref().unwrap_or(pane.lines).rows;
    let inner = pane.title.draw("Form", area, buffer);
    if inner.is_empty() {
        return None;
    }
    let mut cursor = None;
    for (row, y) in rows.iter().skip(pane.top).zip(inner.top()..inner.bottom()) {
        let line = Rect { y, height: 1, width: inner.width - 1, ..inner };
        cursor = draw_row(pane, row, line, buffer).or(cursor);
    }
    text::scroll_bar(
        pane.top,
        rows.len(),
        Rect { x: inner.right() - 1, width: 1, ..inner },
        buffer,
    );
    cursor
}

/// The first visible line such that the focused field is visible with its reason and, if possible,
/// with its group.
pub(crate) fn top_for(pane: &Form<'_>) -> usize {
    let area = pane.area;
    if area.is_empty() {
        return pane.top;
    }
    let height = usize::from(area.height.saturating_sub(1)).max(1);
    let rows = &pane.lines.rows;
    let focused = rows.iter().position(|row| *row == Row::Line(pane.focus)).unwrap_or(0);
    let reasons =
        rows[focused + 1..].iter().take_while(|row| matches!(row, Row::Reason(_))).count();
    let follows_group = focused > 0 && matches!(rows[focused - 1], Row::Group(_));
    let first = focused - usize::from(follows_group);
    let ahead = usize::from(height > 4);
    let least = (focused + reasons + 1 + ahead).min(rows.len()).saturating_sub(height);
    let most = rows.len().saturating_sub(height);
    pane.top.max(least).min(first.max(least)).min(most)
}

/// The field at a cell, if any.
pub(crate) fn field_at(pane: &Form<'_>, at: Position) -> Option<usize> {
    let area = pane.area;
    let line = usize::from(at.y.checked_sub(area.y + 1)?);
    match pane.lines.rows.get(pane.top + line)? {
        Row::Line(index) => Some(*index),
        Row::Group(_) | Row::Reason(_) => None,
    }
}

/// The first visible line after scrolling by lines downwards.
#[must_use]
pub(crate) fn scrolled(pane: &Form<'_>, by: isize) -> usize {
    let area = pane.area;
    let height = usize::from(area.height.saturating_sub(1));
    let most = pane.lines.rows.len().saturating_sub(height);
    pane.top.saturating_add_signed(by).min(most)
}

/// A line of the form.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Row {
    /// The title of the group whose first line has this index.
    Group(usize),
    /// A field or a limit, by its index among the focusable rows.
    Line(usize),
    Reason(String),
}

fn rows(pane: &Form<'_>, width: u16) -> Vec<Row> {
    let count = rows::count(pane.case);
    let groups = rows::groups(pane.case);
    let mut lines = Vec::with_capacity(count + groups.len() + pane.problems.len());
    for index in 0..count {
        if groups.contains(&index) {
            lines.push(Row::Group(index));
        }
        lines.push(Row::Line(index));
        lines.extend(reasons(pane, index, width).map(Row::Reason));
    }
    lines
}

// The title of a group; for a gear with its material, if known.
fn group_title(pane: &Form<'_>, index: usize) -> String {
    let Some(field) = rows::field(pane.case, index) else {
        return "Limits".to_owned();
    };
    let title =
        GROUPS.iter().find(|(table, _)| *table == field.table()).map_or("", |(_, title)| title);
    let material = materials::name_of_gear(pane.case, field.table());
    material.map_or_else(|| title.to_owned(), |material| format!("{title}, {material}"))
}

// The reasons of an invalid field. An unfinished value is explained in the hint until the user
// leaves the field. A missing value has no reason: the field shows that it is required.
fn reasons(pane: &Form<'_>, field: usize, width: u16) -> impl Iterator<Item = String> {
    let has_reason = !pane.is_unfinished(field) && !pane.lacks(field);
    let own = pane.problems.iter().filter(move |(at, _)| *at == field && has_reason);
    own.flat_map(move |(_, problem)| {
        let lines = text::wrap(
            &format!("{}: {}", problem.cause, problem.fix),
            usize::from(width).saturating_sub(5),
        );
        lines
            .into_iter()
            .enumerate()
            .map(|(index, line)| format!("{} {line}", if index == 0 { "!" } else { " " }))
    })
}

fn draw_row(pane: &Form<'_>, row: &Row, line: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = pane.look.theme;
    match row {
        Row::Group(index) => {
            let title = text::cut(&group_title(pane, *index), line.width.into());
            buffer.set_stringn(line.x, line.y, title, line.width.into(), theme.title);
            None
        }
        Row::Reason(reason) => {
            buffer.set_stringn(line.x + MARK, line.y, reason, line.width.into(), theme.problem);
            None
        }
        Row::Line(index) => match rows::row(pane.case, *index) {
            rows::Row::Field(field) => draw_field(pane, field, line, buffer),
            rows::Row::Limit(limit) => draw_limit(pane, *index, limit, line, buffer),
        },
    }
}

fn draw_field(pane: &Form<'_>, index: usize, line: Rect, buffer: &mut Buffer) -> Option<Position> {
    let field = &FIELDS[index];
    let theme = pane.look.theme;
    let is_idle = matches!(relevance(index, pane.inputs), Acting::No(_));
    let style = match (pane.focus == index, is_idle) {
        (true, _) => theme.focus,
        (false, true) => theme.faint,
        (false, false) => Style::new(),
    };
    if is_idle {
        buffer.set_stringn(line.x, line.y, IDLE, 1, style);
    }
    draw_mark(pane, index, line, buffer);
    let name = Rect { x: line.x + MARK, width: line.width.saturating_sub(MARK), ..line };
    let offset = if matches!(field.kind, Kind::Text) {
        draw_words(field.label, name, style, buffer)
    } else {
        let (usual, label) = (label_width(name), field.label.width() as u16);
        let least = if field.symbol.is_empty() { label } else { label.min(LEAST_LABEL) };
        let over = longer(pane, index, line.width - (MARK + SYMBOL + usual + 1))
            .min(usual.saturating_sub(least));
        draw_name(
            &symbol(field.symbol, pane.look.ascii),
            field.label,
            name,
            usual - over,
            style,
            buffer,
        )
    };
    let value = Rect { x: line.x + offset, width: line.width.saturating_sub(offset), ..line };
    draw_value(pane, index, value, style, buffer)
}

// By how many columns a value that is not edited exceeds its room.
fn longer(pane: &Form<'_>, index: usize, room: u16) -> u16 {
    let shown = pane.case.text(index).map_or_else(
        || rows::unwritten(pane.case, pane.inputs, index),
        |text| ascii::printable(text).into_owned(),
    );
    let is_edited = pane.focus == index && pane.line.is_some() && pane.case.text(index).is_some();
    if is_edited { 0 } else { (shown.width() as u16).saturating_sub(room) }
}

// A text has no symbol; its value needs the room.
fn draw_words(label: &str, area: Rect, style: Style, buffer: &mut Buffer) -> u16 {
    buffer.set_stringn(area.x, area.y, label, SYMBOL.into(), style);
    MARK + SYMBOL
}

fn draw_value(
    pane: &Form<'_>,
    index: usize,
    area: Rect,
    style: Style,
    buffer: &mut Buffer,
) -> Option<Position> {
    let unwritten = rows::unwritten(pane.case, pane.inputs, index);
    let written = pane.case.text(index);
    let is_edited = pane.focus == index && pane.line.is_some();
    if is_edited && matches!(FIELDS[index].kind, Kind::Choice(..)) {
        let shown = written.map_or(unwritten, |text| ascii::printable(text).into_owned());
        let width = usize::from(area.width);
        buffer.set_stringn(area.x, area.y, text::cut(&format!("‹ {shown} ›"), width), width, style);
        return None;
    }
    draw_text(pane, index, written, &unwritten, area, style, buffer)
}

fn draw_mark(pane: &Form<'_>, index: usize, line: Rect, buffer: &mut Buffer) {
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
fn label_width(area: Rect) -> u16 {
    let value = if area.width + MARK < WHOLE { NARROW_VALUE } else { VALUE };
    LABEL.min(area.width.saturating_sub(SYMBOL + 1 + value))
}

// Draws symbol and label. Returns their width.
fn draw_name(
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
fn draw_text(
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

// Draws the limit as it is written, with its verdict.
fn draw_limit(
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
    let Some(verdict) = solution.and_then(|solution| verdict(limit, solution)) else {
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
