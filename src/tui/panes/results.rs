//! The results pane: its state and selection; the outcome and the figures as sentences above the
//! table of quantities, the notes below it.

mod table;
mod words;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Text};
use ratatui::widgets::{StatefulWidget, TableState, Widget};

use super::Title;
use crate::case::units::System;
use crate::case::{Case, Problem};
use crate::model::{Quantity, Refusal};
use crate::tui::solver::{Answer, Baseline, Values, Variants};
use crate::tui::text;
use crate::tui::theme::Look;

pub(crate) use table::label;
pub(crate) use words::in_full;

/// Figures and notes get at most this part of the lines beside the outcome.
const SENTENCES: usize = 2;
/// Least number of visible quantities, below the outcome and below a refusal.
const LEAST_ROWS: usize = 4;
const LEAST_BELOW_FAULT: usize = 2;

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
    let parts = parts(pane);
    let inner = pane.title.draw(&title(pane, parts.rows), pane.area, buffer);
    let heights = [parts.head.len(), parts.rows + 1, parts.notes.len()];
    let areas = Layout::vertical(heights.map(|height| Constraint::Length(height as u16)));
    let [head, body, notes] = areas.areas(inner);
    Text::from(parts.head).render(indented(head), buffer);
    Text::from(parts.notes).render(indented(notes), buffer);
    let Some(answer) = pane.answer else { return };
    let ResultsState { row, top, .. } = pane.state;
    let is_marked = pane.is_focused && (top..top + parts.rows).contains(&row);
    let mut state = TableState::new().with_offset(top).with_selected(is_marked.then_some(row));
    StatefulWidget::render(table::table(pane, answer), body, buffer, &mut state);
}

// The column before it has the mark of the selected row.
fn indented(area: Rect) -> Rect {
    Rect { x: area.x + area.width.min(1), width: area.width.saturating_sub(1), ..area }
}

/// The value of the selected quantity with the value of the baseline, if one is pinned.
#[must_use]
pub(crate) fn compared(pane: &Results<'_>, quantity: &Quantity) -> Option<String> {
    table::compared(pane, pane.answer?, quantity)
}

/// The number of variants that fit side by side.
#[must_use]
pub(crate) fn variants_page(pane: &Results<'_>) -> usize {
    table::variants_page(pane)
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
    Some(Listed { key: quantity.key, row, has_value })
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
    let above = selected.map_or(0, |selected| selected.row.saturating_sub(state.top));
    ResultsState { row: now.row, top: now.row.saturating_sub(above), lost: None }
}

/// The first visible line such that the selected quantity is visible.
pub(crate) fn top_for(pane: &Results<'_>) -> usize {
    let (rows, row) = (page(pane).max(1), pane.state.row);
    let least = (row + 1).saturating_sub(rows);
    pane.state.top.clamp(least, row.max(least)).min(count(pane).saturating_sub(rows))
}

/// The first visible line after scrolling by lines downwards.
#[must_use]
pub(crate) fn scrolled(pane: &Results<'_>, by: isize) -> usize {
    pane.state.top.saturating_add_signed(by).min(count(pane).saturating_sub(page(pane)))
}

/// The index of the quantity at a cell, if any.
pub(crate) fn row_at(pane: &Results<'_>, at: Position) -> Option<usize> {
    let parts = parts(pane);
    let line = usize::from(at.y - pane.area.y).checked_sub(parts.head.len() + 2)?;
    let row = pane.state.top + line;
    (line < parts.rows && row < count(pane)).then_some(row)
}

/// The content of the pane, from top to bottom.
struct Parts {
    /// The refusal, the outcome, the figures.
    head: Vec<Line<'static>>,
    /// Number of quantities that fit below their heading.
    rows: usize,
    notes: Vec<Line<'static>>,
}

