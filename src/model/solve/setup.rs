//! What a closed-form solve computes before load and deviations enter, each part where it is first
//! wanted.

use std::cell::OnceCell;

use twofloat::TwoFloat;

use crate::model::compliance::Teeth;
use crate::model::deviation::{Deflected, LoadedPairs};
use crate::model::impact::ImpactInputs;
use crate::model::inputs::Inputs;
use crate::model::position::{ContactSearch, GapSeries};
use crate::model::{Geometry, Refusal};

/// What a closed-form solve computes before load and deviations enter. The parts belong to one
/// geometry, which their users hand over.
#[derive(Debug, Clone)]
pub struct Setup {
    pub(super) search: ContactSearch,
    pub(super) impact: ImpactInputs,
    /// Geometry in double-double arithmetic, where it is called for.
    pub(super) precise: OnceCell<Option<Geometry<TwoFloat>>>,
    series: OnceCell<GapSeries>,
    teeth: OnceCell<Result<Teeth, Refusal>>,
    loaded: OnceCell<Result<LoadedPairs, Refusal>>,
}

impl Setup {
    pub(super) fn of(inputs: &Inputs) -> Setup {
        Setup {
            search: inputs.contact_search(),
            impact: inputs.impact(),
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
        let teeth = || Teeth::of(&self.impact.elasticity, geometry);
        let known = self.teeth.get_or_init(teeth);
        known.as_ref().map_err(|refusal| *refusal)
    }

    /// The deflection by the load.
    pub(super) fn deflected(
        &self,
        geometry: &Geometry,
        mesh_force: f64,
    ) -> Result<Deflected, Refusal> {
        let teeth = || self.teeth(geometry);
        let loaded = || LoadedPairs::of(self.search.method, geometry, teeth);
        let pairs = self.loaded.get_or_init(loaded);
        let pairs = pairs.as_ref().map_err(|refusal| *refusal)?;
        pairs.deflected(teeth()?, mesh_force)
    }
}
