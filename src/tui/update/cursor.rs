//! The cursor on the driver's roll angle, shared by charts and teeth: keys, prompt and run.

use super::panes;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::cursor_range::{cursor_range, parse_cursor, solution};
use crate::tui::layout;
use crate::tui::line::Line;
use crate::tui::pane::Pane;
use crate::tui::panes::chart::{self, first_contact};
use crate::tui::prompt::Prompt;

/// Moves the cursor by columns towards E.
pub(super) fn step(app: &mut App, columns: i16) -> Vec<Effect> {
    match cursor_range(app) {
        Some(reach) => app.cursor = Some(reach.moved(app.cursor, columns)),
        None => app.complain("no valid results for a cursor"),
    }
    stop(app)
}

/// Moves the cursor to the first contact.
pub(super) fn to_start(app: &mut App) -> Vec<Effect> {
    match solution(app).and_then(first_contact) {
        Some(angle) => app.cursor = Some(angle),
        None => app.complain("no corner contact, so no D"),
    }
    stop(app)
}

/// Asks for an angle, a time or a point.
pub(super) fn ask(app: &mut App) {
    if cursor_range(app).is_some() {
        app.prompts.push(Prompt::Aim(Line::default()));
    } else {
        app.complain("no valid results for a cursor");
    }
}

/// Moves the cursor to the typed angle. Shows the chart if neither charts nor teeth are visible.
pub(super) fn take_aim(app: &mut App, typed: &str) -> Vec<Effect> {
    match parse_cursor(app, typed) {
        Err(reason) => {
            app.complain(reason);
            // Typing replaces the wrong text.
            if let Some(Prompt::Aim(line)) = app.prompts.last_mut() {
                line.select_all();
            }
        }
        Ok(angle) => {
            app.prompts.pop();
            let plan = layout::plan(app.size, app.panes);
            if plan.chart.is_empty() && plan.teeth.is_empty() {
                panes::show(app, Pane::Chart);
            }
            app.cursor = Some(angle);
            app.say(format!(
                "cursor at {}",
                chart::readout(&app.charts(), angle)
            ));
        }
    }
    stop(app)
}

/// Moves the cursor to E.
pub(super) fn to_end(app: &mut App) -> Vec<Effect> {
    app.cursor = Some(0.0);
    stop(app)
}

/// Starts or stops the run. At its end the run starts again.
pub(super) fn play(app: &mut App) -> Vec<Effect> {
    if app.is_playing {
        return stop(app);
    }
    let Some(reach) = cursor_range(app).filter(|reach| reach.run_from > reach.run_to) else {
        app.complain("no corner contact, so nothing to play");
        return Vec::new();
    };
    if app
        .cursor
        .is_none_or(|cursor| cursor <= reach.run_to || cursor > reach.run_from)
    {
        app.cursor = Some(reach.run_from);
    }
    app.is_playing = true;
    vec![Effect::Play(true)]
}

/// Moves to the next picture of the run.
pub(super) fn tick(app: &mut App) -> Vec<Effect> {
    if !app.is_playing {
        return vec![Effect::Play(false)];
    }
    let reach = cursor_range(app);
    let next = reach
        .zip(app.cursor)
        .and_then(|(reach, cursor)| reach.played(cursor));
    app.cursor = Some(next.unwrap_or(reach.map_or(0.0, |reach| reach.run_to)));
    if next.is_none() {
        stop(app)
    } else {
        Vec::new()
    }
}

/// Stops the run.
pub(super) fn stop(app: &mut App) -> Vec<Effect> {
    if std::mem::take(&mut app.is_playing) {
        vec![Effect::Play(false)]
    } else {
        Vec::new()
    }
}
