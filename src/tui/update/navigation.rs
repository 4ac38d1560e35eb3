//! Navigation by lines, groups and pages and with the mouse, in the focused pane or in the topmost
//! dialog, and the end of the topmost dialog or work by Esc and Ctrl-C.

use ratatui::layout::Position;

use super::{dialogs, edit, files, panes, study, trade};
use crate::case::Case;
use crate::model::Stage;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::commands::Command;
use crate::tui::layout::Pane;
use crate::tui::panes::chart::{ChartCommand, angle_at};
use crate::tui::panes::form;
use crate::tui::panes::study::{self as study_pane, StudyCommand};
use crate::tui::panes::teeth::TeethCommand;
use crate::tui::tab::Tab;
use crate::tui::{header, rows};

/// Message of Ctrl-C if there is nothing to cancel and nothing unsaved.
pub(super) const LEAVING: &str = "no running work and no unsaved edits: press Ctrl-C again to \
    quit";

/// Carries out a command that moves the focus or the selection; ignores other commands.
pub(super) fn walk(app: &mut App, command: Command) {
    match command {
        Command::Next => step(app, 1),
        Command::Previous => step(app, -1),
        Command::NextGroup => leap(app, 1),
        Command::PreviousGroup => leap(app, -1),
        Command::First if app.layout.focus() == Pane::Results => mark(app, isize::MIN),
        Command::Last if app.layout.focus() == Pane::Results => mark(app, isize::MAX),
        Command::First | Command::FirstField => field(app, 0),
        Command::Last | Command::LastField => field(app, usize::MAX),
        Command::NextFault => fault(app),
        Command::ResultsUp => turn(app, -page(app)),
        Command::ResultsDown => turn(app, page(app)),
        _ => (),
    }
}

/// Handles a click on a field, a result, the chart, the name of a case or of a hidden pane, a line
/// of a list, or a button. A second click on the selection is Enter.
pub(super) fn click(app: &mut App, at: Position) -> Vec<Effect> {
    match dialogs::with(app, |dialog, around| dialog.click(at, around.screen)) {
        None => in_panes(app, at),
        Some(true) => dialogs::accept(app),
        Some(false) => Vec::new(),
    }
}

/// Handles a step of the wheel by lines downwards.
pub(super) fn wheel(app: &mut App, at: Position, by: isize) {
    if dialogs::with(app, |dialog, around| dialog.wheel(by, around)).is_some() {
        return;
    }
    let nearer = if by < 0 { 1 } else { -1 };
    match pane_at(app, at) {
        Some(Pane::Form) => app.tab.form.top = form::scrolled(&app.form(), by),
        Some(Pane::Results) => app.tab.results.top = app.results().scrolled(by),
        Some(Pane::Chart) => panes::run_chart(app, ChartCommand::Zoom(nearer)),
        Some(Pane::Teeth) => panes::run_teeth(app, TeethCommand::Zoom(nearer)),
        Some(Pane::Study) if app.study.is_tolerance => {
            app.study.top = study_pane::scrolled(&app.study(), by);
        }
        Some(Pane::Study) => drop(study::run(app, StudyCommand::Zoom(nearer))),
        Some(Pane::Trade) | None => (),
    }
}

/// Esc: closes a dialog, leaves the field, or stops the work; no edit is lost.
pub(super) fn leave(app: &mut App) -> Vec<Effect> {
    if let Some(mut prompt) = app.prompts.pop() {
        return prompt.dialog_mut().close();
    }
    // Hints such as `Esc n` rely on one Esc to leave the field, also while work runs.
    if app.has_line() {
        app.tab.history.end_visit();
        app.is_editing = false;
        return Vec::new();
    }
    let stopped = stop(app, app.layout.focus() == Pane::Study);
    if !stopped.is_empty() {
        return stopped;
    }
    if app.is_playing {
        return panes::stop_playing(app);
    }
    if app.cursor.is_some() && app.layout.focus().is_lower() {
        app.cursor = None;
    } else if app.layout.is_zoomed() {
        panes::zoom(app);
    } else {
        panes::show(app, Pane::Form);
    }
    Vec::new()
}

