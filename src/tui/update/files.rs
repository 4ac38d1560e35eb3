//! Opening, saving and leaving, with a question before anything is lost.

use std::path::PathBuf;

use tui_input::Input;

use super::{Effect, Over, Saving, recovery, solve};
use crate::case::Document;
use crate::tui::actions::Next;
use crate::tui::app::{App, History};
use crate::tui::clean;
use crate::tui::prompt::{Browser, Choice, Page, Prompt, Question};
use crate::tui::recovery::Access;
use crate::tui::store::{self, Entry, SaveFault};

/// Go on when nothing is unsaved, else ask.
pub(super) fn when_saved(app: &mut App, next: Next) -> Vec<Effect> {
    if app.is_unsaved() {
        app.prompts.push(Prompt::Ask(Question::unsaved(&app.name(), &next)));
        return Vec::new();
    }
    go(app, next)
}

/// Save to the file of the case, or ask where to.
pub(super) fn save(app: &mut App, next: Next) -> Vec<Effect> {
    if refuse_faulty(app) {
        return Vec::new();
    }
    match app.path.clone() {
        Some(path) => vec![saving(app, path, Over::Own, next)],
        None => ask_where(app, next),
    }
}

/// Ask for a path to save to.
pub(super) fn ask_where(app: &mut App, next: Next) -> Vec<Effect> {
    if refuse_faulty(app) {
        return Vec::new();
    }
    let path = app.path.as_ref().map_or_else(|| "case.toml".to_owned(), |path| path.display().to_string());
    app.prompts.push(Prompt::SaveAs(Input::new(path), next));
    Vec::new()
}

/// Close what lies over the form; else ask whether to quit.
pub(super) fn cancel(app: &mut App) -> Vec<Effect> {
    if app.prompts.pop().is_some() {
        return Vec::new();
    }
    if app.is_unsaved() {
        return when_saved(app, Next::Quit);
    }
    app.prompts.push(Prompt::Ask(Question::quit()));
    Vec::new()
}

/// Enter in a prompt.
pub(super) fn accept(app: &mut App) -> Vec<Effect> {
    match app.prompts.last().cloned() {
        Some(Prompt::Browse(browser)) => accept_path(app, &browser),
        Some(Prompt::SaveAs(input, next)) => accept_name(app, input.value(), next),
        Some(Prompt::Ask(question)) => match question.buttons.get(question.marked) {
            Some((_, choice)) => choose(app, choice.clone()),
            None => Vec::new(),
        },
        Some(Prompt::Read(_)) | None => Vec::new(),
    }
}

/// An answer to a question.
pub(super) fn choose(app: &mut App, choice: Choice) -> Vec<Effect> {
    app.prompts.pop();
    match choice {
        Choice::Cancel => Vec::new(),
        Choice::Save(next) => save(app, next),
        Choice::Proceed(next) => go(app, next),
        Choice::Overwrite(path, next) => vec![saving(app, path, Over::Anything, next)],
        Choice::Recover(offer) => recovery::recover(app, &offer),
        Choice::Forget(journal) => vec![Effect::Forget(journal)],
        Choice::SaveAs(next) => {
            if !matches!(app.prompts.last(), Some(Prompt::SaveAs(..))) {
                return ask_where(app, next);
            }
            Vec::new()
        }
    }
}

/// Write the marked name into the line.
pub(super) fn complete(app: &mut App) -> Vec<Effect> {
    let Some(Prompt::Browse(browser)) = app.prompts.last_mut() else { return Vec::new() };
    let Some((path, is_folder)) = browser.marked_path() else { return Vec::new() };
    browser.input = Input::new(if is_folder { path + "/" } else { path });
    typed(app)
}

/// The line of a prompt has changed.
pub(super) fn typed(app: &mut App) -> Vec<Effect> {
    let Some(Prompt::Browse(browser)) = app.prompts.last_mut() else { return Vec::new() };
    browser.marked = 0;
    let folder = browser.split().0.to_owned();
    if folder == browser.folder {
        return Vec::new();
    }
    browser.folder.clone_from(&folder);
    browser.entries.clear();
    vec![Effect::List(folder)]
}

