//! The axes of a chart: the area of the plot, ticks with labels, and the marks of the contact.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::Charts;
use super::range::last_contact;
use crate::model::Solution;
use crate::model::contact_state::first_contact_of_driver as first_contact;
use crate::tui::panes::plot::{Span, Ticks, put_where_free};

/// Least width of the labels beside the plot, in columns.
const LABEL: usize = 6;
/// Least distance of labels: columns below the plot, and rows beside it.
const ROOM: (u16, u16) = (9, 2);
/// The smallest plot.
const LEAST_COLUMNS: u16 = 20;
const LEAST_ROWS: u16 = 2;
/// Longest time in us; longer times are in ms.
const MOST_MICROS: f64 = 5000.0;

/// The direction of time on the axis, the longest text first.
const TIME: [&str; 3] = [" time -> ", "time ->", "->"];

/// Names of the time axis.
const TIME_LABELS: [&str; 2] = ["time after E", "time"];

/// The quantity of the x axis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Ruler {
    /// The axis value of one degree of roll after E.
    pub(crate) factor: f64,
    pub(crate) unit: &'static str,
    /// The name, the longest form first.
    pub(crate) labels: &'static [&'static str],
}

/// The axes of a chart, with their areas on the screen.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Axes {
    /// The plot with the axes and their labels.
    pub(crate) area: Rect,
    /// The cells of the curves.
    pub(crate) plot: Rect,
    /// The visible roll angles, in deg after E.
    pub(crate) across: Span,
    /// The visible values.
    pub(crate) upright: Span,
    /// Ticks below the plot, in the unit of the ruler.
    pub(crate) below: Ticks,
    /// Ticks beside the plot.
    pub(crate) beside: Ticks,
    /// The quantity of the x axis.
    pub(crate) ruler: Ruler,
}

impl Ruler {
    /// The driver's angle before E, or the time after E at the driver's speed in rad/s.
    #[must_use]
    pub(crate) fn of(by_time: bool, speed: f64, window: Span) -> Ruler {
        let micros = 1f64.to_radians() / speed * 1e6;
        let longest = micros * window.from.abs().max(window.to.abs());
        match by_time {
            false => Ruler {
                factor: -1.0,
                unit: "deg",
                labels: &[
                    "driver roll angle before E",
                    "roll angle before E",
                    "roll angle",
                    "angle",
                ],
            },
            true if longest < MOST_MICROS => {
                Ruler { factor: micros, unit: "us", labels: &TIME_LABELS }
            }
            true => Ruler { factor: 1e-3 * micros, unit: "ms", labels: &TIME_LABELS },
        }
    }

    fn ticks(self, window: Span, width: u16) -> Ticks {
        let ends = (window.from * self.factor, window.to * self.factor);
        Span::new(ends.0.min(ends.1), ends.0.max(ends.1)).ticks(width / ROOM.0)
    }
}

/// The columns of the labels of several axes of the same height.
#[must_use]
pub(crate) fn margin(uprights: impl Iterator<Item = Span>, height: u16) -> u16 {
    let labels = uprights.flat_map(|span| beside(span, height).labelled);
    labels.map(|(_, label)| label.len()).max().unwrap_or(0).max(LABEL) as u16 + 2
}

fn beside(span: Span, height: u16) -> Ticks {
    span.ticks(height.saturating_sub(1) / ROOM.1)
}

impl Axes {
    /// The axes in an area with a margin for labels. The plot is empty if the area is too small.
    #[must_use]
    pub(crate) fn new(
        area: Rect,
        margin: u16,
        (across, upright): (Span, Span),
        ruler: Ruler,
    ) -> Axes {
        let (width, height) =
            (area.width.saturating_sub(margin + 1), area.height.saturating_sub(2));
        let has_room = width >= LEAST_COLUMNS && height >= LEAST_ROWS;
        let plot = if has_room {
            Rect { x: area.x + margin, y: area.y, width, height }
        } else {
            Rect::ZERO
        };
        Axes {
            area,
            plot,
            across,
            upright,
            below: ruler.ticks(across, width),
            beside: beside(upright, height),
            ruler,
        }
    }

    /// Removes rows at the top, at most all but two of the plot. Returns these rows and the axes
    /// below them.
    #[must_use]
    pub(crate) fn split(&self, rows: u16) -> (Rect, Axes) {
        let rows = rows.min(self.plot.height.saturating_sub(LEAST_ROWS));
        let above = Rect { height: rows, ..self.plot };
        let area = Rect { y: self.area.y + rows, height: self.area.height - rows, ..self.area };
        let margin = self.plot.x - self.area.x;
        let spans = (self.across, self.upright);
        (above, Axes::new(area, margin, spans, self.ruler))
    }

    /// The column of a visible angle.
    #[must_use]
    pub(crate) fn column(&self, x: f64) -> Option<u16> {
        let part = self.across.part(x);
        let rounding = 1e-9;
        (-rounding..=1.0 + rounding).contains(&part).then(|| {
            self.plot.x
                + (f64::from(self.plot.width.saturating_sub(1)) * part.clamp(0.0, 1.0)).round()
                    as u16
        })
    }

    /// The angle on a column.
    #[must_use]
    pub(crate) fn angle(&self, column: u16) -> f64 {
        let part =
            f64::from(column.saturating_sub(self.plot.x)) / f64::from(self.plot.width.max(2) - 1);
        self.across.from + part * self.across.length()
    }

