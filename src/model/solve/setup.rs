//! Values that a closed-form solve computes before load and deviations, each on first use.

use std::cell::OnceCell;

use twofloat::TwoFloat;

use crate::model::compliance::Teeth;
use crate::model::deviation::{Deflected, GivenDeviations, LoadedPairs};
use crate::model::impact::{FrictionInputs, ImpactInputs};
use crate::model::inputs::Inputs;
use crate::model::position::{GapSeries, PositionInputs, VelocityInputs};
use crate::model::{Geometry, Refusal};

/// Values that a closed-form solve computes before load and deviations. All belong to one geometry,
/// which the caller passes.
#[derive(Debug, Clone)]
pub struct Setup {
    pub(super) position: PositionInputs,
    pub(super) velocity: VelocityInputs,
    /// Inputs of the impact, with the elasticity.
    pub(super) impact: ImpactInputs,
    pub(super) friction: FrictionInputs,
    /// Geometry in double-double arithmetic if it is needed.
    pub(super) precise: OnceCell<Option<Geometry<TwoFloat>>>,
    series: OnceCell<GapSeries>,
    teeth: OnceCell<Result<Teeth, Refusal>>,
    loaded: OnceCell<Result<LoadedPairs, Refusal>>,
}

impl Setup {
    pub(super) fn of(inputs: &Inputs) -> Setup {
        Setup {
            position: PositionInputs::of(inputs),
            velocity: VelocityInputs::of(inputs),
            impact: ImpactInputs::of(inputs),
            friction: FrictionInputs::of(inputs),
            precise: OnceCell::new(),
            series: OnceCell::new(),
            teeth: OnceCell::new(),
            loaded: OnceCell::new(),
        }
    }

    pub(super) fn series(&self, geometry: &Geometry) -> &GapSeries {
        self.series.get_or_init(|| GapSeries::of(geometry))
    }

    pub(super) fn teeth(&self, geometry: &Geometry) -> Result<&Teeth, Refusal> {
        let teeth = || Teeth::of(&self.impact.compliance.elasticity, geometry);
        let known = self.teeth.get_or_init(teeth);
        known.as_ref().map_err(|refusal| *refusal)
    }

    /// The deflection from the load.
    pub(super) fn deflected(
        &self,
        given: &GivenDeviations,
        geometry: &Geometry,
        mesh_force: f64,
    ) -> Result<Deflected, Refusal> {
        let teeth = || self.teeth(geometry);
        let loaded = || LoadedPairs::of(given.method, geometry, teeth);
        let pairs = self.loaded.get_or_init(loaded);
        let pairs = pairs.as_ref().map_err(|refusal| *refusal)?;
        pairs.deflected(teeth()?, mesh_force)
    }
}
