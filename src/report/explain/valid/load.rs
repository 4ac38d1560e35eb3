//! Ranges of the methods in which every pair takes its share of the load.

use std::f64::consts::{PI, TAU};

use super::{Finding, finding, four, micro};
use crate::report::explain::context::Known;

pub(in crate::report::explain) use super::Look;

/// The load is taken over so slowly that the mesh follows at rest.
pub(in crate::report::explain) fn at_rest(known: &Known) -> Option<Finding> {
    let solution = known.solution;
    let time = solution.static_load.as_ref()?.first_contact_angle? / known.inputs.driven_speed();
    let period = TAU * (solution.reduced_mass / solution.mesh.as_ref()?.mean_stiffness).sqrt();
    let part = period / (PI * time);
    let here = format!(
        "1/f_n = {}, t = {}, {} %",
        micro(period, "us"),
        micro(time, "us"),
        four(100.0 * part.min(1.0))
    );
    let range = "the tooth takes its load over so slowly that the mesh does not swing: 1/(π f_n t) <= model.within";
    finding(range, here, part <= known.inputs.within)
}

/// The start of the motion is forgotten at E.
pub(in crate::report::explain) fn forgotten(known: &Known) -> Option<Finding> {
    const LEFT: f64 = 1e-3;
    let (inputs, geometry) = (known.inputs, &known.solution.geometry);
    let frequency =
        (known.solution.mesh.as_ref()?.mean_stiffness / known.solution.reduced_mass).sqrt();
    let time = f64::from(inputs.warmup_cycles) * geometry.base_pitch
        / (inputs.speed * geometry.driver.base);
    let left = (-inputs.damping_ratio * frequency * time).exp();
    let here = format!(
        "{} of it in {} base pitches",
        four(left),
        inputs.warmup_cycles
    );
    finding(
        "the start has died away at E: e^(-ζ 2 π f_n t) <= 0.001",
        here,
        left <= LEFT,
    )
}

/// The teeth stay in contact.
pub(in crate::report::explain) fn kept(known: &Known) -> Option<Finding> {
    let lost = known.solution.dynamic.as_ref()?.contact_lost;
    let here = if lost {
        "contact is lost for a time"
    } else {
        "contact is kept"
    };
    finding(
        "the teeth stay in contact; where they rattle, a small change of the case may move the figure much",
        here,
        !lost,
    )
}
