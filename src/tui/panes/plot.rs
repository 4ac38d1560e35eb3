//! Parts of every plot: positions of values, curves, axes and marks.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::widgets::Widget;
use ratatui::widgets::canvas::{Canvas, Line, Points};

use crate::report::charts::Point;

/// Ends of an axis that begins at 0, times a power of ten.
const ENDS: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
/// With this number of additional intervals an axis always has two ticks.
const CLOSER: u16 = 4;
/// Steps from tick to tick, times a power of ten.
const STEPS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// The axis shrinks if the curve fills a smaller fraction of it. An end is at most 1.5 times the
/// previous end, so that a curve that has just left its axis fills two thirds of the next axis.
const TOO_SMALL: f64 = 0.5;

/// The axis does not include 0 if the least value exceeds this fraction of the greatest value.
const FAR_FROM_ZERO: f64 = 0.5;

/// A value below this fraction of the greatest value is a rounding error of 0.
const NOTHING: f64 = 1e-9;

/// The axis includes 0 if the values differ by a smaller fraction, which the labels could not show.
const ALIKE: f64 = 1e-3;

/// Colour that marks the cells of a curve until they get its style.
const OWN: Color = Color::Indexed(1);

/// A range of values.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Span {
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
}

/// Ticks of an axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Ticks {
    /// The values of the ticks, with their labels.
    pub(crate) labelled: Vec<(f64, String)>,
    /// The labels are multiples of ten to this power.
    pub(crate) power: i32,
}

impl Span {
    /// The empty range.
    pub(crate) const NONE: Span = Span { from: f64::INFINITY, to: f64::NEG_INFINITY };

    /// The range between two ends.
    #[must_use]
    pub(crate) fn new(from: f64, to: f64) -> Span {
        Span { from, to }
    }

    #[must_use]
    pub fn length(self) -> f64 {
        self.to - self.from
    }

    /// Whether the range is empty or a single point.
    #[must_use]
    pub(crate) fn is_empty(self) -> bool {
        self.length().is_nan() || self.length() <= 0.0
    }

    /// The range extended to a point.
    #[must_use]
    pub(crate) fn with(self, value: f64) -> Span {
        Span { from: self.from.min(value), to: self.to.max(value) }
    }

    /// The range that covers both.
    #[must_use]
    pub(crate) fn and(self, other: Span) -> Span {
        Span { from: self.from.min(other.from), to: self.to.max(other.to) }
    }

    /// Whether the range contains the other.
    #[must_use]
    pub fn covers(self, other: Span) -> bool {
        self.from <= other.from && other.to <= self.to
    }

    /// The position of a value, 0 at the lower end and 1 at the upper end.
    #[must_use]
    pub(crate) fn part(self, value: f64) -> f64 {
        if self.is_empty() { 0.0 } else { (value - self.from) / self.length() }
    }

    /// The range, shifted into a longer one.
    #[must_use]
    pub(crate) fn within(self, other: Span) -> Span {
        let from = self.from.min(other.to - self.length()).max(other.from);
        Span { from, to: (from + self.length()).min(other.to) }
    }

    /// An axis that covers the values. Keeps this axis while it fits.
    #[must_use]
    pub(crate) fn fitted(self, values: Span) -> Span {
        self.fitted_from(values, FAR_FROM_ZERO)
    }

    /// An axis that covers the values and includes 0 only if they have both signs or are alike, so
    /// that the differences of compared curves are visible. Keeps this axis while it fits.
    #[must_use]
    pub(crate) fn fitted_closely(self, values: Span) -> Span {
        self.fitted_from(values, 0.0)
    }

    fn fitted_from(self, values: Span, far_from_zero: f64) -> Span {
        if !(values.from.is_finite() && values.to.is_finite()) {
            return self;
        }
        let needed = with_zero(values, far_from_zero);
        let serves =
            self.covers(needed) && needed.length() >= TOO_SMALL * self.length() && !self.is_empty();
        let is_alike = |side: fn(Span) -> bool| side(self) == side(needed);
        let sides: [fn(Span) -> bool; 3] =
            [|span| span.from > 0.0, |span| span.from < 0.0, |span| span.to > 0.0];
        if serves && sides.into_iter().all(is_alike) { self } else { rounded(needed) }
    }

    /// A new axis that covers the values, or this axis if there are no values.
    #[must_use]
    pub(crate) fn refit(self, values: Span) -> Span {
        let fitted = Span::default().fitted(values);
        if fitted.is_empty() { self } else { fitted }
    }

