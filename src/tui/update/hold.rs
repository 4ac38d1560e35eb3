//! The baseline: results that are pinned, and held against all others.

use crate::tui::app::{App, Baseline};

/// Pin the results of the current case, or let go of those that are pinned.
pub(super) fn toggle(app: &mut App) {
    if let Some(baseline) = app.baseline.take() {
        app.say(format!("baseline {} unpinned", baseline.name));
    } else if app.is_stale() || app.answer.is_none() {
        app.complain("there are no valid results to pin: mend the form first");
    } else {
        app.is_pinning = true;
        pin(app);
    }
}

/// Pin the results that were asked for as soon as all of them are there.
pub(super) fn pin(app: &mut App) {
    let Some(answer) = app.answer.as_ref().filter(|answer| app.is_pinning && answer.stages == crate::model::Stages::EVERY) else {
        return;
    };
    let baseline = Baseline { tab: app.tab.id, name: app.short_name(), case: app.case.clone(), answer: answer.clone() };
    let words = format!("baseline: {} as it is now, for this session", baseline.name);
    app.is_pinning = false;
    app.baseline = Some(baseline);
    app.say(words);
}

/// The pinned case has another name now.
pub(super) fn rename(app: &mut App) {
    let (tab, name) = (app.tab.id, app.short_name());
    if let Some(baseline) = app.baseline.as_mut().filter(|baseline| baseline.tab == tab) {
        baseline.name = name;
    }
}
