//! The content of the picture: pair, results, cursor and view.

use ratatui::symbols::Marker;

use super::zoom::TeethView;
use crate::case::units::System;
use crate::model::{Inputs, Solution, contact_state};
use crate::tui::theme::Look;

/// All that the picture shows.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The pair.
    pub inputs: &'a Inputs,
    /// What the model found.
    pub solution: &'a Solution,
    /// The driver's roll angle before E, in rad; without it D, or E where no tooth strikes.
    pub cursor: Option<f64>,
    /// What of the plane is in sight.
    pub view: &'a TeethView,
    /// What the terminal is able to show.
    pub look: Look,
    /// How a point is drawn.
    pub marker: Marker,
    /// The units in which it is read.
    pub units: System,
    /// Whether the results are not those of what the form says now.
    pub is_stale: bool,
}

impl Picture<'_> {
    /// The marker of a dot. In ASCII mode it has the dots from which letters are chosen.
    pub(crate) fn drawn_marker(&self) -> Marker {
        if self.look.ascii {
            Marker::Braille
        } else {
            self.marker
        }
    }

    /// The driver's roll angle before E that is shown, in rad.
    #[must_use]
    pub fn angle(&self) -> f64 {
        let contact =
            contact_state::first_contact(self.solution).unwrap_or(0.0) * self.inputs.ratio();
        self.cursor
            .filter(|cursor| cursor.is_finite())
            .unwrap_or(contact)
    }
}