/// Ctrl-C: closes or stops the topmost item. If there is none, the second press quits, because
/// other programs copy with this key.
pub(super) fn cancel(app: &mut App) -> Vec<Effect> {
    if let Some(mut prompt) = app.prompts.pop() {
        return prompt.dialog_mut().close();
    }
    let stopped = stop(app, true);
    if !stopped.is_empty() {
        return stopped;
    }
    if app.is_playing {
        return panes::stop_playing(app);
    }
    if app.tabs().any(Tab::is_unsaved) {
        return files::quit(app);
    }
    app.say(LEAVING);
    Vec::new()
}

fn field(app: &mut App, field: usize) {
    app.layout.focus_on(Pane::Form);
    app.focus_on(field);
}

// Goes to the next invalid field, wrapping around.
fn fault(app: &mut App) {
    let rows = || {
        let problems = app.tab.problems.iter().map(|(row, _)| *row);
        problems.chain(app.tab.refused_row())
    };
    match rows().filter(|&row| row > app.tab.form.focus).min().or_else(|| rows().min()) {
        Some(row) => field(app, row),
        None => app.say("no field has an error"),
    }
}

fn step(app: &mut App, by: isize) {
    if dialogs::with(app, |dialog, around| dialog.step(by, around)).is_some() {
        return;
    }
    match app.layout.focus() {
        Pane::Results => mark(app, by),
        Pane::Trade => trade::step(app, by),
        _ => app.focus_on(app.tab.form.focus.saturating_add_signed(by)),
    }
}

fn leap(app: &mut App, by: isize) {
    if dialogs::with(app, |dialog, around| dialog.turn(by, around)).is_some() {
        return;
    }
    match app.layout.focus() {
        Pane::Results => turn(app, by * page(app)),
        _ => app.focus_on(group_beside(&app.tab.case, app.tab.form.focus, by)),
    }
}

fn mark(app: &mut App, by: isize) {
    app.tab.results = app.results().stepped(by);
    app.follow();
}

fn turn(app: &mut App, by: isize) {
    app.tab.results = app.results().turned(by);
    app.follow();
}

fn page(app: &App) -> isize {
    app.results().page().max(2).cast_signed() - 1
}

// The first field of the next group, of this one, or of the previous one.
fn group_beside(case: &Case, focus: usize, by: isize) -> usize {
    let starts = rows::groups(case);
    let found = if by > 0 {
        starts.iter().find(|&&start| start > focus)
    } else {
        starts.iter().rev().find(|&&start| start < focus)
    };
    found.copied().unwrap_or(if by > 0 { rows::count(case) - 1 } else { 0 })
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
            if let Some(key) = app.results().key_at(at) {
                let was_selected = app.results().marked().is_some_and(|known| known.key == key);
                app.tab.results.selected = Some(key);
                if was_selected && had_focus {
                    return dialogs::explain(app);
                }
            }
        }
        Pane::Chart => {
            panes::show(app, pane);
            if let Some(angle) = angle_at(&app.charts(), at) {
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

fn hidden_at(app: &App, at: Position) -> Option<Pane> {
    let plan = app.layout.plan();
    let owner = plan.names_hidden()?;
    app.title(owner).hidden_at(plan.area(owner), at)
}

fn pane_at(app: &App, at: Position) -> Option<Pane> {
    let plan = app.layout.plan();
    Pane::ALL.into_iter().find(|&pane| plan.area(pane).contains(at))
}

/// Stops long work, with the study on request. Its results so far stay.
fn stop(app: &mut App, has_study: bool) -> Vec<Effect> {
    let measuring = app.progress.as_ref().map(|_| Effect::CancelWork);
    let solving = app.tab.solving.take().map(|_| {
        app.tab.is_settled = true;
        app.is_pinning = false;
        if let Some(method) = app.tab.answer.as_mut().and_then(|answer| answer.pending.take()) {
            app.say(format!(
                "method {} is stopped; the closed form is shown until the next edit",
                method.name()
            ));
        }
        Effect::CancelSolve
    });
    measuring
        .into_iter()
        .chain(has_study.then(|| study::stop(app)).flatten())
        .chain(solving.or_else(|| stop_seeking(app)))
        .collect()
}

// Stops the search for the required relief, which starts after the other results are shown.
fn stop_seeking(app: &mut App) -> Option<Effect> {
    let answer = app
        .tab
        .answer
        .as_mut()
        .filter(|answer| answer.strikes() && answer.lacks(Stage::Clearing))?;
    answer.requested = answer.stages;
    app.say("the search for the required relief is stopped until the next edit");
    Some(Effect::CancelSolve)
}
