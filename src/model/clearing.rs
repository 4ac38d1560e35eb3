//! The least tip relief of the driven gear with which the incoming tooth does not touch before E,
//! by each method itself.

use std::cell::RefCell;

use super::budget::{Meter, SEARCH_TRIES, SEARCH_WORK};
use super::dynamic::{Approach, Settings, approach};
use super::inputs::{Gear, Inputs, Method};
use super::load_sharing::on_mesh;
use super::position::printed_relief_to_clear;
use super::static_load::{lead_before_start, places_before_start};
use super::{Outcome, Refusal, Solution};

/// No relief is sought beyond so many times what the pairs yield, the gears deviate and the flank
/// lacks already.
const MOST: f64 = 8.0;

/// Greater reliefs, over the one that was found, with which the tooth must not touch either;
const BEYOND: [f64; 4] = [1.05, 1.25, 1.5, 2.0];
/// and so many evenly up to the last of these where contact is lost, since small causes then have
/// large effects.
const BEYOND_RATTLE: u32 = 50;

/// What was found of the least relief.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clearing {
    /// Tip relief that the driven gear has, in m.
    pub given: f64,
    /// How much more it takes, in m; none where the tooth comes in on time anyhow, or where
    /// `withheld` says why.
    pub relief: Option<f64>,
    /// Why none is known for a tooth that touches.
    pub withheld: Option<Refusal>,
    /// How many balances or motions were tried.
    pub runs: u32,
    /// What they took, in units of the [budget](super::budget).
    pub work: u64,
}

