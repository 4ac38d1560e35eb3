//! The outline of a gear's tooth, piece by piece from the root to the tip, and the positions of the
//! teeth at a roll angle.

use super::geometry::{Circles, Geometry, foot};
use super::inputs::{Gear, Inputs};
use super::position::TipContact;
use super::profile::{Profile, Rack};
use crate::numeric::root::last_where;
use nalgebra::{Isometry2, Point2, Vector2};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The outline of a tooth in a frame whose x axis is the tooth's centre line, from the gear's
/// centre.
///
/// The tooth is symmetric: the type describes the half with y above 0. A chamfer is a bevel at 45
/// degrees to the centre line, from the active tip circle to the tip circle, because a case does
/// not give its angle. A tip with a radius has no bevel. The outline does not show reliefs of some
/// micrometres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    profile: Profile,
    /// Angle of the rack's normal at which the fillet ends, in rad.
    fillet_end: f64,
    /// Roll angle at which the involute ends, in rad. Without an involute it is at most the roll
    /// angle of the junction.
    flank_end: f64,
    edge: Option<Edge>,
    bevel: Option<Bevel>,
    /// Radius at which the tooth ends, in m.
    tip_radius: f64,
    /// Angle between the centre line and the end of the tip circle, in rad.
    tip_half_angle: f64,
}

/// A piece of the outline.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Piece {
    /// The trochoid of the rack's rounding.
    Fillet,
    /// The involute, from the form circle.
    Flank,
    /// The rounding of the tip's edge.
    Edge,
    /// The chamfer of the tip's edge.
    Bevel,
    /// The tip circle.
    Tip,
}

impl Piece {
    /// Every piece, from the root to the tip.
    pub const ALL: [Piece; 5] =
        [Piece::Fillet, Piece::Flank, Piece::Edge, Piece::Bevel, Piece::Tip];
}

impl Outline {
    /// The outline of the gear's teeth.
    ///
    /// A pointed tooth ends at the intersection of its flanks. A rounding too large for the tip is
    /// reduced to the largest possible rounding.
    pub fn of(inputs: &Inputs, gear: &Gear, circles: &Circles) -> Outline {
        let profile = Profile::of(&Rack::of(inputs, gear), circles);
        let (fillet_end, flank_end) = (profile.fillet_end(), profile.flank_end());
        let edge = gear.tip_radius.and_then(|radius| widest_edge(&profile, flank_end, radius));
        let sharp = if flank_end > profile.junction.roll {
            profile.involute_at(flank_end)
        } else {
            profile.fillet_at(fillet_end)
        };
        let corner = edge.map_or(sharp.point(), |edge| edge.centre);
        let pointed = edge.is_none() && flank_end < profile.tip_roll();
        let bevel = (edge.is_none() && !pointed && gear.tip_chamfer > 0.0)
            .then(|| bevel(corner, circles.tip + gear.tip_chamfer));
        let end = bevel.map_or(corner, |bevel| bevel.to);
        Outline {
            profile,
            fillet_end,
            flank_end: edge.map_or(flank_end, |edge| edge.roll),
            edge,
            bevel,
            tip_radius: if pointed || bevel.is_some() { end.coords.norm() } else { circles.tip },
            tip_half_angle: end.y.atan2(end.x),
        }
    }

    /// The profile of the tooth.
    pub fn profile(&self) -> &Profile {
        &self.profile
    }

    /// Radius at which the tooth ends, in m: the tip circle, or less for a pointed tooth.
    pub fn tip_radius(&self) -> f64 {
        self.tip_radius
    }

    /// The pieces that the tooth has, from the root to the tip.
    pub fn pieces(&self) -> impl Iterator<Item = Piece> + use<> {
        let has_flank = self.flank_end > self.profile.junction.roll;
        let (has_edge, has_bevel) = (self.edge.is_some(), self.bevel.is_some());
        Piece::ALL.into_iter().filter(move |piece| match piece {
            Piece::Fillet | Piece::Tip => true,
            Piece::Flank => has_flank,
            Piece::Edge => has_edge,
            Piece::Bevel => has_bevel,
        })
    }

