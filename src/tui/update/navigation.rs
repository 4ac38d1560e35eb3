//! Walking: lines, groups and pages, in the focused pane or in what lies over it.

use super::trade;
use crate::case::Case;
use crate::tui::app::App;
use crate::tui::commands::Command;
use crate::tui::pane::Pane;
use crate::tui::panes::results;
use crate::tui::prompt::Prompt;
use crate::tui::rows;
use crate::tui::view::{boxes, explain, popup};

/// A command that moves a focus or a mark; others change nothing.
pub(super) fn walk(app: &mut App, command: Command) {
    match command {
        Command::Next => step(app, 1),
        Command::Previous => step(app, -1),
        Command::NextGroup => leap(app, 1),
        Command::PreviousGroup => leap(app, -1),
        Command::First if app.panes.focus == Pane::Results => mark(app, isize::MIN),
        Command::Last if app.panes.focus == Pane::Results => mark(app, isize::MAX),
        Command::First | Command::FirstField => field(app, 0),
        Command::Last | Command::LastField => field(app, usize::MAX),
        Command::NextFault => fault(app),
        Command::ResultsUp => turn(app, -page(app)),
        Command::ResultsDown => turn(app, page(app)),
        _ => (),
    }
}

fn field(app: &mut App, field: usize) {
    app.panes.focus = Pane::Form;
    app.focus_on(field);
}

// Round and round those that are wrong.
fn fault(app: &mut App) {
    let rows = || app.tab.problems.iter().map(|(row, _)| *row);
    match rows()
        .filter(|&row| row > app.tab.focus)
        .min()
        .or_else(|| rows().min())
    {
        Some(row) => field(app, row),
        None => app.say("no field has an error"),
    }
}

fn step(app: &mut App, by: isize) {
    match app.prompts.last_mut() {
        None if app.panes.focus == Pane::Results => mark(app, by),
        None if app.panes.focus == Pane::Trade => trade::step(app, by),
        None => app.focus_on(app.tab.focus.saturating_add_signed(by)),
        Some(Prompt::Browse(browser)) => browser.mark(by),
        Some(Prompt::Pick(picker)) => picker.mark(by),
        Some(Prompt::Ask(question)) => question.mark(by),
        Some(Prompt::Read(page)) => popup::scroll(page, by, app.size),
        Some(Prompt::Explain(explanation)) => {
            explain::scroll(explanation, by, app.size, app.look.ascii);
        }
        Some(Prompt::SaveAs(..) | Prompt::Aim(_)) => (),
    }
}

fn leap(app: &mut App, by: isize) {
    let page_of_prompt = isize::try_from(boxes::room(app.size).height)
        .unwrap_or(1)
        .max(1);
    match app.prompts.last_mut() {
        None if app.panes.focus == Pane::Results => turn(app, by * page(app)),
        None => app.focus_on(group_beside(&app.tab.case, app.tab.focus, by)),
        Some(Prompt::Browse(browser)) => browser.mark(by * page_of_prompt),
        Some(Prompt::Pick(picker)) => picker.mark(by * page_of_prompt),
        Some(Prompt::Read(text)) => popup::scroll(text, by * page_of_prompt, app.size),
        Some(Prompt::Explain(text)) => {
            explain::scroll(text, by * page_of_prompt, app.size, app.look.ascii);
        }
        Some(Prompt::Ask(_) | Prompt::SaveAs(..) | Prompt::Aim(_)) => (),
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

// The first field of the next group, of this one, or of the one before.
fn group_beside(case: &Case, focus: usize, by: isize) -> usize {
    let starts = rows::groups(case);
    let found = if by > 0 {
        starts.iter().find(|&&start| start > focus)
    } else {
        starts.iter().rev().find(|&&start| start < focus)
    };
    found
        .copied()
        .unwrap_or(if by > 0 { rows::count(case) - 1 } else { 0 })
}
