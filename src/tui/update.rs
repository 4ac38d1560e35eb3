//! The only place where the state changes. It uses no files, no clock and no threads, but requests
//! them as effects.

mod dialogs;
mod edit;
mod export;
pub(super) mod files;
mod navigation;
mod panes;
mod study;
mod trade;
mod variants;

use std::mem;
use std::path::PathBuf;

use ratatui::layout::Size;
use ratatui::symbols::Marker;

use super::actions::{Action, Effect};
use super::app::App;
use super::commands::{self, Command, Scope};
use super::dialogs::Prompt;
use super::dialogs::browser::Browser;
use super::dialogs::page::Page;
use super::dialogs::picker::{Context, List, Picker};
use super::jobs::Job;
use super::layout::Pane;
use super::panes::form;
use super::rows;
use super::session::save::Next;
use super::settings::marker_name;
use super::solver::Request;
use super::theme::{Look, ThemeName};
use crate::case::{Acting, Document, FIELDS, Field, changes, fields, relevance};
use crate::model::inputs::Method;

const UNICODE: &str = "drawn in Unicode; a locale without UTF-8 keeps it for this session only";

/// Applies an action to the state. Returns the effects to carry out.
pub fn update(app: &mut App, action: Action) -> Vec<Effect> {
    if matches!(
        action,
        Action::Do(_) | Action::Insert(_) | Action::Stray(_) | Action::Paste(_) | Action::Click(_)
    ) {
        let is_again = matches!(action, Action::Do(Command::Cancel))
            && app.message.take().is_some_and(|said| said.text == navigation::LEAVING);
        if is_again {
            return files::quit(app);
        }
        app.message = None;
    }
    let cursor = app.cursor;
    let mut effects = happen(app, action);
    if !app.has_line() {
        app.tab.read_line_anew();
    }
    effects.extend(solve(app.catch_up()));
    settle(app);
    dialogs::refresh_page(app);
    panes::follow_cursor(app, cursor);
    effects.extend(dialogs::preview(app));
    effects.extend(study::request(app));
    effects.extend(panes::request_chart(app));
    effects.extend(variants::request(app));
    effects.extend(trade::stop_unseen(app));
    effects
}

/// Updates the dependent state: the scrolling of form and results, and the axes of the charts.
pub(crate) fn settle(app: &mut App) {
    if mem::take(&mut app.needs_scroll) {
        app.tab.form.top = form::top_for(&app.form());
        app.tab.results.top = app.results().top_for();
    }
    panes::fit_chart(app);
}

/// The workbench after it opens a document.
#[must_use]
pub fn opened(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
    let mut app = App::new(document, path, look, size);
    settle(&mut app);
    app
}

fn happen(app: &mut App, action: Action) -> Vec<Effect> {
    match action {
        Action::Do(command) => return run(app, command),
        Action::Insert(letter) => {
            return dialogs::letter(app, letter).unwrap_or_else(|| edit::insert(app, letter));
        }
        Action::Paste(text) => return edit::paste(app, &text),
        Action::Stray(letter) => panes::stray(app, letter),
        Action::Click(at) => return navigation::click(app, at),
        Action::Wheel(at, by) => navigation::wheel(app, at, by),
        Action::Tick => return panes::tick(app),
        Action::Resize(size) => {
            app.layout.resize(size);
            app.follow();
            // Terminals cut their content when they shrink, even if they have the old size again.
            return vec![Effect::Redraw];
        }
        Action::Solved(answer) => {
            app.take(*answer);
            variants::pin_baseline(app);
        }
        Action::Measured(measured) => trade::measured(app, *measured),
        Action::Studied(part) => study::take(app, *part),
        Action::Charted(part) => panes::take_chart(app, &part),
        Action::Compared(found) => variants::take(app, *found),
        Action::SolverFailed(serial) => solver_failed(app, serial),
        Action::Solving(serial, part) => {
            if let Some(tab) = app.tab_of(serial).filter(|tab| !tab.is_settled) {
                tab.solving = Some(part);
            }
        }
        Action::Progress(progress) => app.progress = progress,
        Action::Loaded(path, result) => return files::loaded(app, path, result),
        Action::FileChanged(path, result) => return files::file_changed(app, &path, result),
        Action::Saved(path, next, result) => return files::saved(app, path, next, result),
        Action::Exported(path, result) => export::done(app, &path, result),
        Action::Reported(text) => return export::copy_report(app, text),
        Action::Claimed(claim) => files::claimed(app, *claim),
        Action::Journals(journals) => files::list_journals(app, journals),
        Action::Failed(reason) => app.complain(reason),
        result @ (Action::Listed(_)
        | Action::Found(_)
        | Action::Previewed(..)
        | Action::Recents(_)
        | Action::Examples(_)
        | Action::Explained(_)
        | Action::Relieved(_)) => return dialogs::receive(app, result),
    }
    Vec::new()
}

