//! The tip relief to specify: amounts and lengths on both gears that can be made, without corner
//! contact at the greatest load, and the best by a criterion even at the limits of the tolerances. For
//! a load that varies over the face width also the crowning.

pub mod demand;
mod face;
mod refused;
mod search;

use std::cell::Cell;
use std::cmp::Ordering::Equal;

use crate::case::units::System;
use crate::case::violated_rule;
use crate::model::geometry::Geometry;
use crate::model::helix::Helix;
use crate::model::inputs::{Drive, Gear, Method, ReliefShape};
use crate::model::profile::{Profile, Rack};
use crate::model::relief::Relief;
use crate::model::slices::Face;
use crate::model::static_load::lead_at_rest;
use crate::model::{Inputs, Refusal, Solution, Stage, Stages, solve, solve_while};
pub use demand::{Criterion, Demand};
pub use refused::{Conditions, NoRelief};
use search::{Bench, Grid, LEAST, MOST_TRIES, Search};

/// Step of an amount, in m: a drawing states whole micrometres.
pub const AMOUNT_STEP: f64 = 1e-6;

/// Step of an amount in inch units: 0.1 thou.
const AMOUNT_STEP_INCH: f64 = 2.54e-6;

/// The rule of [`Specification::specified`].
pub const RULE: &str = "A relief is advised if, within the tolerances, it lowers the figure to \
    minimise by at least 5 % (the force before E by 5 % of the mesh force) and raises no other \
    figure (transmission error, peak force, peak line load, dynamic factor) by a greater percentage.";

/// The least gain of the [`RULE`].
const LEAST_GAIN: f64 = 0.05;

/// The greatest load at which corner contact is looked for, relative to the greatest load of the
/// demand.
pub const MOST_LOAD: f64 = 64.0;

/// Greatest amounts of a proposal, relative to the least amounts without corner contact: a shape that is
/// good only with more relief than this lets the load rise far beyond the demand.
const MOST_AMOUNT: f64 = 2.0;

/// Fraction of the progress that the search makes up; whole solves make up the rest.
const SEARCH: f64 = 0.7;

/// Deviations in m: of the amounts on driver and driven gear, then of the lengths.
pub type Off = [f64; 4];

/// The tip reliefs of both gears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipReliefs {
    /// Shape of the relief along the path of contact.
    pub shape: ReliefShape,
    /// Amounts on driver and driven gear, in m.
    pub amounts: [f64; 2],
    /// Lengths along the path of contact, in m.
    pub lengths: [f64; 2],
    /// Crowning of the driver, in m.
    pub crowning: f64,
}

/// The point of a flank at which a relief begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Begin {
    /// Roll angle from the base circle, in rad.
    pub roll_angle: f64,
    /// Diameter, in m.
    pub diameter: f64,
}

/// The figures of a relief: transmission error at rest, and results of the method at the greatest
/// load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Figures {
    /// The figure of the demand over the peak-to-peak transmission errors at its loads, in m.
    pub error: f64,
    /// The gap that remains before E and after B at rest, in m; below 0 the overlap. Over the face
    /// width before E alone.
    pub gap: f64,
    /// Whether a tip touches off the path of contact, at rest or in motion.
    pub strikes: bool,
    /// Greatest force of the incoming tooth before E, in N.
    pub entry: f64,
    /// Greatest force of the incoming tooth, in N.
    pub peak: f64,
    /// Dynamic factor of the mesh in steady motion; only nominal and of method `dynamic`.
    pub factor: Option<f64>,
    /// Transmission errors at the load of the case as in its results, in m: TE_st,pp without deviations,
    /// and TE_st with the deviations of the case; only nominal.
    pub own_errors: Option<[f64; 2]>,
    /// Greatest line load, in N/m, if the load varies over the face width.
    pub line_load: Option<f64>,
}

/// Reliefs with their results.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Short name.
    pub name: &'static str,
    /// The reliefs.
    pub reliefs: TipReliefs,
    /// Peak-to-peak transmission error at each load, without deviations, in m.
    pub errors: Vec<f64>,
    /// The figures without deviations.
    pub nominal: Figures,
    /// The least favourable of each figure at the limits of the tolerances.
    pub worst: Figures,
    /// The greatest load without corner contact at rest, relative to the load of the case. `None`
    /// if [`MOST_LOAD`] times the greatest load of the demand has no corner contact. The motion is
    /// checked only at the greatest load of the demand.
    pub greatest_load: Option<f64>,
    /// Path of contact on unrelieved flanks over the base pitch: the contact ratio without load.
    pub unloaded_contact_ratio: f64,
}

