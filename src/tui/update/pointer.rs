//! The mouse, if the setting is on: a click moves the focus or the cursor, the wheel scrolls.

use ratatui::layout::Position;

use super::{dialogs, edit, files, page, panes, study};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::header;
use crate::tui::layout::Pane;
use crate::tui::panes::chart::{ChartCommand, panels};
use crate::tui::panes::study::{self as study_pane, StudyCommand};
use crate::tui::panes::teeth::TeethCommand;
use crate::tui::panes::{form, results};

/// Handles a click on a field, a result, the chart, the name of a case or of a hidden pane, a line
/// of a list, or a button. A second click on the selection is Enter.
pub(super) fn click(app: &mut App, at: Position) -> Vec<Effect> {
    match dialogs::with(app, |dialog, around| dialog.click(at, around.screen)) {
        None => in_panes(app, at),
        Some(true) => dialogs::accept(app),
        Some(false) => Vec::new(),
    }
}

// Returns whether the line was already selected.
fn mark(marked: &mut usize, line: usize) -> bool {
    std::mem::replace(marked, line) == line
}

fn in_panes(app: &mut App, at: Position) -> Vec<Effect> {
    let plan = app.layout.plan();
    if let Some(tab) = header::tab_at(app, plan.header, at) {
        files::go_to_tab(app, tab);
    } else if let Some(pane) = hidden_at(app, at) {
        panes::show(app, pane);
    } else if let Some(pane) = pane_at(app, at) {
        return in_pane(app, pane, at);
    }
    Vec::new()
}

fn in_pane(app: &mut App, pane: Pane, at: Position) -> Vec<Effect> {
    let had_focus = app.layout.focus() == pane;
    match pane {
        Pane::Form => return in_form(app, form::field_at(&app.form(), at)),
        Pane::Results => {
            panes::show(app, pane);
            let row = results::row_at(&app.results(), at);
            if row.is_some_and(|row| mark(&mut app.tab.results.row, row) && had_focus) {
                return page::explain(app);
            }
        }
        Pane::Chart => {
            panes::show(app, pane);
            if let Some(angle) = panels::angle_at(&app.charts(), at) {
                app.cursor = Some(angle);
                return panes::stop_playing(app);
            }
        }
        Pane::Teeth | Pane::Trade | Pane::Study => panes::show(app, pane),
    }
    Vec::new()
}

// The first click focuses a field, the second one edits it.
fn in_form(app: &mut App, field: Option<usize>) -> Vec<Effect> {
    let is_marked = app.layout.focus() == Pane::Form && field == Some(app.tab.form.focus);
    match field {
        Some(_) if is_marked && app.has_line() => app.tab.form.input.select_all(),
        Some(_) if is_marked => edit::begin(app),
        _ => {
            panes::show(app, Pane::Form);
            app.focus_on(field.unwrap_or(app.tab.form.focus));
        }
    }
    Vec::new()
}

/// Handles a step of the wheel by lines downwards.
pub(super) fn wheel(app: &mut App, at: Position, by: isize) {
    if dialogs::with(app, |dialog, around| dialog.wheel(by, around)).is_some() {
        return;
    }
    let nearer = if by < 0 { 1 } else { -1 };
    match pane_at(app, at) {
        Some(Pane::Form) => app.tab.form.top = form::scrolled(&app.form(), by),
        Some(Pane::Results) => app.tab.results.top = results::scrolled(&app.results(), by),
        Some(Pane::Chart) => panes::run_chart(app, ChartCommand::Zoom(nearer)),
        Some(Pane::Teeth) => panes::run_teeth(app, TeethCommand::Zoom(nearer)),
        Some(Pane::Study) if app.study.is_tolerance => {
            app.study.top = study_pane::scrolled(&app.study(), by);
        }
        Some(Pane::Study) => drop(study::run(app, StudyCommand::Zoom(nearer))),
        Some(Pane::Trade) | None => (),
    }
}

fn hidden_at(app: &App, at: Position) -> Option<Pane> {
    let plan = app.layout.plan();
    let owner = plan.names_hidden()?;
    app.title(owner).hidden_at(plan.area(owner), at)
}

fn pane_at(app: &App, at: Position) -> Option<Pane> {
    let plan = app.layout.plan();
    Pane::ALL.into_iter().find(|&pane| plan.area(pane).contains(at))
}
