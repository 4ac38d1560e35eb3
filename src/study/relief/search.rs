//! The search over round amounts and lengths on a prepared mesh.

use std::array::from_fn;
use std::cell::OnceCell;
use std::collections::HashMap;

use super::refused::Conditions;
use super::{Criterion, Demand, MOST_AMOUNT, NoRelief, Off, TipReliefs, decimal};
use crate::model::geometry::{Geometry, PairShape, geometry};
use crate::model::inputs::{Gear, ReliefShape};
use crate::model::mesh::Mesh;
use crate::model::pair_forces::PairSet;
use crate::model::position::tip_at;
use crate::model::relief::{Relief, Reliefs};
use crate::model::{Inputs, Refusal, Solution};

/// A relief in whole steps: amounts on driver and driven gear, then lengths.
pub(super) type Steps = [i32; 4];

/// A relief with its cost, which is infinite with corner contact.
type Tried = (Steps, f64);

/// The peak force with a relief, in N.
pub(super) type Peak<'a> = &'a dyn Fn(&TipReliefs) -> Result<f64, NoRelief>;

/// The kinds of relief: the shape, the name, and the name if both gears have the same relief.
pub(super) const KINDS: [(ReliefShape, [&str; 2]); 2] = [
    (ReliefShape::Linear, ["linear", "linear, both alike"]),
    (ReliefShape::Parabolic, ["parabolic", "parabolic, both alike"]),
];
/// The name of the relief that removes no more than corner contact requires.
pub(super) const LEAST: &str = "least amount";
/// The name of the relief with the least overlap, if none prevents corner contact.
const LEAST_OVERLAP: &str = "least overlap";

/// The name of equal reliefs of two kinds: the separate reliefs of both gears are alike, or one of
/// them is the least amount too.
pub(super) fn joined(name: &'static str, other: &'static str) -> &'static str {
    match other {
        LEAST if name.starts_with("linear") => "linear, least amount",
        LEAST => "parabolic, least amount",
        other => other,
    }
}

/// Start lengths are multiples of this part of the longest length if they are the same on both gears.
/// The best length can be one step wide, between lengths that are far worse.
const PARTS: i32 = 40;
/// Start lengths of gears with different lengths, in these parts.
const OWN_PARTS: [i32; 6] = [12, 18, 24, 30, 36, 40];
/// Start amounts, relative to the least amount without corner contact.
const TIMES: [f64; 4] = [1.0, 1.15, 1.4, 1.8];
/// Number of starts that the search follows.
const FOLLOWED: usize = 4;
/// Greatest stride of the search, in steps; it is halved down to one step.
const STRIDE: i32 = 8;
/// The directions of the search: both gears alike along the narrow valley in which a greater amount
/// needs a slightly shorter length, both alike, then one gear or both in opposite directions.
const DIRECTIONS: [[Steps; 4]; 5] = [
    [[2, 2, -1, -1], [4, 4, -1, -1], [8, 8, -1, -1], [16, 16, -1, -1]],
    [[1, 1, 0, 0], [0, 0, 1, 1], [1, 1, 1, 1], [1, 1, -1, -1]],
    [[1, 0, 0, 0], [0, 0, 1, 0], [1, 0, 1, 0], [1, 0, -1, 0]],
    [[0, 1, 0, 0], [0, 0, 0, 1], [0, 1, 0, 1], [0, 1, 0, -1]],
    [[1, -1, 0, 0], [0, 0, 1, -1], [1, -1, 1, -1], [1, -1, -1, 1]],
];
/// Greatest number of reliefs that the search evaluates.
pub(super) const MOST_TRIES: u64 = 200_000;
/// Number of reliefs that a typical search evaluates.
const USUAL_TRIES: f64 = 20_000.0;

