//! The mesh of a pair at many places and loads, prepared once for all reliefs: a relief only widens
//! gaps.

use std::cell::OnceCell;

use super::{Demand, TipReliefs};
use crate::model::geometry::{Geometry, PairShape, geometry};
use crate::model::inputs::Gear;
use crate::model::mesh::Mesh;
use crate::model::pair_forces::PairSet;
use crate::model::relief::{Relief, Reliefs};
use crate::model::tip_gap::tip_at;
use crate::model::{Inputs, Refusal, Solution};

/// Places over a base pitch at which the transmission error is always computed.
const PLACES: usize = 48;

/// Places between two of these. Near each turning point of the transmission error the search
/// refines to these places: where a linear relief begins to carry load, the curve has a corner.
const BETWEEN: usize = 32;

/// Places beyond each end of the path of contact that are checked for corner contact.
const BEYOND: usize = 24;

/// The pairs at a place, with the radii of curvature of both flanks of each pair.
#[derive(Clone)]
struct Place {
    pairs: PairSet,
    radii: Vec<(f64, f64)>,
    first: i32,
}

/// The places beyond both ends of the path of contact under one load.
struct Corners {
    force: f64,
    places: Vec<Place>,
}

/// The places over a base pitch under one load; each place is prepared on first use.
struct Pitch {
    force: f64,
    mesh: Mesh,
    curvatures: Curvatures,
    places: Vec<OnceCell<Place>>,
}

/// The prepared mesh.
pub(super) struct PreparedMesh {
    geometry: Geometry,
    reliefs: Reliefs,
    tolerance: f64,
    loads: Vec<Pitch>,
    corners: Corners,
    /// Number of pairs at all places: of the transmission error and of the corners.
    costs: [u64; 2],
}

impl PreparedMesh {
    /// The mesh of a pair with its solution at the greatest load; `most` is the greatest sum of
    /// both reliefs, in m.
    ///
    /// # Errors
    /// Refusals of the mesh.
    pub(super) fn new(
        inputs: &Inputs,
        solution: &Solution,
        demand: &Demand,
        loads: &[f64],
        most: f64,
    ) -> Result<PreparedMesh, Refusal> {
        let bare = bare(inputs);
        let survey = Survey::new(&bare, solution, most)?;
        let unit = solution.mesh_force / demand.loads.1;
        let over_pitch = |load: &f64| survey.over_pitch(load * unit);
        let loads = loads.iter().map(over_pitch).collect::<Result<Vec<_>, _>>()?;
        let corners = survey.corners(solution.mesh_force)?;
        let pairs = corners.places.iter().map(|place| place.radii.len() as u64);
        let corner_cost: u64 = pairs.sum();
        Ok(PreparedMesh {
            geometry: solution.geometry,
            reliefs: bare.reliefs(),
            tolerance: demand.tolerance,
            costs: [
                loads.iter().map(Pitch::cost).sum(),
                tolerances(demand.tolerance).len() as u64 * corner_cost,
            ],
            loads,
            corners,
        })
    }

    /// The costs of the transmission error and of the corners of one relief.
    pub(super) fn costs(&self) -> [u64; 2] {
        self.costs
    }

    /// The peak-to-peak transmission error at each load, in m.
    pub(super) fn errors(&self, reliefs: &TipReliefs) -> impl Iterator<Item = f64> {
        let relief = self.relief(reliefs, [0.0; 2]);
        self.loads.iter().map(move |loaded| loaded.error(&relief))
    }

    /// Overlap of the teeth before E or after B at the greatest load with the least favourable
    /// tolerance, in m; below 0 the gap that remains.
    pub(super) fn overlap(&self, reliefs: &TipReliefs) -> f64 {
        self.overlap_of(reliefs, &self.corners)
    }

    /// The same overlap under `times` the force.
    ///
    /// # Errors
    /// Refusals of the mesh.
    pub(super) fn overlap_under(
        &self,
        reliefs: &TipReliefs,
        (inputs, solution): (&Inputs, &Solution),
        times: f64,
    ) -> Result<f64, Refusal> {
        let most = reliefs.amounts[0] + reliefs.amounts[1] + 2.0 * self.tolerance;
        let bare = bare(inputs);
        let mut survey = Survey::new(&bare, solution, most)?;
        survey.reach *= times.max(1.0);
        Ok(self.overlap_of(reliefs, &survey.corners(times * solution.mesh_force)?))
    }

    fn overlap_of(&self, reliefs: &TipReliefs, corners: &Corners) -> f64 {
        let ways = tolerances(self.tolerance).into_iter();
        let overlaps = ways.map(|off| corners.overlap(&self.relief(reliefs, off)));
        overlaps.fold(f64::NEG_INFINITY, f64::max)
    }

    fn relief(&self, reliefs: &TipReliefs, off: [f64; 2]) -> Relief {
        Relief::of(&with(self.reliefs, reliefs, off), &self.geometry)
    }
}

/// The combinations of deviations of both reliefs.
pub(super) fn tolerances(tolerance: f64) -> Vec<[f64; 2]> {
    let both = [-tolerance, tolerance];
    let ends = &both[..if tolerance > 0.0 { 2 } else { 1 }];
    let pairs = ends.iter().flat_map(|&one| ends.iter().map(move |&other| [one, other]));
    pairs.collect()
}

