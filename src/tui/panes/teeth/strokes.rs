//! The strokes of the teeth: their kinds, and the visible parts of curves, gears and marks, split
//! into as many straight pieces as the visible dots need.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::Range;

use nalgebra::{Point2, Vector2};
use ratatui::style::{Color, Modifier, Style};

use super::window::{Window, round_down, unit_of_length};
use crate::case::units::System;
use crate::model::outline::Placed;
use crate::tui::theme::Theme;

/// The least pitch, in dots, at which teeth are drawn rather than circles.
const LEAST_PITCH: f64 = 5.0;
/// The number of candidate positions of the scale bar along an edge.
const PLACES: u32 = 24;
/// The width of the label of the scale bar, in columns.
const BAR_LABEL: f64 = 9.0;
/// The greatest length of the scale bar, as a fraction of the width.
const BAR: f64 = 0.25;

/// The greatest distance between a chord and its curve, in dots.
const STRAY: f64 = 0.4;
/// The greatest ratio of the length of an arc of at most a quarter turn to the length of its two
/// half chords.
const LONGER: f64 = 1.1;
/// The greatest number of halvings of a curve.
const MOST_HALVINGS: u32 = 32;

/// A straight stroke, or a dot if both ends coincide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// The beginning.
    pub from: Point2<f64>,
    /// The end.
    pub to: Point2<f64>,
    /// The kind.
    pub(crate) ink: Ink,
}

/// A dash pattern, in dots. Dashes of length 0 are dots.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Dash {
    /// The length of a dash.
    pub(crate) on: f64,
    /// The length of a gap.
    pub(crate) off: f64,
}

/// Draws into a window.
#[derive(Debug)]
pub(crate) struct Pen<'a> {
    window: &'a Window,
    /// The strokes so far.
    pub(crate) strokes: Vec<Stroke>,
}

