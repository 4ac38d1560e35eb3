//! The teeth pane: the pair true to scale, and the values at the cursor.

pub(crate) mod scene;
pub(crate) mod strokes;
pub(crate) mod window;

use std::fmt;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use unicode_width::UnicodeWidthStr;

use crate::case::units::System;
use crate::case::units::system::{shown, widest_beside};
use crate::model::{ContactState, Inputs, Solution, contact_state};
use crate::report::graphs::{GRAPHS, Place};
use crate::report::stations::{COLUMNS, Column};
use crate::tui::ascii::symbol;
use crate::tui::theme::Look;

use scene::{Labels, Scene};
use window::Exaggeration;
pub(crate) use window::TeethView;

/// Least width and height of the picture, in cells.
const SMALLEST: (u16, u16) = (12, 4);
/// Least heights of a pane with two and with three lines of values. The number of lines does not
/// depend on the values, so that the picture keeps its size.
const TWO_LINES_FROM: u16 = 13;
const THREE_LINES_FROM: u16 = 20;

/// Significant digits of the opening.
const GAP_DIGITS: usize = 4;
/// The key of the opening, which is not a column of the stations.
const OPEN: &str = "open";
/// The key of the gap.
const GAP: &str = "gap";
/// The text of a missing number.
const NONE: &str = "–";
/// Cells of a number.
const NUMBER: usize = 7;

/// A command of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TeethCommand {
    /// Zooms in by steps; zooms out if negative.
    Zoom(i32),
    /// Restores the initial view.
    Reset,
    /// Selects the view `by` places further, wrapping around.
    Centre(isize),
    /// Switches the exaggeration of the gap.
    Gap,
}

impl TeethView {
    /// Runs a command on the view of a solved pair, if there is one.
    ///
    /// # Errors
    /// Returns an error if the command needs a solved pair.
    pub(crate) fn run(
        &mut self,
        command: TeethCommand,
        solved: Option<(&Inputs, &Solution)>,
    ) -> Result<Option<String>, &'static str> {
        let before = *self;
        let message = match command {
            TeethCommand::Zoom(steps) => {
                let (inputs, solution) = solved.ok_or("no valid results to show")?;
                *self = self.zoomed(steps, inputs, solution);
                let end =
                    if steps > 0 { "closest zoom" } else { "the teeth pane shows the whole pair" };
                (*self == before).then(|| end.to_owned())
            }
            TeethCommand::Reset => {
                *self = TeethView::default();
                None
            }
            TeethCommand::Centre(by) => {
                *self = self.centred_beside(by);
                Some(format!("view: {}", self.centre.name()))
            }
            TeethCommand::Gap => {
                *self = self.exaggerated_or_not();
                Some(match self.exaggeration {
                    Exaggeration::Fitted => "gap exaggerated by the factor shown".to_owned(),
                    Exaggeration::True => "gap drawn true to scale".to_owned(),
                })
            }
        };
        Ok(message)
    }
}

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
    fn drawn_marker(&self) -> Marker {
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

/// A value at the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reading {
    /// The symbol.
    pub symbol: &'static str,
    /// The number, if any.
    pub number: Option<String>,
    pub(crate) unit: &'static str,
}

