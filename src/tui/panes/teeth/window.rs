//! The view of the teeth pane (centre, zoom, and exaggeration of the gap), and the visible part of
//! the plane, in m, with its dots on the screen.

use nalgebra::{Point2, Vector2};
use ratatui::layout::Size;
use ratatui::symbols::Marker;

use crate::case::units::System;
use crate::model::contact_state::{Phase, first_contact_point};
use crate::model::outline::on_line_of_action;
use crate::model::{ContactState, Geometry, Inputs, Solution};
use crate::tui::panes::plot::bounds;

/// The height of a cell over its width.
const CELL_HEIGHT: f64 = 2.0;
/// Bounds of the width of a cell, in m. Outside them, differences of coordinates are lost or
/// overflow.
const CELL: (f64, f64) = (1e-12, 1e6);

/// Units of a length, the longest first: factor to m, and name.
const METRIC: [(f64, &str); 4] = [(1.0, "m"), (1e-3, "mm"), (1e-6, "um"), (1e-9, "nm")];
const INCH: [(f64, &str); 2] = [(25.4e-3, "in"), (25.4e-6, "thou")];
/// The least length in inches; shorter lengths are in thou.
const LEAST_INCHES: f64 = 0.1;

/// The least height of the picture around the strike without zoom, in modules and in distances from
/// D to E.
const STRIKE: (f64, f64) = (3.4, 4.0);
/// The height of the picture around the pitch point, relative to the distance from it to the
/// farther end of the path of contact.
const PATH: f64 = 2.4;
/// The last zoom step in. Each step is √2, and the last step shows some micrometres of a typical
/// gear.
const LAST_STEP_IN: i32 = 20;
/// The last zoom step out, enough for two gears of 1000 teeth.
const LAST_STEP_OUT: i32 = -24;
/// The exaggerated deviation as a fraction of the picture's height, and its greatest value in
/// modules.
const SHARE: f64 = 0.1;
const MOST_DEVIATION: f64 = 0.2;
/// The greatest exaggerated opening, in modules.
const MOST_OPENING: f64 = 0.3;
/// The greatest exaggeration.
const MOST_FACTOR: f64 = 1000.0;

/// The visible part of the plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The middle.
    pub(crate) centre: Point2<f64>,
    /// The vector from the middle to the middle of the outermost dot.
    pub(crate) half: Vector2<f64>,
    /// The width of a dot.
    pub dot: f64,
    /// The columns and rows of the screen.
    pub(crate) size: Size,
    /// The dots of a cell, horizontally and vertically.
    pub(super) dots: (u16, u16),
}

impl Window {
    /// The window of a view on a screen with a size. The scale is the same in both directions, and
    /// the window shows as little as possible outside the pair.
    #[must_use]
    pub(crate) fn of(
        view: TeethView,
        inputs: &Inputs,
        solution: &Solution,
        size: Size,
        marker: Marker,
    ) -> Window {
        let geometry = &solution.geometry;
        let dots = dots(marker);
        let span = |cells: u16, dots: u16| (f64::from(cells) - 1.0 / f64::from(dots)).max(0.5);
        let (wide, high) = (span(size.width, dots.0), CELL_HEIGHT * span(size.height, dots.1));
        let (height, width) = whole(geometry);
        let fitting = (width / wide).max(height / high);
        let cell = if view.centre == Centre::Pair {
            fitting * view.extent(inputs, solution) / width
        } else {
            view.extent(inputs, solution) / wide.min(high)
        };
        let cell = cell.min(fitting).max(CELL.0).min(CELL.1);
        let half = Vector2::new(wide, high) * (0.5 * cell);
        let middle = Point2::new(
            0.5 * (geometry.centre_distance + geometry.driven.tip - geometry.driver.tip),
            0.0,
        );
        let held = |at: f64, middle: f64, room: f64| {
            at.max(middle - room.max(0.0)).min(middle + room.max(0.0))
        };
        let at = anchor(view.centre, solution).unwrap_or(middle);
        let centre = Point2::new(
            held(at.x, middle.x, 0.5 * width - half.x),
            held(at.y, middle.y, 0.5 * height - half.y),
        );
        Window { centre, half, dot: cell / f64::from(dots.0), size, dots }
    }

    /// The window of a rectangle with a lower left corner.
    #[must_use]
    pub(crate) fn around(&self, from: Point2<f64>, room: Vector2<f64>) -> Window {
        Window { centre: from + 0.5 * room, half: 0.5 * room, ..*self }
    }

