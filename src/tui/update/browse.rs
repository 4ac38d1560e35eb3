//! Looking for a case to open: into folders and up again, among the recent ones, with a look into
//! what is marked.

use super::{files, tabs};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::browser::Browser;
use crate::tui::jobs::Job;
use crate::tui::prompt::Prompt;
use crate::tui::store::case_search::Below;
use crate::tui::store::folder::Listing;
use crate::tui::store::preview::{Preview, Viewport};
use crate::tui::store::recents::Recent;

/// Ask for a file to open, from the folder of the present case or from the recent ones.
pub(super) fn open(app: &mut App, prefers_recents: bool) -> Vec<Effect> {
    let browser = Browser::beside(app.tab.path.as_deref(), prefers_recents);
    let effects = vec![list(&browser), Effect::Job(Job::Recents)];
    app.prompts.push(Prompt::Browse(Box::new(browser)));
    effects
}

/// Go to the recent cases, in a browser that is open or in a new one.
pub(super) fn recent(app: &mut App) -> Vec<Effect> {
    match browser(app) {
        Some(browser) => {
            browser.to_recents();
            Vec::new()
        }
        None => open(app, true),
    }
}

/// Go to the folder above.
pub(super) fn up(app: &mut App) -> Vec<Effect> {
    let Some(browser) = browser(app) else {
        return Vec::new();
    };
    let above = browser.above();
    browser.enter(above);
    vec![list(browser)]
}

/// Whether nothing is typed in a browser, so that there is nothing to delete.
pub(super) fn is_in_empty_line(app: &App) -> bool {
    matches!(app.prompts.last(), Some(Prompt::Browse(browser)) if browser.input.value().is_empty())
}

/// Go into the marked folder, or write the marked name into the line.
pub(super) fn complete(app: &mut App) -> Vec<Effect> {
    let Some(browser) = browser(app) else {
        return Vec::new();
    };
    match browser.marked_sight() {
        Some(Viewport::Folder(folder)) => {
            browser.enter(folder);
            vec![list(browser)]
        }
        Some(Viewport::File(path)) => {
            browser.input = path.display().to_string().into();
            typed(browser)
        }
        Some(Viewport::Example(example)) => {
            browser.input = example.name.into();
            typed(browser)
        }
        None => Vec::new(),
    }
}

/// Enter: into a folder, or open a file; where nothing fits, what is typed.
pub(super) fn accept(app: &mut App) -> Vec<Effect> {
    let Some(browser) = browser(app) else {
        return Vec::new();
    };
    match browser.marked_sight() {
        Some(Viewport::Folder(_)) => complete(app),
        Some(Viewport::File(path)) => files::open(app, path),
        Some(Viewport::Example(example)) => {
            app.prompts.pop();
            super::solve(tabs::begin(app, example))
        }
        None if browser.input.value().is_empty() => Vec::new(),
        None => {
            let path = browser.typed_path();
            files::open(app, path)
        }
    }
}

/// The line of a browser has changed.
pub(super) fn typed(browser: &mut Browser) -> Vec<Effect> {
    let list = if browser.follow() {
        Some(list(browser))
    } else {
        None
    };
    let below = browser
        .seek()
        .map(|(base, typed)| Effect::Job(Job::Below(base, typed)));
    list.into_iter().chain(below).collect()
}

/// Which cases stand in the folders below has been found out.
pub(super) fn found(app: &mut App, below: Below) {
    if let Some(browser) = browser(app) {
        browser.take_below(below);
    }
}

/// What stands in a folder has been found out.
pub(super) fn listed(app: &mut App, listing: Listing) {
    if let Some(browser) = browser(app) {
        browser.take(listing);
    }
}

/// Which cases were open last has been found out.
pub(super) fn recalled(app: &mut App, recents: Vec<Recent>) {
    if let Some(browser) = browser(app) {
        browser.remember(recents);
    }
}

/// What something holds has been found out.
pub(super) fn previewed(app: &mut App, sight: Viewport, preview: Preview) {
    if let Some(browser) = browser(app) {
        browser.show(sight, preview);
    }
}

/// Ask what the marked line holds, as soon as another one is marked.
pub(super) fn look(app: &mut App) -> Option<Effect> {
    let units = app.settings.units;
    let sight = browser(app)?.look()?;
    Some(Effect::Job(Job::Preview(sight, units)))
}

fn list(browser: &Browser) -> Effect {
    let (base, typed) = browser.asks();
    Effect::Job(Job::Folder(base, typed))
}

fn browser(app: &mut App) -> Option<&mut Browser> {
    match app.prompts.last_mut() {
        Some(Prompt::Browse(browser)) => Some(browser),
        _ => None,
    }
}
