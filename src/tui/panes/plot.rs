//! Parts of every plot: positions of values, curves, axes and marks.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Line, Points};

use crate::report::charts::Point;
use crate::tui::scale::{Span, bounds};

/// The marker and the style of a curve.
pub(crate) type Look = (Marker, Style);

/// Colour that marks the cells of a curve until they get its style.
const OWN: Color = Color::Indexed(1);

/// The cells of a plot and the ranges of its axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlotArea {
    pub(crate) cells: Rect,
    pub(crate) across: Span,
    pub(crate) upright: Span,
}

impl PlotArea {
    /// The column of a value, if it is in the range.
    pub(crate) fn column(&self, x: f64) -> Option<u16> {
        let part = self.across.part(x);
        let width = f64::from(self.cells.width.saturating_sub(1));
        (-1e-9..=1.0 + 1e-9)
            .contains(&part)
            .then(|| self.cells.x + (width * part.clamp(0.0, 1.0)).round() as u16)
    }

    /// The row of a value, or the nearest row.
    pub(crate) fn row(&self, y: f64) -> u16 {
        let height = f64::from(self.cells.height) - 1e-6;
        let part = (1.0 - self.upright.part(y)).clamp(0.0, 1.0);
        self.cells.y + (part * height).floor() as u16
    }

    /// Draws curves that are compared with each other: the columns of cells that several curves
    /// cross alternate between these curves, so that each of them is visible without colour.
    pub(crate) fn draw_compared(&self, curves: &[(Vec<Vec<Point>>, Look)], buffer: &mut Buffer) {
        let layer = |(pieces, look): &(Vec<Vec<Point>>, Look)| {
            let mut layer = Buffer::empty(self.cells);
            self.draw_pieces(pieces, *look, &mut layer);
            layer
        };
        let layers: Vec<Buffer> = curves.iter().map(layer).collect();
        for position in self.cells.positions() {
            let drawn = layers.iter().filter_map(|layer| layer.cell(position));
            let drawn: Vec<&Cell> = drawn.filter(|cell| cell.symbol() != " ").collect();
            let turn = usize::from(position.x) % drawn.len().max(1);
            if let (Some(own), Some(cell)) = (drawn.get(turn), buffer.cell_mut(position)) {
                *cell = (*own).clone();
            }
        }
    }

    /// Draws the pieces of a curve; a piece with one point is a dot.
    pub(crate) fn draw_pieces(
        &self,
        pieces: &[Vec<Point>],
        (marker, style): Look,
        buffer: &mut Buffer,
    ) {
        let canvas = Canvas::default()
            .marker(marker)
            .x_bounds(widened(self.across))
            .y_bounds(widened(self.upright))
            .paint(|context| {
                for piece in pieces {
                    context.draw(&Points {
                        coords: if piece.len() == 1 { piece } else { &[] },
                        color: OWN,
                    });
                    for ends in piece.windows(2) {
                        context.draw(&Line::new(ends[0].0, ends[0].1, ends[1].0, ends[1].1, OWN));
                    }
                }
            });
        canvas.render(self.cells, buffer);
        for position in self.cells.positions() {
            if let Some(cell) = buffer.cell_mut(position) {
                finish(cell, style);
            }
        }
    }
}

// The bounds include points that are on an end within rounding.
fn widened(span: Span) -> [f64; 2] {
    let rounding = 1e-8 * span.length();
    bounds(span.from - rounding, span.to + rounding)
}

// A half block has two colours, for its upper and its lower half.
fn finish(cell: &mut Cell, style: Style) {
    if cell.fg != OWN && cell.bg != OWN {
        return;
    }
    if cell.bg == OWN {
        cell.set_symbol("█");
    }
    (cell.fg, cell.bg) = (Color::Reset, Color::Reset);
    cell.modifier = Modifier::empty();
    cell.set_style(style);
}

/// Draws the lines left of the cells and below them. Returns their column and their row.
pub(crate) fn draw_axes(cells: Rect, rule: Style, buffer: &mut Buffer) -> (u16, u16) {
    let (left, bottom) = (cells.x - 1, cells.bottom());
    for y in cells.top()..bottom {
        buffer.set_string(left, y, "│", rule);
    }
    buffer.set_string(left, bottom, "└", rule);
    buffer.set_string(cells.x, bottom, "─".repeat(cells.width.into()), rule);
    (left, bottom)
}

/// Writes into a cell if it is blank.
pub(crate) fn put_where_free(at: (u16, u16), symbol: &str, style: Style, buffer: &mut Buffer) {
    if buffer.cell(at).is_some_and(|cell| cell.symbol() == " ") {
        buffer.set_string(at.0, at.1, symbol, style);
    }
}
