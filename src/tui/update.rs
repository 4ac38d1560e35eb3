//! The only place where the state changes. Files, clocks and threads are left to its effects and to the
//! work that it starts.

pub(super) mod commands;
mod edit;
mod export;
pub(super) mod files;
mod navigation;
mod panes;
mod studies;

use std::mem;
use std::path::PathBuf;

use ratatui::layout::Size;

use super::app::App;
use super::app::actions::{Action, Effect};
use super::panes::form;
use super::theme::Look;
use crate::case::Document;

/// Applies an action to the state. Returns the effects to carry out.
pub fn update(app: &mut App, action: Action) -> Vec<Effect> {
    if matches!(
        action,
        Action::Do(..) | Action::Insert(_) | Action::Stray(_) | Action::Paste(_) | Action::Click(_)
    ) {
        app.last_message = app.message.take();
    }
    let cursor = app.cursor;
    happen(app, action);
    if !app.has_line() {
        app.tab.read_line_anew();
    }
    app.catch_up();
    settle(app);
    panes::refresh_page(app);
    panes::follow_cursor(app, cursor);
    app.preview();
    studies::request(app);
    panes::request_chart(app);
    studies::request_variants(app);
    studies::stop_unseen(app);
    mem::take(&mut app.effects.0)
}

/// Scrolls form and results to their focused rows.
pub(crate) fn settle(app: &mut App) {
    if mem::take(&mut app.needs_scroll) {
        app.tab.form.top = form::top_for(&app.form());
        app.tab.results.top = app.results().top_for();
    }
}

/// The workbench after it opens a document.
pub fn opened(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
    let mut app = App::new(document, path, look, size);
    settle(&mut app);
    app
}

fn happen(app: &mut App, action: Action) {
    match action {
        Action::Do(command, way) => command.run(app, way),
        Action::Insert(letter) => navigation::letter(app, letter),
        Action::Paste(text) => edit::paste(app, &text),
        Action::Stray(letter) => panes::stray(app, letter),
        Action::Click(at) => navigation::click(app, at),
        Action::Wheel(at, by) => navigation::wheel(app, at, by),
        Action::Tick => panes::tick(app),
        Action::Resize(size) => {
            app.layout.resize(size);
            app.follow();
            // Terminals cut their content when they shrink, even if they have the old size again.
            app.want(Effect::Redraw);
        }
        Action::Solved(answer) => {
            app.take(*answer);
            studies::pin_baseline(app);
        }
        Action::SolverFailed(serial) => solver_failed(app, serial),
        Action::Solving(serial, part) => {
            if let Some(tab) = app.tab_of(serial).filter(|tab| !tab.is_settled) {
                tab.solving = Some(part);
            }
        }
        Action::Worked(slot, number, change) => {
            if app.runs(slot, number) {
                change.apply(app);
            }
        }
        Action::WorkEnded(slot, number) => app.end_work(slot, number),
        Action::Loaded(path, result) => files::loaded(app, path, result),
        Action::FileChanged(path, result) => files::file_changed(app, &path, result),
        Action::Saved(path, next, result) => files::saved(app, path, next, result),
        Action::Claimed(claim) => files::claimed(app, *claim),
        Action::Journals(journals) => files::list_journals(app, journals),
        Action::Failed(reason) => app.complain(reason),
    }
}

fn solver_failed(app: &mut App, serial: u64) {
    let Some(tab) = app.tab_of(serial) else {
        return;
    };
    (tab.has_failed, tab.is_settled, tab.solving) = (true, true, None);
    if app.tab.serial == serial {
        app.is_pinning = false;
        app.complain("internal error: the solver failed on this; undo or change the last edit");
    }
}

/// The key of the command with a name, in the present place.
fn key_of(app: &App, name: &str) -> String {
    commands::key_in(app.place(), name)
}
