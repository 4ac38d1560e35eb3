//! The trade pane with the benchmark that it shows, and its selection.

use ratatui::layout::Rect;

use crate::model::Inputs;
use crate::report::trade::compliances;
use crate::study::trade::{MeasuredSetting, Setting, Trade};
use crate::tui::jobs::{TradeView, Traded};
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

/// The settings that have an error and a time, the faster ones first.
#[must_use]
pub(crate) fn ordered(trade: &Trade) -> Vec<&MeasuredSetting> {
    let mut found: Vec<&MeasuredSetting> =
        trade.settings.iter().filter(|measured| measured.total().is_some()).collect();
    found.sort_by(|one, other| one.seconds().total_cmp(&other.seconds()));
    found
}

/// The visible settings in the order of the arrow keys: by their times in the chart, row by row in
/// the table.
fn visible(trade: &Trade, view: TradeView) -> Vec<Setting> {
    match view {
        TradeView::Chart => ordered(trade).into_iter().map(|measured| measured.setting).collect(),
        TradeView::Table => {
            let rows = compliances(trade).into_iter();
            let cells = rows.flat_map(|(_, cells)| cells);
            cells.flatten().map(|cell| cell.setting).collect()
        }
    }
}

/// The visible setting nearest to the selected one: that setting itself, otherwise one of its
/// method, preferably with its compliance.
#[must_use]
pub(crate) fn nearest(traded: &Traded, view: TradeView) -> Option<Setting> {
    let (marked, trade) = (traded.marked?, traded.trade.as_ref()?);
    let distance = |setting: &Setting| {
        (*setting != marked, setting.method != marked.method, setting.models != marked.models)
    };
    visible(trade, view).into_iter().min_by_key(distance)
}

/// The setting `by` places from the selected one, in the order of the view.
#[must_use]
pub(crate) fn stepped(traded: &Traded, view: TradeView, by: isize) -> Option<Setting> {
    let settings: Vec<Setting> =
        traded.trade.iter().flat_map(|trade| visible(trade, view)).collect();
    let last = settings.len().checked_sub(1)?;
    let now =
        traded.marked.and_then(|marked| settings.iter().position(|setting| *setting == marked));
    let next = now.map_or(0, |now| now.saturating_add_signed(by).min(last));
    Some(settings[next])
}

pub(super) fn own(pane: &TradePane<'_>) -> Option<Setting> {
    pane.inputs.map(Setting::of)
}
