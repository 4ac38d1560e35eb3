//! Lists the inputs of each stage, besides the results of earlier stages.
//!
//! The result of an earlier solve is valid if both are equal. Only this list decides which stages
//! run again after an edit.

use super::deviation::GivenDeviations;
use super::dynamic::Settings;
use super::inputs::{Inputs, Method};
use super::spacing::Spacing;
use super::stage::Stage;

impl Stage {
    /// Whether the inputs of the stage are equal in two cases.
    #[must_use]
    pub fn has_equal_inputs(self, one: &Inputs, other: &Inputs) -> bool {
        let cases = [one, other];
        let stages =
            |stages: &[Stage]| stages.iter().all(|stage| stage.has_equal_inputs(one, other));
        match self {
            Stage::Geometry => equal(cases, |i| (i.shape(), i.bores(), i.accurate)),
            Stage::Load => equal(cases, Inputs::torque),
            Stage::Masses => equal(cases, Inputs::bodies),
            // The load causes the deflection if the case does not give it.
            Stage::Deviation => {
                equal(cases, GivenDeviations::of)
                    && (one.given_deflection().is_some() || equal(cases, Inputs::elasticity))
            }
            Stage::Position => equal(cases, |i| (i.method, i.shape(), i.driven.tip_radius)),
            Stage::Velocity => equal(cases, Inputs::driven_speed),
            Stage::Compliance => equal(cases, |i| (i.driven.tip_radius, i.elasticity())),
            Stage::Impact => equal(cases, |i| i.method) && stages(&[Stage::Compliance]),
            Stage::Friction => equal(cases, |i| (i.method, i.speed)),
            Stage::Band => {
                stages(&[Stage::Deviation, Stage::Position, Stage::Velocity, Stage::Impact])
            }
            Stage::Stations => {
                stages(&[Stage::Velocity, Stage::Impact]) && equal(cases, Spacing::of)
            }
            Stage::Mesh => equal(cases, |i| i.mesh().at_speed(1.0)),
            Stage::Resonance => equal(cases, |i| i.speed),
            Stage::Static => equal(cases, |i| (i.speed, Spacing::of(i))),
            Stage::Dynamic => equal(cases, |i| (i.speed, Settings::of(i, 0.0))),
            // This stage reads only the results of other stages.
            Stage::StaticSpectrum => true,
            Stage::SteadyMotion => equal(cases, |i| (i.speed, Settings::steady(i, 0.0))),
            // The torque stays the same at every speed.
            Stage::SpeedRun => stages(&[Stage::SteadyMotion]) && equal(cases, Inputs::torque),
            Stage::Clearing => {
                equal(cases, |i| (i.method, i.driven.tip_relief))
                    && match one.method {
                        Method::Exact | Method::Auto => true,
                        Method::Paper => equal(cases, Inputs::shape),
                        Method::Static => equal(cases, Inputs::mesh),
                        Method::Dynamic => {
                            equal(cases, |i| (i.mesh(), i.speed, Settings::approach(i, 0.0)))
                        }
                    }
            }
        }
    }
}

/// Whether the inputs of a stage are equal in two cases.
fn equal<T: PartialEq>(cases: [&Inputs; 2], of: impl Fn(&Inputs) -> T) -> bool {
    let [one, other] = cases.map(of);
    one == other
}
