//! The trade pane with the benchmark that it shows, and its selection.

use ratatui::layout::Rect;

use crate::model::Inputs;
use crate::study::trade::{Measured, Setting, Trade};
use crate::tui::benchmark::{TradeView, Traded};
use crate::tui::panes::title::Title;
use crate::tui::theme::Look;

/// The pane with the benchmark that it shows.
#[derive(Debug, Clone)]
pub(crate) struct TradePane<'a> {
    /// The benchmark of the open case.
    pub(crate) traded: Option<&'a Traded>,
    /// The case in the form, if it is valid.
    pub(crate) inputs: Option<&'a Inputs>,
    /// Chart or table.
    pub(crate) view: TradeView,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The title line.
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

/// The settings that have an error and a time, the quicker ones first.
#[must_use]
pub(crate) fn ordered(trade: &Trade) -> Vec<&Measured> {
    let mut found: Vec<&Measured> = trade
        .settings
        .iter()
        .filter(|measured| measured.total().is_some())
        .collect();
    found.sort_by(|one, other| one.seconds().total_cmp(&other.seconds()));
    found
}

/// The setting so many places from the selected one, in the order of their times.
#[must_use]
pub(crate) fn stepped(traded: &Traded, by: isize) -> Option<Setting> {
    let settings: Vec<Setting> = traded
        .trade
        .iter()
        .flat_map(ordered)
        .map(|measured| measured.setting)
        .collect();
    let last = settings.len().checked_sub(1)?;
    let now = traded
        .marked
        .and_then(|marked| settings.iter().position(|setting| *setting == marked));
    let next = now.map_or(0, |now| now.saturating_add_signed(by).min(last));
    Some(settings[next])
}

pub(super) fn own(pane: &TradePane<'_>) -> Option<Setting> {
    pane.inputs.map(Setting::of)
}