    /// An axis that covers the values and never shrinks.
    #[must_use]
    pub(crate) fn grown(self, values: Span) -> Span {
        if self.covers(values) && !self.is_empty() { self } else { self.fitted(values) }
    }

    /// Ticks at multiples of 1, 2 or 5, with at most `most` intervals but at least two ticks.
    #[must_use]
    pub(crate) fn ticks(self, most: u16) -> Ticks {
        let greatest = self.from.abs().max(self.to.abs());
        let intervals =
            (most.max(1)..=most.max(1) + CLOSER).map(|most| self.length() / f64::from(most));
        let mut steps = intervals.map(|step| round_up(step, &STEPS));
        let step = steps
            .find(|step| (self.to / step + 1e-6).floor() - (self.from / step - 1e-6).ceil() >= 1.0);
        let Some(step) =
            step.filter(|step| (1e-250..1e250).contains(&greatest) && *step > 1e-12 * greatest)
        else {
            return Ticks::default();
        };
        let power = power(greatest);
        let unit = 10f64.powi(power);
        let decimals = (-(step / unit * (1.0 + 1e-9)).log10().floor()).max(0.0) as usize;
        let first = (self.from / step - 1e-6).ceil() as i64;
        let last = (self.to / step + 1e-6).floor() as i64;
        let tick = |count: i64| {
            let value = count as f64 * step;
            (
                value,
                if count == 0 { "0".to_owned() } else { format!("{:.decimals$}", value / unit) },
            )
        };
        Ticks { labelled: (first..=last).map(tick).collect(), power }
    }
}

/// Valid bounds of a canvas: finite, in order, never equal.
#[must_use]
pub(in crate::tui) fn bounds(from: f64, to: f64) -> [f64; 2] {
    let sound = |value: f64| {
        if value.is_finite() { value.clamp(-1e100, 1e100) } else { 0.0 }
    };
    let (from, to) = (sound(from).min(sound(to)), sound(from).max(sound(to)));
    let pad = if from < to { 0.0 } else { 1f64.max(from.abs()) };
    [from - pad, to + pad]
}

/// The marker and the style of a curve.
pub(crate) type Look = (Marker, Style);

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

// Extends the values to 0 unless they are far from it.
fn with_zero(values: Span, far_from_zero: f64) -> Span {
    let least = values.from.abs().min(values.to.abs());
    let greatest = values.from.abs().max(values.to.abs());
    let sound = |value: f64| {
        if value.abs() <= NOTHING * greatest { 0.0 } else { value }
    };
    let values = Span::new(sound(values.from), sound(values.to));
    let one_side = values.from.signum() == values.to.signum();
    let apart = one_side && least > far_from_zero * greatest && values.length() > ALIKE * greatest;
    if apart { values } else { values.with(0.0) }
}

// Rounds the ends: from 0 to a round end, or to multiples of a step.
fn rounded(values: Span) -> Span {
    let end = |value: f64| round_up(value, &ENDS);
    match (values.from, values.to) {
        (0.0, to) => Span::new(0.0, end(to)),
        (from, 0.0) => Span::new(-end(-from), 0.0),
        (from, to) => {
            let step = round_up((to - from) / 16.0, &STEPS);
            Span::new((from / step - 1e-9).floor() * step, (to / step + 1e-9).ceil() * step)
        }
    }
}

// The least round number that is not below the value, at least `LEAST`.
fn round_up(value: f64, round: &[f64]) -> f64 {
    const LEAST: f64 = 1e-30;
    if !value.is_normal() || value < LEAST {
        return LEAST;
    }
    let power = 10f64.powi(value.log10().floor() as i32);
    let step = round.iter().find(|&&step| step * power >= value * (1.0 - 1e-12));
    step.unwrap_or(&10.0) * power
}

