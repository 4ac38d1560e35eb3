//! Focus and layout: the focused pane, and the visible panes.

use super::edit;
use crate::tui::app::App;
use crate::tui::ascii;
use crate::tui::layout::Pane;
use crate::tui::panes::results;

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
    let row = results::listed(&app.results()).position(|quantity| quantity.key == key);
    app.tab.results.row = row.unwrap_or(app.tab.results.row);
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
