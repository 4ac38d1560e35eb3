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

use super::title::Title;
use crate::case::units::System;
use crate::case::{Case, Problem};
use crate::model::{Note, Quantity, Refusal, Solution};
use crate::report::{self, Shown, digest};
use crate::tui::ascii::symbol;
use crate::tui::baseline::Baseline;
use crate::tui::rows;
use crate::tui::solver::{Answer, Values};
use crate::tui::text;
use crate::tui::theme::Look;
use crate::tui::variants::Variants;

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

/// The state of the pane. Each open case has its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ResultsState {
    /// The selected line among the quantities.
    pub row: usize,
    /// The first visible line of the quantities.
    pub top: usize,
    /// The quantity that was selected and is none of the present results: the selection returns to
    /// it.
    pub lost: Option<&'static str>,
}

/// The pane with the results that it shows.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct Results<'a> {
    /// The state of the pane.
    pub state: ResultsState,
    /// The last valid results.
    pub answer: Option<&'a Answer>,
    /// The pinned results.
    pub baseline: Option<&'a Baseline>,
    /// The variants, if they stand in place of the methods.
    pub variants: Option<&'a Variants>,
    /// The first visible one.
    pub first_variant: usize,
    /// The values before the last edit.
    pub earlier: Option<&'a Values>,
    /// Why the model refuses the case.
    pub refusal: Option<&'a Refusal>,
    /// The rows of the form that are wrong.
    pub problems: &'a [(usize, Problem)],
    /// How many required values are missing, if nothing else is wrong.
    pub missing: Option<usize>,
    /// The case in the form.
    pub case: &'a Case,
    /// Whether the results are older than the form.
    pub is_stale: bool,
    /// Whether the title says so.
    pub shows_last_valid: bool,
    /// Whether the title shows the cost of the solve.
    pub shows_cost: bool,
    /// Whether the pane has the focus.
    pub is_focused: bool,
    /// Names the key that goes to the next wrong row.
    pub next_fault: fn() -> String,
    /// The display units.
    pub units: System,
    /// The capabilities of the terminal.
    pub look: Look,
    /// The title line.
    pub title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub area: Rect,
}

/// What stands in the pane, from its top to its bottom.
struct Parts {
    /// The refusal, the outcome, the gauges.
    head: Vec<Line<'static>>,
    /// How many quantities have room below their heading.
    rows: usize,
    /// What to know.
    notes: Vec<Line<'static>>,
}

pub fn draw(pane: &Results<'_>, buffer: &mut Buffer) {
    let area = pane.area;
    let parts = parts(pane);
    let words = title(pane, parts.rows, pane.title.room(area.width));
    let inner = pane.title.draw(&words, area, buffer);
    let Some(answer) = pane.answer else {
        draw_lines(&parts.head, inner, buffer);
        return;
    };
    let inner = Rect {
        x: inner.x + inner.width.min(1),
        width: inner.width.saturating_sub(1),
        ..inner
    };
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
    draw_lines(&lines, inner, buffer);
    if pane.is_focused
        && let Some(line) = line_of(pane, pane.state.row)
            .checked_sub(pane.state.top)
            .filter(|&line| line < parts.rows)
    {
        let y = area.y + (before + line) as u16;
        buffer.set_stringn(area.x, y, "▸", 1, pane.look.theme.focus);
    }
}

/// The quantities in their order.
pub fn listed<'a>(pane: &Results<'a>) -> impl Iterator<Item = &'static Quantity> + use<'a> {
    pane.answer.into_iter().flat_map(table::order)
}

/// How many quantities there are.
#[must_use]
pub fn count(pane: &Results<'_>) -> usize {
    listed(pane).count()
}

/// How many of them are in sight.
#[must_use]
pub fn page(pane: &Results<'_>) -> usize {
    parts(pane).rows
}