    /// The point of a piece at `part` of its parameter, from the root end (0) to the tip end (1).
    pub fn at(&self, piece: Piece, part: f64) -> Point2<f64> {
        let between = |from: f64, to: f64| from + part * (to - from);
        match (piece, self.edge, self.bevel) {
            (Piece::Fillet, ..) => {
                self.profile.fillet_at(between(FRAC_PI_2, self.fillet_end)).point()
            }
            (Piece::Edge, Some(edge), _) => {
                let string = FRAC_PI_2 - self.profile.load_angle(edge.roll);
                edge.centre + along(between(string, self.tip_half_angle)) * edge.radius
            }
            (Piece::Bevel, _, Some(bevel)) => bevel.from + (bevel.to - bevel.from) * part,
            (Piece::Flank | Piece::Edge | Piece::Bevel, ..) => self
                .profile
                .involute_at(between(self.profile.junction.roll, self.flank_end))
                .point(),
            (Piece::Tip, ..) => {
                Point2::from(along(between(self.tip_half_angle, 0.0)) * self.tip_radius)
            }
        }
    }

    /// The whole tooth as points, from the middle of one space to the middle of the next. The root
    /// circle and each piece have `steps` equal steps of the parameter.
    pub fn tooth(&self, steps: usize) -> Vec<Point2<f64>> {
        let part = move |step: usize| step as f64 / steps.max(1) as f64;
        let (space, root, radius) = (
            self.profile.half_pitch(),
            self.profile.root_half_angle(),
            self.profile.circles().root,
        );
        let land = (0..=steps)
            .map(|step| Point2::from(along(space + part(step) * (root - space)) * radius));
        let rise =
            self.pieces().flat_map(|piece| (0..=steps).map(move |step| self.at(piece, part(step))));
        let half: Vec<_> = land.chain(rise).collect();
        let lower = half.iter().map(|point| Point2::new(point.x, -point.y));
        lower.chain(half.iter().rev().copied()).collect()
    }
}

/// The unit vector at an angle to the centre line.
fn along(angle: f64) -> Vector2<f64> {
    Vector2::new(angle.cos(), angle.sin())
}

/// The rounding between flank and tip circle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Edge {
    centre: Point2<f64>,
    radius: f64,
    /// Roll angle at the end of the involute, in rad.
    roll: f64,
}

/// The chamfer between flank and tip circle.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bevel {
    from: Point2<f64>,
    to: Point2<f64>,
}

/// The rounding with the given radius, or the largest one that fits the tip.
fn widest_edge(profile: &Profile, flank_end: f64, radius: f64) -> Option<Edge> {
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
fn bevel(corner: Point2<f64>, tip: f64) -> Bevel {
    let skew = corner.x - corner.y;
    let rise = (tip - corner.coords.norm()) * (tip + corner.coords.norm());
    let way = rise / (skew + (skew * skew + 2.0 * rise).sqrt());
    let way = way.min(corner.y);
    Bevel { from: corner, to: corner + Vector2::new(way, -way) }
}

/// The two gears at a roll angle. Tooth 0 of each gear belongs to the incoming pair. Teeth are
/// numbered counterclockwise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GearPose {
    /// The driver.
    pub driver: Placed,
    /// The driven gear.
    pub driven: Placed,
}

/// One gear at a roll angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// The outline of its teeth.
    pub outline: Outline,
    /// Number of teeth z.
    pub teeth: u32,
    /// The gear's centre, in m.
    pub centre: Point2<f64>,
    /// Direction of the centre line of tooth 0, in rad.
    pub turn: f64,
}

