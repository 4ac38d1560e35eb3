//! The computation core: from a gear pair to the corner contact, stage by stage.
//!
//! Symbols follow Zhou & Chen 2014, "Modeling and Calculation of Impact Friction Caused by Corner
//! Contact in Gear Transmission", Chin. J. Mech. Eng.; gear 1 is the driver, gear 2 the driven
//! gear. SI units throughout.

pub mod auto;
pub mod budget;
pub mod clearing;
pub mod compliance;
pub mod contact_state;
pub mod deviation;
pub mod dynamic;
pub mod explanation;
pub mod face;
pub mod field;
pub mod figures;
pub mod geometry;
pub mod given;
pub mod helix;
pub mod impact;
pub mod inputs;
pub mod limits;
pub mod masses;
pub mod mesh;
pub mod notes;
pub mod outline;
pub mod pair_forces;
pub mod position;
pub mod profile;
pub mod quantities;
pub mod relief;
#[cfg(test)]
pub(crate) mod sample;
pub mod slices;
pub mod solve;
pub mod speeds;
pub mod stage;
pub mod static_load;
pub mod stations;

pub use auto::Choice;
pub use clearing::Clearing;
pub use compliance::TeethCompliance;
pub use contact_state::{ContactState, Interpolated};
pub use deviation::Deviation;
pub use dynamic::Dynamic;
pub use dynamic::steady::Steady;
pub use explanation::Context;
pub use figures::Figures;
pub use geometry::Geometry;
pub use helix::Helix;
pub use impact::{Band, Friction, Impact};
pub use inputs::Inputs;
pub use limits::Refusal;
pub use mesh::Mesh;
pub use notes::{Note, notes};
pub use outline::Outline;
pub use position::{Position, Velocity};
pub use quantities::{QUANTITIES, Quantity};
pub use slices::load::{FaceCycle, FaceLoad};
pub use solve::{Earlier, solve, solve_while};
pub use speeds::SpeedCurve;
pub use stage::{Stage, Stages};
pub use static_load::StaticLoad;
pub use static_load::{Resonance, StaticSpectrum};
pub use stations::Station;

use std::sync::Arc;

use twofloat::TwoFloat;

use figures::Hertz;
use inputs::Method;
use masses::Masses;

/// Intermediate results for a later solve.
#[derive(Debug, Clone, PartialEq)]
struct Kept {
    masses: Masses,
    /// The unrounded deviation.
    deviation: Deviation<TwoFloat>,
    hertz: Hertz,
}

/// Whether the incoming tooth strikes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The tip touches before the normal path of contact begins.
    CornerContact,
    /// The tooth makes no contact before E.
    NoCornerContact,
}

impl Outcome {
    fn of_contact(is_made: bool) -> Outcome {
        if is_made { Outcome::CornerContact } else { Outcome::NoCornerContact }
    }

    /// The name in a report.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::CornerContact => "corner-contact",
            Outcome::NoCornerContact => "no-corner-contact",
        }
    }
}