    /// The ends of the x axis.
    #[must_use]
    pub fn across(&self) -> [f64; 2] {
        bounds(self.centre.x - self.half.x, self.centre.x + self.half.x)
    }

    /// The ends of the y axis.
    #[must_use]
    pub fn upright(&self) -> [f64; 2] {
        bounds(self.centre.y - self.half.y, self.centre.y + self.half.y)
    }

    /// Whether a point is visible.
    #[must_use]
    pub(crate) fn sees(&self, point: Point2<f64>) -> bool {
        let off = point - self.centre;
        off.x.abs() <= self.half.x && off.y.abs() <= self.half.y
    }

    /// The distance from a point to the window, 0 inside.
    #[must_use]
    pub(crate) fn distance(&self, point: Point2<f64>) -> f64 {
        let off = point - self.centre;
        Vector2::new((off.x.abs() - self.half.x).max(0.0), (off.y.abs() - self.half.y).max(0.0))
            .norm()
    }

    /// The visible part of a straight line, as fractions of its length (Liang & Barsky 1984).
    pub(crate) fn clip(&self, from: Point2<f64>, to: Point2<f64>) -> Option<(f64, f64)> {
        let (start, way) = (from - self.centre, to - from);
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            for side in [-1.0, 1.0] {
                let (speed, room) = (side * way[axis], self.half[axis] - side * start[axis]);
                if speed > 0.0 {
                    last = last.min(room / speed);
                } else if speed < 0.0 {
                    first = first.max(room / speed);
                } else if room < 0.0 {
                    return None;
                }
            }
        }
        (first <= last).then_some((first, last))
    }

    /// The column and row of a visible point.
    #[must_use]
    pub(crate) fn cell(&self, point: Point2<f64>) -> Option<(u16, u16)> {
        if !self.sees(point) {
            return None;
        }
        let off = point - self.centre;
        let dot = |part: f64, cells: u16, dots: u16| {
            (part * (f64::from(cells) * f64::from(dots) - 1.0)).round() as u16 / dots
        };
        let right = 0.5 * (1.0 + off.x / self.half.x);
        let down = 0.5 * (1.0 - off.y / self.half.y);
        Some((dot(right, self.size.width, self.dots.0), dot(down, self.size.height, self.dots.1)))
    }

    /// Width of a column of the screen.
    #[must_use]
    pub(crate) fn column(&self) -> f64 {
        self.dot * f64::from(self.dots.0)
    }

    /// Height of a row of the screen.
    #[must_use]
    pub(crate) fn row(&self) -> f64 {
        self.column() * CELL_HEIGHT
    }

    #[must_use]
    pub fn dot_height(&self) -> f64 {
        self.row() / f64::from(self.dots.1)
    }
}

/// The view of the teeth pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TeethView {
    /// The point in the middle of the pane.
    pub centre: Centre,
    /// Zoom steps of √2: in above 0, out below.
    pub zoom: i32,
    /// Whether the gap is exaggerated.
    pub exaggeration: Exaggeration,
}

/// The centre of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Centre {
    /// D, or E without corner contact.
    #[default]
    Strike,
    /// The pitch point.
    PitchPoint,
    /// The whole pair.
    Pair,
}

/// The exaggeration of the gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Exaggeration {
    /// By a factor that makes the gap visible.
    #[default]
    Fitted,
    /// True to scale.
    True,
}

impl Centre {
    const ALL: [Centre; 3] = [Centre::Strike, Centre::PitchPoint, Centre::Pair];

    /// The centre `by` places further, wrapping around.
    #[must_use]
    pub(crate) fn beside(self, by: isize) -> Centre {
        let count = Centre::ALL.len();
        Centre::ALL[(self as usize + count).saturating_add_signed(by) % count]
    }

    #[must_use]
    pub(crate) fn name(self) -> &'static str {
        match self {
            Centre::Strike => "the strike",
            Centre::PitchPoint => "the pitch point",
            Centre::Pair => "the pair",
        }
    }
}