/// The entries of a folder have come.
pub(super) fn listed(app: &mut App, folder: &str, entries: Vec<Entry>) -> Vec<Effect> {
    if let Some(Prompt::Browse(browser)) = app.prompts.last_mut()
        && browser.folder == folder
    {
        browser.entries = entries;
        browser.mark(0);
    }
    Vec::new()
}

/// A file was read, or its faults were found: then nothing changes but what is told.
pub(super) fn loaded(app: &mut App, path: PathBuf, result: Result<Box<Document>, Vec<String>>) -> Vec<Effect> {
    match result {
        Ok(document) => {
            app.prompts.clear();
            let mut effects = vec![Effect::Remember(path.clone())];
            effects.extend(show(app, *document, Some(path)));
            app.say(format!("opened {}", clean::clean(&app.name())));
            effects
        }
        Err(faults) => {
            let title = format!("{} cannot be opened", path.display());
            app.prompts.push(Prompt::Read(Page::new(title, faults)));
            Vec::new()
        }
    }
}

/// A file was written, or not.
pub(super) fn saved(app: &mut App, path: PathBuf, next: Next, result: Result<Box<Document>, SaveFault>) -> Vec<Effect> {
    match result {
        Ok(document) => {
            if matches!(app.prompts.last(), Some(Prompt::SaveAs(..))) {
                app.prompts.pop();
            }
            app.saved = document.case.clone();
            app.document = *document;
            app.say(format!("saved {}", path.display()));
            app.path = Some(path.clone());
            let mut effects = vec![Effect::Remember(path)];
            effects.extend(go(app, next));
            return effects;
        }
        Err(SaveFault::Exists) => app.prompts.push(Prompt::Ask(Question::exists(&path, &next))),
        Err(SaveFault::Changed(lines)) => app.prompts.push(Prompt::Ask(Question::changed(&path, lines, &next))),
        Err(SaveFault::Held(holder)) => app.prompts.push(Prompt::Ask(Question::held(&path, &holder, &next))),
        Err(SaveFault::Failed(reason)) => app.complain(format!("not saved: {reason}")),
    }
    Vec::new()
}

fn go(app: &mut App, next: Next) -> Vec<Effect> {
    match next {
        Next::Stay => Vec::new(),
        Next::Quit => vec![Effect::Quit],
        Next::Load(path) => vec![Effect::Load(path)],
        Next::Fresh => {
            let effects = show(app, store::built_in(), None);
            app.say("a new case, beginning with Table 1");
            effects
        }
        Next::Browse => {
            let browser = Browser::beside(app.path.as_deref());
            let folder = browser.folder.clone();
            app.prompts.push(Prompt::Browse(browser));
            vec![Effect::List(folder)]
        }
    }
}

fn show(app: &mut App, document: Document, path: Option<PathBuf>) -> Vec<Effect> {
    app.saved = document.case.clone();
    app.document = document;
    app.path = path;
    app.access = Access::default();
    app.history = History::default();
    app.results_top = 0;
    solve(app.replace_case(app.saved.clone(), app.focus))
}

// What would be saved could not be opened again.
fn refuse_faulty(app: &mut App) -> bool {
    let Some(&(field, _)) = app.problems.first() else { return false };
    app.focus_on(field);
    app.complain("not saved: mend what is marked with ! first");
    true
}

fn saving(app: &App, path: PathBuf, over: Over, next: Next) -> Effect {
    let mut document = app.document.clone();
    document.case = app.case.clone();
    Effect::Save(Box::new(Saving { document, path, over, next }))
}

fn accept_path(app: &mut App, browser: &Browser) -> Vec<Effect> {
    match browser.marked_path() {
        Some((_, true)) => complete(app),
        Some((path, false)) => vec![Effect::Load(path.into())],
        None if browser.input.value().is_empty() => Vec::new(),
        None => vec![Effect::Load(browser.input.value().into())],
    }
}

fn accept_name(app: &mut App, name: &str, next: Next) -> Vec<Effect> {
    if name.trim().is_empty() {
        app.complain("a file needs a name");
        return Vec::new();
    }
    let path = PathBuf::from(name);
    let over = if app.path.as_ref() == Some(&path) { Over::Own } else { Over::Nothing };
    vec![saving(app, path, over, next)]
}
