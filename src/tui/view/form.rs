//! The form: every field of the case in its group, and under a wrong one the reason.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::{plan, text, titled};
use crate::case::fields::{GROUPS, Kind};
use crate::case::{FIELDS, Field};
use crate::tui::app::{self, App};
use crate::tui::clean::{clean, symbol};
use crate::tui::pane::Pane;

const MARK: u16 = 2;
const SYMBOL: u16 = 6;
const LABEL: u16 = 20;
const VALUE: u16 = 15;
/// On a narrow screen the label gets some of the value's room.
const NARROW_VALUE: u16 = 11;
const WHOLE: u16 = MARK + SYMBOL + LABEL + 1 + VALUE;

/// A line of the form.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Row {
    Group(&'static str),
    Field(usize),
    Reason(String),
}

/// Draw the form; where the cursor stands.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let rows = rows(app, area.width);
    let inner = titled(app, Pane::Form, "Form", area, buffer);
    if inner.is_empty() {
        return None;
    }
    let mut cursor = None;
    for (row, y) in rows.iter().skip(app.form_top).zip(inner.top()..inner.bottom()) {
        let line = Rect { y, height: 1, width: inner.width - 1, ..inner };
        cursor = draw_row(app, row, line, buffer).or(cursor);
    }
    scroll_bar(app.form_top, rows.len(), Rect { x: inner.right() - 1, width: 1, ..inner }, buffer);
    cursor
}

/// The first line to be shown, so that the focused field is in sight with its reason and, at the top, its group.
#[must_use]
pub fn top_for(app: &App) -> usize {
    let area = plan(app.size, app.panes).form;
    if area.is_empty() {
        return app.form_top;
    }
    let height = usize::from(area.height.saturating_sub(1)).max(1);
    let rows = rows(app, area.width);
    let focused = rows.iter().position(|row| *row == Row::Field(app.focus)).unwrap_or(0);
    let reasons = rows[focused + 1..].iter().take_while(|row| matches!(row, Row::Reason(_))).count();
    let follows_group = focused > 0 && matches!(rows[focused - 1], Row::Group(_));
    let first = focused - usize::from(follows_group);
    let ahead = usize::from(height > 4);
    let least = (focused + reasons + 1 + ahead).min(rows.len()).saturating_sub(height);
    let most = rows.len().saturating_sub(height);
    app.form_top.max(least).min(first.max(least)).min(most)
}

/// The field on a cell, where there is one.
#[must_use]
pub fn field_at(app: &App, area: Rect, at: Position) -> Option<usize> {
    let line = usize::from(at.y.checked_sub(area.y + 1)?);
    match rows(app, area.width).get(app.form_top + line)? {
        Row::Field(index) => Some(*index),
        Row::Group(_) | Row::Reason(_) => None,
    }
}

/// The first line to be shown after so many lines downwards.
#[must_use]
pub fn scrolled(app: &App, by: isize) -> usize {
    let area = plan(app.size, app.panes).form;
    let most = rows(app, area.width).len().saturating_sub(area.height.saturating_sub(1).into());
    app.form_top.saturating_add_signed(by).min(most)
}

/// A bar whose thumb shows which part of the lines is in sight.
pub fn scroll_bar(top: usize, lines: usize, area: Rect, buffer: &mut Buffer) {
    let height = usize::from(area.height);
    let is_thumb = |row: usize| {
        let from = top * height / lines.max(1);
        let size = (height * height).div_ceil(lines.max(1)).max(1);
        lines > height && (from..from + size).contains(&row)
    };
    for (row, y) in (area.top()..area.bottom()).enumerate() {
        let bar = if is_thumb(row) { "█" } else { "│" };
        buffer.set_string(area.x, y, bar, Style::new());
    }
}

fn rows(app: &App, width: u16) -> Vec<Row> {
    let mut rows = Vec::with_capacity(FIELDS.len() + GROUPS.len() + app.problems.len());
    for (index, field) in FIELDS.iter().enumerate() {
        if index == 0 || field.table() != FIELDS[index - 1].table() {
            rows.push(Row::Group(group_title(field)));
        }
        rows.push(Row::Field(index));
        rows.extend(reasons(app, index, width).map(Row::Reason));
    }
    rows
}

