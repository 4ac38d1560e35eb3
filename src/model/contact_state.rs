//! The state of the incoming pair at a roll angle: place of tip and flank, gap, velocities and
//! load.

#[cfg(test)]
mod tests;

use nalgebra::Point2;

use super::gear_pose::{on_line_of_action, tip_point};
use super::geometry::geometry;
use super::inputs::Inputs;
use super::interpolate::Interpolated;
use super::position::velocity;
use super::tip_gap::{TipContact, gap_without, tip_at};
use super::{Geometry, Solution};

/// Greatest angle of a tip beyond its end of the path of contact, in rad of its gear.
pub const MOST_ANGLE: f64 = 1.0;

/// Greatest loss of precision of the closed-form gap, as a factor. Four digits of an f64 remain.
/// Beyond it the quadrature computes the gap.
const LOSS: f64 = 1e12;

/// A gap below this part of the gap closed at the first contact counts as 0.
const ROUNDING: f64 = 1e-9;

/// The state of the incoming pair at a roll angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactState {
    /// The phase of the engagement.
    pub phase: Phase,
    /// Driver's angle before E, in rad; below 0 after E.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, u, in rad.
    pub roll_angle_driven: f64,
    /// The tip, or the contact on the line of action, in m; O₁ at the origin, O₂ at (a, 0).
    pub point: Point2<f64>,
    /// Distance O₁J of the point from O₁, in m.
    pub radius_driver: f64,
    /// Gap S between tip and flank of the involutes without deviation, in m; 0 on the line of
    /// action.
    pub gap: f64,
    /// The part of the gap that is still open, in m; 0 from the first contact on.
    pub opening: f64,
    /// Approach velocity ΔV_n, in m/s; below 0 when tip and flank separate.
    pub normal_velocity: f64,
    /// Sliding velocity ΔV_τ, in m/s.
    pub sliding_velocity: f64,
    /// The interpolated results of the method if the tooth is in contact.
    pub interpolated: Option<Interpolated>,
}

/// The phase of the engagement of the incoming pair.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Before E: the driven tip faces the driver's flank.
    RunIn,
    /// From E to B: both flanks touch on the line of action.
    Line,
    /// After B: the driver's tip faces the driven flank.
    RunOut,
}

/// The driven gear's angle before E at the first contact, in rad, by the solution's method. `None`
/// if no tooth strikes.
#[must_use]
pub fn first_contact(solution: &Solution) -> Option<f64> {
    let at_rest = solution.static_load.as_ref().map(|load| load.first_contact_angle);
    let moving = solution.dynamic.as_ref().map(|dynamic| dynamic.first_contact_angle);
    moving.or(at_rest).unwrap_or(solution.position.map(|position| position.approach_angle_driven))
}

/// The driver's angle before E at the first contact, in rad, by the solution's method. `None` if no
/// tooth strikes.
#[must_use]
pub fn first_contact_of_driver(solution: &Solution) -> Option<f64> {
    let ratio = solution.geometry.driven.base / solution.geometry.driver.base;
    first_contact(solution).map(|angle| angle * ratio)
}

/// Whether the solution includes load sharing.
#[must_use]
pub fn shares_load(solution: &Solution) -> bool {
    solution.static_load.is_some() || solution.dynamic.is_some()
}

/// Point D of the driven tip at the first contact, in m.
#[must_use]
pub fn first_contact_point(solution: &Solution) -> Option<Point2<f64>> {
    let tip = tip_at(&solution.geometry, first_contact(solution)?);
    Some(tip_point(&solution.geometry, &tip))
}

