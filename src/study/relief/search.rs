//! The search over round amounts and lengths.

use std::cell::{Cell, OnceCell, RefCell};
use std::collections::HashMap;

use super::{AMOUNT_STEP, Demand, MapPoint, NoRelief, TipReliefs, decimal};
use crate::model::budget::Meter;
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
    /// Sum of both greatest amounts, in m.
    pub(super) fn most_relief(&self) -> f64 {
        AMOUNT_STEP * f64::from(self.most_amounts[0] + self.most_amounts[1])
    }

    /// The greatest amount of either gear, in m.
    fn most_amount(&self) -> f64 {
        AMOUNT_STEP * f64::from(self.most_amounts[0].max(self.most_amounts[1]))
    }

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

    fn has(&self, steps: Steps) -> bool {
        let lengths = self.least_length..=self.most_length;
        let has_amount = |at: usize| (0..=self.most_amounts[at]).contains(&steps[at]);
        has_amount(0) && has_amount(1) && lengths.contains(&steps[2]) && lengths.contains(&steps[3])
    }
}

/// The cost of a relief: whether it has corner contact, then the overlap, otherwise the transmission
/// error. Any overlap costs more than any error.
type Cost = (bool, f64);

/// A relief with its cost.
type Tried = (Steps, Cost);

pub(super) struct Search<'a> {
    pub(super) bench: &'a PreparedMesh,
    pub(super) grid: &'a Grid,
    pub(super) meter: &'a Meter,
    pub(super) go_on: &'a dyn Fn(f64) -> bool,
    pub(super) known: RefCell<HashMap<(bool, Steps), Cost>>,
    /// The number of evaluated reliefs.
    pub(super) tries: Cell<u64>,
}

impl Search<'_> {
    /// The best relief of each kind without corner contact, those with equal gears last.
    ///
    /// # Errors
    /// Returns an error if no kind has such a relief, or if the user stops the search.
    pub(super) fn best_of_each_kind(&self) -> Result<Vec<(&'static str, TipReliefs)>, NoRelief> {
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
        let grid = self.grid;
        let [one, other] = grid.most_amounts;
        let most = [one, other, grid.most_length, grid.most_length];
        let overlap = self.bench.overlap(&grid.reliefs(ReliefShape::Linear, most));
        let thin = (0..2).find(|&at| grid.tips[at] < grid.most_amount() + AMOUNT_STEP);
        match thin {
            Some(at) => {
                NoRelief::ThinTip { gear: ["driver", "driven"][at], most: grid.tips[at], overlap }
            }
            None => NoRelief::Beyond { most: grid.most_amount(), overlap },
        }
    }

    /// The best relief of a kind; the search also follows `start`.
    fn best(
        &self,
        shape: ReliefShape,
        is_alike: bool,
        start: Option<Tried>,
    ) -> Result<Option<Tried>, NoRelief> {
        let by_cost = |one: &Tried, other: &Tried| {
            one.1.partial_cmp(&other.1).unwrap_or(std::cmp::Ordering::Equal)
        };
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
    fn starts(&self, shape: ReliefShape, is_alike: bool) -> Result<Vec<Tried>, NoRelief> {
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
    fn least_clear(&self, shape: ReliefShape, lengths: [i32; 2]) -> Result<i32, NoRelief> {
        const STRIDES: i32 = 24;
        let overlaps = |amount: i32| {
            let (overlaps, _) = self.cost(shape, self.grid.equal(amount, lengths))?;
            Ok::<bool, NoRelief>(overlaps)
        };
        let [one, other] = self.grid.most_amounts;
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
        &self,
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

    /// The cost of a relief. Once the budget is spent, a relief that is not cached costs an
    /// infinite overlap.
    fn cost(&self, shape: ReliefShape, steps: Steps) -> Result<Cost, NoRelief> {
        let key = (shape == ReliefShape::Linear, steps);
        if let Some(&known) = self.known.borrow().get(&key) {
            return Ok(known);
        }
        if !(self.go_on)(self.meter.spent() as f64 / self.meter.limit() as f64) {
            return Err(NoRelief::Refused(Refusal::Stopped));
        }
        if !self.meter.spend(0) {
            return Ok((true, f64::INFINITY));
        }
        self.tries.set(self.tries.get() + 1);
        let (reliefs, [errors, corners]) = (self.grid.reliefs(shape, steps), self.bench.costs);
        self.meter.spend(corners);
        let overlap = self.bench.overlap(&reliefs);
        let cost = if overlap > 0.0 {
            (true, overlap)
        } else {
            self.meter.spend(errors);
            (false, self.error(&reliefs))
        };
        self.known.borrow_mut().insert(key, cost);
        Ok(cost)
    }

    /// The greatest transmission error over the loads, plus a thousandth of the mean, which decides
    /// between equal errors.
    fn error(&self, reliefs: &TipReliefs) -> f64 {
        const MEAN: f64 = 1e-3;
        let errors: Vec<f64> = self.bench.errors(reliefs).collect();
        let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        errors.into_iter().fold(0.0, f64::max) + MEAN * mean
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
        let row = |part: f64| {
            let scale = part * longest / greatest;
            let point = |times: f64| {
                let at = TipReliefs {
                    shape: reliefs.shape,
                    amounts: reliefs.amounts.map(|amount| times * amount),
                    lengths: reliefs.lengths.map(|length| scale * length),
                };
                MapPoint {
                    reliefs: at,
                    error: self.bench.errors(&at).fold(0.0, f64::max),
                    margin: -self.bench.overlap(&at),
                }
            };
            AMOUNTS.into_iter().map(point).collect()
        };
        let own = greatest / longest;
        let mut parts = LENGTHS.to_vec();
        parts.retain(|part| (part - own).abs() > CLOSE);
        parts.push(own);
        parts.sort_by(f64::total_cmp);
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
        Ok(PreparedMesh {
            geometry: solution.geometry,
            reliefs: bare.reliefs(),
            tolerance: demand.tolerance,
            costs: [
                loads.iter().map(Pitch::cost).sum(),
                tolerances(demand.tolerance).len() as u64 * pairs.sum::<u64>(),
            ],
            loads,
            corners,
        })
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
        Mesh::new(&inputs, &self.solution.geometry, (force, error), self.reach, None)
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
