//! The form: every field of the case in its group; below an invalid field the reason.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use super::Title;
use crate::case::fields::{GROUPS, Kind};
use crate::case::{Case, Limit, Problem};
use crate::model::{Inputs, Solution};
use crate::report::verdict::{Standing, verdict};
use crate::tui::form_aids::materials;
use crate::tui::text::Line as Text;
use crate::tui::theme::Look;
use crate::tui::{rows, text};

/// Widths of the marks and of a symbol, and the usual width of a label.
const MARKS: u16 = 2;
const SYMBOL: u16 = 6;
const LABEL: u16 = 20;
/// The least width of the value of a field.
const VALUE: u16 = 14;

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
}

impl FormState {
    /// Focus on a row, with the cursor at the end of its text.
    pub(crate) fn at(case: &Case, focus: usize) -> FormState {
        FormState {
            focus,
            input: Text::whole(rows::text(case, focus).unwrap_or_default()),
            written_unit: rows::written_unit(case, focus),
            top: 0,
        }
    }
}

/// The form with its case.
#[derive(Debug, Clone)]
pub(crate) struct Form<'a> {
    pub(crate) case: &'a Case,
    /// The case in the file.
    pub(crate) saved: &'a Case,
    /// The inputs of the valid fields.
    pub(crate) inputs: &'a Inputs,
    /// The fields without effect.
    pub(crate) idle: &'a [usize],
    /// The invalid rows.
    pub(crate) problems: &'a [(usize, Problem)],
    /// The row that the fix of the model's refusal names first.
    pub(crate) refused: Option<usize>,
    /// The present results of the method of the case.
    pub(crate) solution: Option<&'a Solution>,
    pub(crate) state: &'a FormState,
    /// Whether letters go into the focused row.
    pub(crate) is_editing: bool,
    /// The completion of the typed text.
    pub(crate) ending: Option<String>,
    pub(crate) look: Look,
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

impl Form<'_> {
    /// Whether the value of a row is only invalid because it is unfinished.
    pub(crate) fn is_unfinished(&self, row: usize) -> bool {
        self.is_edited(row) && rows::is_unfinished(self.case, row, self.state.input.value())
    }

    /// Whether a row is invalid, or the model refuses the case because of it.
    fn is_faulty(&self, row: usize) -> bool {
        self.refused == Some(row) || self.problems.iter().any(|(at, _)| *at == row)
    }

    fn is_edited(&self, row: usize) -> bool {
        self.is_editing && self.state.focus == row
    }

    /// The lines below the title.
    fn rows(&self) -> Vec<Row> {
        let groups = rows::groups(self.case);
        let row = |index: usize| {
            let group = groups.contains(&index).then_some(Row::Group(index));
            group.into_iter().chain([Row::Line(index)]).chain(reasons(self, index))
        };
        (0..rows::count(self.case)).flat_map(row).collect()
    }

    /// The number of lines that fit below the title.
    fn height(&self) -> usize {
        usize::from(self.area.height.saturating_sub(1)).max(1)
    }
}

/// A line of the form.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Row {
    /// The title of the group whose first line has this index.
    Group(usize),
    /// A field, a limit or a distribution, by its index among the focusable rows.
    Line(usize),
    Reason(String),
}

/// Draws the form. Returns the position of the text cursor.
pub(crate) fn draw(pane: &Form<'_>, buffer: &mut Buffer) -> Option<Position> {
    let inner = pane.title.draw("Form", pane.area, buffer);
    if inner.is_empty() {
        return None;
    }
    let rows = pane.rows();
    let lines = Rect { width: inner.width - 1, ..inner };
    let bar = Rect { x: lines.right(), width: 1, ..inner };
    text::scroll_bar(pane.state.top, rows.len(), bar, buffer);
    let theme = pane.look.theme;
    let mut cursor = None;
    for (row, line) in rows.iter().skip(pane.state.top).zip(lines.rows()) {
        match row {
            Row::Group(index) => put(&group_title(pane, *index), line, theme.title, buffer),
            Row::Reason(reason) => put(reason, line, theme.problem, buffer),
            Row::Line(index) => cursor = draw_line(pane, *index, line, buffer).or(cursor),
        }
    }
    cursor
}