impl<'a> Pen<'a> {
    /// A pen without strokes.
    #[must_use]
    pub(crate) fn new(window: &'a Window) -> Pen<'a> {
        Pen { window, strokes: Vec::new() }
    }

    /// Draws a gear with its tooth 0 turned by an angle.
    pub(crate) fn gear(&mut self, gear: &Placed, turned: f64, bore: f64, [ink, struck]: [Ink; 2]) {
        let circles = gear.outline.profile().circles();
        if bore > 0.0 {
            self.circle(gear.centre, bore, None, ink);
        }
        if gear.pitch() * circles.tip < LEAST_PITCH * self.window.dot {
            for radius in [circles.tip, circles.root] {
                self.circle(gear.centre, radius, None, ink);
            }
            return;
        }
        let teeth = i64::from(gear.teeth);
        let turn_of = |number: i64| {
            if number.rem_euclid(teeth) == 0 { turned } else { 0.0 }
        };
        for number in self.in_sight(gear) {
            let ink = if number.rem_euclid(teeth) == 0 { struck } else { ink };
            self.tooth(&gear.turned(turn_of(number)), number, ink);
            let half = gear.outline.profile().root_half_angle();
            let middle = gear.turn + number as f64 * gear.pitch();
            let (from, to) = (
                middle + turn_of(number) + half,
                middle + gear.pitch() + turn_of(number + 1) - half,
            );
            self.arc(gear.centre, circles.root, from, to, None, ink);
        }
    }

    fn tooth(&mut self, gear: &Placed, number: i64, ink: Ink) {
        let place = gear.tooth(number);
        for piece in gear.outline.pieces() {
            for side in [1.0, -1.0] {
                let curve = |part: f64| {
                    let point = gear.outline.at(piece, part);
                    place * Point2::new(point.x, side * point.y)
                };
                self.curve(curve, 0.0, None, ink);
            }
        }
    }

    /// The numbers of the visible teeth and their neighbours.
    fn in_sight(&self, gear: &Placed) -> Range<i64> {
        let teeth = i64::from(gear.teeth);
        let way = self.window.centre - gear.centre;
        let (distance, reach) = (way.norm(), self.window.half.norm());
        let circles = gear.outline.profile().circles();
        if distance - reach > circles.tip || distance + reach < circles.root {
            return 0..0;
        }
        if distance <= reach {
            return 0..teeth;
        }
        let half = (reach / distance).asin() + gear.pitch();
        let middle = (way.y.atan2(way.x) - gear.turn).rem_euclid(TAU);
        let (first, last) = ((middle - half) / gear.pitch(), (middle + half) / gear.pitch());
        let first = first.floor() as i64;
        first..(last.ceil() as i64 + 1).min(first + teeth)
    }

    /// Draws a circle, solid or dashed.
    pub(crate) fn circle(
        &mut self,
        centre: Point2<f64>,
        radius: f64,
        dash: Option<Dash>,
        ink: Ink,
    ) {
        self.arc(centre, radius, 0.0, TAU, dash, ink);
    }

    fn arc(
        &mut self,
        centre: Point2<f64>,
        radius: f64,
        from: f64,
        to: f64,
        dash: Option<Dash>,
        ink: Ink,
    ) {
        let quarters = ((to - from).abs() / FRAC_PI_2 + 1e-9).ceil().clamp(1.0, 4.0);
        let step = (to - from) / quarters;
        for quarter in 0..quarters as u32 {
            let start = from + f64::from(quarter) * step;
            let curve = |part: f64| {
                centre
                    + Vector2::new((start + part * step).cos(), (start + part * step).sin())
                        * radius
            };
            self.curve(curve, radius * step.abs(), dash, ink);
        }
    }

    /// Draws a curve of a length, solid or dashed. See [`follow`] for the condition on the curve.
    pub(crate) fn curve(
        &mut self,
        curve: impl Fn(f64) -> Point2<f64>,
        length: f64,
        dash: Option<Dash>,
        ink: Ink,
    ) {
        let window = self.window;
        follow(curve, window, |stretch| match dash {
            None => self.strokes.push(Stroke { from: stretch.from.1, to: stretch.to.1, ink }),
            Some(dash) => self.dashes(&stretch, length / window.dot, dash, ink),
        });
    }

    /// Draws the dashes of a piece of a curve that is `length` dots long.
    fn dashes(&mut self, stretch: &Stretch, length: f64, dash: Dash, ink: Ink) {
        let ((from, start), (to, end)) = (stretch.from, stretch.to);
        let (period, rest) = ((dash.on + dash.off) / length, to - from);
        if !(period > 0.0 && rest > 0.0) {
            return;
        }
        let at = |part: f64| start + (end - start) * ((part - from) / rest).clamp(0.0, 1.0);
        let mut dash_from = ((from - dash.on / length) / period).ceil() * period;
        while dash_from < to {
            self.strokes.push(Stroke {
                from: at(dash_from),
                to: at(dash_from + dash.on / length),
                ink,
            });
            dash_from += period;
        }
    }

    /// Draws the scale bar along the lower or the upper edge, preferably in the lower left corner.
    pub(crate) fn bar(&mut self, system: System) -> (Point2<f64>, Point2<f64>) {
        let (dot, high) = (self.window.dot, self.window.dot_height());
        let most = BAR * 2.0 * self.window.half.x;
        let (unit, _) = unit_of_length(most, system);
        let length = round_down(most / unit) * unit;
        let room = Vector2::new(length + BAR_LABEL * self.window.column(), self.window.row());
        let (low, top) =
            (self.window.centre - self.window.half, self.window.centre + self.window.half);
        let margin = Vector2::new(2.0 * dot, 0.25 * high);
        let left = low + margin;
        let (right, up) =
            ((top.x - room.x - margin.x).max(left.x), (top.y - 1.5 * high).max(left.y));
        let from = self.free_place(left, Point2::new(right, up), room);
        let to = from + Vector2::new(length, 0.0);
        self.strokes.push(Stroke { from, to, ink: Ink::Mark });
        for end in [from, to] {
            self.strokes.push(Stroke {
                from: end,
                to: end + Vector2::new(0.0, high),
                ink: Ink::Mark,
            });
        }
        (from, to)
    }

    /// The position along the lower or the upper edge with the fewest strokes, from the corners
    /// inwards.
    fn free_place(&self, low: Point2<f64>, top: Point2<f64>, room: Vector2<f64>) -> Point2<f64> {
        let part = |place: u32| f64::from(place) / f64::from(PLACES);
        let mut parts: Vec<f64> = (0..=PLACES).map(part).collect();
        parts.sort_by(|one, other| one.min(1.0 - one).total_cmp(&other.min(1.0 - other)));
        let mut best = (usize::MAX, low);
        for y in [low.y, top.y] {
            let row =
                if y > low.y { self.window.centre.y + self.window.half.y - room.y } else { y };
            let band = self
                .window
                .around(Point2::new(low.x, row), Vector2::new(top.x - low.x + room.x, room.y));
            let near: Vec<&Stroke> = self
                .strokes
                .iter()
                .filter(|stroke| band.clip(stroke.from, stroke.to).is_some())
                .collect();
            for at in parts.iter().map(|part| Point2::new(low.x + part * (top.x - low.x), y)) {
                let window = self.window.around(Point2::new(at.x, row), room);
                let count = near
                    .iter()
                    .filter(|stroke| window.clip(stroke.from, stroke.to).is_some())
                    .count();
                best = if count < best.0 { (count, at) } else { best };
            }
        }
        best.1
    }

    /// Draws a cross of five dots, or one dot if the marker has one dot per cell.
    pub(crate) fn cross(&mut self, at: Point2<f64>, ink: Ink) {
        if self.window.sees(at) {
            let arm = if self.window.dot < self.window.column() { 1.0 } else { 0.0 };
            let (right, up) = (
                Vector2::new(arm * self.window.dot, 0.0),
                Vector2::new(0.0, arm * self.window.dot_height()),
            );
            for arm in [right, up] {
                self.strokes.push(Stroke { from: at - arm, to: at + arm, ink });
            }
        }
    }
}

/// The kind of a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Ink {
    /// Base circles and line of action.
    Construction,
    /// The path of contact, and the path of the tip before it.
    Path,
    /// The driven gear.
    Driven,
    /// The incoming tooth.
    StruckDriven,
    Driver,
    /// The struck tooth.
    StruckDriver,
    /// A point with a name.
    Mark,
    /// A contact of two flanks.
    Contact,
}

