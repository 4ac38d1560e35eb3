//! The results: the outcome in a sentence, the gauges, every quantity with the methods side by
//! side, what to know.

mod gauges;
mod table;

use std::collections::BTreeSet;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{text, title_room, titled};
use crate::model::{Note, Quantity, Solution};
use crate::report::{self, Shown, digest};
use crate::tui::app::App;
use crate::tui::ascii::symbol;
use crate::tui::commands::{Command, key_of};
use crate::tui::layout::plan;
use crate::tui::pane::Pane;
use crate::tui::rows;
use crate::tui::solver::Answer;
use crate::tui::tab::Tab;

/// So many quantities are to be in sight before gauges and notes get more than a line each.
const ENOUGH_ROWS: usize = 8;
/// So many at least, whatever stands above them.
const LEAST_ROWS: usize = 2;
/// So much of the baseline's name, and of the word before it, tells something.
const LEAST_OF_BASE: usize = ", against name…".len();
/// Stands before a note.
const NOTE: &str = "Note: ";
/// A pane with fewer lines and columns has room for the outcome in a few words only.
const LOW: usize = 20;
const NARROW: usize = 30;

/// What stands in the pane, from its top to its bottom.
struct Parts {
    /// The refusal, the outcome, the gauges.
    head: Vec<Line<'static>>,
    /// How many quantities have room below their heading.
    rows: usize,
    /// What to know.
    notes: Vec<Line<'static>>,
}

/// Draw the results.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let parts = parts(app, area);
    let inner = titled(
        app,
        Pane::Results,
        &title(app, parts.rows, title_room(app, Pane::Results, area.width)),
        area,
        buffer,
    );
    let Some(answer) = &app.tab.answer else {
        draw_lines(&parts.head, inner, buffer);
        return;
    };
    let inner = Rect {
        x: inner.x + inner.width.min(1),
        width: inner.width.saturating_sub(1),
        ..inner
    };
    let table = table::lines(app, answer, inner.width.into());
    let quantities = table.rows.iter().skip(app.tab.results_top).take(parts.rows);
    let lines: Vec<Line<'static>> = parts
        .head
        .into_iter()
        .chain([table.heading])
        .chain(quantities.cloned())
        .chain(parts.notes)
        .collect();
    draw_lines(&lines, inner, buffer);
    if app.panes.focus == Pane::Results
        && let Some(line) = line_of(app, app.tab.row)
            .checked_sub(app.tab.results_top)
            .filter(|&line| line < parts.rows)
    {
        let y = area.y + (lines_before(app, area) + line) as u16;
        buffer.set_stringn(area.x, y, "▸", 1, app.look.theme.focus);
    }
}

/// The quantities in their order.
pub fn listed(app: &App) -> impl Iterator<Item = &'static Quantity> {
    app.tab.answer.iter().flat_map(table::order)
}

/// How many quantities there are.
#[must_use]
pub fn count(app: &App) -> usize {
    listed(app).count()
}

/// How many of them are in sight.
#[must_use]
pub fn page(app: &App) -> usize {
    parts(app, plan(app.size, app.panes).results).rows
}

/// The marked quantity.
#[must_use]
pub fn marked(app: &App) -> Option<&'static Quantity> {
    table::order(app.tab.answer.as_ref()?).nth(app.tab.row)
}

/// Where a quantity stands in the results of a tab.
#[derive(Debug, Clone, Copy)]
pub struct Listed {
    /// Its key.
    pub key: &'static str,
    /// Its place among the quantities.
    pub row: usize,
    /// Its line.
    pub line: usize,
    /// Whether the active method finds a value.
    pub has_value: bool,
}

/// Where a quantity stands in the results of a tab, by its key; else the marked one.
#[must_use]
pub fn place_of(tab: &Tab, key: Option<&str>) -> Option<Listed> {
    let answer = tab.answer.as_ref()?;
    let is_meant = |(row, quantity): &(usize, &Quantity)| {
        key.map_or(*row == tab.row, |key| quantity.key == key)
    };
    let (row, quantity) = table::order(answer).enumerate().find(is_meant)?;
    let has_value = answer.of(answer.active).and_then(quantity.value).is_some();
    Some(Listed {
        key: quantity.key,
        row,
        line: table::line_of(answer, row),
        has_value,
    })
}

/// The first line to be shown, so that the marked quantity is in sight.
#[must_use]
pub fn top_for(app: &App) -> usize {
    let rows = page(app).max(1);
    let line = line_of(app, app.tab.row);
    let least = (line + 1).saturating_sub(rows);
    app.tab
        .results_top
        .clamp(least, line.max(least))
        .min(line_count(app).saturating_sub(rows))
}

/// The first line to be shown after so many lines downwards.
#[must_use]
pub fn scrolled(app: &App, by: isize) -> usize {
    app.tab
        .results_top
        .saturating_add_signed(by)
        .min(line_count(app).saturating_sub(page(app)))
}

