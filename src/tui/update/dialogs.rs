//! Keys, mouse and results for the topmost dialog, the effects of its outcome, and the pages of
//! explanations and notes.

use super::{edit, export, files, panes, run, solve, study, variants};
use crate::case::units::System;
use crate::model::Quantity;
use crate::report;
use crate::tui::actions::{Action, Effect};
use crate::tui::app::App;
use crate::tui::dialogs::browser::Browser;
use crate::tui::dialogs::page::{Explanation, Page};
use crate::tui::dialogs::picker::Pick;
use crate::tui::dialogs::{Dialog, Outcome, Prompt, Surroundings};
use crate::tui::jobs::{Explaining, Job};
use crate::tui::panes::results;

/// Passes control to the topmost dialog; `None` if there is no dialog.
pub(super) fn with<T>(
    app: &mut App,
    act: impl FnOnce(&mut dyn Dialog, &Surroundings<'_>) -> T,
) -> Option<T> {
    let mut prompt = app.prompts.pop()?;
    let result = act(prompt.dialog_mut(), &app.surroundings());
    app.prompts.push(prompt);
    Some(result)
}

/// Handles Enter.
pub(super) fn accept(app: &mut App) -> Vec<Effect> {
    let outcome = with(app, |dialog, around| dialog.accept(around));
    outcome.map_or_else(Vec::new, |outcome| decided(app, outcome))
}

/// Handles a letter that is a command of the dialog; `None` if it is text for a line.
pub(super) fn letter(app: &mut App, letter: char) -> Option<Vec<Effect>> {
    let outcome = app.prompts.last_mut()?.dialog_mut().letter(letter)?;
    Some(decided(app, outcome))
}

/// Passes on the result of a job.
pub(super) fn receive(app: &mut App, result: Action) -> Vec<Effect> {
    let Some(prompt) = app.prompts.last_mut() else {
        return Vec::new();
    };
    prompt.dialog_mut().receive(result);
    let accepts = prompt.browser().is_some_and(Browser::accepts_now);
    if accepts { accept(app) } else { Vec::new() }
}

/// The job that previews a new selection.
pub(super) fn preview(app: &mut App) -> Option<Effect> {
    let units = app.settings.units;
    app.prompts.last_mut()?.dialog_mut().preview(units)
}

/// Opens the explanation of the selected result.
pub(super) fn explain(app: &mut App) -> Vec<Effect> {
    let Some(quantity) = app.results().marked() else {
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
pub(super) fn refresh_page(app: &mut App) {
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
pub(super) fn step_page(app: &mut App, by: isize) {
    with(app, |dialog, around| dialog.select_field(by, around));
}

fn decided(app: &mut App, outcome: Outcome) -> Vec<Effect> {
    match outcome {
        Outcome::Effects(effects) => effects,
        Outcome::Open(path) => files::open(app, path),
        Outcome::Choose(choice) => files::choose(app, choice),
        Outcome::SaveAs(name, next) => files::save_under(app, &name, next),
        Outcome::Relief(values) => edit::take_relief(app, &values),
        Outcome::Export(name) => export::begin(app, name.trim().into(), false),
        Outcome::CursorTo(angle) => panes::move_cursor(app, angle),
        Outcome::Pick(chosen) => pick(app, chosen),
        Outcome::GoTo(field) => {
            app.prompts.clear();
            panes::go_to(app, field);
            Vec::new()
        }
    }
}

fn pick(app: &mut App, pick: Pick) -> Vec<Effect> {
    let prompt = app.prompts.pop();
    match pick {
        Pick::Variant => {
            let name = match &prompt {
                Some(Prompt::Pick(picker)) => picker.variant_name().unwrap_or_default(),
                _ => "",
            };
            variants::keep(app, name)
        }
        Pick::Run(command) => run(app, command),
        Pick::Begin(example) => solve(files::begin_example(app, example)),
        Pick::Make(gears, material) => edit::make_of_material(app, gears, material),
        Pick::Limit(key) => {
            Quantity::find(key).map_or_else(Vec::new, |quantity| edit::hold_limit(app, quantity))
        }
        Pick::Second(field) => {
            study::choose(app, field);
            Vec::new()
        }
        Pick::Show(key) => {
            panes::show_result(app, key);
            Vec::new()
        }
        Pick::Go(field) => {
            panes::go_to(app, field);
            Vec::new()
        }
    }
}