/// The reliefs with other tip reliefs and their deviations.
fn with(reliefs: Reliefs, tips: &TipReliefs, off: [f64; 2]) -> Reliefs {
    let mut all = Reliefs { shape: tips.shape, ..reliefs };
    for (at, gear) in [&mut all.driver, &mut all.driven].into_iter().enumerate() {
        gear.tip = (tips.amounts[at] + off[at]).max(0.0);
        gear.tip_length = Some(tips.lengths[at]);
    }
    all
}

/// The pair without tip reliefs.
fn bare(inputs: &Inputs) -> Inputs {
    let bare = |gear: &Gear| Gear { tip_relief: 0.0, ..gear.clone() };
    Inputs { driver: bare(&inputs.driver), driven: bare(&inputs.driven), ..inputs.clone() }
}

impl Pitch {
    /// Number of pairs at all places of a transmission error, about half of them near the turning
    /// points.
    fn cost(&self) -> u64 {
        let pairs = |at: usize| self.place(at * BETWEEN).radii.len() as u64;
        2 * (0..PLACES).map(pairs).sum::<u64>()
    }

    fn place(&self, at: usize) -> &Place {
        let count = self.places.len();
        self.places[at % count].get_or_init(|| {
            let part = ((at % count) as f64 + 0.5) / count as f64;
            self.curvatures.place(&self.mesh, part * self.mesh.base_pitch)
        })
    }

    /// The peak-to-peak transmission error, in m.
    fn error(&self, relief: &Relief) -> f64 {
        let ahead = |at: usize| {
            let eased = self.place(at).eased(relief);
            eased.balance(self.force).displacement
        };
        let even: Vec<f64> = (0..PLACES).map(|at| ahead(at * BETWEEN)).collect();
        let opposite: Vec<f64> = even.iter().map(|ahead| -ahead).collect();
        greatest(&even, &ahead) + greatest(&opposite, &|at| -ahead(at))
    }
}

/// The greatest value over a base pitch: among the even places, and next to each local maximum by
/// halving the stride.
fn greatest(even: &[f64], value: &dyn Fn(usize) -> f64) -> f64 {
    let count = even.len();
    let exceeds = |at: &usize| {
        let [before, after] = [at + count - 1, at + 1].map(|next| even[next % count]);
        even[*at] >= before && even[*at] > after
    };
    let climbed = |turn: usize| {
        // One base pitch is added, so that no index is negative.
        let (mut at, mut most) = ((turn + count) * BETWEEN, even[turn]);
        let mut stride = BETWEEN / 2;
        while stride > 0 {
            for next in [at - stride, at + stride] {
                let found = value(next);
                if found > most {
                    (at, most) = (next, found);
                }
            }
            stride /= 2;
        }
        most
    };
    let turns = (0..count).filter(exceeds).map(climbed);
    turns.fold(even[0], f64::max)
}

impl Corners {
    fn overlap(&self, relief: &Relief) -> f64 {
        let leads = self.places.iter().map(|place| place.eased(relief).lead(0, self.force));
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

/// Data for the radii of curvature at a place.
#[derive(Clone, Copy)]
struct Curvatures {
    geometry: Geometry,
    swapped: Geometry,
}

struct Survey<'a> {
    inputs: &'a Inputs,
    solution: &'a Solution,
    curvatures: Curvatures,
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
            curvatures: Curvatures {
                geometry: solution.geometry,
                swapped: geometry(&PairShape {
                    driver: shape.driven,
                    driven: shape.driver,
                    ..shape
                })?,
            },
            reach: FURTHER * (2.0 * yields + most + inputs.reliefs().sum()),
        })
    }

    fn mesh(&self, force: f64, error: f64) -> Result<Mesh, Refusal> {
        let mut inputs = self.inputs.mesh();
        // The places apply the root reliefs together with the tip reliefs.
        (inputs.reliefs.driver.root, inputs.reliefs.driven.root) = (0.0, 0.0);
        Mesh::new(&inputs, &self.solution.geometry, force, error, self.reach)
    }

    fn over_pitch(&self, force: f64) -> Result<Pitch, Refusal> {
        Ok(Pitch {
            force,
            mesh: self.mesh(force, 0.0)?,
            curvatures: self.curvatures,
            places: vec![OnceCell::new(); PLACES * BETWEEN],
        })
    }

    /// Places from the ends of the path of contact outwards, denser near the ends.
    fn corners(&self, force: f64) -> Result<Corners, Refusal> {
        let mesh = self.mesh(force, self.solution.deviation.equivalent_error)?;
        let (from, to) = mesh.ends();
        let part = |at: usize| (at as f64 / BEYOND as f64).powi(2);
        let before = (0..=BEYOND).map(|at| part(at) * from);
        let after = (0..=BEYOND).map(|at| mesh.length + part(at) * (to - mesh.length));
        let places = before.chain(after);
        Ok(Corners { force, places: places.map(|s| self.curvatures.place(&mesh, s)).collect() })
    }
}

impl Curvatures {
    fn place(&self, mesh: &Mesh, s: f64) -> Place {
        let pairs = mesh.pair_set(s, s);
        let way = |ahead: i32| s + f64::from(ahead) * mesh.base_pitch;
        let all = pairs.pairs().iter();
        Place {
            radii: all.map(|pair| self.at(mesh, way(pair.ahead))).collect(),
            first: pairs.pairs().first().map_or(0, |pair| pair.ahead),
            pairs,
        }
    }

    /// The radii of curvature of both flanks at the contact of a pair.
    fn at(&self, mesh: &Mesh, s: f64) -> (f64, f64) {
        let geometry = &self.geometry;
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
