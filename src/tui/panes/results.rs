//! The results pane: the outcome, figures and notes as sentences above the table of quantities.

mod sentences;
mod table;

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

pub(crate) use sentences::in_full;
pub(crate) use table::{compared, label};

/// Figures and notes get at most this part of the lines beside the outcome.
const SENTENCES: usize = 2;
/// Least number of visible quantities, below the outcome and below a fault.
const LEAST_ROWS: usize = 4;
const LEAST_BELOW_FAULT: usize = 2;

/// The state of the pane, separate for each open case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ResultsState {
    /// The key of the selected quantity. While the results do not have it, the first one is
    /// selected.
    pub selected: Option<&'static str>,
    /// The first visible line of the quantities.
    pub top: usize,
}

/// The pane with the results that it shows.
#[derive(Debug, Clone)]
pub struct Results<'a> {
    pub(crate) state: ResultsState,
    /// The last valid results.
    pub(crate) answer: Option<&'a Answer>,
    /// Whether they are older than the form.
    pub(crate) is_stale: bool,
    /// The pinned results.
    pub(crate) baseline: Option<&'a Baseline>,
    /// The variants, with the first visible one, if they are shown instead of the methods.
    pub(crate) variants: Option<(&'a Variants, usize)>,
    /// The values before the last edit.
    pub(crate) earlier: Option<&'a Values>,
    /// Why the model refuses the case.
    pub(crate) refusal: Option<&'a Refusal>,
    /// The invalid rows of the form.
    pub(crate) problems: &'a [(usize, Problem)],
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// Whether the title shows the cost of the solve.
    pub(crate) shows_cost: bool,
    /// The key that shows the outcome and every note in full.
    pub(crate) notes_key: &'static str,
    pub(crate) units: System,
    pub(crate) look: Look,
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

impl Results<'_> {
    /// The quantities in their order.
    #[must_use]
    pub fn listed(&self) -> Vec<&'static Quantity> {
        self.answer.map_or_else(Vec::new, table::order)
    }

    /// The selected line among the quantities.
    fn row(&self) -> usize {
        let is_selected = |quantity: &&Quantity| Some(quantity.key) == self.state.selected;
        self.listed().iter().position(is_selected).unwrap_or(0)
    }

    /// The selected quantity.
    #[must_use]
    pub fn marked(&self) -> Option<&'static Quantity> {
        self.listed().get(self.row()).copied()
    }

    /// The number of visible quantities.
    #[must_use]
    pub fn page(&self) -> usize {
        parts(self).1
    }

    /// The state with the selection `by` quantities further.
    #[must_use]
    pub(crate) fn stepped(&self, by: isize) -> ResultsState {
        self.with_selection(self.row().saturating_add_signed(by))
    }

    fn with_selection(&self, row: usize) -> ResultsState {
        let listed = self.listed();
        let quantity = listed.get(row).or(listed.last());
        ResultsState { selected: quantity.map(|quantity| quantity.key), ..self.state }
    }

    /// The state scrolled by `by` lines; the selection moves if it would leave the visible lines.
    pub(crate) fn turned(&self, by: isize) -> ResultsState {
        let top = self.scrolled(by);
        let row = if top == self.state.top {
            self.row().saturating_add_signed(by)
        } else {
            self.row().clamp(top, top + self.page().saturating_sub(1))
        };
        ResultsState { top, ..self.with_selection(row) }
    }

    /// The first visible line after scrolling by lines downwards.
    #[must_use]
    pub(crate) fn scrolled(&self, by: isize) -> usize {
        let last = self.listed().len().saturating_sub(self.page());
        self.state.top.saturating_add_signed(by).min(last)
    }

    /// The first visible line such that the selected quantity is visible.
    pub(crate) fn top_for(&self) -> usize {
        let (rows, row) = (self.page().max(1), self.row());
        let least = (row + 1).saturating_sub(rows);
        let last = self.listed().len().saturating_sub(rows);
        self.state.top.clamp(least, row.max(least)).min(last)
    }

    /// The key of the quantity at a cell, if any.
    pub(crate) fn key_at(&self, at: Position) -> Option<&'static str> {
        let (head, rows) = parts(self);
        let line = usize::from(at.y - self.area.y).checked_sub(head.len() + 2)?;
        let listed = self.listed();
        listed.get(self.state.top + line).filter(|_| line < rows).map(|quantity| quantity.key)
    }

    /// The number of variants that fit side by side.
    #[must_use]
    pub(crate) fn variants_page(&self) -> usize {
        table::variants_page(self)
    }

    fn shows_last_valid(&self) -> bool {
        self.is_stale && self.answer.is_some()
    }
}