/// A point of the map over amount and length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapPoint {
    /// The reliefs.
    pub reliefs: TipReliefs,
    /// The figure of the transmission errors over the loads, in m.
    pub error: f64,
    /// The remaining gap, in m.
    pub margin: f64,
}

/// The relief to specify.
#[derive(Debug, Clone, PartialEq)]
pub struct Specification {
    /// The method of the case.
    pub asked: Method,
    /// The method that finds no corner contact with the specified relief.
    pub method: Method,
    /// The demand, with the tolerance of the lengths.
    pub demand: Demand,
    /// Torque on the driver at load 1, in N m.
    pub torque: f64,
    /// Mesh force at the greatest load of the demand, in N.
    pub mesh_force: f64,
    /// Whether the load varies over the face width.
    pub is_over_face: bool,
    /// The crowning of the driven gear, which stays that of the case, in m.
    pub driven_crowning: f64,
    /// The helical geometry.
    pub helix: Helix,
    /// The geometry of the pair.
    pub geometry: Geometry,
    /// The loads, relative to the load of the case.
    pub loads: Vec<f64>,
    /// The reliefs of the case, then the best relief of each kind.
    pub choices: Vec<Choice>,
    /// Index of the best choice by the criterion.
    pub best: usize,
    /// One row per length, shortest first; one point per amount.
    pub map: Vec<Vec<MapPoint>>,
    /// Number of reliefs that the search evaluated.
    pub tries: u64,
    /// Whether the budget ended the search early.
    pub is_cut: bool,
}

impl TipReliefs {
    /// The reliefs of a case.
    pub fn of_case(inputs: &Inputs, geometry: &Geometry) -> TipReliefs {
        let gears = [&inputs.driver, &inputs.driven];
        let usual = geometry.shared_length();
        TipReliefs {
            shape: inputs.relief_shape,
            amounts: gears.map(|gear| gear.tip_relief),
            lengths: gears.map(|gear| gear.tip_relief_length.unwrap_or(usual)),
            crowning: inputs.driver.crowning,
        }
    }

    /// The reliefs with deviations. A tip without relief has no deviation.
    pub fn off(&self, by: Off) -> TipReliefs {
        let amount = |at: usize| {
            if self.amounts[at] > 0.0 { (self.amounts[at] + by[at]).max(0.0) } else { 0.0 }
        };
        let length = |at: usize| (self.lengths[at] + by[2 + at]).max(f64::MIN_POSITIVE);
        TipReliefs { amounts: [amount(0), amount(1)], lengths: [length(0), length(1)], ..*self }
    }

    /// The points at which the reliefs begin.
    ///
    /// # Formula
    /// ```text
    /// ρ = ρ_a − L_Ca,   ξ = ρ/r_b,   d_Ca = 2 √(r_b² + ρ²)
    /// ```
    /// ρ_a is the radius of curvature at the end of contact, ξ the roll angle.
    ///
    /// # Source
    /// ISO 21771: involute and tip relief.
    pub fn begins(&self, geometry: &Geometry) -> [Begin; 2] {
        let Geometry { driver, driven, start, end, tangent_length, .. } = geometry;
        let gears = [(driver.base, *end), (driven.base, tangent_length - start)];
        std::array::from_fn(|at| {
            let (base, tip) = gears[at];
            let curvature = (tip - self.lengths[at]).max(0.0);
            Begin { roll_angle: curvature / base, diameter: 2.0 * base.hypot(curvature) }
        })
    }

    /// The case with these reliefs.
    pub fn of(&self, inputs: &Inputs) -> Inputs {
        let gear = |gear: &Gear, at: usize| Gear {
            tip_relief: self.amounts[at],
            tip_relief_length: Some(self.lengths[at]),
            ..*gear
        };
        Inputs {
            driver: Gear { crowning: self.crowning, ..gear(&inputs.driver, 0) },
            driven: gear(&inputs.driven, 1),
            relief_shape: self.shape,
            ..inputs.clone()
        }
    }

    /// Both amounts together, in m.
    pub fn removed(&self) -> f64 {
        decimal(self.amounts[0] + self.amounts[1])
    }
}

