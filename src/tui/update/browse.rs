//! The file browser: its opening and its keys.

use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::browser::Browser;
use crate::tui::jobs::Job;

/// Opens the browser in the folder of the present case or on the recent cases.
pub(super) fn open(app: &mut App, prefers_recents: bool) -> Vec<Effect> {
    let browser = Browser::beside(app.tab.path.as_deref(), prefers_recents);
    let effects = vec![browser.list(), Effect::Job(Job::Recents)];
    app.prompts.push(Prompt::Browse(Box::new(browser)));
    effects
}

/// Goes to the recent cases, in an open browser or in a new one.
pub(super) fn recent(app: &mut App) -> Vec<Effect> {
    match browser(app) {
        Some(browser) => {
            browser.select_recents();
            Vec::new()
        }
        None => open(app, true),
    }
}

/// Goes to the parent folder.
pub(super) fn up(app: &mut App) -> Vec<Effect> {
    let Some(browser) = browser(app) else {
        return Vec::new();
    };
    let above = browser.above();
    browser.enter(above);
    vec![browser.list()]
}

/// Whether the line of a browser is empty, so that there is nothing to delete.
pub(super) fn is_in_empty_line(app: &mut App) -> bool {
    browser(app).is_some_and(|browser| browser.input.value().is_empty())
}

/// Enters the selected folder, or writes the selected name into the line.
pub(super) fn complete(app: &mut App) -> Vec<Effect> {
    browser(app).map_or_else(Vec::new, Browser::complete)
}

fn browser(app: &mut App) -> Option<&mut Browser> {
    app.prompts.last_mut().and_then(Prompt::browser)
}
