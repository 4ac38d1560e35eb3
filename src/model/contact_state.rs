//! The state of the incoming pair at a roll angle: place of tip and flank, gap, velocities, and the
//! results of the method there.

#[cfg(test)]
mod tests;

use super::compliance::Teeth;
use super::geometry::geometry;
use super::inputs::Inputs;
use super::masses::Masses;
use super::mesh::Mesh;
use super::outline::{on_line_of_action, tip_point};
use super::position::{TipContact, gap_without, tip_at, velocity};
use super::static_load::balance;
use super::{Geometry, Refusal, Solution, Station, stations};
use nalgebra::Point2;

/// Greatest angle of a tip beyond its end of the path of contact, in rad of its gear.
pub const MOST_ANGLE: f64 = 1.0;

/// Greatest loss of precision of the closed-form gap, as a factor. Four digits of an f64 remain.
/// Beyond it the quadrature computes the gap.
const LOSS: f64 = 1e12;

/// A gap below this part of the gap closed at the first contact counts as 0, and an angle beyond the
/// first contact by less than this part as the first contact.
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
pub fn first_contact(solution: &Solution) -> Option<f64> {
    let at_rest = solution.static_load.as_ref().map(|load| load.first_contact_angle);
    let moving = solution.dynamic.as_ref().map(|dynamic| dynamic.first_contact_angle);
    moving.or(at_rest).unwrap_or(solution.position.map(|position| position.approach_angle_driven))
}

/// The driver's angle before E at the first contact, in rad, by the solution's method. `None` if no
/// tooth strikes.
pub fn first_contact_of_driver(solution: &Solution) -> Option<f64> {
    let ratio = solution.geometry.driven.base / solution.geometry.driver.base;
    first_contact(solution).map(|angle| angle * ratio)
}

/// The driver's angle before E at which the tooth first touches, in rad: of a helical pair the angle of
/// the middle of the face, not that of the plane of the contact. `None` if no tooth strikes.
pub fn first_touch_of_driver(solution: &Solution) -> Option<f64> {
    let contact = first_contact_of_driver(solution)?;
    let first = solution.own_stations().first().filter(|_| solution.is_helical());
    Some(first.map_or(contact, |station| station.roll_angle_driver))
}

/// Whether the solution includes load sharing.
pub fn shares_load(solution: &Solution) -> bool {
    solution.static_load.is_some() || solution.dynamic.is_some()
}