// The power of ten of the labels: 0 for up to five digits before the point, otherwise a multiple of
// 3.
fn power(greatest: f64) -> i32 {
    if (0.01..1e5).contains(&greatest) { 0 } else { 3 * (greatest.log10() / 3.0).floor() as i32 }
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn to(value: f64) -> Span {
        Span::new(0.0, value)
    }

    #[test]
    fn an_axis_stays_until_the_curve_leaves_it() {
        for (now, greatest, then) in [
            (0.0, 2191.0, 3000.0),
            (3000.0, 2999.0, 3000.0),
            (3000.0, 1501.0, 3000.0),
            (3000.0, 1499.0, 1500.0),
        ] {
            assert_eq!(to(now).fitted(to(greatest)), to(then));
        }
        assert_eq!(to(2000.0).fitted(to(2001.0)), to(3000.0));
        assert_eq!(to(3000.0).grown(to(100.0)), to(3000.0));
        assert_eq!(to(3000.0).refit(to(1700.0)), to(2000.0));
        assert_eq!(to(3000.0).refit(Span::NONE), to(3000.0));
    }

    #[test]
    fn an_axis_has_both_signs_if_the_curve_has_and_leaves_out_a_distant_zero() {
        assert_eq!(Span::default().fitted(Span::new(-1.366, 24.6)), Span::new(-2.0, 26.0));
        assert_eq!(Span::default().fitted(Span::new(-1.366, 0.0)), Span::new(-1.5, 0.0));
        let fitted = Span::default().fitted(Span::new(47.34, 47.89));
        assert!((fitted.from - 47.3).abs() < 1e-9 && (fitted.to - 47.9).abs() < 1e-9, "{fitted:?}");
        assert_eq!(Span::default().fitted(Span::new(1.0, 1.0)), to(1.0));
        assert_eq!(Span::new(-5.0, 25.0).fitted(Span::new(-1.0, 20.0)), Span::new(-5.0, 25.0));
        assert_eq!(to(3.0).fitted(Span::NONE), to(3.0));
    }

    #[test]
    fn bounds_are_always_valid() {
        let hostile =
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0, -1.0, 5e-324];
        for from in hostile {
            for to in hostile {
                let [low, high] = bounds(from, to);
                assert!(low < high && (high - low).is_finite(), "{from} {to}");
            }
        }
    }

    #[test]
    fn labels_are_short_and_large_numbers_have_a_power() {
        let labels = |from, to, most| {
            let ticks = Span::new(from, to).ticks(most);
            (
                ticks.labelled.into_iter().map(|(_, label)| label).collect::<Vec<_>>().join(" "),
                ticks.power,
            )
        };
        assert_eq!(labels(0.0, 3000.0, 2), ("0 2000".into(), 0));
        assert_eq!(labels(-1.5, 0.0, 8), ("-1.4 -1.2 -1.0 -0.8 -0.6 -0.4 -0.2 0".into(), 0));
        assert_eq!(labels(0.0, 3e5, 3), ("0 100 200 300".into(), 3));
        assert_eq!(labels(0.0, 2e-6, 4), ("0 0.5 1.0 1.5 2.0".into(), -6));
        assert_eq!(labels(47.3, 47.9, 6), ("47.3 47.4 47.5 47.6 47.7 47.8 47.9".into(), 0));
    }

    proptest! {
        #[test]
        fn just_after_a_change_the_axis_stays(from in -1e6..1e6f64, length in 0.0..1e6f64, shrunk in -12..3i32) {
            let length = length * 10f64.powi(shrunk);
            let values = Span::new(from, from + length);
            let axis = Span::default().fitted(values);
            prop_assert!(axis.covers(Span::new(from + 1e-9 * length, from + length * (1.0 - 1e-9))) || length < 1e-9);
            prop_assert_eq!(axis.fitted(values), axis);
        }

        #[test]
        fn ticks_are_multiples_of_1_2_or_5_and_every_label_is_another(
            from in -1e9..1e9f64, length in 1e-4..1.0f64, power in -20..12i32, most in 1..30u16,
        ) {
            let size = 10f64.powi(power);
            let span = Span::new(from * 1e-9 * size, (from * 1e-9 + length) * size);
            let ticks = span.ticks(most);
            let labels: Vec<_> = ticks.labelled.iter().map(|(_, label)| label.clone()).collect();
            prop_assert!((2..=usize::from(most).max(4) + 1).contains(&labels.len()), "{labels:?}");
            let mut distinct = labels.clone();
            distinct.dedup();
            prop_assert_eq!(&labels, &distinct);
            let unit = 10f64.powi(ticks.power);
            for pair in ticks.labelled.windows(2) {
                let step = pair[1].0 - pair[0].0;
                let digit = step / 10f64.powf((step * (1.0 + 1e-6)).log10().floor());
                prop_assert!([1.0, 2.0, 5.0].iter().any(|round| (digit - round).abs() < 1e-3), "{digit}");
            }
            for (value, label) in &ticks.labelled {
                let read: f64 = label.parse().unwrap();
                prop_assert!((read * unit - value).abs() <= 1e-9 * size, "{label} {value}");
                prop_assert!(label != "-0" && label.len() <= 10, "{label}");
            }
        }
    }
}