impl Choice {
    /// The figures that the [`RULE`] compares: transmission error, peak force, peak line load and force
    /// before E within the tolerances, then the nominal dynamic factor.
    pub fn compared(&self) -> [Option<f64>; 5] {
        let Figures { error, peak, line_load, entry, .. } = self.worst;
        [Some(error), Some(peak), line_load, Some(entry), self.nominal.factor]
    }

    /// Whether the [`RULE`] advises this relief in place of that of the case.
    fn is_advised(&self, case: &Choice, criterion: Criterion, mesh_force: f64) -> bool {
        let [from, to] = [case, self].map(|choice| choice.worst.of(criterion));
        let over = if criterion == Criterion::Entry { mesh_force } else { from };
        let gain = (from - to) / over;
        // The force before E is part of the peak force.
        let figures = case.compared().into_iter().zip(self.compared()).enumerate();
        let mut rises = figures
            .filter(|(at, _)| *at != ENTRY)
            .filter_map(|(_, (from, to))| from.zip(to).map(|(from, to)| to / from - 1.0));
        gain >= LEAST_GAIN && rises.all(|rise| rise <= gain)
    }

    /// The length on a gear, if it has a relief, in m.
    pub fn length(&self, at: usize) -> Option<f64> {
        (self.reliefs.amounts[at] > 0.0).then_some(self.reliefs.lengths[at])
    }
}

/// The place of the force before E in [`Choice::compared`].
const ENTRY: usize = 3;

impl Figures {
    /// The least favourable of each figure.
    fn worst(self, other: Figures) -> Figures {
        Figures {
            error: self.error.max(other.error),
            gap: self.gap.min(other.gap),
            strikes: self.strikes || other.strikes,
            entry: self.entry.max(other.entry),
            peak: self.peak.max(other.peak),
            factor: None,
            own_errors: None,
            line_load: self.line_load.into_iter().chain(other.line_load).reduce(f64::max),
        }
    }

    /// The figure that a criterion compares: of forces over the face width the line load.
    pub fn of(&self, criterion: Criterion) -> f64 {
        [self.error, self.line_load.unwrap_or(self.peak), self.entry][criterion as usize]
    }
}

impl Specification {
    /// The best choice.
    pub fn chosen(&self) -> &Choice {
        &self.choices[self.best]
    }

    /// Index of the choice with the least figure of those without corner contact.
    pub fn least(&self) -> Option<usize> {
        let figure = |at: &usize| self.choices[*at].worst.of(self.demand.minimise);
        let open = (0..self.choices.len()).filter(|at| !self.choices[*at].worst.strikes);
        open.min_by(|one, other| figure(one).total_cmp(&figure(other)))
    }

    /// The choice whose figures are shown beside those of the case: for the case the best one, or if
    /// none is better by the rule, the one with the least figure.
    pub fn compared(&self, at: usize) -> usize {
        match (at, self.best) {
            (0, 0) => self.least().unwrap_or(0),
            (0, best) => best,
            (own, _) => own,
        }
    }

    /// Whether the [`RULE`] advises the best choice. The relief of the case needs no advice.
    pub fn is_advised(&self) -> bool {
        let Specification { demand, mesh_force, .. } = self;
        self.chosen().is_advised(&self.choices[0], demand.minimise, *mesh_force)
    }

    /// Index of the choice to specify: the best one if it is advised, otherwise the relief of the
    /// case.
    pub fn specified(&self) -> usize {
        if self.is_advised() { self.best } else { 0 }
    }
}

