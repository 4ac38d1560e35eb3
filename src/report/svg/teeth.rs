//! Draws the teeth of a pair around the contact, true to scale.

use std::fmt::Write;

use nalgebra::Point2;

use super::{escaped, opening};
use crate::model::contact_state::{first_contact, first_contact_point};
use crate::model::outline::{GearPose, Placed, on_line_of_action};
use crate::model::{Inputs, Solution};

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 622.0;
/// Left, top, width and height of the window.
const WINDOW: (f64, f64, f64, f64) = (12.0, 40.0, 736.0, 520.0);
/// Steps of each piece of an outline.
const STEPS: usize = 24;
/// Additional height of the window, relative to the length of the path of contact.
const MARGIN: f64 = 0.35;

/// Transformation from the plane of the gears, in m, to the window.
struct View {
    centre: Point2<f64>,
    /// Pixels per metre.
    scale: f64,
}

impl View {
    fn of(solution: &Solution) -> View {
        let geometry = &solution.geometry;
        let ends = [geometry.start, geometry.end].map(|length| on_line_of_action(geometry, length));
        let tip = first_contact_point(solution).unwrap_or(ends[0]);
        let high = [ends[0].y, ends[1].y, tip.y];
        let least = high.into_iter().fold(f64::INFINITY, f64::min);
        let most = high.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let span = (most - least) * (1.0 + MARGIN) + geometry.base_pitch * 0.4;
        View {
            centre: Point2::new(f64::midpoint(ends[0].x, ends[1].x), f64::midpoint(least, most)),
            scale: WINDOW.3 / span,
        }
    }

    fn at(&self, point: Point2<f64>) -> (f64, f64) {
        (
            WINDOW.2 / 2.0 + (point.x - self.centre.x) * self.scale,
            WINDOW.3 / 2.0 - (point.y - self.centre.y) * self.scale,
        )
    }

    /// Whether a point is in the window or near it.
    fn sees(&self, point: Point2<f64>, margin: f64) -> bool {
        let (x, y) = self.at(point);
        (-margin..=WINDOW.2 + margin).contains(&x) && (-margin..=WINDOW.3 + margin).contains(&y)
    }
}

/// Draws the teeth at the first contact, or at E without corner contact.
#[must_use]
pub fn teeth(inputs: &Inputs, solution: &Solution) -> String {
    let contact = first_contact(solution);
    let pose =
        GearPose::nominal(inputs, &solution.geometry, contact.unwrap_or(0.0) * inputs.ratio());
    let view = View::of(solution);
    let title = if contact.is_some() {
        "Teeth at the first contact D"
    } else {
        "Teeth at E, without corner contact"
    };
    let (left, top, width, height) = WINDOW;
    let mut text = opening(&escaped(title), WIDTH, HEIGHT);
    let _ = writeln!(
        text,
        "<text x=\"{left}\" y=\"24\" class=\"title\">{title}</text>\n\
         <svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" overflow=\"hidden\">"
    );
    gear(&mut text, &pose.driver, &view, "body1");
    gear(&mut text, &pose.driven, &view, "body2");
    construction(&mut text, solution, &view);
    points(&mut text, solution, &view);
    let _ = writeln!(
        text,
        "</svg>\n<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" class=\"axis\"/>"
    );
    caption(&mut text, &view);
    text + "</svg>\n"
}

/// The visible teeth of a gear, closed towards the centre.
fn gear(text: &mut String, gear: &Placed, view: &View, class: &str) {
    let tooth = gear.outline.tooth(STEPS);
    let circles = gear.outline.profile().circles();
    let margin = 2.0 * gear.pitch() * circles.tip * view.scale;
    let half = i64::from(gear.teeth / 2);
    let seen: Vec<i64> = (-half..=half)
        .filter(|&number| {
            let middle = gear.tooth(number) * Point2::new(circles.tip, 0.0);
            view.sees(middle, margin)
        })
        .collect();
    let mut points: Vec<Point2<f64>> = seen
        .iter()
        .flat_map(|&number| {
            let place = gear.tooth(number);
            tooth.iter().map(move |point| place * point)
        })
        .collect();
    if seen.len() < gear.teeth as usize {
        points.push(gear.centre);
    }
    let points: Vec<String> = points
        .into_iter()
        .map(|point| view.at(point))
        .map(|(x, y)| format!("{x:.2},{y:.2}"))
        .collect();
    let _ = writeln!(text, "<polygon points=\"{}\" class=\"{class}\"/>", points.join(" "));
}

