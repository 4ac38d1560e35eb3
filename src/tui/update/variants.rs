//! Comparisons: the variants of the case, saved from the edits and loaded into the form, and the
//! baseline.

use super::edit;
use crate::case::{Case, Variant};
use crate::model::{Inputs, Stage};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::commands::Command;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::picker::{List, Picker, VARIANT};
use crate::tui::jobs::Job;
use crate::tui::layout::Pane;
use crate::tui::solver::{Baseline, Variants, VariantsRequest};

/// Asks for the name of the variant.
pub(super) fn ask(app: &mut App) {
    let picker =
        Picker { input: format!("{VARIANT} ").as_str().into(), ..Picker::new(List::Commands) };
    app.prompts.push(Prompt::Pick(picker));
}

/// Saves the edits since the last save as a variant and shows the case without them. Without edits,
/// loads the variant with this name into the form.
pub(super) fn keep(app: &mut App, name: &str) -> Vec<Effect> {
    if let Err(problem) = Variant::check_name(name) {
        app.complain(format!("{}: {}", problem.cause, problem.fix));
        return Vec::new();
    }
    let variant = Variant::between(name, &app.tab.saved, &app.tab.case);
    if variant.overrides.is_empty() {
        return recall(app, name);
    }
    if !app.tab.problems.is_empty() {
        app.complain("a field has an error: correct it before the edits become a variant");
        return Vec::new();
    }
    let count = variant.overrides.len();
    let edits = if count == 1 { "edit" } else { "edits" };
    let mut case = app.tab.saved.clone();
    case.variants.clone_from(&app.tab.case.variants);
    case.keep_variant(variant);
    let effects = edit::replace(app, case);
    app.say(format!(
        "variant {name} now has {count} {edits}; the form shows the case without them; Ctrl-Z undoes"
    ));
    effects
}

/// Shows the variants beside the case, the next variants, or the methods again.
pub(super) fn next(app: &mut App) {
    let count = app.tab.case.variants.len();
    if count == 0 {
        let key = app.key_of(Command::Variant);
        app.say(format!("the case has no variants: {key} NAME saves the edits as one"));
        return;
    }
    let page = app.results().variants_page();
    app.first_variant = match app.first_variant {
        None => Some(0),
        Some(first) if first + page < count => Some(first + page),
        Some(_) => None,
    };
}

/// A request for the visible variants, unless they are solved or requested already.
pub(super) fn request(app: &mut App) -> Option<Effect> {
    let is_shown = !app.layout.plan().area(Pane::Results).is_empty();
    app.first_variant = app.first_variant.filter(|first| *first < app.tab.case.variants.len());
    app.first_variant.filter(|_| is_shown)?;
    let tab = &mut app.tab;
    let is_known = tab.variants.as_ref().is_some_and(|found| found.serial == tab.serial);
    // A request of another tab replaces this request.
    if is_known || app.comparing == Some(tab.serial) || !tab.problems.is_empty() {
        return None;
    }
    app.comparing = Some(tab.serial);
    let column = |variant: &Variant| (variant.name.clone(), inputs(&tab.case, variant));
    let request = VariantsRequest {
        serial: tab.serial,
        columns: tab.case.variants.iter().map(column).collect(),
        stages: Pane::Results.needs().without(Stage::Clearing),
    };
    Some(Effect::Job(Job::Variants(Box::new(request))))
}

/// Shows the solved variants.
pub(super) fn take(app: &mut App, found: Variants) {
    app.comparing = app.comparing.filter(|serial| *serial != found.serial);
    if let Some(tab) = app.tab_of(found.serial) {
        tab.variants = Some(found);
    }
}

/// Pins the results of the current case, or unpins the pinned ones.
pub(super) fn toggle_baseline(app: &mut App) {
    if let Some(baseline) = app.baseline.take() {
        app.say(format!("baseline {} unpinned", baseline.name));
    } else if app.tab.is_stale() || app.tab.answer.is_none() {
        app.complain("there are no valid results to pin: fix the form first");
    } else {
        app.is_pinning = true;
        pin_baseline(app);
    }
}

/// Pins the requested results as soon as they are complete.
pub(super) fn pin_baseline(app: &mut App) {
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
pub(super) fn rename_baseline(app: &mut App) {
    let (tab, name) = (app.tab.id, app.tab.short_name());
    let saved = &app.tab.saved;
    let is_it = |baseline: &&mut Baseline| {
        baseline.tab == tab && !baseline.is_file && baseline.case == *saved
    };
    if let Some(baseline) = app.baseline.as_mut().filter(is_it) {
        (baseline.name, baseline.is_file) = (name, true);
    }
}

fn recall(app: &mut App, name: &str) -> Vec<Effect> {
    let Ok(variant) = app.tab.case.variant(name).cloned() else {
        let key = app.key_of(Command::Variant);
        app.say(format!("no edits since the last save: change a field, then type {key} NAME"));
        return Vec::new();
    };
    let case = app.tab.case.with(&variant);
    let outcome = edit::undone_by(app, &case);
    let effects = edit::replace(app, case);
    app.say(format!("the form shows variant {name}{outcome}"));
    effects
}

fn inputs(case: &Case, variant: &Variant) -> Result<Inputs, String> {
    case.with(variant).inputs().map_err(|problems| {
        let first = problems.into_iter().next();
        first.map_or_else(String::new, |problem| problem.to_string())
    })
}