/// The steps and bounds of amounts and lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Grid {
    /// Step of an amount, in m.
    pub(super) amount_step: f64,
    /// Step of a length, in m.
    pub(super) length_step: f64,
    /// Least and greatest length, in steps.
    pub(super) least_length: i32,
    pub(super) most_length: i32,
    /// Greatest amounts on driver and driven gear, in steps.
    pub(super) most_amounts: [i32; 2],
    /// Deflection and deviation at the greatest load with the tolerances, in m.
    pub(super) needed: f64,
    /// Greatest amounts that the tips may lose, in m.
    pub(super) tips: [f64; 2],
}

impl Grid {
    /// The greatest length, in m.
    pub(super) fn longest(&self) -> f64 {
        self.length_step * f64::from(self.most_length)
    }

    /// The reliefs with amounts increased by `steps`, if the tips allow it.
    pub(super) fn greater(&self, reliefs: &TipReliefs, steps: i32) -> Option<TipReliefs> {
        let more = |at: usize| {
            let amount = (reliefs.amounts[at] / self.amount_step).round() as i32 + steps;
            (amount <= self.most_amounts[at]).then(|| decimal(self.amount_step * f64::from(amount)))
        };
        Some(TipReliefs { amounts: [more(0)?, more(1)?], ..*reliefs })
    }

    pub(super) fn reliefs(&self, shape: ReliefShape, [one, other, from, to]: Steps) -> TipReliefs {
        TipReliefs {
            shape,
            amounts: [one, other].map(|steps| decimal(self.amount_step * f64::from(steps))),
            lengths: [from, to].map(|steps| decimal(self.length_step * f64::from(steps))),
            crowning: 0.0,
        }
    }

    /// The same amount on both gears, as far as the tips allow it.
    pub(super) fn equal(&self, amount: i32, [one, other]: [i32; 2]) -> Steps {
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

/// A figure of the prepared mesh for a relief.
#[derive(Clone, Copy)]
enum Figure {
    Overlap,
    Error,
}

pub(super) struct Search<'a> {
    bench: &'a Bench<'a>,
    grid: &'a Grid,
    /// The deviations at the limits of the tolerances.
    corners: Vec<Off>,
    /// The corner that last exceeded a bound: the next relief is likely to exceed it there too.
    hardest: usize,
    /// Greatest sum of both amounts, in steps.
    most: i32,
    go_on: &'a dyn Fn(f64) -> bool,
    /// The overlaps and errors of the evaluated reliefs, by shape, amounts and lengths in 0.1 nm.
    known: [HashMap<[i64; 5], f64>; 2],
}

impl<'a> Search<'a> {
    pub(super) fn new(
        bench: &'a Bench<'a>,
        grid: &'a Grid,
        go_on: &'a dyn Fn(f64) -> bool,
    ) -> Search<'a> {
        let corners = bench.demand.corners();
        Search {
            bench,
            grid,
            corners,
            hardest: 0,
            most: i32::MAX,
            go_on,
            known: Default::default(),
        }
    }

    /// The number of evaluated reliefs.
    pub(super) fn tries(&self) -> u64 {
        self.known.iter().map(|known| known.len() as u64).sum()
    }