/// The relief to specify for a pair.
///
/// # Formula
/// ```text
/// least over C1, L1, C2, L2, shape of  max over the tolerances of  figure
/// figure:  te     max over the loads of (max x − min x), or its mean over a load spectrum
///          peak   greatest tooth force at the greatest load; over the face its line load
///          entry  greatest tooth force before E at the greatest load
/// with x + e − S <= 0 before E and after B at the greatest load, for each C and L ± its tolerance
/// ```
/// x is the transmission error of the static balance. If the method of the case is `dynamic`, the
/// amounts grow until the motion has no corner contact either. Of the kinds of relief whose figures
/// differ by no more than [`Criterion::worth`], the one with the smallest amounts is chosen, and
/// specified if it gains more than it costs ([`RULE`]). No kind
/// has amounts above twice the least ones that prevent corner contact. If no relief prevents corner
/// contact, the criterion `entry` chooses the one with the least overlap. If the load varies over the
/// face width, both gears have the same relief, the crowning of the driver is found together with it,
/// and the misalignment ± its deviation is one of the tolerances.
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
    let (asked, torque) = (inputs.method, inputs.torque());
    let inputs = Inputs { drive: Drive::Torque(torque), ..inputs.clone() };
    let is_over_face = inputs.face().is_some() || demand.misalignment > 0.0;
    let tilt = demand.misalignment.copysign(inputs.misalignment);
    let tilted = Inputs { misalignment: inputs.misalignment + tilt, ..inputs.clone() };
    if let Some(problem) = violated_rule(&tilted) {
        return Err(NoRelief::Misaligned(Box::new(problem)));
    }
    let method = if is_over_face { Method::Static } else { governing(&inputs, go_on)? };
    // No figure reads the stations.
    let at_rest = Inputs { method: Method::Static, stations: Some(1), ..inputs };
    let at_most = loaded(&at_rest, demand.greatest_load());
    let solution = solve(&at_most, Stages::of(Stage::Static))?;
    let step = length_step(&solution.geometry, demand.units);
    let tolerance_length = demand.tolerance_length.unwrap_or(step);
    let demand = &Demand { tolerance_length: Some(tolerance_length), ..demand.clone() };
    let mut loads = demand.loads();
    if is_over_face && demand.spectrum.is_empty() && loads.len() > 2 {
        // Whole solves over the face take long.
        loads.drain(1..loads.len() - 1);
    }
    let grid = grid(&at_rest, &solution, demand, step)?;
    let bench =
        if is_over_face { None } else { Some(Bench::new(&at_rest, &solution, demand, &grid)?) };
    let pair = WholeSolves {
        is_in_motion: method == Method::Dynamic,
        inputs: &at_rest,
        at_most: &at_most,
        demand,
        loads: &loads,
        grid: &grid,
        bench: bench.as_ref(),
        go_on,
        part: Cell::new(if is_over_face { 0.0 } else { SEARCH }),
    };
    let (found, tries) = match &bench {
        None => face::search(&pair)?,
        Some(bench) => {
            let peak = |reliefs: &TipReliefs| Ok(pair.figures(reliefs, pair.is_in_motion)?.peak);
            let peak = (demand.minimise == Criterion::Peak).then_some(&peak as search::Peak<'_>);
            let mut search = Search::new(bench, &grid, go_on);
            (search.best_of_each_kind(peak)?, search.tries())
        }
    };
    pair.part.set(SEARCH);
    let present = TipReliefs::of_case(&at_rest, &solution.geometry);
    let mut choices = vec![pair.choice("relief of the case", present, pair.worst(&present)?)?];
    let (kinds, mut beyond) = (found.len() as f64, None);
    for (done, (name, reliefs)) in (1..).zip(found) {
        pair.part.set(SEARCH + (1.0 - SEARCH) * f64::from(done) / (kinds + 1.0));
        match pair.cleared(name, reliefs) {
            Ok(choice) => {
                let is_least = choice.name == LEAST;
                // The amounts grow in whole solves, and another kind can then have the least ones.
                let is_same = |one: &&mut Choice| match is_least {
                    true if one.worst.strikes => false,
                    true => {
                        choice.worst.strikes || one.reliefs.removed() <= choice.reliefs.removed()
                    }
                    false => one.reliefs == choice.reliefs,
                };
                let same = choices[1..].iter_mut().filter(is_same);
                match same
                    .min_by(|one, other| one.reliefs.removed().total_cmp(&other.reliefs.removed()))
                {
                    Some(same) => same.name = search::joined(same.name, choice.name),
                    None => choices.push(choice),
                }
            }
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
    let best = best(&choices, demand.minimise, solution.mesh_force);
    Ok(Specification {
        asked,
        method,
        torque,
        mesh_force: solution.mesh_force,
        is_over_face,
        driven_crowning: at_rest.driven.crowning,
        helix: solution.helix,
        geometry: solution.geometry,
        map: pair.map(&choices[best].reliefs)?,
        loads: loads.into_iter().map(|(load, _)| load).collect(),
        choices,
        best,
        tries,
        is_cut: tries >= MOST_TRIES,
        demand: demand.clone(),
    })
}

/// The choice with the smallest amounts among those whose figure is close to the best one; of the
/// advised choices if there are any. Of equal peak forces the transmission error decides.
fn best(choices: &[Choice], criterion: Criterion, mesh_force: f64) -> usize {
    let mut candidates: Vec<usize> =
        (0..choices.len()).filter(|&at| !choices[at].worst.strikes).collect();
    if candidates.is_empty() {
        candidates = (1..choices.len()).collect();
    }
    let is_kept =
        |at: &usize| *at == 0 || choices[*at].is_advised(&choices[0], criterion, mesh_force);
    if candidates.iter().any(is_kept) {
        candidates.retain(is_kept);
    }
    let others = [Criterion::Te].into_iter().filter(|_| criterion == Criterion::Peak);
    for criterion in [criterion].into_iter().chain(others) {
        let figure = |at: &usize| choices[*at].worst.of(criterion);
        let least = candidates.iter().map(figure).fold(f64::INFINITY, f64::min);
        candidates.retain(|at| figure(at) <= (1.0 + criterion.worth()) * least);
    }
    // Of equal amounts the smaller figure, then the shorter relief.
    let cost = |at: &usize| {
        let Choice { reliefs, worst, .. } = &choices[*at];
        [reliefs.removed(), worst.of(criterion), reliefs.lengths[0] + reliefs.lengths[1]]
    };
    let is_less = |one: &usize, other: &usize| cost(one).partial_cmp(&cost(other));
    let least = candidates.into_iter().min_by(|one, other| is_less(one, other).unwrap_or(Equal));
    least.unwrap_or(0)
}

/// The method that decides whether a tooth strikes: the closed forms do not share the load.
fn governing(inputs: &Inputs, go_on: &dyn Fn(f64) -> bool) -> Result<Method, NoRelief> {
    Ok(match inputs.method {
        Method::Auto => {
            let moves = |inputs: &Inputs| {
                let found = solve_while(inputs, Stages::of(Stage::Dynamic), &|_| go_on(0.0));
                found.map(|found| found.method == Method::Dynamic)
            };
            // The reliefs of the case must not decide the method for the others.
            let mut plain = inputs.clone();
            (plain.driver.tip_relief, plain.driven.tip_relief) = (0.0, 0.0);
            let is_relieved = plain != *inputs;
            let is_in_motion = moves(inputs)? || is_relieved && moves(&plain)?;
            if is_in_motion { Method::Dynamic } else { Method::Static }
        }
        Method::Dynamic => Method::Dynamic,
        Method::Paper | Method::Exact | Method::Static => Method::Static,
    })
}

/// Rounds a number to at most twelve decimal places.
fn decimal(number: f64) -> f64 {
    const PLACES: f64 = 1e12;
    (number * PLACES).round() / PLACES
}

/// The step of a length, in m: 0.1 mm or 0.005 in, and less where the path of contact is short.
fn length_step(geometry: &Geometry, units: System) -> f64 {
    let at = match longest(geometry) {
        3e-3.. => 0,
        1e-3.. => 1,
        _ => 2,
    };
    match units {
        System::Metric => [1e-4, 5e-5, 1e-5][at],
        System::Inch => [1.27e-4, 5.08e-5, 1.27e-5][at],
    }
}

/// The search grid: amounts and lengths in steps that a drawing states, up to the limits of tip and
/// path of contact.
fn grid(
    inputs: &Inputs,
    solution: &Solution,
    demand: &Demand,
    length_step: f64,
) -> Result<Grid, NoRelief> {
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
    let shortest = demand.tolerance_length.unwrap_or(0.0) + length_step;
    let least = (needed / STEEPEST).max(shortest);
    let steps = |length: f64, step: f64| (length / step).floor().max(0.0) as i32;
    let least_length = (least / length_step - 1e-9).ceil() as i32;
    let most_length = steps(longest * (1.0 + 1e-9), length_step);
    if least_length > most_length {
        let (of, ratio) = (Conditions::of(demand, longest), geometry.contact_ratio);
        return Err(NoRelief::ShortPath { of, least, ratio });
    }
    let tip = |gear, circles| {
        let thickness = Profile::of(&Rack::of(inputs, gear), circles).tip_thickness();
        PART_OF_TIP * thickness.max(0.0)
    };
    let tips = [tip(&inputs.driver, &geometry.driver), tip(&inputs.driven, &geometry.driven)];
    let amount_step = match demand.units {
        System::Metric => AMOUNT_STEP,
        System::Inch => AMOUNT_STEP_INCH,
    };
    Ok(Grid {
        amount_step,
        length_step,
        least_length,
        most_length,
        most_amounts: tips.map(|tip| steps(tip.min(MOST * needed), amount_step)),
        needed,
        tips,
    })
}

/// The longest relief, in m: up to single-tooth contact. If two pairs always share the load, up to
/// the length at which the unrelieved flanks keep a contact ratio of 1.
fn longest(geometry: &Geometry) -> f64 {
    let kept = 0.5 * (geometry.contact_ratio - 1.0) * geometry.base_pitch;
    geometry.shared_length().max(kept)
}

/// Steps by which the amount of a relief grows if a whole solve finds an overlap.
const GROWTHS: [i32; 12] = [0, 1, 2, 3, 4, 5, 6, 8, 10, 14, 18, 24];

/// The case with a fraction of its load.
fn loaded(inputs: &Inputs, part: f64) -> Inputs {
    Inputs { drive: Drive::Torque(part * inputs.torque()), ..inputs.clone() }
}

/// Whole solves of the pair with other reliefs.
struct WholeSolves<'a> {
    inputs: &'a Inputs,
    /// Whether the motion decides.
    is_in_motion: bool,
    /// The case under the greatest load of the demand.
    at_most: &'a Inputs,
    demand: &'a Demand,
    /// Loads with their shares.
    loads: &'a [(f64, f64)],
    grid: &'a Grid,
    /// The prepared mesh; `None` if the load varies over the face width.
    bench: Option<&'a Bench<'a>>,
    go_on: &'a dyn Fn(f64) -> bool,
    /// The progress so far.
    part: Cell<f64>,
}

impl WholeSolves<'_> {
    /// The limits of the tolerances, over the face width those with equal gears; each with every
    /// misalignment, in m.
    fn limits(&self) -> Vec<(Off, f64)> {
        let mut limits = self.demand.corners();
        if self.bench.is_none() {
            limits.retain(is_alike);
            limits.retain(|off| off[0] * off[2] >= 0.0);
        }
        let misalignments = self.misalignments();
        limits.iter().flat_map(|&off| misalignments.iter().map(move |&by| (off, by))).collect()
    }

    /// The limits with the smallest reliefs.
    fn smallest(&self) -> Vec<(Off, f64)> {
        let mut limits = self.limits();
        limits.retain(|(off, _)| off.iter().all(|by| *by <= 0.0));
        limits
    }

    /// The misalignment of the case, and its limits, in m.
    fn misalignments(&self) -> Vec<f64> {
        let (own, by) = (self.inputs.misalignment, self.demand.misalignment);
        if by > 0.0 { vec![own - by, own, own + by] } else { vec![own] }
    }

    /// Increases a relief until no whole solve finds corner contact. The criterion `entry` accepts
    /// the contact of a relief that cannot prevent it.
    fn cleared(&self, name: &'static str, reliefs: TipReliefs) -> Result<Choice, NoRelief> {
        let (mut greatest, mut last) = (reliefs, 0.0);
        for steps in GROWTHS {
            let Some(greater) = self.grid.greater(&reliefs, steps) else {
                break;
            };
            let worst = self.worst(&greater)?;
            if !worst.strikes {
                return self.choice(name, greater, worst);
            }
            (greatest, last) = (greater, worst.gap);
        }
        if self.demand.minimise == Criterion::Entry {
            return self.choice(name, reliefs, self.worst(&reliefs)?);
        }
        let most = greatest.amounts[0].max(greatest.amounts[1]);
        let of = Conditions::of(self.demand, self.grid.longest());
        Err(if last < 0.0 {
            NoRelief::Beyond { of, most, overlap: -last }
        } else {
            NoRelief::InMotion { of, most }
        })
    }

    /// The peak-to-peak transmission error at each load, in m.
    fn errors(&self, reliefs: &TipReliefs, misalignment: f64) -> Result<Vec<f64>, NoRelief> {
        let error = |&(part, _): &(f64, f64)| {
            let inputs = Inputs { misalignment, ..reliefs.of(&loaded(self.inputs, part)) };
            let solution = self.solve(&inputs, Stages::of(Stage::StaticSpectrum))?;
            let found = solution.static_spectrum.transpose()?;
            Ok(found.map_or(0.0, |found| found.spectrum.peak_to_peak))
        };
        self.loads.iter().map(error).collect()
    }

    fn choice(
        &self,
        name: &'static str,
        reliefs: TipReliefs,
        worst: Figures,
    ) -> Result<Choice, NoRelief> {
        let (demand, own) = (self.demand, self.inputs.misalignment);
        let errors = self.errors(&reliefs, own)?;
        let factor = if self.is_in_motion {
            // A motion that does not become steady has no factor.
            let solution = self.solve(&self.moving(&reliefs), Stages::of(Stage::SteadyMotion))?;
            let steady = solution.steady.and_then(Result::ok);
            steady.map(|steady| steady.mesh_force / solution.mesh_force)
        } else {
            None
        };
        let stages = Stages::of(Stage::Static).and(Stages::of(Stage::StaticSpectrum));
        let inputs = reliefs.of(self.inputs);
        let solution = self.solve(&inputs, stages)?;
        let relief = Relief::of(&inputs.reliefs(), &solution.geometry);
        let unloaded_contact_ratio = relief.unrelieved_contact_ratio(&solution.geometry);
        let ideal = solution.static_spectrum.transpose()?;
        let own_errors = ideal
            .zip(solution.static_load)
            .map(|(ideal, load)| [ideal.spectrum.peak_to_peak, load.transmission_error]);
        let error = demand.figure(errors.iter().copied());
        let nominal =
            Figures { error, factor, own_errors, ..self.figures(&reliefs, self.is_in_motion)? };
        let mut worst = nominal.worst(worst);
        for (off, misalignment) in self.limits() {
            let errors = self.errors(&reliefs.off(off), misalignment)?;
            worst.error = worst.error.max(demand.figure(errors.into_iter()));
        }
        let greatest_load = self.greatest_load(&reliefs)?;
        Ok(Choice { name, reliefs, errors, nominal, worst, greatest_load, unloaded_contact_ratio })
    }

    /// The least favourable figures at the limits of the tolerances, without the errors. The motion
    /// is computed where both gears have equal deviations; the other limits have no forces in motion.
    fn worst(&self, reliefs: &TipReliefs) -> Result<Figures, NoRelief> {
        let none = Figures { gap: f64::INFINITY, ..Figures::default() };
        self.limits().into_iter().try_fold(none, |worst, (off, misalignment)| {
            let in_motion = self.is_in_motion && is_alike(&off);
            let mut found = self.figures_at(&reliefs.off(off), misalignment, 1.0, in_motion)?;
            if self.is_in_motion && !in_motion {
                (found.entry, found.peak) = (0.0, 0.0);
            }
            Ok(worst.worst(found))
        })
    }

    /// The figures of a relief without the error, by the motion if that is wanted.
    fn figures(&self, reliefs: &TipReliefs, in_motion: bool) -> Result<Figures, NoRelief> {
        self.figures_at(reliefs, self.inputs.misalignment, 1.0, in_motion)
    }

    /// The same with a misalignment in m, under a multiple of the greatest load.
    fn figures_at(
        &self,
        reliefs: &TipReliefs,
        misalignment: f64,
        times: f64,
        in_motion: bool,
    ) -> Result<Figures, NoRelief> {
        let inputs = Inputs { misalignment, ..reliefs.of(&loaded(self.at_most, times)) };
        let solution = self.solve(&inputs, Stages::of(Stage::Static))?;
        // Over the face width the contact after B is known without its lead.
        let (leads, strikes_after) = match (&solution.mesh, inputs.face()) {
            (Some(mesh), Some(face)) => {
                let before = Face::new(&face, &solution.geometry, mesh)?.lead_at_rest(false)?;
                let load = solution.static_load.as_ref();
                let last = load.and_then(|load| load.last_contact_angle);
                ([before, f64::NEG_INFINITY], last.is_some())
            }
            (Some(mesh), None) => ([lead_at_rest(mesh, false)?, lead_at_rest(mesh, true)?], false),
            (None, _) => ([f64::NEG_INFINITY; 2], false),
        };
        let line_load = solution.face_load.as_ref().map(|load| load.peak.line_load);
        let found = solution.static_load.unwrap_or_default();
        let gap = -leads[0].max(leads[1]);
        let at_rest = Figures {
            error: 0.0,
            gap,
            strikes: gap < 0.0 || strikes_after,
            entry: if leads[0] > 0.0 { found.approach_force } else { 0.0 },
            peak: found.peak_force,
            line_load,
            ..Figures::default()
        };
        if !in_motion {
            return Ok(at_rest);
        }
        let solution = self.solve(&self.moving(reliefs), Stages::of(Stage::Dynamic))?;
        Ok(solution.dynamic.map_or(at_rest, |found| Figures {
            strikes: at_rest.strikes
                || found.first_contact_angle.is_some()
                || found.last_contact_angle.is_some(),
            entry: found.peak_approach_force,
            peak: found.peak_force,
            ..at_rest
        }))
    }

    fn moving(&self, reliefs: &TipReliefs) -> Inputs {
        reliefs.of(&Inputs { method: Method::Dynamic, ..self.at_most.clone() })
    }

    fn solve(&self, inputs: &Inputs, stages: Stages) -> Result<Solution, NoRelief> {
        Ok(solve_while(inputs, stages, &|_| (self.go_on)(self.part.get()))?)
    }

    /// Whether no tolerance leads to overlap at rest under a multiple of the greatest load.
    fn clears(&self, reliefs: &TipReliefs, times: f64) -> Result<bool, NoRelief> {
        if !(self.go_on)(self.part.get()) {
            return Err(NoRelief::Refused(Refusal::Stopped));
        }
        if let Some(bench) = self.bench {
            return Ok(bench.overlap_under(reliefs, times)? <= 0.0);
        }
        for (off, misalignment) in self.smallest() {
            let found = self.figures_at(&reliefs.off(off), misalignment, times, false);
            let is_refused =
                matches!(found, Err(NoRelief::Refused(refusal)) if refusal != Refusal::Stopped);
            if is_refused || found?.strikes {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// The greatest load without overlap at rest, relative to the load of the case. `None` if even
    /// [`MOST_LOAD`] times the greatest load of the range has no overlap.
    fn greatest_load(&self, reliefs: &TipReliefs) -> Result<Option<f64>, NoRelief> {
        let close = if self.bench.is_some() { 1e-3 } else { 1e-2 };
        let (mut low, mut high) = (0.0, 1.0);
        while self.clears(reliefs, high)? {
            if high >= MOST_LOAD {
                return Ok(None);
            }
            (low, high) = (high, 2.0 * high);
        }
        while high - low > close * high.max(close) {
            let middle = f64::midpoint(low, high);
            if self.clears(reliefs, middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Some(self.demand.greatest_load() * low))
    }

    /// The map around a relief over both amounts and both lengths in proportion; the map contains
    /// the relief itself.
    fn map(&self, reliefs: &TipReliefs) -> Result<Vec<Vec<MapPoint>>, NoRelief> {
        const AMOUNTS: [f64; 7] = [0.4, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6];
        const LENGTHS: [f64; 6] = [0.25, 0.4, 0.55, 0.7, 0.85, 1.0];
        /// A length of the map this close to the length of the relief is omitted.
        const CLOSE: f64 = 0.03;
        let longest = self.grid.longest();
        let greatest = reliefs.lengths[0].max(reliefs.lengths[1]);
        let own = greatest / longest;
        let [amounts, lengths] = match self.bench {
            Some(_) => [&AMOUNTS[..], &LENGTHS[..]],
            None => [&AMOUNTS[1..6], &LENGTHS[1..5]],
        };
        let mut parts = lengths.to_vec();
        parts.retain(|part| (part - own).abs() > CLOSE);
        parts.push(own);
        parts.sort_by(f64::total_cmp);
        let point = |part: f64, times: f64| -> Result<MapPoint, NoRelief> {
            let scale = part * longest / greatest;
            let reliefs = TipReliefs {
                amounts: reliefs.amounts.map(|amount| times * amount),
                lengths: reliefs.lengths.map(|length| scale * length),
                ..*reliefs
            };
            let (error, margin) = if let Some(bench) = self.bench {
                (bench.error(&reliefs), -bench.worst_overlap(&reliefs))
            } else {
                let errors = self.errors(&reliefs, self.inputs.misalignment)?;
                (self.demand.figure(errors.into_iter()), self.figures(&reliefs, false)?.gap)
            };
            Ok(MapPoint { reliefs, error, margin })
        };
        let row = |part| amounts.iter().map(|&times| point(part, times)).collect();
        parts.into_iter().map(row).collect()
    }
}

/// Whether both gears have equal deviations.
fn is_alike(off: &Off) -> bool {
    off[..2] == [off[0]; 2] && off[2..] == [off[2]; 2]
}
