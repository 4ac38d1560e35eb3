//! The incoming pair at one roll angle: where tip and flank face each other, and every value there.

use nalgebra::Point2;

use super::impact::Masses;
use super::inputs::Inputs;
use super::placing::{on_line_of_action, tip_point};
use super::tip::{self, tip_at};
use super::velocity::velocity;
use super::{Solution, stations};

/// The incoming pair at a roll angle.
///
/// Before E the driven tip faces the driver's flank. From E on the pair meets on the line of action, as far as B.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Driver's angle before E, in rad; below 0 after E.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, u, in rad.
    pub roll_angle_driven: f64,
    /// The driven tip, or after E the contact on the line of action, in m; O₁ at the origin, O₂ at (a, 0).
    pub point: Point2<f64>,
    /// Its distance from O₁, O₁J, in m.
    pub radius_driver: f64,
    /// Gap S(u) that the involutes without deviation leave between tip and flank, in m; 0 from E on.
    pub gap: f64,
    /// What is left of it to close, S(u) − Δ, in m; 0 in contact.
    pub opening: f64,
    /// Approach velocity ΔV_n, in m/s.
    pub normal_velocity: f64,
    /// Sliding velocity ΔV_τ, in m/s.
    pub sliding_velocity: f64,
    /// The impact force, in N, if the tooth struck here; only from D to E, and where it can be computed.
    pub impact_force: Option<f64>,
}