impl Ink {
    const ALL: [Ink; 8] = [
        Ink::Construction,
        Ink::Path,
        Ink::Driven,
        Ink::StruckDriven,
        Ink::Driver,
        Ink::StruckDriver,
        Ink::Mark,
        Ink::Contact,
    ];

    #[must_use]
    pub(crate) fn style(self, theme: &Theme) -> Style {
        match self {
            Ink::Construction => theme.faint,
            Ink::Path => theme.path,
            Ink::Driven => theme.driven,
            Ink::StruckDriven => theme.driven.add_modifier(Modifier::BOLD),
            Ink::Driver => theme.driver,
            Ink::StruckDriver => theme.driver.add_modifier(Modifier::BOLD),
            Ink::Mark => theme.focus,
            Ink::Contact => theme.active,
        }
    }

    /// The canvas stores only colours: a colour number encodes the ink until the cells get their
    /// style.
    #[must_use]
    pub(crate) fn number(self) -> Color {
        Color::Indexed(self as u8)
    }

    /// The ink of a colour number.
    #[must_use]
    pub(crate) fn of(number: Color) -> Option<Ink> {
        Ink::ALL.into_iter().find(|ink| ink.number() == number)
    }
}

/// A straight visible piece of a curve, with the parameters at its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    /// Parameter and point at the beginning.
    pub(crate) from: (f64, Point2<f64>),
    /// Parameter and point at the end.
    pub(crate) to: (f64, Point2<f64>),
}

/// Follows a curve over its parameter from 0 to 1 through the window, in pieces that are straight
/// within a dot.
///
/// The curve must turn by less than a quarter turn in one direction. Hidden parts are skipped, so
/// that the cost depends on the dots and not on the zoom.
pub(crate) fn follow(
    curve: impl Fn(f64) -> Point2<f64>,
    window: &Window,
    mut found: impl FnMut(Stretch),
) {
    let ends = ((0.0, curve(0.0)), (1.0, curve(1.0)));
    halve(&curve, window, ends.0, ends.1, MOST_HALVINGS, &mut found);
}

