//! The chart pane within the workbench: its commands, its axes, and the cursor.

use crate::tui::app::App;
use crate::tui::panes::chart::ChartCommand;

/// Runs a command of the pane.
pub(super) fn run(app: &mut App, command: ChartCommand) {
    let (pane, message) = app.charts().run(command);
    app.chart = pane;
    if let Some(message) = message {
        app.say(message);
    }
}

/// Fits the axes to the visible curves.
pub(super) fn fit(app: &mut App) {
    if let Some((occasion, scale)) = app.charts().fitted_since(app.tab.fitted) {
        (app.tab.fitted, app.tab.scale) = (occasion, scale);
    }
}

/// Scrolls to a moved cursor.
pub(super) fn follow_cursor(app: &mut App, cursor_before: Option<f64>) {
    if let Some(cursor) = app.cursor.filter(|_| app.cursor != cursor_before) {
        app.chart.view = app.chart.view.following(0.0 - cursor.to_degrees(), &app.tab.scale);
    }
}
