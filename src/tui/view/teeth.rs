//! The teeth pane: the pair true to scale, and the values at the cursor.

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

const NOTHING: &str = "  This method has no valid results.";

/// Draws the pane.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let stale = if app.is_stale() { "LAST VALID, " } else { "" };
    let title = format!(
        "{stale}Teeth, true to scale, around {}",
        app.teeth.centre.name()
    );
    let inner = titled(app, Pane::Teeth, &title, area, buffer);
    let Some((inputs, solution)) = solved(app) else {
        buffer.set_stringn(inner.x, inner.y, NOTHING, inner.width.into(), Style::new());
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

/// The pair that the active method solved last, and its results.
#[must_use]
pub fn solved(app: &App) -> Option<(&Inputs, &Solution)> {
    let answer = app.answer.as_ref()?;
    Some((&answer.inputs, answer.of(answer.active)?))
}
