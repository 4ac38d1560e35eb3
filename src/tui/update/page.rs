//! The explanation of a result, and the page of outcome, limits and notes.

use super::dialogs;
use crate::case::units::System;
use crate::report;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::page::{Explanation, Page};
use crate::tui::jobs::{Explaining, Job};
use crate::tui::panes::results;

/// Opens the explanation of the selected result.
pub(super) fn explain(app: &mut App) -> Vec<Effect> {
    let Some(quantity) = results::marked(&app.results()) else {
        app.complain("there are no results to explain");
        return Vec::new();
    };
    let Some(inputs) = app.tab.inputs().cloned() else {
        app.complain(
            "these are the last valid results: fix the fields marked with ! to explain a result",
        );
        return Vec::new();
    };
    let solution = app.tab.answer.as_ref().and_then(|answer| answer.of(answer.active));
    let value = solution.and_then(|solution| report::value(quantity, solution));
    let value = value.and_then(|value| {
        let [own, metric] = [app.settings.units, System::Metric]
            .map(|system| report::shown_in(quantity, value, system));
        (own.unit != metric.unit).then_some(own)
    });
    app.prompts.push(Prompt::Explain(Explanation::new(quantity, app.tab.name(), value)));
    vec![Effect::Job(Job::Explain(Box::new(Explaining {
        quantity,
        case: app.tab.case.clone(),
        inputs,
    })))]
}

/// Opens a page with the outcome, the limits and every note in full.
pub(super) fn notes(app: &mut App) {
    let lines = results::in_full(&app.results());
    if lines.is_empty() {
        app.complain("there are no results to show");
    } else {
        let page = Page::new("Outcome, limits, notes", lines);
        app.prompts.push(Prompt::Read(Page { is_of_results: true, ..page }));
    }
}

/// Shows new results on that page while it is open.
pub(super) fn refresh(app: &mut App) {
    let is_of_results =
        |prompt: &Prompt| matches!(prompt, Prompt::Read(page) if page.is_of_results);
    if !app.prompts.iter().any(is_of_results) {
        return;
    }
    let lines = results::in_full(&app.results());
    for prompt in &mut app.prompts {
        if let Prompt::Read(page) = prompt
            && page.is_of_results
        {
            page.lines.clone_from(&lines);
        }
    }
}

/// Selects another field of the explanation and makes it visible.
pub(super) fn step(app: &mut App, by: isize) {
    dialogs::with(app, |dialog, around| dialog.select_field(by, around));
}
