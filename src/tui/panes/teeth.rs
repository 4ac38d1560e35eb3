//! The teeth pane: the pair true to scale, and the values at the cursor.

pub(crate) mod ink;
pub(crate) mod labels;
pub(crate) mod path;
pub(crate) mod picture;
pub(crate) mod raster;
pub(crate) mod readings;
pub(crate) mod scene;
pub(crate) mod strokes;
pub(crate) mod window;
pub(crate) mod zoom;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use crate::model::{ContactState, Inputs, Solution};
use crate::tui::ascii::symbol;

use labels::Labels;
use scene::Scene;
use zoom::Exaggeration;

pub use picture::Picture;
pub(crate) use zoom::TeethView;

/// Least width and height of the picture, in cells.
const SMALLEST: (u16, u16) = (12, 4);
/// Least heights of a pane with two and with three lines of values. The number of lines does not
/// depend on the values, so that the picture keeps its size.
const TWO_LINES_FROM: u16 = 13;
const THREE_LINES_FROM: u16 = 20;

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
    raster::draw(&scene, picture, plot, buffer);
    let _ = Labels::new(plot).draw(&scene, picture, buffer);
}

/// The values at the cursor, in lines.
fn values(picture: &Picture, moment: Option<&ContactState>, width: u16) -> Vec<String> {
    let ascii = picture.look.ascii;
    let values = moment
        .map(|moment| readings::readings(moment, (picture.inputs, picture.solution), picture.units))
        .unwrap_or_default();
    let values = values.iter().map(|reading| {
        let cells = reading.width(symbol(reading.symbol, ascii).width());
        (symbol(&reading.to_string(), ascii).into_owned(), cells)
    });
    readings::lines(values, usize::from(width.saturating_sub(1)))
}
