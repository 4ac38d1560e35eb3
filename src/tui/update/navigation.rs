//! Navigation by lines, groups and pages, in the focused pane or in the topmost dialog.

use super::{dialogs, trade};
use crate::case::Case;
use crate::tui::app::App;
use crate::tui::commands::Command;
use crate::tui::layout::Pane;
use crate::tui::panes::results;
use crate::tui::rows;

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
    results::page(&app.results()).max(2).cast_signed() - 1
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