impl Moment {
    /// The incoming pair where the driver stands `roll_angle` before E, in rad, held within what can be: a driven angle of
    /// [`MOST_ANGLE`] before E, and B after it. `None` where the tip would be inside the driver's base circle.
    ///
    /// # Formula
    /// ```text
    /// u = θ/i,  opening = max(0, S(u) − Δ),  S(u ≤ 0) = 0
    /// ```
    ///
    /// # Source
    /// The gap, the velocities and the force of the rung `exact` in every rung, so that what is seen is what the involutes do.
    #[must_use]
    pub fn at(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<Moment> {
        let geometry = &solution.geometry;
        let last = (geometry.start - geometry.end) / geometry.driver.base;
        let roll_angle = roll_angle.max(last).min(MOST_ANGLE * inputs.ratio());
        let moment = if roll_angle < 0.0 { after(inputs, solution, roll_angle) } else { before(inputs, solution, roll_angle) };
        moment.is_sound().then_some(moment)
    }

    /// How far the struck flank is ahead of its nominal place along the line of action when the opening is shown `factor`
    /// times as wide, in m.
    ///
    /// # Formula
    /// ```text
    /// S(u) − factor · opening
    /// ```
    /// An involute turned about its gear moves by the same length along each of its normals, so that the gap drawn is the
    /// factor times the opening, exactly, and in contact the two touch whatever the factor.
    #[must_use]
    pub fn lead(&self, factor: f64) -> f64 {
        self.gap - factor * self.opening
    }

    fn is_sound(&self) -> bool {
        let numbers = [self.point.x, self.point.y, self.radius_driver, self.gap, self.opening];
        numbers.iter().chain(&[self.normal_velocity, self.sliding_velocity]).all(|number| number.is_finite())
    }
}

/// No tip is followed further before E, in rad of the driven gear.
pub const MOST_ANGLE: f64 = 1.0;

/// The tip in front of the flank.
fn before(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Moment {
    let geometry = &solution.geometry;
    let angle = roll_angle / inputs.ratio();
    let tip = tip_at(geometry, angle);
    let gap = tip::gap_without(LOSS, geometry, &tip).max(0.0);
    let velocity = velocity(inputs, &tip);
    Moment {
        roll_angle_driver: roll_angle,
        roll_angle_driven: angle,
        point: tip_point(geometry, &tip),
        radius_driver: tip.radius_driver,
        gap,
        opening: opening(solution, gap),
        normal_velocity: velocity.normal,
        sliding_velocity: velocity.sliding,
        impact_force: force(inputs, solution, angle),
    }
}

/// Flank on flank on the line of action.
fn after(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Moment {
    let geometry = &solution.geometry;
    let curvature = geometry.start - roll_angle * geometry.driver.base;
    let rest = geometry.tangent_length - curvature;
    Moment {
        roll_angle_driver: roll_angle,
        roll_angle_driven: roll_angle / inputs.ratio(),
        point: on_line_of_action(geometry, curvature),
        radius_driver: geometry.driver.base.hypot(curvature),
        gap: 0.0,
        opening: opening(solution, 0.0),
        normal_velocity: 0.0,
        sliding_velocity: inputs.driven_speed() * rest - inputs.speed * curvature,
        impact_force: None,
    }
}

/// The gap in closed form may lose this factor of its digits before the quadrature serves: four of a double are kept.
const LOSS: f64 = 1e12;

/// A gap below this share of Δ is none: what the gap at D misses of Δ.
const ROUNDING: f64 = 1e-9;

fn opening(solution: &Solution, gap: f64) -> f64 {
    let deviation = solution.deviation.total;
    let left = gap - deviation;
    if left > ROUNDING * deviation.abs() { left } else { 0.0 }
}

/// The force from D to E.
fn force(inputs: &Inputs, solution: &Solution, angle: f64) -> Option<f64> {
    let first = solution.position?.approach_angle_driven * (1.0 + ROUNDING);
    let masses = Masses::of(inputs, &solution.geometry).ok().filter(|_| angle <= first)?;
    let station = stations::station(inputs, &solution.geometry, &masses, angle).ok()?;
    Some(station.impact_force).filter(|force| force.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Rung;
    use crate::model::sample::standard_pair;
    use crate::model::{Stages, solve};

    /// Pairs with a deviation of 30 µm, up and down in ratio, shifted, and without a deviation.
    fn solved() -> Vec<(Inputs, Solution)> {
        let mut found = Vec::new();
        for (driver, driven, shift, deflection) in
            [(20, 20, 0.0, 30e-6), (20, 60, 0.2, 30e-6), (60, 20, -0.1, 30e-6), (33, 47, 0.3, 1e-6), (20, 20, 0.0, -20e-6)]
        {
            let mut inputs = standard_pair(driver, driven, 5e-3);
            inputs.driver.profile_shift = shift;
            inputs.deflection = Some(deflection);
            let solution = solve(&inputs, Stages::ALL).unwrap();
            found.push((inputs, solution));
        }
        found
    }

    #[test]
    fn values_at_d_and_at_the_stations_are_the_solutions() {
        for (inputs, solution) in solved() {
            let Some(position) = solution.position else { continue };
            let moment = Moment::at(&inputs, &solution, position.approach_angle_driver).unwrap();
            assert_eq!((moment.opening, moment.radius_driver), (0.0, position.contact.radius_driver));
            assert_eq!(moment.impact_force, solution.impact.map(|impact| impact.force));
            for station in &solution.stations {
                let moment = Moment::at(&inputs, &solution, station.roll_angle_driver).unwrap();
                let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-9 * expected.abs();
                assert!(close(moment.normal_velocity, station.normal_velocity), "{moment:?} {station:?}");
                assert!(close(moment.sliding_velocity, station.sliding_velocity), "{moment:?} {station:?}");
                assert!(close(moment.impact_force.unwrap(), station.impact_force), "{moment:?} {station:?}");
                assert!(close(moment.radius_driver, station.radius_driver), "{moment:?} {station:?}");
            }
        }
    }

    #[test]
    fn the_opening_closes_at_d_and_stays_closed() {
        for (inputs, solution) in solved() {
            let Some(position) = solution.position else { continue };
            let at = |part: f64| Moment::at(&inputs, &solution, part * position.approach_angle_driver).unwrap();
            let openings: Vec<f64> = (0..=30).map(|step| at(2.0 - f64::from(step) / 10.0).opening).collect();
            assert!(openings[..10].windows(2).all(|pair| pair[0] > pair[1] && pair[1] > 0.0), "{openings:?}");
            assert!(openings[10..].iter().all(|opening| *opening == 0.0), "{openings:?}");
        }
    }

    #[test]
    fn without_contact_the_flanks_stay_apart_by_what_lacks() {
        let (inputs, solution) = solved().pop().unwrap();
        assert_eq!(solution.position, None);
        for angle in [0.0, -0.05] {
            let moment = Moment::at(&inputs, &solution, angle).unwrap();
            assert!((moment.opening - 20e-6).abs() < 1e-15 && moment.impact_force.is_none(), "{moment:?}");
        }
    }

    #[test]
    fn nothing_jumps_at_e() {
        for (inputs, solution) in solved() {
            let (before, after) = (Moment::at(&inputs, &solution, 1e-9), Moment::at(&inputs, &solution, -1e-9));
            let (before, after) = (before.unwrap(), after.unwrap());
            assert!((before.point - after.point).norm() < 1e-7 * inputs.module, "{before:?} {after:?}");
            assert!((before.sliding_velocity - after.sliding_velocity).abs() < 1e-6, "{before:?} {after:?}");
        }
    }

    #[test]
    fn angles_beyond_what_can_be_are_held_at_its_ends() {
        let (mut inputs, solution) = solved().remove(0);
        inputs.rung = Rung::Paper;
        for angle in [1e300, -1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            let moment = Moment::at(&inputs, &solution, angle).unwrap();
            assert!(moment.roll_angle_driver.is_finite(), "{angle}: {moment:?}");
        }
    }
}