impl TeethView {
    /// The view zoomed in by `steps`, or out if negative, at most to the whole pair.
    #[must_use]
    pub fn zoomed(self, steps: i32, inputs: &Inputs, solution: &Solution) -> TeethView {
        let unzoomed = TeethView { zoom: 0, ..self }.extent(inputs, solution);
        let beyond = 2.0 * (whole(&solution.geometry).1 / unzoomed).log2().ceil();
        let last_out = if beyond > 0.0 { -beyond as i32 } else { 0 };
        let zoom =
            self.zoom.saturating_add(steps).max(last_out.max(LAST_STEP_OUT)).min(LAST_STEP_IN);
        TeethView { zoom, ..self }
    }

    /// The view around another centre, without zoom.
    pub(crate) fn centred_beside(self, by: isize) -> TeethView {
        TeethView { centre: self.centre.beside(by), zoom: 0, ..self }
    }

    /// The view with the exaggeration of the gap switched on or off.
    #[must_use]
    pub fn exaggerated_or_not(self) -> TeethView {
        let exaggeration = match self.exaggeration {
            Exaggeration::Fitted => Exaggeration::True,
            Exaggeration::True => Exaggeration::Fitted,
        };
        TeethView { exaggeration, ..self }
    }

    /// The length of the shorter side of the picture, in m.
    #[must_use]
    pub fn extent(&self, inputs: &Inputs, solution: &Solution) -> f64 {
        let geometry = &solution.geometry;
        let contact = first_contact_point(solution);
        let way = |from: f64| {
            let from = on_line_of_action(geometry, from);
            contact.map_or(0.0, |contact| (contact - from).norm())
        };
        let pitch_point = geometry.start + geometry.approach_length;
        let unzoomed = match self.centre {
            Centre::Strike => (STRIKE.0 * inputs.module).max(STRIKE.1 * way(geometry.start)),
            Centre::PitchPoint => {
                PATH * way(pitch_point)
                    .max(geometry.end - pitch_point)
                    .max(geometry.approach_length)
                    .max(inputs.module)
            }
            Centre::Pair => whole(geometry).1,
        };
        let steps = self.zoom.clamp(LAST_STEP_OUT, LAST_STEP_IN);
        unzoomed * 2f64.powf(-0.5 * f64::from(steps))
    }

    /// The exaggeration of the opening, 1 if the opening is visible true to scale.
    ///
    /// The factor is a round number that makes the deviation at most 10 % of the picture's height.
    /// The factor decreases far from the flank, so that the struck tooth does not move, and is 1
    /// after B.
    #[must_use]
    pub(crate) fn factor(self, inputs: &Inputs, solution: &Solution, moment: &ContactState) -> f64 {
        if self.exaggeration == Exaggeration::True || moment.phase == Phase::RunOut {
            return 1.0;
        }
        let room = (SHARE * self.extent(inputs, solution)).min(MOST_DEVIATION * inputs.module);
        let fitted = round_down(room / solution.deviation.total.abs()).min(MOST_FACTOR);
        fitted.min(MOST_OPENING * inputs.module / moment.opening).max(1.0)
    }
}

/// The unit for a length in m: its factor to m, and its name.
pub(crate) fn unit_of_length(length: f64, system: System) -> (f64, &'static str) {
    let (units, least) = match system {
        System::Metric => (&METRIC[..], 1.0),
        System::Inch => (&INCH[..], LEAST_INCHES),
    };
    let fitting = units.iter().find(|(unit, _)| length >= 0.999 * least * unit);
    fitting.or(units.last()).copied().unwrap_or((1.0, "m"))
}

/// The height and width of the whole pair with a margin, in m.
#[must_use]
pub(crate) fn whole(geometry: &Geometry) -> (f64, f64) {
    const MARGIN: f64 = 1.04;
    let (driver, driven) = (geometry.driver.tip, geometry.driven.tip);
    (MARGIN * 2.0 * driver.max(driven), MARGIN * (geometry.centre_distance + driver + driven))
}

/// The greatest of 1, 2, 5 times a power of ten that is not above the value; at least 1.
pub(crate) fn round_down(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let steps = [10.0, 5.0, 2.0, 1.0].map(|step| step * power);
    steps.into_iter().find(|step| *step <= value * (1.0 + 1e-12)).unwrap_or(power)
}

/// The point at the centre, if the view has one.
fn anchor(centre: Centre, solution: &Solution) -> Option<Point2<f64>> {
    let geometry = &solution.geometry;
    let start = on_line_of_action(geometry, geometry.start);
    match centre {
        Centre::Strike => Some(first_contact_point(solution).unwrap_or(start)),
        Centre::PitchPoint => {
            Some(on_line_of_action(geometry, geometry.start + geometry.approach_length))
        }
        Centre::Pair => None,
    }
}

