//! The only place where the state changes: no files, no clock, no threads; those are asked for as effects.

mod edit;
mod files;
mod recovery;

use std::path::PathBuf;

use ratatui::symbols::Marker;

use super::actions::{Action, Command, Next};
use super::app::{App, Panes};
use super::prompt::{Page, Prompt};
use super::solver::Request;
use super::view;
use super::view::{popup, results};
use crate::case::Document;
use crate::case::fields::{self, Kind};
use crate::model::inputs::Rung;

/// What the state asks of the world.
#[derive(Debug, Clone)]
pub enum Effect {
    /// Solve, in place of any request that has not begun.
    Solve(Box<Request>),
    /// Read a case, and tell it as [`Action::Loaded`].
    Load(PathBuf),
    /// Write a case, and tell it as [`Action::Saved`].
    Save(Box<Saving>),
    /// Look what stands in a folder, and tell it as [`Action::Listed`].
    List(String),
    /// Open this case when the workbench starts the next time.
    Remember(PathBuf),
    /// The edits of this journal are in the form now.
    Adopt(PathBuf),
    /// The edits of this journal are not wanted.
    Forget(PathBuf),
    /// Draw every cell anew.
    Redraw,
    /// Give the terminal back to the shell, until it brings us back.
    Suspend,
    /// Leave.
    Quit,
}

/// A save that is asked for.
#[derive(Debug, Clone)]
pub struct Saving {
    /// The document, with the case as the form has it.
    pub document: Document,
    /// Where to.
    pub path: PathBuf,
    /// What may be written over.
    pub over: Over,
    /// What comes next.
    pub next: Next,
}

/// What a save may write over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// Nothing: a file of that name is not to be touched.
    Nothing,
    /// The file that was opened, as long as nobody else changed it.
    Own,
    /// Whatever is there.
    Anything,
}

/// Change the state by what happened, and say what is to be done about it.
pub fn update(app: &mut App, action: Action) -> Vec<Effect> {
    if matches!(action, Action::Do(_) | Action::Insert(_) | Action::Paste(_)) {
        app.message = None;
    }
    match action {
        Action::Do(command) => run(app, command),
        Action::Insert(letter) => edit::insert(app, letter),
        Action::Paste(text) => edit::paste(app, &text),
        Action::Resize(size) => {
            app.size = size;
            app.follow();
            // Terminals cut what they show when they shrink, even if they are back at the old size by now.
            vec![Effect::Redraw]
        }
        Action::Solved(answer) => {
            app.take(*answer);
            Vec::new()
        }
        Action::SolverFailed(serial) => {
            if serial == app.serial {
                app.has_failed = true;
                app.complain("a fault of the program: the solver failed on this; undo or change the last edit");
            }
            Vec::new()
        }
        Action::Loaded(path, result) => files::loaded(app, path, result),
        Action::Saved(path, next, result) => files::saved(app, path, next, result),
        Action::Listed(folder, entries) => files::listed(app, &folder, entries),
        Action::Claimed(claim) => recovery::claimed(app, *claim),
        Action::Warned(text) => {
            app.complain(text);
            Vec::new()
        }
    }
}

fn run(app: &mut App, command: Command) -> Vec<Effect> {
    match command {
        Command::Edit(request) => return edit::handle(app, request),
        Command::Save => return files::save(app, Next::Stay),
        Command::SaveAs => return files::ask_where(app, Next::Stay),
        Command::Open => return files::when_saved(app, Next::Browse),
        Command::New => return files::when_saved(app, Next::Fresh),
        Command::Quit => return files::when_saved(app, Next::Quit),
        Command::Cancel => return files::cancel(app),
        Command::Accept => return files::accept(app),
        Command::Complete => return files::complete(app),
        Command::Undo => return travel(app, Command::Undo),
        Command::Redo => return travel(app, Command::Redo),
        Command::ToggleRung => return toggle_rung(app),
        Command::NextChoice => return edit::cycle(app, 1),
        Command::PreviousChoice => return edit::cycle(app, -1),
        Command::Redraw => return vec![Effect::Redraw],
        Command::Suspend => return vec![Effect::Suspend],
        Command::Help => app.prompts.push(Prompt::Read(Page::new("Help", view::help::lines()))),
        Command::Leave => drop(app.prompts.pop()),
        Command::CyclePanes => cycle_panes(app),
        Command::CycleMarker => cycle_marker(app),
        Command::ResultsUp => scroll_results(app, -1),
        Command::ResultsDown => scroll_results(app, 1),
        Command::Next => step(app, 1),
        Command::Previous => step(app, -1),
        Command::NextGroup => leap(app, 1),
        Command::PreviousGroup => leap(app, -1),
        Command::FirstField => app.focus_on(0),
        Command::LastField => app.focus_on(usize::MAX),
    }
    Vec::new()
}

