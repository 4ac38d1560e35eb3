//! The results pane: its state, its selection and its parts from top to bottom: the outcome as a
//! sentence, the gauges, every quantity with the methods side by side.

mod table;
mod words;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use unicode_width::UnicodeWidthStr;

use super::Title;
use crate::case::units::System;
use crate::case::{Case, Problem};
use crate::model::{Quantity, Refusal};
use crate::report::digest;
use crate::tui::solver::{Answer, Baseline, Values, Variants};
use crate::tui::text;
use crate::tui::theme::Look;

pub(crate) use words::in_full;
use words::{Gauge, NOTE, faults, refused_variants, sentence};

/// Number of visible quantities above which gauges and notes get more than one line each.
const ENOUGH_ROWS: usize = 8;

/// Least number of visible quantities, below outcome and gauges or below a refusal.
const LEAST_ROWS: usize = 4;
const LEAST_BELOW_FAULT: usize = 2;

/// A pane with fewer lines and columns shows the outcome as a short phrase.
const LOW: usize = 20;

const NARROW: usize = 30;

/// Least useful width of the baseline's name with the word before it.
const LEAST_OF_BASE: usize = ", against name…".len();

/// Words for the variants, the longest first.
const VARIANTS: [&str; 2] = [", variants against the case", ", variants"];

/// The state of the pane, separate for each open case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ResultsState {
    /// The selected line among the quantities.
    pub row: usize,
    /// The first visible line of the quantities.
    pub top: usize,
    /// The quantity that was selected and is missing from the present results; the selection
    /// returns to it.
    pub(crate) lost: Option<&'static str>,
}

/// The pane with the results that it shows.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "the flags are independent")]
pub struct Results<'a> {
    /// The state of the pane.
    pub(crate) state: ResultsState,
    /// The last valid results.
    pub(crate) answer: Option<&'a Answer>,
    /// The pinned results.
    pub(crate) baseline: Option<&'a Baseline>,
    /// The variants, if they are shown instead of the methods.
    pub(crate) variants: Option<&'a Variants>,
    /// The first visible variant.
    pub(crate) first_variant: usize,
    /// The values before the last edit.
    pub(crate) earlier: Option<&'a Values>,
    /// Why the model refuses the case.
    pub(crate) refusal: Option<&'a Refusal>,
    /// The invalid rows of the form.
    pub(crate) problems: &'a [(usize, Problem)],
    /// The number of missing required values, if nothing else is wrong.
    pub(crate) missing: Option<usize>,
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// Whether the results are older than the form.
    pub(crate) is_stale: bool,
    /// Whether the title shows that the results are older.
    pub(crate) shows_last_valid: bool,
    /// Whether the title shows the cost of the solve.
    pub(crate) shows_cost: bool,
    /// Whether the pane has the focus.
    pub(crate) is_focused: bool,
    /// Returns the name of the key that goes to the next invalid row.
    pub(crate) next_fault: fn() -> String,
    /// Returns the name of the key that shows the outcome and every note in full.
    pub(crate) notes_key: fn() -> String,
    /// The display units.
    pub(crate) units: System,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The title line.
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

/// A quantity in the results of a tab.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Listed {
    pub(crate) key: &'static str,
    /// Its index among the quantities.
    pub(crate) row: usize,
    pub(crate) line: usize,
    /// Whether the active method has a value.
    pub(crate) has_value: bool,
}

impl Results<'_> {
    /// The state with the selection `by` quantities further.
    #[must_use]
    pub(crate) fn stepped(&self, by: isize) -> ResultsState {
        ResultsState {
            row: self.state.row.saturating_add_signed(by).min(self.last()),
            ..self.state
        }
    }

    /// The state scrolled by `by` lines; the selection moves if it would leave the visible lines.
    pub(crate) fn turned(&self, by: isize) -> ResultsState {
        let top = scrolled(self, by);
        let last = top + page(self).saturating_sub(1);
        let row = if top == self.state.top {
            self.state.row.saturating_add_signed(by)
        } else {
            self.state.row.clamp(top, last)
        };
        ResultsState { row: row.min(self.last()), top, ..self.state }
    }

    fn last(&self) -> usize {
        count(self).saturating_sub(1)
    }
}

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

/// The quantities in their order.
pub(crate) fn listed<'a>(pane: &Results<'a>) -> impl Iterator<Item = &'static Quantity> + use<'a> {
    pane.answer.into_iter().flat_map(table::order)
}

/// The number of quantities.
#[must_use]
pub fn count(pane: &Results<'_>) -> usize {
    listed(pane).count()
}

/// The number of visible quantities.
#[must_use]
pub fn page(pane: &Results<'_>) -> usize {
    parts(pane).rows
}

