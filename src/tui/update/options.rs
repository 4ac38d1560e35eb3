//! Settings for every case: marker, theme, ASCII, units, mouse.

use ratatui::symbols::Marker;

use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::settings::marker_name;
use crate::tui::theme::ThemeName;

/// Switches to the next marker.
pub(super) fn cycle_marker(app: &mut App) -> Vec<Effect> {
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
    keep(app)
}

/// Switches to the next theme.
pub(super) fn cycle_theme(app: &mut App) -> Vec<Effect> {
    let name = match ThemeName::of(app.look.theme) {
        ThemeName::Quiet => ThemeName::Contrast,
        ThemeName::Contrast => ThemeName::Mono,
        ThemeName::Mono => ThemeName::Quiet,
    };
    app.settings.theme = Some(name);
    app.look.theme = name.theme();
    app.say(format!("theme {}", name.name()));
    keep(app)
}

const UNICODE: &str = "drawn in Unicode; a locale without UTF-8 keeps it for this session only";

/// Switches between ASCII and Unicode; Unicode only for this session if the environment lacks it.
pub(super) fn toggle_ascii(app: &mut App) -> Vec<Effect> {
    app.look.ascii = !app.look.ascii;
    app.settings.ascii = app.look.ascii;
    app.say(if app.look.ascii { "drawn in ASCII" } else { UNICODE });
    keep(app)
}

/// Switches the display units between metric and inch.
pub(super) fn cycle_units(app: &mut App) -> Vec<Effect> {
    app.settings.units = app.settings.units.other();
    app.say(format!(
        "results, hints, charts and teeth in {} units; the file keeps its own units",
        app.settings.units.name()
    ));
    keep(app)
}

/// Turns mouse reports on or off.
pub(super) fn toggle_mouse(app: &mut App) -> Vec<Effect> {
    app.settings.mouse = !app.settings.mouse;
    app.say(if app.settings.mouse {
        "the workbench uses the mouse; most terminals still select text with Shift held"
    } else {
        "the terminal uses the mouse"
    });
    let mut effects = keep(app);
    effects.push(Effect::Mouse(app.settings.mouse));
    effects
}

/// Saves the settings.
pub(super) fn keep(app: &App) -> Vec<Effect> {
    vec![Effect::Keep(app.settings)]
}