fn parts(pane: &Results<'_>) -> Parts {
    let width = usize::from(pane.area.width.saturating_sub(1));
    let height = usize::from(pane.area.height.saturating_sub(1));
    let theme = pane.look.theme;
    let wrapped = |text: &str, style: Style| -> Vec<Line<'static>> {
        text::wrap(text, width).into_iter().map(|line| Line::styled(line, style)).collect()
    };
    let faults = words::faults(pane).into_iter().zip([theme.problem, Style::new()]);
    let mut head: Vec<Line<'static>> =
        faults.flat_map(|(fault, style)| wrapped(&fault, style)).collect();
    let Some(answer) = pane.answer else {
        head.truncate(height);
        return Parts { head, rows: 0, notes: Vec::new() };
    };
    let faint = if pane.is_stale { theme.faint } else { Style::new() };
    let least = if head.is_empty() { LEAST_ROWS } else { LEAST_BELOW_FAULT };
    let mut figures: Vec<Vec<Line<'static>>> =
        words::figures(pane, answer).iter().map(|figure| wrapped(figure, faint)).collect();
    if let Some(solution) = answer.of(answer.active) {
        let style = if pane.is_stale { theme.faint } else { theme.focus };
        let warning = words::limit_warning(pane, solution).filter(|_| !pane.is_stale);
        let warning = warning.iter().flat_map(|warning| wrapped(warning, theme.problem));
        let outcome = warning.chain(wrapped(&words::sentence(pane, solution), style)).collect();
        if head.is_empty() {
            head = outcome;
        } else {
            figures.insert(0, outcome);
        }
    }
    let most = height.saturating_sub(least + 2);
    if head.len() > most {
        head.truncate(most);
        head.iter_mut().last().into_iter().for_each(|line| line.push_span("…"));
    }
    let style = theme.note.patch(faint);
    let notes: Vec<Vec<Line<'static>>> =
        words::notes(pane, answer).iter().map(|note| wrapped(note, style)).collect();
    let (all, is_figure) = ([&figures[..], &notes[..]].concat(), figures.len());
    let room = height.saturating_sub(head.len() + 1) / SENTENCES;
    let is_whole = all.iter().map(Vec::len).sum::<usize>() <= room;
    // The last line counts the hidden sentences.
    let mut left = if is_whole { room } else { room.saturating_sub(1) };
    let mut shown = 0;
    while let Some(rest) = all.get(shown).and_then(|lines| left.checked_sub(lines.len())) {
        (left, shown) = (rest, shown + 1);
    }
    let (above, below) = all[..shown].split_at(shown.min(is_figure));
    head.extend(above.concat());
    let mut notes = below.concat();
    if shown < all.len() {
        let hidden = all.len() - shown;
        let noun = if hidden == 1 { "note" } else { "notes" };
        let words = format!("{hidden} more {noun} ({})", (pane.notes_key)());
        notes.push(Line::styled(words, style));
    }
    let rows = height.saturating_sub(head.len() + 1 + notes.len());
    Parts { head, rows, notes }
}

fn title(pane: &Results<'_>, rows: usize) -> String {
    let name = if pane.shows_last_valid { "Results: LAST VALID" } else { "Results" };
    let (count, top) = (count(pane), pane.state.top);
    let position = (0 < rows && rows < count)
        .then(|| format!(" {}-{}/{count}", top + 1, (top + rows).min(count)));
    let base = match (pane.variants, pane.baseline) {
        (Some(_), _) => Some(", variants".to_owned()),
        (None, baseline) => baseline.map(|baseline| format!(", against {}", baseline.name)),
    };
    let pending = pane.answer.and_then(|answer| answer.pending);
    let pending = pending.map(|method| format!(", {} pending", method.name()));
    let cost = pane.answer.filter(|_| pane.shows_cost).map(|answer| answer.cost);
    let cost = cost.map(|cost| format!(", {} stages in {} us", cost.stages, cost.micros));
    let parts = [position, base, pending, cost].into_iter().flatten();
    name.to_owned() + &parts.collect::<String>()
}
