//! The force over roll angle, from D to E.

use super::Refusal;
use super::budget::{CURVE_WORK, IMPACT_WORK};
use super::compliance::{ContactPlace, Teeth};
use super::geometry::Geometry;
use super::impact::impact;
use super::inputs::Inputs;
use super::masses::Masses;
use super::mesh::Mesh;
use super::position::{Position, velocity};
use super::spacing::{Resolution, Spacing};
use super::tip_gap::{gap_without, tip_at};

/// Greatest loss of precision of the closed-form gap, as a factor. Beyond it the quadrature
/// computes the gap.
const LOSS: f64 = 1e4;

/// A force below this part of the sum of all forces is rounding and counts as 0.
const ROUNDING: f64 = 1e-12;

/// A station between D and E. The impact is computed as if D were at this place.
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
    /// Gap S(u) between tip and flank without deviation, in m; Δ at D, 0 at E.
    pub gap: f64,
    /// Pair compliance q_s at the impact force, in m²/N. `None` at E, where the force is 0.
    pub pair_compliance: Option<f64>,
    /// Normal kinetic energy E_k of the whole width, in J.
    pub impact_energy: f64,
}

/// A station of the incoming tooth between its first contact and its last contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshStation {
    /// Driver's angle before E, in rad; below 0 after E.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, in rad; below 0 after E.
    pub roll_angle_driven: f64,
    /// Force of the incoming tooth, in N.
    pub force: f64,
    /// Part of the sum of all forces.
    pub load_share: f64,
    /// Displacement of the driver ahead along the line of action, in m.
    pub transmission_error: f64,
    /// Approach velocity of the incoming pair without load, −dS/dt, in m/s; below 0 when tip and
    /// flank separate.
    pub normal_velocity: f64,
    /// Sliding velocity of the incoming pair, in m/s.
    pub sliding_velocity: f64,
    /// Gap S of the incoming pair without deviation and load, with reliefs, in m.
    pub gap: f64,
    /// Compliance q_s of the pair at the force along the line of action, in m²/N.
    pub pair_compliance: f64,
    /// Time since E, in s; only in the method `dynamic`.
    pub time: Option<f64>,
    /// Rate of the displacement, in m/s; only in the method `dynamic`.
    pub rate: Option<f64>,
}

impl MeshStation {
    /// Stations from `first` to E, which is at 0, and from E to `last`. Without contact before E,
    /// only from `first` to `last`.
    pub(super) fn through_start(
        first: f64,
        last: f64,
        mut stations: impl FnMut(f64, f64) -> (Vec<MeshStation>, Resolution),
    ) -> (Vec<MeshStation>, Resolution) {
        if first >= 0.0 {
            return stations(first, last);
        }
        let ((mut all, before), (after_start, after)) = (stations(first, 0.0), stations(0.0, last));
        all.extend(after_start.into_iter().skip(1));
        (all, before.and(after))
    }

    /// The station with the incoming pair at `s` after E.
    pub(super) fn at(
        mesh: &Mesh,
        s: f64,
        force: f64,
        total: f64,
        displacement: f64,
        time: Option<f64>,
    ) -> MeshStation {
        let (own, slope) = mesh.incoming(s);
        let least = ROUNDING * total.max(mesh.force);
        let force = if force > least { force } else { 0.0 };
        MeshStation {
            roll_angle_driver: 0.0 - s / mesh.base_radii.0,
            roll_angle_driven: 0.0 - s / mesh.base_radii.1,
            force,
            load_share: if total > 0.0 { force / total } else { 0.0 },
            transmission_error: displacement,
            normal_velocity: 0.0 - slope * mesh.speed,
            sliding_velocity: own.sliding,
            gap: own.gap,
            pair_compliance: mesh.width / own.stiffness,
            time,
            rate: None,
        }
    }
}

/// The impact at stations over the driven gear's angle, from D (first) to E (last, force 0). Omits
/// stations without a force and returns the first refusal with the other stations.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 58-60. Eq. 60 is corrected to the law of cosines: as printed, O₁J is
/// inside the base circle.
#[must_use]
pub fn stations(
    inputs: &Inputs,
    geometry: &Geometry,
    masses: &Masses,
    position: &Position,
    peak: f64,
) -> (Vec<Station>, Option<Refusal>) {
    let mut refused = None;
    let spacing = Spacing::of(inputs);
    let mut found = Vec::with_capacity(spacing.count().map_or(0, |count| count + 1));
    let teeth = match Teeth::of(&inputs.elasticity(), geometry) {
        Ok(teeth) => teeth,
        Err(refusal) => return (found, Some(refusal)),
    };
    let at = |angle: f64| {
        let station = station(inputs, &teeth, masses, angle);
        (station.as_ref().map_or(f64::NAN, |station| station.impact_force), station)
    };
    let resolution = spacing.walk(
        &[position.approach_angle_driven, 0.0],
        peak,
        CURVE_WORK / IMPACT_WORK,
        at,
        |station| match station {
            Ok(station) => found.push(station),
            Err(refusal) => refused = refused.or(Some(refusal)),
        },
    );
    (found, refused.or(resolution.refusal()))
}

/// The impact as if it occurred at the driven gear's angle `angle` before E, in rad.
///
/// # Errors
/// The [`Refusal`] of the stage that cannot compute the force.
pub fn station(
    inputs: &Inputs,
    teeth: &Teeth,
    masses: &Masses,
    angle: f64,
) -> Result<Station, Refusal> {
    let geometry = teeth.geometry();
    let tip = tip_at(geometry, angle);
    let velocity = velocity(inputs.driven_speed(), &tip);
    let struck = if angle > 0.0 {
        let place = ContactPlace::at_tip(inputs.driven.tip_radius, geometry, &tip);
        Some(impact(inputs, teeth, masses, &tip, &teeth.at(&place)?, &velocity)?)
    } else {
        None
    };
    Ok(Station {
        roll_angle_driver: angle * geometry.ratio,
        roll_angle_driven: angle,
        radius_driver: tip.radius_driver,
        normal_velocity: velocity.normal,
        sliding_velocity: velocity.sliding,
        impact_force: struck.map_or(0.0, |impact| impact.force),
        gap: gap_without(LOSS, geometry, &tip),
        pair_compliance: struck.map(|impact| impact.pair_compliance),
        impact_energy: struck.map_or(0.0, |impact| impact.energy),
    })
}