/// The value of the marked quantity beside that of the baseline, where one is pinned.
#[must_use]
pub fn compared(app: &App, quantity: &Quantity) -> Option<String> {
    table::compared(app, app.tab.answer.as_ref()?, quantity)
}

/// The place of the quantity on a cell, where there is one.
#[must_use]
pub fn row_at(app: &App, area: Rect, at: Position) -> Option<usize> {
    let line = usize::from(at.y - area.y).checked_sub(lines_before(app, area))?;
    let in_sight = line < parts(app, area).rows;
    table::row_of(app.tab.answer.as_ref()?, app.tab.results_top + line)
        .filter(|&row| in_sight && row < count(app))
}

// The line of a quantity, by their places.
fn line_of(app: &App, row: usize) -> usize {
    app.tab
        .answer
        .as_ref()
        .map_or(row, |answer| table::line_of(answer, row))
}

fn line_count(app: &App) -> usize {
    count(app)
        .checked_sub(1)
        .map_or(0, |last| line_of(app, last) + 1)
}

// Which lines of the table are in sight, where some are not; in words, in numbers, in arrows.
fn position(app: &App, rows: usize) -> [String; 3] {
    let (lines, first) = (line_count(app), app.tab.results_top + 1);
    let last = (app.tab.results_top + rows).min(lines);
    if rows == 0 || rows >= lines {
        return Default::default();
    }
    [
        format!(" {first} to {last} of {lines}"),
        format!(" {first}-{last}/{lines}"),
        [
            " ",
            if first > 1 { "↑" } else { "" },
            if last < lines { "↓" } else { "" },
        ]
        .concat(),
    ]
}

/// The outcome of a solve, in a sentence.
#[must_use]
pub fn sentence(app: &App, solution: &Solution) -> String {
    let sentence = digest::sentence(solution, app.settings.units);
    symbol(&sentence, app.look.ascii).into_owned()
}

/// The outcome, the gauges and the notes in full, a line each.
#[must_use]
pub fn told(app: &App) -> Vec<String> {
    let Some(answer) = &app.tab.answer else {
        return Vec::new();
    };
    let outcome = answer
        .of(answer.active)
        .map(|solution| sentence(app, solution));
    let gauges = gauges::gauges(app, answer)
        .into_iter()
        .map(gauges::Gauge::in_full);
    let notes = answer
        .notes
        .iter()
        .map(|note| format!("{NOTE}{}.", note.message));
    let lines = outcome.into_iter().chain(gauges).chain(notes);
    lines.flat_map(|line| [line, String::new()]).collect()
}

