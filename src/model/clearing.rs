//! The required additional tip relief: the least relief of the driven gear with which a method
//! finds no contact before E.

mod search;

use std::cell::RefCell;

use super::budget::{Meter, SEARCH_TRIES, SEARCH_WORK};
use super::dynamic::{Approach, MotionInputs, approach};
use super::geometry::PairShape;
use super::inputs::{Inputs, Method};
use super::load_sharing::on_mesh;
use super::mesh::MeshInputs;
use super::position::printed_relief_to_clear;
use super::static_load::{lead_before_start, places_before_start};
use super::{Outcome, Refusal, Solution};
use search::{Tried, least};

/// Limit of the search, relative to the sum of deflection, deviation and given relief.
const MOST: f64 = 8.0;

/// Inputs of the required additional tip relief, besides deviation, load and masses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearingInputs {
    /// Given tip relief of the driven gear, in m.
    pub tip_relief: f64,
    /// How the method tests a relief.
    pub trial: Trial,
}

/// How a method tests whether a relief prevents contact before E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trial {
    /// By the deviation.
    Deviation,
    /// By the printed equations, with this shape of the pair.
    Printed(PairShape),
    /// By the static balance.
    AtRest(MeshInputs),
    /// By the motion.
    InMotion(MeshInputs, MotionInputs),
}

impl ClearingInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> ClearingInputs {
        ClearingInputs {
            tip_relief: inputs.driven.tip_relief,
            trial: match inputs.method {
                Method::Paper => Trial::Printed(inputs.shape()),
                Method::Static => Trial::AtRest(inputs.mesh()),
                Method::Dynamic => Trial::InMotion(inputs.mesh(), MotionInputs::approach(inputs)),
                Method::Exact | Method::Auto => Trial::Deviation,
            },
        }
    }
}

/// Result of the search for the required additional tip relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearing {
    /// Given tip relief of the driven gear, in m.
    pub given: f64,
    /// The required additional tip relief, in m. `None` without contact before E, or with the
    /// reason `withheld`.
    pub relief: Option<f64>,
    /// The reason why the relief of a tooth with contact is unknown.
    pub withheld: Option<Refusal>,
    /// Number of balances or motions solved.
    pub runs: u32,
    /// Work of the search, in units of the [budget](super::budget).
    pub work: u64,
}

