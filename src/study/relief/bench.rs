//! The mesh of a pair at many places and loads, prepared once for all reliefs: a relief only widens
//! gaps.

use super::{Demand, TipReliefs};
use crate::model::geometry::{Geometry, PairShape, geometry};
use crate::model::inputs::Gear;
use crate::model::mesh::Mesh;
use crate::model::pair_forces::PairSet;
use crate::model::relief::{Relief, Reliefs};
use crate::model::tip_gap::tip_at;
use crate::model::{Inputs, Refusal, Solution};

/// Places over a base pitch at which the transmission error counts.
const PLACES: usize = 48;

/// Places beyond each end of the path of contact at which corner contact is looked for.
const BEYOND: usize = 24;

/// The pairs at a place, with the radii of curvature of both flanks of each.
struct Place {
    pairs: PairSet,
    radii: Vec<(f64, f64)>,
    first: i32,
}

/// The places of one load.
struct Loaded {
    force: f64,
    places: Vec<Place>,
}

/// The prepared mesh.
pub(super) struct Bench {
    geometry: Geometry,
    reliefs: Reliefs,
    tolerance: f64,
    loads: Vec<Loaded>,
    corners: Loaded,
    /// Pairs at all places together, of the transmission error and of the corners.
    costs: [u64; 2],
}

impl Bench {
    /// The mesh of a pair whose solution at the greatest load is given, for reliefs up to `most`
    /// together, in m.
    ///
    /// # Errors
    /// Those of the mesh.
    pub(super) fn new(
        inputs: &Inputs,
        solution: &Solution,
        demand: &Demand,
        loads: &[f64],
        most: f64,
    ) -> Result<Bench, Refusal> {
        let bare = bare(inputs);
        let survey = Survey::new(&bare, solution, most)?;
        let unit = solution.mesh_force / demand.loads.1;
        let over_pitch = |load: &f64| survey.over_pitch(load * unit);
        let loads = loads
            .iter()
            .map(over_pitch)
            .collect::<Result<Vec<_>, _>>()?;
        let corners = survey.corners(solution.mesh_force)?;
        let cost = |loaded: &Loaded| {
            let pairs = loaded.places.iter().map(|place| place.radii.len() as u64);
            pairs.sum::<u64>()
        };
        Ok(Bench {
            geometry: solution.geometry,
            reliefs: bare.reliefs(),
            tolerance: demand.tolerance,
            costs: [
                loads.iter().map(cost).sum(),
                tolerances(demand.tolerance).len() as u64 * cost(&corners),
            ],
            loads,
            corners,
        })
    }

    /// What the transmission error and the corners of one relief cost.
    pub(super) fn costs(&self) -> [u64; 2] {
        self.costs
    }

    /// The peak-to-peak transmission error at each load, in m.
    pub(super) fn errors(&self, reliefs: &TipReliefs) -> impl Iterator<Item = f64> {
        let relief = self.relief(reliefs, [0.0; 2]);
        self.loads.iter().map(move |loaded| loaded.error(&relief))
    }

    /// By how much the teeth overlap before E or after B at the greatest load, in m, with the
    /// tolerance on its bad side; below 0 the gap that remains.
    pub(super) fn overlap(&self, reliefs: &TipReliefs) -> f64 {
        self.overlap_of(reliefs, &self.corners)
    }

    /// The same under another force, in N.
    ///
    /// # Errors
    /// Those of the mesh.
    pub(super) fn overlap_under(
        &self,
        reliefs: &TipReliefs,
        (inputs, solution): (&Inputs, &Solution),
        force: f64,
    ) -> Result<f64, Refusal> {
        let most = reliefs.amounts[0] + reliefs.amounts[1] + 2.0 * self.tolerance;
        let scale = (force / solution.mesh_force).max(1.0);
        let bare = bare(inputs);
        let survey = Survey::new(&bare, solution, scale * most)?;
        Ok(self.overlap_of(reliefs, &survey.corners(force)?))
    }

    fn overlap_of(&self, reliefs: &TipReliefs, corners: &Loaded) -> f64 {
        let ways = tolerances(self.tolerance).into_iter();
        let overlaps = ways.map(|off| corners.overlap(&self.relief(reliefs, off)));
        overlaps.fold(f64::NEG_INFINITY, f64::max)
    }

    fn relief(&self, reliefs: &TipReliefs, off: [f64; 2]) -> Relief {
        Relief::of(&with(self.reliefs, reliefs, off), &self.geometry)
    }
}

/// The ways in which both reliefs may be off.
pub(super) fn tolerances(tolerance: f64) -> Vec<[f64; 2]> {
    let both = [-tolerance, tolerance];
    let ends = &both[..if tolerance > 0.0 { 2 } else { 1 }];
    let pairs = ends
        .iter()
        .flat_map(|&one| ends.iter().map(move |&other| [one, other]));
    pairs.collect()
}

