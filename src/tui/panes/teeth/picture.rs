//! The input of the picture: pair, results, cursor and view.

use ratatui::symbols::Marker;

use super::zoom::TeethView;
use crate::case::units::System;
use crate::model::{Inputs, Solution, contact_state};
use crate::tui::theme::Look;

/// The input of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The pair.
    pub inputs: &'a Inputs,
    /// The solution of the model.
    pub solution: &'a Solution,
    /// The driver's roll angle before E, in rad. By default D, or E without corner contact.
    pub cursor: Option<f64>,
    /// The visible part of the plane.
    pub view: &'a TeethView,
    /// The capabilities of the terminal.
    pub look: Look,
    /// The marker of a dot.
    pub marker: Marker,
    /// The display units.
    pub units: System,
    /// Whether the results are older than the form.
    pub is_stale: bool,
}

impl Picture<'_> {
    /// The marker of a dot. In ASCII mode it is the marker from whose dots the letters are chosen.
    pub(crate) fn drawn_marker(&self) -> Marker {
        if self.look.ascii { Marker::Braille } else { self.marker }
    }

    /// The displayed roll angle of the driver before E, in rad.
    #[must_use]
    pub fn angle(&self) -> f64 {
        let contact =
            contact_state::first_contact(self.solution).unwrap_or(0.0) * self.inputs.ratio();
        self.cursor.filter(|cursor| cursor.is_finite()).unwrap_or(contact)
    }
}
