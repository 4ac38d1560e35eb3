//! Keys and mouse for the topmost dialog, the effects of its outcome, its jobs, and the pages of
//! explanations and notes.

use super::{edit, export, files, panes, run, study, variants};
use crate::case::units::System;
use crate::model::{self, Refusal, Stages};
use crate::report;
use crate::report::explain;
use crate::study::relief::{NoRelief, specify};
use crate::tui::app::App;
use crate::tui::app::actions::{Running, Work};
use crate::tui::dialogs::browser::Browser;
use crate::tui::dialogs::page::{Explanation, Page};
use crate::tui::dialogs::picker::Pick;
use crate::tui::dialogs::{Dialog, Outcome, Prompt, Surroundings};
use crate::tui::jobs::{Job, Slot};
use crate::tui::panes::results;
use crate::tui::store::{self, folder};

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
pub(super) fn accept(app: &mut App) {
    if let Some(outcome) = with(app, |dialog, around| dialog.accept(around)) {
        decided(app, outcome);
    }
}

/// Handles a letter that is a command of the dialog. Returns false if it is text for a line.
pub(super) fn letter(app: &mut App, letter: char) -> bool {
    let outcome = app.prompts.last_mut().and_then(|prompt| prompt.dialog_mut().letter(letter));
    let is_command = outcome.is_some();
    if let Some(outcome) = outcome {
        decided(app, outcome);
    }
    is_command
}

/// Previews a new selection.
pub(super) fn preview(app: &mut App) {
    let units = app.settings.units;
    let prompt = app.prompts.last_mut();
    if let Some(job) = prompt.and_then(|prompt| prompt.dialog_mut().preview(units)) {
        app.start_job(job);
    }
}

/// Closes the topmost dialog. Returns false if there is none.
pub(super) fn close(app: &mut App) -> bool {
    let prompt = app.prompts.pop();
    if matches!(prompt, Some(Prompt::Relief(_))) {
        app.cancel(Slot::Relief);
    }
    prompt.is_some()
}

/// The work of a job, which brings its result into the topmost dialog.
#[must_use]
pub fn work_of(job: Job) -> Work {
    let slot = job.slot();
    match job {
        Job::Folder(asked, place) => Work::new(
            slot,
            |_| Some(folder::list(asked, place)),
            |app, listing| {
                let browser = browser(app);
                let accepts = browser.is_some_and(|browser| {
                    browser.take(listing);
                    browser.accepts_now()
                });
                if accepts {
                    accept(app);
                }
            },
        ),
        Job::Search(asked, place) => Work::new(
            slot,
            move |running| folder::find(asked, &place, &|_| running.is_wanted()),
            |app, found| in_browser(app, |browser| browser.take_below(found)),
        ),
        Job::Preview(target, system) => Work::new(
            slot,
            move |running| {
                let preview = folder::preview(&target, system, &|_| running.is_wanted())?;
                Some((target, preview))
            },
            |app, (target, preview)| {
                if let Some(prompt) = app.prompts.last_mut() {
                    prompt.dialog_mut().show(&target, preview);
                }
            },
        ),
        Job::Recents => Work::new(
            slot,
            |_| Some(store::looked_at(store::recents())),
            |app, recents| in_browser(app, |browser| browser.remember(recents)),
        ),
        // As in `tipstrike relief`.
        Job::Relief(request) => Work::new(
            slot,
            move |running| {
                let go_on = |_| running.is_wanted();
                let found = match specify(&request.inputs, &request.demand, &go_on) {
                    Ok(found) => Ok(Box::new(found)),
                    Err(NoRelief::Refused(Refusal::Stopped)) => return None,
                    Err(none) => Err(none.to_string()),
                };
                Some((request.demand, found))
            },
            |app, (demand, found)| {
                if let Some(Prompt::Relief(dialog)) = app.prompts.last_mut() {
                    dialog.take(&demand, found);
                }
            },
        ),
        Job::Export(exporting) => export::work(*exporting),
    }
}

/// Opens the browser in the folder of the present case or on the recent cases.
pub(super) fn open_browser(app: &mut App, prefers_recents: bool) {
    let browser = Browser::beside(app.tab.path.as_deref(), prefers_recents);
    app.start_job(browser.list());
    app.start_job(Job::Recents);
    app.prompts.push(Prompt::Browse(Box::new(browser)));
}