    /// The best relief of each kind without corner contact, then those with equal gears, and the
    /// least; by the transmission error, and then by the peak force if that is the criterion. If
    /// there is none, the criterion `entry` accepts the relief with the least overlap.
    ///
    /// # Errors
    /// Returns an error if no kind has such a relief, or if the user stops the search.
    pub(super) fn best_of_each_kind(
        &mut self,
        peak: Option<Peak<'_>>,
    ) -> Result<Vec<(&'static str, TipReliefs)>, NoRelief> {
        let (mut found, mut least) = (Vec::new(), None::<((i32, f64), TipReliefs)>);
        for (shape, names) in KINDS {
            let (mut starts, clear) = self.starts(shape)?;
            let least_sum = clear.iter().map(|(steps, _)| steps[0] + steps[1]).min();
            self.most = least_sum.map_or(i32::MAX, |sum| (MOST_AMOUNT * f64::from(sum)) as i32);
            starts.retain(|(steps, _)| steps[0] + steps[1] <= self.most);
            let smallest =
                clear.into_iter().filter(|(steps, _)| Some(steps[0] + steps[1]) == least_sum);
            if let Some((steps, error)) = self.best(shape, &smallest.collect::<Vec<_>>(), &[])? {
                let size = (steps[0] + steps[1], error);
                if least.is_none_or(|(least, _)| size < least) {
                    least = Some((size, self.grid.reliefs(shape, steps)));
                }
            }
            let alike = (1, &DIRECTIONS[..2], &DIRECTIONS[1..2]);
            for (kind, errors, peaks) in [alike, (0, &DIRECTIONS[1..], &DIRECTIONS[1..])] {
                let Some(mut best) = self.best(shape, &starts, errors)? else { continue };
                starts.insert(0, best);
                if let Some(peak) = peak {
                    let cost = |search: &mut Self, steps, _| {
                        let error = search.cost(shape, steps, f64::INFINITY)?;
                        let reliefs = search.grid.reliefs(shape, steps);
                        // The transmission error decides between equal forces.
                        let is_clear = error.is_finite();
                        Ok(if is_clear { peak(&reliefs)? * (1.0 + error) } else { error })
                    };
                    let start = (best.0, cost(self, best.0, f64::INFINITY)?);
                    best = self.followed(start, peaks, STRIDE / 2, &cost)?;
                }
                found.push((kind, names[kind], self.grid.reliefs(shape, best.0)));
            }
        }
        found.extend(least.map(|(_, reliefs)| (2, LEAST, reliefs)));
        if found.is_empty() && self.bench.demand.minimise == Criterion::Entry {
            found.push((2, LEAST_OVERLAP, self.least_overlap()?));
        }
        found.sort_by_key(|&(kind, ..)| kind);
        let found: Vec<_> = found.into_iter().map(|(_, name, reliefs)| (name, reliefs)).collect();
        if found.is_empty() { Err(self.none()) } else { Ok(found) }
    }

    /// The relief of a coarse grid with the least overlap.
    fn least_overlap(&mut self) -> Result<TipReliefs, NoRelief> {
        const PARTS: i32 = 12;
        let Grid { least_length, most_length, most_amounts: [one, other], .. } = *self.grid;
        let mut best = (f64::INFINITY, self.grid.reliefs(ReliefShape::Linear, [0; 4]));
        for (index, (shape, _)) in (0..PARTS * PARTS).flat_map(|at| KINDS.map(|kind| (at, kind))) {
            let (length, amount) = (index / PARTS, 1 + index % PARTS);
            let length = least_length + (most_length - least_length) * length / (PARTS - 1);
            let steps = self.grid.equal(one.max(other) * amount / PARTS, [length; 2]);
            let reliefs = self.grid.reliefs(shape, steps);
            let overlap = self.figure(Figure::Overlap, &reliefs.off(self.corners[0]))?;
            if overlap < best.0 {
                best = (overlap, reliefs);
            }
        }
        Ok(best.1)
    }

    /// Why no relief prevents corner contact.
    fn none(&self) -> NoRelief {
        let Grid { tips, amount_step, most_amounts: [one, other], most_length, .. } = *self.grid;
        let steps = [one, other, most_length, most_length];
        let worst = self.grid.reliefs(ReliefShape::Linear, steps).off(self.corners[0]);
        let overlap = self.bench.overlap(&worst);
        let most = amount_step * f64::from(one.max(other));
        let of = Conditions::of(self.bench.demand, self.grid.longest());
        match (0..2).find(|&at| tips[at] < most + amount_step) {
            Some(at) => {
                let gear = ["driver", "driven"][at];
                NoRelief::ThinTip { of, gear, most: tips[at], overlap }
            }
            None => NoRelief::Beyond { of, most, overlap },
        }
    }

