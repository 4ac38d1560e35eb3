//! The cursor on the driver's roll angle, common to charts and teeth: keys, prompt and animation.

use super::panes;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::cursor_to::{CursorTo, Reach, cursor_range};
use crate::tui::layout::Pane;
use crate::tui::panes::chart::{self, first_contact};

/// Moves the cursor by columns towards E.
pub(super) fn step(app: &mut App, columns: i16) -> Vec<Effect> {
    match range(app) {
        Some(reach) => app.cursor = Some(reach.moved(app.cursor, columns)),
        None => app.complain("no valid results for a cursor"),
    }
    stop(app)
}

/// Moves the cursor to the first contact.
pub(super) fn to_start(app: &mut App) -> Vec<Effect> {
    let start = app.charts().solution().and_then(first_contact);
    match start {
        Some(angle) => app.cursor = Some(angle),
        None => app.complain("no corner contact, so no D"),
    }
    stop(app)
}

/// Asks for an angle, a time or a point.
pub(super) fn ask(app: &mut App) {
    if range(app).is_some() {
        app.prompts.push(Prompt::CursorTo(CursorTo::default()));
    } else {
        app.complain("no valid results for a cursor");
    }
}

/// Moves the cursor to the typed angle. Shows the chart if neither charts nor teeth are visible.
pub(super) fn move_to(app: &mut App, typed: Result<f64, String>) -> Vec<Effect> {
    match typed {
        Err(reason) => app.complain(reason),
        Ok(angle) => {
            app.prompts.pop();
            let plan = app.layout.plan();
            if plan.chart.is_empty() && plan.teeth.is_empty() {
                panes::show(app, Pane::Chart);
            }
            app.cursor = Some(angle);
            let reading = chart::readout(&app.charts(), angle);
            app.say(format!("cursor at {reading}"));
        }
    }
    stop(app)
}

/// Moves the cursor to E.
pub(super) fn to_end(app: &mut App) -> Vec<Effect> {
    app.cursor = Some(0.0);
    stop(app)
}

/// Starts or stops the animation. At its end it starts again.
pub(super) fn play(app: &mut App) -> Vec<Effect> {
    if app.is_playing {
        return stop(app);
    }
    let Some(reach) = range(app).filter(|reach| reach.run_from > reach.run_to) else {
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
    let reach = range(app);
    let next = reach.zip(app.cursor).and_then(|(reach, cursor)| reach.played(cursor));
    app.cursor = Some(next.unwrap_or(reach.map_or(0.0, |reach| reach.run_to)));
    if next.is_none() { stop(app) } else { Vec::new() }
}

/// Stops the animation.
pub(super) fn stop(app: &mut App) -> Vec<Effect> {
    if std::mem::take(&mut app.is_playing) { vec![Effect::Play(false)] } else { Vec::new() }
}

fn range(app: &App) -> Option<Reach> {
    cursor_range(&app.cursor_scope())
}
