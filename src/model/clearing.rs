//! The required additional tip relief: the least relief of the driven gear with which a method finds
//! no contact before E; and the gap of a tooth without contact before E.

use std::cell::RefCell;
use std::sync::Arc;

use super::budget::{Meter, SEARCH_TRIES, SEARCH_WORK};
use super::dynamic::{Approach, Settings, approach};
use super::face::FaceInputs;
use super::inputs::{Inputs, Method};
use super::mesh::build::Meshes;
use super::mesh::{Mesh, MeshInputs};
use super::position::printed_relief_to_clear;
use super::relief::Reliefs;
use super::slices::{self, Face};
use super::static_load::{StaticLoad, lead_at_rest, lead_work};
use super::{Outcome, Refusal, Solution, Stage};
use crate::numeric::steps;

/// Limit of the search, relative to the sum of deflection, deviation and given relief.
const MOST: f64 = 8.0;

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
    /// Given and required additional tip relief of the driver, in m, with which its tip does not touch
    /// after B at rest. `None` without contact there, or if the relief is unknown.
    pub at_exit: Option<(f64, f64)>,
    /// Whether a tooth without contact before E has contact there with that relief of the driver.
    pub closes_gap: bool,
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
/// incoming tooth. The relief of the driver follows from the same balance over s ≥ B. S includes the
/// reliefs of both flanks, with C along its whole length. Relief on the pair ahead at F makes the
/// incoming tooth earlier, and each base pitch excites the mesh differently.
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
    inputs: &Inputs,
    solution: &Solution,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Clearing, Refusal> {
    let meter = Meter::new(SEARCH_WORK);
    let (entry, exit) = (Search::new(false, &meter), Search::new(true, &meter));
    let (given, of_driver) = (inputs.driven.tip_relief, inputs.driver.tip_relief);
    let touches_after = |load: &StaticLoad| load.last_contact_angle.is_some();
    let is_moving = inputs.method == Method::Dynamic;
    let motion = is_moving.then(|| Settings::approach(inputs, solution.reduced_mass));
    let (mut at_exit, mut closes_gap) = (None, false);
    if solution.static_load.as_ref().is_some_and(touches_after) {
        let found = exit.least(&inputs.mesh(), None, inputs.face(), solution, go_on);
        let relief = Refusal::unless_stopped(found)?.ok().filter(|relief| *relief > 0.0);
        at_exit = relief.map(|relief| (of_driver, enough(relief, of_driver)));
    }
    if let (Outcome::NoCornerContact, Some((_, more))) = (solution.outcome, at_exit) {
        let mut mesh = inputs.mesh();
        mesh.reliefs.driver.tip += more;
        let pair = (&mesh, motion.as_ref(), inputs.face());
        let found = Refusal::unless_stopped(entry.relieved(0.0, pair, solution, go_on))?;
        closes_gap = found.is_ok_and(|tried| tried.lead > 0.0);
    }
    let found = match (solution.outcome, inputs.method) {
        (Outcome::NoCornerContact, _) => Ok(None),
        (_, Method::Exact | Method::Auto) => Ok(Some(solution.deviation.total)),
        (_, Method::Paper) => printed_relief_to_clear(&inputs.shape(), &solution.kept.deviation),
        (_, Method::Static | Method::Dynamic) => {
            entry.least(&inputs.mesh(), motion.as_ref(), inputs.face(), solution, go_on).map(Some)
        }
    };
    let (relief, withheld) = match Refusal::unless_stopped(found)? {
        Ok(relief) => (relief.map(|relief| enough(relief, given)), None),
        Err(refusal) => (None, Some(refusal)),
    };
    let runs = entry.runs() + exit.runs();
    Ok(Clearing { given, relief, withheld, at_exit, closes_gap, runs, work: meter.spent() })
}

/// The relief, rounded up so far that the sum with the given relief is enough after its conversion
/// to any unit and back. Each of sum, conversion and reading rounds the sum once.
fn enough(relief: f64, given: f64) -> f64 {
    relief + 4.0 * f64::EPSILON * (relief + given)
}