fn halve(
    curve: &impl Fn(f64) -> Point2<f64>,
    window: &Window,
    from: (f64, Point2<f64>),
    to: (f64, Point2<f64>),
    halvings: u32,
    found: &mut impl FnMut(Stretch),
) {
    let at = f64::midpoint(from.0, to.0);
    let middle = (at, curve(at));
    let reach = LONGER * ((middle.1 - from.1).norm() + (to.1 - middle.1).norm());
    // A curve with NaN is never visible.
    let in_sight = window.distance(middle.1) <= reach;
    if !in_sight {
        return;
    }
    if halvings == 0 || stray(from.1, middle.1, to.1) <= STRAY * window.dot {
        for (from, to) in [(from, middle), (middle, to)] {
            found_in_sight(window, from, to, found);
        }
        return;
    }
    halve(curve, window, from, middle, halvings - 1, found);
    halve(curve, window, middle, to, halvings - 1, found);
}

/// The distance between the middle and the chord.
fn stray(from: Point2<f64>, middle: Point2<f64>, to: Point2<f64>) -> f64 {
    let (chord, way) = (to - from, middle - from);
    let length = chord.norm();
    if length > 0.0 { chord.perp(&way).abs() / length } else { way.norm() }
}

fn found_in_sight(
    window: &Window,
    from: (f64, Point2<f64>),
    to: (f64, Point2<f64>),
    found: &mut impl FnMut(Stretch),
) {
    let Some((first, last)) = window.clip(from.1, to.1) else {
        return;
    };
    let at = |part: f64| (from.0 + part * (to.0 - from.0), from.1 + (to.1 - from.1) * part);
    found(Stretch { from: at(first), to: at(last) });
}

#[cfg(test)]
mod tests {
    use ratatui::layout::Size;

    use super::*;

    #[test]
    fn every_ink_has_its_own_number() {
        for ink in Ink::ALL {
            assert_eq!(Ink::of(ink.number()), Some(ink));
        }
        assert_eq!(Ink::of(Color::Reset), None);
    }

    /// A window of a size in m around a point, on 100 columns and 25 rows of Braille.
    fn window(centre: Point2<f64>, width: f64) -> Window {
        let dot = width / 199.0;
        let half = Vector2::new(99.5, 49.5) * dot;
        Window { centre, half, dot, size: Size::new(100, 25), dots: (2, 4) }
    }

    fn quarter(radius: f64) -> impl Fn(f64) -> Point2<f64> {
        move |part| {
            let angle = part * std::f64::consts::FRAC_PI_2;
            Point2::new(radius * angle.cos(), radius * angle.sin())
        }
    }

    #[test]
    fn stretches_keep_to_the_curve_and_the_window_at_every_zoom() {
        let centre = quarter(1.0)(0.3);
        for zoom in 0..20 {
            let window = window(centre, 4.0 * 0.5f64.powi(zoom));
            let (mut count, mut length) = (0, 0.0);
            follow(quarter(1.0), &window, |stretch| {
                count += 1;
                length += (stretch.to.1 - stretch.from.1).norm();
                let off =
                    (1.0 - nalgebra::center(&stretch.from.1, &stretch.to.1).coords.norm()).abs();
                assert!(off <= window.dot, "{off} off at zoom {zoom}");
                assert!(
                    window.distance(stretch.from.1) < 1e-6 * window.dot
                        && window.distance(stretch.to.1) < 1e-6 * window.dot
                );
            });
            assert!((1..=128).contains(&count), "{count} stretches at zoom {zoom}");
            let across = length / window.dot;
            assert!(zoom < 4 || (99.0..250.0).contains(&across), "{across} dots at zoom {zoom}");
        }
    }

    #[test]
    fn hidden_and_invalid_curves_cost_nothing() {
        let window = window(Point2::new(5.0, 5.0), 1.0);
        follow(quarter(1.0), &window, |stretch| panic!("{stretch:?}"));
        follow(|_| Point2::new(f64::NAN, 5.0), &window, |stretch| panic!("{stretch:?}"));
        follow(|part| Point2::new(5.0, part / 0.0), &window, |stretch| panic!("{stretch:?}"));
    }
}