fn travel(app: &mut App, command: Command) -> Vec<Effect> {
    let (case, focus) = (app.case.clone(), app.focus);
    let state = if command == Command::Undo { app.history.undo(&case, focus) } else { app.history.redo(&case, focus) };
    let Some((case, focus)) = state else {
        app.say(if command == Command::Undo { "nothing to undo" } else { "nothing to redo" });
        return Vec::new();
    };
    solve(app.replace_case(case, focus))
}

fn toggle_rung(app: &mut App) -> Vec<Effect> {
    let Some(field) = fields::index_of("model.rung") else { return Vec::new() };
    let names: Vec<_> = Rung::ALL.iter().map(|rung| rung.name()).collect();
    let effects = edit::choose(app, field, &names, 1);
    app.say(format!("rung {}", edit::chosen(app, field)));
    effects
}

fn cycle_panes(app: &mut App) {
    app.panes = match app.panes {
        Panes::All => Panes::NoChart,
        Panes::NoChart => Panes::Chart,
        Panes::Chart => Panes::All,
    };
    app.follow();
}

fn cycle_marker(app: &mut App) {
    app.marker = match app.marker {
        Marker::Braille => Marker::HalfBlock,
        Marker::HalfBlock => Marker::Dot,
        _ => Marker::Braille,
    };
    app.say(format!("chart in {}", app.marker.to_string().to_lowercase()));
}

fn scroll_results(app: &mut App, by: isize) {
    let page = results::page(app).max(2) - 1;
    let last = results::length(app).saturating_sub(page + 1);
    app.results_top = app.results_top.saturating_add_signed(by * page.cast_signed()).min(last);
}

fn step(app: &mut App, by: isize) {
    match app.prompts.last_mut() {
        None => app.focus_on(app.focus.saturating_add_signed(by)),
        Some(Prompt::Browse(browser)) => browser.mark(by),
        Some(Prompt::Ask(question)) => question.mark(by),
        Some(Prompt::Read(page)) => popup::scroll(page, by, app.size),
        Some(Prompt::SaveAs(..)) => (),
    }
}

fn leap(app: &mut App, by: isize) {
    let page = isize::try_from(popup::room(app.size).height).unwrap_or(1).max(1);
    match app.prompts.last_mut() {
        None => app.focus_on(group_beside(app.focus, by)),
        Some(Prompt::Browse(browser)) => browser.mark(by * page),
        Some(Prompt::Read(text)) => popup::scroll(text, by * page, app.size),
        Some(Prompt::Ask(_) | Prompt::SaveAs(..)) => (),
    }
}

// The first field of the next group, of this one, or of the one before.
fn group_beside(focus: usize, by: isize) -> usize {
    let starts: Vec<_> = (0..fields::FIELDS.len())
        .filter(|&field| field == 0 || fields::FIELDS[field].table() != fields::FIELDS[field - 1].table())
        .collect();
    let found =
        if by > 0 { starts.iter().find(|&&start| start > focus) } else { starts.iter().rev().find(|&&start| start < focus) };
    found.copied().unwrap_or(if by > 0 { fields::FIELDS.len() - 1 } else { 0 })
}

fn solve(request: Option<Request>) -> Vec<Effect> {
    request.map(|request| Effect::Solve(Box::new(request))).into_iter().collect()
}

fn options(field: usize) -> &'static [&'static str] {
    match fields::FIELDS[field].kind {
        Kind::Choice(names, _) => names,
        Kind::Text | Kind::Number(..) | Kind::Count(..) => &[],
    }
}
