//! The charts: which one, how much of the roll angle, and what it is told in.

use crate::report::graphs::GRAPHS;
use crate::tui::app::App;
use crate::tui::view::chart::{first_contact, fitted, occasion};
use crate::tui::window::{ChartView, Frame};

/// The chart so many places further, round and round.
pub(super) fn step(app: &mut App, by: isize) {
    choose(
        app,
        (app.graph + GRAPHS.len()).saturating_add_signed(by) % GRAPHS.len(),
    );
}

/// The chart at that place of the table.
pub(super) fn choose(app: &mut App, graph: usize) {
    app.graph = graph.min(GRAPHS.len() - 1);
}

/// The time after E in place of the roll angle before it, or back.
pub(super) fn time_or_angle(app: &mut App) {
    app.by_time = !app.by_time;
    app.say(if app.by_time {
        "x axis: time after E"
    } else {
        "x axis: driver roll angle before E"
    });
}

/// Some steps closer around the cursor, or around D without one; farther below 0.
pub(super) fn zoom(app: &mut App, steps: i32) {
    let start = app
        .answer
        .as_ref()
        .and_then(|answer| first_contact(answer.of(answer.active)?));
    let around = 0.0 - app.cursor.or(start).unwrap_or(0.0).to_degrees();
    let view = app.chart.zoomed(steps, around, &app.scale);
    if view == app.chart {
        app.say(if steps > 0 {
            "the zoom is at its maximum"
        } else {
            "the whole range is visible"
        });
    }
    app.chart = view;
}

/// All of the roll angle.
pub(super) fn whole(app: &mut App) {
    app.chart = ChartView::default();
}

/// From D to a little after E, or all of it.
pub(super) fn strike_or_whole(app: &mut App) {
    app.chart = app.chart.strike_or_whole();
    app.say(match app.chart.frame {
        Frame::Strike if app.scale.strike.is_empty() => {
            "no corner contact: there is no strike to show"
        }
        Frame::Strike => "the charts around the strike",
        Frame::Whole => "the charts over the whole contact",
    });
}

/// Fit the axes to the curves in sight.
pub(super) fn fit(app: &mut App) {
    let mut occasion = occasion(app);
    let anew = occasion.since(app.tab.fitted);
    if app.tab.fitted != occasion {
        app.tab.scale = fitted(app, anew);
        app.tab.fitted = occasion;
    }
}

/// A cursor that moved is brought in sight.
pub(super) fn follow_cursor(app: &mut App, cursor_before: Option<f64>) {
    if let Some(cursor) = app.cursor.filter(|_| app.cursor != cursor_before) {
        app.chart = app.chart.following(0.0 - cursor.to_degrees(), &app.scale);
    }
}