fn run(app: &mut App, command: Command) -> Vec<Effect> {
    match command {
        Command::Edit(request) => edit::handle(app, request),
        Command::Save => files::save(app, Next::Stay),
        Command::SaveAs => files::ask_where(app, Next::Stay),
        Command::Reload => files::ask_reload(app),
        Command::Journals => vec![Effect::Journals],
        Command::Relief => edit::ask_relief(app),
        Command::Export => export::ask(app),
        Command::Open => open_browser(app, false),
        Command::Recent => open_recent(app),
        Command::FolderUp => browse_up(app),
        Command::Example => edit::ask_example(app),
        Command::Explain => dialogs::explain(app),
        Command::New => solve(files::fresh_tab(app)),
        Command::BuiltIn => solve(files::built_in(app)),
        Command::CloseTab => files::close(app),
        Command::Quit => files::quit(app),
        Command::Cancel => navigation::cancel(app),
        Command::Accept => dialogs::accept(app),
        Command::Complete => complete_path(app),
        Command::Undo | Command::Redo => travel(app, command),
        Command::ToggleMethod => set_method(app, None),
        Command::Method(method) => set_method(app, Some(method)),
        Command::NextChoice => edit::cycle(app, 1),
        Command::PreviousChoice => edit::cycle(app, -1),
        Command::Redraw => vec![Effect::Redraw],
        Command::Suspend => vec![Effect::Suspend],
        Command::Leave => navigation::leave(app),
        Command::CopyValue => export::copy_value(app),
        Command::CopyResults => export::copy_results(app),
        Command::Measure => trade::measure(app),
        Command::TakeSetting => trade::take(app),
        Command::SwitchTradeView => {
            trade::switch_view(app);
            Vec::new()
        }
        Command::CursorBy(columns) => panes::step_cursor(app, columns),
        Command::CursorToD => panes::cursor_to_start(app),
        Command::CursorToE => panes::cursor_to_end(app),
        Command::Play => panes::play(app),
        Command::CursorAway => {
            app.cursor = None;
            panes::stop_playing(app)
        }
        Command::CycleMarker => cycle_marker(app),
        Command::ShowCost => {
            app.shows_cost = !app.shows_cost;
            Vec::new()
        }
        Command::CycleTheme => cycle_theme(app),
        Command::ToggleAscii => toggle_ascii(app),
        Command::CycleUnits => cycle_units(app),
        Command::Step(by) => edit::step(app, by),
        Command::Limit => edit::ask_limit(app),
        Command::Study(command) => study::run(app, command),
        Command::ToggleMouse => toggle_mouse(app),
        other => {
            show(app, other);
            Vec::new()
        }
    }
}

