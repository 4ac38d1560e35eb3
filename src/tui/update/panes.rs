//! Focus and layout: which pane takes the keys, which ones have the screen.

use super::{Effect, cursor};
use crate::tui::app::App;
use crate::tui::pane::Pane;
use crate::tui::view;

/// Go to a pane, and bring it into sight. In the form, letters stay commands until a field is entered.
pub(super) fn show(app: &mut App, pane: Pane) {
    app.tab.history.end_visit();
    app.panes.focus = pane;
    app.is_editing = false;
    if pane.is_lower() && view::plan(app.size, app.panes).area(pane).is_empty() {
        app.panes.lower = pane;
    }
    app.follow();
}

/// The next pane or the one before, round and round.
pub(super) fn step(app: &mut App, by: isize) {
    show(app, app.panes.focus.beside(by));
}

/// Another pane into the lower area; the focus stays where it is unless it is there.
pub(super) fn cycle_lower(app: &mut App) {
    let plan = view::plan(app.size, app.panes);
    let now = Pane::LOWER.iter().position(|&pane| pane == app.panes.lower).unwrap_or(0);
    let others = (1..=Pane::LOWER.len()).map(|by| Pane::LOWER[(now + by) % Pane::LOWER.len()]);
    let next = others.into_iter().find(|&pane| plan.area(pane).is_empty()).unwrap_or(Pane::Chart);
    let has_room = Pane::LOWER.iter().any(|&pane| !plan.area(pane).is_empty());
    if app.panes.focus.is_lower() || !has_room {
        app.panes.lower = next;
        show(app, next);
    } else {
        app.panes.lower = next;
        app.follow();
    }
}

/// Give the focused pane the screen, or take it back.
pub(super) fn zoom(app: &mut App) {
    app.panes.is_zoomed = !app.panes.is_zoomed;
    app.follow();
}

/// Esc: what is topmost goes, and nothing is lost.
pub(super) fn leave(app: &mut App) -> Vec<Effect> {
    if app.prompts.pop().is_some() {
        return Vec::new();
    }
    let stopped = super::stop(app);
    if !stopped.is_empty() {
        return stopped;
    }
    if app.has_line() {
        app.tab.history.end_visit();
        app.is_editing = false;
    } else if app.is_playing {
        return cursor::stop(app);
    } else if app.cursor.is_some() && app.panes.focus.is_lower() {
        app.cursor = None;
    } else if app.panes.is_zoomed {
        zoom(app);
    } else {
        show(app, Pane::Form);
    }
    Vec::new()
}
