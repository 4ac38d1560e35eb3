//! The force over roll angle, from D to E.

use super::Refusal;
use super::budget::{CURVE_WORK, IMPACT_WORK};
use super::compliance::Teeth;
use super::geometry::Geometry;
use super::impact::{ImpactInputs, impact};
use super::inputs::Inputs;
use super::masses::Masses;
use super::mesh::Mesh;
use super::position::Position;
use super::spacing::{Resolution, Spacing};
use super::tip_gap::{gap_without, tip_at};
use super::velocity::{VelocityInputs, velocity};

/// The gap in closed form may lose this factor of its digits before the quadrature serves.
const LOSS: f64 = 1e4;

/// A force below this part of the forces of all pairs is the rounding of their balance, and 0.
const ROUNDING: f64 = 1e-12;

/// Inputs of the impacts between D and E, besides geometry, masses and D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StationsInputs {
    /// Velocities at a station.
    pub velocity: VelocityInputs,
    /// The impact at a station.
    pub impact: ImpactInputs,
    /// Distances between the stations.
    pub spacing: Spacing,
}

impl StationsInputs {
    /// Selects them from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> StationsInputs {
        StationsInputs {
            velocity: VelocityInputs::of(inputs),
            impact: ImpactInputs::of(inputs),
            spacing: Spacing::of(inputs),
        }
    }
}

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
    /// Gap S(u) between tip and flank without deviation, in m; Δ at D, 0 at E.
    pub gap: f64,
    /// Pair compliance q_s at the impact force, in m²/N; none at E, where there is no force.
    pub pair_compliance: Option<f64>,
    /// Normal kinetic energy E_k of the whole width, in J.
    pub impact_energy: f64,
}

/// A place of the incoming tooth from its first contact through E to its last.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshStation {
    /// Driver's angle before E, in rad; below 0 after E.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, in rad; below 0 after E.
    pub roll_angle_driven: f64,
    /// Force of the incoming tooth, in N.
    pub force: f64,
    /// Its part of the forces of all pairs.
    pub load_share: f64,
    /// Displacement of the driver ahead along the line of action, in m.
    pub transmission_error: f64,
    /// Approach velocity of the incoming pair without load, −dS/dt, in m/s; below 0 where tip and
    /// flank part.
    pub normal_velocity: f64,
    /// Its sliding velocity, in m/s.
    pub sliding_velocity: f64,
    /// Its gap S without deviation and load, reliefs included, in m.
    pub gap: f64,
    /// Its compliance q_s at the force along the line of action, in m²/N.
    pub pair_compliance: f64,
    /// Time since E, in s; in the method `dynamic` alone.
    pub time: Option<f64>,
    /// How fast the displacement grows, in m/s; in the method `dynamic` alone.
    pub rate: Option<f64>,
}

impl MeshStation {
    /// Stations from `first` to E, which is at 0, and from there to `last`; where the first is not
    /// before E, from it.
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

    /// The station at which the incoming pair stands `s` after E.
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

/// The impact at stations over the driven gear's angle, from D (first) to E (last, force 0). A
/// station whose force cannot be computed is left out, and the first refusal stands beside the
/// rest.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 58-60; Eq. 60 corrected to the law of cosines: as printed, O₁J would lie
/// inside the base circle.
#[must_use]
pub fn stations(
    inputs: &StationsInputs,
    geometry: &Geometry,
    masses: &Masses,
    position: &Position,
    peak: f64,
) -> (Vec<Station>, Option<Refusal>) {
    let mut refused = None;
    let mut found = Vec::with_capacity(inputs.spacing.count().map_or(0, |count| count + 1));
    let teeth = match Teeth::of(&inputs.impact.compliance.elasticity, geometry) {
        Ok(teeth) => teeth,
        Err(refusal) => return (found, Some(refusal)),
    };
    let at = |angle: f64| {
        let station = station(inputs, geometry, &teeth, masses, angle);
        (
            station
                .as_ref()
                .map_or(f64::NAN, |station| station.impact_force),
            station,
        )
    };
    let resolution = inputs.spacing.walk(
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

/// The impact as if it happened at the driven gear's angle `angle` before E, in rad.
///
/// # Errors
/// The [`Refusal`] of the stage that has no force there.
pub fn station(
    inputs: &StationsInputs,
    geometry: &Geometry,
    teeth: &Teeth,
    masses: &Masses,
    angle: f64,
) -> Result<Station, Refusal> {
    let tip = tip_at(geometry, angle);
    let velocity = velocity(&inputs.velocity, &tip);
    let struck = if angle > 0.0 {
        let place = inputs.impact.compliance.place(geometry, &tip);
        let (teeth, spring) = (teeth.at(&place)?, teeth.spring(&place)?);
        let elastic = (&teeth, &spring);
        Some(impact(
            &inputs.impact,
            geometry,
            masses,
            &tip,
            elastic,
            &velocity,
        )?)
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