    /// The best relief that the search finds from the best of the starts.
    fn best(
        &mut self,
        shape: ReliefShape,
        starts: &[Tried],
        directions: &[[Steps; 4]],
    ) -> Result<Option<Tried>, NoRelief> {
        let mut best: Option<Tried> = None;
        // Steps with both gears alike keep their lengths alike.
        let is_free = directions.len() > 2;
        let starts = starts.iter().filter(|(steps, _)| is_free || steps[2] == steps[3]);
        let count = if directions.is_empty() { usize::MAX } else { FOLLOWED };
        for &(steps, _) in starts.take(count) {
            let start = (steps, self.cost(shape, steps, f64::INFINITY)?);
            let cost = |search: &mut Self, steps, bound| search.cost(shape, steps, bound);
            let found = self.followed(start, directions, STRIDE, &cost)?;
            if found.1 < best.map_or(f64::INFINITY, |best| best.1) {
                best = Some(found);
            }
        }
        Ok(best)
    }

    /// Reliefs of several lengths with the least amounts without corner contact and with greater
    /// amounts, those with the least nominal error first; and those with the least amounts alone.
    fn starts(&mut self, shape: ReliefShape) -> Result<(Vec<Tried>, Vec<Tried>), NoRelief> {
        let grid = self.grid;
        let (mut starts, mut least): (Vec<Tried>, Vec<Tried>) = (Vec::new(), Vec::new());
        let own = OWN_PARTS.iter().flat_map(|one| OWN_PARTS.map(|other| [*one, other]));
        let own = own.filter(|[one, other]| one != other);
        for parts in (1..=PARTS).map(|part| [part; 2]).chain(own) {
            let lengths =
                parts.map(|part| (part * grid.most_length / PARTS).max(grid.least_length));
            let Some(clears) = self.least_clear(shape, lengths)? else { continue };
            for times in TIMES {
                let steps = grid.equal((f64::from(clears) * times).round() as i32, lengths);
                let error = self.figure(Figure::Error, &grid.reliefs(shape, steps))?;
                starts.push((steps, error));
            }
            least.push(starts[starts.len() - TIMES.len()]);
        }
        starts.sort_by(|one, other| one.1.total_cmp(&other.1));
        starts.dedup();
        Ok((starts, least))
    }

