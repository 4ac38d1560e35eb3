//! The computation core: from a gear pair to the corner contact, stage by stage.
//!
//! Symbols follow Zhou & Chen 2014, "Modeling and Calculation of Impact Friction Caused by Corner Contact in
//! Gear Transmission", Chin. J. Mech. Eng.; gear 1 is the driver, gear 2 the driven gear. SI units throughout.

pub mod auto;
pub mod band;
pub mod compliance;
pub mod deviation;
pub mod dynamic;
pub mod friction;
pub mod geometry;
pub mod impact;
pub mod inputs;
pub mod limits;
pub mod load_sharing;
pub mod mesh;
pub mod notes;
pub mod position;
pub mod quantities;
pub mod relief;
#[cfg(test)]
pub(crate) mod sample;
pub mod spacing;
pub mod stage;
pub mod static_load;
pub mod stations;
pub mod tip;
pub mod velocity;

pub use auto::Choice;
pub use band::Band;
pub use compliance::TeethCompliance;
pub use deviation::Deviation;
pub use dynamic::Dynamic;
pub use friction::Friction;
pub use geometry::Geometry;
pub use impact::Impact;
pub use inputs::Inputs;
pub use limits::Refusal;
pub use notes::{Note, notes};
pub use position::Position;
pub use quantities::{QUANTITIES, Quantity};
pub use stage::{Stage, Stages};
pub use static_load::StaticLoad;
pub use stations::{MeshStation, Station};
pub use velocity::Velocity;

use twofloat::TwoFloat;

use impact::Masses;
use inputs::Rung;

use crate::numeric::Real;

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
    /// Why that much, where the rung `auto` chose.
    pub choice: Option<Choice>,
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
    /// The impact force by every stiffness model.
    pub band: Option<Band>,
    /// From D (first) to E (last, force 0); empty unless asked for.
    pub stations: Vec<Station>,
    /// Mean stiffness of the mesh, in N/m.
    pub mesh_stiffness: Option<f64>,
    /// The load shared by every pair.
    pub static_load: Option<StaticLoad>,
    /// The same with inertia.
    pub dynamic: Option<Dynamic>,
    /// Why the tooth strikes and yet compliance, force and what follows are absent, where that is so.
    pub withheld: Option<Refusal>,
    /// Why stations are missing between D and E, where some are.
    pub stations_withheld: Option<Refusal>,
}

/// Solve the pair, running only the wanted stages and what they need.
///
/// Geometry, load and deviation always run, since they tell the outcome. Where a small difference decides, geometry and
/// position are computed in double-double arithmetic, asked for or not.
///
/// # Errors
/// A [`Refusal`] where the pair cannot mesh, or D does not exist. Where only the force cannot be computed, the rest is
/// given and [`Solution::withheld`] says why.
pub fn solve(inputs: &Inputs, wanted: Stages) -> Result<Solution, Refusal> {
    solve_while(inputs, wanted, &|_| true)
}