/// Goes to the recent cases, in an open browser or in a new one.
pub(super) fn open_recent(app: &mut App) {
    match browser(app) {
        Some(browser) => browser.select_recents(),
        None => open_browser(app, true),
    }
}

/// Goes to the parent folder.
pub(super) fn browse_up(app: &mut App) {
    if let Some(browser) = browser(app) {
        let job = browser.leave();
        app.start_job(job);
    }
}

/// Whether the line of a browser is empty, so that there is nothing to delete.
pub(super) fn is_in_empty_line(app: &mut App) -> bool {
    browser(app).is_some_and(|browser| browser.input.value().is_empty())
}

/// Enters the selected folder, or writes the selected name into the line.
pub(super) fn complete_path(app: &mut App) {
    let jobs = browser(app).map_or_else(Vec::new, Browser::complete);
    start_all(app, jobs);
}

/// Handles a change of the line of a dialog.
pub(super) fn line_changed(app: &mut App) {
    let prompt = app.prompts.last_mut();
    let jobs = prompt.map_or_else(Vec::new, |prompt| prompt.dialog_mut().typed());
    start_all(app, jobs);
}

/// Opens the explanation of the selected result.
pub(super) fn explain(app: &mut App) {
    let Some(quantity) = app.results().marked() else {
        return app.complain("there are no results to explain");
    };
    let Some(inputs) = app.tab.inputs().cloned() else {
        return app.complain(
            "these are the last valid results: fix the fields marked with ! to explain a result",
        );
    };
    let solution = app.tab.answer.as_ref().and_then(|answer| answer.of(answer.active));
    let value = solution.and_then(|solution| report::value(quantity, solution));
    let value = value.and_then(|value| {
        let [own, metric] = [app.settings.units, System::Metric]
            .map(|system| report::shown_in(quantity, value, system));
        (own.unit != metric.unit).then_some(own)
    });
    app.prompts.push(Prompt::Explain(Explanation::new(quantity, app.tab.name(), value)));
    let case = app.tab.case.clone();
    // As in `tipstrike explain`.
    let page = move |_: &Running<'_>| {
        let inputs = inputs.needing([quantity.stage]);
        Some(match model::solve(&inputs, Stages::of(quantity.stage)) {
            Ok(solution) => Ok(Box::new(explain::explain(quantity, &case, &inputs, &solution))),
            Err(refusal) => Err(format!("Not solved: {refusal}. Correction: {}.", refusal.fix())),
        })
    };
    app.start(Work::new(Slot::Explanation, page, |app, page| {
        if let Some(Prompt::Explain(explanation)) = app.prompts.last_mut() {
            explanation.page = Some(page);
        }
    }));
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
    let Some(at) = app.prompts.iter().position(is_of_results) else { return };
    let lines = results::in_full(&app.results());
    if let Prompt::Read(page) = &mut app.prompts[at] {
        page.lines = lines;
    }
}

/// Selects another field of the explanation and makes it visible.
pub(super) fn step_page(app: &mut App, by: isize) {
    with(app, |dialog, around| dialog.select_field(by, around));
}

fn browser(app: &mut App) -> Option<&mut Browser> {
    app.prompts.last_mut().and_then(Prompt::browser)
}

fn in_browser(app: &mut App, act: impl FnOnce(&mut Browser)) {
    if let Some(browser) = browser(app) {
        act(browser);
    }
}

fn start_all(app: &mut App, jobs: Vec<Job>) {
    for job in jobs {
        app.start_job(job);
    }
}

fn decided(app: &mut App, outcome: Outcome) {
    match outcome {
        Outcome::Jobs(jobs) => start_all(app, jobs),
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
        }
    }
}

fn pick(app: &mut App, pick: Pick) {
    let prompt = app.prompts.pop();
    match pick {
        Pick::Variant => {
            let name = match &prompt {
                Some(Prompt::Pick(picker)) => picker.variant_name().unwrap_or_default(),
                _ => "",
            };
            variants::keep(app, name);
        }
        Pick::Run(name) => run(app, name),
        Pick::Chart(at) => panes::select_chart(app, at),
        Pick::Begin(example) => files::begin_example(app, example),
        Pick::Make(gears, material) => edit::make_of_material(app, gears, material),
        Pick::Limit(quantity) => edit::hold_limit(app, quantity),
        Pick::Second(field) => study::choose(app, field),
        Pick::Show(quantity) => panes::show_result(app, quantity.key),
        Pick::Go(field) => panes::go_to(app, field),
    }
}
