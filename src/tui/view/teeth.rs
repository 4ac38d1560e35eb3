//! The teeth, drawn: the pair true to scale around the strike, with every value at the cursor.

pub mod labels;
pub mod path;
pub mod picture;
pub mod raster;
pub mod readings;
pub mod scene;
pub mod strokes;
pub mod window;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::titled;
use crate::model::{Inputs, Solution};
use crate::tui::app::App;
use crate::tui::pane::Pane;

pub use picture::Picture;

const NOTHING: &str = "  No valid results of this method.";
const NOT_YET: &str = "  No results yet.";

/// Draw the pane.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let stale = if app.shows_last_valid() {
        "LAST VALID, "
    } else {
        ""
    };
    let title = format!(
        "{stale}Teeth, true to scale, around {}",
        app.teeth.centre.name()
    );
    let inner = titled(app, Pane::Teeth, &title, area, buffer);
    let Some((inputs, solution)) = solved(app) else {
        let words = app.answer.as_ref().map_or(NOT_YET, |_| NOTHING);
        buffer.set_stringn(inner.x, inner.y, words, inner.width.into(), Style::new());
        return;
    };
    let picture = Picture {
        inputs,
        solution,
        cursor: app.cursor,
        view: &app.teeth,
        look: app.look,
        marker: app.settings.marker,
        units: app.settings.units,
        is_stale: app.is_stale(),
    };
    picture::draw(&picture, inner, buffer);
}

/// The pair that the active method has solved last, and what it found.
#[must_use]
pub fn solved(app: &App) -> Option<(&Inputs, &Solution)> {
    let answer = app.answer.as_ref()?;
    Some((&answer.inputs, answer.of(answer.active)?))
}