    /// The least amount, the same on both gears, without overlap. Amounts are tried in rising
    /// order: a very large relief shifts load to the pair ahead, whose deflection causes an overlap
    /// again.
    fn least_clear(
        &mut self,
        shape: ReliefShape,
        lengths: [i32; 2],
    ) -> Result<Option<i32>, NoRelief> {
        const STRIDES: i32 = 24;
        let grid = self.grid;
        let [one, other] = grid.most_amounts;
        let greatest = one.max(other);
        let stride = (greatest / STRIDES).max(1);
        let (mut low, mut high) = (-1, 0);
        while !self.clears(shape, grid.equal(high, lengths))? {
            if high >= greatest {
                return Ok(None);
            }
            (low, high) = (high, (high + stride).min(greatest));
        }
        while high - low > 1 {
            let middle = i32::midpoint(low, high);
            if self.clears(shape, grid.equal(middle, lengths))? {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok(Some(high))
    }

    /// The best relief that steps in every direction find from a start, long steps first. `cost`
    /// may return any cost above the bound for a relief that exceeds it.
    fn followed(
        &mut self,
        start: Tried,
        directions: &[[Steps; 4]],
        longest: i32,
        cost: &dyn Fn(&mut Self, Steps, f64) -> Result<f64, NoRelief>,
    ) -> Result<Tried, NoRelief> {
        let (mut best, mut stride) = (start, longest);
        while stride > 0 {
            let (at, before) = best;
            for direction in directions.iter().flatten() {
                for by in [stride, -stride] {
                    let next: Steps = from_fn(|axis| at[axis] + by * direction[axis]);
                    if self.grid.has(next) && next[0] + next[1] <= self.most {
                        let cost = cost(self, next, best.1)?;
                        if cost < best.1 {
                            best = (next, cost);
                        }
                    }
                }
            }
            if best.1.total_cmp(&before).is_eq() {
                stride /= 2;
            }
        }
        Ok(best)
    }

    /// Whether no tip touches off the path of contact at any limit of the tolerances.
    fn clears(&mut self, shape: ReliefShape, steps: Steps) -> Result<bool, NoRelief> {
        let reliefs = self.grid.reliefs(shape, steps);
        for at in 0..self.corners.len() {
            if self.figure(Figure::Overlap, &reliefs.off(self.corners[at]))? > 0.0 {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The greatest error within the tolerances, or a cost above the bound.
    fn cost(&mut self, shape: ReliefShape, steps: Steps, bound: f64) -> Result<f64, NoRelief> {
        let reliefs = self.grid.reliefs(shape, steps);
        let mut worst = self.figure(Figure::Error, &reliefs)?;
        if worst > bound || !self.clears(shape, steps)? {
            return Ok(f64::INFINITY);
        }
        for at in std::iter::once(self.hardest).chain(0..self.corners.len()) {
            worst = worst.max(self.figure(Figure::Error, &reliefs.off(self.corners[at]))?);
            if worst > bound {
                self.hardest = at;
                return Ok(f64::INFINITY);
            }
        }
        Ok(worst)
    }

    /// A figure, computed once for each relief; infinite after the last try.
    fn figure(&mut self, of: Figure, reliefs: &TipReliefs) -> Result<f64, NoRelief> {
        let TipReliefs { shape, amounts: [one, other], lengths: [from, to], .. } = *reliefs;
        let [one, other, from, to] =
            [one, other, from, to].map(|length| (length * 1e10).round() as i64);
        let key = [i64::from(shape == ReliefShape::Linear), one, other, from, to];
        if let Some(&known) = self.known[of as usize].get(&key) {
            return Ok(known);
        }
        if !(self.go_on)(super::SEARCH * (self.tries() as f64 / USUAL_TRIES).min(1.0)) {
            return Err(NoRelief::Refused(Refusal::Stopped));
        }
        if self.tries() >= MOST_TRIES {
            return Ok(f64::INFINITY);
        }
        let found = match of {
            Figure::Overlap => self.bench.overlap(reliefs),
            Figure::Error => self.bench.error(reliefs),
        };
        self.known[of as usize].insert(key, found);
        Ok(found)
    }
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

/// A pair without tip reliefs, prepared at the loads of a demand.
pub(super) struct Bench<'a> {
    inputs: Inputs,
    /// The solution at the greatest load.
    pub(super) solution: &'a Solution,
    pub(super) demand: &'a Demand,
    /// The geometry with the gears exchanged.
    swapped: Geometry,
    loads: Vec<Pitch>,
    corners: Corners,
}

impl<'a> Bench<'a> {
    /// The mesh of a pair with its solution at the greatest load; the grid has the greatest reliefs.
    ///
    /// # Errors
    /// Refusals of the mesh.
    pub(super) fn new(
        inputs: &Inputs,
        solution: &'a Solution,
        demand: &'a Demand,
        grid: &Grid,
    ) -> Result<Bench<'a>, Refusal> {
        let [driver, driven] = grid.most_amounts;
        let own = inputs.driver.tip_relief + inputs.driven.tip_relief;
        let most = own.max(grid.amount_step * f64::from(driver + driven)) + 2.0 * demand.tolerance;
        let bare = |gear: &Gear| Gear { tip_relief: 0.0, ..*gear };
        let (driver, driven) = (bare(&inputs.driver), bare(&inputs.driven));
        let inputs = Inputs { driver, driven, ..inputs.clone() };
        let shape = inputs.shape();
        let swapped = geometry(&PairShape { driver: shape.driven, driven: shape.driver, ..shape })?;
        let (loads, corners) = (Vec::new(), Corners { force: 0.0, places: Vec::new() });
        let mut bench = Bench { inputs, solution, demand, swapped, loads, corners };
        let unit = solution.mesh_force / demand.greatest_load();
        let pitch = |(load, _): (f64, f64)| {
            let (force, places) = (load * unit, vec![OnceCell::new(); PLACES * BETWEEN]);
            Ok(Pitch { force, mesh: bench.mesh((force, 0.0), most, 1.0)?, places })
        };
        bench.loads = demand.loads().into_iter().map(pitch).collect::<Result<_, Refusal>>()?;
        bench.corners = bench.corners(most, 1.0)?;
        Ok(bench)
    }

    /// The figure of the demand over the peak-to-peak transmission errors at its loads, in m.
    pub(super) fn error(&self, reliefs: &TipReliefs) -> f64 {
        let relief = self.relief(reliefs);
        self.demand.figure(self.loads.iter().map(|pitch| {
            let ahead = |at: usize| {
                let eased = self.at(pitch, at).eased(&relief);
                eased.balance(pitch.force).displacement
            };
            let even: Vec<f64> = (0..PLACES).map(|at| ahead(at * BETWEEN)).collect();
            let opposite: Vec<f64> = even.iter().map(|ahead| -ahead).collect();
            greatest(&even, &ahead) + greatest(&opposite, &|at| -ahead(at))
        }))
    }

    /// Overlap of the teeth before E or after B at the greatest load, in m; below 0 the gap that
    /// remains.
    pub(super) fn overlap(&self, reliefs: &TipReliefs) -> f64 {
        self.overlap_at(reliefs, &self.corners)
    }

    /// The overlap under `times` the force with the least favourable tolerance, in m.
    ///
    /// # Errors
    /// Refusals of the mesh.
    pub(super) fn overlap_under(&self, reliefs: &TipReliefs, times: f64) -> Result<f64, Refusal> {
        let most = reliefs.removed() + 2.0 * self.demand.tolerance;
        Ok(self.worst_at(reliefs, &self.corners(most, times)?))
    }

    /// The overlap at the greatest load with the least favourable tolerance, in m.
    pub(super) fn worst_overlap(&self, reliefs: &TipReliefs) -> f64 {
        self.worst_at(reliefs, &self.corners)
    }

    fn worst_at(&self, reliefs: &TipReliefs, corners: &Corners) -> f64 {
        let all = self.demand.corners().into_iter();
        let all = all.map(|off| self.overlap_at(&reliefs.off(off), corners));
        all.fold(f64::NEG_INFINITY, f64::max)
    }

    fn overlap_at(&self, reliefs: &TipReliefs, corners: &Corners) -> f64 {
        let relief = self.relief(reliefs);
        let leads = corners.places.iter();
        let leads = leads.map(|place| place.eased(&relief).lead(0, corners.force));
        leads.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The reliefs of the pair with other tip reliefs.
    fn relief(&self, tips: &TipReliefs) -> Relief {
        let mut all = Reliefs { shape: tips.shape, ..self.inputs.reliefs() };
        for (at, gear) in [&mut all.driver, &mut all.driven].into_iter().enumerate() {
            gear.tip = tips.amounts[at];
            gear.tip_length = Some(tips.lengths[at]);
        }
        Relief::of(&all, &self.solution.geometry)
    }

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

    fn at<'p>(&self, pitch: &'p Pitch, at: usize) -> &'p Place {
        let at = at % pitch.places.len();
        pitch.places[at].get_or_init(|| {
            let part = (at as f64 + 0.5) / pitch.places.len() as f64;
            self.place(&pitch.mesh, part * pitch.mesh.base_pitch)
        })
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