/// The same, asked now and then whether to go on, with the part that is done, from 0 to 1.
///
/// # Errors
/// Those of [`solve`], and [`Refusal::Stopped`] where `go_on` says no.
pub fn solve_while(inputs: &Inputs, wanted: Stages, go_on: &dyn Fn(f64) -> bool) -> Result<Solution, Refusal> {
    if inputs.rung == Rung::Auto {
        return solve_by_choice(inputs, wanted, go_on);
    }
    let wanted = wanted.within(inputs.rung.stages());
    let plain = geometry::geometry::<f64>(inputs);
    let close_call = plain.map_or(true, |geometry| geometry.is_close_call(inputs));
    let precise = (inputs.accurate || close_call).then(|| geometry::geometry::<TwoFloat>(inputs)).transpose()?;
    let geometry = precise.map_or(plain, |precise| Ok(precise.rounded()))?;
    let masses = precise.map_or_else(|| Masses::of(inputs, &geometry), |precise| Masses::of(inputs, &precise))?;
    let mesh_force = inputs.torque() / geometry.driver.base;
    let deviation = deviation::deviation(inputs, &geometry, mesh_force)?;
    let mut solution = Solution {
        rung: inputs.rung,
        choice: None,
        outcome: if deviation.total.rounded() > 0.0 { Outcome::CornerContact } else { Outcome::NoCornerContact },
        stages: Stages::of(Stage::Deviation),
        geometry,
        mesh_force,
        reduced_mass: masses.reduced(),
        deviation: deviation.rounded(),
        position: None,
        velocity: None,
        compliance: None,
        impact: None,
        friction: None,
        band: None,
        stations: Vec::new(),
        mesh_stiffness: None,
        static_load: None,
        dynamic: None,
        withheld: None,
        stations_withheld: None,
    };
    if wanted.has(Stage::Position) {
        solution.stages = solution.stages.with(Stage::Position);
        match position::position(inputs, &solution.geometry, precise.as_ref(), &deviation) {
            Ok(Some(position)) => solution.follow(inputs, &masses, wanted, position),
            Ok(None) => solution.outcome = Outcome::NoCornerContact,
            Err(refusal) if inputs.rung.shares_load() => solution.withheld = Some(refusal),
            Err(refusal) => return Err(refusal),
        }
    }
    if wanted.has(Stage::Mesh) {
        load_sharing::share(&mut solution, inputs, wanted, go_on)?;
    }
    Ok(solution)
}

/// Solve with the rung that the closed form calls for. One that is too slow to be followed in time is at rest.
fn solve_by_choice(inputs: &Inputs, wanted: Stages, go_on: &dyn Fn(f64) -> bool) -> Result<Solution, Refusal> {
    let read = wanted.within(Stages::CLOSED_FORM).and(auto::READS);
    let closed_form = solve(&auto::taken(inputs, Rung::Exact), read);
    let choice = auto::choose(inputs, &closed_form);
    let solved = |rung: Rung| solve_while(&auto::taken(inputs, rung), wanted, go_on);
    let mut solution = match choice.rung {
        Rung::Exact if read.covers(wanted.within(Rung::Exact.stages())) => closed_form,
        rung => match solved(rung) {
            Err(Refusal::TooSlow { .. }) => solved(Rung::Static),
            found => found,
        },
    }?;
    solution.choice = Some(Choice { rung: solution.rung, ..choice });
    Ok(solution)
}

impl Solution {
    /// Everything after D, as far as it is wanted and can be computed.
    fn follow(&mut self, inputs: &Inputs, masses: &Masses, wanted: Stages, position: Position) {
        self.position = Some(position);
        self.withheld = self.strike(inputs, masses, wanted, &position).err();
    }

    /// The stages from the velocity on.
    fn strike(&mut self, inputs: &Inputs, masses: &Masses, wanted: Stages, position: &Position) -> Result<(), Refusal> {
        let geometry = self.geometry;
        let tip = &position.contact;
        let velocity = velocity::velocity(inputs, tip);
        if wanted.has(Stage::Velocity) {
            self.velocity = Some(velocity);
            self.stages = self.stages.with(Stage::Velocity);
        }
        if !wanted.has(Stage::Compliance) {
            return Ok(());
        }
        let teeth = compliance::teeth(inputs, &geometry, &compliance::ContactPlace::at_tip(inputs, &geometry, tip))?;
        self.compliance = Some(teeth);
        self.stages = self.stages.with(Stage::Compliance);
        if !wanted.has(Stage::Impact) {
            return Ok(());
        }
        let impact = impact::impact(inputs, &geometry, masses, tip, &teeth, &velocity)?;
        self.impact = Some(impact);
        self.stages = self.stages.with(Stage::Impact);
        if wanted.has(Stage::Friction) {
            self.friction = Some(friction::friction(inputs, &geometry, tip, &velocity, &impact, masses.reduced()));
            self.stages = self.stages.with(Stage::Friction);
        }
        if wanted.has(Stage::Band) {
            self.band = Some(band::band(inputs, impact.force));
            self.stages = self.stages.with(Stage::Band);
        }
        if wanted.has(Stage::Stations) {
            (self.stations, self.stations_withheld) = stations::stations(inputs, &geometry, masses, position, impact.force);
            self.stages = self.stages.with(Stage::Stations);
        }
        Ok(())
    }
}