// Commands that change only the view.
fn show(app: &mut App, command: Command) {
    match command {
        Command::Help => app.prompts.push(Prompt::Read(Page::new("Help", commands::help()))),
        Command::Palette => find(app, List::Commands),
        Command::SearchField => find(app, List::Places),
        Command::Material => edit::ask_material(app),
        Command::Notes => dialogs::notes(app),
        Command::CursorTo => panes::ask_cursor(app),
        Command::Variant => variants::ask(app),
        Command::NextVariants => variants::next(app),
        Command::NextReason => dialogs::step_page(app, 1),
        Command::PreviousReason => dialogs::step_page(app, -1),
        Command::PinBaseline => variants::toggle_baseline(app),
        Command::NextTab => files::step_tab(app, 1),
        Command::PreviousTab => files::step_tab(app, -1),
        Command::Tab(at) => files::go_to_tab(app, at),
        Command::Show(pane) => panes::show(app, pane),
        Command::NextPane => panes::step(app, 1),
        Command::PreviousPane => panes::step(app, -1),
        Command::CycleLower => panes::cycle_lower(app),
        Command::Zoom => panes::zoom(app),
        Command::StartEdit => edit::begin(app),
        Command::Chart(command) => panes::run_chart(app, command),
        Command::Teeth(command) => panes::run_teeth(app, command),
        other => navigation::walk(app, other),
    }
}

// A list in the order of the focused pane and field.
fn find(app: &mut App, list: List) {
    let inputs = &app.tab.inputs_so_far;
    let idle = |field: &usize| matches!(relevance(*field, inputs), Acting::No(_));
    let of_scope = |scope: Scope| {
        let commands = commands::commands().map(|binding| binding.command);
        commands.filter(|&command| scope_of(app, command) == scope).collect()
    };
    let context = Context {
        results: app.results().listed().iter().map(|quantity| quantity.key).collect(),
        are_results_first: app.layout.focus() == Pane::Results,
        idle: (0..FIELDS.len()).filter(idle).collect(),
        own: of_scope(Scope::Own),
        elsewhere: of_scope(Scope::Elsewhere),
    };
    app.prompts.push(Prompt::Pick(Picker::over(list, context)));
}

