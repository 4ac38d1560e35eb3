//! The form: every field of the case in its group; below an invalid field the reason.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};

use crate::case::fields::{GROUPS, Kind};
use crate::case::{Case, Limit};
use crate::report::verdict::{Standing, verdict};
use crate::tui::app::App;
use crate::tui::form_aids::materials;
use crate::tui::layout::Pane;
use crate::tui::{rows, text};

/// Widths of the marks and of a symbol, and the usual width of a label with its blank.
const MARKS: u16 = 2;
const SYMBOL: u16 = 6;
const LABEL: u16 = 21;
/// The least width of the value of a field.
const VALUE: u16 = 14;

/// The state of the pane, separate for each open case.
#[derive(Debug, Clone)]
pub struct FormState {
    /// The focused row.
    pub focus: usize,
    /// Its typed text with the cursor. The case has the text with its unit.
    pub input: text::Line,
    /// The unit of the row when it got the focus.
    pub(crate) written_unit: Option<String>,
    /// The first visible line.
    pub top: usize,
    /// The row that had the focus before a command added this row; Esc removes an unedited one.
    pub(crate) added_from: Option<usize>,
}

impl FormState {
    /// Focus on a row, with the cursor at the end of its text.
    pub(crate) fn at(case: &Case, focus: usize) -> FormState {
        FormState {
            focus,
            input: text::Line::whole(rows::text(case, focus).unwrap_or_default()),
            written_unit: rows::written_unit(case, focus),
            top: 0,
            added_from: None,
        }
    }
}

impl App {
    /// Whether the value of a row of the form is only invalid because it is unfinished.
    pub(crate) fn is_unfinished(&self, row: usize) -> bool {
        let input = self.tab.form.input.value();
        self.is_edited(row) && rows::is_unfinished(&self.tab.case, row, input)
    }

    /// Whether a row is invalid, or the model refuses the case because of it.
    fn is_faulty(&self, row: usize) -> bool {
        let is_invalid = self.tab.problems.iter().any(|(at, _)| *at == row);
        is_invalid || self.tab.refused_row() == Some(row)
    }

    fn is_edited(&self, row: usize) -> bool {
        self.has_line() && self.tab.form.focus == row
    }

    /// The lines of the form below its title.
    fn form_lines(&self) -> Vec<Row> {
        let groups = rows::groups(&self.tab.case);
        let row = |index: usize| {
            let group = groups.contains(&index).then_some(Row::Group(index));
            group.into_iter().chain([Row::Line(index)]).chain(reasons(self, index))
        };
        (0..rows::count(&self.tab.case)).flat_map(row).collect()
    }

