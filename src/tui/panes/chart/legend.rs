//! The legend of a chart: a message and the names of the curves, on cells without curves.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;

use super::Charts;
use super::curves::{Curve, CurveSource};
use super::raster;
use super::readout::base_name;
use crate::model::inputs::ToothCompliance;
use crate::tui::ascii::symbol;

/// The blocks of text of a legend.
#[derive(Debug, Clone, Default)]
pub(crate) struct Legend {
    blocks: Vec<Block>,
}

/// A block of text: unbroken pieces with a number of blank cells between them.
#[derive(Debug, Clone)]
struct Block {
    pieces: Vec<Line<'static>>,
    gap: usize,
}

/// A block with its position.
#[derive(Debug, Clone)]
pub(crate) struct Placed {
    /// The cells of the block.
    pub(crate) area: Rect,
    rows: Vec<Line<'static>>,
}

impl Legend {
    /// The message, if any, and the name of each curve, the active method first.
    #[must_use]
    pub(crate) fn of(charts: &Charts, curves: &[Curve], message: Option<&str>) -> Legend {
        let words = |text: &str| text.split(' ').map(|word| Line::raw(word.to_owned())).collect();
        let message = message.map(|text| Block { pieces: words(text), gap: 1 });
        let names = Block {
            pieces: curves.iter().rev().map(|curve| name(charts, curve)).collect(),
            gap: 2,
        };
        Legend { blocks: message.into_iter().chain([names]).collect() }
    }

    /// Places every block on blank cells of the plot. Returns `None` if a block does not fit.
    #[must_use]
    pub(crate) fn inside(&self, plot: Rect, buffer: &Buffer) -> Option<Vec<Placed>> {
        let mut placed: Vec<Placed> = Vec::new();
        for block in &self.blocks {
            let is_free = |area: Rect| {
                let is_blank = |at| buffer.cell(at).is_some_and(|cell| cell.symbol() == " ");
                placed.iter().all(|other| !other.area.intersects(area))
                    && area.positions().all(is_blank)
            };
            let found = block.free_place(plot, is_free)?;
            placed.push(found);
        }
        Some(placed)
    }

    /// Places the blocks below each other from the top of an area, as many rows as it has.
    #[must_use]
    pub(crate) fn above(&self, area: Rect) -> Vec<Placed> {
        let rows = self.blocks.iter().flat_map(|block| {
            let rows = block.rows(area.width).into_iter();
            rows.map(|row| block.line(row))
        });
        let row = |(row, y)| Placed { area: Rect { y, height: 1, ..area }, rows: vec![row] };
        rows.zip(area.top()..area.bottom()).map(row).collect()
    }

    /// The number of rows that the blocks need below each other.
    #[must_use]
    pub(crate) fn height(&self, width: u16) -> u16 {
        let rows = self.blocks.iter().map(|block| block.rows(width).len());
        u16::try_from(rows.sum::<usize>()).unwrap_or(u16::MAX)
    }
}

impl Placed {
    /// Draws the rows of the block.
    pub(crate) fn draw(&self, buffer: &mut Buffer) {
        for (line, row) in self.rows.iter().zip(self.area.rows()) {
            line.render(row, buffer);
        }
    }
}

impl Block {
    /// The pieces in rows of at most `width` cells, with a blank cell at both ends.
    fn rows(&self, width: u16) -> Vec<Range<usize>> {
        let mut rows: Vec<Range<usize>> = Vec::new();
        for at in 0..self.pieces.len() {
            let has_room = |row: &&mut Range<usize>| self.width(&(row.start..at + 1)) <= width;
            match rows.last_mut().filter(has_room) {
                Some(row) => row.end = at + 1,
                None => rows.push(at..at + 1),
            }
        }
        rows
    }

    fn width(&self, row: &Range<usize>) -> u16 {
        let pieces: usize = self.pieces[row.clone()].iter().map(Line::width).sum();
        (pieces + self.gap * (row.len() - 1) + 2) as u16
    }

    fn line(&self, row: Range<usize>) -> Line<'static> {
        let mut line = Line::raw(" ");
        for (at, piece) in self.pieces[row].iter().enumerate() {
            if at > 0 {
                line.push_span(" ".repeat(self.gap));
            }
            line.extend(piece.spans.iter().cloned());
        }
        line.push_span(" ");
        line
    }

    /// The narrowest rows for each number of rows, the fewest rows first.
    fn layouts(&self, plot: Rect) -> Vec<(Size, Vec<Range<usize>>)> {
        let mut layouts: Vec<(Size, Vec<Range<usize>>)> = Vec::new();
        for width in (1..=plot.width).rev() {
            let rows = self.rows(width);
            let size = Size {
                width: rows.iter().map(|row| self.width(row)).max().unwrap_or(0),
                height: rows.len() as u16,
            };
            if size.width > width || size.height > plot.height {
                break;
            }
            let same = layouts.last_mut().filter(|(last, _)| last.height == size.height);
            match same {
                Some(last) => *last = (size, rows),
                None => layouts.push((size, rows)),
            }
        }
        layouts
    }

    /// The first free place: on the right, the left or in the middle of the outer rows, then of the
    /// other rows, then anywhere.
    fn free_place(&self, plot: Rect, is_free: impl Fn(Rect) -> bool) -> Option<Placed> {
        let layouts = self.layouts(plot);
        let room = |size: Size| (plot.width - size.width, plot.height - size.height);
        let tidy = layouts.iter().flat_map(|(size, rows)| {
            let (right, low) = room(*size);
            let outer = [0, 1.min(low), low, low.saturating_sub(1)];
            outer.into_iter().chain(0..=low).flat_map(move |down| {
                [right, 0, right / 2].map(|across| (*size, rows, (across, down)))
            })
        });
        let anywhere = layouts.iter().flat_map(|(size, rows)| {
            let (right, low) = room(*size);
            (0..=low).flat_map(move |down| {
                (0..=right).rev().map(move |across| (*size, rows, (across, down)))
            })
        });
        tidy.chain(anywhere)
            .map(|(size, rows, (across, down))| {
                let at = Position::new(plot.x + across, plot.y + down);
                (Rect::from((at, size)), rows)
            })
            .find(|(area, _)| is_free(*area))
            .map(|(area, rows)| Placed {
                area,
                rows: rows.iter().map(|row| self.line(row.clone())).collect(),
            })
    }
}

fn model_name(model: ToothCompliance, is_own: bool) -> String {
    let case = if is_own { " (case)" } else { "" };
    format!("{}{case}", model.name())
}

fn name(charts: &Charts, curve: &Curve) -> Line<'static> {
    let name = match curve.source {
        CurveSource::Active(method) | CurveSource::Other(method) => method.name().to_owned(),
        CurveSource::Pinned(method) => base_name(charts, method),
        CurveSource::Model { model, is_own } => model_name(model, is_own),
        CurveSource::Bound(name) => symbol(name, charts.look.ascii).into_owned(),
    };
    let sample = match raster::marker(charts, curve.source) {
        Marker::Custom(letter) => letter.to_string(),
        Marker::Dot => "•".to_owned(),
        Marker::HalfBlock => "▀".to_owned(),
        _ => "⠒".to_owned(),
    };
    Line::from(vec![
        Span::styled(sample, raster::style(charts, curve.source)),
        Span::raw(format!(" {name}")),
    ])
}
