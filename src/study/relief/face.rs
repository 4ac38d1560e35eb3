//! The search over slices: tip relief and crowning together, by whole solves on a grid that becomes
//! finer.

use std::collections::HashMap;

use super::refused::Conditions;
use super::search::{KINDS, LEAST};
use super::{Criterion, MOST_AMOUNT, NoRelief, SEARCH, TipReliefs, WholeSolves, decimal, loaded};
use crate::model::inputs::ReliefShape;
use crate::model::{Inputs, Outcome, Quantity};
use crate::study::batch::{Batch, Control, PointOutcome, Points, Row, Writer, solve_all};

/// Amount on both gears, length and crowning in steps: the axes of the search.
type Place = [i32; 3];

/// The first amounts, relative to the deflection and deviation at the greatest load.
const AMOUNTS: [f64; 6] = [0.4, 0.7, 1.0, 1.4, 2.0, 3.0];
/// The first lengths, relative to the longest.
const LENGTHS: [f64; 3] = [0.4, 0.7, 1.0];
/// The first crownings, relative to the misalignment with its deviation.
const CROWNINGS: [f64; 3] = [0.0, 0.5, 1.0];
/// The directions of the search.
const DIRECTIONS: [Place; 5] = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0], [1, 0, -1]];
/// Progress by a step of the search.
const STEP: f64 = 0.01;
/// Least strides.
const LAST: Place = [2, 2, 2];
/// Greatest crowning, in steps.
const MOST_CROWNING: i32 = 200;

/// Solves of the pair: reliefs, part of the load, misalignment in m.
struct Trials<'a> {
    inputs: &'a Inputs,
    all: Vec<(TipReliefs, f64, f64)>,
}

impl Points for Trials<'_> {
    fn count(&self) -> usize {
        self.all.len()
    }

    fn writer(&self) -> Writer<'_> {
        Box::new(|index, inputs| {
            let (reliefs, load, misalignment) = self.all[index];
            *inputs = Inputs { misalignment, ..reliefs.of(&loaded(self.inputs, load)) };
            Ok(())
        })
    }
}

struct Search<'a> {
    pair: &'a WholeSolves<'a>,
    shape: ReliefShape,
    /// The costs of the evaluated places.
    known: HashMap<Place, f64>,
    /// The least amount without corner contact.
    least: Option<Place>,
}

