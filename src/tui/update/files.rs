//! Opening, saving and quitting, with a question before edits are discarded.

use std::path::{Path, PathBuf};

use super::{baseline, export, recovery, solve, tabs};
use crate::case::file::Saved;
use crate::case::{Document, rexs};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::page::Page;
use crate::tui::dialogs::path::SaveAs;
use crate::tui::dialogs::question::{Choice, Question};
use crate::tui::line::{CASE_ENDING, Line};
use crate::tui::session::recovery::{Access, NEWER};
use crate::tui::session::save::{Next, Over, SaveFault, Saving, Written};
use crate::tui::tab::{Origin, Tab};
use crate::tui::{ascii, rows};

/// Quits, or asks if there are unsaved edits.
pub(super) fn quit(app: &mut App) -> Vec<Effect> {
    let unsaved: Vec<_> =
        app.tabs().enumerate().filter(|(_, tab)| tab.is_unsaved()).map(|(at, _)| at).collect();
    match unsaved[..] {
        [] => leave(app),
        [only] => {
            tabs::go_to(app, only);
            app.prompts.push(Prompt::Ask(Question::unsaved(&app.tab.name(), &Next::Quit)));
            Vec::new()
        }
        _ => {
            let names: Vec<_> = app.tabs().filter(|tab| tab.is_unsaved()).map(Tab::name).collect();
            app.prompts.push(Prompt::Ask(Question::all_unsaved(&names)));
            Vec::new()
        }
    }
}

/// Ends the workbench, or asks if an export is running.
fn leave(app: &mut App) -> Vec<Effect> {
    let Some(running) = &app.exporting else {
        return vec![Effect::Quit];
    };
    let question = Question::export_runs(&running.path);
    app.prompts.push(Prompt::Ask(question));
    Vec::new()
}

/// Closes the current case, or asks if it has unsaved edits.
pub(super) fn close(app: &mut App) -> Vec<Effect> {
    if app.tab.is_unsaved() {
        app.prompts.push(Prompt::Ask(Question::unsaved(&app.tab.name(), &Next::Close)));
        return Vec::new();
    }
    go(app, Next::Close)
}

/// Saves to the file of the case, or asks for a path.
pub(super) fn save(app: &mut App, next: Next) -> Vec<Effect> {
    if refuse_faulty(app) {
        return Vec::new();
    }
    match app.tab.path.clone() {
        Some(path) => vec![saving(app, path, Over::Own, next)],
        None => ask_where(app, next),
    }
}

/// Asks for a path to save to.
pub(super) fn ask_where(app: &mut App, next: Next) -> Vec<Effect> {
    if refuse_faulty(app) {
        return Vec::new();
    }
    let path = app
        .tab
        .path
        .as_ref()
        .map_or_else(|| "case.toml".to_owned(), |path| path.display().to_string());
    let input = Line::named(path);
    app.prompts.push(Prompt::SaveAs(SaveAs { input, next }));
    Vec::new()
}

/// Carries out the answer to a question.
pub(super) fn choose(app: &mut App, choice: Choice) -> Vec<Effect> {
    app.prompts.pop();
    match choice {
        Choice::Cancel => Vec::new(),
        Choice::Save(next) => save(app, next),
        Choice::Proceed(next) => go(app, next),
        Choice::Overwrite(path, seen, next) => vec![saving(app, path, Over::Seen(seen), next)],
        Choice::Leave => vec![Effect::Quit],
        Choice::ExportOver(path) => export::begin(app, path, true),
        Choice::Recover(offer) => recovery::recover(app, &offer),
        Choice::Forget(journals) => vec![Effect::Forget(journals)],
        Choice::SaveAs(next) => {
            if !app.prompts.last().is_some_and(Prompt::is_save_as) {
                return ask_where(app, next);
            }
            Vec::new()
        }
    }
}

/// Opens a file that was read; reports its faults, if any.
pub(super) fn loaded(
    app: &mut App,
    path: PathBuf,
    result: Result<Box<Document>, Vec<String>>,
) -> Vec<Effect> {
    match result {
        Ok(document) if is_open_as_another(app, &document, &path) => Vec::new(),
        Ok(document) => {
            app.prompts.clear();
            let case_path = rexs::case_path(&path);
            let mut effects = vec![Effect::Remember(path)];
            effects.extend(solve(tabs::show(app, *document, case_path)));
            if app.tab.access == Access::Newer {
                app.complain(NEWER);
            } else {
                app.say(format!("opened {}", ascii::printable(&app.tab.name())));
            }
            effects
        }
        Err(faults) => {
            let title = format!("{} cannot be opened", path.display());
            app.prompts.push(Prompt::Read(Page::new(title, faults)));
            Vec::new()
        }
    }
}

