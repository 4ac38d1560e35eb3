//! The picture of the pair, true to scale, and below it the values at the cursor.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use unicode_width::UnicodeWidthStr;

use super::labels::Labels;
use super::scene::Scene;
use super::{raster, readings};
use crate::case::units::System;
use crate::model::{ContactState, Inputs, Solution, contact_state};
use crate::tui::ascii::symbol;
use crate::tui::theme::Look;
use crate::tui::zoom::TeethView;

/// Least width and height of the picture, in cells.
const SMALLEST: (u16, u16) = (12, 4);
/// The least heights with two and three lines of values. The number of lines does not depend on the
/// values, so that the picture keeps its size.
const TWO_LINES_FROM: u16 = 13;
const THREE_LINES_FROM: u16 = 20;

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

/// Draws the teeth, and below them the values at the cursor.
pub fn draw(picture: &Picture, area: Rect, buffer: &mut Buffer) {
    let area = area.intersection(buffer.area);
    let moment = ContactState::at(picture.inputs, picture.solution, picture.angle());
    let values = values(picture, moment.as_ref(), area.width);
    let most =
        1 + u16::from(area.height >= TWO_LINES_FROM) + u16::from(area.height >= THREE_LINES_FROM);
    let lines = most.min(values.len().max(1) as u16);
    let plot = Rect {
        height: area.height.saturating_sub(lines),
        ..area
    };
    for (line, y) in values.iter().zip(plot.bottom()..area.bottom()) {
        buffer.set_stringn(
            area.x + 1,
            y,
            line,
            usize::from(area.width.saturating_sub(1)),
            Style::new(),
        );
    }
    if plot.width < SMALLEST.0 || plot.height < SMALLEST.1 {
        return;
    }
    let scene = Scene::of(picture, moment.as_ref(), plot.as_size());
    raster::draw(&scene, picture, plot, buffer);
    let _ = Labels::new(plot).draw(&scene, picture, buffer);
}

/// The values at the cursor, in lines.
fn values(picture: &Picture, moment: Option<&ContactState>, width: u16) -> Vec<String> {
    let ascii = picture.look.ascii;
    let told = moment
        .map(|moment| readings::readings(moment, (picture.inputs, picture.solution), picture.units))
        .unwrap_or_default();
    let told = told.iter().map(|reading| {
        let cells = reading.width(symbol(reading.symbol, ascii).width());
        (symbol(&reading.to_string(), ascii).into_owned(), cells)
    });
    readings::lines(told, usize::from(width.saturating_sub(1)))
}
