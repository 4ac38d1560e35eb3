//! The form: every field of the case in its group, and under a wrong one the reason.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::{text, titled};
use crate::case::fields::{GROUPS, Kind};
use crate::case::{Acting, FIELDS, materials, relevance};
use crate::model::Inputs;
use crate::tui::app::{self, App};
use crate::tui::ascii::{self, symbol};
use crate::tui::layout::plan;
use crate::tui::pane::Pane;
use crate::tui::rows;

mod limit;
mod line;

use limit::draw_limit;
use line::{MARK, SYMBOL, draw_mark, draw_name, draw_text, label_width};

/// The mark of a field without effect.
const IDLE: &str = "-";
/// The least width of a label beside a symbol.
const LEAST_LABEL: u16 = 6;

/// A line of the form.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Row {
    /// The group that begins with that line.
    Group(usize),
    /// A field or a limit, by its place among those that take the focus.
    Line(usize),
    Reason(String),
}

/// Draw the form; where the cursor stands.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let rows = rows(app, area.width);
    let inner = titled(app, Pane::Form, "Form", area, buffer);
    if inner.is_empty() {
        return None;
    }
    let inputs = app.tab.case.inputs_so_far();
    let mut cursor = None;
    for (row, y) in rows
        .iter()
        .skip(app.tab.form_top)
        .zip(inner.top()..inner.bottom())
    {
        let line = Rect {
            y,
            height: 1,
            width: inner.width - 1,
            ..inner
        };
        cursor = draw_row(app, &inputs, row, line, buffer).or(cursor);
    }
    scroll_bar(
        app.tab.form_top,
        rows.len(),
        Rect {
            x: inner.right() - 1,
            width: 1,
            ..inner
        },
        buffer,
    );
    cursor
}

/// The first line to be shown, so that the focused field is in sight with its reason and, at the
/// top, its group.
#[must_use]
pub fn top_for(app: &App) -> usize {
    let area = plan(app.size, app.panes).form;
    if area.is_empty() {
        return app.tab.form_top;
    }
    let height = usize::from(area.height.saturating_sub(1)).max(1);
    let rows = rows(app, area.width);
    let focused = rows
        .iter()
        .position(|row| *row == Row::Line(app.tab.focus))
        .unwrap_or(0);
    let reasons = rows[focused + 1..]
        .iter()
        .take_while(|row| matches!(row, Row::Reason(_)))
        .count();
    let follows_group = focused > 0 && matches!(rows[focused - 1], Row::Group(_));
    let first = focused - usize::from(follows_group);
    let ahead = usize::from(height > 4);
    let least = (focused + reasons + 1 + ahead)
        .min(rows.len())
        .saturating_sub(height);
    let most = rows.len().saturating_sub(height);
    app.tab.form_top.max(least).min(first.max(least)).min(most)
}

/// The field on a cell, where there is one.
#[must_use]
pub fn field_at(app: &App, area: Rect, at: Position) -> Option<usize> {
    let line = usize::from(at.y.checked_sub(area.y + 1)?);
    match rows(app, area.width).get(app.tab.form_top + line)? {
        Row::Line(index) => Some(*index),
        Row::Group(_) | Row::Reason(_) => None,
    }
}

/// The first line to be shown after so many lines downwards.
#[must_use]
pub fn scrolled(app: &App, by: isize) -> usize {
    let area = plan(app.size, app.panes).form;
    let most = rows(app, area.width)
        .len()
        .saturating_sub(area.height.saturating_sub(1).into());
    app.tab.form_top.saturating_add_signed(by).min(most)
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
    let count = rows::count(&app.tab.case);
    let groups = rows::groups(&app.tab.case);
    let mut lines = Vec::with_capacity(count + groups.len() + app.tab.problems.len());
    for index in 0..count {
        if groups.contains(&index) {
            lines.push(Row::Group(index));
        }
        lines.push(Row::Line(index));
        lines.extend(reasons(app, index, width).map(Row::Reason));
    }
    lines
}

// The title of a group; of a gear also its material, where that is known.
fn group_title(app: &App, index: usize) -> String {
    let Some(field) = rows::field(&app.tab.case, index) else {
        return "Limits".to_owned();
    };
    let title = GROUPS
        .iter()
        .find(|(table, _)| *table == field.table())
        .map_or("", |(_, title)| title);
    let material = materials::name_of_gear(&app.tab.case, field.table());
    material.map_or_else(
        || title.to_owned(),
        |material| format!("{title}, {material}"),
    )
}