/// Base circles, line of action and path of contact.
fn construction(text: &mut String, solution: &Solution, view: &View) {
    let geometry = &solution.geometry;
    let centres = [
        (Point2::origin(), geometry.driver.base),
        (Point2::new(geometry.centre_distance, 0.0), geometry.driven.base),
    ];
    for (centre, radius) in centres {
        let ((x, y), radius) = (view.at(centre), radius * view.scale);
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" class=\"mark\"/>"
        );
    }
    let mut line = |from: f64, to: f64, class: &str| {
        let ends = [from, to].map(|length| view.at(on_line_of_action(geometry, length)));
        let [(x, y), (to_x, to_y)] = ends;
        let _ =
            writeln!(text, "<path d=\"M{x:.2} {y:.2}L{to_x:.2} {to_y:.2}\" class=\"{class}\"/>");
    };
    line(0.0, geometry.tangent_length, "mark");
    line(geometry.start, geometry.end, "path");
}

/// D, E, the pitch point P and the end of contact B.
fn points(text: &mut String, solution: &Solution, view: &View) {
    let geometry = &solution.geometry;
    let on_line = |length| view.at(on_line_of_action(geometry, length));
    let mut named = vec![
        ("E", on_line(geometry.start), "start"),
        ("P", on_line(geometry.start + geometry.approach_length), "start"),
        ("B", on_line(geometry.end), "start"),
    ];
    if let Some(contact) = first_contact_point(solution) {
        named.push(("D", view.at(contact), "end"));
    }
    for (name, (x, y), anchor) in named {
        let beside = if anchor == "end" { x - 9.0 } else { x + 9.0 };
        let base = y + 4.0;
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" class=\"f1\"/>\
             <text x=\"{beside:.1}\" y=\"{base:.1}\" text-anchor=\"{anchor}\" class=\"title \
                 halo\">{name}</text>"
        );
    }
}

/// The caption, and a scale bar of a round length.
fn caption(text: &mut String, view: &View) {
    let length = round_below(150.0 / view.scale);
    let (dots, name) = (length * view.scale, printed(length));
    let (left, base) = (WINDOW.0, HEIGHT - 14.0);
    let first = base - 21.0;
    let bar = WIDTH - WINDOW.0 - dots;
    let (middle, above) = (bar + dots / 2.0, base - 8.0);
    let _ = writeln!(
        text,
        "<text x=\"{left}\" y=\"{first}\">Driver left, driven gear right; E to B: path of contact.</text>\n\
         <text x=\"{left}\" y=\"{base}\">Reliefs are not drawn.</text>\n\
         <path d=\"M{bar:.1} {base}v-5v5h{dots:.1}v-5\" class=\"axis\"/>\
         <text x=\"{middle:.1}\" y=\"{above}\" text-anchor=\"middle\">{name}</text>"
    );
}

/// The greatest length of 1, 2 or 5 times a power of ten not above `length`, in m.
fn round_below(length: f64) -> f64 {
    let power = 10f64.powf(length.log10().floor());
    let times = [5.0, 2.0, 1.0].into_iter().find(|times| times * power <= length);
    times.unwrap_or(1.0) * power
}

fn printed(length: f64) -> String {
    let millimetres = length * 1e3;
    if millimetres >= 1.0 {
        format!("{millimetres:.0} mm")
    } else {
        format!("{:.0} µm", length * 1e6)
    }
}