fn group_title(field: &Field) -> &'static str {
    GROUPS.iter().find(|(table, _)| *table == field.table()).map_or("", |(_, title)| title)
}

fn reasons(app: &App, field: usize, width: u16) -> impl Iterator<Item = String> {
    let own = app.problems.iter().filter(move |(at, _)| *at == field);
    own.flat_map(move |(_, problem)| {
        let lines = text::wrap(&format!("{}: {}", problem.cause, problem.mend), usize::from(width).saturating_sub(5));
        lines.into_iter().enumerate().map(|(index, line)| format!("{} {line}", if index == 0 { "!" } else { " " }))
    })
}

fn draw_row(app: &App, row: &Row, line: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = app.look.theme;
    match row {
        Row::Group(title) => {
            buffer.set_stringn(line.x, line.y, title, line.width.into(), theme.title);
            None
        }
        Row::Reason(reason) => {
            buffer.set_stringn(line.x + MARK, line.y, reason, line.width.into(), theme.problem);
            None
        }
        Row::Field(index) => draw_field(app, *index, line, buffer),
    }
}

fn draw_field(app: &App, index: usize, line: Rect, buffer: &mut Buffer) -> Option<Position> {
    let field = &FIELDS[index];
    let is_focused = app.focus == index;
    let style = if is_focused { app.look.theme.focus } else { Style::new() };
    let is_wrong = app.problems.iter().any(|(at, _)| *at == index);
    let mark = if is_wrong { "!" } else { "▸" };
    if is_focused || is_wrong {
        buffer.set_stringn(line.x, line.y, mark, 1, if is_wrong { app.look.theme.problem } else { style });
    }
    let offset = draw_name(
        field,
        Rect { x: line.x + MARK, width: line.width.saturating_sub(MARK), ..line },
        app.look.ascii,
        style,
        buffer,
    );
    let value = Rect { x: line.x + offset, width: line.width.saturating_sub(offset), ..line };
    draw_value(app, index, value, style, buffer)
}

// Symbol and label; how far into the line they go. Words have no symbol, and need the room for themselves.
fn draw_name(field: &Field, area: Rect, ascii: bool, style: Style, buffer: &mut Buffer) -> u16 {
    if matches!(field.kind, Kind::Text) {
        buffer.set_stringn(area.x, area.y, field.label, SYMBOL.into(), style);
        return MARK + SYMBOL;
    }
    let value = if area.width + MARK < WHOLE { NARROW_VALUE } else { VALUE };
    let label = LABEL.min(area.width.saturating_sub(SYMBOL + 1 + value));
    let name = text::cut(&symbol(field.symbol, ascii), usize::from(SYMBOL) - 1);
    buffer.set_stringn(area.x, area.y, name, SYMBOL.into(), style);
    buffer.set_stringn(area.x + SYMBOL, area.y, text::cut(field.label, label.into()), label.into(), style);
    MARK + SYMBOL + label + 1
}

fn draw_value(app: &App, index: usize, area: Rect, style: Style, buffer: &mut Buffer) -> Option<Position> {
    let width = usize::from(area.width);
    let is_focused = app.focus == index;
    let is_edited = is_focused && app.has_line();
    let is_choice = matches!(FIELDS[index].kind, Kind::Choice(..));
    let written = app.case.text(index);
    let shown = written.map_or_else(|| app::unwritten(&app.case, index), |text| clean(text).into_owned());
    if is_edited && is_choice {
        buffer.set_stringn(area.x, area.y, text::cut(&format!("‹ {shown} ›"), width), width, style);
        return None;
    }
    if is_edited && written.is_some() {
        return text::edited(&app.input, area, style.add_modifier(Modifier::UNDERLINED), buffer);
    }
    let faint = if written.is_none() { app.look.theme.faint } else { style };
    buffer.set_stringn(area.x, area.y, text::cut(&shown, width), width, faint);
    is_edited.then_some(Position::new(area.x, area.y))
}