/// The selected quantity.
#[must_use]
pub fn marked(pane: &Results<'_>) -> Option<&'static Quantity> {
    table::order(pane.answer?).nth(pane.state.row)
}

/// The quantity with a key in an answer; without a key, the selected quantity.
pub(crate) fn place_of(answer: &Answer, state: ResultsState, key: Option<&str>) -> Option<Listed> {
    let is_meant = |(row, quantity): &(usize, &Quantity)| {
        key.map_or(*row == state.row, |key| quantity.key == key)
    };
    let (row, quantity) = table::order(answer).enumerate().find(is_meant)?;
    let has_value = answer.of(answer.active).and_then(quantity.value).is_some();
    Some(Listed { key: quantity.key, row, line: table::line_of(answer, row), has_value })
}

/// The state for a new answer: the selection stays on the quantity that was selected in the
/// previous answer, and on its line of the screen. Shows the top if nothing was selected, or if the
/// quantity is missing or has no value.
#[must_use]
pub(crate) fn followed(
    state: ResultsState,
    before: Option<Listed>,
    answer: &Answer,
) -> ResultsState {
    let selected = before.filter(|_| state.row > 0);
    let Some(key) = selected.map(|selected| selected.key).or(state.lost) else {
        return state;
    };
    let had_value = selected.is_none_or(|selected| selected.has_value);
    let now = place_of(answer, state, Some(key)).filter(|now| now.has_value || !had_value);
    let Some(now) = now else {
        return ResultsState { lost: Some(key), ..ResultsState::default() };
    };
    let above = selected.map_or(0, |selected| selected.line.saturating_sub(state.top));
    ResultsState { row: now.row, top: now.line.saturating_sub(above), lost: None }
}

/// The first visible line such that the selected quantity is visible.
pub(crate) fn top_for(pane: &Results<'_>) -> usize {
    let rows = page(pane).max(1);
    let line = line_of(pane, pane.state.row);
    let least = (line + 1).saturating_sub(rows);
    pane.state.top.clamp(least, line.max(least)).min(line_count(pane).saturating_sub(rows))
}

/// The first visible line after scrolling by lines downwards.
#[must_use]
pub(crate) fn scrolled(pane: &Results<'_>, by: isize) -> usize {
    pane.state.top.saturating_add_signed(by).min(line_count(pane).saturating_sub(page(pane)))
}

/// The index of the quantity at a cell, if any.
pub(crate) fn row_at(pane: &Results<'_>, at: Position) -> Option<usize> {
    let line = usize::from(at.y - pane.area.y).checked_sub(lines_before(pane))?;
    let in_sight = line < parts(pane).rows;
    table::row_of(pane.answer?, pane.state.top + line).filter(|&row| in_sight && row < count(pane))
}

// The line of a quantity.
fn line_of(pane: &Results<'_>, row: usize) -> usize {
    pane.answer.map_or(row, |answer| table::line_of(answer, row))
}

fn line_count(pane: &Results<'_>) -> usize {
    count(pane).checked_sub(1).map_or(0, |last| line_of(pane, last) + 1)
}

// The number of lines of title, head and heading.
fn lines_before(pane: &Results<'_>) -> usize {
    parts(pane).head.len() + 2
}

/// The content of the pane, from top to bottom.
struct Parts {
    /// The refusal, the outcome, the gauges.
    head: Vec<Line<'static>>,
    /// Number of quantities that fit below their heading.
    rows: usize,
    /// The notes.
    notes: Vec<Line<'static>>,
}

// If there is room, every gauge and note is printed in full; otherwise each gauge has one line and
// all notes share one.
fn parts(pane: &Results<'_>) -> Parts {
    let area = pane.area;
    let width = usize::from(area.width.saturating_sub(1));
    let height = usize::from(area.height.saturating_sub(1));
    let mut head = banner(pane, width);
    let faults = head.len();
    let (mut gauges, mut notes) = (Vec::new(), Vec::new());
    if let Some(answer) = pane.answer {
        head.extend(outcome(pane, answer, width, height < LOW));
        gauges = words::gauges(pane, answer).iter().map(|gauge| gauge.fitting(width)).collect();
        notes = answer
            .notes
            .iter()
            .map(|note| format!("{NOTE}{}", note.message))
            .chain(refused_variants(pane))
            .collect();
    }
    let whole = |texts: &[String]| {
        texts.iter().flat_map(|text| text::wrap(text, width)).collect::<Vec<_>>()
    };
    let rows_beside = |gauges: &[String], notes: &[String]| {
        height.saturating_sub(head.len() + gauges.len() + 1 + notes.len())
    };
    let (mut gauge_lines, mut note_lines) = (whole(&gauges), whole(&notes));
    if rows_beside(&gauge_lines, &note_lines) < ENOUGH_ROWS {
        gauge_lines = gauges.iter().map(|gauge| text::cut(gauge, width)).collect();
        note_lines = shortened(pane, 0, width).into_iter().collect();
        let least = if faults == 0 { LEAST_ROWS } else { LEAST_BELOW_FAULT };
        let room = |notes: usize| height.saturating_sub(head.len() + 1 + least + notes);
        if gauge_lines.len() > room(note_lines.len()) {
            let hidden = gauge_lines.len() - room(1).min(gauge_lines.len());
            gauge_lines.truncate(room(1));
            note_lines = shortened(pane, hidden, width).into_iter().collect();
        }
    }
    let faint = if pane.is_stale { pane.look.theme.faint } else { Style::new() };
    head.extend(gauge_lines.into_iter().map(|gauge| Line::styled(gauge, faint)));
    head.truncate(height.saturating_sub(1 + LEAST_BELOW_FAULT + note_lines.len()));
    let rows = height.saturating_sub(head.len() + 1 + note_lines.len());
    let style = pane.look.theme.note.patch(faint);
    Parts {
        head,
        rows,
        notes: note_lines.into_iter().map(|note| Line::styled(note, style)).collect(),
    }
}

// A single note in full, otherwise the names of as many notes as fit, otherwise their number. If
// lines above are hidden, the number of all hidden lines.
fn shortened(pane: &Results<'_>, hidden: usize, width: usize) -> Option<String> {
    let notes = pane.answer.map_or(&[][..], |answer| &answer.notes[..]);
    let count = notes.len() + hidden;
    let key = (pane.notes_key)();
    let noun = match (hidden, count) {
        (0, 1) => "note",
        (0, _) => "notes",
        (_, 1) => "more line",
        _ => "more lines",
    };
    let counted = format!("{count} {noun} ({key})");
    if hidden > 0 {
        return Some(counted);
    }
    let in_full =
        notes.first().filter(|_| count == 1).map(|note| format!("{NOTE}{}", note.message));
    let names: Vec<String> = notes.iter().map(|note| note.code.replace('-', " ")).collect();
    let by_names = (1..=count).rev().map(|shown| {
        let others =
            if shown < count { format!(", {} more", count - shown) } else { String::new() };
        format!("{NOTE}{}{others} ({key})", names[..shown].join(", "))
    });
    let mut sayings = in_full.into_iter().chain(by_names).chain([counted.clone()]);
    (count > 0).then(|| sayings.find(|words| words.width() <= width).unwrap_or(counted))
}

fn banner(pane: &Results<'_>, width: usize) -> Vec<Line<'static>> {
    let styles = [pane.look.theme.problem, Style::new()];
    let lines = faults(pane).into_iter().zip(styles);
    lines
        .flat_map(|(text, style)| {
            text::wrap(&text, width).into_iter().map(move |line| Line::styled(line, style))
        })
        .collect()
}

fn outcome(pane: &Results<'_>, answer: &Answer, width: usize, is_low: bool) -> Vec<Line<'static>> {
    let Some(solution) = answer.of(answer.active) else {
        return Vec::new();
    };
    let style = if pane.is_stale { pane.look.theme.faint } else { pane.look.theme.focus };
    let words = if is_low && width < NARROW {
        digest::short(solution, pane.units)
    } else {
        sentence(pane, solution)
    };
    let lines = text::wrap(&words, width).into_iter();
    let warning = words::limit_warning(pane, solution).filter(|_| !pane.is_stale);
    let warning = warning.map(|words| Gauge(words).fitting(width));
    let warning = warning.map(|words| {
        let line = text::cut(&words, width);
        Line::styled(line, pane.look.theme.problem)
    });
    lines.map(|line| Line::styled(line, style)).chain(warning).collect()
}

// The range of visible lines of the table, if some are hidden: in words, in numbers, as arrows.
fn position(pane: &Results<'_>, rows: usize) -> [String; 3] {
    let (lines, first) = (line_count(pane), pane.state.top + 1);
    let last = (pane.state.top + rows).min(lines);
    if rows == 0 || rows >= lines {
        return Default::default();
    }
    [
        format!(" {first} to {last} of {lines}"),
        format!(" {first}-{last}/{lines}"),
        [" ", if first > 1 { "↑" } else { "" }, if last < lines { "↓" } else { "" }].concat(),
    ]
}

// The longest title that fits without a cut.
fn title(pane: &Results<'_>, rows: usize, room: usize) -> String {
    let name = if pane.shows_last_valid { "Results: LAST VALID" } else { "Results" };
    let left = room.saturating_sub(name.width());
    let name_of_base = match (pane.variants, pane.baseline) {
        (Some(_), _) => VARIANTS.into_iter().find(|words| words.width() <= left).map(str::to_owned),
        (None, baseline) => baseline.map(|baseline| format!(", against {}", baseline.name)),
    };
    let against = name_of_base.as_deref().unwrap_or_default();
    let begun = text::cut(against, left);
    let base =
        if begun.width() >= LEAST_OF_BASE || pane.variants.is_some() { begun.as_str() } else { "" };
    let answer = pane.answer;
    let pending = answer
        .and_then(|answer| answer.pending)
        .map_or_else(String::new, |method| format!(", {} pending", method.name()));
    let cost = answer.filter(|_| pane.shows_cost).map_or_else(String::new, |answer| {
        format!(", {} stages in {} us", answer.cost.stages, answer.cost.micros)
    });
    let short = if pane.shows_last_valid { "LAST VALID" } else { name };
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
    titles.into_iter().find(|title| title.width() <= room).unwrap_or_else(|| short.to_owned())
}
