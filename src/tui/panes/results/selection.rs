//! The selected quantity, and which quantities are visible.

use ratatui::layout::Position;

use super::pane::{Results, ResultsState};
use super::parts::parts;
use super::table;
use crate::model::Quantity;
use crate::tui::solver::Answer;

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
pub(super) fn line_of(pane: &Results<'_>, row: usize) -> usize {
    pane.answer.map_or(row, |answer| table::line_of(answer, row))
}

pub(super) fn line_count(pane: &Results<'_>) -> usize {
    count(pane).checked_sub(1).map_or(0, |last| line_of(pane, last) + 1)
}

// The number of lines of title, head and heading.
fn lines_before(pane: &Results<'_>) -> usize {
    parts(pane).head.len() + 2
}