    fn row(&self, y: f64) -> u16 {
        let dots = 4 * self.plot.height;
        let dot =
            ((1.0 - self.upright.part(y)).clamp(0.0, 1.0) * f64::from(dots - 1)).round() as u16;
        self.plot.y + dot / 4
    }

    /// Draws lines, ticks and labels.
    pub(crate) fn draw(&self, buffer: &mut Buffer) {
        let plot = self.plot;
        let (left, axis) = (plot.x - 1, plot.bottom());
        buffer.set_string(left, axis, "└", Style::new());
        buffer.set_string(plot.x, axis, "─".repeat(plot.width.into()), Style::new());
        for y in plot.top()..axis {
            buffer.set_string(left, y, "│", Style::new());
        }
        let mut last = None;
        for (value, label) in &self.beside.labelled {
            let (y, room) = (self.row(*value), label.len() as u16 + 1);
            if last.replace(y) == Some(y) {
                continue;
            }
            buffer.set_string(left.saturating_sub(room), y, label, Style::new());
            buffer.set_string(left, y, "┤", Style::new());
        }
        let mut free = 0;
        for (column, label) in self.labels_below() {
            buffer.set_string(column, axis, "┴", Style::new());
            let width = label.len() as u16;
            let x = column.saturating_sub(width / 2).min((plot.right() + 1).saturating_sub(width));
            if x >= free {
                buffer.set_string(x, axis + 1, label, Style::new());
                free = x + width + 1;
            }
        }
    }

    // The labels below the plot, from left to right.
    fn labels_below(&self) -> Vec<(u16, &str)> {
        let ticks = self.below.labelled.iter();
        let mut labels: Vec<_> = ticks
            .filter_map(|(value, label)| {
                Some((self.column(value / self.ruler.factor)?, label.as_str()))
            })
            .collect();
        labels.sort_by_key(|(column, _)| *column);
        labels
    }

    /// Draws a faint line at 0 on blank cells, if the values have both signs.
    pub(crate) fn draw_zero(&self, charts: &Charts, buffer: &mut Buffer) {
        if self.upright.from < 0.0 && self.upright.to > 0.0 {
            let y = self.row(0.0);
            for x in self.plot.left()..self.plot.right() {
                put_where_free((x, y), "┄", charts.look.theme.faint, buffer);
            }
        }
    }

    /// Draws the marks of the contact on the axis: D of the other methods, B, the last contact L, E
    /// and D.
    pub(crate) fn draw_marks(&self, charts: &Charts, buffer: &mut Buffer) {
        let Some(answer) = charts.answer else { return };
        let theme = charts.look.theme;
        let others = answer
            .methods
            .iter()
            .filter(|(method, _)| *method != answer.active)
            .filter_map(|(_, found)| found.as_ref().ok());
        let struck = others
            .filter_map(first_contact)
            .map(|angle| (0.0 - angle.to_degrees(), "d", theme.other));
        let own = answer.of(answer.active).map(marks).unwrap_or_default();
        for (x, name, style) in
            struck.chain(own.into_iter().map(|(x, name)| (x, name, theme.active)))
        {
            if let Some(column) = self.column(x) {
                buffer.set_string(column, self.plot.bottom(), name, style);
            }
        }
    }

    /// Draws a dotted line on blank cells outside the legend, and a mark on the axis.
    pub(crate) fn draw_cursor(
        &self,
        charts: &Charts,
        is_legend: impl Fn(Position) -> bool,
        buffer: &mut Buffer,
    ) {
        let column = charts.cursor.and_then(|cursor| self.column(0.0 - cursor.to_degrees()));
        let Some(x) = column else { return };
        for y in self.plot.top()..self.plot.bottom() {
            if !is_legend(Position::new(x, y)) {
                put_where_free((x, y), "┊", charts.look.theme.faint, buffer);
            }
        }
        buffer.set_string(x, self.plot.bottom(), "▴", charts.look.theme.focus);
    }

    /// Draws the direction of time on the axis between its ticks and marks.
    pub(crate) fn draw_time_direction(&self, buffer: &mut Buffer) {
        let y = self.plot.bottom();
        let is_line = |x: u16| buffer.cell((x, y)).is_some_and(|cell| cell.symbol() == "─");
        let place = |text: &&str| {
            let width = text.len() as u16;
            (self.plot.left()..=self.plot.right().saturating_sub(width))
                .rev()
                .find(|&x| (x..x + width).all(is_line))
        };
        let found = TIME.into_iter().find_map(|text| Some((text, place(&text)?)));
        if let Some((text, x)) = found {
            buffer.set_string(x, y, text, Style::new());
        }
    }
}

// B, the end of the path of contact; L, the last contact; E; D.
fn marks(solution: &Solution) -> Vec<(f64, &'static str)> {
    let geometry = &solution.geometry;
    let end = ((geometry.start - geometry.end) / geometry.driver.base, "B");
    let last = last_contact(solution).map(|angle| (angle, "L"));
    let first = first_contact(solution).map(|angle| (angle, "D"));
    let found = [Some(end), last, Some((0.0, "E")), first];
    found.into_iter().flatten().map(|(angle, name)| (0.0 - angle.to_degrees(), name)).collect()
}
