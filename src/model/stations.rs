//! The force over roll angle, from D to E.

use super::compliance::{self, ContactPlace};
use super::geometry::Geometry;
use super::impact::{Masses, impact};
use super::inputs::Inputs;
use super::position::Position;
use super::tip::tip_at;
use super::{Refusal, velocity};

/// A place between D and E at which the impact is computed as if it were D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Driver's angle before E, in rad.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, in rad.
    pub roll_angle_driven: f64,
    /// O₁J, in m.
    pub radius_driver: f64,
    /// Approach velocity, in m/s.
    pub normal_velocity: f64,
    /// Sliding velocity, in m/s.
    pub sliding_velocity: f64,
    /// Impact force, in N.
    pub impact_force: f64,
}

/// The impact at `inputs.stations` equal intervals of the driven gear's angle, from D (first) to E (last, force 0). A
/// station whose force cannot be computed is left out, and the first refusal stands beside the rest.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 58-60; Eq. 60 mended to the law of cosines: as printed, O₁J would lie inside the base circle.
#[must_use]
pub fn stations(inputs: &Inputs, geometry: &Geometry, masses: &Masses, position: &Position) -> (Vec<Station>, Option<Refusal>) {
    let count = inputs.stations.max(1);
    let (mut found, mut refused) = (Vec::with_capacity(count + 1), None);
    for step in (0..=count).rev() {
        let part = step as f64 / count as f64;
        match station(inputs, geometry, masses, part * position.approach_angle_driven) {
            Ok(station) => found.push(station),
            Err(refusal) => refused = refused.or(Some(refusal)),
        }
    }
    (found, refused)
}

/// The impact as if it happened at the angle `angle` before E.
fn station(inputs: &Inputs, geometry: &Geometry, masses: &Masses, angle: f64) -> Result<Station, Refusal> {
    let tip = tip_at(geometry, angle);
    let velocity = velocity::velocity(inputs, &tip);
    let impact_force = if angle > 0.0 {
        let teeth = compliance::teeth(inputs, geometry, &ContactPlace::at_tip(inputs, geometry, &tip))?;
        impact(inputs, geometry, masses, &tip, &teeth, &velocity)?.force
    } else {
        0.0
    };
    Ok(Station {
        roll_angle_driver: angle * inputs.ratio(),
        roll_angle_driven: angle,
        radius_driver: tip.radius_driver,
        normal_velocity: velocity.normal,
        sliding_velocity: velocity.sliding,
        impact_force,
    })
}