/// The least tip relief of the driven gear, in addition to the given relief, with which the method
/// finds no contact before E.
///
/// # Formula
/// ```text
/// exact:    Δ,  because e_m counts in full and δ is independent of e_m; rounded up in the last digits
/// paper:    C with u(Δf − C/√2) = 0 by Eqs. 11-20;  at most √2 Δ, because Eq. 1 scales e_m
/// static:   C with max over s ≤ 0 of x(s) + e − S(s) = 0
/// dynamic:  C with max over t ≤ 0 of x(t) + e − S(t) = 0
/// ```
/// x is the displacement by the other pairs, in static balance or in the motion without the
/// incoming tooth. S includes the reliefs of both flanks, with C along its whole length. Relief on
/// the pair ahead at F makes the incoming tooth earlier, and each base pitch excites the mesh
/// differently.
///
/// # Valid for
/// With the relief rounded up, the solve of the method finds no contact before E. With a relief
/// smaller by at most a 20,000th (or by 1 pm, if that is larger), the tooth touches. In static
/// balance this relief is unique if the relief ends before F, because more relief only delays the
/// tooth. In motion a larger relief can cause contact again. The search tests four larger reliefs
/// up to twice the result, and fifty if contact is lost. Reliefs between the tested reliefs can
/// still cause contact.
///
/// # Errors
/// [`Refusal::Stopped`] if `go_on` returns false. A search beyond its [budget](super::budget) sets
/// `withheld`.
pub fn clearing(
    inputs: &ClearingInputs,
    solution: &Solution,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Clearing, Refusal> {
    let search = Search::new();
    let found = match (solution.outcome, &inputs.trial) {
        (Outcome::NoCornerContact, _) => Ok(None),
        (_, Trial::Deviation) => Ok(Some(solution.deviation.total)),
        (_, Trial::Printed(shape)) => printed_relief_to_clear(shape, &solution.kept.deviation),
        (_, Trial::AtRest(mesh)) => {
            search.least(inputs.tip_relief, (mesh, None), solution, go_on).map(Some)
        }
        (_, Trial::InMotion(mesh, motion)) => {
            search.least(inputs.tip_relief, (mesh, Some(motion)), solution, go_on).map(Some)
        }
    };
    let (relief, withheld) = match found {
        Ok(relief) => (relief.map(|relief| enough(relief, inputs.tip_relief)), None),
        Err(Refusal::Stopped) => return Err(Refusal::Stopped),
        Err(refusal) => (None, Some(refusal)),
    };
    Ok(Clearing {
        given: inputs.tip_relief,
        relief,
        withheld,
        runs: search.runs(),
        work: search.meter.spent(),
    })
}

/// The relief, rounded up so far that the sum with the given relief is enough after its conversion
/// to any unit and back. Each of sum, conversion and reading rounds the sum once.
fn enough(relief: f64, given: f64) -> f64 {
    relief + 4.0 * f64::EPSILON * (relief + given)
}

/// The tested reliefs and the work of the search.
struct Search {
    meter: Meter,
    tries: RefCell<Vec<Tried>>,
}

impl Search {
    fn new() -> Search {
        Search { meter: Meter::new(SEARCH_WORK), tries: RefCell::new(Vec::new()) }
    }

    /// The least additional relief, in m, by the static balance or by a motion.
    fn least(
        &self,
        given: f64,
        (mesh, motion): (&MeshInputs, Option<&MotionInputs>),
        solution: &Solution,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<f64, Refusal> {
        let tried = |relief: f64| {
            let tried = self
                .may_go_on()
                .then(|| relieved(relief, (mesh, motion), solution, &self.meter, go_on))
                .transpose();
            match tried {
                Ok(Some(tried)) => Ok(self.noted(tried)),
                Ok(None) | Err(Refusal::MotionTooLong { .. } | Refusal::MotionTooLarge { .. }) => {
                    Err(self.ended(motion.is_some()))
                }
                Err(refusal) => Err(refusal),
            }
        };
        let deviation = &solution.deviation;
        let size = deviation.loaded_deflection() + deviation.equivalent_error.abs() + given;
        least(&tried, motion.is_none(), MOST * size)
    }

    fn runs(&self) -> u32 {
        self.tries.borrow().len() as u32
    }

    fn may_go_on(&self) -> bool {
        self.runs() < SEARCH_TRIES && self.meter.spend(0)
    }

    fn noted(&self, tried: Tried) -> Tried {
        self.tries.borrow_mut().push(tried);
        tried
    }

    /// The refusal of a search beyond its budget, with the bracket found so far.
    fn ended(&self, in_motion: bool) -> Refusal {
        let tries = self.tries.borrow();
        let touching = tries.iter().filter(|tried| tried.lead > 0.0);
        let touching = touching.map(|tried| tried.relief).reduce(f64::max);
        let clear = tries.iter().filter(|tried| {
            tried.lead <= 0.0 && touching.is_none_or(|touching| tried.relief > touching)
        });
        Refusal::SearchTooLong {
            tries: tries.len() as u32,
            in_motion,
            touching,
            clear: clear.map(|tried| tried.relief).reduce(f64::min),
        }
    }
}

/// The lead of the incoming tooth with `relief` more tip relief, in m, in static balance or in
/// motion.
fn relieved(
    relief: f64,
    (mesh, motion): (&MeshInputs, Option<&MotionInputs>),
    solution: &Solution,
    meter: &Meter,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Tried, Refusal> {
    let mut relieved = *mesh;
    relieved.reliefs.driven.tip += relief;
    on_mesh(&relieved, solution, solution.mesh.as_ref(), |mesh| {
        meter.spend(mesh.work());
        let Approach { lead, contact_lost } = if let Some(motion) = motion {
            approach(mesh, &motion.settings(solution.reduced_mass), meter, go_on)?
        } else {
            meter.spend(places_before_start(mesh));
            Approach { lead: lead_before_start(mesh)?, contact_lost: false }
        };
        Ok(Tried { relief, lead, contact_lost })
    })
}
