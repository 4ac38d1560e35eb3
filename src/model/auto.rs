//! The rung `auto`: the cheapest rung that is good enough, by what the closed form says of itself.

use std::f64::consts::PI;
use std::fmt;

use super::inputs::{Inputs, Rung};
use super::stage::{Stage, Stages};
use super::{Outcome, Refusal, Solution};
use crate::numeric::decimal::significant;

/// The rung that was taken, and why.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Choice {
    /// `exact`, `static` or `dynamic`.
    pub rung: Rung,
    /// Why no cheaper one serves, or why the cheapest does.
    pub reason: Reason,
    /// Estimate of what inertia adds to the shared load, where it decided.
    pub inertia: Option<f64>,
}

/// Why a rung was taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reason {
    /// The gap left at E is greater than any swing of the mesh.
    NoContact,
    /// The impact is over before E, and the load adds little to it.
    FreeImpact,
    /// The closed form has no answer.
    Refused,
    /// The load lifts off the pair ahead.
    ContactLost,
    /// The impact is still under way at E: duration and way from D to E, in s.
    Outlasts(f64, f64),
    /// Force and duration contradict each other.
    Impulse(f64),
    /// The load that the tooth takes over is no small part of the impact force.
    LoadShared(f64),
}

/// The rung that the pair needs.
///
/// # Formula
/// ```text
/// exact:    T_S <= t_DE,  1 <= κ <= 2,  δ >= Δf  and  F0/F_S <= within
/// static:   otherwise, while  c T_n/(π t) <= within,  T_n = 2 π √(M q/b),  t = t_DE
/// dynamic:  otherwise
/// ```
/// A load that is taken over within a time t leaves a mesh of the period T_n swinging by at most T_n/(π t) of it: the
/// response of an oscillator to a ramp. The greatest error of `static` was 0.46 times that over 150 random pairs whose pair
/// ahead stays in contact, and 11.3 times over 300 whose pair ahead loses it (δ < Δf): c is 1/2 and 12. Without contact `exact` stays where the gap left is greater than that part of the
/// deflection, t being the time in which two pairs share the load.
#[must_use]
pub fn choose(inputs: &Inputs, closed_form: &Result<Solution, Refusal>) -> Choice {
    let Ok(solution) = closed_form else {
        return Choice { rung: Rung::Dynamic, reason: Reason::Refused, inertia: None };
    };
    match solution.outcome {
        Outcome::NoCornerContact => without_contact(inputs, solution),
        Outcome::CornerContact => with_contact(inputs, solution),
    }
}

fn without_contact(inputs: &Inputs, solution: &Solution) -> Choice {
    let deviation = &solution.deviation;
    let Some(period) = period(solution) else {
        return Choice { rung: Rung::Dynamic, reason: Reason::Refused, inertia: None };
    };
    let geometry = &solution.geometry;
    let shared = (geometry.contact_ratio - 1.0) * geometry.base_pitch / (inputs.speed * geometry.driver.base);
    let swing = swing(period, shared);
    if -deviation.total >= swing * deviation.combined_deflection {
        return Choice { rung: Rung::Exact, reason: Reason::NoContact, inertia: None };
    }
    sharing(inputs, Reason::LoadShared(1.0), swing)
}

fn with_contact(inputs: &Inputs, solution: &Solution) -> Choice {
    let (Some(impact), Some(velocity)) = (&solution.impact, &solution.velocity) else {
        return Choice { rung: Rung::Dynamic, reason: Reason::Refused, inertia: None };
    };
    let deviation = &solution.deviation;
    let load = solution.mesh_force / impact.force;
    let reason = if deviation.combined_deflection < deviation.equivalent_error {
        Reason::ContactLost
    } else if impact.duration > velocity.transit_time {
        Reason::Outlasts(impact.duration, velocity.transit_time)
    } else if !(1.0 - 1e-9..=2.0 + 1e-9).contains(&impact.impulse_ratio) {
        Reason::Impulse(impact.impulse_ratio)
    } else if load > inputs.within {
        Reason::LoadShared(load)
    } else {
        return Choice { rung: Rung::Exact, reason: Reason::FreeImpact, inertia: None };
    };
    let swing = swing(2.0 * impact.duration_spring, velocity.transit_time);
    sharing(inputs, reason, (swing * part_felt(reason)).min(1.0))
}

/// What the forces feel of a swing, as measured.
fn part_felt(reason: Reason) -> f64 {
    match reason {
        Reason::LoadShared(_) => 0.5,
        Reason::ContactLost => 12.0,
        _ => 1.0,
    }
}

/// `static` where inertia adds little, else `dynamic`.
fn sharing(inputs: &Inputs, reason: Reason, inertia: f64) -> Choice {
    let rung = if inertia <= inputs.within { Rung::Static } else { Rung::Dynamic };
    Choice { rung, reason, inertia: Some(inertia) }
}

/// What a load taken over within `time` leaves of itself as a swing.
fn swing(period: f64, time: f64) -> f64 {
    (period / (PI * time)).min(1.0)
}

/// Period of a pair at rest under its load, in s.
fn period(solution: &Solution) -> Option<f64> {
    let compliance = solution.deviation.combined_deflection / solution.mesh_force;
    Some(2.0 * PI * (solution.reduced_mass * compliance).sqrt()).filter(|period| *period > 0.0)
}

/// The stages of the closed form that the choice reads.
pub(super) const READS: Stages = Stages::of(Stage::Impact);

/// The inputs of the rung that was taken.
#[must_use]
pub fn taken(inputs: &Inputs, rung: Rung) -> Inputs {
    /// The tolerance of the peak force is this part of what may be left in all.
    const NUMERICAL: f64 = 0.02;
    Inputs { rung, tolerance: (NUMERICAL * inputs.within).max(1e-12), ..inputs.clone() }
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "auto took {}: {}", self.rung.name(), self.reason)?;
        let Some(inertia) = self.inertia else { return Ok(()) };
        let adds = significant(100.0 * inertia, 2);
        write!(f, ", and inertia may add {adds} % to the shared load")
    }
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micro = |time: f64| significant(time * 1e6, 4);
        match self {
            Reason::NoContact => f.write_str("the tooth comes in on time, by more than the mesh swings"),
            Reason::FreeImpact => f.write_str("the impact is over before E, and the load adds little to it"),
            Reason::Refused => f.write_str("the closed form has no answer"),
            Reason::ContactLost => f.write_str("the pair ahead loses contact"),
            Reason::Outlasts(lasts, way) => {
                write!(f, "the impact lasts {} us and D to E only {} us", micro(*lasts), micro(*way))
            }
            Reason::Impulse(ratio) => write!(f, "the impulse ratio is {}", significant(*ratio, 4)),
            Reason::LoadShared(part) => write!(f, "the load shared is {} of the impact force", significant(*part, 3)),
        }
    }
}
