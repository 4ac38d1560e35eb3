//! The search over round amounts and lengths.

use std::cell::OnceCell;
use std::collections::HashMap;

use super::{AMOUNT_STEP, Demand, MapPoint, NoRelief, TipReliefs, decimal};
use crate::model::geometry::{Geometry, PairShape, geometry};
use crate::model::inputs::{Gear, ReliefShape};
use crate::model::mesh::Mesh;
use crate::model::pair_forces::PairSet;
use crate::model::position::tip_at;
use crate::model::relief::{Relief, Reliefs};
use crate::model::{Inputs, Refusal, Solution};

/// A relief in whole steps: amounts on driver and driven gear, then lengths.
type Steps = [i32; 4];

/// The kinds of relief: the shape, the name, and the name if both gears have the same relief.
const KINDS: [(ReliefShape, [&str; 2]); 2] = [
    (ReliefShape::Linear, ["linear", "linear, both alike"]),
    (ReliefShape::Parabolic, ["parabolic", "parabolic, both alike"]),
];

/// Start lengths, relative to the longest length.
const PARTS: [f64; 7] = [0.15, 0.3, 0.45, 0.6, 0.75, 0.9, 1.0];
/// The number of start lengths, in equal steps, if both gears have the same length.
const PARTS_ALIKE: u32 = 20;
/// Start amounts, relative to the least amount without corner contact.
const TIMES: [f64; 4] = [1.0, 1.15, 1.4, 1.8];
/// Number of starts that the search follows: with two free lengths, and with one.
const FOLLOWED: [usize; 2] = [6, 16];
/// Greatest stride of the search, in steps; it is halved down to one step.
const STRIDE: i32 = 8;
/// Greatest number of reliefs that the search evaluates.
pub(super) const MOST_TRIES: u64 = 50_000;
/// Number of reliefs that a typical search evaluates.
const USUAL_TRIES: f64 = 7_500.0;

/// The steps and bounds of amounts and lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    /// Step of a length, in m.
    pub(super) length_step: f64,
    /// Least and greatest length, in steps.
    pub(super) least_length: i32,
    pub(super) most_length: i32,
    /// Greatest amounts on driver and driven gear, in steps.
    pub(super) most_amounts: [i32; 2],
    /// Greatest amounts that the tips may lose, in m.
    pub(super) tips: [f64; 2],
}

impl Grid {
    /// The reliefs with amounts increased by `steps`, if the tips allow it.
    pub(super) fn greater(&self, reliefs: &TipReliefs, steps: i32) -> Option<TipReliefs> {
        let more = |at: usize| {
            let amount = (reliefs.amounts[at] / AMOUNT_STEP).round() as i32 + steps;
            (amount <= self.most_amounts[at]).then(|| decimal(AMOUNT_STEP * f64::from(amount)))
        };
        Some(TipReliefs { amounts: [more(0)?, more(1)?], ..*reliefs })
    }

    fn reliefs(&self, shape: ReliefShape, [one, other, from, to]: Steps) -> TipReliefs {
        TipReliefs {
            shape,
            amounts: [one, other].map(|steps| decimal(AMOUNT_STEP * f64::from(steps))),
            lengths: [from, to].map(|steps| decimal(self.length_step * f64::from(steps))),
        }
    }

    /// The same amount on both gears, as far as the tips allow it.
    fn equal(&self, amount: i32, [one, other]: [i32; 2]) -> Steps {
        let [driver, driven] = self.most_amounts.map(|most| amount.min(most));
        [driver, driven, one, other]
    }

    fn has(&self, [driver, driven, one, other]: Steps) -> bool {
        let lengths = self.least_length..=self.most_length;
        (0..=self.most_amounts[0]).contains(&driver)
            && (0..=self.most_amounts[1]).contains(&driven)
            && lengths.contains(&one)
            && lengths.contains(&other)
    }
}

/// The cost of a relief: whether it has corner contact, then the overlap, otherwise the transmission
/// error. Any overlap costs more than any error.
type Cost = (bool, f64);

/// A relief with its cost.
type Tried = (Steps, Cost);

