//! The tip relief to specify: amounts and lengths on both gears without corner contact at the
//! greatest load and with the least transmission error over the loads.

mod bench;
pub mod demand;
mod figures;
mod refusal;
mod search;

use std::cell::Cell;

use crate::model::budget::Meter;
use crate::model::geometry::Geometry;
use crate::model::inputs::{Drive, Method, ReliefShape};
use crate::model::profile::{Profile, Rack};
use crate::model::{Inputs, Solution, Stage, Stages, solve, solve_while};
use bench::PreparedMesh;
pub use refusal::NoRelief;
use search::{Grid, Search};

/// Step of an amount, in m: half a micrometre.
pub const AMOUNT_STEP: f64 = 0.5e-6;

/// The greatest load at which corner contact is looked for, relative to the greatest load of the
/// demand.
pub const MOST_LOAD: f64 = 64.0;

/// Number of loads at which the transmission error is computed.
const LOADS: usize = 6;

/// Budget of the search, in evaluations of a pair at a place.
const WORK: u64 = 80_000_000;
/// Fraction of the budget that a typical search uses.
const USUAL_WORK: f64 = 0.25;
/// Fraction of the progress that the search makes up; whole solves make up the rest.
const SEARCH: f64 = 0.5;

/// Load range and tolerance that a relief must satisfy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Least and greatest load, relative to the load of the case.
    pub loads: (f64, f64),
    /// Deviation of each relief in both directions, in m.
    pub tolerance: f64,
}

/// The tip reliefs of both gears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipReliefs {
    /// Shape of the relief along the path of contact.
    pub shape: ReliefShape,
    /// Amounts on driver and driven gear, in m.
    pub amounts: [f64; 2],
    /// Lengths along the path of contact, in m.
    pub lengths: [f64; 2],
}

/// Reliefs with their transmission errors and gaps.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Short name.
    pub name: &'static str,
    /// The reliefs.
    pub reliefs: TipReliefs,
    /// Peak-to-peak transmission error at each load, in m.
    pub errors: Vec<f64>,
    /// The gap that remains before E and after B at the greatest load with the least favourable
    /// tolerance, in m; below 0 the overlap.
    pub margin: f64,
}

impl Demand {
    /// Loads from 25 % to 110 % of the load of the case, tolerance 5 um.
    pub const USUAL: Demand = Demand { loads: (0.25, 1.1), tolerance: 5e-6 };
}

impl Choice {
    /// The greatest transmission error over the loads, in m.
    #[must_use]
    pub fn greatest_error(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// The mean transmission error over the loads, in m.
    #[must_use]
    pub fn mean_error(&self) -> f64 {
        self.errors.iter().sum::<f64>() / self.errors.len().max(1) as f64
    }
}

/// A point of the map over amount and length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// The reliefs.
    pub reliefs: TipReliefs,
    /// Greatest peak-to-peak transmission error over the loads, in m.
    pub error: f64,
    /// The remaining gap, in m.
    pub margin: f64,
}

/// The relief to specify.
#[derive(Debug, Clone, PartialEq)]
pub struct Specification {
    /// The method that finds no corner contact with the specified relief.
    pub method: Method,
    /// The demand of the specification.
    pub demand: Demand,
    /// Torque on the driver at load 1, in N m.
    pub torque: f64,
    /// The loads, relative to the load of the case.
    pub loads: Vec<f64>,
    /// The reliefs of the case, then the best relief of each kind; [`Specification::best`] is one
    /// of them.
    pub choices: Vec<Choice>,
    /// Index of the choice to specify.
    pub best: usize,
    /// The greatest load without corner contact at rest, relative to the load of the case. `None`
    /// if [`MOST_LOAD`] times the greatest load of the demand has no corner contact. The motion is
    /// checked only at the greatest load of the demand.
    pub greatest_load: Option<f64>,
    /// Path of contact on unrelieved flanks over the base pitch: the contact ratio without load.
    pub unloaded_contact_ratio: f64,
    /// One row per length, shortest first; one point per amount.
    pub map: Vec<Vec<MapPoint>>,
    /// Number of reliefs that the search evaluated.
    pub tries: u64,
    /// Whether the budget ended the search early.
    pub is_cut: bool,
}

impl Specification {
    /// The choice to specify.
    #[must_use]
    pub fn chosen(&self) -> &Choice {
        &self.choices[self.best]
    }
}

