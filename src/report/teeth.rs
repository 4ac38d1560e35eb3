//! The scene of a pair of gears at a roll angle, true to scale: curves and named points, which the
//! painters of the terminal and of SVG draw.

use std::f64::consts::{PI, TAU};

use nalgebra::{Point2, Vector2};

use crate::case::units::System;
use crate::model::contact_state::{first_contact, shares_load};
use crate::model::outline::{
    GearPose, Placed, driven_tangent_point, driver_tangent_point, on_line_of_action, tip_point,
};
use crate::model::position::tip_at;
use crate::model::{ContactState, Inputs, Solution};
use crate::numeric::decimal::significant;

/// The start of the path of the tip, as a multiple of the angle from D to E.
const PATH_FROM: f64 = 2.5;
/// The least pitch, in dots, at which teeth are drawn rather than circles.
const LEAST_PITCH: f64 = 5.0;
/// The pieces of a curve without a radius.
const PIECES: usize = 100;

/// Units of a length, the longest first: factor to m, least number, and name.
const METRIC: [(f64, f64, &str); 4] =
    [(1.0, 1.0, "m"), (1e-3, 1.0, "mm"), (1e-6, 1.0, "um"), (1e-9, 1.0, "nm")];
const INCH: [(f64, f64, &str); 2] = [(25.4e-3, 0.1, "in"), (25.4e-6, 0.1, "thou")];

/// The visible part of the plane, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The middle.
    pub centre: Point2<f64>,
    /// The vector from the middle to the upper right corner.
    pub half: Vector2<f64>,
    /// The width of a dot, the smallest visible length.
    pub dot: f64,
}

impl Window {
    /// Whether a point is visible.
    pub fn sees(&self, point: Point2<f64>) -> bool {
        let off = point - self.centre;
        off.x.abs() <= self.half.x && off.y.abs() <= self.half.y
    }

    /// The visible part of a straight line, as fractions of its length (Liang & Barsky 1984).
    pub fn clip(&self, from: Point2<f64>, to: Point2<f64>) -> Option<(f64, f64)> {
        let (start, way) = (from - self.centre, to - from);
        let (mut first, mut last) = (0.0f64, 1.0f64);
        for axis in 0..2 {
            let low = (-self.half[axis] - start[axis]) / way[axis];
            let high = (self.half[axis] - start[axis]) / way[axis];
            first = first.max(low.min(high));
            last = last.min(low.max(high));
        }
        (first <= last).then_some((first, last))
    }
}

/// The meaning of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// A base circle.
    BaseCircle,
    /// The line of action between the points of tangency.
    LineOfAction,
    /// The path of contact.
    PathOfContact,
    /// The path of the driven tip before E.
    TipPath,
    /// The bore of the driven gear.
    DrivenBore,
    /// The teeth of the driven gear.
    Driven,
    /// The driven tooth of the incoming pair.
    IncomingTooth,
    /// The bore of the driver.
    DriverBore,
    /// The teeth of the driver.
    Driver,
    /// The driver's tooth of the incoming pair.
    StruckTooth,
}

/// The pair at a roll angle.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The lines in drawing order, as points.
    pub lines: Vec<(Ink, Vec<Point2<f64>>)>,
    /// Points with a name, the most important first.
    pub points: Vec<(&'static str, Point2<f64>)>,
    /// The contacts of two flanks.
    pub contacts: Vec<Point2<f64>>,
}

impl Scene {
    /// The pair at a contact state, or at E, with the struck tooth ahead by `lead`, in m.
    pub fn of(
        inputs: &Inputs,
        solution: &Solution,
        moment: Option<&ContactState>,
        lead: f64,
        window: &Window,
    ) -> Scene {
        let geometry = &solution.geometry;
        let angle = moment.map_or(0.0, |moment| moment.roll_angle_driver);
        let pose = GearPose::nominal(inputs, geometry, angle);
        let line = |from: f64, to: f64| {
            sampled(PIECES, |part| on_line_of_action(geometry, from + part * (to - from)))
        };
        let before = PATH_FROM * first_contact(solution).unwrap_or(0.0);
        let tip_path =
            sampled(PIECES, |part| tip_point(geometry, &tip_at(geometry, part * before)));
        let base = |gear: &Placed, radius| (Ink::BaseCircle, circle(gear.centre, radius, window));
        let mut lines = vec![
            base(&pose.driver, geometry.driver.base),
            base(&pose.driven, geometry.driven.base),
            (Ink::LineOfAction, line(0.0, geometry.tangent_length)),
            (Ink::PathOfContact, line(geometry.start, geometry.end)),
            (Ink::TipPath, tip_path),
        ];
        let turn = -lead / geometry.driver.base;
        let driven = [Ink::DrivenBore, Ink::Driven, Ink::IncomingTooth];
        let driver = [Ink::DriverBore, Ink::Driver, Ink::StruckTooth];
        lines.extend(gear(&pose.driven, 0.0, inputs.driven.bore_radius, driven, window));
        lines.extend(gear(&pose.driver, turn, inputs.driver.bore_radius, driver, window));
        Scene {
            lines,
            points: points(inputs, solution),
            contacts: moment.map_or_else(Vec::new, |moment| contacts(solution, moment)),
        }
    }