fn draw_lines(lines: &[Line<'static>], area: Rect, buffer: &mut Buffer) {
    for (line, y) in lines.iter().zip(area.top()..area.bottom()) {
        line.render(
            Rect {
                y,
                height: 1,
                ..area
            },
            buffer,
        );
    }
}

// Title, head and heading.
fn lines_before(app: &App, area: Rect) -> usize {
    parts(app, area).head.len() + 2
}

// As much of it as has room, so that nothing is cut.
fn title(app: &App, rows: usize, room: usize) -> String {
    let name = if app.tab.shows_last_valid() {
        "Results: LAST VALID"
    } else {
        "Results"
    };
    let name_of_base = app
        .baseline
        .as_ref()
        .map(|baseline| format!(", against {}", baseline.name));
    let against = name_of_base.as_deref().unwrap_or_default();
    let begun = text::cut(against, room.saturating_sub(name.width()));
    let base = if begun.width() >= LEAST_OF_BASE {
        begun.as_str()
    } else {
        ""
    };
    let answer = app.tab.answer.as_ref();
    let pending = answer
        .and_then(|answer| answer.pending)
        .map_or_else(String::new, |method| format!(", {} to come", method.name()));
    let cost = answer
        .filter(|_| app.shows_cost)
        .map_or_else(String::new, |answer| {
            format!(
                ", {} stages in {} us",
                answer.cost.stages, answer.cost.micros
            )
        });
    let short = if app.tab.shows_last_valid() {
        "LAST VALID"
    } else {
        name
    };
    let [position, numbers, arrows] = position(app, rows);
    let titles = [
        format!("{name}{position}{against}{pending}{cost}"),
        format!("{name}{numbers}{against}{pending}{cost}"),
        format!("{name}{arrows}{against}{pending}{cost}"),
        format!("{name}{arrows}{against}{cost}"),
        format!("{name}{position}{base}"),
        format!("{name}{numbers}{base}"),
        format!("{name}{arrows}{base}"),
        format!("{name}{base}"),
        format!("{name}{arrows}"),
        name.to_owned(),
    ];
    titles
        .into_iter()
        .find(|title| title.width() <= room)
        .unwrap_or_else(|| short.to_owned())
}

// With room every gauge and note is told in full, else each in a line, and the notes in one.
fn parts(app: &App, area: Rect) -> Parts {
    let width = usize::from(area.width.saturating_sub(1));
    let height = usize::from(area.height.saturating_sub(1));
    let mut head = banner(app, width);
    let (mut gauges, mut notes) = (Vec::new(), Vec::new());
    if let Some(answer) = &app.tab.answer {
        head.extend(outcome(app, answer, width, height < LOW));
        gauges = gauges::gauges(app, answer)
            .iter()
            .map(|gauge| gauge.fitting(width))
            .collect();
        notes = answer
            .notes
            .iter()
            .map(|note| format!("{NOTE}{}", note.message))
            .collect();
    }
    let whole = |texts: &[String]| {
        texts
            .iter()
            .flat_map(|text| text::wrap(text, width))
            .collect::<Vec<_>>()
    };
    let rows_beside = |gauges: &[String], notes: &[String]| {
        height.saturating_sub(head.len() + gauges.len() + 1 + notes.len())
    };
    let (mut gauge_lines, mut note_lines) = (whole(&gauges), whole(&notes));
    if rows_beside(&gauge_lines, &note_lines) < ENOUGH_ROWS {
        gauge_lines = gauges.iter().map(|gauge| text::cut(gauge, width)).collect();
        note_lines = app
            .tab
            .answer
            .iter()
            .filter_map(|answer| shortened(&answer.notes, width))
            .collect();
    }
    let room_for_head = height.saturating_sub(1 + LEAST_ROWS + note_lines.len());
    let faint = if app.tab.is_stale() {
        app.look.theme.faint
    } else {
        Style::new()
    };
    head.extend(
        gauge_lines
            .into_iter()
            .map(|gauge| Line::styled(gauge, faint)),
    );
    head.truncate(room_for_head);
    let rows = height.saturating_sub(head.len() + 1 + note_lines.len());
    let style = app.look.theme.note.patch(faint);
    Parts {
        head,
        rows,
        notes: note_lines
            .into_iter()
            .map(|note| Line::styled(note, style))
            .collect(),
    }
}

// The only note in full, else as many as have room by their names, else how many there are.
fn shortened(notes: &[Note], width: usize) -> Option<String> {
    let count = notes.len();
    let in_full = notes
        .first()
        .filter(|_| count == 1)
        .map(|note| format!("{NOTE}{}", note.message));
    let names: Vec<String> = notes
        .iter()
        .map(|note| note.code.replace('-', " "))
        .collect();
    let noun = if count == 1 { "note" } else { "notes" };
    let by_names = (1..=count).rev().map(|told| {
        let others = if told < count {
            format!(", {} more", count - told)
        } else {
            String::new()
        };
        format!("key n: {}{others}", names[..told].join(", "))
    });
    let counted = format!("{count} {noun}: press n");
    let mut sayings = in_full.into_iter().chain(by_names).chain([counted.clone()]);
    (count > 0).then(|| {
        sayings
            .find(|words| words.width() <= width)
            .unwrap_or(counted)
    })
}

fn banner(app: &App, width: usize) -> Vec<Line<'static>> {
    let theme = app.look.theme;
    let said = |text: String, style: Style| {
        text::wrap(&text, width)
            .into_iter()
            .map(move |line| Line::styled(line, style))
    };
    let Some(refusal) = &app.tab.refusal else {
        return wrong(app)
            .into_iter()
            .flat_map(|wrong| said(wrong, theme.problem))
            .collect();
    };
    let cause = said(format!("! Not solved: {refusal}."), theme.problem);
    cause
        .chain(said(
            format!("Correction: {}.", refusal.mend()),
            Style::new(),
        ))
        .collect()
}

// The first field that is wrong, in the order of the form, why, how many more are, and the key that
// goes there.
fn wrong(app: &App) -> Option<String> {
    let (row, problem) = app.tab.problems.iter().min_by_key(|(row, _)| *row)?;
    let symbol = rows::symbol(&app.tab.case, *row);
    let name = format!(
        "{} {}",
        self::symbol(symbol, app.look.ascii),
        rows::label(&app.tab.case, *row)
    );
    let fields: BTreeSet<usize> = app.tab.problems.iter().map(|(row, _)| *row).collect();
    let more = if fields.len() > 1 {
        format!("; {} more", fields.len() - 1)
    } else {
        String::new()
    };
    let key = key_of(Command::NextFault);
    if let Some(missing) = app.missing().filter(|&missing| missing > 1) {
        return Some(format!("! {missing} required values are missing ({key})"));
    }
    Some(format!(
        "! {}: {}{more} ({key})",
        name.trim_start(),
        problem.cause
    ))
}

fn outcome(app: &App, answer: &Answer, width: usize, is_low: bool) -> Vec<Line<'static>> {
    let Some(solution) = answer.of(answer.active) else {
        return Vec::new();
    };
    let style = if app.tab.is_stale() {
        app.look.theme.faint
    } else {
        app.look.theme.focus
    };
    let words = if is_low && width < NARROW {
        digest::short(solution, app.settings.units)
    } else {
        sentence(app, solution)
    };
    let lines = text::wrap(&words, width);
    lines
        .into_iter()
        .map(|line| Line::styled(line, style))
        .collect()
}

fn shown_in(app: &App, quantity: &Quantity, value: f64) -> Shown {
    report::shown_in(quantity, value, app.settings.units)
}
