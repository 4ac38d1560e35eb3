//! The visible parts of the pair: strokes, and points with a name.

use nalgebra::Point2;
use ratatui::layout::Size;

use super::ink::Ink;
use super::picture::Picture;
use super::strokes::{Dash, Pen, Stroke};
use super::window::Window;
use crate::model::ContactState;
use crate::model::contact_state::{first_contact, shares_load};
use crate::model::gear_pose::{
    GearPose, Placed, driven_tangent_point, driver_tangent_point, on_line_of_action, tip_point,
};
use crate::model::position::tip_at;

/// Dashes and gaps, in dots.
const LINE_OF_ACTION: Dash = Dash { on: 5.0, off: 4.0 };
const CIRCLE: Dash = Dash { on: 0.0, off: 4.0 };
const PATH: Dash = Dash { on: 0.0, off: 2.0 };
/// The start of the path of the tip, as a multiple of the angle from D to E.
const PATH_FROM: f64 = 2.5;

/// The visible parts of the pair.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The visible part of the plane.
    pub window: Window,
    /// The strokes in drawing order.
    pub strokes: Vec<Stroke>,
    /// Points with a name, the most important first.
    pub(crate) points: Vec<Named>,
    /// Candidate positions for the name of each gear, the best first.
    pub(crate) bodies: [Vec<Point2<f64>>; 2],
    /// The exaggeration of the opening.
    pub factor: Option<f64>,
    /// Ends of the scale bar.
    pub(crate) bar: (Point2<f64>, Point2<f64>),
}

/// A point with a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Named {
    /// The position.
    pub(crate) at: Point2<f64>,
    pub(crate) name: &'static str,
}

impl Scene {
    /// The visible parts on a screen with a size.
    #[must_use]
    pub fn of(picture: &Picture, moment: Option<&ContactState>, size: Size) -> Scene {
        let Picture { inputs, solution, view, .. } = *picture;
        let window = Window::of(*view, inputs, solution, size, picture.drawn_marker());
        let factor = moment.map(|moment| view.factor(inputs, solution, moment));
        let angle = moment.map_or(0.0, |moment| moment.roll_angle_driver);
        let lead = moment.zip(factor).map_or(0.0, |(moment, factor)| moment.lead(factor))
            / solution.geometry.driver.base;
        let placing = GearPose::nominal(inputs, &solution.geometry, angle);
        let mut pen = Pen::new(&window);
        construction(&mut pen, picture);
        pen.gear(&placing.driven, 0.0, inputs.driven.bore_radius, [Ink::Driven, Ink::StruckDriven]);
        pen.gear(
            &placing.driver,
            -lead,
            inputs.driver.bore_radius,
            [Ink::Driver, Ink::StruckDriver],
        );
        let points = distinct(points(picture), &window);
        let contacts = moment
            .into_iter()
            .flat_map(|moment| contacts(picture, moment))
            .map(|at| (at, Ink::Contact));
        for (at, ink) in points.iter().map(|point| (point.at, Ink::Mark)).chain(contacts) {
            pen.cross(at, ink);
        }
        let bar = pen.bar(picture.units);
        Scene {
            strokes: pen.strokes,
            points,
            bodies: [bodies(&placing.driver), bodies(&placing.driven)],
            factor,
            bar,
            window,
        }
    }
}

/// Draws base circles, line of action, path of contact, and path of the tip before it.
fn construction(pen: &mut Pen, picture: &Picture) {
    let geometry = &picture.solution.geometry;
    let centre = Point2::new(geometry.centre_distance, 0.0);
    pen.circle(Point2::origin(), geometry.driver.base, Some(CIRCLE), Ink::Construction);
    pen.circle(centre, geometry.driven.base, Some(CIRCLE), Ink::Construction);
    let line = |from: f64, to: f64| {
        move |part: f64| on_line_of_action(geometry, from + part * (to - from))
    };
    pen.curve(
        line(0.0, geometry.tangent_length),
        geometry.tangent_length,
        Some(LINE_OF_ACTION),
        Ink::Construction,
    );
    pen.curve(line(geometry.start, geometry.end), geometry.end - geometry.start, None, Ink::Path);
    let from = PATH_FROM * first_contact(picture.solution).unwrap_or(0.0);
    let path = |part: f64| tip_point(geometry, &tip_at(geometry, part * from));
    pen.curve(path, from * geometry.driven.tip, Some(PATH), Ink::Path);
}

/// D, E, D', the pitch point, the end of contact, the points of tangency and the centres. D' is the
/// driven tip at the end of the impact, at most at E. `static` and `dynamic` have no D'.
fn points(picture: &Picture) -> Vec<Named> {
    let Picture { inputs, solution, .. } = *picture;
    let geometry = &solution.geometry;
    let mut points = Vec::new();
    let mut add = |name, at| points.push(Named { at, name });
    let start = on_line_of_action(geometry, geometry.start);
    let contact = first_contact(solution);
    let on_way = |angle: f64| tip_point(geometry, &tip_at(geometry, angle));
    let turn = solution
        .impact
        .map(|impact| inputs.driven_speed() * impact.duration())
        .filter(|_| !shares_load(solution));
    if let Some(contact) = contact {
        add("D", on_way(contact));
    }
    match contact.zip(turn) {
        Some((contact, turn)) if turn < contact => {
            add("E", start);
            add("D'", on_way(contact - turn));
        }
        Some(_) => add("E=D'", start),
        None => add("E", start),
    }
    add("P", on_line_of_action(geometry, geometry.start + geometry.approach_length));
    add("B", on_line_of_action(geometry, geometry.end));
    add("N1", driver_tangent_point(geometry));
    add("N2", driven_tangent_point(geometry));
    add("O1", Point2::origin());
    add("O2", Point2::new(geometry.centre_distance, 0.0));
    points
}

/// The visible points without those closer than two columns to a previous point.
fn distinct(points: Vec<Named>, window: &Window) -> Vec<Named> {
    let mut kept: Vec<Named> = Vec::new();
    for point in points.into_iter().filter(|point| window.sees(point.at)) {
        if kept.iter().all(|other| (other.at - point.at).norm() >= 2.0 * window.column()) {
            kept.push(point);
        }
    }
    kept
}

/// The contact points: of the incoming pair from the first contact on, and of the pairs ahead of
/// it, one base pitch apart on the path of contact.
fn contacts(picture: &Picture, moment: &ContactState) -> Vec<Point2<f64>> {
    let geometry = &picture.solution.geometry;
    let incoming = geometry.start - moment.roll_angle_driver * geometry.driver.base;
    let ahead = (1..10).map(|pair| incoming + f64::from(pair) * geometry.base_pitch);
    let touching = ahead.filter(|length| (geometry.start..=geometry.end).contains(length));
    let own = moment.touches().then_some(moment.point);
    touching.map(|length| on_line_of_action(geometry, length)).chain(own).collect()
}

/// Positions inside a gear: on the centre lines of the teeth, from the middle of a tooth to the
/// centre.
fn bodies(gear: &Placed) -> Vec<Point2<f64>> {
    let circles = gear.outline.profile().circles();
    let depth = circles.tip - circles.root;
    let radii = [0.5, 0.0, -0.5, -1.2, -2.5, -5.0].map(|part| circles.root + part * depth);
    let inside = radii.into_iter().filter(|radius| *radius > 0.0);
    let on_teeth = inside.flat_map(|radius| {
        [0, 1, -1, 2, -2].map(|number| gear.tooth(number) * Point2::new(radius, 0.0))
    });
    on_teeth.collect()
}
