//! The only place where the state changes: actions, navigation by lines, groups and pages and with the
//! mouse, and the end of dialogs and work. Files, clocks and threads are left to effects and to the work
//! that it starts.

pub(super) mod commands;
mod edit;
mod export;
pub(super) mod files;
mod panes;
mod studies;

use std::mem;
use std::path::PathBuf;

use ratatui::layout::{Position, Size};

use super::app::App;
use super::app::actions::{Action, Effect, Running, Slot, Work};
use super::app::dialogs::Prompt;
use super::app::dialogs::browser::Browser;
use super::app::panes::chart::cursor_at;
use super::app::panes::form;
use super::app::tab::Tab;
use super::layout::{Pane, is_too_small};
use super::settings::Look;
use super::{rows, solver, store};
use crate::case::Document;
use crate::model::Stage;

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
    studies::pin_baseline(app);
    if !app.has_line() {
        app.tab.read_line_anew();
    }
    app.catch_up();
    settle(app);
    panes::follow_cursor(app, cursor);
    app.preview();
    studies::request(app);
    panes::request_chart(app);
    studies::request_variants(app);
    studies::stop_unseen(app);
    mem::take(&mut app.effects.0)
}

/// Scrolls form and results to their focused rows.
fn settle(app: &mut App) {
    if mem::take(&mut app.needs_scroll) {
        app.tab.form.top = form::top_for(app);
        app.tab.results.top = app.top_of_results();
    }
}

/// The workbench after it opens and solves a document, which may take long.
pub fn opened(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
    let mut app = App::new(document, path, look, size);
    if let Some(request) = app.checked() {
        app.take(solver::answer(&request));
    }
    settle(&mut app);
    app
}