/// The least tip relief of the driven gear, beyond what it has, with which the method finds no
/// contact before E.
///
/// # Formula
/// ```text
/// exact:    Δ,  since e_m counts in full and δ does not depend on it
/// paper:    C with u(Δf − C/√2) = 0 by Eqs. 11-20: at most √2 Δ, since Eq. 1 as printed scales e_m
/// static:   C with max over s ≤ 0 of x(s) + e − S(s) = 0,  x the displacement by the other pairs at rest
/// dynamic:  C with max over t ≤ 0 of x(t) + e − S(t) = 0,  x that of the motion in which the incoming tooth stands off
/// ```
/// where S has the reliefs of both flanks, C among them along its whole length: what the pair ahead
/// lacks at F lets the incoming tooth in earlier, and each base pitch shakes the mesh another way.
///
/// # Valid for
/// With the relief rounded up the tooth comes in on time, in the method's own solve, and with one
/// less by no more than a 20,000th of it (or 1 pm, where that is more) it touches. At rest nothing
/// else can be, as long as the relief ends before F: more relief only delays the tooth. In motion a
/// greater relief may bring it back: four up to twice as much were tried and did not, fifty where
/// contact is lost; what may lie between them is not known.
///
/// # Errors
/// [`Refusal::Stopped`] where `go_on` says no. A search that exceeds its [budget](super::budget)
/// withholds the relief.
pub fn clearing(
    inputs: &Inputs,
    solution: &Solution,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Clearing, Refusal> {
    let search = Search::new();
    let found = match (solution.outcome, inputs.method) {
        (Outcome::NoCornerContact, _) => Ok(None),
        (_, Method::Paper) => printed_relief_to_clear(&inputs.shape(), &solution.kept.deviation),
        (_, Method::Static | Method::Dynamic) => {
            let is_in_motion = inputs.method == Method::Dynamic;
            let tried = |relief: f64| {
                let tried = search
                    .may_go_on()
                    .then(|| relieved(relief, inputs, solution, &search.meter, go_on))
                    .transpose();
                match tried {
                    Ok(Some(tried)) => Ok(search.noted(tried)),
                    Ok(None)
                    | Err(Refusal::MotionTooLong { .. } | Refusal::MotionTooLarge { .. }) => {
                        Err(search.ended(is_in_motion))
                    }
                    Err(refusal) => Err(refusal),
                }
            };
            let deviation = &solution.deviation;
            let size = deviation.loaded_deflection()
                + deviation.equivalent_error.abs()
                + inputs.driven.tip_relief;
            least(&tried, !is_in_motion, MOST * size).map(Some)
        }
        (_, Method::Exact | Method::Auto) => Ok(Some(solution.deviation.total)),
    };
    let (relief, withheld) = match found {
        Ok(relief) => (relief, None),
        Err(Refusal::Stopped) => return Err(Refusal::Stopped),
        Err(refusal) => (None, Some(refusal)),
    };
    Ok(Clearing {
        given: inputs.driven.tip_relief,
        relief,
        withheld,
        runs: search.runs(),
        work: search.meter.spent(),
    })
}

/// The reliefs that were tried, and the work of it.
struct Search {
    meter: Meter,
    tries: RefCell<Vec<Tried>>,
}

impl Search {
    fn new() -> Search {
        Search {
            meter: Meter::new(SEARCH_WORK),
            tries: RefCell::new(Vec::new()),
        }
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

    /// The refusal of a search that goes no further, with the bracket that it has.
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

/// The incoming tooth of the pair with so much more tip relief, in m, at rest or in motion.
fn relieved(
    relief: f64,
    inputs: &Inputs,
    solution: &Solution,
    meter: &Meter,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<Tried, Refusal> {
    let driven = Gear {
        tip_relief: inputs.driven.tip_relief + relief,
        ..inputs.driven.clone()
    };
    let relieved = Inputs {
        driven,
        ..inputs.clone()
    };
    let settings = Settings::of(inputs, solution.reduced_mass);
    on_mesh(&relieved.mesh(), solution, |mesh| {
        meter.spend(mesh.work());
        let Approach { lead, contact_lost } = if inputs.method == Method::Dynamic {
            approach(mesh, &settings, meter, go_on)?
        } else {
            meter.spend(places_before_start(mesh));
            Approach {
                lead: lead_before_start(mesh)?,
                contact_lost: false,
            }
        };
        Ok(Tried {
            relief,
            lead,
            contact_lost,
        })
    })
}

/// A relief and what comes of it.
#[derive(Debug, Clone, Copy)]
struct Tried {
    /// In m.
    relief: f64,
    /// How early the tooth is with it, in m.
    lead: f64,
    contact_lost: bool,
}

/// How a relief is tried.
type Try<'a> = &'a dyn Fn(f64) -> Result<Tried, Refusal>;

/// The least relief with which, and with greater ones, the tooth does not touch.
fn least(tried: Try<'_>, is_monotonic: bool, most: f64) -> Result<f64, Refusal> {
    let mut clear = crossing(tried, tried(0.0)?, most)?;
    while !is_monotonic && let Some(touching) = touching_beyond(tried, clear)? {
        clear = crossing(tried, touching, most)?;
    }
    Ok(clear.relief)
}

/// The greatest of some greater reliefs with which the tooth touches, where there is one.
fn touching_beyond(tried: Try<'_>, clear: Tried) -> Result<Option<Tried>, Refusal> {
    let [.., last] = BEYOND;
    let even = (1..=BEYOND_RATTLE)
        .map(|step| 1.0 + (last - 1.0) * f64::from(step) / f64::from(BEYOND_RATTLE));
    let beyond: Vec<f64> = if clear.contact_lost {
        even.collect()
    } else {
        BEYOND.to_vec()
    };
    for part in beyond.into_iter().rev() {
        let found = tried(part * clear.relief)?;
        if found.lead > 0.0 {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// The first relief found beyond one that touches with which the tooth does not.
fn crossing(tried: Try<'_>, mut touching: Tried, most: f64) -> Result<Tried, Refusal> {
    /// The lead mostly falls by as much as the relief grows; where it falls more slowly, so many
    /// times as far at most.
    const STRIDE: f64 = 4.0;
    /// After three strides reliefs grow by this factor at least.
    const GROWTH: f64 = 1.5;
    let mut stride = 1.0;
    let mut strides = 0;
    while touching.lead > 0.0 {
        if touching.relief > most {
            return Err(Refusal::NoClearing { most });
        }
        let least = if strides < 3 {
            0.0
        } else {
            GROWTH * touching.relief
        };
        let aim = (touching.relief + stride * touching.lead).max(least);
        strides += 1;
        let found = tried(aim + ASIDE * closeness(aim))?;
        if found.lead <= 0.0 {
            return closed_in(tried, touching, found);
        }
        let fall = (touching.lead - found.lead) / (found.relief - touching.relief);
        stride = if fall > 0.0 {
            (1.0 / fall).clamp(1.0, STRIDE)
        } else {
            STRIDE
        };
        touching = found;
    }
    Ok(touching)
}

/// How near to the crossing is near enough, in m.
fn closeness(relief: f64) -> f64 {
    (5e-5 * relief).max(1e-12)
}

/// A try is made so much of the closeness beyond the crossing, so that the last two stand on both
/// its sides.
const ASIDE: f64 = 0.4;

/// The clear one of two reliefs, one that touches and one that does not, as near to each other as
/// is near enough: by secants, aiming a little to that side of the crossing on which the further
/// one is, and by halves where these do not close in.
fn closed_in(tried: Try<'_>, mut touching: Tried, mut clear: Tried) -> Result<Tried, Refusal> {
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
        let aim = touching.relief
            + if is_slow {
                0.5 * width
            } else {
                before * width + aside
            };
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

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// The least relief for a lead that is known, and how many tries it took.
    fn found(lead: impl Fn(f64) -> f64, contact_lost: bool) -> (Result<f64, Refusal>, u32) {
        let tries = Cell::new(0);
        let tried = |relief: f64| {
            tries.set(tries.get() + 1);
            Ok(Tried {
                relief,
                lead: lead(relief),
                contact_lost,
            })
        };
        (least(&tried, false, 1e-3), tries.get())
    }

    #[test]
    fn a_lead_that_falls_is_followed_to_its_end_in_few_tries() {
        type Lead = Box<dyn Fn(f64) -> f64>;
        let leads: [(&str, f64, Lead); 5] = [
            (
                "as the relief grows",
                20e-6,
                Box::new(|relief| 20e-6 - relief),
            ),
            (
                "more slowly",
                100e-6,
                Box::new(|relief| 0.2 * (100e-6 - relief)),
            ),
            ("faster", 20e-6, Box::new(|relief| 3.0 * (20e-6 - relief))),
            (
                "at last not at all",
                20e-6,
                Box::new(|relief| (20e-6 - relief).max(-1e-9)),
            ),
            (
                "in bends",
                20e-6,
                Box::new(|relief| {
                    20e-6 - relief + 4e-6 * (relief * 1e6 * std::f64::consts::PI / 20.0).sin()
                }),
            ),
        ];
        for (name, end, lead) in leads {
            let (relief, tries) = found(lead, false);
            let relief = relief.unwrap();
            assert!(
                relief >= end && relief - end <= closeness(end),
                "{name}: {relief:e}"
            );
            assert!(tries <= 20, "{name}: {tries}");
        }
    }

    #[test]
    fn a_touch_with_more_relief_is_not_overlooked_where_it_is_looked_for() {
        let lead = |back: std::ops::Range<f64>| {
            move |relief: f64| {
                if back.contains(&relief) {
                    1e-6
                } else {
                    20e-6 - relief
                }
            }
        };
        let (relief, _) = found(lead(29e-6..31e-6), false);
        assert!(
            (relief.unwrap() - 31e-6).abs() < closeness(31e-6),
            "{relief:?}"
        );
        let narrow = || lead(33.0e-6..33.8e-6);
        assert!(found(narrow(), false).0.unwrap() < 21e-6);
        assert!((found(narrow(), true).0.unwrap() - 33.8e-6).abs() < closeness(34e-6));
    }

    #[test]
    fn where_no_relief_stops_it_that_is_said() {
        let (none, tries) = found(|_| 1e-6, false);
        assert_eq!(none.unwrap_err().code(), "no-clearing-relief");
        assert!(tries < 30, "{tries}");
        assert!(found(|relief| 1e-6 + 0.1 * relief, false).0.is_err());
    }
}
