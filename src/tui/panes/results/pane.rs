//! The results pane: its state, and the results that it shows.

use ratatui::layout::Rect;

use crate::case::units::System;
use crate::case::{Case, Problem};
use crate::model::Refusal;
use crate::tui::panes::title::Title;
use crate::tui::solver::{Answer, Baseline, Values, Variants};
use crate::tui::theme::Look;

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
