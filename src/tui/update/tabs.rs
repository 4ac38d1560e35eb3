//! The tabs of the open cases: switching, opening and closing.

use std::path::PathBuf;

use crate::case::{Case, Document, Example};
use crate::model::Stages;
use crate::tui::app::App;
use crate::tui::commands::Command;
use crate::tui::layout::Pane;
use crate::tui::solver::Request;
use crate::tui::store;
use crate::tui::tab::{Origin, Tab};

/// Switches to the tab with an index, if it exists.
pub(super) fn go_to(app: &mut App, at: usize) {
    let now = app.place_of_tab;
    if at == now || at > app.others.len() {
        return;
    }
    app.tab.history.end_visit();
    let taken = if at > now { at - 1 } else { at };
    let next = app.others.remove(taken);
    let before = std::mem::replace(&mut app.tab, next);
    app.others.insert(if at > now { now } else { now - 1 }, before);
    app.place_of_tab = at;
    // The worker may have dropped a request of this tab for a later one.
    if !app.tab.is_settled {
        app.tab.requested = Stages::NONE;
    }
    app.follow();
}

/// Switches to the next or previous tab, wrapping around.
pub(super) fn step(app: &mut App, by: isize) {
    let count = app.others.len() + 1;
    if count == 1 {
        app.say("only one case is open");
    }
    go_to(app, (app.place_of_tab + count).saturating_add_signed(by) % count);
}

/// Shows a document: in the tab of its path, instead of the unchanged built-in case, or in a new
/// tab.
pub(super) fn show(app: &mut App, document: Document, path: PathBuf) -> Option<Request> {
    let own = app.tabs().position(|tab| tab.path.as_ref() == Some(&path));
    if let Some(own) = own {
        go_to(app, own);
    }
    let replaces = own.is_some() || app.tab.is_untouched();
    let before = own.map(|_| app.tab.id);
    let request = put(app, Tab::new(document, Some(path)), replaces);
    // A file that is read again keeps its tab.
    app.tab.id = before.unwrap_or(app.tab.id);
    request
}

/// Shows the built-in case, in a new tab if another case is in use.
pub(super) fn built_in(app: &mut App) -> Option<Request> {
    let at = app.tabs().position(Tab::is_built_in);
    if let Some(at) = at {
        go_to(app, at);
        return None;
    }
    let replaces = app.tab.is_untouched();
    put(app, Tab::new(store::built_in(), None), replaces)
}

/// Starts an empty case in a new tab.
pub(super) fn fresh(app: &mut App) -> Option<Request> {
    let replaces = app.tab.is_untouched();
    let request = put(
        app,
        Tab { origin: Origin::New, ..Tab::new(Document::new(Case::fresh()), None) },
        replaces,
    );
    let missing = app.tab.problems.len();
    app.say(format!(
        "new case: {missing} required fields are empty, the others show their defaults; \
         {} starts from an example",
        app.key_of(Command::Example)
    ));
    request
}

/// Starts a case from an example in a new tab.
pub(super) fn begin(app: &mut App, example: &'static Example) -> Option<Request> {
    let replaces = app.tab.is_untouched();
    let request = put(
        app,
        Tab { origin: Origin::Example(example.name), ..Tab::new(example.document(), None) },
        replaces,
    );
    app.say(format!("new case from {}; it has no file yet", example.name));
    request
}

/// Closes the current case; after the last one the built-in case is shown.
pub(super) fn close(app: &mut App) -> Option<Request> {
    let name = app.tab.name();
    if app.others.is_empty() {
        let request = put(app, Tab::new(store::built_in(), None), true);
        app.say(format!("closed {name}: this is the built-in Table 1"));
        return request;
    }
    let closed = app.place_of_tab;
    go_to(app, if closed == 0 { 1 } else { closed - 1 });
    app.others.remove(if closed == 0 { 0 } else { closed - 1 });
    app.place_of_tab = closed.saturating_sub(1);
    app.say(format!("closed {name}"));
    None
}

fn put(app: &mut App, tab: Tab, replaces: bool) -> Option<Request> {
    let focus = app.tab.form.focus;
    app.last_id += 1;
    let before = std::mem::replace(&mut app.tab, Tab { id: app.last_id, ..tab });
    if !replaces {
        app.others.insert(app.place_of_tab, before);
        app.place_of_tab += 1;
    }
    app.layout.focus_on(Pane::Form);
    app.cursor = None;
    let request = app.request();
    app.focus_on(focus);
    request
}
