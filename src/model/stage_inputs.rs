//! Lists the inputs of each stage, besides the results of earlier stages.
//!
//! The result of an earlier solve is valid if both are equal. Only this list decides which stages
//! run again after an edit. Points of a study that differ only in load and deviations repeat all
//! stages after those two, see `solve_repeated`.

use super::clearing::ClearingInputs;
use super::compliance::ComplianceInputs;
use super::deviation::DeviationInputs;
use super::dynamic::MotionInputs;
use super::dynamic::speeds::SpeedInputs;
use super::geometry::{GeometryInputs, LoadInputs};
use super::impact::{BandInputs, FrictionInputs, ImpactInputs};
use super::inputs::Inputs;
use super::masses::MassInputs;
use super::mesh::MeshInputs;
use super::position::{PositionInputs, VelocityInputs};
use super::stage::Stage;
use super::static_load::StaticInputs;
use super::static_spectrum::ResonanceInputs;
use super::stations::StationsInputs;

impl Stage {
    /// Whether the inputs of the stage are equal in two cases.
    #[must_use]
    pub fn has_equal_inputs(self, one: &Inputs, other: &Inputs) -> bool {
        let cases = [one, other];
        match self {
            Stage::Geometry => equal(cases, GeometryInputs::of),
            Stage::Load => equal(cases, LoadInputs::of),
            Stage::Masses => equal(cases, MassInputs::of),
            Stage::Deviation => equal(cases, DeviationInputs::of),
            Stage::Position => equal(cases, PositionInputs::of),
            Stage::Velocity => equal(cases, VelocityInputs::of),
            Stage::Compliance => equal(cases, ComplianceInputs::of),
            Stage::Impact => equal(cases, ImpactInputs::of),
            Stage::Friction => equal(cases, FrictionInputs::of),
            Stage::Band => equal(cases, BandInputs::of),
            Stage::Stations => equal(cases, StationsInputs::of),
            Stage::Mesh => equal(cases, MeshInputs::at_any_speed),
            Stage::Resonance => equal(cases, ResonanceInputs::of),
            Stage::Static => equal(cases, StaticInputs::of),
            Stage::Dynamic => equal(cases, MotionInputs::of),
            // This stage reads only the results of other stages.
            Stage::StaticSpectrum => true,
            Stage::SteadyMotion => equal(cases, MotionInputs::steady),
            Stage::SpeedRun => equal(cases, SpeedInputs::of),
            Stage::Clearing => equal(cases, ClearingInputs::of),
        }
    }
}

/// Whether the inputs of a stage are equal in two cases.
fn equal<T: PartialEq>(cases: [&Inputs; 2], of: impl Fn(&Inputs) -> T) -> bool {
    let [one, other] = cases.map(of);
    one == other
}