/// The tested reliefs and the work of the search.
struct Search<'a> {
    /// Whether the driver's tip after B is searched in place of the driven tip before E.
    at_exit: bool,
    meter: &'a Meter,
    tries: RefCell<Vec<Tried>>,
    /// The mesh of the last relief, which is like that of the next.
    last: RefCell<Option<Arc<Mesh>>>,
}

impl<'a> Search<'a> {
    fn new(at_exit: bool, meter: &'a Meter) -> Search<'a> {
        Search { at_exit, meter, tries: RefCell::default(), last: RefCell::default() }
    }

    /// The least additional relief, in m, by the static balance or by a motion.
    fn least(
        &self,
        mesh: &MeshInputs,
        motion: Option<&Settings>,
        face: Option<FaceInputs>,
        solution: &Solution,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<f64, Refusal> {
        let tried = |relief: f64| {
            if self.runs() >= SEARCH_TRIES || !self.meter.spend(0) {
                return Err(self.ended(motion.is_some()));
            }
            let tried = self.relieved(relief, (mesh, motion, face), solution, go_on);
            if let Ok(tried) = tried {
                self.tries.borrow_mut().push(tried);
            }
            tried.map_err(|refusal| match refusal {
                Refusal::MotionTooLong { .. } | Refusal::MotionTooLarge { .. } => {
                    self.ended(motion.is_some())
                }
                other => other,
            })
        };
        let deviation = &solution.deviation;
        let reliefs = &mesh.reliefs;
        let given = if self.at_exit { reliefs.driver.tip } else { reliefs.driven.tip };
        let size = deviation.loaded_deflection() + deviation.equivalent_error.abs() + given;
        least(&tried, motion.is_none(), MOST * size)
    }

    /// The lead of the incoming tooth with `relief` more tip relief, in m, in static balance or in
    /// motion.
    fn relieved(
        &self,
        relief: f64,
        (mesh, motion, face): (&MeshInputs, Option<&Settings>, Option<FaceInputs>),
        solution: &Solution,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Result<Tried, Refusal> {
        let mut relieved = *mesh;
        let Reliefs { driver, driven, .. } = &mut relieved.reliefs;
        (if self.at_exit { driver } else { driven }).tip += relief;
        let last = self.last.take().or_else(|| solution.mesh.clone());
        Meshes::new(&relieved, solution, last.as_ref(), None).find(|mesh| {
            self.last.replace(Some(Arc::clone(mesh)));
            let meter = self.meter;
            meter.spend(mesh.work());
            let at_rest = |lead: f64| Approach { lead, contact_lost: false };
            let over_face =
                face.map(|face| Face::new(&face, &solution.geometry, mesh)).transpose()?;
            let Approach { lead, contact_lost } = match (over_face, motion) {
                (Some(face), Some(motion)) => slices::motion::approach(&face, motion, go_on)?,
                (Some(face), None) => at_rest(face.lead_at_rest(self.at_exit)?),
                (None, Some(motion)) => approach(mesh, motion, meter, go_on)?,
                (None, None) => {
                    meter.spend(lead_work(mesh, self.at_exit));
                    at_rest(lead_at_rest(mesh, self.at_exit)?)
                }
            };
            Ok(Tried { relief, lead, contact_lost })
        })
    }

    fn runs(&self) -> u32 {
        self.tries.borrow().len() as u32
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

/// Larger reliefs, relative to the result, that the search tests for contact.
const BEYOND: [f64; 4] = [1.05, 1.25, 1.5, 2.0];
/// Number of evenly spaced larger reliefs tested if contact is lost, because small changes then
/// have large effects.
const BEYOND_RATTLE: usize = 50;

/// A tested relief and its result.
#[derive(Debug, Clone, Copy)]
struct Tried {
    /// Additional relief, in m.
    relief: f64,
    /// How early the tooth is, in m; above 0 the tooth touches before E.
    lead: f64,
    contact_lost: bool,
}

/// Solves the pair with an additional relief in m.
type Try<'a> = &'a dyn Fn(f64) -> Result<Tried, Refusal>;

/// The least relief without contact. Unless `is_monotonic`, tests larger reliefs as well.
fn least(tried: Try<'_>, is_monotonic: bool, most: f64) -> Result<f64, Refusal> {
    let mut clear = crossing(tried, tried(0.0)?, most)?;
    while !is_monotonic && let Some(touching) = touching_beyond(tried, clear)? {
        clear = crossing(tried, touching, most)?;
    }
    Ok(clear.relief)
}

/// The greatest of the tested larger reliefs with contact.
fn touching_beyond(tried: Try<'_>, clear: Tried) -> Result<Option<Tried>, Refusal> {
    let [.., last] = BEYOND;
    let even = steps(1.0, last, BEYOND_RATTLE).skip(1);
    let beyond: Vec<f64> = if clear.contact_lost { even.collect() } else { BEYOND.to_vec() };
    for part in beyond.into_iter().rev() {
        let found = tried(part * clear.relief)?;
        if found.lead > 0.0 {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// A relief without contact, close to a relief with contact below it.
fn crossing(tried: Try<'_>, mut touching: Tried, most: f64) -> Result<Tried, Refusal> {
    /// The lead usually falls by as much as the relief grows. Limit of the stride for a lead that
    /// falls more slowly.
    const STRIDE: f64 = 4.0;
    /// Least growth factor of the relief after three strides.
    const GROWTH: f64 = 1.5;
    let mut stride = 1.0;
    let mut strides = 0;
    while touching.lead > 0.0 {
        if touching.relief > most {
            return Err(Refusal::NoClearing { most });
        }
        let least = if strides < 3 { 0.0 } else { GROWTH * touching.relief };
        let aim = (touching.relief + stride * touching.lead).max(least);
        strides += 1;
        let found = tried(aim + ASIDE * closeness(aim))?;
        if found.lead <= 0.0 {
            return narrow_bracket(tried, touching, found);
        }
        let fall = (touching.lead - found.lead) / (found.relief - touching.relief);
        stride = if fall > 0.0 { (1.0 / fall).clamp(1.0, STRIDE) } else { STRIDE };
        touching = found;
    }
    Ok(touching)
}

/// Width of the final bracket, in m.
fn closeness(relief: f64) -> f64 {
    (5e-5 * relief).max(1e-12)
}

/// Offset of a test from the expected crossing, relative to the final width. The last two tests are
/// then on both sides of the crossing.
const ASIDE: f64 = 0.4;

/// The relief without contact at the end of the search in a bracket. Uses secants that aim slightly
/// beyond the crossing, towards the farther end, and halves the bracket if the secants are slow.
fn narrow_bracket(tried: Try<'_>, mut touching: Tried, mut clear: Tried) -> Result<Tried, Refusal> {
    const PATIENCE: usize = 3;
    let mut widths = [f64::INFINITY; PATIENCE];
    loop {
        let (width, near) = (clear.relief - touching.relief, closeness(clear.relief));
        if width <= near {
            return Ok(clear);
        }
        let before = touching.lead / (touching.lead - clear.lead);
        let aside = ASIDE * near * if before < 0.5 { 1.0 } else { -1.0 };
        let is_slow = width > 0.5 * widths[0];
        let aim = touching.relief + if is_slow { 0.5 * width } else { before * width + aside };
        widths.rotate_left(1);
        widths[PATIENCE - 1] = width;
        let found = tried(aim.clamp(touching.relief + 0.1 * near, clear.relief - 0.1 * near))?;
        if found.lead > 0.0 {
            touching = found;
        } else {
            clear = found;
        }
    }
}

impl Solution {
    /// Whether the driver's tip touches after B, by the load at rest or the motion of the method; `None`
    /// if its stage did not run.
    pub fn exit_outcome(&self) -> Option<Outcome> {
        let solution = self.having(Stage::Static);
        let last = match solution.method {
            Method::Static => solution.static_load.as_ref()?.last_contact_angle,
            Method::Dynamic => solution.dynamic.as_ref()?.last_contact_angle,
            Method::Paper | Method::Exact | Method::Auto => return None,
        };
        Some(if last.is_some() { Outcome::CornerContact } else { Outcome::NoCornerContact })
    }

    /// The least gap before E, in m. `None` if a tooth touches before E, or if the method does not
    /// compute the gap.
    ///
    /// # Formula
    /// ```text
    /// exact, paper:  −Δ
    /// static:        −max over s ≤ 0 of x(s) + e − S(s)
    /// dynamic:       −max over t ≤ 0 of x(t) + e − S(t)
    /// ```
    /// x is the displacement by the other pairs, in static balance or in the motion without contact
    /// of the incoming pair. The base pitch deviation moves only the incoming tooth. In every
    /// method an increase of f_pb by the gap/√2 closes the gap.
    pub fn margin(&self) -> Option<f64> {
        if self.outcome == Outcome::CornerContact {
            return None;
        }
        let margin = match self.method {
            Method::Dynamic => self.dynamic.as_ref()?.least_gap?,
            Method::Static => -self.lead_at_rest()?,
            _ => -self.deviation.total,
        };
        (margin >= 0.0).then_some(margin)
    }

    /// How early the static load makes the tooth, in m. A negative value is the gap that is left.
    /// `None` if the mesh is not computed, or if the tooth touches before E at a place of the face.
    pub fn lead_at_rest(&self) -> Option<f64> {
        match (&self.face_load, &self.face_motion) {
            (Some(face), _) => face.least_gap.map(|gap| -gap),
            (None, Some(_)) => None,
            (None, None) => lead_at_rest(self.mesh.as_ref()?, false).ok(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// The least relief for a given lead, and the number of tests.
    fn found(lead: impl Fn(f64) -> f64, contact_lost: bool) -> (Result<f64, Refusal>, u32) {
        let tries = Cell::new(0);
        let tried = |relief: f64| {
            tries.set(tries.get() + 1);
            Ok(Tried { relief, lead: lead(relief), contact_lost })
        };
        (least(&tried, false, 1e-3), tries.get())
    }

    #[test]
    fn the_crossing_of_a_falling_lead_is_found_with_few_tests() {
        type Lead = Box<dyn Fn(f64) -> f64>;
        let leads: [(&str, f64, Lead); 5] = [
            ("as fast as the relief grows", 20e-6, Box::new(|relief| 20e-6 - relief)),
            ("more slowly", 100e-6, Box::new(|relief| 0.2 * (100e-6 - relief))),
            ("faster", 20e-6, Box::new(|relief| 3.0 * (20e-6 - relief))),
            ("constant at the end", 20e-6, Box::new(|relief| (20e-6 - relief).max(-1e-9))),
            (
                "with oscillations",
                20e-6,
                Box::new(|relief| {
                    20e-6 - relief + 4e-6 * (relief * 1e6 * std::f64::consts::PI / 20.0).sin()
                }),
            ),
        ];
        for (name, end, lead) in leads {
            let (relief, tries) = found(lead, false);
            let relief = relief.unwrap();
            assert!(relief >= end && relief - end <= closeness(end), "{name}: {relief:e}");
            assert!(tries <= 20, "{name}: {tries}");
        }
    }

    #[test]
    fn contact_at_a_larger_tested_relief_is_found() {
        let lead = |back: std::ops::Range<f64>| {
            move |relief: f64| {
                if back.contains(&relief) { 1e-6 } else { 20e-6 - relief }
            }
        };
        let (relief, _) = found(lead(29e-6..31e-6), false);
        assert!((relief.unwrap() - 31e-6).abs() < closeness(31e-6), "{relief:?}");
        let narrow = || lead(33.0e-6..33.8e-6);
        assert!(found(narrow(), false).0.unwrap() < 21e-6);
        assert!((found(narrow(), true).0.unwrap() - 33.8e-6).abs() < closeness(34e-6));
    }

    #[test]
    fn a_lead_that_no_relief_removes_is_refused() {
        let (none, tries) = found(|_| 1e-6, false);
        assert_eq!(none.unwrap_err().code(), "no-clearing-relief");
        assert!(tries < 30, "{tries}");
        assert!(found(|relief| 1e-6 + 0.1 * relief, false).0.is_err());
    }
}
