//! What each stage reads of a case, beside the results of earlier stages.
//!
//! A kept result is valid while both are equal. No other bookkeeping decides what an edit, or a
//! step of a study, computes again; points of a study that differ in load and deviations alone
//! repeat all stages after them, see `solve_repeated`.

use super::deviation::DeviationInputs;
use super::dynamic::Settings;
use super::geometry::PairShape;
use super::impact::ImpactInputs;
use super::inertia::Body;
use super::inputs::{Inputs, Method};
use super::mesh::MeshInputs;
use super::position::ContactSearch;
use super::spacing::Spacing;
use super::stage::Stage;

/// The inputs of a stage.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StageInputs {
    /// Shape of the pair, bore radii in m, and whether double-double arithmetic is asked for.
    Geometry(PairShape, [f64; 2], bool),
    /// Torque on the driver, in N m.
    Load(f64),
    /// Bodies of driver and driven gear.
    Masses([Body; 2]),
    /// Errors, reliefs and deflection.
    Deviation(DeviationInputs),
    /// How the first contact is searched for.
    Position(ContactSearch),
    /// Speed of the driver, in rad/s.
    Velocity(f64),
    /// One impact.
    Impact(ImpactInputs),
    /// The same impact by every stiffness model.
    StiffnessSpread(PairShape, DeviationInputs, ImpactInputs),
    /// Impacts between D and E.
    Stations(ImpactInputs, Spacing),
    /// Every pair along the line of action, at any speed.
    Mesh(MeshInputs),
    /// Stations of the load at rest, and the speed of the driver in rad/s, by which they slide.
    Static(Spacing, f64),
    /// The motion, and the speed of the driver in rad/s.
    Dynamic(Settings, f64),
    /// Mesh frequency, by the speed of the driver in rad/s.
    Resonance(f64),
    /// Results of other stages alone.
    Results,
    /// The steady motion, which has neither warm-up nor stations, and the speed of the driver in
    /// rad/s.
    SteadyMotion(Settings, f64),
    /// The search for the relief: the mesh and the motion of the methods that have them.
    Clearing(DeviationInputs, Option<MeshInputs>, Option<Settings>),
}

impl Stage {
    /// What the stage reads of a case.
    #[must_use]
    pub fn inputs(self, inputs: &Inputs) -> StageInputs {
        match self {
            Stage::Geometry => {
                StageInputs::Geometry(inputs.shape(), inputs.bores(), inputs.accurate)
            }
            Stage::Load => StageInputs::Load(inputs.torque()),
            Stage::Masses => StageInputs::Masses(inputs.bodies()),
            Stage::Deviation => StageInputs::Deviation(inputs.deviation()),
            Stage::Position => StageInputs::Position(inputs.contact_search()),
            Stage::Velocity => StageInputs::Velocity(inputs.speed),
            Stage::Compliance | Stage::Impact | Stage::Friction => {
                StageInputs::Impact(inputs.impact())
            }
            Stage::Band => {
                StageInputs::StiffnessSpread(inputs.shape(), inputs.deviation(), inputs.impact())
            }
            Stage::Stations => StageInputs::Stations(inputs.impact(), Spacing::of(inputs)),
            Stage::Mesh => StageInputs::Mesh(inputs.mesh().at_speed(1.0)),
            Stage::Static => StageInputs::Static(Spacing::of(inputs), inputs.speed),
            Stage::Dynamic => StageInputs::Dynamic(inputs.motion(), inputs.speed),
            Stage::Resonance => StageInputs::Resonance(inputs.speed),
            Stage::StaticSpectrum => StageInputs::Results,
            Stage::SteadyMotion => StageInputs::SteadyMotion(inputs.steady_motion(), inputs.speed),
            Stage::Clearing => StageInputs::Clearing(
                inputs.deviation(),
                inputs.method.shares_load().then(|| inputs.mesh()),
                (inputs.method == Method::Dynamic).then(|| inputs.motion().without_stations()),
            ),
        }
    }
}
