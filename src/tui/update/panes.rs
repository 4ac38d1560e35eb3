//! The panes: focus and layout, the commands of charts and teeth, the selection of the results, and
//! the cursor on the driver's roll angle.

use super::edit;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::ascii;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::cursor_to::{CursorTo, Reach, cursor_range};
use crate::tui::jobs::{ChartPart, ChartRequest};
use crate::tui::layout::Pane;
use crate::tui::panes::chart::{self, ChartCommand, first_contact};
use crate::tui::panes::teeth::TeethCommand;

/// Moves the focus to a pane and makes it visible. In the form, letters are commands until the user
/// enters a field.
pub(super) fn show(app: &mut App, pane: Pane) {
    app.tab.history.end_visit();
    app.layout.focus_on(pane);
    app.is_editing = false;
    if pane.is_lower() && app.layout.plan().area(pane).is_empty() {
        app.layout.show_below(pane);
    }
    app.follow();
}

/// Moves the focus by `by` panes, wrapping around.
pub(super) fn step(app: &mut App, by: isize) {
    show(app, app.layout.focus().beside(by));
}

/// Shows another pane in the lower area; the focus does not move unless it is there.
pub(super) fn cycle_lower(app: &mut App) {
    let plan = app.layout.plan();
    let now = Pane::LOWER.iter().position(|&pane| pane == app.layout.lower()).unwrap_or(0);
    let others = (1..=Pane::LOWER.len()).map(|by| Pane::LOWER[(now + by) % Pane::LOWER.len()]);
    let next = others.into_iter().find(|&pane| plan.area(pane).is_empty()).unwrap_or(Pane::Chart);
    let has_room = Pane::LOWER.iter().any(|&pane| !plan.area(pane).is_empty());
    if app.layout.focus().is_lower() || !has_room {
        app.layout.show_below(next);
        show(app, next);
    } else {
        app.layout.show_below(next);
        app.follow();
    }
}

/// Makes the focused pane fill the screen, or restores the layout.
pub(super) fn zoom(app: &mut App) {
    app.layout.zoom(!app.layout.is_zoomed());
    app.follow();
}

/// Goes to a field of the form and starts its edit.
pub(super) fn go_to(app: &mut App, field: usize) {
    app.focus_on(field);
    edit::begin(app);
}

/// Goes to the result with a key.
pub(super) fn show_result(app: &mut App, key: &str) {
    let listed = app.results().listed();
    if let Some(quantity) = listed.iter().find(|quantity| quantity.key == key) {
        app.tab.results.selected = Some(quantity.key);
    }
    show(app, Pane::Results);
}

/// Reports a letter without a command in the focused pane, and suggests a command.
pub(super) fn stray(app: &mut App, letter: char) {
    let name = if letter == ' ' { "Space".to_owned() } else { letter.to_string() };
    let meant = if app.layout.focus() == Pane::Form { "Enter edits the field, " } else { "" };
    app.say(format!(
        "{} is not a command in {}: {meant}? lists the keys",
        ascii::printable(&name),
        app.layout.focus().name()
    ));
}

/// Runs a command of the pane.
pub(super) fn run_teeth(app: &mut App, command: TeethCommand) {
    let mut view = app.teeth;
    let solved = app.picture().map(|picture| (picture.inputs, picture.solution));
    let result = view.run(command, solved);
    app.teeth = view;
    match result {
        Ok(Some(message)) => app.say(message),
        Ok(None) => (),
        Err(reason) => app.complain(reason),
    }
}

/// Runs a command of the pane.
pub(super) fn run_chart(app: &mut App, command: ChartCommand) {
    let (pane, message) = app.charts().run(command);
    app.chart = pane;
    if let Some(message) = message {
        app.say(message);
    }
}

/// Fits the axes to the visible curves.
pub(super) fn fit_chart(app: &mut App) {
    (app.tab.fitted, app.tab.scale) = app.charts().fitted(app.tab.fitted);
}

/// Scrolls to a moved cursor.
pub(super) fn follow_cursor(app: &mut App, cursor_before: Option<f64>) {
    if let Some(cursor) = app.cursor.filter(|_| app.cursor != cursor_before) {
        app.chart.view = app.chart.view.following(0.0 - cursor.to_degrees(), &app.tab.scale);
    }
}

/// Moves the cursor by columns towards E.
pub(super) fn step_cursor(app: &mut App, columns: i16) -> Vec<Effect> {
    match range_of_cursor(app) {
        Some(reach) => app.cursor = Some(reach.moved(app.cursor, columns)),
        None => app.complain("no valid results for a cursor"),
    }
    stop_playing(app)
}