pub(crate) fn draw(pane: &Results<'_>, buffer: &mut Buffer) {
    let (head, rows) = parts(pane);
    let inner = pane.title.draw(&title(pane, rows), pane.area, buffer);
    let [above, body] =
        Layout::vertical([Constraint::Length(head.len() as u16), Constraint::Fill(1)]).areas(inner);
    // The first column has the mark of the selected row.
    let [_, above] = Layout::horizontal([Constraint::Length(1), Constraint::Fill(1)]).areas(above);
    Text::from(head).render(above, buffer);
    let Some(answer) = pane.answer else { return };
    let (row, top) = (pane.row(), pane.state.top);
    let is_marked = pane.title.has_focus && (top..top + rows).contains(&row);
    let mut state = TableState::new().with_offset(top).with_selected(is_marked.then_some(row));
    StatefulWidget::render(table::table(pane, answer), body, buffer, &mut state);
}

/// The lines above the table, and the number of quantities that fit below them: the fault, or the
/// outcome, in full, then as many sentences as fit into their part, and the number of the others.
fn parts(pane: &Results<'_>) -> (Vec<Line<'static>>, usize) {
    let width = usize::from(pane.area.width.saturating_sub(1));
    let height = usize::from(pane.area.height.saturating_sub(1));
    let wrapped = |(text, style): (String, Style)| -> Vec<Line<'static>> {
        text::wrap(&text, width).into_iter().map(|line| Line::styled(line, style)).collect()
    };
    let (first, others) = sentences::of(pane);
    let mut head: Vec<_> = first.into_iter().flat_map(wrapped).collect();
    let others: Vec<_> = others.into_iter().map(wrapped).collect();
    let has_fault = pane.refusal.is_some() || !pane.problems.is_empty();
    let most = match pane.answer {
        None => height,
        Some(_) if has_fault => height.saturating_sub(LEAST_BELOW_FAULT + 2),
        Some(_) => height.saturating_sub(LEAST_ROWS + 2),
    };
    if head.len() > most {
        head.truncate(most);
        head.iter_mut().last().into_iter().for_each(|line| line.push_span("…"));
    }
    let mut room = height.saturating_sub(head.len() + 1) / SENTENCES;
    let all: usize = others.iter().map(Vec::len).sum();
    if all > room {
        // The last line counts the hidden sentences.
        room = room.saturating_sub(1);
    }
    let mut hidden = others.len();
    for lines in others {
        if lines.len() > room {
            break;
        }
        (room, hidden) = (room - lines.len(), hidden - 1);
        head.extend(lines);
    }
    if hidden > 0 {
        let noun = if hidden == 1 { "note" } else { "notes" };
        let words = format!("{hidden} more {noun} ({})", pane.notes_key);
        head.push(Line::styled(words, pane.look.theme.note));
    }
    let rows = if pane.answer.is_some() { height.saturating_sub(head.len() + 1) } else { 0 };
    (head, rows)
}

fn title(pane: &Results<'_>, rows: usize) -> String {
    let name = if pane.shows_last_valid() { "Results: LAST VALID" } else { "Results" };
    let (count, top) = (pane.listed().len(), pane.state.top);
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
