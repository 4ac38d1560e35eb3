//! The search over round amounts and lengths.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;

use super::bench::PreparedMesh;
use super::{AMOUNT_STEP, MapPoint, NoRelief, TipReliefs, decimal};
use crate::model::Refusal;
use crate::model::budget::Meter;
use crate::model::inputs::ReliefShape;

/// A relief in whole steps: amounts on driver and driven gear, then lengths.
type Steps = [i32; 4];

/// The kinds of relief in the order of the answer: the shape, the name, and the name if both gears
/// have the same relief.
const KINDS: [(ReliefShape, &str, &str); 2] = [
    (ReliefShape::Linear, "linear", "linear, both alike"),
    (ReliefShape::Parabolic, "parabolic", "parabolic, both alike"),
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

    fn has(&self, steps: Steps) -> bool {
        let within = |steps: i32, least: i32, most: i32| (least..=most).contains(&steps);
        within(steps[0], 0, self.most_amounts[0])
            && within(steps[1], 0, self.most_amounts[1])
            && within(steps[2], self.least_length, self.most_length)
            && within(steps[3], self.least_length, self.most_length)
    }
}

/// The cost of a relief: the transmission error, or the overlap with corner contact. Any overlap
/// costs more than any error.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
enum Cost {
    Error(f64),
    Overlap(f64),
}

pub(super) struct Search<'a> {
    bench: &'a PreparedMesh,
    grid: &'a Grid,
    meter: &'a Meter,
    go_on: &'a dyn Fn(f64) -> bool,
    known: RefCell<HashMap<(bool, Steps), Cost>>,
    tries: Cell<u64>,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        bench: &'a PreparedMesh,
        grid: &'a Grid,
        meter: &'a Meter,
        go_on: &'a dyn Fn(f64) -> bool,
    ) -> Search<'a> {
        Search { bench, grid, meter, go_on, known: RefCell::default(), tries: Cell::default() }
    }

    /// The number of evaluated reliefs.
    pub(super) fn tries(&self) -> u64 {
        self.tries.get()
    }

    /// The best relief of each kind without corner contact.
    ///
    /// # Errors
    /// Returns an error if no kind has such a relief, or if the user stops the search.
    pub(super) fn best_of_each_kind(&self) -> Result<Vec<(&'static str, TipReliefs)>, NoRelief> {
        let (mut own, mut alike) = (Vec::new(), Vec::new());
        for (shape, name, name_alike) in KINDS {
            let best_alike = self.best(shape, true, None)?;
            let best = self.best(shape, false, best_alike)?;
            let named = |name, best: Option<(Steps, Cost)>| {
                best.map(|(steps, _)| (name, self.grid.reliefs(shape, steps)))
            };
            own.extend(named(name, best));
            alike.extend(named(name_alike, best_alike));
        }
        own.append(&mut alike);
        if own.is_empty() {
            return Err(self.none());
        }
        Ok(own)
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
        start: Option<(Steps, Cost)>,
    ) -> Result<Option<(Steps, Cost)>, NoRelief> {
        let mut starts = self.starts(shape, is_alike)?;
        starts
            .sort_by(|one, other| one.1.partial_cmp(&other.1).unwrap_or(std::cmp::Ordering::Equal));
        starts.truncate(FOLLOWED[usize::from(is_alike)]);
        let mut best: Option<(Steps, Cost)> = None;
        for start in starts.into_iter().chain(start) {
            let found = self.followed(shape, is_alike, start)?;
            if best.is_none_or(|best| found.1 < best.1) {
                best = Some(found);
            }
        }
        Ok(best.filter(|(_, cost)| matches!(cost, Cost::Error(_))))
    }

    /// Reliefs of several lengths with the least amounts without corner contact, and with greater
    /// amounts.
    fn starts(&self, shape: ReliefShape, is_alike: bool) -> Result<Vec<(Steps, Cost)>, NoRelief> {
        let grid = self.grid;
        let (least, most) = (f64::from(grid.least_length), f64::from(grid.most_length));
        let length = |part: f64| (part * most).round().max(least) as i32;
        let parts: Vec<f64> = if is_alike {
            let part = |at: u32| f64::from(at) / f64::from(PARTS_ALIKE);
            (1..=PARTS_ALIKE).map(part).collect()
        } else {
            PARTS.to_vec()
        };
        let mut starts: Vec<(Steps, Cost)> = Vec::new();
        for &one in &parts {
            for &other in &parts {
                if is_alike && one.to_bits() != other.to_bits() {
                    continue;
                }
                let lengths = [length(one), length(other)];
                let clears = self.least_clear(shape, lengths)?;
                for times in TIMES {
                    let amount = (f64::from(clears) * times).round() as i32;
                    let steps = [
                        amount.min(grid.most_amounts[0]),
                        amount.min(grid.most_amounts[1]),
                        lengths[0],
                        lengths[1],
                    ];
                    if starts.iter().all(|(known, _)| *known != steps) {
                        starts.push((steps, self.cost(shape, steps)?));
                    }
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
        let most = self.grid.most_amounts;
        let clears = |amount: i32| {
            let steps = [amount.min(most[0]), amount.min(most[1]), lengths[0], lengths[1]];
            Ok::<bool, NoRelief>(matches!(self.cost(shape, steps)?, Cost::Error(_)))
        };
        let greatest = most[0].max(most[1]);
        let stride = (greatest / STRIDES).max(1);
        let (mut low, mut high) = (-1, 0);
        while !clears(high)? {
            if high >= greatest {
                return Ok(greatest);
            }
            (low, high) = (high, (high + stride).min(greatest));
        }
        while high - low > 1 {
            let middle = i32::midpoint(low, high);
            if clears(middle)? {
                high = middle;
            } else {
                low = middle;
            }
        }
        Ok(high)
    }

    /// The best relief that steps in every direction find from a start, long steps first.
    fn followed(
        &self,
        shape: ReliefShape,
        is_alike: bool,
        start: (Steps, Cost),
    ) -> Result<(Steps, Cost), NoRelief> {
        let directions = directions(is_alike);
        let (mut at, mut cost) = start;
        let mut stride = STRIDE;
        while stride > 0 {
            let mut better = None;
            for direction in &directions {
                let next: Steps = std::array::from_fn(|axis| at[axis] + stride * direction[axis]);
                if !self.grid.has(next) {
                    continue;
                }
                let found = self.cost(shape, next)?;
                if found < better.map_or(cost, |(_, best)| best) {
                    better = Some((next, found));
                }
            }
            match better {
                Some(found) => (at, cost) = found,
                None => stride /= 2,
            }
        }
        Ok((at, cost))
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
            return Ok(Cost::Overlap(f64::INFINITY));
        }
        self.tries.set(self.tries.get() + 1);
        let (reliefs, [errors, corners]) = (self.grid.reliefs(shape, steps), self.bench.costs());
        self.meter.spend(corners);
        let overlap = self.bench.overlap(&reliefs);
        let cost = if overlap > 0.0 {
            Cost::Overlap(overlap)
        } else {
            self.meter.spend(errors);
            Cost::Error(self.error(&reliefs))
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
    let of = |index: i32| {
        let digit = |place: u32| index / 3i32.pow(place) % 3 - 1;
        [digit(0), digit(1), digit(2), digit(3)]
    };
    let is_wanted = |steps: &Steps| {
        let is_same = steps[0] == steps[1] && steps[2] == steps[3];
        *steps != [0; 4] && (!is_alike || is_same)
    };
    (0..81).map(of).filter(is_wanted).collect()
}
