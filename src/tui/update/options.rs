//! What the user chooses for every case: marker, theme, ASCII, units, mouse.

use ratatui::symbols::Marker;

use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::settings::marker_name;
use crate::tui::theme::ThemeName;

/// Another way to draw a point.
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

/// Other colours.
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

/// ASCII alone, from now on; or, in this session whatever the environment says, the whole of
/// Unicode.
pub(super) fn toggle_ascii(app: &mut App) -> Vec<Effect> {
    app.look.ascii = !app.look.ascii;
    app.settings.ascii = app.look.ascii;
    app.say(if app.look.ascii {
        "drawn in ASCII"
    } else {
        UNICODE
    });
    keep(app)
}

/// Metric units for what is shown, or inch.
pub(super) fn cycle_units(app: &mut App) -> Vec<Effect> {
    app.settings.units = app.settings.units.other();
    app.say(format!(
        "results, hints, charts and teeth in {} units; the file keeps its own units",
        app.settings.units.name()
    ));
    keep(app)
}

/// The mouse for the workbench, or for the terminal.
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

/// Keep what was chosen.
pub(super) fn keep(app: &App) -> Vec<Effect> {
    vec![Effect::Keep(app.settings)]
}
