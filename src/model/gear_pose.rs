//! Positions of the teeth at a roll angle. O₁ is at the origin, O₂ at (a, 0), and the driver turns
//! clockwise.

use std::f64::consts::{PI, TAU};

use nalgebra::{Isometry2, Point2};

use super::geometry::{Geometry, foot};
use super::inputs::Inputs;
use super::outline::Outline;
use super::tip_gap::TipContact;

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
    #[must_use]
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
    #[must_use]
    pub fn pitch(&self) -> f64 {
        TAU / f64::from(self.teeth)
    }

    /// The pose of a tooth, numbered from the incoming tooth.
    #[must_use]
    pub fn tooth(&self, number: i64) -> Isometry2<f64> {
        Isometry2::new(self.centre.coords, self.turn + number as f64 * self.pitch())
    }

    /// The gear turned by an angle, in rad.
    #[must_use]
    pub fn turned(&self, angle: f64) -> Placed {
        Placed { turn: self.turn + angle, ..*self }
    }
}

/// N₁, where the line of action is tangent to the driver's base circle.
#[must_use]
pub fn driver_tangent_point(geometry: &Geometry) -> Point2<f64> {
    on_line_of_action(geometry, 0.0)
}

/// N₂, where the line of action is tangent to the driven gear's base circle.
#[must_use]
pub fn driven_tangent_point(geometry: &Geometry) -> Point2<f64> {
    on_line_of_action(geometry, geometry.tangent_length)
}

/// The point of the line of action at the distance `length` from N₁, in m.
#[must_use]
pub fn on_line_of_action(geometry: &Geometry, length: f64) -> Point2<f64> {
    Point2::from(foot(geometry.driver.base, length, geometry.working_pressure_angle))
}

/// The driven tip on its circle. For a rounded tip, the point of its arc that faces the driver's
/// flank.
#[must_use]
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
    use crate::model::Solution;
    use crate::model::contact_state::ContactState;
    use crate::model::outline::Piece;
    use crate::model::sample::standard_pair;
    use crate::model::{Stages, solve};

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