/// The relief to specify for a pair.
///
/// # Formula
/// ```text
/// least over C1, L1, C2, L2, shape of  max over the loads of (max x − min x)
/// with x + e − S <= 0 before E and after B at the greatest load, for each C ± the tolerance
/// ```
/// x is the transmission error of the static balance. If the method of the case is `dynamic`, the
/// amounts grow until the motion has no corner contact either.
///
/// # Source
/// Harris maps of the transmission error over the load: Harris 1958; long and short relief: Munro,
/// Morrish & Palmer 1999. Reliefs that prevent corner contact:
/// [`clearing`](crate::model::clearing).
///
/// # Errors
/// [`NoRelief`] with the reason.
pub fn specify(
    inputs: &Inputs,
    demand: &Demand,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Specification, NoRelief> {
    let torque = inputs.torque();
    let inputs = Inputs { drive: Drive::Torque(torque), ..inputs.clone() };
    let method = governing(&inputs, go_on)?;
    // No figure reads the stations.
    let by_method = |method| Inputs { method, stations: Some(1), ..inputs.clone() };
    let at_rest = by_method(Method::Static);
    let in_motion = (method == Method::Dynamic).then(|| by_method(Method::Dynamic));
    let at_most = figures::loaded(&at_rest, demand.loads.1);
    let solution = solve(&at_most, Stages::of(Stage::Static))?;
    let grid = grid(&at_rest, &solution, demand)?;
    let loads = loads(demand.loads);
    let meter = Meter::new(WORK);
    let bench = PreparedMesh::new(&at_rest, &solution, demand, &loads, grid.most_relief())?;
    let searching = |part: f64| go_on(SEARCH * (part / USUAL_WORK).min(1.0));
    let search = Search::new(&bench, &grid, &meter, &searching);
    let found = search.best_of_each_kind()?;
    let figures = figures::Figures {
        inputs: &at_rest,
        motion: in_motion.as_ref(),
        at_most: (&at_most, &solution),
        demand,
        loads: &loads,
        grid: &grid,
        go_on,
        part: Cell::new(SEARCH),
    };
    let (mut choices, mut beyond) = (vec![figures.present()?], None);
    let solves = found.len() as f64 + 1.0;
    for (done, (name, reliefs)) in found.into_iter().enumerate() {
        let part = (done as f64 + 1.0) / solves;
        figures.part.set(SEARCH + (1.0 - SEARCH) * part);
        match figures.cleared(name, reliefs) {
            Ok(choice) => choices.push(choice),
            // Another kind of relief may still prevent corner contact.
            Err(none @ (NoRelief::Beyond { .. } | NoRelief::InMotion { .. })) => {
                beyond = Some(none);
            }
            Err(none) => return Err(none),
        }
    }
    if let (1, Some(none)) = (choices.len(), beyond) {
        return Err(none);
    }
    let is_better = |one: &usize, other: &usize| {
        let error = |at: &usize| choices[*at].greatest_error();
        error(one).total_cmp(&error(other))
    };
    let best = (1..choices.len()).min_by(is_better).unwrap_or(0);
    let reliefs = choices[best].reliefs;
    Ok(Specification {
        method,
        demand: *demand,
        torque,
        greatest_load: figures.greatest_load(&bench, &reliefs)?,
        unloaded_contact_ratio: solution.geometry.contact_ratio
            - (reliefs.lengths[0] + reliefs.lengths[1]) / solution.geometry.base_pitch,
        map: search.map(&reliefs),
        choices,
        best,
        loads,
        tries: search.tries(),
        is_cut: !meter.spend(0),
    })
}

/// The method that decides whether a tooth strikes: the closed forms do not share the load.
fn governing(inputs: &Inputs, go_on: &dyn Fn(f64) -> bool) -> Result<Method, NoRelief> {
    Ok(match inputs.method {
        Method::Auto => {
            match solve_while(inputs, Stages::of(Stage::Dynamic), &|_| go_on(0.0))?.method {
                Method::Dynamic => Method::Dynamic,
                _ => Method::Static,
            }
        }
        Method::Dynamic => Method::Dynamic,
        Method::Paper | Method::Exact | Method::Static => Method::Static,
    })
}

/// Loads over the range, including both ends.
fn loads((from, to): (f64, f64)) -> Vec<f64> {
    let steps = if to > from { LOADS } else { 1 };
    let last = (steps - 1).max(1) as f64;
    (0..steps).map(|at| decimal(from + (to - from) * at as f64 / last)).collect()
}

/// Rounds a number to at most twelve decimal places.
fn decimal(number: f64) -> f64 {
    const PLACES: f64 = 1e12;
    (number * PLACES).round() / PLACES
}

/// The search grid: amounts and lengths in round steps, up to the limits of tip and path of
/// contact.
fn grid(inputs: &Inputs, solution: &Solution, demand: &Demand) -> Result<Grid, NoRelief> {
    /// Greatest amount over the deflection and deviation at the greatest load.
    const MOST: f64 = 3.0;
    /// Greatest fraction of its thickness that a tip may lose on one flank.
    const PART_OF_TIP: f64 = 0.25;
    /// Steepest relief, as amount over length.
    const STEEPEST: f64 = 0.05;
    let geometry = &solution.geometry;
    let longest = longest(geometry);
    let needed = solution.deviation.loaded_deflection()
        + solution.deviation.equivalent_error.max(0.0)
        + 2.0 * demand.tolerance;
    let length_step = round_step(longest / 40.0);
    let least = (needed / STEEPEST).max(length_step);
    if least > longest {
        return Err(NoRelief::ShortPath { length: longest, least, ratio: geometry.contact_ratio });
    }
    let tip = |gear, circles| {
        let thickness = Profile::of(&Rack::of(inputs, gear), circles).tip_thickness();
        PART_OF_TIP * thickness.max(0.0)
    };
    let tips = [tip(&inputs.driver, &geometry.driver), tip(&inputs.driven, &geometry.driven)];
    let steps = |length: f64, step: f64| (length / step).floor().max(0.0) as i32;
    Ok(Grid {
        length_step,
        least_length: steps(least, length_step).max(1),
        most_length: steps(longest * (1.0 + 1e-9), length_step),
        most_amounts: tips.map(|tip| steps(tip.min(MOST * needed), AMOUNT_STEP)),
        tips,
    })
}

/// The longest relief, in m: up to single-tooth contact. If two pairs always share the load, up to
/// the length at which the unrelieved flanks keep a contact ratio of 1.
fn longest(geometry: &Geometry) -> f64 {
    let kept = 0.5 * (geometry.contact_ratio - 1.0) * geometry.base_pitch;
    geometry.shared_length().max(kept)
}

/// The least round step not below a length: 1, 2 or 5 times a power of ten.
fn round_step(length: f64) -> f64 {
    let decade = 10f64.powf(length.log10().floor());
    let round = [1.0, 2.0, 5.0, 10.0].into_iter();
    let step = round.map(|part| part * decade).find(|step| *step >= length);
    step.unwrap_or(length)
}