/// Moves the cursor to the first contact.
pub(super) fn cursor_to_start(app: &mut App) -> Vec<Effect> {
    let start = app.charts().solution().and_then(first_contact);
    match start {
        Some(angle) => app.cursor = Some(angle),
        None => app.complain("no corner contact, so no D"),
    }
    stop_playing(app)
}

/// Asks for an angle, a time or a point.
pub(super) fn ask_cursor(app: &mut App) {
    if range_of_cursor(app).is_some() {
        app.prompts.push(Prompt::CursorTo(CursorTo::default()));
    } else {
        app.complain("no valid results for a cursor");
    }
}

/// Moves the cursor to the typed angle. Shows the chart if neither charts nor teeth are visible.
pub(super) fn move_cursor(app: &mut App, typed: Result<f64, String>) -> Vec<Effect> {
    match typed {
        Err(reason) => app.complain(reason),
        Ok(angle) => {
            app.prompts.pop();
            let plan = app.layout.plan();
            if plan.chart.is_empty() && plan.teeth.is_empty() {
                show(app, Pane::Chart);
            }
            app.cursor = Some(angle);
            let reading = chart::readout(&app.charts(), angle);
            app.say(format!("cursor at {reading}"));
        }
    }
    stop_playing(app)
}

/// Moves the cursor to E.
pub(super) fn cursor_to_end(app: &mut App) -> Vec<Effect> {
    app.cursor = Some(0.0);
    stop_playing(app)
}

/// Starts or stops the animation. At its end it starts again.
pub(super) fn play(app: &mut App) -> Vec<Effect> {
    if app.is_playing {
        return stop_playing(app);
    }
    let Some(reach) = range_of_cursor(app).filter(|reach| reach.run_from > reach.run_to) else {
        app.complain("no corner contact, so nothing to play");
        return Vec::new();
    };
    if app.cursor.is_none_or(|cursor| cursor <= reach.run_to || cursor > reach.run_from) {
        app.cursor = Some(reach.run_from);
    }
    app.is_playing = true;
    vec![Effect::Play(true)]
}

/// Moves to the next frame of the animation.
pub(super) fn tick(app: &mut App) -> Vec<Effect> {
    if !app.is_playing {
        return vec![Effect::Play(false)];
    }
    let reach = range_of_cursor(app);
    let next = reach.zip(app.cursor).and_then(|(reach, cursor)| reach.played(cursor));
    app.cursor = Some(next.unwrap_or(reach.map_or(0.0, |reach| reach.run_to)));
    if next.is_none() { stop_playing(app) } else { Vec::new() }
}

/// Stops the animation.
pub(super) fn stop_playing(app: &mut App) -> Vec<Effect> {
    if std::mem::take(&mut app.is_playing) { vec![Effect::Play(false)] } else { Vec::new() }
}

/// Requests the visible chart, unless it is the last request; stops a hidden one.
pub(super) fn request_chart(app: &mut App) -> Vec<Effect> {
    let is_visible = !app.layout.plan().area(Pane::Chart).is_empty();
    let Some(chart) = app.chart.worker_chart.filter(|_| is_visible) else {
        return stop_chart(app);
    };
    let Some(inputs) = app.tab.inputs().cloned() else {
        return stop_chart(app);
    };
    let last = app.tab.chart_work.request.as_ref();
    if last.is_some_and(|last| last.chart == chart && last.inputs == inputs) {
        return Vec::new();
    }
    forget_running_chart(app);
    app.last_serial += 1;
    let request = ChartRequest { serial: app.last_serial, chart, inputs };
    app.tab.chart_work.request = Some(request.clone());
    app.tab.chart_work.is_running = true;
    vec![Effect::Chart(Box::new(request))]
}

/// Adds the next values.
pub(super) fn take_chart(app: &mut App, part: &ChartPart) {
    let tabs = std::iter::once(&mut app.tab).chain(&mut app.others);
    tabs.for_each(|tab| tab.chart_work.take(part.clone()));
}

fn range_of_cursor(app: &App) -> Option<Reach> {
    cursor_range(&app.cursor_scope())
}

/// Stops the computation; the request is repeated once the chart is visible.
fn stop_chart(app: &mut App) -> Vec<Effect> {
    if forget_running_chart(app) { vec![Effect::CancelChart] } else { Vec::new() }
}

/// Forgets the running request of any tab: the computation ends, and the tab requests it again.
fn forget_running_chart(app: &mut App) -> bool {
    let mut has_run = false;
    for tab in std::iter::once(&mut app.tab).chain(&mut app.others) {
        if std::mem::take(&mut tab.chart_work.is_running) {
            tab.chart_work.request = None;
            has_run = true;
        }
    }
    has_run
}