fn by_cost(one: &Tried, other: &Tried) -> std::cmp::Ordering {
    one.1.partial_cmp(&other.1).unwrap_or(std::cmp::Ordering::Equal)
}

pub(super) struct Search<'a> {
    pub(super) bench: &'a PreparedMesh<'a>,
    pub(super) grid: &'a Grid,
    pub(super) go_on: &'a dyn Fn(f64) -> bool,
    /// The costs of the evaluated reliefs, by shape and steps.
    pub(super) known: HashMap<(bool, Steps), Cost>,
}

impl Search<'_> {
    /// The number of evaluated reliefs.
    pub(super) fn tries(&self) -> u64 {
        self.known.len() as u64
    }

    /// The best relief of each kind without corner contact, those with equal gears last.
    ///
    /// # Errors
    /// Returns an error if no kind has such a relief, or if the user stops the search.
    pub(super) fn best_of_each_kind(
        &mut self,
    ) -> Result<Vec<(&'static str, TipReliefs)>, NoRelief> {
        let (mut own, mut alike) = (Vec::new(), Vec::new());
        for (shape, names) in KINDS {
            let best_alike = self.best(shape, true, None)?;
            let best = self.best(shape, false, best_alike)?;
            let named = |name, best: Option<Tried>| Some((name, self.grid.reliefs(shape, best?.0)));
            own.extend(named(names[0], best));
            alike.extend(named(names[1], best_alike));
        }
        own.append(&mut alike);
        if own.is_empty() { Err(self.none()) } else { Ok(own) }
    }

    /// Why no relief prevents corner contact.
    fn none(&self) -> NoRelief {
        let Grid { tips, most_amounts: [one, other], most_length, .. } = *self.grid;
        let steps = [one, other, most_length, most_length];
        let overlap = self.bench.overlap(&self.grid.reliefs(ReliefShape::Linear, steps));
        let most = AMOUNT_STEP * f64::from(one.max(other));
        match (0..2).find(|&at| tips[at] < most + AMOUNT_STEP) {
            Some(at) => {
                NoRelief::ThinTip { gear: ["driver", "driven"][at], most: tips[at], overlap }
            }
            None => NoRelief::Beyond { most, overlap },
        }
    }

    /// The best relief of a kind; the search also follows `start`.
    fn best(
        &mut self,
        shape: ReliefShape,
        is_alike: bool,
        start: Option<Tried>,
    ) -> Result<Option<Tried>, NoRelief> {
        let mut starts = self.starts(shape, is_alike)?;
        starts.sort_by(by_cost);
        starts.truncate(FOLLOWED[usize::from(is_alike)]);
        let directions = directions(is_alike);
        let mut found = Vec::new();
        for start in starts.into_iter().chain(start) {
            found.push(self.followed(shape, &directions, start)?);
        }
        Ok(found.into_iter().min_by(by_cost).filter(|(_, (overlaps, _))| !overlaps))
    }

    /// Reliefs of several lengths with the least amounts without corner contact, and with greater
    /// amounts.
    fn starts(&mut self, shape: ReliefShape, is_alike: bool) -> Result<Vec<Tried>, NoRelief> {
        let grid = self.grid;
        let (least, most) = (f64::from(grid.least_length), f64::from(grid.most_length));
        let length = |part: f64| (part * most).round().max(least) as i32;
        let lengths: Vec<[i32; 2]> = if is_alike {
            let part = |at: u32| f64::from(at) / f64::from(PARTS_ALIKE);
            (1..=PARTS_ALIKE).map(|at| [length(part(at)); 2]).collect()
        } else {
            PARTS.iter().flat_map(|one| PARTS.map(|other| [length(*one), length(other)])).collect()
        };
        let mut starts: Vec<Tried> = Vec::new();
        for lengths in lengths {
            let clears = self.least_clear(shape, lengths)?;
            for times in TIMES {
                let steps = grid.equal((f64::from(clears) * times).round() as i32, lengths);
                if starts.iter().all(|(known, _)| *known != steps) {
                    starts.push((steps, self.cost(shape, steps)?));
                }
            }
        }
        Ok(starts)
    }

    /// The least amount, the same on both gears, without overlap; the greatest amount if there is
    /// none. Amounts are tried in rising order: a very large relief shifts load to the pair ahead,
    /// whose deflection causes an overlap again.
    fn least_clear(&mut self, shape: ReliefShape, lengths: [i32; 2]) -> Result<i32, NoRelief> {
        const STRIDES: i32 = 24;
        let grid = self.grid;
        let mut overlaps = |amount: i32| {
            let (overlaps, _) = self.cost(shape, grid.equal(amount, lengths))?;
            Ok::<bool, NoRelief>(overlaps)
        };
        let [one, other] = grid.most_amounts;
        let greatest = one.max(other);
        let stride = (greatest / STRIDES).max(1);
        let (mut low, mut high) = (-1, 0);
        while overlaps(high)? {
            if high >= greatest {
                return Ok(greatest);
            }
            (low, high) = (high, (high + stride).min(greatest));
        }
        while high - low > 1 {
            let middle = i32::midpoint(low, high);
            if overlaps(middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(high)
    }

    /// The best relief that steps in every direction find from a start, long steps first.
    fn followed(
        &mut self,
        shape: ReliefShape,
        directions: &[Steps],
        start: Tried,
    ) -> Result<Tried, NoRelief> {
        let (mut best, mut stride) = (start, STRIDE);
        while stride > 0 {
            let (at, before) = best;
            for direction in directions {
                let next: Steps = std::array::from_fn(|axis| at[axis] + stride * direction[axis]);
                if self.grid.has(next) {
                    let cost = self.cost(shape, next)?;
                    if cost < best.1 {
                        best = (next, cost);
                    }
                }
            }
            if best.1 == before {
                stride /= 2;
            }
        }
        Ok(best)
    }

    /// The cost of a relief. After the last try, a relief that is not known costs an infinite
    /// overlap.
    fn cost(&mut self, shape: ReliefShape, steps: Steps) -> Result<Cost, NoRelief> {
        /// Part of the mean error in the cost, which decides between equal greatest errors.
        const MEAN: f64 = 1e-3;
        let key = (shape == ReliefShape::Linear, steps);
        if let Some(&known) = self.known.get(&key) {
            return Ok(known);
        }
        if !(self.go_on)(self.tries() as f64 / USUAL_TRIES) {
            return Err(NoRelief::Refused(Refusal::Stopped));
        }
        if self.tries() >= MOST_TRIES {
            return Ok((true, f64::INFINITY));
        }
        let reliefs = self.grid.reliefs(shape, steps);
        let overlap = self.bench.overlap(&reliefs);
        let cost = if overlap > 0.0 {
            (true, overlap)
        } else {
            let errors: Vec<f64> = self.bench.errors(&reliefs).collect();
            let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
            (false, errors.into_iter().fold(0.0, f64::max) + MEAN * mean)
        };
        self.known.insert(key, cost);
        Ok(cost)
    }

    /// The map around a relief over both amounts and both lengths in proportion; the map contains
    /// the relief itself.
    pub(super) fn map(&self, reliefs: &TipReliefs) -> Vec<Vec<MapPoint>> {
        const AMOUNTS: [f64; 7] = [0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6];
        const LENGTHS: [f64; 6] = [0.25, 0.4, 0.55, 0.7, 0.85, 1.0];
        /// A length of the map this close to the length of the relief is omitted.
        const CLOSE: f64 = 0.03;
        let longest = self.grid.length_step * f64::from(self.grid.most_length);
        let greatest = reliefs.lengths[0].max(reliefs.lengths[1]);
        let own = greatest / longest;
        let mut parts = LENGTHS.to_vec();
        parts.retain(|part| (part - own).abs() > CLOSE);
        parts.push(own);
        parts.sort_by(f64::total_cmp);
        let point = |part: f64, times: f64| {
            let scale = part * longest / greatest;
            let reliefs = TipReliefs {
                shape: reliefs.shape,
                amounts: reliefs.amounts.map(|amount| times * amount),
                lengths: reliefs.lengths.map(|length| scale * length),
            };
            let error = self.bench.errors(&reliefs).fold(0.0, f64::max);
            MapPoint { reliefs, error, margin: -self.bench.overlap(&reliefs) }
        };
        let row = |part| AMOUNTS.map(|times| point(part, times)).to_vec();
        parts.into_iter().map(row).collect()
    }
}

/// Every direction to a neighbour; both gears together if they have the same relief.
fn directions(is_alike: bool) -> Vec<Steps> {
    let of = |index: i32| [1, 3, 9, 27].map(|power| index / power % 3 - 1);
    let is_wanted = |steps: &Steps| {
        *steps != [0; 4] && (!is_alike || steps[0] == steps[1] && steps[2] == steps[3])
    };
    (0..81).map(of).filter(is_wanted).collect()
}

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
}