impl GearPose {
    /// The pair at the driver's angle `roll_angle` before E, in rad, with flanks in contact on the
    /// line of action.
    ///
    /// # Formula
    /// ```text
    /// driver: αw − N1E/rb1 + θ + ψ1,   driven: π + αw − N2E/rb2 − θ/i + ψ2
    /// ```
    /// These are the directions of the centre lines of the teeth 0. ψ is half of the tooth's angle
    /// at the base circle. At E the driver's involute begins N₁E/r_b1 before N₁; the driven
    /// involute accordingly.
    pub fn nominal(inputs: &Inputs, geometry: &Geometry, roll_angle: f64) -> GearPose {
        let driver = Outline::of(inputs, &inputs.driver, &geometry.driver);
        let driven = Outline::of(inputs, &inputs.driven, &geometry.driven);
        let start = |outline: &Outline, curvature: f64| {
            let profile = outline.profile();
            geometry.working_pressure_angle - curvature / profile.circles().base
                + profile.base_half_angle()
        };
        GearPose {
            driver: Placed {
                outline: driver,
                teeth: inputs.driver.teeth,
                centre: Point2::origin(),
                turn: start(&driver, geometry.start) + roll_angle,
            },
            driven: Placed {
                outline: driven,
                teeth: inputs.driven.teeth,
                centre: Point2::new(geometry.centre_distance, 0.0),
                turn: PI + start(&driven, geometry.driven.tip_curvature)
                    - roll_angle / inputs.ratio(),
            },
        }
    }
}

impl Placed {
    /// Angle from one tooth to the next, in rad.
    pub fn pitch(&self) -> f64 {
        TAU / f64::from(self.teeth)
    }

    /// The pose of a tooth, numbered from the incoming tooth.
    pub fn tooth(&self, number: i64) -> Isometry2<f64> {
        Isometry2::new(self.centre.coords, self.turn + number as f64 * self.pitch())
    }

    /// The gear turned by an angle, in rad.
    pub fn turned(&self, angle: f64) -> Placed {
        Placed { turn: self.turn + angle, ..*self }
    }
}

/// N₁, where the line of action is tangent to the driver's base circle.
pub fn driver_tangent_point(geometry: &Geometry) -> Point2<f64> {
    on_line_of_action(geometry, 0.0)
}

/// N₂, where the line of action is tangent to the driven gear's base circle.
pub fn driven_tangent_point(geometry: &Geometry) -> Point2<f64> {
    on_line_of_action(geometry, geometry.tangent_length)
}

/// The point of the line of action at the distance `length` from N₁, in m.
pub fn on_line_of_action(geometry: &Geometry, length: f64) -> Point2<f64> {
    Point2::from(foot(geometry.driver.base, length, geometry.working_pressure_angle))
}

