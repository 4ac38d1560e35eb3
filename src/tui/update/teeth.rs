//! What of the teeth is in sight: zoom, centre and the factor of the gap.

use crate::tui::app::App;
use crate::tui::view::teeth::solved;
use crate::tui::zoom::{Exaggeration, TeethView};

/// Some steps closer, or farther below 0.
pub(super) fn zoom(app: &mut App, steps: i32) {
    match solved(app).map(|(inputs, solution)| app.teeth.zoomed(steps, inputs, solution)) {
        Some(view) if view == app.teeth => app.say(if steps > 0 {
            "the zoom is at its maximum"
        } else {
            "the whole range is visible"
        }),
        Some(view) => app.teeth = view,
        None => app.complain("no valid results to show"),
    }
}

/// As at first.
pub(super) fn anew(app: &mut App) {
    app.teeth = TeethView::default();
}

/// Around the next of what there is to look at, or the one before, round and round.
pub(super) fn centre_step(app: &mut App, by: isize) {
    app.teeth = app.teeth.centred_beside(by);
    app.say(format!("the teeth around {}", app.teeth.centre.name()));
}

/// The gap wider than it is, or as it is.
pub(super) fn exaggerate_or_not(app: &mut App) {
    app.teeth = app.teeth.exaggerated_or_not();
    app.say(match app.teeth.exaggeration {
        Exaggeration::Fitted => "the gap is drawn enlarged by the printed factor",
        Exaggeration::True => "the gap is drawn true to scale",
    });
}
