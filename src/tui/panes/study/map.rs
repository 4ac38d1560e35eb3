//! A quantity over two fields: a cell for each point, contours of the limit and of no contact.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use super::{NO_CONTACT, REFUSED, StudyPane, cursor, range};
use crate::model::{Outcome, Quantity};
use crate::report::chart::{Axis, Span};
use crate::report::{common_unit, shown_with};
use crate::study::axis::Axis as StudyAxis;
use crate::study::batch::PointOutcome;
use crate::tui::panes::plot::{Plot, Words, draw_legend, label_margin};
use crate::tui::study::{LayerFound, StudyResults};

/// Shades from the least to the greatest value.
const SHADES: [&str; 5] = ["∙", "░", "▒", "▓", "█"];
/// The sign of the limit; the next sign marks the edge of contact.
const LIMIT: &str = "+";
const EDGE: &str = "o";

struct Map<'a> {
    pane: &'a StudyPane<'a>,
    found: &'a LayerFound,
    across: &'a StudyAxis,
    up: &'a StudyAxis,
    cells: Rect,
    values: Span,
    limit: Option<f64>,
}

pub(super) fn draw(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    (across, up): (&StudyAxis, &StudyAxis),
    area: Rect,
    buffer: &mut Buffer,
) {
    let (Some(found), Some(known)) = (shown.layers.first(), shown.quantity()) else {
        return;
    };
    let all = || found.values.iter().flatten().copied();
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == known.key);
    let mut map = Map {
        pane,
        found,
        across,
        up,
        cells: Rect::ZERO,
        values: Span::of(all()),
        limit: limit.and_then(|limit| limit.bound(|_| None)).filter(|value| value.is_finite()),
    };
    let words = map.legend(known, common_unit(known, all(), pane.units));
    let legend = Rect { height: area.height.saturating_sub(4), ..area };
    let rows = draw_legend(&words, legend, buffer);
    let area = Rect { y: area.y + rows, height: area.height - rows, ..area };
    let spans = (span(across), span(up));
    let up_axis = labelled(up, area.height.saturating_sub(2));
    let margin = label_margin(&up_axis, spans.1, area.height).max(7);
    let plot = Plot::new(area, margin, spans);
    if plot.cells.is_empty() {
        return;
    }
    map.cells = plot.cells;
    let across_axis = labelled(across, plot.cells.width);
    plot.draw_axes(&across_axis, &up_axis, pane.look.theme, buffer);
    for (column, row) in positions(plot.cells) {
        let (symbol, style) = map.cell(column, row);
        buffer.set_string(plot.cells.x + column, plot.cells.y + row, symbol, style);
    }
    map.marks(shown, buffer);
}

fn span(axis: &StudyAxis) -> Span {
    Span::new(0.0, axis.points.len().saturating_sub(1) as f64)
}

/// The indices of the points of an axis with this many cells: labels at both ends and, if there is
/// room, in the middle.
fn labelled(axis: &StudyAxis, cells: u16) -> Axis {
    let last = axis.points.len().saturating_sub(1);
    let middle = Some(last / 2).filter(|&middle| cells >= 5 && middle > 0 && middle < last);
    let points = [Some(0), middle, Some(last)].into_iter().flatten();
    let labels = points.map(|at| (at as f64, axis.points[at].text.clone())).collect();
    Axis { labels, ..Axis::new("", axis.unit.clone()) }
}

fn positions(cells: Rect) -> impl Iterator<Item = (u16, u16)> {
    (0..cells.height).flat_map(move |row| (0..cells.width).map(move |column| (column, row)))
}

