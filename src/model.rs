//! The computation core: from a gear pair to the corner contact, stage by stage.
//!
//! Symbols follow Zhou & Chen 2014, "Modeling and Calculation of Impact Friction Caused by Corner Contact in
//! Gear Transmission", Chin. J. Mech. Eng.; gear 1 is the driver, gear 2 the driven gear. SI units throughout.

pub mod compliance;
pub mod deviation;
pub mod friction;
pub mod geometry;
pub mod impact;
pub mod inputs;
pub mod limits;
pub mod position;
pub mod quantities;
pub mod stage;
pub mod stations;
pub mod velocity;

pub use compliance::TeethCompliance;
pub use deviation::Deviation;
pub use friction::Friction;
pub use geometry::Geometry;
pub use impact::Impact;
pub use inputs::Inputs;
pub use limits::{Note, Refusal};
pub use position::Position;
pub use quantities::{QUANTITIES, Quantity};
pub use stage::{Stage, Stages};
pub use stations::Station;
pub use velocity::Velocity;

use inputs::Rung;

/// Whether the incoming tooth strikes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The tip touches before the normal path of contact begins.
    CornerContact,
    /// The deviation does not bring the tooth in early.
    NoCornerContact,
}

impl Outcome {
    /// The name in a report.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Outcome::CornerContact => "corner-contact",
            Outcome::NoCornerContact => "no-corner-contact",
        }
    }
}

/// What a solve found. A stage that did not run, or that has no answer because no tooth strikes, is absent.
#[derive(Debug, Clone, PartialEq)]
pub struct Solution {
    /// How much of the physics was taken in.
    pub rung: Rung,
    /// Whether the incoming tooth strikes.
    pub outcome: Outcome,
    /// The stages that ran.
    pub stages: Stages,
    /// Involute geometry of the pair.
    pub geometry: Geometry,
    /// Force along the line of action F₀ = T₁/r_b1, in N.
    pub mesh_force: f64,
    /// Reduced mass m_red of Eq. 33, in kg.
    pub reduced_mass: f64,
    /// What brings the tooth in early.
    pub deviation: Deviation,
    /// Where the tip first touches the flank.
    pub position: Option<Position>,
    /// Velocities at D.
    pub velocity: Option<Velocity>,
    /// Compliance of the teeth at D.
    pub compliance: Option<TeethCompliance>,
    /// Force, energy and duration.
    pub impact: Option<Impact>,
    /// Change of the velocities over the impact.
    pub friction: Option<Friction>,
    /// From D (first) to E (last, force 0); empty unless asked for.
    pub stations: Vec<Station>,
}

/// Solve the pair, running only the wanted stages and what they need.
///
/// # Errors
/// A [`Refusal`] where the pair cannot mesh or a formula leaves its range.
pub fn solve(_inputs: &Inputs, _wanted: Stages) -> Result<Solution, Refusal> {
    Err(Refusal::Interference { start: 0.0 })
}

/// What a reader must know beside the result.
#[must_use]
pub fn notes(_inputs: &Inputs, _solution: &Solution) -> Vec<Note> {
    Vec::new()
}