// An unfinished value is explained in the hint until the field is left. A missing value needs no
// reason: the field itself shows that it is required.
fn reasons(app: &App, field: usize, width: u16) -> impl Iterator<Item = String> {
    let has_reason = !app.is_unfinished(field) && !app.lacks(field);
    let own = app
        .tab
        .problems
        .iter()
        .filter(move |(at, _)| *at == field && has_reason);
    own.flat_map(move |(_, problem)| {
        let lines = text::wrap(
            &format!("{}: {}", problem.cause, problem.mend),
            usize::from(width).saturating_sub(5),
        );
        lines
            .into_iter()
            .enumerate()
            .map(|(index, line)| format!("{} {line}", if index == 0 { "!" } else { " " }))
    })
}

fn draw_row(
    app: &App,
    inputs: &Inputs,
    row: &Row,
    line: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let theme = app.look.theme;
    match row {
        Row::Group(index) => {
            let title = text::cut(&group_title(app, *index), line.width.into());
            buffer.set_stringn(line.x, line.y, title, line.width.into(), theme.title);
            None
        }
        Row::Reason(reason) => {
            buffer.set_stringn(
                line.x + MARK,
                line.y,
                reason,
                line.width.into(),
                theme.problem,
            );
            None
        }
        Row::Line(index) => match rows::row(&app.tab.case, *index) {
            rows::Row::Field(field) => draw_field(app, inputs, field, line, buffer),
            rows::Row::Limit(limit) => draw_limit(app, *index, limit, line, buffer),
        },
    }
}

fn draw_field(
    app: &App,
    inputs: &Inputs,
    index: usize,
    line: Rect,
    buffer: &mut Buffer,
) -> Option<Position> {
    let field = &FIELDS[index];
    let theme = app.look.theme;
    let is_idle = matches!(relevance(index, inputs), Acting::No(_));
    let style = match (app.tab.focus == index, is_idle) {
        (true, _) => theme.focus,
        (false, true) => theme.faint,
        (false, false) => Style::new(),
    };
    if is_idle {
        buffer.set_stringn(line.x, line.y, IDLE, 1, style);
    }
    draw_mark(app, index, line, buffer);
    let name = Rect {
        x: line.x + MARK,
        width: line.width.saturating_sub(MARK),
        ..line
    };
    let offset = if matches!(field.kind, Kind::Text) {
        draw_words(field.label, name, style, buffer)
    } else {
        let (usual, label) = (label_width(name), field.label.width() as u16);
        let least = if field.symbol.is_empty() {
            label
        } else {
            label.min(LEAST_LABEL)
        };
        let over = longer(app, index, line.width - (MARK + SYMBOL + usual + 1))
            .min(usual.saturating_sub(least));
        draw_name(
            &symbol(field.symbol, app.look.ascii),
            field.label,
            name,
            usual - over,
            style,
            buffer,
        )
    };
    let value = Rect {
        x: line.x + offset,
        width: line.width.saturating_sub(offset),
        ..line
    };
    draw_value(app, index, value, style, buffer)
}

// By how much a value that is not edited is wider than its room.
fn longer(app: &App, index: usize, room: u16) -> u16 {
    let shown = app.tab.case.text(index).map_or_else(
        || app::unwritten(&app.tab.case, index),
        |text| ascii::printable(text).into_owned(),
    );
    let is_edited = app.tab.focus == index && app.has_line() && app.tab.case.text(index).is_some();
    if is_edited {
        0
    } else {
        (shown.width() as u16).saturating_sub(room)
    }
}

// Words have no symbol, and need the room for themselves.
fn draw_words(label: &str, area: Rect, style: Style, buffer: &mut Buffer) -> u16 {
    buffer.set_stringn(area.x, area.y, label, SYMBOL.into(), style);
    MARK + SYMBOL
}

fn draw_value(
    app: &App,
    index: usize,
    area: Rect,
    style: Style,
    buffer: &mut Buffer,
) -> Option<Position> {
    let unwritten = app::unwritten(&app.tab.case, index);
    let written = app.tab.case.text(index);
    let is_edited = app.tab.focus == index && app.has_line();
    if is_edited && matches!(FIELDS[index].kind, Kind::Choice(..)) {
        let shown = written.map_or(unwritten, |text| ascii::printable(text).into_owned());
        let width = usize::from(area.width);
        buffer.set_stringn(
            area.x,
            area.y,
            text::cut(&format!("‹ {shown} ›"), width),
            width,
            style,
        );
        return None;
    }
    draw_text(app, index, written, &unwritten, area, style, buffer)
}
