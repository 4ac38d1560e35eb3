//! Esc and Ctrl-C: they end the topmost dialog or work first.

use super::{files, panes, study};
use crate::model::Stage;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::layout::Pane;
use crate::tui::tab::Tab;

/// Message of Ctrl-C if there is nothing to cancel and nothing unsaved.
pub(super) const LEAVING: &str = "no running work and no unsaved edits: press Ctrl-C again to \
    quit";

/// Esc: closes a dialog, leaves the field, or stops the work; no edit is lost.
pub(super) fn leave(app: &mut App) -> Vec<Effect> {
    if let Some(mut prompt) = app.prompts.pop() {
        return prompt.dialog_mut().close();
    }
    // Hints such as `Esc n` rely on one Esc to leave the field, also while work runs.
    if app.has_line() {
        app.tab.history.end_visit();
        app.is_editing = false;
        return Vec::new();
    }
    let stopped = stop(app, app.layout.focus() == Pane::Study);
    if !stopped.is_empty() {
        return stopped;
    }
    if app.is_playing {
        return panes::stop_playing(app);
    }
    if app.cursor.is_some() && app.layout.focus().is_lower() {
        app.cursor = None;
    } else if app.layout.is_zoomed() {
        panes::zoom(app);
    } else {
        panes::show(app, Pane::Form);
    }
    Vec::new()
}

/// Ctrl-C: closes or stops the topmost item. If there is none, the second press quits, because
/// other programs copy with this key.
pub(super) fn cancel(app: &mut App) -> Vec<Effect> {
    if let Some(mut prompt) = app.prompts.pop() {
        return prompt.dialog_mut().close();
    }
    let stopped = stop(app, true);
    if !stopped.is_empty() {
        return stopped;
    }
    if app.is_playing {
        return panes::stop_playing(app);
    }
    if app.tabs().any(Tab::is_unsaved) {
        return files::quit(app);
    }
    app.say(LEAVING);
    Vec::new()
}

/// Stops long work, with the study on request. Its results so far stay.
fn stop(app: &mut App, has_study: bool) -> Vec<Effect> {
    let measuring = app.progress.as_ref().map(|_| Effect::CancelWork);
    let solving = app.tab.solving.take().map(|_| {
        app.tab.is_settled = true;
        app.is_pinning = false;
        if let Some(method) = app.tab.answer.as_mut().and_then(|answer| answer.pending.take()) {
            app.say(format!(
                "method {} is stopped; the closed form is shown until the next edit",
                method.name()
            ));
        }
        Effect::CancelSolve
    });
    measuring
        .into_iter()
        .chain(has_study.then(|| study::stop(app)).flatten())
        .chain(solving.or_else(|| stop_seeking(app)))
        .collect()
}

// Stops the search for the required relief, which starts after the other results are shown.
fn stop_seeking(app: &mut App) -> Option<Effect> {
    let answer = app
        .tab
        .answer
        .as_mut()
        .filter(|answer| answer.strikes() && answer.lacks(Stage::Clearing))?;
    answer.requested = answer.stages;
    app.say("the search for the required relief is stopped until the next edit");
    Some(Effect::CancelSolve)
}