impl ContactState {
    /// The state at the driver's `roll_angle` before E, in rad. The angle is limited to
    /// [`MOST_ANGLE`] beyond the ends of the path of contact. `None` if the tip would be inside the
    /// other gear's base circle.
    ///
    /// # Formula
    /// ```text
    /// u = θ/i,   opening = max(0, S(u) − S₀),   S = 0 on the line of action
    /// ```
    /// S₀ is the gap that is closed at the first contact: Δ in `paper` and `exact`, S at the first
    /// contact in `static` and `dynamic`. After B the values describe the driver's tip, computed
    /// with swapped gears, and S₀ is 0.
    ///
    /// # Source
    /// `paper` uses gap, velocities and force of the method `exact`, so that the picture shows the
    /// involutes.
    #[must_use]
    pub fn at(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<ContactState> {
        let last =
            (solution.geometry.start - solution.geometry.end) / solution.geometry.driver.base;
        let roll_angle = roll_angle.max(last - MOST_ANGLE).min(MOST_ANGLE * inputs.ratio());
        let moment = if roll_angle < last {
            run_out(inputs, solution, roll_angle, last)?
        } else if roll_angle < 0.0 {
            line(inputs, solution, roll_angle)
        } else {
            run_in(inputs, solution, roll_angle)
        };
        moment.is_sound().then_some(moment)
    }

    /// Distance of the driver's flank ahead of its nominal place along the line of action, in m, if
    /// the opening is drawn enlarged by `factor`.
    ///
    /// # Formula
    /// ```text
    /// S(u) − factor · opening,   0 after B
    /// ```
    /// A turned involute moves by the same length along each of its normals. The drawn gap is
    /// therefore exactly `factor` times the opening, and flanks in contact touch at every factor.
    #[must_use]
    pub fn lead(&self, factor: f64) -> f64 {
        if self.phase == Phase::RunOut { 0.0 } else { self.gap - factor * self.opening }
    }

    /// Whether the pair touches.
    #[must_use]
    pub fn touches(&self) -> bool {
        self.opening <= 0.0
            && self
                .interpolated
                .as_ref()
                .and_then(Interpolated::load)
                .is_none_or(|load| load.force > 0.0)
    }

    fn is_sound(&self) -> bool {
        let numbers = [self.point.x, self.point.y, self.radius_driver, self.gap, self.opening];
        numbers
            .iter()
            .chain(&[self.normal_velocity, self.sliding_velocity])
            .all(|number| number.is_finite())
    }
}

/// The driven tip before the driver's flank.
fn run_in(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> ContactState {
    let geometry = &solution.geometry;
    let angle = roll_angle / inputs.ratio();
    let tip = tip_at(geometry, angle);
    let gap = gap_of(geometry, &tip);
    let velocity = velocity(inputs.driven_speed(), &tip);
    ContactState {
        phase: Phase::RunIn,
        roll_angle_driver: roll_angle,
        roll_angle_driven: angle,
        point: tip_point(geometry, &tip),
        radius_driver: tip.radius_driver,
        gap,
        opening: opening(solution, gap),
        normal_velocity: velocity.normal,
        sliding_velocity: velocity.sliding,
        interpolated: Interpolated::at(inputs, solution, roll_angle),
    }
}

/// Both flanks in contact on the line of action.
fn line(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> ContactState {
    let geometry = &solution.geometry;
    let curvature = geometry.start - roll_angle * geometry.driver.base;
    let rest = geometry.tangent_length - curvature;
    ContactState {
        phase: Phase::Line,
        roll_angle_driver: roll_angle,
        roll_angle_driven: roll_angle / inputs.ratio(),
        point: on_line_of_action(geometry, curvature),
        radius_driver: geometry.driver.base.hypot(curvature),
        gap: 0.0,
        opening: opening(solution, 0.0),
        normal_velocity: 0.0,
        sliding_velocity: inputs.driven_speed() * rest - inputs.speed * curvature,
        interpolated: Interpolated::at(inputs, solution, roll_angle),
    }
}

/// The driver's tip after the driven flank: the reversed run-in of the swapped gears, rotated by
/// half a turn.
fn run_out(
    inputs: &Inputs,
    solution: &Solution,
    roll_angle: f64,
    last: f64,
) -> Option<ContactState> {
    let swapped = Inputs {
        driver: inputs.driven.clone(),
        driven: inputs.driver.clone(),
        speed: inputs.driven_speed(),
        ..inputs.clone()
    };
    let geometry = geometry::<f64>(&swapped.shape()).ok()?;
    let tip = tip_at(&geometry, last - roll_angle);
    let (gap, velocity, interpolated) = (
        gap_of(&geometry, &tip),
        velocity(swapped.driven_speed(), &tip),
        Interpolated::at(inputs, solution, roll_angle),
    );
    let point = tip_point(&geometry, &tip);
    Some(ContactState {
        phase: Phase::RunOut,
        roll_angle_driver: roll_angle,
        roll_angle_driven: roll_angle / inputs.ratio(),
        point: Point2::new(geometry.centre_distance - point.x, -point.y),
        radius_driver: tip.radius_driven,
        gap,
        opening: if interpolated.is_some() { 0.0 } else { gap },
        normal_velocity: -velocity.normal,
        sliding_velocity: -velocity.sliding,
        interpolated,
    })
}

fn gap_of(geometry: &Geometry, tip: &TipContact) -> f64 {
    gap_without(LOSS, geometry, tip).max(0.0)
}

/// The part of a gap that is still open before the first contact.
fn opening(solution: &Solution, gap: f64) -> f64 {
    let total = solution.deviation.total;
    let closed = match first_contact(solution) {
        Some(angle) if shares_load(solution) => {
            gap_of(&solution.geometry, &tip_at(&solution.geometry, angle))
        }
        None if shares_load(solution) => total.min(0.0),
        _ => total,
    };
    let left = gap - closed;
    if left > ROUNDING * closed.abs() { left } else { 0.0 }
}