// The scope of a command; in the form, the focused row decides too.
fn scope_of(app: &App, command: Command) -> Scope {
    let scope = commands::scope(command, app.place(), app.layout.focus());
    if app.layout.focus() != Pane::Form {
        return scope;
    }
    let field = rows::field(&app.tab.case, app.tab.form.focus);
    let is_own = match command {
        Command::Step(by) => rows::stepped(&app.tab.case, app.tab.form.focus, by).is_some(),
        Command::Material => field.is_some_and(Field::is_of_gear),
        Command::ToggleMethod | Command::Method(_) => {
            field.is_some_and(|field| field.key == "model.method")
        }
        Command::Limit => field.is_none(),
        _ => return scope,
    };
    if is_own { Scope::Own } else { Scope::Everywhere }
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

fn travel(app: &mut App, command: Command) -> Vec<Effect> {
    let tab = &mut app.tab;
    let (state, verb) = match command {
        Command::Undo => (tab.history.undo(&tab.case, tab.form.focus), "undo"),
        _ => (tab.history.redo(&tab.case, tab.form.focus), "redo"),
    };
    let Some((case, focus)) = state else {
        app.say(format!("nothing to {verb}"));
        return Vec::new();
    };
    tab.remember();
    let summary = super::session::save::summary(&changes::between(&tab.case, &case));
    let effects = solve(app.replace_case(case, focus));
    app.tab.undone = app.tab.serial;
    app.say(format!("{verb}: {summary}"));
    effects
}

// Sets a method, by default the next one.
fn set_method(app: &mut App, method: Option<Method>) -> Vec<Effect> {
    let Some(field) = fields::index_of("model.method") else {
        return Vec::new();
    };
    let names: Vec<_> = Method::ALL.iter().map(|method| method.name()).collect();
    let effects = match method {
        Some(method) => edit::set(app, field, method.name()),
        None => edit::choose(app, field, &names, 1),
    };
    let waits = if app.tab.is_stale() { ", solved once every field is valid" } else { "" };
    app.say(format!("method {}{waits}", edit::chosen(app, field)));
    effects
}

fn solve(request: Option<Request>) -> Vec<Effect> {
    request.map(|request| Effect::Solve(Box::new(request))).into_iter().collect()
}

/// Switches to the next marker.
fn cycle_marker(app: &mut App) -> Vec<Effect> {
    if app.look.ascii {
        app.say("the marker has no effect: the chart is drawn in ASCII");
        return Vec::new();
    }
    app.settings.marker = match app.settings.marker {
        Marker::Braille => Marker::HalfBlock,
        Marker::HalfBlock => Marker::Dot,
        _ => Marker::Braille,
    };
    app.say(format!("chart in {}", marker_name(app.settings.marker)));
    keep_settings(app)
}

/// Switches to the next theme.
fn cycle_theme(app: &mut App) -> Vec<Effect> {
    let name = match ThemeName::of(app.look.theme) {
        ThemeName::Quiet => ThemeName::Contrast,
        ThemeName::Contrast => ThemeName::Mono,
        ThemeName::Mono => ThemeName::Quiet,
    };
    app.settings.theme = Some(name);
    app.look.theme = name.theme();
    app.say(format!("theme {}", name.name()));
    keep_settings(app)
}

/// Switches between ASCII and Unicode; Unicode only for this session if the environment lacks it.
fn toggle_ascii(app: &mut App) -> Vec<Effect> {
    app.look.ascii = !app.look.ascii;
    app.settings.ascii = app.look.ascii;
    app.say(if app.look.ascii { "drawn in ASCII" } else { UNICODE });
    keep_settings(app)
}

/// Switches the display units between metric and inch.
fn cycle_units(app: &mut App) -> Vec<Effect> {
    app.settings.units = app.settings.units.other();
    app.say(format!(
        "results, hints, charts and teeth in {} units; the file keeps its own units",
        app.settings.units.name()
    ));
    keep_settings(app)
}

/// Turns mouse reports on or off.
fn toggle_mouse(app: &mut App) -> Vec<Effect> {
    app.settings.mouse = !app.settings.mouse;
    app.say(if app.settings.mouse {
        "the workbench uses the mouse; most terminals still select text with Shift held"
    } else {
        "the terminal uses the mouse"
    });
    let mut effects = keep_settings(app);
    effects.push(Effect::Mouse(app.settings.mouse));
    effects
}

/// Saves the settings.
fn keep_settings(app: &App) -> Vec<Effect> {
    vec![Effect::Keep(app.settings)]
}

/// Opens the browser in the folder of the present case or on the recent cases.
fn open_browser(app: &mut App, prefers_recents: bool) -> Vec<Effect> {
    let browser = Browser::beside(app.tab.path.as_deref(), prefers_recents);
    let effects = vec![browser.list(), Effect::Job(Job::Recents)];
    app.prompts.push(Prompt::Browse(Box::new(browser)));
    effects
}

/// Goes to the recent cases, in an open browser or in a new one.
fn open_recent(app: &mut App) -> Vec<Effect> {
    match browser(app) {
        Some(browser) => {
            browser.select_recents();
            Vec::new()
        }
        None => open_browser(app, true),
    }
}

/// Goes to the parent folder.
fn browse_up(app: &mut App) -> Vec<Effect> {
    let Some(browser) = browser(app) else {
        return Vec::new();
    };
    let above = browser.above();
    browser.enter(above);
    vec![browser.list()]
}

/// Whether the line of a browser is empty, so that there is nothing to delete.
fn is_in_empty_line(app: &mut App) -> bool {
    browser(app).is_some_and(|browser| browser.input.value().is_empty())
}

/// Enters the selected folder, or writes the selected name into the line.
fn complete_path(app: &mut App) -> Vec<Effect> {
    browser(app).map_or_else(Vec::new, Browser::complete)
}

fn browser(app: &mut App) -> Option<&mut Browser> {
    app.prompts.last_mut().and_then(Prompt::browser)
}
