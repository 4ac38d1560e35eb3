//! The edge between flank and tip circle: its rounding, or its chamfer.

use nalgebra::{Point2, Vector2};

use crate::model::profile::Profile;
use crate::numeric::root::last_where;

/// The rounding between flank and tip circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    pub(super) centre: Point2<f64>,
    pub(super) radius: f64,
    /// Roll angle at the end of the involute, in rad.
    pub(super) roll: f64,
}

/// The chamfer between flank and tip circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bevel {
    pub(super) from: Point2<f64>,
    pub(super) to: Point2<f64>,
}

/// The rounding with the given radius, or the largest one that fits the tip.
pub(super) fn widest_edge(profile: &Profile, flank_end: f64, radius: f64) -> Option<Edge> {
    edge(
        profile,
        flank_end,
        last_where(0.0, radius, |radius| edge(profile, flank_end, radius).is_some()),
    )
}

/// The rounding of a radius, tangent to the involute and inside the tip circle. `None` if it does
/// not fit.
///
/// # Formula
/// ```text
/// (rb φ − re)² + rb² = (ra − re)²
/// ```
/// The curve at the distance r_e inside an involute is an involute of the same base circle with a
/// string shorter by r_e.
fn edge(profile: &Profile, flank_end: f64, radius: f64) -> Option<Edge> {
    let circles = profile.circles();
    let over_base = circles.tip - radius - circles.base;
    if !(radius > 0.0 && over_base >= 0.0) {
        return None;
    }
    let roll = (radius + (over_base * (circles.tip - radius + circles.base)).sqrt()) / circles.base;
    let angle = profile.load_angle(roll);
    let centre =
        profile.involute_at(roll).point() - Vector2::new(angle.sin(), angle.cos()) * radius;
    (centre.y >= 0.0 && roll >= profile.junction.roll && roll <= flank_end).then_some(Edge {
        centre,
        radius,
        roll,
    })
}

/// The bevel at 45 degrees from the corner of the flank to the tip circle. It ends at the centre
/// line if the tooth is too thin.
pub(super) fn bevel(corner: Point2<f64>, tip: f64) -> Bevel {
    let skew = corner.x - corner.y;
    let rise = (tip - corner.coords.norm()) * (tip + corner.coords.norm());
    let way = rise / (skew + (skew * skew + 2.0 * rise).sqrt());
    let way = way.min(corner.y);
    Bevel { from: corner, to: corner + Vector2::new(way, -way) }
}
