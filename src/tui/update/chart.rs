//! The commands of the chart pane: the chart, the visible range, and the x axis.

use crate::report::graphs::GRAPHS;
use crate::tui::app::App;
use crate::tui::view::chart::{first_contact, fitted, occasion};
use crate::tui::window::{ChartView, Frame};

/// Selects the chart `by` places further, wrapping around.
pub(super) fn step(app: &mut App, by: isize) {
    choose(
        app,
        (app.graph + GRAPHS.len()).saturating_add_signed(by) % GRAPHS.len(),
    );
}

/// Selects the chart at an index of the table.
pub(super) fn choose(app: &mut App, graph: usize) {
    app.graph = graph.min(GRAPHS.len() - 1);
}

/// Switches the x axis between roll angle and time.
pub(super) fn time_or_angle(app: &mut App) {
    app.by_time = !app.by_time;
    app.say(if app.by_time {
        "x axis: time after E"
    } else {
        "x axis: driver roll angle before E"
    });
}

/// Zooms in by `steps` around the cursor, or around D without a cursor; out if negative.
pub(super) fn zoom(app: &mut App, steps: i32) {
    let start = app
        .answer
        .as_ref()
        .and_then(|answer| first_contact(answer.of(answer.active)?));
    let around = 0.0 - app.cursor.or(start).unwrap_or(0.0).to_degrees();
    let view = app.chart.zoomed(steps, around, &app.scale);
    if view == app.chart {
        app.say(if steps > 0 {
            "closest zoom"
        } else {
            "the charts show the whole contact"
        });
    }
    app.chart = view;
}

/// Shows the whole contact.
pub(super) fn whole(app: &mut App) {
    app.chart = ChartView::whole();
    app.say("the charts show the whole contact");
}

/// Switches between the strike and the whole contact.
pub(super) fn strike_or_whole(app: &mut App) {
    app.chart = app.chart.strike_or_whole(&app.scale);
    app.say(match app.chart.frame {
        Frame::Strike if app.scale.strike.is_empty() => "no corner contact: no strike to show",
        Frame::Strike => "the charts show the strike",
        Frame::Opening | Frame::Whole => "the charts show the whole contact",
    });
}

/// Fits the axes to the visible curves.
pub(super) fn fit(app: &mut App) {
    let mut occasion = occasion(app);
    let anew = occasion.since(app.tab.fitted);
    if app.tab.fitted != occasion {
        app.tab.scale = fitted(app, anew);
        app.tab.fitted = occasion;
    }
}

/// Scrolls to a cursor that moved.
pub(super) fn follow_cursor(app: &mut App, cursor_before: Option<f64>) {
    if let Some(cursor) = app.cursor.filter(|_| app.cursor != cursor_before) {
        app.chart = app.chart.following(0.0 - cursor.to_degrees(), &app.scale);
    }
}