/// The driven tip on its circle. For a rounded tip, the point of its arc that faces the driver's
/// flank.
pub fn tip_point(geometry: &Geometry, tip: &TipContact) -> Point2<f64> {
    let (sine, cosine) = tip.polar_angle.sin_cos();
    let edge = geometry.driven.edge;
    let radius = geometry.driven.tip - edge;
    let (across, along) = (geometry.working_pressure_angle + tip.normal_turn).sin_cos();
    Point2::new(
        geometry.centre_distance - radius * cosine - edge * across,
        radius * sine + edge * along,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::contact_state::ContactState;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;
    use crate::model::{Solution, Stages, solve};

    /// Outlines of ordinary, shifted, undercut and rounded teeth, with their inputs.
    fn outlines() -> Vec<(String, Outline, Inputs)> {
        let kinds: [(u32, f64, Option<f64>); 7] = [
            (20, 0.0, None),
            (12, 0.5, None),
            (100, -0.3, None),
            (9, 0.0, None),
            (20, 0.0, Some(0.2e-3)),
            (40, 0.3, Some(2e-3)),
            (30, 0.8, Some(1e-9)),
        ];
        let outline = |(teeth, shift, tip_radius): (u32, f64, Option<f64>)| {
            let mut inputs = standard_pair(teeth, 60, 5e-3);
            inputs.driven.addendum = if tip_radius.is_some() { 0.8 } else { 0.3 };
            (inputs.driver.profile_shift, inputs.driver.tip_radius) = (shift, tip_radius);
            let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
            (
                format!("z {teeth} x {shift} re {tip_radius:?}"),
                Outline::of(&inputs, &inputs.driver, &circles),
                inputs,
            )
        };
        kinds.map(outline).into()
    }

    /// Angle between the centre line and the involute at a radius, in rad, by its polar equation.
    fn involute_angle(inputs: &Inputs, radius: f64) -> f64 {
        let (gear, alpha) = (&inputs.driver, inputs.pressure_angle);
        let involute = |angle: f64| angle.tan() - angle;
        let at_reference =
            (PI / 2.0 + 2.0 * gear.profile_shift * alpha.tan()) / f64::from(gear.teeth);
        let base = inputs.module * f64::from(gear.teeth) / 2.0 * alpha.cos();
        at_reference + involute(alpha) - involute((base / radius).min(1.0).acos())
    }

    #[test]
    fn flanks_are_on_the_involute() {
        for (name, outline, inputs) in outlines() {
            for step in 0..=40 {
                let point = outline.at(Piece::Flank, f64::from(step) / 40.0);
                let radius = point.coords.norm();
                let off = radius * (point.y.atan2(point.x) - involute_angle(&inputs, radius));
                // Near the base circle acos amplifies an error of 1e-16 in the radius to 1e-8 of
                // the angle.
                let tolerance =
                    if radius < 1.0001 * outline.profile().circles().base { 1e-9 } else { 1e-12 };
                assert!(
                    off.abs() < tolerance * inputs.module,
                    "{name}: error {off:e} m at {radius}"
                );
            }
        }
    }

    #[test]
    fn pieces_join_without_a_gap() {
        for (name, outline, inputs) in outlines() {
            let pieces: Vec<_> = outline.pieces().collect();
            for pair in pieces.windows(2) {
                let gap = (outline.at(pair[0], 1.0) - outline.at(pair[1], 0.0)).norm();
                assert!(gap < 1e-9 * inputs.module, "{name}: {gap:e} m between {pair:?}");
            }
            let root = outline.at(Piece::Fillet, 0.0).coords.norm();
            assert!(
                (root - outline.profile().circles().root).abs() < 1e-12 * inputs.module,
                "{name}"
            );
            let tip = outline.at(Piece::Tip, 1.0);
            assert!(tip.y.abs() < 1e-15 && (tip.x - outline.tip_radius()).abs() < 1e-15, "{name}");
        }
    }

    #[test]
    fn thickness_at_the_reference_circle_agrees_with_the_rack() {
        for (name, outline, inputs) in outlines() {
            let reference = outline.profile().circles().reference;
            let steps = 20_000;
            let on_circle = outline.tooth(steps).windows(2).find_map(|pair| {
                let (inner, outer) = (pair[0].coords.norm(), pair[1].coords.norm());
                let part = (reference - inner) / (outer - inner);
                (inner <= reference && reference < outer)
                    .then(|| pair[0] + (pair[1] - pair[0]) * part)
            });
            let point = on_circle.unwrap();
            let thickness = 2.0 * reference * (-point.y).atan2(point.x);
            let expected = inputs.module
                * (PI / 2.0 + 2.0 * inputs.driver.profile_shift * inputs.pressure_angle.tan());
            assert!(
                (thickness - expected).abs() < 1e-8 * inputs.module,
                "{name}: {thickness} m for {expected}"
            );
        }
    }

    /// The arc is tangent to the involute and to the tip circle.
    #[test]
    fn rounded_edges_are_tangent_to_flank_and_tip() {
        const STEP: f64 = 1e-5;
        for (name, outline, _) in outlines() {
            let Some(edge) = outline.edge else { continue };
            let turn =
                |from: Vector2<f64>, to: Vector2<f64>| from.normalize().perp(&to.normalize()).abs();
            let into = outline.at(Piece::Edge, STEP) - outline.at(Piece::Edge, 0.0);
            let out = outline.at(Piece::Edge, 1.0) - outline.at(Piece::Edge, 1.0 - STEP);
            let flank = outline.at(Piece::Flank, 1.0) - outline.at(Piece::Flank, 1.0 - STEP);
            assert!(
                turn(flank, into) < 1e-3,
                "{name}: kink of {} at the flank, {edge:?}",
                turn(flank, into)
            );
            let tip = outline.at(Piece::Edge, 1.0).coords;
            let across = tip.normalize().dot(&out.normalize());
            assert!(across.abs() < 1e-3, "{name}: kink of {across} at the tip, {edge:?}");
        }
    }

    #[test]
    fn a_chamfer_leaves_a_bevel_from_the_lower_tip_to_the_tip_circle() {
        let mut inputs = standard_pair(20, 60, 5e-3);
        inputs.driver.tip_chamfer = 0.4e-3;
        let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
        let outline = Outline::of(&inputs, &inputs.driver, &circles);
        let (corner, end) = (outline.at(Piece::Bevel, 0.0), outline.at(Piece::Bevel, 1.0));
        assert!((corner.coords.norm() - circles.tip).abs() < 1e-15);
        assert!((corner - outline.at(Piece::Flank, 1.0)).norm() < 1e-15);
        assert!((end.coords.norm() - 55e-3).abs() < 1e-15);
        assert!(((end.x - corner.x) + (end.y - corner.y)).abs() < 1e-15);
        assert!((outline.tip_radius() - 55e-3).abs() < 1e-15);
        // A tooth thinner than the chamfer ends on its centre line.
        inputs.driver.tip_chamfer = 4e-3;
        inputs.driver.addendum = 1.5;
        let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
        let thin = Outline::of(&inputs, &inputs.driver, &circles);
        assert!(thin.at(Piece::Bevel, 1.0).y.abs() < 1e-15);
    }

    #[test]
    fn pointed_teeth_end_at_the_intersection_of_their_flanks() {
        let mut inputs = standard_pair(12, 60, 5e-3);
        (inputs.driver.addendum, inputs.driver.profile_shift, inputs.driven.addendum) =
            (1.4, 0.6, 0.3);
        let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
        let outline = Outline::of(&inputs, &inputs.driver, &circles);
        assert!(outline.profile().tip_thickness() < 0.0);
        assert!(outline.tip_radius() < circles.tip);
        assert!(outline.at(Piece::Flank, 1.0).y.abs() < 1e-15);
        assert!(
            outline
                .tooth(50)
                .iter()
                .all(|point| point.coords.norm() <= outline.tip_radius() * (1.0 + 1e-12))
        );
    }

    /// Pairs with a deviation: equal gears, speed reducing, speed increasing, with profile shift,
    /// with a wide centre distance, with undercut teeth.
    fn solved() -> Vec<(String, Inputs, Solution)> {
        let kinds = [
            (20, 20, 0.0, 0.0, None),
            (20, 60, 0.2, 0.0, None),
            (60, 20, -0.1, 0.3, None),
            (33, 47, 0.3, -0.2, None),
            (25, 30, 0.0, 0.0, Some(139e-3)),
            (12, 15, 0.0, 0.0, None),
        ];
        let pair = |(driver, driven, first, second, centre_distance): (
            u32,
            u32,
            f64,
            f64,
            Option<f64>,
        )| {
            let mut inputs = standard_pair(driver, driven, 5e-3);
            (inputs.driver.profile_shift, inputs.driven.profile_shift) = (first, second);
            (inputs.centre_distance, inputs.deflection) = (centre_distance, Some(30e-6));
            if driver == 12 {
                (inputs.driver.addendum, inputs.driven.addendum) = (0.7, 0.7);
            }
            let solution = solve(&inputs, Stages::CLOSED_FORM).unwrap();
            (format!("z {driver}/{driven} x {first}/{second}"), inputs, solution)
        };
        kinds.map(pair).into()
    }

    /// Gap between a point and the driver's flank along the flank's normal, in m, by unwinding a
    /// string from the base circle. Independent of the model.
    fn gap_to_struck_flank(driver: &Placed, point: Point2<f64>) -> f64 {
        let profile = driver.outline.profile();
        let base = profile.circles().base;
        let string = (point.coords.norm_squared() - base * base).sqrt();
        let tangent = point.y.atan2(point.x) + (string / base).atan();
        string - base * (tangent - (driver.turn - profile.base_half_angle()))
    }

    /// The flank of tooth 0 that meets the other gear.
    fn working_flank(gear: &Placed, steps: usize) -> Vec<Point2<f64>> {
        let lower = |step: usize| {
            let point = gear.outline.at(Piece::Flank, step as f64 / steps as f64);
            gear.tooth(0) * Point2::new(point.x, -point.y)
        };
        (0..=steps).map(lower).collect()
    }

    /// Least distance between two polylines.
    fn distance(one: &[Point2<f64>], other: &[Point2<f64>]) -> (f64, Point2<f64>) {
        let pairs = one.iter().flat_map(|p| other.iter().map(move |q| ((p - q).norm(), *p)));
        pairs.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
    }

    #[test]
    fn flanks_touch_on_the_line_of_action_and_do_not_overlap() {
        for (name, inputs, solution) in solved() {
            let geometry = solution.geometry;
            for part in [0.02, 0.3, 0.6, 0.98] {
                let length = geometry.start + part * (geometry.end - geometry.start);
                let angle = (geometry.start - length) / geometry.driver.base;
                let placing = GearPose::nominal(&inputs, &geometry, angle);
                let (driver, driven) =
                    (working_flank(&placing.driver, 1000), working_flank(&placing.driven, 1000));
                let (gap, place) = distance(&driver, &driven);
                assert!(gap < 1e-3 * inputs.module, "{name}: {gap:e} m apart at {part}");
                let off = (place - on_line_of_action(&geometry, length)).norm();
                assert!(
                    off < 0.1 * inputs.module,
                    "{name}: {off:e} m from the line of action at {part}"
                );
                let gaps = driven.iter().map(|point| gap_to_struck_flank(&placing.driver, *point));
                let least = gaps.filter(|gap| gap.is_finite()).fold(f64::INFINITY, f64::min);
                assert!(
                    (-1e-12..1e-6 * inputs.module).contains(&least),
                    "{name}: gap {least:e} m at {part}"
                );
            }
        }
    }

    #[test]
    fn the_gap_is_the_distance_of_the_tip_from_the_flank() {
        for (name, inputs, solution) in solved() {
            for part in [0.1, 0.5, 1.0, 2.0] {
                let angle = part * solution.position.unwrap().approach_angle_driver;
                let moment = ContactState::at(&inputs, &solution, angle).unwrap();
                let placing = GearPose::nominal(&inputs, &solution.geometry, angle);
                let tip = *working_flank(&placing.driven, 1).last().unwrap();
                assert!(
                    (tip - moment.point).norm() < 1e-12 * inputs.module,
                    "{name}: the tooth's tip is not the tip"
                );
                let gap = gap_to_struck_flank(&placing.driver, tip);
                assert!((gap - moment.gap).abs() < 1e-12, "{name}: {gap:e} m for {:e}", moment.gap);
                let flank = working_flank(&placing.driver, 200_000);
                let (nearest, _) = distance(&flank, &[tip]);
                assert!(
                    (nearest - gap).abs() < 1e-3 * gap + 1e-9,
                    "{name}: {nearest:e} m to the points for {gap:e}"
                );
            }
        }
    }

    /// In the frame of the driver, which is ahead by the deviation, the tip touches the flank at D.
    #[test]
    fn the_path_of_the_tip_touches_the_flank_at_d() {
        for (name, inputs, solution) in solved() {
            let contact = solution.position.unwrap().approach_angle_driver;
            let gap_at = |part: f64, factor: f64| {
                let moment = ContactState::at(&inputs, &solution, part * contact).unwrap();
                let placing = GearPose::nominal(&inputs, &solution.geometry, part * contact);
                let lead = moment.lead(factor) / solution.geometry.driver.base;
                (gap_to_struck_flank(&placing.driver.turned(-lead), moment.point), moment.opening)
            };
            for factor in [1.0, 7.5, 100.0] {
                for part in [2.0, 1.5, 1.1, 1.01, 1.0001] {
                    let (gap, opening) = gap_at(part, factor);
                    assert!(
                        gap > 0.0 && (gap - factor * opening).abs() < 1e-13,
                        "{name}: {gap:e} m, not {factor} x {opening:e}"
                    );
                }
                for part in [1.0, 0.7, 0.1, 0.0] {
                    assert!(gap_at(part, factor).0.abs() < 1e-13, "{name}: no touch at {part}");
                }
            }
        }
    }

    #[test]
    fn n1_and_n2_are_on_the_base_circles() {
        for (name, _, solution) in solved() {
            let geometry = solution.geometry;
            let centre = Point2::new(geometry.centre_distance, 0.0);
            let first = driver_tangent_point(&geometry).coords.norm() - geometry.driver.base;
            let second = (driven_tangent_point(&geometry) - centre).norm() - geometry.driven.base;
            assert!(first.abs() < 1e-15 && second.abs() < 1e-15, "{name}: {first:e} {second:e}");
        }
    }
}