/// The dots of a cell for each marker, horizontally and vertically.
fn dots(marker: Marker) -> (u16, u16) {
    match marker {
        Marker::Braille | Marker::Octant => (2, 4),
        Marker::Sextant => (2, 3),
        Marker::Quadrant => (2, 2),
        Marker::HalfBlock => (1, 2),
        _ => (1, 1),
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::Color;
    use ratatui::widgets::Widget;
    use ratatui::widgets::canvas::{Canvas, Line};

    use super::*;
    use crate::case::Case;
    use crate::model::{self, Stages};

    const MARKERS: [Marker; 3] = [Marker::Braille, Marker::HalfBlock, Marker::Dot];

    fn windows() -> Vec<(Window, Marker)> {
        let inputs = Case::table_1().inputs().unwrap();
        let solution = model::solve(&inputs, Stages::CLOSED_FORM).unwrap();
        let of = |(marker, size)| {
            (Window::of(TeethView::default(), &inputs, &solution, size, marker), marker)
        };
        MARKERS
            .into_iter()
            .flat_map(|marker| [Size::new(80, 24), Size::new(30, 40)].map(|size| (marker, size)))
            .map(of)
            .collect()
    }

    #[test]
    fn scale_is_the_same_in_both_directions() {
        for (window, marker) in windows() {
            let (columns, rows) = (f64::from(window.size.width), f64::from(window.size.height));
            let (wide, high) =
                (columns - 1.0 / f64::from(window.dots.0), rows - 1.0 / f64::from(window.dots.1));
            let (column, row) = (2.0 * window.half.x / wide, 2.0 * window.half.y / high);
            assert!(
                (row / column - CELL_HEIGHT).abs() < 1e-12,
                "{marker:?}: {column} m and {row} m"
            );
            assert!((column - window.column()).abs() < 1e-15);
        }
    }

    #[test]
    fn a_point_is_drawn_in_its_cell() {
        for (window, marker) in windows() {
            for (right, up) in [
                (0.02, -0.03),
                (0.3, -0.7),
                (-0.99, 0.99),
                (0.999, 0.999),
                (-0.999, -0.999),
                (0.51, 0.13),
            ] {
                let point = window.centre + Vector2::new(right * window.half.x, up * window.half.y);
                let area = Rect::new(0, 0, window.size.width, window.size.height);
                let mut buffer = Buffer::empty(area);
                Canvas::default()
                    .marker(marker)
                    .x_bounds(window.across())
                    .y_bounds(window.upright())
                    .paint(|context| {
                        context.draw(&Line::new(point.x, point.y, point.x, point.y, Color::Reset));
                    })
                    .render(area, &mut buffer);
                let drawn = area
                    .positions()
                    .find(|position| buffer[*position].symbol() != " ")
                    .map(|cell| (cell.x, cell.y));
                assert_eq!(drawn, window.cell(point), "{marker:?} {right} {up}");
            }
        }
    }

    #[test]
    fn lines_are_cut_at_the_edges() {
        let (window, _) = windows()[0];
        let at = |right: f64, up: f64| {
            window.centre + Vector2::new(right * window.half.x, up * window.half.y)
        };
        assert_eq!(window.clip(at(0.1, 0.2), at(-0.5, 0.9)), Some((0.0, 1.0)));
        let (first, last) = window.clip(at(-3.0, 0.0), at(1.0, 0.0)).unwrap();
        assert!((first - 0.5).abs() < 1e-9 && (last - 1.0).abs() < 1e-9);
        assert_eq!(window.clip(at(-3.0, 1.5), at(3.0, 1.5)), None);
        assert_eq!(window.clip(at(-3.0, 0.0), at(0.0, 3.0)), None);
    }

    #[test]
    fn factors_and_bars_are_round() {
        for (value, round) in [
            (1.0, 1.0),
            (1.99, 1.0),
            (2.0, 2.0),
            (49.0, 20.0),
            (50.0, 50.0),
            (999.0, 500.0),
            (1000.0, 1000.0),
        ] {
            assert_eq!(round_down(value).to_bits(), f64::to_bits(round));
        }
        assert!((round_down(0.0034) / 0.002 - 1.0).abs() < 1e-12);
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(round_down(value).to_bits(), 1.0_f64.to_bits());
        }
    }
}