/// The results of a solve. A stage is `None` if it did not run, or if it has no result because no
/// tooth strikes.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// The method.
    pub method: Method,
    /// The choice and its reason if the method is `auto`.
    pub choice: Option<Choice>,
    /// Whether the incoming tooth strikes.
    pub outcome: Outcome,
    /// The stages with results.
    pub stages: Stages,
    /// The stages that this solve ran. The other results come from an earlier solve.
    pub ran: Stages,
    /// Involute geometry of the pair.
    pub geometry: Geometry,
    /// Force along the line of action F₀ = T₁/r_b1, in N.
    pub mesh_force: f64,
    /// Helical geometry and axial force.
    pub helix: Helix,
    /// Whether the load varies over the face width: a helical, misaligned or crowned pair.
    pub is_over_face: bool,
    /// Reduced mass m_red of Eq. 33, in kg.
    pub reduced_mass: f64,
    /// The deviation that makes the tooth early.
    pub deviation: Deviation,
    /// Intermediate results for the next solve.
    kept: Kept,
    /// Figures of ISO 21771 and ISO 6336-1.
    pub figures: Option<Figures>,
    /// The first contact of the tip with the flank.
    pub position: Option<Position>,
    /// Velocities at D.
    pub velocity: Option<Velocity>,
    /// Compliance of the teeth at D.
    pub compliance: Option<TeethCompliance>,
    /// Force, energy and duration.
    pub impact: Option<Impact>,
    /// Change of the velocities over the impact.
    pub friction: Option<Friction>,
    /// The impact force by every stiffness model.
    pub band: Option<Band>,
    /// Stations from D (first) to E (last, force 0). Empty unless requested.
    pub stations: Vec<Station>,
    /// Gap and stiffness of every pair along the line of action.
    pub mesh: Option<Arc<Mesh>>,
    /// The load sharing in static balance.
    pub static_load: Option<StaticLoad>,
    /// The line load of the incoming tooth over the face width in static balance, if the pair is in
    /// slices.
    pub face_load: Option<Arc<FaceLoad>>,
    /// One base pitch without deviations over the face width, if the pair is in slices.
    pub face_cycle: Option<FaceCycle>,
    /// The load sharing with inertia and damping.
    pub dynamic: Option<Dynamic>,
    /// The line load of the incoming tooth over the face width in motion, if the pair is in slices.
    pub face_motion: Option<Arc<FaceLoad>>,
    /// Mesh frequency and natural frequency.
    pub resonance: Option<Resonance>,
    /// The harmonics of the static transmission error without deviations, or the reason why there
    /// are none.
    pub static_spectrum: Option<Result<StaticSpectrum, Refusal>>,
    /// The steady motion without deviations, or the reason why there is none.
    pub steady: Option<Result<Steady, Refusal>>,
    /// The steady motion over the speed, or the reason why there is none.
    pub over_speed: Option<Result<Arc<SpeedCurve>, Refusal>>,
    /// The required additional tip relief.
    pub clearing: Option<Clearing>,
    /// The reason why compliance, force and later results are absent although the tooth strikes.
    pub withheld: Option<Refusal>,
    /// The reason why stations between D and E are missing.
    pub stations_withheld: Option<Refusal>,
    /// The solve by a slower method, or its refusal, if the method is `auto` and limits or selected
    /// quantities need it.
    pub beside: Option<Result<Box<Solution>, Refusal>>,
}

impl Solution {
    /// Whether the pair is helical.
    pub fn is_helical(&self) -> bool {
        self.helix.base_helix_angle > 0.0
    }

    /// Whether the load of the incoming tooth is shared over the face width.
    pub fn has_slices(&self) -> bool {
        self.face_load.is_some() || self.face_motion.is_some()
    }

    /// Whether the printed equations put D so close to E that the tip has not closed its gap.
    pub fn leaves_gap_open(&self) -> bool {
        const CLOSED: f64 = 1e-6;
        let is_open = |at: Position| at.closed_gap < (1.0 - CLOSED) * self.deviation.total;
        self.method == Method::Paper && self.position.is_some_and(is_open)
    }

    /// The stations of the load sharing: those of the motion, otherwise those at rest.
    pub fn shared_stations(&self) -> Option<&[Station]> {
        let moving = self.dynamic.as_ref().map(|load| &load.stations);
        let stations = moving.or(self.static_load.as_ref().map(|load| &load.stations))?;
        Some(stations)
    }

    /// The results of geometry, load, masses and deviation.
    fn new(inputs: &Inputs, geometry: Geometry, mesh_force: f64, kept: Kept) -> Solution {
        let deviation = kept.deviation.rounded();
        Solution {
            method: inputs.method,
            choice: None,
            outcome: Outcome::of_contact(deviation.total > 0.0),
            stages: Stages::NONE,
            ran: Stages::NONE,
            geometry,
            mesh_force,
            helix: inputs.helix(&geometry, mesh_force),
            is_over_face: inputs.face().is_some(),
            reduced_mass: kept.masses.reduced(),
            deviation,
            kept,
            figures: None,
            position: None,
            velocity: None,
            compliance: None,
            impact: None,
            friction: None,
            band: None,
            stations: Vec::new(),
            mesh: None,
            static_load: None,
            face_load: None,
            face_cycle: None,
            dynamic: None,
            face_motion: None,
            resonance: None,
            static_spectrum: None,
            steady: None,
            over_speed: None,
            clearing: None,
            withheld: None,
            stations_withheld: None,
            beside: None,
        }
    }

    /// The stages with results, here or in the solve beside.
    pub fn all_stages(&self) -> Stages {
        let beside = self.beside.as_ref().and_then(|beside| beside.as_ref().ok());
        beside.map_or(self.stages, |beside| self.stages.and(beside.stages))
    }

    /// The stations of its method.
    pub fn own_stations(&self) -> &[Station] {
        self.shared_stations().unwrap_or(&self.stations)
    }

    /// The solve that computes a stage: this one, or that by a slower method beside it.
    pub fn having(&self, stage: Stage) -> &Solution {
        match &self.beside {
            Some(Ok(beside)) if !self.method.stages().has(stage) => beside,
            _ => self,
        }
    }
}