/// The reliefs with other tip reliefs, off by so much.
fn with(reliefs: Reliefs, tips: &TipReliefs, off: [f64; 2]) -> Reliefs {
    let mut all = Reliefs {
        shape: tips.shape,
        ..reliefs
    };
    for (at, gear) in [&mut all.driver, &mut all.driven].into_iter().enumerate() {
        gear.tip = (tips.amounts[at] + off[at]).max(0.0);
        gear.tip_length = Some(tips.lengths[at]);
    }
    all
}

/// The pair without tip reliefs.
fn bare(inputs: &Inputs) -> Inputs {
    let bare = |gear: &Gear| Gear {
        tip_relief: 0.0,
        ..gear.clone()
    };
    Inputs {
        driver: bare(&inputs.driver),
        driven: bare(&inputs.driven),
        ..inputs.clone()
    }
}

impl Loaded {
    fn error(&self, relief: &Relief) -> f64 {
        let ahead = self.places.iter().map(|place| {
            let eased = place.eased(relief);
            eased.balance(self.force).displacement
        });
        let (least, most) = ahead.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), x| {
            (least.min(x), most.max(x))
        });
        most - least
    }

    fn overlap(&self, relief: &Relief) -> f64 {
        let leads = self
            .places
            .iter()
            .map(|place| place.eased(relief).lead(0, self.force));
        leads.fold(f64::NEG_INFINITY, f64::max)
    }
}

impl Place {
    fn eased(&self, relief: &Relief) -> PairSet {
        self.pairs.widened(|ahead| {
            let index = usize::try_from(ahead - self.first).unwrap_or(0);
            let (driver, driven) = self.radii[index];
            relief.at(driver, driven)
        })
    }
}

/// Prepares the places.
struct Survey<'a> {
    inputs: &'a Inputs,
    solution: &'a Solution,
    swapped: Geometry,
    reach: f64,
}

impl<'a> Survey<'a> {
    fn new(inputs: &'a Inputs, solution: &'a Solution, most: f64) -> Result<Survey<'a>, Refusal> {
        const FURTHER: f64 = 4.0;
        let shape = inputs.shape();
        let deviation = &solution.deviation;
        let yields = deviation.loaded_deflection() + deviation.equivalent_error.abs();
        Ok(Survey {
            inputs,
            solution,
            swapped: geometry(&PairShape {
                driver: shape.driven,
                driven: shape.driver,
                ..shape
            })?,
            reach: FURTHER * (2.0 * yields + most + inputs.reliefs().sum()),
        })
    }

    fn mesh(&self, force: f64, error: f64) -> Result<Mesh, Refusal> {
        let mut inputs = self.inputs.mesh();
        // The places take the root reliefs with the tip reliefs.
        (inputs.reliefs.driver.root, inputs.reliefs.driven.root) = (0.0, 0.0);
        Mesh::new(&inputs, &self.solution.geometry, force, error, self.reach)
    }

    fn over_pitch(&self, force: f64) -> Result<Loaded, Refusal> {
        let mesh = self.mesh(force, 0.0)?;
        let place = |at: usize| (at as f64 + 0.5) / PLACES as f64 * mesh.base_pitch;
        let places = (0..PLACES).map(|at| self.place(&mesh, place(at)));
        Ok(Loaded {
            force,
            places: places.collect(),
        })
    }

    /// Places from the ends of the path of contact outwards, closer to each other at the ends.
    fn corners(&self, force: f64) -> Result<Loaded, Refusal> {
        let mesh = self.mesh(force, self.solution.deviation.equivalent_error)?;
        let (from, to) = mesh.ends();
        let part = |at: usize| (at as f64 / BEYOND as f64).powi(2);
        let before = (0..=BEYOND).map(|at| part(at) * from);
        let after = (0..=BEYOND).map(|at| mesh.length + part(at) * (to - mesh.length));
        let places = before.chain(after).map(|s| self.place(&mesh, s));
        Ok(Loaded {
            force,
            places: places.collect(),
        })
    }

    fn place(&self, mesh: &Mesh, s: f64) -> Place {
        let pairs = mesh.pair_set(s, s);
        let way = |ahead: i32| s + f64::from(ahead) * mesh.base_pitch;
        let all = pairs.pairs().iter();
        Place {
            radii: all.map(|pair| self.radii(mesh, way(pair.ahead))).collect(),
            first: pairs.pairs().first().map_or(0, |pair| pair.ahead),
            pairs,
        }
    }

    /// The radii of curvature of both flanks where a pair touches.
    fn radii(&self, mesh: &Mesh, s: f64) -> (f64, f64) {
        let geometry = &self.solution.geometry;
        if s < 0.0 {
            let tip = tip_at(geometry, -s / geometry.driven.base);
            return (tip.curvature_driver, geometry.driven.tip_curvature);
        }
        if s > mesh.length {
            let tip = tip_at(&self.swapped, (s - mesh.length) / geometry.driver.base);
            return (geometry.driver.tip_curvature, tip.curvature_driver);
        }
        let along = geometry.start + s;
        (along, geometry.tangent_length - along)
    }
}
