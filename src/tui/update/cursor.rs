//! The cursor in the driver's roll angle that chart and teeth share: how it goes by keys and by
//! itself.

use super::panes;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::layout;
use crate::tui::line::Line;
use crate::tui::pane::Pane;
use crate::tui::prompt::Prompt;
use crate::tui::view::chart::{self, first_contact};
use crate::tui::view::cursor_range::{cursor_range, parse_cursor, solution};

/// Move by columns towards E.
pub(super) fn step(app: &mut App, columns: i16) -> Vec<Effect> {
    match cursor_range(app) {
        Some(reach) => app.cursor = Some(reach.moved(app.cursor, columns)),
        None => app.complain("no valid results for the cursor"),
    }
    stop(app)
}

/// To the first contact.
pub(super) fn to_start(app: &mut App) -> Vec<Effect> {
    match solution(app).and_then(first_contact) {
        Some(angle) => app.cursor = Some(angle),
        None => app.complain("no corner contact, no first contact D"),
    }
    stop(app)
}

/// Ask for an angle, a time or a place.
pub(super) fn ask(app: &mut App) {
    if cursor_range(app).is_some() {
        app.prompts.push(Prompt::Aim(Line::default()));
    } else {
        app.complain("no valid results for the cursor");
    }
}

/// To the angle that is typed, where there is such a one; a chart comes into sight where neither it
/// nor the teeth are.
pub(super) fn take_aim(app: &mut App, typed: &str) -> Vec<Effect> {
    match parse_cursor(app, typed) {
        Err(reason) => {
            app.complain(reason);
            // What is typed next is meant anew.
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
            app.say(format!("cursor at {}", chart::readout(app, angle)));
        }
    }
    stop(app)
}

/// To E.
pub(super) fn to_end(app: &mut App) -> Vec<Effect> {
    app.cursor = Some(0.0);
    stop(app)
}

/// Start or stop the run; from its end it starts again.
pub(super) fn play(app: &mut App) -> Vec<Effect> {
    if app.is_playing {
        return stop(app);
    }
    let Some(reach) = cursor_range(app).filter(|reach| reach.run_from > reach.run_to) else {
        app.complain("no corner contact: nothing to play");
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

/// The next picture.
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

/// Stop what plays.
pub(super) fn stop(app: &mut App) -> Vec<Effect> {
    if std::mem::take(&mut app.is_playing) {
        vec![Effect::Play(false)]
    } else {
        Vec::new()
    }
}