/// Reliefs with their names.
type Named = Vec<(&'static str, TipReliefs)>;

/// The best relief of each shape with its crowning, then the one with the least amounts; and the
/// number of evaluated reliefs.
///
/// # Errors
/// [`NoRelief::Beyond`] if no relief prevents corner contact, [`NoRelief::Refused`] if the user stops.
pub(super) fn search(pair: &WholeSolves<'_>) -> Result<(Named, u64), NoRelief> {
    let (mut found, mut least, mut tries) = (Vec::new(), Vec::new(), 0);
    pair.part.set(0.0);
    for (shape, [_, name]) in KINDS {
        let mut search = Search { pair, shape, known: HashMap::new(), least: None };
        if let Some(best) = search.best()? {
            found.push((name, search.reliefs(best)));
        }
        least.extend(search.least.map(|place| (LEAST, search.reliefs(place))));
        tries += search.known.len() as u64;
    }
    let removed = |(_, reliefs): &(_, TipReliefs)| reliefs.removed();
    found.extend(least.into_iter().min_by(|one, other| removed(one).total_cmp(&removed(other))));
    if found.is_empty() {
        let [one, other] = pair.grid.most_amounts;
        let steps = [one, other, pair.grid.most_length, pair.grid.most_length];
        let most = pair.grid.reliefs(ReliefShape::Linear, steps);
        let overlap = (-pair.worst(&most)?.gap).max(0.0);
        return Err(NoRelief::Beyond {
            of: Conditions::of(pair.demand, pair.grid.longest()),
            most: pair.grid.amount_step * f64::from(one.max(other)),
            overlap,
        });
    }
    Ok((found, tries))
}

impl Search<'_> {
    /// The best place: that of a coarse grid, then by steps that are halved where none is better.
    fn best(&mut self) -> Result<Option<Place>, NoRelief> {
        let (grid, inputs) = (self.pair.grid, self.pair.inputs);
        let needed = grid.needed / grid.amount_step;
        let tilt = inputs.misalignment.abs() + self.pair.demand.misalignment;
        let crownings = CROWNINGS.map(|part| {
            let crowning = part * tilt.max(inputs.driver.crowning);
            (crowning / grid.amount_step).round() as i32
        });
        let places = AMOUNTS.iter().flat_map(|amount| {
            LENGTHS.iter().flat_map(move |length| {
                crownings.map(|crowning| {
                    let length = length * f64::from(grid.most_length);
                    [(amount * needed).round() as i32, length.round() as i32, crowning]
                })
            })
        });
        let mut places: Vec<Place> = places.map(|place| self.inside(place)).collect();
        places.sort_unstable();
        places.dedup();
        self.evaluate(&places)?;
        self.lower((needed / 5.0) as i32)?;
        let most = self.least.map_or(i32::MAX, |least| (MOST_AMOUNT * f64::from(least[0])) as i32);
        places.retain(|place| place[0] <= most);
        let mut best = self.cheapest(&places);
        let crowning = (f64::from(crownings[1]) / 2.0).max(2.0);
        let mut strides = [needed / 5.0, f64::from(grid.most_length) / 8.0, crowning]
            .map(|stride| (stride.round() as i32).max(LAST[0]));
        while best.1.is_finite() {
            let around = DIRECTIONS.iter().flat_map(|by| [1, -1].map(|sign| (by, sign)));
            let around = around.map(|(by, sign)| {
                self.inside([0, 1, 2].map(|axis| best.0[axis] + sign * by[axis] * strides[axis]))
            });
            let around: Vec<Place> = around.filter(|place| place[0] <= most).collect();
            self.evaluate(&around)?;
            let next = self.cheapest(&around);
            if next.1 < best.1 {
                best = next;
            } else if strides == LAST {
                return Ok(Some(best.0));
            } else {
                strides = strides.map(|stride| (stride / 2).max(LAST[0]));
            }
        }
        Ok(None)
    }

    /// Lowers the least amount without corner contact by steps that are halved.
    fn lower(&mut self, mut stride: i32) -> Result<(), NoRelief> {
        while stride >= LAST[0] {
            let Some([amount, length, crowning]) = self.least else { break };
            let place = self.inside([amount - stride, length, crowning]);
            self.evaluate(&[place])?;
            if self.least != Some(place) {
                stride /= 2;
            }
        }
        Ok(())
    }

    /// The nearest place of the grid.
    fn inside(&self, [amount, length, crowning]: Place) -> Place {
        let grid = self.pair.grid;
        let most = grid.most_amounts[0].max(grid.most_amounts[1]);
        [
            amount.clamp(0, most),
            length.clamp(grid.least_length, grid.most_length),
            crowning.clamp(0, MOST_CROWNING),
        ]
    }

    fn reliefs(&self, [amount, length, crowning]: Place) -> TipReliefs {
        let grid = self.pair.grid;
        TipReliefs {
            crowning: decimal(grid.amount_step * f64::from(crowning)),
            ..grid.reliefs(self.shape, grid.equal(amount, [length; 2]))
        }
    }

    fn cheapest(&self, places: &[Place]) -> (Place, f64) {
        let all = places.iter().map(|place| (*place, self.known[place]));
        all.min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or(([0; 3], f64::INFINITY))
    }

    /// Computes the costs of new places: the figure of the criterion at its least favourable
    /// misalignment, infinite with corner contact of the smallest reliefs within the tolerances. For the criterion
    /// `entry` the amount, or the force before E.
    fn evaluate(&mut self, places: &[Place]) -> Result<(), NoRelief> {
        let (pair, demand) = (self.pair, self.pair.demand);
        let mut new: Vec<Place> =
            places.iter().copied().filter(|place| !self.known.contains_key(place)).collect();
        new.sort_unstable();
        new.dedup();
        let (limits, most) = (pair.smallest(), demand.greatest_load());
        let keys = ["static_last_contact_angle", "static_force_at_start", "static_peak_line_load"];
        let rows = self.solved(&keys, &new, &|reliefs| {
            limits.iter().map(|&(off, by)| (reliefs.off(off), most, by)).collect()
        })?;
        let mut clear = Vec::new();
        for (place, rows) in new.into_iter().zip(rows.chunks(limits.len())) {
            let strikes = |row: &Row| {
                row.outcome != PointOutcome::Solved(Outcome::NoCornerContact)
                    || row.values[0].is_some()
            };
            let value = |at: usize| {
                rows.iter().map(|row| row.values[at].unwrap_or(0.0)).fold(0.0, f64::max)
            };
            let is_refused = rows.iter().any(|row| row.refusal.is_some());
            let strikes = rows.iter().any(strikes);
            if !strikes && self.least.is_none_or(|least| place < least) {
                self.least = Some(place);
            }
            let cost = match demand.minimise {
                _ if is_refused => f64::INFINITY,
                // Any force is worse than any amount.
                Criterion::Entry if strikes => 1.0 + value(1),
                Criterion::Entry => {
                    self.reliefs(place).removed() + 0.01 * self.reliefs(place).crowning
                }
                _ if strikes => f64::INFINITY,
                Criterion::Peak => value(2),
                Criterion::Te => {
                    clear.push(place);
                    continue;
                }
            };
            self.known.insert(place, cost);
        }
        let misalignments = pair.misalignments();
        let rows = self.solved(&["static_te_peak_to_peak"], &clear, &|reliefs| {
            let loads = pair.loads.iter();
            let all = loads.flat_map(|&(load, _)| misalignments.iter().map(move |&by| (load, by)));
            all.map(|(load, by)| (reliefs, load, by)).collect()
        })?;
        let each = pair.loads.len() * misalignments.len();
        for (place, rows) in clear.into_iter().zip(rows.chunks(each)) {
            let of_load = rows.chunks(misalignments.len()).map(|rows| {
                let errors = rows.iter().map(|row| row.values[0].unwrap_or(f64::INFINITY));
                errors.fold(0.0, f64::max)
            });
            self.known.insert(place, demand.figure(of_load));
        }
        Ok(())
    }

    /// Solves each place under its conditions; the rows of each place follow each other.
    fn solved(
        &self,
        keys: &[&str],
        places: &[Place],
        conditions: &dyn Fn(TipReliefs) -> Vec<(TipReliefs, f64, f64)>,
    ) -> Result<Vec<Row>, NoRelief> {
        let pair = self.pair;
        pair.part.set((pair.part.get() + STEP).min(SEARCH));
        let all = places.iter().flat_map(|&place| conditions(self.reliefs(place))).collect();
        let trials = Trials { inputs: pair.inputs, all };
        let quantities: Vec<_> = keys.iter().filter_map(|key| Quantity::find(key)).collect();
        let batch = Batch { inputs: pair.inputs, points: &trials, quantities: &quantities };
        let control = Control { jobs: None, go_on: &|_, _| (pair.go_on)(pair.part.get()) };
        let mut found = Vec::with_capacity(trials.count());
        solve_all(&batch, 0..trials.count(), &control, &mut |_, rows| {
            found.extend_from_slice(rows);
            true
        })?;
        Ok(found)
    }
}