impl Reading {
    /// The width for any number in any unit of its kind, with a symbol of a width.
    #[must_use]
    pub(crate) fn width(&self, symbol: usize) -> usize {
        let unit = if self.unit.is_empty() { 0 } else { 1 + widest_beside(self.unit) };
        symbol + 1 + NUMBER + unit
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.number {
            None => write!(f, "{} {NONE}", self.symbol),
            Some(number) if self.unit.is_empty() => write!(f, "{} {number}", self.symbol),
            Some(number) => write!(f, "{} {number} {}", self.symbol, self.unit),
        }
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
    let plot = Rect { height: area.height.saturating_sub(lines), ..area };
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
    scene::draw_strokes(&scene, picture, plot, buffer);
    let _ = Labels::new(plot).draw(&scene, picture, buffer);
}

/// Every value of the method at a contact state, and the opening, in a fixed order.
#[must_use]
pub fn readings(
    moment: &ContactState,
    solved: (&Inputs, &Solution),
    system: System,
) -> Vec<Reading> {
    keys()
        .filter_map(|key| {
            if key == OPEN {
                Some(open(moment, system))
            } else {
                reading(moment, key, solved, system)
            }
        })
        .collect()
}

/// The values at the cursor, in lines.
fn values(picture: &Picture, moment: Option<&ContactState>, width: u16) -> Vec<String> {
    let ascii = picture.look.ascii;
    let values = moment
        .map(|moment| readings(moment, (picture.inputs, picture.solution), picture.units))
        .unwrap_or_default();
    let values = values.iter().map(|reading| {
        let cells = reading.width(symbol(reading.symbol, ascii).width());
        (symbol(&reading.to_string(), ascii).into_owned(), cells)
    });
    reading_lines(values, usize::from(width.saturating_sub(1)))
}

/// The displayed values: the driver's angle, those of the charts in their order, the others. The
/// opening precedes the gap, which includes it.
fn keys() -> impl Iterator<Item = &'static str> {
    let shown = GRAPHS.iter().filter(|graph| graph.is_at(Place::Teeth));
    let of_charts = shown.flat_map(|graph| graph.columns.iter().copied());
    let of_charts = of_charts.flat_map(|key| {
        let before = (key == GAP).then_some(OPEN);
        before.into_iter().chain([key])
    });
    let has_chart = |key: &str| GRAPHS.iter().any(|graph| graph.columns.contains(&key));
    let others = COLUMNS.iter().map(|column| column.key);
    let mut others = others.filter(move |key| !has_chart(key));
    others.next().into_iter().chain(of_charts).chain(others)
}

fn open(moment: &ContactState, system: System) -> Reading {
    let (number, unit) = shown(moment.opening, "um", GAP_DIGITS, system);
    Reading { symbol: OPEN, number: Some(number), unit }
}

fn reading(
    moment: &ContactState,
    key: &str,
    (inputs, solution): (&Inputs, &Solution),
    system: System,
) -> Option<Reading> {
    let column: &Column = COLUMNS.iter().find(|column| column.key == key)?;
    let interpolated = moment.interpolated.as_ref().and_then(|one| column.of(&one.station));
    let value = interpolated.or_else(|| without_contact(moment, key));
    if value.is_none() && !column.methods.contains(&solution.method) {
        return None;
    }
    let digits = moment
        .interpolated
        .as_ref()
        .map_or(column.digits, |interpolated| column.digits_of(interpolated));
    let usual = if column.shown == "1" { "" } else { system.unit(column.shown) };
    let (number, unit) = value.map_or((None, usual), |value| {
        let (number, unit) =
            shown(column.resolved(value, inputs, solution), column.shown, digits, system);
        (Some(number), unit)
    });
    Some(Reading { symbol: column.symbol, number, unit })
}

/// The value from the involutes, if the method has none.
fn without_contact(moment: &ContactState, key: &str) -> Option<f64> {
    match key {
        "roll_angle_driver" => Some(moment.roll_angle_driver),
        "roll_angle_driven" => Some(moment.roll_angle_driven),
        "radius_driver" => Some(moment.radius_driver),
        "normal_velocity" => Some(moment.normal_velocity),
        "sliding_velocity" => Some(moment.sliding_velocity),
        "gap" => Some(moment.gap),
        _ => None,
    }
}

/// The values in lines of at most a width. Each value has a fixed width, and two blanks separate
/// the values.
#[must_use]
fn reading_lines(values: impl Iterator<Item = (String, usize)>, width: usize) -> Vec<String> {
    let mut lines: Vec<(String, usize)> = Vec::new();
    for (value, cells) in values {
        match lines.last_mut() {
            Some((line, end)) if *end + 2 + cells <= width => {
                // A longer number uses the blanks after it.
                let gap = (*end + 2).saturating_sub(line.width()).max(1);
                line.push_str(&" ".repeat(gap));
                line.push_str(&value);
                *end += 2 + cells;
            }
            _ => lines.push((value, cells)),
        }
    }
    lines.into_iter().map(|(line, _)| line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_keeps_its_place_if_others_change() {
        let line = |numbers: [Option<&str>; 2]| {
            let readings = numbers.map(|number| Reading {
                symbol: "F_S",
                number: number.map(str::to_owned),
                unit: "N",
            });
            reading_lines(
                readings.iter().map(|reading| (reading.to_string(), reading.width(3))),
                40,
            )
        };
        assert_eq!(line([Some("2191.0"), Some("1")]), ["F_S 2191.0 N    F_S 1 N"]);
        assert_eq!(line([None, Some("1")]), ["F_S –           F_S 1 N"]);
        assert_eq!(line([Some("-0.12345"), Some("1")]), ["F_S -0.12345 N  F_S 1 N"]);
    }
}
