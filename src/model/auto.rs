//! The method `auto`: chooses the fastest method within the tolerance from the closed-form results.

use std::f64::consts::PI;
use std::fmt;

use super::dynamic::Dynamic;
use super::inputs::{Inputs, Method};
use super::mesh::Mesh;
use super::stage::{Stage, Stages};
use super::static_load::{StaticLoad, balance, static_load};
use super::stations::Spacing;
use super::{Outcome, Refusal, Solution};
use crate::numeric::decimal::significant;

/// The methods to choose from, fastest first.
pub const METHODS: [Method; 3] = [Method::Exact, Method::Static, Method::Dynamic];

/// The chosen method and the reason.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// `exact`, `static` or `dynamic`.
    pub method: Method,
    /// The reason for the method.
    pub reason: Reason,
    /// The effect of inertia on the shared load, if it decided the choice.
    pub inertia: Option<Inertia>,
}

/// Relative effect of inertia on the shared load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Inertia {
    /// An upper bound that is small enough to neglect inertia.
    AtMost(f64),
    /// A lower bound that is large enough to require inertia.
    AtLeast(f64),
    /// A lower and an upper bound that do not decide; a trial motion is needed.
    Between(f64, f64),
    /// The value from a trial motion.
    Tried(f64),
}

/// The reason for the choice of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reason {
    /// The closed form finds no contact before E, so that it has no force.
    NoContact,
    /// The impact ends before E, and the load adds little to the impact force.
    FreeImpact,
    /// The closed form has no result.
    Refused,
    /// The load of the pair varies over the face width.
    OverFace,
    /// The pair ahead loses contact.
    ContactLost,
    /// The impact lasts longer than the time from D to E: both times, in s.
    Outlasts(f64, f64),
    /// The impulse ratio is outside 1 to 2.
    Impulse(f64),
    /// The ratio of the shared load to the impact force exceeds the tolerance.
    LoadShared(f64),
}

/// Chooses the method of a pair from the results of the closed form.
///
/// # Formula
/// ```text
/// exact:    T_S <= t_DE,  1 <= κ <= 2,  δ >= Δf  and  F0/F_S <= within
/// static:   otherwise if  most · T_n/(π t) <= within,  T_n = 2 π √(M q/b),  t = t_DE
/// dynamic:  otherwise if  least · T_n/(π t) > within
/// ```
/// A load transferred within a time t leaves an oscillation of at most T_n/(π t) of the load in a
/// mesh with the period T_n: the response of an oscillator to a ramp.
/// `Reason::static_error_bounds` gives the least and the most part of this oscillation that `static`
/// can miss, measured over 300 pairs. Between both bounds a trial motion decides. Without contact
/// by the closed form, which has no force then, and for a pair in slices, a trial motion always
/// decides.
///
/// The choice depends on the pair alone, not on the limits and the selected quantities.
pub fn choose(inputs: &Inputs, closed_form: &Result<Solution, Refusal>) -> Choice {
    match closed_form {
        Err(Refusal::NotOverFace { .. }) => {
            let inertia = Some(Inertia::Between(0.0, f64::INFINITY));
            Choice { method: Method::Dynamic, reason: Reason::OverFace, inertia }
        }
        Err(_) => Choice { method: Method::Dynamic, reason: Reason::Refused, inertia: None },
        Ok(solution) => match solution.outcome {
            Outcome::NoCornerContact => sharing(inputs, Reason::NoContact, 1.0),
            Outcome::CornerContact => with_contact(inputs, solution),
        },
    }
}

/// The method that computes the needed stages which `method` lacks, if it lacks any: the fastest
/// that has them all, otherwise `dynamic`.
pub(super) fn beside(inputs: &Inputs, method: Method) -> Option<Method> {
    let missing = inputs.needs.except(method.stages());
    let has_all = |method: &Method| method.stages().covers(missing);
    (missing != Stages::NONE).then(|| METHODS.into_iter().find(has_all).unwrap_or(Method::Dynamic))
}

fn with_contact(inputs: &Inputs, solution: &Solution) -> Choice {
    let (Some(impact), Some(velocity)) = (&solution.impact, &solution.velocity) else {
        return Choice { method: Method::Dynamic, reason: Reason::Refused, inertia: None };
    };
    let deviation = &solution.deviation;
    let load = solution.mesh_force / impact.force;
    let reason = if deviation.combined_deflection < deviation.equivalent_error {
        Reason::ContactLost
    } else if impact.duration > velocity.transit_time {
        Reason::Outlasts(impact.duration, velocity.transit_time)
    } else if !impact.is_possible() {
        Reason::Impulse(impact.impulse_ratio)
    } else if load > inputs.within {
        Reason::LoadShared(load)
    } else {
        return Choice { method: Method::Exact, reason: Reason::FreeImpact, inertia: None };
    };
    sharing(inputs, reason, swing(2.0 * impact.duration_spring, velocity.transit_time))
}

/// `static` if the effect of inertia is small. Otherwise `dynamic`, also if a trial must decide.
fn sharing(inputs: &Inputs, reason: Reason, swing: f64) -> Choice {
    let (least, most) = reason.static_error_bounds();
    let inertia = match (least * swing, most * swing) {
        (_, most) if most <= inputs.within => Inertia::AtMost(most),
        (least, _) if least > inputs.within => Inertia::AtLeast(least),
        (least, most) => Inertia::Between(least, most),
    };
    let method =
        if matches!(inertia, Inertia::AtMost(_)) { Method::Static } else { Method::Dynamic };
    Choice { method, reason, inertia: Some(inertia) }
}

