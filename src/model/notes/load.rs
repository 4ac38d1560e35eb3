//! Notes on the methods with load sharing and on the choice of the method.

use super::{Note, four};
use crate::model::compliance::model_of;
use crate::model::inputs::Method;
use crate::model::{Inputs, Solution};
use crate::numeric::decimal::significant;

/// The method that `auto` chose and the reason.
pub(super) fn method_taken(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let choice = solution.choice?;
    let message = if inputs.tooth_compliance.is_none() {
        format!("{choice}; tooth compliance `{}`", model_of(inputs).name())
    } else {
        choice.to_string()
    };
    Some(Note::new("method-taken", message))
}

/// The case gives a deflection that this method computes itself.
pub(super) fn deflection_ignored(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let given = inputs.deflection.filter(|_| solution.method.shares_load())?;
    let (given, found) = (four(given * 1e6), four(solution.deviation.combined_deflection * 1e6));
    let method = solution.method.name();
    let message = format!(
        "method {method} ignores the given deflection of {given} um and uses its own, {found} um"
    );
    Some(Note::new("deflection-ignored", message))
}

/// The case gives the deflection, so that the load does not affect the impact.
pub(super) fn deflection_given(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let given = four(inputs.deflection.filter(|_| !solution.method.shares_load())? * 1e6);
    let message = format!(
        "the deflection of {given} um is given: power and torque change only F_0, not D or the \
            impact"
    );
    Some(Note::new("deflection-given", message))
}

/// Method `paper` subtracts a backlash from the equivalent error.
pub(super) fn backlash_subtracted(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let is_subtracted = solution.method == Method::Paper && inputs.backlash > 0.0;
    let message = || {
        format!(
            "Eq. 1 subtracts the backlash of {} um from Δf; a backlash does not delay a drive flank \
                under load, so the other methods do not",
            four(inputs.backlash * 1e6)
        )
    };
    is_subtracted.then(|| Note::new("backlash-subtracted", message()))
}

/// Base pitch deviations of unlike sign add, although the case asks for independent ones.
pub(super) fn deviations_added(inputs: &Inputs, _: &Solution) -> Option<Note> {
    let message = || {
        let [driver, driven] = inputs.base_pitches().map(|deviation| four(deviation * 1e6));
        format!(
            "base pitch deviations of unlike sign, {driver} and {driven} um, are known with their \
                signs: they add as a sum"
        )
    };
    (inputs.effective_combination() != inputs.combination)
        .then(|| Note::new("deviations-added", message()))
}

/// For a time, no pair is in contact.
pub(super) fn lost_in_motion(_: &Inputs, solution: &Solution) -> Option<Note> {
    let lost = solution.dynamic.as_ref()?.contact_lost;
    lost.then(|| {
        Note::new(
            "dynamic-contact-lost",
            "all teeth lose contact for a time: the gears rattle".to_owned(),
        )
    })
}

/// The contact leaves the tip radius at E, and the stiffness of the pair rises in one step.
pub(super) fn stiffness_step(_: &Inputs, solution: &Solution) -> Option<Note> {
    const LEAST: f64 = 0.02;
    solution.dynamic.as_ref()?.first_contact_angle?;
    let rise = solution.mesh.as_ref()?.stiffness_step() - 1.0;
    let message = || {
        format!(
            "at E the contact passes from the tip radius to the flank, and the stiffness of the pair \
             rises by {} % in one step: so does its force, at any speed; method static has no such step",
            significant(100.0 * rise, 3)
        )
    };
    (rise > LEAST).then(|| Note::new("stiffness-step", message()))
}

/// The back flanks strike.
pub(super) fn back_strikes(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let steady = solution.steady.as_ref().and_then(|found| found.as_ref().ok());
    let in_steady = steady.and_then(|steady| steady.rattle);
    let in_motion = solution.dynamic.as_ref().and_then(|found| found.rattle);
    let (rattle, when) = match (in_motion, in_steady) {
        (Some(rattle), _) if rattle.strikes > 0 => (rattle, "before the incoming tooth leaves"),
        (_, Some(rattle)) if rattle.strikes > 0 => (rattle, "in the steady motion"),
        _ => return None,
    };
    let (backlash, force) = (four(inputs.backlash * 1e6), four(rattle.force));
    let times = match rattle.strikes {
        1 => "once".to_owned(),
        strikes => format!("{strikes} times"),
    };
    let message = format!(
        "the back flanks strike {times} across the backlash of {backlash} um {when}, with up to \
            {force} N"
    );
    Some(Note::new("back-flank-strikes", message))
}

/// The load changes too fast for a static balance.
pub(super) fn inertia(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let (Method::Static, Some(mesh), Some(load)) =
        (solution.method, &solution.mesh, &solution.static_load)
    else {
        return None;
    };
    let time = load.first_contact_angle? / inputs.driven_speed();
    let period = std::f64::consts::TAU * (solution.reduced_mass / mesh.mean_stiffness()).sqrt();
    let part = period / (std::f64::consts::PI * time);
    let message = || {
        let (period, time) = (four(period * 1e6), four(time * 1e6));
        format!(
            "method static ignores inertia, which may change the force by {:.0} %: the mesh period \
             is {period} us, and the load on the tooth grows over {time} us",
            100.0 * part.min(1.0)
        )
    };
    (part > inputs.within).then(|| Note::new("inertia", message()))
}

/// The search found no relief without contact before E.
pub(super) fn not_cleared(_: &Inputs, solution: &Solution) -> Option<Note> {
    let refusal = solution.clearing?.withheld?;
    Some(Note::new(refusal.code(), format!("the required tip relief is unknown: {refusal}")))
}
