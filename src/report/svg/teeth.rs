//! Draws the teeth of a pair around the contact, true to scale.

use std::fmt::Write;

use nalgebra::{Point2, Vector2};

use super::{escaped, opening};
use crate::case::units::System;
use crate::model::contact_state::{first_contact_of_driver, first_contact_point};
use crate::model::outline::on_line_of_action;
use crate::model::{ContactState, Inputs, Solution};
use crate::report::teeth::{Ink, Scene, Window, scale_bar};

const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 388.0;
/// Left, top, width and height of the window.
const WINDOW: (f64, f64, f64, f64) = (10.0, 34.0, 540.0, 296.0);
/// Additional height of the window, relative to the length of the path of contact.
const MARGIN: f64 = 0.35;
/// Size of the smallest visible detail, and least distance of two named points.
const DOT: f64 = 0.2;
const APART: f64 = 14.0;
/// Greatest length of the scale bar.
const BAR: f64 = 110.0;

/// Draws the teeth at the first contact, or at E without corner contact.
#[must_use]
pub fn teeth(inputs: &Inputs, solution: &Solution) -> String {
    let contact = first_contact_of_driver(solution);
    let title = if contact.is_some() {
        "Teeth at the first contact D"
    } else {
        "Teeth at E, without corner contact"
    };
    let (window, scale) = window(solution);
    let moment = ContactState::at(inputs, solution, contact.unwrap_or(0.0));
    let lead = moment.as_ref().map_or(0.0, |moment| moment.lead(1.0));
    let scene = Scene::of(inputs, solution, moment.as_ref(), lead, &window);
    let at = |point: Point2<f64>| {
        let off = (point - window.centre) * scale;
        (WINDOW.2 / 2.0 + off.x, WINDOW.3 / 2.0 - off.y)
    };
    let (left, top, width, height) = WINDOW;
    let mut text = opening(&escaped(title), WIDTH, HEIGHT);
    let _ = writeln!(
        text,
        "<text x=\"{left}\" y=\"22\" class=\"title\">{title}</text>\n\
         <svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" overflow=\"hidden\">"
    );
    let listed = |points: &mut dyn Iterator<Item = Point2<f64>>| {
        points.map(&at).map(|(x, y)| format!("{x:.2},{y:.2}")).collect::<Vec<_>>().join(" ")
    };
    let centres = [Point2::origin(), Point2::new(solution.geometry.centre_distance, 0.0)];
    for (gear, centre) in centres.into_iter().enumerate() {
        let (inks, count) = [
            ([Ink::Driver, Ink::StruckTooth], inputs.driver.teeth),
            ([Ink::Driven, Ink::IncomingTooth], inputs.driven.teeth),
        ][gear];
        let teeth: Vec<_> = scene.lines.iter().filter(|(ink, _)| inks.contains(ink)).collect();
        // Unless the whole gear is visible, the outline is closed at the centre.
        let end = (teeth.len() < count as usize).then_some(centre);
        let outline = teeth.iter().flat_map(|(_, points)| points.iter().copied());
        let points = listed(&mut outline.chain(end));
        let _ = writeln!(text, "<polygon points=\"{points}\" class=\"body{}\"/>", gear + 1);
    }
    for (ink, points) in &scene.lines {
        let class = match ink {
            Ink::BaseCircle | Ink::LineOfAction => "mark",
            Ink::PathOfContact => "path",
            _ => continue,
        };
        let points = listed(&mut points.iter().copied());
        let _ = writeln!(text, "<polyline points=\"{points}\" class=\"{class}\"/>");
    }
    for (name, point) in scene.distinct_points(&window, APART / scale) {
        let (x, y) = at(point);
        let (anchor, beside) = if name == "D" { ("end", x - 9.0) } else { ("start", x + 9.0) };
        let base = y + 4.0;
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"4\" class=\"f1\"/>\
             <text x=\"{beside:.1}\" y=\"{base:.1}\" text-anchor=\"{anchor}\" class=\"title \
                 halo\">{name}</text>"
        );
    }
    let (length, name) = scale_bar(BAR / scale, System::Metric);
    let (dots, base) = (length * scale, HEIGHT - 14.0);
    let (first, bar, above) = (base - 21.0, WIDTH - left - dots, base - 8.0);
    let middle = bar + dots / 2.0;
    text + &format!(
        "</svg>\n<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" class=\"axis\"/>\n\
         <text x=\"{left}\" y=\"{first}\">Driver left, driven gear right; E to B: path of contact.</text>\n\
         <text x=\"{left}\" y=\"{base}\">Reliefs are not drawn.</text>\n\
         <path d=\"M{bar:.1} {base}v-5v5h{dots:.1}v-5\" class=\"axis\"/>\
         <text x=\"{middle:.1}\" y=\"{above}\" text-anchor=\"middle\">{name}</text>\n</svg>\n"
    )
}

/// The part of the plane around the path of contact, with the pixels per metre.
fn window(solution: &Solution) -> (Window, f64) {
    let geometry = &solution.geometry;
    let ends = [geometry.start, geometry.end].map(|length| on_line_of_action(geometry, length));
    let tip = first_contact_point(solution).unwrap_or(ends[0]);
    let high = [ends[0].y, ends[1].y, tip.y];
    let least = high.into_iter().fold(f64::INFINITY, f64::min);
    let most = high.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let scale = WINDOW.3 / ((most - least) * (1.0 + MARGIN) + geometry.base_pitch * 0.4);
    let centre = Point2::new(f64::midpoint(ends[0].x, ends[1].x), f64::midpoint(least, most));
    let half = Vector2::new(WINDOW.2, WINDOW.3) / (2.0 * scale);
    (Window { centre, half, dot: DOT / scale }, scale)
}
