//! The commands of the teeth pane: zoom, view and exaggeration of the gap.

use crate::tui::app::App;
use crate::tui::view::teeth::solved;
use crate::tui::zoom::{Exaggeration, TeethView};

/// Zooms in by `steps`, or out if negative.
pub(super) fn zoom(app: &mut App, steps: i32) {
    match solved(app).map(|(inputs, solution)| app.teeth.zoomed(steps, inputs, solution)) {
        Some(view) if view == app.teeth => app.say(if steps > 0 {
            "closest zoom"
        } else {
            "the teeth pane shows the whole pair"
        }),
        Some(view) => app.teeth = view,
        None => app.complain("no valid results to show"),
    }
}

/// Returns to the view at start.
pub(super) fn anew(app: &mut App) {
    app.teeth = TeethView::default();
}

/// Selects the view `by` places further, wrapping around.
pub(super) fn centre_step(app: &mut App, by: isize) {
    app.teeth = app.teeth.centred_beside(by);
    app.say(format!("view: {}", app.teeth.centre.name()));
}

/// Switches the exaggeration of the gap.
pub(super) fn exaggerate_or_not(app: &mut App) {
    app.teeth = app.teeth.exaggerated_or_not();
    app.say(match app.teeth.exaggeration {
        Exaggeration::Fitted => "gap exaggerated by the factor shown",
        Exaggeration::True => "gap drawn true to scale",
    });
}