impl Place {
    fn eased(&self, relief: &Relief) -> PairSet {
        let first = self.pairs.pairs().first().map_or(0, |pair| pair.ahead);
        self.pairs.widened(|ahead| {
            let (driver, driven) = self.radii[usize::try_from(ahead - first).unwrap_or(0)];
            relief.at(driver, driven)
        })
    }
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
    places: Vec<OnceCell<Place>>,
}

/// A pair without tip reliefs, and its solution at the greatest load.
struct BarePair<'a> {
    inputs: Inputs,
    solution: &'a Solution,
    /// The geometry with the gears exchanged.
    swapped: Geometry,
}

/// The prepared mesh.
pub(super) struct PreparedMesh<'a> {
    pair: BarePair<'a>,
    tolerance: f64,
    loads: Vec<Pitch>,
    corners: Corners,
}

impl<'a> PreparedMesh<'a> {
    /// The mesh of a pair with its solution at the greatest load; the grid has the greatest reliefs.
    ///
    /// # Errors
    /// Refusals of the mesh.
    pub(super) fn new(
        inputs: &Inputs,
        solution: &'a Solution,
        demand: &Demand,
        loads: &[f64],
        grid: &Grid,
    ) -> Result<PreparedMesh<'a>, Refusal> {
        let [driver, driven] = grid.most_amounts;
        let most = AMOUNT_STEP * f64::from(driver + driven);
        let bare = |gear: &Gear| Gear { tip_relief: 0.0, ..gear.clone() };
        let (driver, driven) = (bare(&inputs.driver), bare(&inputs.driven));
        let inputs = Inputs { driver, driven, ..inputs.clone() };
        let shape = inputs.shape();
        let swapped = PairShape { driver: shape.driven, driven: shape.driver, ..shape };
        let pair = BarePair { inputs, solution, swapped: geometry(&swapped)? };
        let unit = solution.mesh_force / demand.loads.1;
        let pitch = |load: &f64| {
            let (force, places) = (load * unit, vec![OnceCell::new(); PLACES * BETWEEN]);
            Ok(Pitch { force, mesh: pair.mesh((force, 0.0), most, 1.0)?, places })
        };
        Ok(PreparedMesh {
            loads: loads.iter().map(pitch).collect::<Result<_, Refusal>>()?,
            corners: pair.corners(most, 1.0)?,
            tolerance: demand.tolerance,
            pair,
        })
    }

    /// The peak-to-peak transmission error at each load, in m.
    pub(super) fn errors(&self, reliefs: &TipReliefs) -> impl Iterator<Item = f64> {
        let relief = self.relief(reliefs, [0.0; 2]);
        self.loads.iter().map(move |pitch| {
            let ahead = |at: usize| {
                let eased = pitch.place(&self.pair, at).eased(&relief);
                eased.balance(pitch.force).displacement
            };
            let even: Vec<f64> = (0..PLACES).map(|at| ahead(at * BETWEEN)).collect();
            let opposite: Vec<f64> = even.iter().map(|ahead| -ahead).collect();
            greatest(&even, &ahead) + greatest(&opposite, &|at| -ahead(at))
        })
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
    pub(super) fn overlap_under(&self, reliefs: &TipReliefs, times: f64) -> Result<f64, Refusal> {
        let most = reliefs.amounts[0] + reliefs.amounts[1] + 2.0 * self.tolerance;
        Ok(self.overlap_of(reliefs, &self.pair.corners(most, times)?))
    }

    fn overlap_of(&self, reliefs: &TipReliefs, corners: &Corners) -> f64 {
        let overlaps = tolerances(self.tolerance).into_iter().map(|off| {
            let relief = self.relief(reliefs, off);
            let leads = corners.places.iter();
            let leads = leads.map(|place| place.eased(&relief).lead(0, corners.force));
            leads.fold(f64::NEG_INFINITY, f64::max)
        });
        overlaps.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The reliefs of the pair with other tip reliefs and their deviations.
    fn relief(&self, tips: &TipReliefs, off: [f64; 2]) -> Relief {
        let mut all = Reliefs { shape: tips.shape, ..self.pair.inputs.reliefs() };
        for (at, gear) in [&mut all.driver, &mut all.driven].into_iter().enumerate() {
            gear.tip = (tips.amounts[at] + off[at]).max(0.0);
            gear.tip_length = Some(tips.lengths[at]);
        }
        Relief::of(&all, &self.pair.solution.geometry)
    }
}

/// The combinations of deviations of both reliefs.
pub(super) fn tolerances(tolerance: f64) -> Vec<[f64; 2]> {
    let both = [-tolerance, tolerance];
    let ends = &both[..if tolerance > 0.0 { 2 } else { 1 }];
    let pairs = ends.iter().flat_map(|&one| ends.iter().map(move |&other| [one, other]));
    pairs.collect()
}

impl Pitch {
    fn place(&self, pair: &BarePair, at: usize) -> &Place {
        let at = at % self.places.len();
        self.places[at].get_or_init(|| {
            let part = (at as f64 + 0.5) / self.places.len() as f64;
            pair.place(&self.mesh, part * self.mesh.base_pitch)
        })
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
    (0..count).filter(exceeds).map(climbed).fold(even[0], f64::max)
}

impl BarePair<'_> {
    /// The mesh under a force with an error; `most` is the greatest sum of both reliefs, in m.
    fn mesh(&self, load: (f64, f64), most: f64, times: f64) -> Result<Mesh, Refusal> {
        const FURTHER: f64 = 4.0;
        let mut inputs = self.inputs.mesh();
        // The places apply the root reliefs together with the tip reliefs.
        (inputs.reliefs.driver.root, inputs.reliefs.driven.root) = (0.0, 0.0);
        let deviation = &self.solution.deviation;
        let yields = deviation.loaded_deflection() + deviation.equivalent_error.abs();
        let reach = FURTHER * (2.0 * yields + most + self.inputs.reliefs().sum()) * times;
        Mesh::new(&inputs, &self.solution.geometry, load, reach, None)
    }

    /// Places from the ends of the path of contact outwards, denser near the ends, under `times` the
    /// greatest load.
    fn corners(&self, most: f64, times: f64) -> Result<Corners, Refusal> {
        let force = times * self.solution.mesh_force;
        let error = self.solution.deviation.equivalent_error;
        let mesh = self.mesh((force, error), most, times.max(1.0))?;
        let (from, to) = mesh.ends();
        let part = |at: usize| (at as f64 / BEYOND as f64).powi(2);
        let before = (0..=BEYOND).map(|at| part(at) * from);
        let after = (0..=BEYOND).map(|at| mesh.length + part(at) * (to - mesh.length));
        Ok(Corners { force, places: before.chain(after).map(|s| self.place(&mesh, s)).collect() })
    }

    fn place(&self, mesh: &Mesh, s: f64) -> Place {
        let pairs = mesh.pair_set(s, s);
        let all = pairs.pairs().iter();
        let way = |ahead: i32| s + f64::from(ahead) * mesh.base_pitch;
        Place { radii: all.map(|pair| self.radii(mesh, way(pair.ahead))).collect(), pairs }
    }

    /// The radii of curvature of both flanks at the contact of a pair.
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
