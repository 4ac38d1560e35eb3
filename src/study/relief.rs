//! The tip relief to specify: amounts and lengths on both gears without corner contact at the
//! greatest load and with the least transmission error over the loads.

mod search;

use std::cell::Cell;
use std::collections::HashMap;
use std::fmt;

use crate::case::units::{self, Dimension};
use crate::model::geometry::Geometry;
use crate::model::inputs::{Drive, Gear, Method, ReliefShape};
use crate::model::profile::{Profile, Rack};
use crate::model::static_load::{lead_after_end, lead_before_start};
use crate::model::{Inputs, Refusal, Solution, Stage, Stages, solve, solve_while};
use crate::numeric::decimal::shortest;
use search::{Grid, MOST_TRIES, PreparedMesh, Search, tolerances};

/// Step of an amount, in m: half a micrometre.
pub const AMOUNT_STEP: f64 = 0.5e-6;

/// The greatest load at which corner contact is looked for, relative to the greatest load of the
/// demand.
pub const MOST_LOAD: f64 = 64.0;

/// Number of loads at which the transmission error is computed.
const LOADS: usize = 6;

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
    pub fn greatest_error(&self) -> f64 {
        self.errors.iter().copied().fold(0.0, f64::max)
    }

    /// The mean transmission error over the loads, in m.
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
    let at_rest = Inputs { method: Method::Static, stations: Some(1), ..inputs };
    let at_most = loaded(&at_rest, demand.loads.1);
    let solution = solve(&at_most, Stages::of(Stage::Static))?;
    let grid = grid(&at_rest, &solution, demand)?;
    let loads = load_factors(demand.loads);
    let bench = PreparedMesh::new(&at_rest, &solution, demand, &loads, &grid)?;
    let searching = |part: f64| go_on(SEARCH * part.min(1.0));
    let mut search =
        Search { bench: &bench, grid: &grid, go_on: &searching, known: HashMap::new() };
    let found = search.best_of_each_kind()?;
    let solves = WholeSolves {
        inputs: &at_rest,
        is_in_motion: method == Method::Dynamic,
        at_most: &at_most,
        demand,
        loads: &loads,
        grid: &grid,
        go_on,
        part: Cell::new(SEARCH),
    };
    let usual = solution.geometry.shared_length();
    let gears = [&at_rest.driver, &at_rest.driven];
    let present = TipReliefs {
        shape: at_rest.relief_shape,
        amounts: gears.map(|gear| gear.tip_relief),
        lengths: gears.map(|gear| gear.tip_relief_length.unwrap_or(usual)),
    };
    let (mut choices, mut beyond) = (vec![solves.choice("relief of the case", present)?], None);
    let kinds = found.len() as f64;
    for (done, (name, reliefs)) in (1..).zip(found) {
        solves.part.set(SEARCH + (1.0 - SEARCH) * f64::from(done) / (kinds + 1.0));
        match solves.cleared(name, reliefs) {
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
    let error = |at: &usize| choices[*at].greatest_error();
    let best = (1..choices.len()).min_by(|one, other| error(one).total_cmp(&error(other)));
    let best = best.unwrap_or(0);
    let reliefs = choices[best].reliefs;
    Ok(Specification {
        method,
        demand: *demand,
        torque,
        greatest_load: solves.greatest_load(&bench, &reliefs)?,
        unloaded_contact_ratio: solution.geometry.contact_ratio
            - (reliefs.lengths[0] + reliefs.lengths[1]) / solution.geometry.base_pitch,
        map: search.map(&reliefs),
        choices,
        best,
        loads,
        tries: search.tries(),
        is_cut: search.tries() >= MOST_TRIES,
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
fn load_factors((from, to): (f64, f64)) -> Vec<f64> {
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

/// Parses a range of loads in percent, such as `25..110%`, or one load.
///
/// # Errors
/// Returns the syntax of a load range.
pub fn loads(text: &str) -> Result<(f64, f64), String> {
    const FIX: &str = "write a range above 0 % and up to 1000 %, such as 25..110%";
    let number = |text: &str| {
        let number = text.trim().trim_end_matches('%').trim_end();
        let percent = number.parse::<f64>().ok().filter(|percent| *percent > 0.0);
        percent.filter(|percent| *percent <= 1000.0).map(|percent| percent / 100.0)
    };
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    match number(from).zip(number(to)) {
        Some((from, to)) if from > to => Err(format!("the range is reversed: {FIX}")),
        found => found.ok_or(FIX.to_owned()),
    }
}

/// Parses a length from 0 to 1 mm.
///
/// # Errors
/// Returns the syntax of a tolerance.
pub fn tolerance(text: &str) -> Result<f64, String> {
    const MOST: f64 = 1e-3;
    let length = units::parse(text, Dimension::Length, "um")
        .map_err(|error| format!("{}: {}", error.cause, error.fix))?;
    if (0.0..=MOST).contains(&length) {
        Ok(length)
    } else {
        Err("write a length from 0 um to 1 mm, such as '5 um'".to_owned())
    }
}

impl Demand {
    /// Parses a text such as `25..110 %, 5 um`; the tolerance is optional.
    ///
    /// # Errors
    /// Returns the correct syntax.
    pub fn parse(text: &str) -> Result<Demand, String> {
        let (range, width) = text.split_once(',').unwrap_or((text, ""));
        let tolerance = match width.trim() {
            "" => Demand::USUAL.tolerance,
            width => tolerance(width)?,
        };
        let loads = loads(range)?;
        Ok(Demand { loads, tolerance })
    }

    /// The text that [`Demand::parse`] reads.
    pub fn text(&self) -> String {
        let percent = |part: f64| shortest((part * 1e4).round() / 100.0);
        let (from, to) = self.loads;
        let tolerance = units::text(self.tolerance, "um");
        format!("{}..{} %, {tolerance}", percent(from), percent(to))
    }
}

/// Steps by which the amount of a relief grows if a whole solve finds an overlap.
const GROWTHS: [i32; 12] = [0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48];

/// The case with a fraction of its load.
fn loaded(inputs: &Inputs, part: f64) -> Inputs {
    Inputs { drive: Drive::Torque(part * inputs.torque()), ..inputs.clone() }
}

/// The case with other tip reliefs and their deviations.
fn relieved(inputs: &Inputs, reliefs: &TipReliefs, off: [f64; 2]) -> Inputs {
    let gear = |gear: &Gear, at: usize| Gear {
        tip_relief: (reliefs.amounts[at] + off[at]).max(0.0),
        tip_relief_length: Some(reliefs.lengths[at]),
        ..gear.clone()
    };
    Inputs {
        driver: gear(&inputs.driver, 0),
        driven: gear(&inputs.driven, 1),
        relief_shape: reliefs.shape,
        ..inputs.clone()
    }
}

/// Whole solves of the pair with other reliefs.
struct WholeSolves<'a> {
    inputs: &'a Inputs,
    /// Whether the motion decides.
    is_in_motion: bool,
    /// The case under the greatest load of the demand.
    at_most: &'a Inputs,
    demand: &'a Demand,
    loads: &'a [f64],
    grid: &'a Grid,
    go_on: &'a dyn Fn(f64) -> bool,
    /// The progress so far.
    part: Cell<f64>,
}

impl WholeSolves<'_> {
    /// Increases a relief until no whole solve finds corner contact.
    fn cleared(&self, name: &'static str, reliefs: TipReliefs) -> Result<Choice, NoRelief> {
        let (mut greatest, mut overlap) = (reliefs, f64::INFINITY);
        for steps in GROWTHS {
            let Some(greater) = self.grid.greater(&reliefs, steps) else {
                break;
            };
            (greatest, overlap) = (greater, self.overlap(&greater)?);
            if overlap <= 0.0 && !self.strikes_in_motion(&greater)? {
                return self.choice(name, greater);
            }
        }
        let most = greatest.amounts[0].max(greatest.amounts[1]);
        Err(if overlap > 0.0 {
            NoRelief::Beyond { most, overlap }
        } else {
            NoRelief::InMotion { most }
        })
    }

    fn choice(&self, name: &'static str, reliefs: TipReliefs) -> Result<Choice, NoRelief> {
        let errors = self.loads.iter().map(|&part| {
            let inputs = relieved(&loaded(self.inputs, part), &reliefs, [0.0; 2]);
            let solution = self.solve(&inputs, Stage::StaticSpectrum)?;
            let found = solution.static_spectrum.transpose()?;
            Ok(found.map_or(0.0, |found| found.spectrum.peak_to_peak))
        });
        Ok(Choice {
            name,
            reliefs,
            errors: errors.collect::<Result<_, NoRelief>>()?,
            margin: -self.overlap(&reliefs)?,
        })
    }

    /// Overlap of the teeth at the greatest load with the least favourable tolerance, in m.
    fn overlap(&self, reliefs: &TipReliefs) -> Result<f64, NoRelief> {
        let mut worst = f64::NEG_INFINITY;
        for off in tolerances(self.demand.tolerance) {
            let solution = self.solve(&relieved(self.at_most, reliefs, off), Stage::Static)?;
            if let Some(mesh) = &solution.mesh {
                let leads = [lead_before_start(mesh)?, lead_after_end(mesh)?];
                worst = leads.into_iter().fold(worst, f64::max);
            }
        }
        Ok(worst)
    }

    /// Whether a tip touches off the path of contact in motion at the greatest load.
    fn strikes_in_motion(&self, reliefs: &TipReliefs) -> Result<bool, NoRelief> {
        if !self.is_in_motion {
            return Ok(false);
        }
        let inputs = Inputs { method: Method::Dynamic, ..self.at_most.clone() };
        for off in tolerances(self.demand.tolerance) {
            let solution = self.solve(&relieved(&inputs, reliefs, off), Stage::Dynamic)?;
            if let Some(found) = solution.dynamic
                && (found.first_contact_angle.is_some() || found.last_contact_angle.is_some())
            {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn solve(&self, inputs: &Inputs, stage: Stage) -> Result<Solution, NoRelief> {
        Ok(solve_while(inputs, Stages::of(stage), &|_| (self.go_on)(self.part.get()))?)
    }

    /// The greatest load without overlap at rest, relative to the load of the case. `None` if even
    /// [`MOST_LOAD`] times the greatest load of the range has no overlap.
    fn greatest_load(
        &self,
        bench: &PreparedMesh,
        reliefs: &TipReliefs,
    ) -> Result<Option<f64>, NoRelief> {
        const CLOSE: f64 = 1e-3;
        let clears = |times: f64| Ok::<bool, NoRelief>(bench.overlap_under(reliefs, times)? <= 0.0);
        let (mut low, mut high) = (1.0, 2.0);
        while clears(high)? {
            if high >= MOST_LOAD {
                return Ok(None);
            }
            (low, high) = (high, 2.0 * high);
        }
        while high - low > CLOSE * high {
            if !(self.go_on)(self.part.get()) {
                return Err(NoRelief::Refused(Refusal::Stopped));
            }
            let middle = f64::midpoint(low, high);
            if clears(middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Some(self.demand.loads.1 * low))
    }
}

/// Why there is no relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoRelief {
    /// The model refuses the pair.
    Refused(Refusal),
    /// The relief without corner contact exceeds the thickness that the tip can lose.
    ThinTip {
        /// The gear whose tip is too thin.
        gear: &'static str,
        /// Greatest amount that its tip may lose, in m.
        most: f64,
        /// Overlap that remains with this amount, in m.
        overlap: f64,
    },
    /// The path of contact has no room for a relief.
    ShortPath {
        /// The longest relief, in m.
        length: f64,
        /// The least useful length, in m.
        least: f64,
        /// Contact ratio ε.
        ratio: f64,
    },
    /// No relief up to this amount prevents corner contact.
    Beyond {
        /// The greatest amount, in m.
        most: f64,
        /// Overlap that remains with this amount, in m.
        overlap: f64,
    },
    /// In motion the teeth touch before E with every evaluated relief.
    InMotion {
        /// The greatest evaluated amount, in m.
        most: f64,
    },
}

impl From<Refusal> for NoRelief {
    fn from(refusal: Refusal) -> NoRelief {
        NoRelief::Refused(refusal)
    }
}

impl fmt::Display for NoRelief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let um = |length: &f64| format!("{:.1} um", length * 1e6);
        let mm = |length: &f64| format!("{:.2} mm", length * 1e3);
        match self {
            NoRelief::Refused(refusal) => write!(f, "{refusal}; {}", refusal.fix()),
            NoRelief::ThinTip { gear, most, overlap } => write!(
                f,
                "no tip relief prevents corner contact: the {gear} tip is thin, its relief is \
                    limited to {}, and the teeth still overlap by {}; lower the greatest load or \
                    the tolerance",
                um(most),
                um(overlap)
            ),
            NoRelief::ShortPath { length, least, ratio } => write!(
                f,
                "no tip relief prevents corner contact: for this load its length is at least {} (20 times \
                 its amount), and beyond {} {} (contact ratio {ratio:.4}); raise the addendum or the \
                 number of teeth, or lower the greatest load",
                mm(least),
                mm(length),
                if *ratio < 2.0 {
                    "it reaches the contact of a single pair"
                } else {
                    "the unrelieved flanks lose contact under light load"
                }
            ),
            NoRelief::Beyond { most, overlap } => write!(
                f,
                "no tip relief up to {} prevents corner contact: the teeth still overlap by {}; lower \
                 the greatest load or the tolerance",
                um(most),
                um(overlap)
            ),
            NoRelief::InMotion { most } => write!(
                f,
                "no tip relief up to {} prevents corner contact in motion; raise model.damping_ratio or \
                 change operation.speed, or use --method static",
                um(most)
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_demand_is_parsed_from_its_text() {
        assert_eq!(Demand::USUAL.text(), "25..110 %, 5 um");
        assert_eq!(Demand::parse(&Demand::USUAL.text()), Ok(Demand::USUAL));
        let own = Demand::parse("50..100%").expect("a range");
        assert_eq!((own.loads, own.tolerance), ((0.5, 1.0), 5e-6));
        for wrong in ["", "110..25 %", "25..110 %, 5", "0..110 %, 5 um", "25..110 %, 2 mm"] {
            assert!(Demand::parse(wrong).is_err(), "{wrong}");
        }
    }
}
