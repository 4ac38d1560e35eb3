//! The tip relief to specify: its search, and its values in the case.

use super::edit;
use crate::case::fields::index_of;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::{Prompt, ReliefDialog};

/// Opens the dialog and starts the search with the default demand.
pub(super) fn ask(app: &mut App) -> Vec<Effect> {
    let Some(inputs) = app.tab.inputs().cloned() else {
        app.complain("no search: fix the fields marked with ! first");
        return Vec::new();
    };
    let title = index_of("title").and_then(|field| app.tab.case.text(field));
    let title = title.unwrap_or_default().to_owned();
    let mut dialog = ReliefDialog::new(app.tab.name(), title, inputs);
    let effects = dialog.search();
    app.prompts.push(Prompt::Relief(Box::new(dialog)));
    effects
}

/// Writes the relief into the form as one edit.
pub(super) fn take(app: &mut App, values: &[(&'static str, String)]) -> Vec<Effect> {
    app.prompts.pop();
    let mut case = app.tab.case.clone();
    for (key, text) in values {
        if let Err(problem) = case.set(key, text) {
            app.complain(problem.to_string());
            return Vec::new();
        }
    }
    let effects = edit::replace(app, case);
    let amounts = values.iter().filter(|(key, _)| key.ends_with(".tip_relief"));
    let words: Vec<String> =
        amounts.map(|(key, text)| format!("{} {text}", key.replace(['.', '_'], " "))).collect();
    app.say(format!("{}; Ctrl-Z undoes", words.join(", ")));
    effects
}