fn happen(app: &mut App, action: Action) {
    // Nothing is edited unseen; a question can be answered.
    let is_hidden = is_too_small(app.layout.size) && app.prompts.is_empty();
    match action {
        Action::Do(command, _) if is_hidden && !command.works_unseen => {}
        Action::Insert(_) | Action::Paste(_) | Action::Stray(_) | Action::Click(_) if is_hidden => {
        }
        Action::Do(command, way) => command.run(app, way),
        Action::Insert(letter) => type_letter(app, letter),
        Action::Paste(text) => edit::paste(app, &text),
        Action::Stray(letter) => panes::stray(app, letter),
        Action::Click(at) => click(app, at),
        Action::Wheel(at, by) => wheel(app, at, by),
        Action::Tick => panes::tick(app),
        Action::Resize(size) => {
            app.layout.size = size;
            app.follow();
            // Terminals cut their content when they shrink, even if they have the old size again.
            app.want(Effect::Redraw);
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

/// The key of the command with a name, in the present place.
fn key_of(app: &App, name: &str) -> String {
    commands::key_in(app.place(), name)
}

/// Message of Ctrl-C if there is nothing to cancel and nothing unsaved.
const LEAVING: &str = "no running work and no unsaved edits: press Ctrl-C again to \
    quit";

/// Handles a letter that is no command of the table: it presses a button, or is text.
fn type_letter(app: &mut App, letter: char) {
    let Some(Prompt::Ask(question)) = app.prompts.last() else {
        return edit::insert(app, letter, commands::at_letter(letter));
    };
    if let Some(change) = question.by_letter(letter) {
        change.apply(app);
    }
}

/// Selects another field of the explanation and makes it visible.
fn step_page(app: &mut App, by: isize) {
    app.with_dialog(|dialog, around| dialog.select_field(by, around));
}

/// Closes the topmost dialog. Returns false if there is none.
fn close(app: &mut App) -> bool {
    let prompt = app.prompts.pop();
    if let Some(Prompt::Relief(dialog)) = &prompt {
        if let Ok(demand) = dialog.demand() {
            app.tab.demand = Some(demand);
        }
        app.cancel(Slot::Relief);
    }
    prompt.is_some()
}

/// Opens the browser in the folder of the present case, or goes to the recent cases in the open one.
fn browse(app: &mut App, prefers_recents: bool) {
    if let Some(browser) = app.browser() {
        return browser.select_recents();
    }
    let opens = (files::open as fn(&mut App, _), files::begin_example as fn(&mut App, _));
    let browser = Browser::beside(app.tab.path.as_deref(), prefers_recents, opens);
    let recents = |app: &mut App, recents| {
        if let Some(browser) = app.browser() {
            browser.remember(recents);
        }
    };
    let find = |_: &Running<'_>| Some(store::looked_at(store::recents()));
    app.start_all([browser.list(), Work::new(Slot::Recents, find, recents)]);
    app.prompts.push(Prompt::Browse(Box::new(browser)));
}

/// Enters the selected folder, or writes the selected name into the line.
fn complete_path(app: &mut App) {
    let works = app.browser().map_or_else(Vec::new, Browser::complete);
    app.start_all(works);
}

/// Handles a click on a field, a result, the chart, the name of a case or of a hidden pane, a line
/// of a list, or a button. A second click on the selection is Enter.
fn click(app: &mut App, at: Position) {
    match app.with_dialog(|dialog, around| dialog.click(at, around)) {
        None => in_panes(app, at),
        Some(true) => app.accept(),
        Some(false) => (),
    }
}

/// Handles a step of the wheel by lines downwards.
fn wheel(app: &mut App, at: Position, by: isize) {
    if app.with_dialog(|dialog, around| dialog.wheel(by, around)).is_some() {
        return;
    }
    let nearer = if by < 0 { 1 } else { -1 };
    match pane_at(app, at) {
        Some(Pane::Form) => app.tab.form.top = form::scrolled(app, by),
        Some(Pane::Results) => app.tab.results.top = app.scrolled_results(by),
        Some(Pane::Chart) => panes::zoom_chart(app, nearer),
        Some(Pane::Teeth) => panes::zoom_teeth(app, nearer),
        Some(Pane::Study) if app.tab.study.state.is_tolerance => studies::scroll(app, by),
        Some(Pane::Study) if app.tab.study.state.is_table => studies::move_cursor(app, by, 0),
        Some(Pane::Study) => studies::zoom(app, nearer),
        Some(Pane::Trade) | None => (),
    }
}

/// Esc: closes a dialog, leaves the field, or stops the work; no edit is lost.
fn leave(app: &mut App) {
    if close(app) {
        return;
    }
    // Hints such as `Esc n` rely on one Esc to leave the field, also while work runs.
    if app.has_line() {
        edit::take_back(app);
        app.tab.history.end_visit();
        app.is_editing = false;
        return;
    }
    if stop(app, app.layout.focus == Pane::Study) || panes::stop_playing(app) {
        return;
    }
    if app.cursor.is_some() && app.layout.focus.is_lower() {
        app.cursor = None;
    } else if app.layout.is_zoomed {
        panes::zoom(app);
    } else {
        panes::show(app, Pane::Form);
    }
}

/// Ctrl-C: closes or stops the topmost item. If there is none, the second press quits, because
/// other programs copy with this key.
fn cancel(app: &mut App) {
    let is_again = app.last_message.as_ref().is_some_and(|message| message.text == LEAVING);
    if !is_again && (close(app) || stop(app, true) || panes::stop_playing(app)) {
        return;
    }
    if is_again || app.tabs().any(Tab::is_unsaved) {
        files::quit(app);
    } else {
        app.say(LEAVING);
    }
}

fn field(app: &mut App, field: usize) {
    app.layout.focus = Pane::Form;
    app.focus_on(field);
}

/// Goes to the first field, or to the last one if `way` is positive.
fn end_of_form(app: &mut App, way: isize) {
    field(app, if way > 0 { usize::MAX } else { 0 });
}

/// Goes to the next invalid field, wrapping around.
fn fault(app: &mut App) {
    let (tab, focus) = (&app.tab, app.tab.form.focus);
    let rows = tab.problems.iter().map(|(row, _)| *row).chain(tab.refused_row());
    match rows.min_by_key(|&row| (row <= focus, row)) {
        Some(row) => {
            app.is_editing = true;
            field(app, row);
        }
        None => app.say("no field has an error"),
    }
}

/// Goes to the next or previous line.
fn step(app: &mut App, by: isize) {
    if app.with_dialog(|dialog, around| dialog.step(by, around)).is_some() {
        return;
    }
    match app.layout.focus {
        Pane::Results => mark(app, by),
        Pane::Trade => studies::step_setting(app, by),
        _ => app.focus_on(app.tab.form.focus.saturating_add_signed(by)),
    }
}

/// Goes to the next or previous group or page.
fn leap(app: &mut App, by: isize) {
    if app.with_dialog(|dialog, around| dialog.turn(by, around)).is_some() {
        return;
    }
    if app.layout.focus == Pane::Results {
        return turn(app, by);
    }
    // The first field of the next group, of this one, or of the previous one.
    let (case, focus) = (&app.tab.case, app.tab.form.focus);
    let starts = rows::groups(case);
    let found = if by > 0 {
        starts.iter().find(|&&start| start > focus)
    } else {
        starts.iter().rev().find(|&&start| start < focus)
    };
    let end = if by > 0 { rows::count(case) - 1 } else { 0 };
    app.focus_on(found.copied().unwrap_or(end));
}

/// Goes to the first line, or to the last one if `way` is positive.
fn go_to_end(app: &mut App, way: isize) {
    match app.layout.focus {
        Pane::Results => mark(app, way.saturating_mul(isize::MAX)),
        _ => end_of_form(app, way),
    }
}

fn mark(app: &mut App, by: isize) {
    app.tab.results = app.stepped_result(by);
    app.follow();
}

/// Scrolls the results by pages.
fn turn(app: &mut App, by: isize) {
    let page = app.results_page().max(2).cast_signed() - 1;
    app.tab.results = app.turned_results(by * page);
    app.follow();
}

fn in_panes(app: &mut App, at: Position) {
    let plan = app.layout.plan();
    if plan.header.contains(at) {
        let mut right = 0;
        let part = app.header().into_iter().find(|(_, span)| {
            right += span.width();
            usize::from(at.x) < right
        });
        if let Some(tab) = part.and_then(|(tab, _)| tab) {
            files::go_to_tab(app, tab);
        }
    } else if let Some(pane) = app.hidden_at(at) {
        panes::show(app, pane);
    } else if let Some(pane) = pane_at(app, at) {
        in_pane(app, pane, at);
    }
}

fn in_pane(app: &mut App, pane: Pane, at: Position) {
    let had_focus = app.layout.focus == pane;
    match pane {
        Pane::Form => in_form(app, form::field_at(app, at)),
        Pane::Results => {
            panes::show(app, pane);
            if let Some(key) = app.result_at(at) {
                let was_selected = app.marked_result().is_some_and(|known| known.key == key);
                app.tab.results.selected = Some(key);
                if was_selected && had_focus {
                    panes::explain(app);
                }
            }
        }
        Pane::Chart => {
            // The focus may widen the pane.
            let found = cursor_at(app.charts(), at);
            panes::show(app, pane);
            if let Some((angle, z)) = found {
                (app.cursor, app.chart.z) = (Some(angle), z);
                panes::stop_playing(app);
            }
        }
        Pane::Teeth | Pane::Trade | Pane::Study => panes::show(app, pane),
    }
}

// The first click focuses a field, the second one edits it.
fn in_form(app: &mut App, field: Option<usize>) {
    let is_marked = app.layout.focus == Pane::Form && field == Some(app.tab.form.focus);
    match field {
        Some(_) if is_marked && app.has_line() => app.tab.form.input.select_all(),
        Some(_) if is_marked => edit::begin(app),
        _ => {
            panes::show(app, Pane::Form);
            app.focus_on(field.unwrap_or(app.tab.form.focus));
        }
    }
}

fn pane_at(app: &App, at: Position) -> Option<Pane> {
    let plan = app.layout.plan();
    Pane::ALL.into_iter().find(|&pane| plan.area(pane).contains(at))
}

/// Stops long work, with the study on request. Its results so far stay. Returns whether any ran.
fn stop(app: &mut App, has_study: bool) -> bool {
    let has_measured = studies::stop_benchmark(app);
    let has_studied = has_study && studies::stop(app);
    let has_solved = stop_solve(app);
    has_measured || has_studied || has_solved
}

// Stops a slow solve, or the search for the required relief, which starts after the other results
// are shown.
fn stop_solve(app: &mut App) -> bool {
    let is_searching = app.tab.lacks(Stage::Clearing);
    let (tab, mut words) = (&mut app.tab, None);
    let is_slow = tab.solving.take().is_some();
    let answer = tab.answer.as_mut().filter(|answer| is_slow || answer.serial == tab.serial);
    if let Some(answer) = answer {
        if is_slow {
            let shown = "is stopped; the closed form is shown until the next edit";
            words = answer.pending.take().map(|method| format!("method {} {shown}", method.name()));
        } else if answer.strikes() && is_searching {
            answer.stages = tab.requested.stages;
            let search = "the search for the required relief is stopped until the next edit";
            words = Some(search.to_owned());
        }
    }
    if is_slow {
        (tab.is_settled, app.is_pinning) = (true, false);
    }
    let has_run = is_slow || words.is_some();
    if has_run {
        app.cancel(Slot::Solve);
    }
    if let Some(words) = words {
        app.say(words);
    }
    has_run
}