    /// The visible points with a name, without those closer than a distance to a previous point.
    pub fn distinct_points(&self, window: &Window, apart: f64) -> Vec<(&'static str, Point2<f64>)> {
        let mut kept: Vec<(&'static str, Point2<f64>)> = Vec::new();
        for &(name, at) in self.points.iter().filter(|(_, at)| window.sees(*at)) {
            if kept.iter().all(|(_, other)| (other - at).norm() >= apart) {
                kept.push((name, at));
            }
        }
        kept
    }
}

/// The points of a curve at equal steps of its parameter from 0 to 1, as far as they exist.
fn sampled(pieces: usize, curve: impl Fn(f64) -> Point2<f64>) -> Vec<Point2<f64>> {
    let points = (0..=pieces).map(|piece| curve(piece as f64 / pieces as f64));
    points.filter(|point| point.coords.norm().is_finite()).collect()
}

/// A circle in chords that are less than half a dot away from it.
fn circle(centre: Point2<f64>, radius: f64, window: &Window) -> Vec<Point2<f64>> {
    let pieces = PI * (radius / (0.8 * window.dot)).sqrt();
    sampled(pieces.clamp(8.0, 1e5) as usize, |part| {
        let (sine, cosine) = (part * TAU).sin_cos();
        centre + Vector2::new(cosine, sine) * radius
    })
}

/// The bore and the visible teeth of a gear, with tooth 0 turned by an angle; circles in place of
/// teeth too small to be seen.
fn gear(
    gear: &Placed,
    turn: f64,
    bore: f64,
    [ink_of_bore, ink, ink_of_0]: [Ink; 3],
    window: &Window,
) -> Vec<(Ink, Vec<Point2<f64>>)> {
    let circles = gear.outline.profile().circles();
    let mut lines = Vec::new();
    if bore > 0.0 {
        lines.push((ink_of_bore, circle(gear.centre, bore, window)));
    }
    if gear.pitch() * circles.tip < LEAST_PITCH * window.dot {
        let radii = [circles.tip, circles.root];
        lines.extend(radii.map(|radius| (ink, circle(gear.centre, radius, window))));
        return lines;
    }
    let height = circles.tip - circles.root;
    let tooth = gear.outline.tooth((height / (2.0 * window.dot)).sqrt().clamp(2.0, 400.0) as usize);
    let mut joint = None;
    for number in visible_teeth(gear, window) {
        let is_0 = number.rem_euclid(i64::from(gear.teeth)) == 0;
        let place = gear.turned(if is_0 { turn } else { 0.0 }).tooth(number);
        let outline: Vec<_> =
            joint.into_iter().chain(tooth.iter().map(|point| place * point)).collect();
        joint = outline.last().copied();
        lines.push((if is_0 { ink_of_0 } else { ink }, outline));
    }
    lines
}

/// The numbers of the visible teeth and their neighbours.
fn visible_teeth(gear: &Placed, window: &Window) -> std::ops::Range<i64> {
    let teeth = i64::from(gear.teeth);
    let way = window.centre - gear.centre;
    let (distance, reach) = (way.norm(), window.half.norm());
    let circles = gear.outline.profile().circles();
    if distance - reach > circles.tip || distance + reach < circles.root {
        return 0..0;
    }
    if distance <= reach {
        return 0..teeth;
    }
    let half = (reach / distance).asin() + gear.pitch();
    let middle = (way.y.atan2(way.x) - gear.turn).rem_euclid(TAU);
    let first = ((middle - half) / gear.pitch()).floor() as i64;
    let last = ((middle + half) / gear.pitch()).ceil() as i64;
    first..(last + 1).min(first + teeth)
}

/// D, E, D', the pitch point, the end of contact, the points of tangency and the centres. D' is the
/// driven tip at the end of the impact, at most at E. `static` and `dynamic` have no D'.
fn points(inputs: &Inputs, solution: &Solution) -> Vec<(&'static str, Point2<f64>)> {
    let geometry = &solution.geometry;
    let start = on_line_of_action(geometry, geometry.start);
    let tip = |angle: f64| tip_point(geometry, &tip_at(geometry, angle));
    let impact = solution.impact.filter(|_| !shares_load(solution));
    let turn = impact.map(|impact| inputs.driven_speed() * impact.duration);
    let mut points = match (first_contact(solution), turn) {
        (Some(contact), Some(turn)) if turn < contact => {
            vec![("D", tip(contact)), ("E", start), ("D'", tip(contact - turn))]
        }
        (Some(contact), Some(_)) => vec![("D", tip(contact)), ("E=D'", start)],
        (Some(contact), None) => vec![("D", tip(contact)), ("E", start)],
        (None, _) => vec![("E", start)],
    };
    points.extend([
        ("P", on_line_of_action(geometry, geometry.start + geometry.approach_length)),
        ("B", on_line_of_action(geometry, geometry.end)),
        ("N1", driver_tangent_point(geometry)),
        ("N2", driven_tangent_point(geometry)),
        ("O1", Point2::origin()),
        ("O2", Point2::new(geometry.centre_distance, 0.0)),
    ]);
    points
}

/// The contact points: of the incoming pair from the first contact on, and of the pairs ahead of
/// it, one base pitch apart on the path of contact.
fn contacts(solution: &Solution, moment: &ContactState) -> Vec<Point2<f64>> {
    let geometry = &solution.geometry;
    let incoming = geometry.start - moment.roll_angle_driver * geometry.driver.base;
    let ahead = (1..10).map(|pair| incoming + f64::from(pair) * geometry.base_pitch);
    let touching = ahead.filter(|length| (geometry.start..=geometry.end).contains(length));
    let own = moment.touches().then_some(moment.point);
    touching.map(|length| on_line_of_action(geometry, length)).chain(own).collect()
}

/// The greatest round length not above `most`, in m, with its text in a suitable unit.
pub fn scale_bar(most: f64, system: System) -> (f64, String) {
    let units = if system == System::Metric { &METRIC[..] } else { &INCH[..] };
    let fits = |(unit, least, _): &&(f64, f64, &str)| most >= 0.999 * least * unit;
    let &(unit, _, name) = units.iter().find(fits).unwrap_or(&units[units.len() - 1]);
    let length = round_down(most / unit);
    (length * unit, format!("{} {name}", significant(length, 1)))
}

/// The greatest of 1, 2, 5 times a power of ten that is not above the value; 1 if the value is not
/// positive.
pub fn round_down(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let steps = [10.0, 5.0, 2.0, 1.0].map(|step| step * power);
    steps.into_iter().find(|step| *step <= value * (1.0 + 1e-12)).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_cut_at_the_edges() {
        let window =
            Window { centre: Point2::new(3.0, -1.0), half: Vector2::new(2.0, 0.5), dot: 0.1 };
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
        for (value, round) in
            [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (49.0, 20.0), (50.0, 50.0), (999.0, 500.0)]
        {
            assert_eq!(round_down(value).to_bits(), f64::to_bits(round));
        }
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(round_down(value).to_bits(), 1.0_f64.to_bits());
        }
        for (most, system, text) in [
            (0.0199, System::Metric, "10 mm"),
            (0.0021, System::Metric, "2 mm"),
            (0.9e-6, System::Metric, "500 nm"),
            (0.03, System::Inch, "1 in"),
            (0.003, System::Inch, "0.1 in"),
            (0.002, System::Inch, "50 thou"),
        ] {
            assert_eq!(scale_bar(most, system).1, text);
        }
    }

    #[test]
    fn a_circle_stays_within_a_dot_at_every_zoom() {
        for zoom in 0..20 {
            let dot = 0.01 * 0.5f64.powi(zoom);
            let window = Window { centre: Point2::origin(), half: Vector2::new(1.0, 1.0), dot };
            let points = circle(Point2::origin(), 1.0, &window);
            let middles = points.windows(2).map(|ends| nalgebra::center(&ends[0], &ends[1]));
            assert!(middles.into_iter().all(|middle| 1.0 - middle.coords.norm() < dot), "{zoom}");
        }
    }
}