/// The first visible line such that the focused field is visible with its reason and, if possible,
/// with its group.
pub(crate) fn top_for(pane: &Form<'_>) -> usize {
    if pane.area.is_empty() {
        return pane.state.top;
    }
    let (height, rows) = (pane.height(), pane.rows());
    let focused = rows.iter().position(|row| *row == Row::Line(pane.state.focus)).unwrap_or(0);
    let below = rows[focused + 1..].iter();
    let reasons = below.take_while(|row| matches!(row, Row::Reason(_))).count();
    let follows_group = focused > 0 && matches!(rows[focused - 1], Row::Group(_));
    let (first, ahead) = (focused - usize::from(follows_group), usize::from(height > 4));
    let end = (focused + reasons + 1 + ahead).min(rows.len());
    let most = rows.len().saturating_sub(height);
    pane.state.top.max(end.saturating_sub(height)).min(first).min(most)
}

/// The field at a cell, if any.
pub(crate) fn field_at(pane: &Form<'_>, at: Position) -> Option<usize> {
    let line = usize::from(at.y.checked_sub(pane.area.y + 1)?);
    let rows = pane.rows();
    if let Row::Line(index) = rows.get(pane.state.top + line)? { Some(*index) } else { None }
}

/// The first visible line after scrolling by lines downwards.
pub(crate) fn scrolled(pane: &Form<'_>, by: isize) -> usize {
    let last = pane.rows().len().saturating_sub(pane.height());
    pane.state.top.saturating_add_signed(by).min(last)
}

// The title of a group; for a gear with its material, if known.
fn group_title(pane: &Form<'_>, index: usize) -> String {
    let Some(field) = rows::field(pane.case, index) else {
        return rows::title_of_entries(pane.case, index).unwrap_or_default().to_owned();
    };
    let title = GROUPS.iter().find(|(table, _)| *table == field.table());
    let title = title.map_or("", |(_, title)| title);
    match materials::name_of_gear(pane.case, field.table()) {
        Some(material) => format!("{title}, {material}"),
        None => title.to_owned(),
    }
}

// The reasons of an invalid row. An unfinished value is explained in the hint until the user leaves
// the row. A missing value has no reason: the row shows that it is required.
fn reasons(pane: &Form<'_>, row: usize) -> Vec<Row> {
    if pane.is_unfinished(row) || rows::lacks(pane.case, row) {
        return Vec::new();
    }
    let width = usize::from(pane.area.width).saturating_sub(6);
    let own = pane.problems.iter().filter(|(at, _)| *at == row);
    own.flat_map(|(_, problem)| {
        let lines = text::wrap(&format!("{}: {}", problem.cause, problem.fix), width);
        let marks = ["  ! "].into_iter().chain(std::iter::repeat("    "));
        marks.zip(lines).map(|(mark, line)| Row::Reason(format!("{mark}{line}")))
    })
    .collect()
}

// Draws a text; the last column separates it from the next text.
fn put(text: &str, area: Rect, style: Style, buffer: &mut Buffer) {
    let width = usize::from(area.width).saturating_sub(1);
    text::put(&text::cut(text, width), area, width, style, buffer);
}

