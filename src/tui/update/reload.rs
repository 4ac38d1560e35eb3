//! Reading the file of an open case again, for example after another program changed it.

use std::path::Path;

use super::edit;
use crate::case::Document;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::ascii;
use crate::tui::commands::Command;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::question::Question;
use crate::tui::session::recovery::Access;
use crate::tui::session::save::Next;
use crate::tui::tab::Tab;

/// Reads the file again, or asks if edits would be discarded.
pub(super) fn ask(app: &mut App) -> Vec<Effect> {
    let Some(path) = app.tab.path.clone() else {
        app.say("this case has no file to read again");
        return Vec::new();
    };
    let next = Next::Load(path.clone());
    if app.tab.is_unsaved() {
        let question = Question::unsaved(&app.tab.name(), &next);
        app.prompts.push(Prompt::Ask(question));
        return Vec::new();
    }
    vec![Effect::Load(path)]
}

/// Handles a possible change of the file of an open case: a case without edits is replaced.
pub(super) fn changed(
    app: &mut App,
    path: &Path,
    found: Result<Box<Document>, Vec<String>>,
) -> Vec<Effect> {
    let mut tabs = std::iter::once(&mut app.tab).chain(&mut app.others);
    let Some(tab) = tabs.find(|tab| tab.path.as_deref() == Some(path)) else {
        return Vec::new();
    };
    let (id, name) = (tab.id, ascii::printable(&tab.short_name()).into_owned());
    tab.is_outdated = true;
    let document = match found {
        Ok(document) if document.stamp() == tab.document.stamp() => {
            // A link may lead to a copy now.
            (tab.document, tab.is_outdated) = (*document, false);
            return Vec::new();
        }
        Ok(document) => document,
        Err(faults) => {
            let fault = faults.into_iter().next().unwrap_or_default();
            let fault = ascii::printable(&fault).into_owned();
            app.complain(format!("{name} changed on disk and cannot be read: {fault}"));
            return Vec::new();
        }
    };
    if tab.is_unsaved() {
        let reload = app.key_of(Command::Reload);
        app.complain(format!(
            "{name} changed on disk: {reload} reads it and asks about your edits"
        ));
        return Vec::new();
    }
    app.say(format!("read {name} again: it changed on disk"));
    if app.tab.id == id {
        let case = document.case.clone();
        take_over(&mut app.tab, *document);
        return edit::replace(app, case);
    }
    app.last_serial += 1;
    let serial = app.last_serial;
    if let Some(tab) = app.others.iter_mut().find(|tab| tab.id == id) {
        replace_unseen(tab, *document, serial);
    }
    Vec::new()
}

/// Replaces document and saved case by the content of the file.
fn take_over(tab: &mut Tab, document: Document) {
    if !matches!(tab.access, Access::Held(_)) {
        tab.access = Access::of(&document);
    }
    tab.saved = document.case.clone();
    tab.document = document;
    tab.is_outdated = false;
}

/// Replaces the case of a hidden tab; the worker solves it once the tab is shown.
fn replace_unseen(tab: &mut Tab, document: Document, serial: u64) {
    tab.history.end_visit();
    let focus = tab.form.focus;
    tab.before_edit(focus);
    tab.case = document.case.clone();
    tab.inputs_so_far = tab.case.read().0;
    take_over(tab, document);
    tab.problems.clear();
    (tab.serial, tab.is_settled, tab.solving) = (serial, false, None);
    tab.focus_on(focus);
}