impl Choice {
    /// Whether a trial motion must decide.
    pub fn is_open(&self) -> bool {
        matches!(self.inertia, Some(Inertia::Between(..)))
    }

    /// The choice after a trial motion, with the relative effect `adds` of inertia.
    pub fn tried(self, inputs: &Inputs, adds: f64) -> Choice {
        /// The difference is sampled and can be slightly larger between the samples.
        const SURE: f64 = 0.9;
        let method = if adds <= SURE * inputs.within { Method::Static } else { Method::Dynamic };
        Choice { method, inertia: Some(Inertia::Tried(adds)), ..self }
    }
}

impl Reason {
    /// The least and the greatest difference of `static`, as parts of the oscillation. Over 300
    /// random pairs `static` differed by 0.04 to 3.3 times the oscillation if the pair ahead stays
    /// in contact, and by 0.48 to 23.5 times if the pair ahead loses contact.
    fn static_error_bounds(&self) -> (f64, f64) {
        match self {
            Reason::ContactLost => (0.4, 24.0),
            // No oscillation was measured.
            Reason::NoContact => (0.0, f64::INFINITY),
            _ => (0.04, 3.3),
        }
    }
}

/// The oscillation after a load transfer within `time`, relative to the load.
fn swing(period: f64, time: f64) -> f64 {
    (period / (PI * time)).min(1.0)
}

/// The stages of the closed form that the choice reads.
pub(super) const READS: Stages = Stages::of(Stage::Impact);

/// The inputs for the chosen method.
pub fn taken(inputs: &Inputs, method: Method) -> Inputs {
    /// Tolerance of the peak force relative to `model.within`.
    const NUMERICAL: f64 = 0.02;
    /// Least tolerance between stations relative to `model.within`.
    const READING: f64 = 0.1;
    /// Enough to find the greatest difference of the methods.
    const SAMPLES: usize = 256;
    Inputs {
        method,
        tolerance: (NUMERICAL * inputs.within).max(1e-12),
        approach_samples: SAMPLES,
        station_tolerance: inputs.station_tolerance.max(READING * inputs.within),
        ..inputs.clone()
    }
}

/// The relative difference between motion and static balance: the greatest difference of first
/// contact, peaks and force from the first contact to E, relative to the motion; of a pair in slices,
/// whose balance is known, of first contact and peaks. `None` if the mesh, the motion or the static
/// balance is absent.
pub(super) fn added_by_inertia(moved: &Solution, still: Option<&Solution>) -> Option<f64> {
    let (mesh, motion) = (moved.mesh.as_deref()?, moved.dynamic.as_ref()?);
    match still {
        Some(still) => Some(difference(mesh, still.static_load.as_ref()?, motion)),
        // These values need no stations.
        None => Some(difference(mesh, &static_load(mesh, Spacing::Even(1)).ok()?, motion)),
    }
}

fn difference(mesh: &Mesh, still: &StaticLoad, moved: &Dynamic) -> f64 {
    /// Part of the peak force below which a contact that only the motion has counts as none.
    const TOUCH: f64 = 1e-4;
    let is_force =
        still.first_contact_angle.is_some() || moved.peak_approach_force > TOUCH * moved.peak_force;
    let first_moved = moved.first_contact_angle.filter(|_| is_force);
    let angles = match (still.first_contact_angle, first_moved) {
        (Some(still), Some(moved)) => (still / moved - 1.0).abs(),
        (None, None) => 0.0,
        _ => 1.0,
    };
    let over = |difference: f64, force: f64| {
        if difference == 0.0 { 0.0 } else { (difference / force).abs() }
    };
    let peaks = over(still.peak_force - moved.peak_force, moved.peak_force);
    let approach = first_moved.map_or(0.0, |_| {
        over(still.approach_force - moved.peak_approach_force, moved.peak_approach_force)
    });
    let off = |&(place, force): &(f64, f64)| {
        over(force - balance(mesh, place, place).force, moved.peak_force)
    };
    moved.approach.iter().map(off).fold(angles.max(peaks).max(approach), f64::max)
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "auto chose {}: {}", self.method.name(), self.reason)?;
        self.inertia
            .map_or(Ok(()), |inertia| write!(f, "; inertia changes the shared load by {inertia}"))
    }
}

impl fmt::Display for Inertia {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |part: f64| significant(100.0 * part, 2);
        match *self {
            Inertia::AtMost(most) => write!(f, "at most {} %", percent(most)),
            Inertia::AtLeast(least) => write!(f, "at least {} %", percent(least)),
            Inertia::Between(least, _) => write!(f, "{} % or more", percent(least)),
            Inertia::Tried(adds) => write!(f, "{} % (trial motion)", percent(adds)),
        }
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micro = |time: f64| significant(time * 1e6, 4);
        match self {
            Reason::NoContact => f.write_str("the closed form finds no contact and no force"),
            Reason::FreeImpact => {
                f.write_str("the impact ends before E, and the load adds little to it")
            }
            Reason::Refused => f.write_str("the closed form has no solution"),
            Reason::OverFace => f.write_str("the load varies over the face width"),
            Reason::ContactLost => f.write_str("by the closed form the pair ahead loses contact"),
            Reason::Outlasts(lasts, way) => {
                write!(
                    f,
                    "the impact lasts {} us, longer than the {} us from D to E",
                    micro(*lasts),
                    micro(*way)
                )
            }
            Reason::Impulse(ratio) => write!(f, "the impulse ratio is {}", significant(*ratio, 4)),
            Reason::LoadShared(part) => {
                write!(f, "the shared load is {} times the impact force", significant(*part, 3))
            }
        }
    }
}