#[must_use]
pub fn marked(pane: &Results<'_>) -> Option<&'static Quantity> {
    table::order(pane.answer?).nth(pane.state.row)
}

/// Where a quantity stands in the results of a tab.
#[derive(Debug, Clone, Copy)]
pub struct Listed {
    pub key: &'static str,
    /// Its place among the quantities.
    pub row: usize,
    pub line: usize,
    /// Whether the active method finds a value.
    pub has_value: bool,
}

/// Where a quantity stands in an answer, by its key; else the selected one.
pub(crate) fn place_of(answer: &Answer, state: ResultsState, key: Option<&str>) -> Option<Listed> {
    let is_meant = |(row, quantity): &(usize, &Quantity)| {
        key.map_or(*row == state.row, |key| quantity.key == key)
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

/// The state with a new answer: the selection stays on the quantity that was selected in the answer
/// before, and on its line of the screen. Where nothing was selected, and while the quantity is gone
/// or has no value any more, the top is shown.
#[must_use]
pub fn followed(state: ResultsState, before: Option<Listed>, answer: &Answer) -> ResultsState {
    let selected = before.filter(|_| state.row > 0);
    let Some(key) = selected.map(|selected| selected.key).or(state.lost) else {
        return state;
    };
    let had_value = selected.is_none_or(|selected| selected.has_value);
    let now = place_of(answer, state, Some(key)).filter(|now| now.has_value || !had_value);
    let Some(now) = now else {
        return ResultsState {
            lost: Some(key),
            ..ResultsState::default()
        };
    };
    let above = selected.map_or(0, |selected| selected.line.saturating_sub(state.top));
    ResultsState {
        row: now.row,
        top: now.line.saturating_sub(above),
        lost: None,
    }
}

impl Results<'_> {
    /// The state with the selection so many quantities further.
    #[must_use]
    pub fn stepped(&self, by: isize) -> ResultsState {
        ResultsState {
            row: self.state.row.saturating_add_signed(by).min(self.last()),
            ..self.state
        }
    }

    /// The state so many lines further, the selection moved along where it would be left behind.
    pub(crate) fn turned(&self, by: isize) -> ResultsState {
        let top = scrolled(self, by);
        let last = top + page(self).saturating_sub(1);
        let row = if top == self.state.top {
            self.state.row.saturating_add_signed(by)
        } else {
            self.state.row.clamp(top, last)
        };
        ResultsState {
            row: row.min(self.last()),
            top,
            ..self.state
        }
    }

    fn last(&self) -> usize {
        count(self).saturating_sub(1)
    }
}

/// The first line to be shown, so that the marked quantity is in sight.
pub(crate) fn top_for(pane: &Results<'_>) -> usize {
    let rows = page(pane).max(1);
    let line = line_of(pane, pane.state.row);
    let least = (line + 1).saturating_sub(rows);
    pane.state
        .top
        .clamp(least, line.max(least))
        .min(line_count(pane).saturating_sub(rows))
}

/// The first line to be shown after so many lines downwards.
#[must_use]
pub fn scrolled(pane: &Results<'_>, by: isize) -> usize {
    pane.state
        .top
        .saturating_add_signed(by)
        .min(line_count(pane).saturating_sub(page(pane)))
}

/// The value of the marked quantity beside that of the baseline, where one is pinned.
#[must_use]
pub fn compared(pane: &Results<'_>, quantity: &Quantity) -> Option<String> {
    table::compared(pane, pane.answer?, quantity)
}

/// The place of the quantity on a cell, where there is one.
pub(crate) fn row_at(pane: &Results<'_>, at: Position) -> Option<usize> {
    let line = usize::from(at.y - pane.area.y).checked_sub(lines_before(pane))?;
    let in_sight = line < parts(pane).rows;
    table::row_of(pane.answer?, pane.state.top + line).filter(|&row| in_sight && row < count(pane))
}

// The line of a quantity, by their places.
fn line_of(pane: &Results<'_>, row: usize) -> usize {
    pane.answer
        .map_or(row, |answer| table::line_of(answer, row))
}

fn line_count(pane: &Results<'_>) -> usize {
    count(pane)
        .checked_sub(1)
        .map_or(0, |last| line_of(pane, last) + 1)
}

// Which lines of the table are in sight, where some are not; in words, in numbers, in arrows.
fn position(pane: &Results<'_>, rows: usize) -> [String; 3] {
    let (lines, first) = (line_count(pane), pane.state.top + 1);
    let last = (pane.state.top + rows).min(lines);
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
pub fn sentence(pane: &Results<'_>, solution: &Solution) -> String {
    let sentence = digest::sentence(solution, pane.units);
    symbol(&sentence, pane.look.ascii).into_owned()
}

/// The outcome, the gauges and the notes in full, a line each.
#[must_use]
pub fn in_full(pane: &Results<'_>) -> Vec<String> {
    let Some(answer) = pane.answer else {
        return Vec::new();
    };
    let outcome = answer
        .of(answer.active)
        .map(|solution| sentence(pane, solution));
    let gauges = gauges::gauges(pane, answer)
        .into_iter()
        .map(gauges::Gauge::in_full);
    let notes = answer
        .notes
        .iter()
        .map(|note| format!("{NOTE}{}.", note.message));
    let lines = outcome
        .into_iter()
        .chain(gauges)
        .chain(notes)
        .chain(refused_variants(pane));
    lines.flat_map(|line| [line, String::new()]).collect()
}

// A line for each variant that the model refuses.
fn refused_variants<'a>(pane: &Results<'a>) -> impl Iterator<Item = String> + use<'a> {
    let columns = pane
        .variants
        .into_iter()
        .flat_map(|variants| &variants.columns);
    columns.filter_map(|(name, found)| {
        let reason = found.as_ref().err()?;
        Some(format!("{NOTE}variant {name} is refused: {reason}."))
    })
}

/// How many variants have room beside each other.
#[must_use]
pub fn variants_page(pane: &Results<'_>) -> usize {
    table::variants_page(pane, usize::from(pane.area.width.saturating_sub(1)))
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
fn lines_before(pane: &Results<'_>) -> usize {
    parts(pane).head.len() + 2
}

// As much of it as has room, so that nothing is cut.
fn title(pane: &Results<'_>, rows: usize, room: usize) -> String {
    let name = if pane.shows_last_valid {
        "Results: LAST VALID"
    } else {
        "Results"
    };
    let name_of_base = pane
        .baseline
        .map(|baseline| format!(", against {}", baseline.name));
    let against = name_of_base.as_deref().unwrap_or_default();
    let begun = text::cut(against, room.saturating_sub(name.width()));
    let base = if begun.width() >= LEAST_OF_BASE {
        begun.as_str()
    } else {
        ""
    };
    let answer = pane.answer;
    let pending = answer
        .and_then(|answer| answer.pending)
        .map_or_else(String::new, |method| format!(", {} to come", method.name()));
    let cost = answer
        .filter(|_| pane.shows_cost)
        .map_or_else(String::new, |answer| {
            format!(
                ", {} stages in {} us",
                answer.cost.stages, answer.cost.micros
            )
        });
    let short = if pane.shows_last_valid {
        "LAST VALID"
    } else {
        name
    };
    let [position, numbers, arrows] = position(pane, rows);
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

// With room every gauge and note is printed in full, else each gauge in a line and the notes in one.
fn parts(pane: &Results<'_>) -> Parts {
    let area = pane.area;
    let width = usize::from(area.width.saturating_sub(1));
    let height = usize::from(area.height.saturating_sub(1));
    let mut head = banner(pane, width);
    let (mut gauges, mut notes) = (Vec::new(), Vec::new());
    if let Some(answer) = pane.answer {
        head.extend(outcome(pane, answer, width, height < LOW));
        gauges = gauges::gauges(pane, answer)
            .iter()
            .map(|gauge| gauge.fitting(width))
            .collect();
        notes = answer
            .notes
            .iter()
            .map(|note| format!("{NOTE}{}", note.message))
            .chain(refused_variants(pane))
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
        note_lines = pane
            .answer
            .into_iter()
            .filter_map(|answer| shortened(&answer.notes, width))
            .collect();
    }
    let room_for_head = height.saturating_sub(1 + LEAST_ROWS + note_lines.len());
    let faint = if pane.is_stale {
        pane.look.theme.faint
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
    let style = pane.look.theme.note.patch(faint);
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
    let by_names = (1..=count).rev().map(|shown| {
        let others = if shown < count {
            format!(", {} more", count - shown)
        } else {
            String::new()
        };
        format!("key n: {}{others}", names[..shown].join(", "))
    });
    let counted = format!("{count} {noun}: press n");
    let mut sayings = in_full.into_iter().chain(by_names).chain([counted.clone()]);
    (count > 0).then(|| {
        sayings
            .find(|words| words.width() <= width)
            .unwrap_or(counted)
    })
}

fn banner(pane: &Results<'_>, width: usize) -> Vec<Line<'static>> {
    let theme = pane.look.theme;
    let said = |text: String, style: Style| {
        text::wrap(&text, width)
            .into_iter()
            .map(move |line| Line::styled(line, style))
    };
    let Some(refusal) = pane.refusal else {
        return wrong(pane)
            .into_iter()
            .flat_map(|wrong| said(wrong, theme.problem))
            .collect();
    };
    let cause = said(format!("! Not solved: {refusal}."), theme.problem);
    cause
        .chain(said(
            format!("Correction: {}.", refusal.fix()),
            Style::new(),
        ))
        .collect()
}

// The first field that is wrong, in the order of the form, why, how many more are, and the key that
// goes there.
fn wrong(pane: &Results<'_>) -> Option<String> {
    let (row, problem) = pane.problems.iter().min_by_key(|(row, _)| *row)?;
    let symbol = rows::symbol(pane.case, *row);
    let name = format!(
        "{} {}",
        self::symbol(symbol, pane.look.ascii),
        rows::label(pane.case, *row)
    );
    let fields: BTreeSet<usize> = pane.problems.iter().map(|(row, _)| *row).collect();
    let more = if fields.len() > 1 {
        format!("; {} more", fields.len() - 1)
    } else {
        String::new()
    };
    let key = (pane.next_fault)();
    if let Some(missing) = pane.missing.filter(|&missing| missing > 1) {
        return Some(format!("! {missing} required values are missing ({key})"));
    }
    Some(format!(
        "! {}: {}{more} ({key})",
        name.trim_start(),
        problem.cause
    ))
}

fn outcome(pane: &Results<'_>, answer: &Answer, width: usize, is_low: bool) -> Vec<Line<'static>> {
    let Some(solution) = answer.of(answer.active) else {
        return Vec::new();
    };
    let style = if pane.is_stale {
        pane.look.theme.faint
    } else {
        pane.look.theme.focus
    };
    let words = if is_low && width < NARROW {
        digest::short(solution, pane.units)
    } else {
        sentence(pane, solution)
    };
    let lines = text::wrap(&words, width);
    lines
        .into_iter()
        .map(|line| Line::styled(line, style))
        .collect()
}

fn shown_in(pane: &Results<'_>, quantity: &Quantity, value: f64) -> Shown {
    report::shown_in(quantity, value, pane.units)
}
