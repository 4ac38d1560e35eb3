//! Comparisons: the variants of the case, saved from the edits and loaded into the form, and the
//! baseline.

use super::{edit, key_of};
use crate::case::{Case, Evaluator, Variant};
use crate::model::{Inputs, Refusal};
use crate::tui::app::App;
use crate::tui::app::actions::{Running, Work};
use crate::tui::jobs::Slot;
use crate::tui::layout::Pane;
use crate::tui::solver::{Baseline, Variants};

/// Saves the edits since the last save as a variant and shows the case without them. Without edits,
/// loads the variant with this name into the form.
pub(super) fn keep(app: &mut App, name: &str) {
    if let Err(problem) = Variant::check_name(name) {
        app.complain(format!("{}: {}", problem.cause, problem.fix));
        return;
    }
    let variant = Variant::between(name, &app.tab.saved, &app.tab.case);
    if variant.overrides.is_empty() {
        return recall(app, name);
    }
    if !app.tab.problems.is_empty() {
        app.complain("a field has an error: correct it before the edits become a variant");
        return;
    }
    let count = variant.overrides.len();
    let edits = if count == 1 { "edit" } else { "edits" };
    let mut case = app.tab.saved.clone();
    case.variants.clone_from(&app.tab.case.variants);
    case.keep_variant(variant);
    edit::replace(app, case);
    app.say(format!(
        "variant {name} now has {count} {edits}; the form shows the case without them; Ctrl-Z undoes"
    ));
}

/// Shows the variants beside the case, the next variants, or the methods again.
pub(super) fn next(app: &mut App) {
    let count = app.tab.case.variants.len();
    if count == 0 {
        let key = key_of(app, "variant");
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

/// Solves the visible variants, unless they are solved already.
pub(super) fn request(app: &mut App) {
    let is_shown = app.layout.plan().shows(Pane::Results);
    app.first_variant = app.first_variant.filter(|first| *first < app.tab.case.variants.len());
    let tab = &app.tab;
    let (serial, id) = (tab.serial, tab.id);
    let is_known = tab.variants.as_ref().is_some_and(|found| found.serial == serial);
    // A request of another tab replaces this request.
    let runs = app.comparing == Some(serial) && app.is_busy(Slot::Variants);
    let is_wanted = is_shown && app.first_variant.is_some() && tab.problems.is_empty();
    if !is_wanted || is_known || runs {
        return;
    }
    let column = |variant: &Variant| (variant.name.clone(), inputs(&tab.case, variant));
    let columns: Vec<_> = tab.case.variants.iter().map(column).collect();
    app.comparing = Some(serial);
    let stages = Pane::Results.needs();
    let solve = move |running: &Running<'_>| {
        let solved = |inputs: &Inputs| {
            let go_on = |_| running.is_wanted();
            match Evaluator::default().solve(inputs, inputs.method, stages, &go_on) {
                Err(Refusal::Stopped) => None,
                found => Some(found.map_err(|refusal| format!("{refusal}: {}", refusal.fix()))),
            }
        };
        let columns = columns.into_iter().map(|(name, inputs)| {
            let found = match inputs {
                Ok(inputs) => solved(&inputs)?,
                Err(problem) => Err(problem),
            };
            Some((name, found))
        });
        Some(Variants { serial, columns: columns.collect::<Option<_>>()? })
    };
    app.start(Work::new(Slot::Variants, solve, move |app, found| {
        if let Some(tab) = app.tab_with(id) {
            tab.variants = Some(found);
        }
    }));
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

fn recall(app: &mut App, name: &str) {
    let Ok(variant) = app.tab.case.variant(name).cloned() else {
        let key = key_of(app, "variant");
        app.say(format!("no edits since the last save: change a field, then type {key} NAME"));
        return;
    };
    let case = app.tab.case.with(&variant);
    let outcome = edit::undone_by(app, &case);
    edit::replace(app, case);
    app.say(format!("the form shows variant {name}{outcome}"));
}

fn inputs(case: &Case, variant: &Variant) -> Result<Inputs, String> {
    case.with(variant).inputs().map_err(|problems| {
        let first = problems.into_iter().next();
        first.map_or_else(String::new, |problem| problem.to_string())
    })
}