/// Handles the result of a save.
pub(super) fn saved(
    app: &mut App,
    path: PathBuf,
    next: Next,
    result: Result<Box<Written>, SaveFault>,
) -> Vec<Effect> {
    let asked = app.tab.saving.take();
    match result {
        Ok(written) => {
            let Written { document, saved } = *written;
            if app.prompts.last().is_some_and(Prompt::is_save_as) {
                app.prompts.pop();
            }
            app.tab.saved = document.case.clone();
            // Later edits are not saved and remain.
            let is_as_asked = asked.is_none_or(|asked| asked == app.tab.case);
            if is_as_asked && app.tab.case != document.case {
                app.tab.case = document.case.clone();
                app.focus_on(app.tab.form.focus);
            }
            app.tab.read_line_anew();
            (app.tab.document, app.tab.is_outdated) = (document, false);
            (app.tab.in_place_of, app.tab.origin) = (None, Origin::Given);
            let how = match saved {
                Saved::Written => "",
                Saved::Recreated => ": the file was deleted, and this save created it again",
            };
            let missing = match app.tab.problems.len() {
                0 => String::new(),
                1 => "; 1 required value is missing".to_owned(),
                count => format!("; {count} required values are missing"),
            };
            app.say(format!("saved {}{how}{missing}", path.display()));
            app.tab.path = Some(path.clone());
            baseline::rename(app);
            let mut effects = vec![Effect::Remember(path)];
            effects.extend(go(app, next));
            return effects;
        }
        Err(SaveFault::Exists(found)) => {
            app.prompts.push(Prompt::Ask(Question::exists(&path, found, &next)))
        }
        Err(SaveFault::Changed(found)) => {
            app.prompts.push(Prompt::Ask(Question::changed(&path, found, &next)))
        }
        Err(SaveFault::Held(holder)) => {
            app.prompts.push(Prompt::Ask(Question::held(&path, &holder, &next)))
        }
        Err(SaveFault::Failed(reason)) => app.complain(format!("not saved: {reason}")),
    }
    Vec::new()
}

/// Carries out the step after a save.
fn go(app: &mut App, next: Next) -> Vec<Effect> {
    match next {
        Next::Stay => Vec::new(),
        Next::Quit => leave(app),
        Next::Load(path) => vec![Effect::Load(path)],
        Next::Close => solve(tabs::close(app)),
        Next::SaveRest => save_rest(app),
    }
}

fn save_rest(app: &mut App) -> Vec<Effect> {
    let unsaved = app.tabs().position(Tab::is_unsaved);
    let Some(unsaved) = unsaved else {
        return leave(app);
    };
    tabs::go_to(app, unsaved);
    save(app, Next::SaveRest)
}

/// Opens a file. If the case is already open, goes to its tab with its unsaved edits.
pub(super) fn open(app: &mut App, path: PathBuf) -> Vec<Effect> {
    let Some(at) = place_of(app, &path) else {
        return vec![Effect::Load(path)];
    };
    app.prompts.clear();
    tabs::go_to(app, at);
    app.say(format!("{} is open already", ascii::printable(&app.tab.name())));
    Vec::new()
}

// A path through a link names the same file, and hence the same case.
fn is_open_as_another(app: &mut App, document: &Document, path: &Path) -> bool {
    let is_it = |tab: &Tab| {
        tab.path.as_deref().is_some_and(|own| own != path)
            && document.path().is_some()
            && tab.document.path() == document.path()
    };
    let Some(at) = app.tabs().position(is_it) else {
        return false;
    };
    app.prompts.clear();
    tabs::go_to(app, at);
    app.say(format!(
        "{} is open already, as {}",
        ascii::printable(&path.display().to_string()),
        ascii::printable(&app.tab.name())
    ));
    true
}

fn place_of(app: &App, path: &Path) -> Option<usize> {
    let path = rexs::case_path(path);
    app.tabs().position(|tab| tab.path.as_deref() == Some(&path))
}

// A file with invalid values could not be opened again; a file with missing values can.
fn refuse_faulty(app: &mut App) -> bool {
    let wrong = app.tab.problems.iter().find(|(row, _)| !rows::lacks(&app.tab.case, *row));
    let Some(&(field, _)) = wrong else {
        return false;
    };
    app.focus_on(field);
    app.complain("not saved: fix the fields marked with ! first");
    true
}

fn saving(app: &mut App, path: PathBuf, over: Over, next: Next) -> Effect {
    let document = app.tab.as_edited();
    app.tab.saving = Some(app.tab.case.clone());
    Effect::Save(Box::new(Saving { document, path, over }), next)
}

// The list of cases in a folder shows only names with the extension.
fn named(name: &str) -> PathBuf {
    let last = name.rsplit('/').next().unwrap_or_default();
    let is_place = matches!(last, "" | "." | ".." | "~");
    let has_ending = last.rfind('.').is_some_and(|dot| dot > 0);
    PathBuf::from(if is_place || has_ending {
        name.to_owned()
    } else {
        format!("{name}{CASE_ENDING}")
    })
}

/// Saves under the typed name.
pub(super) fn save_under(app: &mut App, name: &str, next: Next) -> Vec<Effect> {
    if name.trim().is_empty() {
        app.complain("type a name for the file");
        return Vec::new();
    }
    let is_own = app.tab.path.as_deref() == Some(Path::new(name));
    let (path, over) =
        if is_own { (PathBuf::from(name), Over::Own) } else { (named(name.trim()), Over::Nothing) };
    vec![saving(app, path, over, next)]
}