/// Point D of the driven tip at the first contact, in m.
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
    pub fn at(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<ContactState> {
        let last =
            (solution.geometry.start - solution.geometry.end) / solution.geometry.driver.base;
        let roll_angle = roll_angle.max(last - MOST_ANGLE).min(MOST_ANGLE * inputs.ratio());
        let state = ContactState {
            phase: Phase::Line,
            roll_angle_driver: roll_angle,
            roll_angle_driven: roll_angle / inputs.ratio(),
            point: Point2::origin(),
            radius_driver: 0.0,
            gap: 0.0,
            opening: 0.0,
            normal_velocity: 0.0,
            sliding_velocity: 0.0,
            interpolated: Interpolated::at(inputs, solution, roll_angle),
        };
        let state = if roll_angle < last {
            run_out(inputs, last, state)?
        } else if roll_angle < 0.0 {
            line(inputs, solution, state)
        } else {
            run_in(inputs, solution, state)
        };
        state.is_sound().then_some(state)
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
    pub fn lead(&self, factor: f64) -> f64 {
        if self.phase == Phase::RunOut { 0.0 } else { self.gap - factor * self.opening }
    }

    /// Whether the pair touches.
    pub fn touches(&self) -> bool {
        let carries =
            |one: &Interpolated| one.station.load_share().is_none() || one.station.force > 0.0;
        self.opening <= 0.0 && self.interpolated.as_ref().is_none_or(carries)
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
fn run_in(inputs: &Inputs, solution: &Solution, state: ContactState) -> ContactState {
    let geometry = &solution.geometry;
    let tip = tip_at(geometry, state.roll_angle_driven);
    let (gap, velocity) = (gap_of(geometry, &tip), velocity(inputs.driven_speed(), &tip));
    ContactState {
        phase: Phase::RunIn,
        point: tip_point(geometry, &tip),
        radius_driver: tip.radius_driver,
        gap,
        opening: opening(solution, gap),
        normal_velocity: velocity.normal,
        sliding_velocity: velocity.sliding,
        ..state
    }
}

/// Both flanks in contact on the line of action.
fn line(inputs: &Inputs, solution: &Solution, state: ContactState) -> ContactState {
    let geometry = &solution.geometry;
    let curvature = geometry.start - state.roll_angle_driver * geometry.driver.base;
    let rest = geometry.tangent_length - curvature;
    ContactState {
        point: on_line_of_action(geometry, curvature),
        radius_driver: geometry.driver.base.hypot(curvature),
        opening: opening(solution, 0.0),
        sliding_velocity: inputs.driven_speed() * rest - inputs.speed * curvature,
        ..state
    }
}

/// The driver's tip after the driven flank: the reversed run-in of the swapped gears, rotated by
/// half a turn.
fn run_out(inputs: &Inputs, last: f64, state: ContactState) -> Option<ContactState> {
    let swapped = Inputs {
        driver: inputs.driven,
        driven: inputs.driver,
        speed: inputs.driven_speed(),
        ..inputs.clone()
    };
    let geometry = geometry::<f64>(&swapped.shape()).ok()?;
    let tip = tip_at(&geometry, last - state.roll_angle_driver);
    let (gap, velocity) = (gap_of(&geometry, &tip), velocity(swapped.driven_speed(), &tip));
    let point = tip_point(&geometry, &tip);
    Some(ContactState {
        phase: Phase::RunOut,
        point: Point2::new(geometry.centre_distance - point.x, -point.y),
        radius_driver: tip.radius_driven,
        gap,
        opening: if state.interpolated.is_some() { 0.0 } else { gap },
        normal_velocity: -velocity.normal,
        sliding_velocity: -velocity.sliding,
        ..state
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

/// The results for the incoming tooth at a roll angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpolated {
    /// The results as at a station.
    pub station: Station,
    /// Whether they are between two stations of a motion, with [`DIGITS_BETWEEN`] correct digits of
    /// force and displacement.
    pub is_between: bool,
}

/// Correct digits of the force between two stations of a motion, relative to the greatest force,
/// with 64 stations.
pub const DIGITS_BETWEEN: usize = 3;

impl Interpolated {
    /// The results of the solution's method at `roll_angle` before E, in rad of the driver. `None`
    /// if the tooth is not in contact, or has no force or a force over the face that the method lacks.
    ///
    /// # Formula
    /// ```text
    /// paper, exact:  as at a station
    /// static:        as at a station
    /// dynamic:       F of the load shared at x,
    ///                x by the cubic with x and x' of both neighbouring stations
    /// in slices:     linear between both neighbouring stations
    /// ```
    ///
    /// # Valid for
    /// Full precision for the closed form, for `static`, and at the stations of `dynamic`. Between
    /// 64 stations of `dynamic` the error of the force is at most 5e-3 of the peak.
    pub fn at(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<Interpolated> {
        let exact = |station| Interpolated { station, is_between: false };
        if solution.has_slices() {
            let between = |from: &Station, to: &Station, part| Some(from.towards(to, part));
            return interpolated(solution.shared_stations()?, roll_angle, between);
        }
        match (&solution.dynamic, &solution.static_load) {
            (Some(dynamic), _) => moving(solution.mesh.as_deref()?, &dynamic.stations, roll_angle),
            (None, Some(load)) => {
                at_rest(solution.mesh.as_deref()?, &load.stations, roll_angle).map(exact)
            }
            _ if matches!(solution.withheld, Some(Refusal::NotOverFace { .. })) => None,
            (None, None) => struck(inputs, solution, roll_angle).map(exact),
        }
    }
}

/// The impact from D to E.
fn struck(inputs: &Inputs, solution: &Solution, roll_angle: f64) -> Option<Station> {
    let angle = roll_angle / inputs.ratio();
    let first = solution.position?.approach_angle_driven * (1.0 + ROUNDING);
    let masses =
        Masses::of(inputs, &solution.geometry).ok().filter(|_| (0.0..=first).contains(&angle))?;
    let geometry = &solution.geometry;
    let teeth = Teeth::of(&inputs.elasticity(), geometry).ok()?;
    let station = stations::station(inputs, &teeth, &masses, angle).ok()?;
    station.force.is_finite().then_some(station)
}

/// The station at an angle; otherwise `between` of its neighbours and the part of the way from the
/// first to the second.
fn interpolated(
    stations: &[Station],
    roll_angle: f64,
    between: impl FnOnce(&Station, &Station, f64) -> Option<Station>,
) -> Option<Interpolated> {
    let next = stations.partition_point(|station| station.roll_angle_driver > roll_angle);
    let to = stations.get(next)?;
    if (to.roll_angle_driver..=to.roll_angle_driver).contains(&roll_angle) {
        return Some(Interpolated { station: *to, is_between: false });
    }
    let from = stations.get(next.checked_sub(1)?)?;
    let way = from.roll_angle_driver - to.roll_angle_driver;
    let station = between(from, to, (from.roll_angle_driver - roll_angle) / way)?;
    Some(Interpolated { station, is_between: true })
}

/// The balance from the first contact to the last.
fn at_rest(mesh: &Mesh, stations: &[Station], roll_angle: f64) -> Option<Station> {
    let (first, last) = (stations.first()?.roll_angle_driver, stations.last()?.roll_angle_driver);
    let s = (last..=first).contains(&roll_angle).then_some(0.0 - roll_angle * mesh.base_radii.0)?;
    let balance = balance(mesh, s, s);
    Some(Station::at(mesh, s, balance.force, balance.total, balance.displacement, None))
}

/// The motion from the first contact to the last.
fn moving(mesh: &Mesh, stations: &[Station], roll_angle: f64) -> Option<Interpolated> {
    interpolated(stations, roll_angle, |from, to, part| {
        let (displacement, time) = cubic(from, to, part)?;
        let s = 0.0 - roll_angle * mesh.base_radii.0;
        let pairs = mesh.pair_set(s, s);
        let forces = pairs.forces(displacement);
        let total = forces.iter().sum();
        let incoming = pairs.pairs().iter().position(|pair| pair.ahead == 0);
        let force = incoming.map_or(0.0, |incoming| forces[incoming]);
        Some(Station::at(mesh, s, force, total, displacement, Some((time, None))))
    })
}

/// Displacement and time between two stations, by the cubic through value and slope at both
/// stations.
fn cubic(from: &Station, to: &Station, part: f64) -> Option<(f64, f64)> {
    let (begin, end) = (from.time()?, to.time()?);
    let rest = 1.0 - part;
    let values = from.transmission_error()? * (1.0 + 2.0 * part) * rest * rest
        + to.transmission_error()? * (3.0 - 2.0 * part) * part * part;
    let rates = part * rest * (end - begin) * (from.rate()? * rest - to.rate()? * part);
    Some((values + rates, begin + part * (end - begin)))
}
