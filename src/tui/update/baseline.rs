//! The baseline: pinned results for comparison.

use crate::tui::app::App;
use crate::tui::solver::Baseline;

/// Pins the results of the current case, or unpins the pinned ones.
pub(super) fn toggle(app: &mut App) {
    if let Some(baseline) = app.baseline.take() {
        app.say(format!("baseline {} unpinned", baseline.name));
    } else if app.tab.is_stale() || app.tab.answer.is_none() {
        app.complain("there are no valid results to pin: fix the form first");
    } else {
        app.is_pinning = true;
        pin(app);
    }
}

/// Pins the requested results as soon as they are complete.
pub(super) fn pin(app: &mut App) {
    let Some(answer) = app
        .tab
        .answer
        .as_ref()
        .filter(|answer| app.is_pinning && answer.stages.covers(crate::model::Stages::EVERY))
    else {
        return;
    };
    let (name, is_file) = (app.tab.short_name(), app.tab.path.is_some());
    let baseline = Baseline {
        tab: app.tab.id,
        name,
        is_file,
        case: app.tab.case.clone(),
        answer: answer.clone(),
    };
    let words = format!("baseline: {} as it is now, for this session", baseline.name);
    app.is_pinning = false;
    app.baseline = Some(baseline);
    app.say(words);
}

/// A case that had no file when it was pinned gets the name of the file to which these values were
/// saved.
pub(super) fn rename(app: &mut App) {
    let (tab, name) = (app.tab.id, app.tab.short_name());
    let saved = &app.tab.saved;
    let is_it = |baseline: &&mut Baseline| {
        baseline.tab == tab && !baseline.is_file && baseline.case == *saved
    };
    if let Some(baseline) = app.baseline.as_mut().filter(is_it) {
        (baseline.name, baseline.is_file) = (name, true);
    }
}