    /// The number of lines of the form that fit below its title.
    fn form_height(&self) -> usize {
        usize::from(self.area(Pane::Form).height.saturating_sub(1)).max(1)
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
pub(crate) fn draw(app: &App, buffer: &mut Buffer) -> Option<Position> {
    let inner = app.draw_title(Pane::Form, &title(app), buffer);
    if inner.is_empty() {
        return None;
    }
    let rows = app.form_lines();
    let lines = Rect { width: inner.width - 1, ..inner };
    let bar = Rect { x: lines.right(), width: 1, ..inner };
    text::scroll_bar(app.tab.form.top, rows.len(), bar, buffer);
    let theme = app.look.theme;
    let mut cursor = None;
    for (row, line) in rows.iter().skip(app.tab.form.top).zip(lines.rows()) {
        match row {
            Row::Group(index) => put(&group_title(app, *index), line, theme.title, buffer),
            Row::Reason(reason) => put(reason, line, theme.problem, buffer),
            Row::Line(index) => cursor = draw_line(app, *index, line, buffer).or(cursor),
        }
    }
    cursor
}

/// The title, which names the result whose limit is edited.
fn title(app: &App) -> String {
    let case = &app.tab.case;
    match rows::row(case, app.tab.form.focus) {
        rows::Row::Limit(limit) if app.has_line() => {
            format!("Form: limit of {}", text::symbol(limit.quantity.symbol, app.look.ascii))
        }
        _ => "Form".to_owned(),
    }
}

/// The first visible line such that the focused field is visible with its reason and, if possible,
/// with its group.
pub(crate) fn top_for(app: &App) -> usize {
    if app.area(Pane::Form).is_empty() {
        return app.tab.form.top;
    }
    let (height, rows) = (app.form_height(), app.form_lines());
    let focused = rows.iter().position(|row| *row == Row::Line(app.tab.form.focus)).unwrap_or(0);
    let below = rows[focused + 1..].iter();
    let reasons = below.take_while(|row| matches!(row, Row::Reason(_))).count();
    let follows_group = focused > 0 && matches!(rows[focused - 1], Row::Group(_));
    let (first, ahead) = (focused - usize::from(follows_group), usize::from(height > 4));
    let end = (focused + reasons + 1 + ahead).min(rows.len());
    let most = rows.len().saturating_sub(height);
    app.tab.form.top.max(end.saturating_sub(height)).min(first).min(most)
}

/// The field at a cell, if any.
pub(crate) fn field_at(app: &App, at: Position) -> Option<usize> {
    let line = usize::from(at.y.checked_sub(app.area(Pane::Form).y + 1)?);
    let rows = app.form_lines();
    if let Row::Line(index) = rows.get(app.tab.form.top + line)? { Some(*index) } else { None }
}

/// The first visible line after scrolling by lines downwards.
pub(crate) fn scrolled(app: &App, by: isize) -> usize {
    let last = app.form_lines().len().saturating_sub(app.form_height());
    app.tab.form.top.saturating_add_signed(by).min(last)
}

// The title of a group; for a gear with its material, if known.
fn group_title(app: &App, index: usize) -> String {
    let Some(field) = rows::field(&app.tab.case, index) else {
        return rows::title_of_entries(&app.tab.case, index).unwrap_or_default().to_owned();
    };
    let title = GROUPS.iter().find(|(table, _)| *table == field.table());
    let title = title.map_or("", |(_, title)| title);
    match materials::name_of_gear(&app.tab.case, field.table()) {
        Some(material) => format!("{title}, {material}"),
        None => title.to_owned(),
    }
}

// The reasons of an invalid row. An unfinished value is explained in the hint until the user leaves
// the row. A missing value has no reason: the row shows that it is required.
fn reasons(app: &App, row: usize) -> Vec<Row> {
    if app.is_unfinished(row) || rows::lacks(&app.tab.case, row) {
        return Vec::new();
    }
    let own = app.tab.problems.iter().filter(|(at, _)| *at == row);
    own.flat_map(|(_, problem)| {
        let width = usize::from(app.area(Pane::Form).width).saturating_sub(6);
        let lines = text::wrap(&format!("{}: {}", problem.cause, problem.fix), width);
        let marks = ["  ! "].into_iter().chain(std::iter::repeat("    "));
        marks.zip(lines).map(|(mark, line)| Row::Reason(format!("{mark}{line}")))
    })
    .collect()
}

// Draws a text; the last column separates it from the next text.
fn put(text: &str, area: Rect, style: Style, buffer: &mut Buffer) {
    let width = usize::from(area.width).saturating_sub(1);
    text::put(&text::cut(text, width), area, style, buffer);
}

// Draws marks, symbol, label and value of a row, and the verdict on a limit. A label gives way to a
// long value that is not edited.
fn draw_line(app: &App, index: usize, line: Rect, buffer: &mut Buffer) -> Option<Position> {
    let (case, theme) = (&app.tab.case, app.look.theme);
    let field = rows::field(case, index);
    let kind = field.map(|field| field.kind);
    let is_idle = rows::is_idle(case, index, &app.tab.inputs_so_far);
    let (mark, of_mark, style) = match (app.tab.form.focus == index, is_idle) {
        (true, _) => ("▸", theme.focus, theme.focus),
        // The reason below the row has a mark of its own.
        (false, _) if app.is_faulty(index) => ("!", theme.problem, Style::new()),
        (false, true) => ("-", theme.faint, theme.faint),
        (false, false) => (" ", Style::new(), Style::new()),
    };
    let written = rows::text(case, index);
    let (default, verdict) = match rows::row(case, index) {
        rows::Row::Field(field) => {
            (rows::unwritten(case, &app.tab.inputs_so_far, field, app.bare_unit(index)), None)
        }
        rows::Row::Limit(limit) => ("(no limit)".to_owned(), verdict_on(app, limit)),
        rows::Row::Spread(_) => ("(no distribution)".to_owned(), None),
    };
    let value = written.map_or(default, |text| text::printable(text).into_owned());
    let (verdict, of_verdict) = verdict.unwrap_or_default();
    let (symbol, label) = rows::names_of(case, index);
    let [symbol, label] = match kind {
        // A text has no symbol; its value needs the room.
        Some(Kind::Text) => [&*label, ""],
        _ => [&text::symbol(symbol, app.look.ascii), &*label],
    };
    let (is_edited, is_choice) = (app.is_edited(index), matches!(kind, Some(Kind::Choice(..))));
    let is_typed = is_edited && written.is_some() && !is_choice;
    let width = |text: &str| text::width(text) as u16 + 1;
    let of_label = match width(label) {
        1 => 0,
        ..=LABEL => LABEL,
        // The value is not below the other values: a second blank separates it.
        long => long + 1,
    };
    let (of_symbol, end) = (SYMBOL.max(width(symbol)), text::width(&verdict) as u16);
    let least = if field.is_some() { VALUE } else { 0 };
    // The label gives way to a limit, whose factor stays visible.
    let of_value = if is_typed && field.is_some() { VALUE } else { least.max(width(&value)) };
    let rest = line.width.saturating_sub(MARKS + of_symbol + end);
    let of_label = of_label.min(rest.saturating_sub(of_value));
    let mut left = line;
    let widths = [MARKS, of_symbol, of_label, rest.saturating_sub(of_label), end];
    let [marks, of_symbol, of_label, area, end] = widths.map(|width| {
        let part = Rect { width: width.min(left.width), ..left };
        left = Rect { x: part.right(), width: left.width - part.width, ..left };
        part
    });
    let unsaved = if rows::differs(case, app.tab.document.loaded(), index) { "*" } else { "" };
    let marked = Line::from_iter([Span::styled(mark, of_mark), Span::styled(unsaved, theme.note)]);
    text::draw_lines([marked], marks, buffer);
    text::put(&verdict, end, of_verdict, buffer);
    put(symbol, of_symbol, style, buffer);
    put(label, of_label, style, buffer);
    if is_typed {
        let (input, style) = (&app.tab.form.input, style.underlined());
        let cursor = text::edited(input, area, style, buffer);
        text::ending(app.ending().as_deref(), text::width(input.value()), area, theme, buffer);
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
fn verdict_on(app: &App, limit: &Limit) -> Option<(String, Style)> {
    let solution = app.tab.present().filter(|_| !limit.text.is_empty())?;
    let verdict = verdict(limit, solution);
    if app.tab.awaits(&verdict) {
        return Some(("pending".to_owned(), app.look.theme.faint));
    }
    let is_above_beside = verdict.is_exceeded_beside();
    let is_met = verdict.standing.holds() && !is_above_beside;
    let word = if verdict.standing == Standing::Exceeded { "!" } else { verdict.standing.word() };
    let part = verdict.part().map_or_else(String::new, |part| format!(" {:.0} %", 100.0 * part));
    let beside = if is_above_beside { " (!)" } else { "" };
    let style = if is_met { app.look.theme.note } else { app.look.theme.problem };
    Some((format!("{word}{part}{beside}"), style))
}