impl Map<'_> {
    /// The point nearest to a cell; the first and the last cell show the ends.
    fn at(cell: u16, cells: u16, points: usize) -> usize {
        let last = f64::from(cells.max(2) - 1);
        (f64::from(cell) / last * (points - 1) as f64).round() as usize
    }

    /// The cell of a point.
    fn of(point: usize, cells: u16, points: usize) -> u16 {
        let last = (points.max(2) - 1) as f64;
        (point as f64 / last * f64::from(cells - 1)).round() as u16
    }

    fn index(&self, column: u16, row: u16) -> usize {
        let x = Map::at(column, self.cells.width, self.across.points.len());
        let below = self.cells.height - 1 - row;
        let y = Map::at(below, self.cells.height, self.up.points.len());
        y * self.across.points.len() + x
    }

    /// The outcome and the value of a cell.
    fn point(&self, column: u16, row: u16) -> Option<(PointOutcome, Option<f64>)> {
        let at = self.index(column, row);
        Some((*self.found.outcomes.get(at)?, *self.found.values.get(at)?))
    }

    fn cell(&self, column: u16, row: u16) -> (&'static str, Style) {
        let theme = self.pane.look.theme;
        let is_above =
            |value: Option<f64>| value.zip(self.limit).is_some_and(|(one, limit)| one > limit);
        let has_beside = |is: &dyn Fn((PointOutcome, Option<f64>)) -> bool| {
            let mut beside = self.beside(column, row);
            beside.any(|(column, row)| self.point(column, row).is_some_and(is))
        };
        let Some((outcome, value)) = self.point(column, row) else {
            return (" ", Style::new());
        };
        let strikes = PointOutcome::Solved(Outcome::CornerContact);
        match (outcome, value) {
            (PointOutcome::Refused, _) => (REFUSED, theme.problem),
            // Above the limit, beside a point that is not.
            _ if is_above(value) && has_beside(&|(_, beside)| !is_above(beside)) => {
                (LIMIT, theme.problem)
            }
            (_, Some(value)) => (self.shade(value), theme.active),
            (PointOutcome::Solved(Outcome::CornerContact), None) => (" ", Style::new()),
            _ if has_beside(&|(beside, _)| beside == strikes) => (EDGE, theme.note),
            _ => (NO_CONTACT, theme.note),
        }
    }

    fn shade(&self, value: f64) -> &'static str {
        let part = if self.values.is_empty() { 0.5 } else { self.values.part(value) };
        SHADES[((part * SHADES.len() as f64) as usize).min(SHADES.len() - 1)]
    }

    fn beside(&self, column: u16, row: u16) -> impl Iterator<Item = (u16, u16)> + use<> {
        let (width, height) = (self.cells.width, self.cells.height);
        let steps = [(-1, 0), (1, 0), (0, -1), (0, 1)];
        steps.into_iter().filter_map(move |(x, y)| {
            let column = column.checked_add_signed(x).filter(|column| *column < width)?;
            let row = row.checked_add_signed(y).filter(|row| *row < height)?;
            Some((column, row))
        })
    }

    /// Draws the present values on the axes, and the cursor.
    fn marks(&self, shown: &StudyResults, buffer: &mut Buffer) {
        let (cells, theme) = (self.cells, self.pane.look.theme);
        let column = |at| cells.x + Map::of(at, cells.width, self.across.points.len());
        let row = |at| cells.bottom() - 1 - Map::of(at, cells.height, self.up.points.len());
        let case = self.pane.case;
        let now = range::nearest(self.across, case).zip(range::nearest(self.up, case));
        if let Some((x, y)) = now {
            buffer.set_string(column(x), row(y), "●", theme.focus);
        }
        let (x, y) = cursor(self.pane, shown);
        if let Some(cell) = buffer.cell_mut((column(x), row(y))) {
            cell.modifier |= Modifier::REVERSED;
        }
        buffer.set_string(column(x), cells.bottom(), "▴", theme.focus);
        buffer.set_string(cells.x - 1, row(y), "▸", theme.focus);
    }

    fn legend(&self, known: &Quantity, unit: &'static str) -> Vec<Words> {
        let theme = self.pane.look.theme;
        let worded = |value| shown_with(known, value, unit).to_string();
        let has = |sought| self.found.outcomes.contains(&sought);
        let mut words = Vec::new();
        if self.values.from <= self.values.to {
            for value in [self.values.from, self.values.to] {
                words.push((format!("{} {}", self.shade(value), worded(value)), theme.active));
            }
        }
        if let Some(limit) = self.limit {
            words.push((format!("{LIMIT} limit {}", worded(limit)), theme.problem));
        }
        if has(PointOutcome::Solved(Outcome::NoCornerContact)) {
            words.push((format!("{EDGE} edge of contact"), theme.note));
            words.push((format!("{NO_CONTACT} no contact"), theme.note));
        }
        if has(PointOutcome::Refused) {
            words.push((format!("{REFUSED} refused"), theme.problem));
        }
        words.push(("● now".to_owned(), theme.focus));
        words
    }
}