// Draws marks, symbol, label and value of a row, and the verdict on a limit. A label gives way to a
// long value that is not edited.
fn draw_line(pane: &Form<'_>, index: usize, line: Rect, buffer: &mut Buffer) -> Option<Position> {
    let (case, theme) = (pane.case, pane.look.theme);
    let field = rows::field(case, index);
    let kind = field.map(|field| field.kind);
    let is_idle = pane.idle.contains(&index);
    let (mark, of_mark, style) = match (pane.state.focus == index, is_idle) {
        (true, _) => ("▸", theme.focus, theme.focus),
        // The reason below the row has a mark of its own.
        (false, _) if pane.is_faulty(index) => ("!", theme.problem, Style::new()),
        (false, true) => ("-", theme.faint, theme.faint),
        (false, false) => (" ", Style::new(), Style::new()),
    };
    let written = rows::text(case, index);
    let (default, verdict) = match rows::row(case, index) {
        rows::Row::Field(field) => (rows::unwritten(case, pane.inputs, field), None),
        rows::Row::Limit(limit) => ("(no limit)".to_owned(), verdict_on(pane, limit)),
        rows::Row::Spread(_) => ("(no distribution)".to_owned(), None),
    };
    let value = written.map_or(default, |text| text::printable(text).into_owned());
    let (verdict, of_verdict) = verdict.unwrap_or_default();
    let (symbol, label) = rows::names_of(case, index);
    let [symbol, label] = match kind {
        // A text has no symbol; its value needs the room.
        Some(Kind::Text) => [&*label, ""],
        _ => [&text::symbol(symbol, pane.look.ascii), &*label],
    };
    let (is_edited, is_choice) = (pane.is_edited(index), matches!(kind, Some(Kind::Choice(..))));
    let is_typed = is_edited && written.is_some() && !is_choice;
    let width = |text: &str| text::width(text) as u16 + 1;
    let of_label = if label.is_empty() { 0 } else { width(label).max(LABEL + 1) };
    let (of_symbol, end) = (SYMBOL.max(width(symbol)), text::width(&verdict) as u16);
    let least = if field.is_some() { VALUE } else { 0 };
    let of_value = if is_typed { VALUE } else { least.max(width(&value)) };
    let rest = line.width.saturating_sub(MARKS + of_symbol + end);
    let of_label = of_label.min(rest.saturating_sub(of_value));
    let mut x = line.x;
    let [marks, of_symbol, of_label, area, end] =
        [MARKS, of_symbol, of_label, rest - of_label, end].map(|width| {
            let part = Rect { x, width, ..line }.intersection(line);
            x += width;
            part
        });
    let unsaved = if rows::differs(case, pane.saved, index) { "*" } else { "" };
    let x = text::put(mark, marks, marks.width.into(), of_mark, buffer);
    text::put(unsaved, (x, line.y), 1, theme.note, buffer);
    text::put(&verdict, end, end.width.into(), of_verdict, buffer);
    put(symbol, of_symbol, style, buffer);
    put(label, of_label, style, buffer);
    if is_typed {
        let (input, style) = (&pane.state.input, style.add_modifier(Modifier::UNDERLINED));
        let cursor = text::edited(input, area, style, buffer);
        text::ending(pane.ending.as_deref(), text::width(input.value()), area, theme, buffer);
        return cursor;
    }
    let is_default = written.is_none() && !rows::lacks(case, index);
    let (value, style) = match (is_edited && is_choice, is_default) {
        (true, _) => (format!("‹ {value} ›"), style),
        (false, true) => (value, theme.faint),
        (false, false) => (value, style),
    };
    put(&value, area, style, buffer);
    (is_edited && !is_choice).then_some(area.as_position())
}

// The verdict of the present result, with its style. The sign (!) marks a free impact within the
// limit while the impact of the method exceeds it.
fn verdict_on(pane: &Form<'_>, limit: &Limit) -> Option<(String, Style)> {
    let solution = pane.solution.filter(|_| !limit.text.is_empty())?;
    let verdict = verdict(limit, solution);
    let is_above_beside = verdict.is_exceeded_beside();
    let is_met = verdict.standing.holds() && !is_above_beside;
    let word = if verdict.standing == Standing::Exceeded { "!" } else { verdict.standing.word() };
    let part = verdict.part().map_or_else(String::new, |part| format!(" {:.0} %", 100.0 * part));
    let beside = if is_above_beside { " (!)" } else { "" };
    let style = if is_met { pane.look.theme.note } else { pane.look.theme.problem };
    Some((format!("{word}{part}{beside}"), style))
}
