//! What a reader must know beside a result: each note with its value and its limit.

use super::{Inputs, Refusal, Solution};

/// Something a reader must know beside a result.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// A short name for scripts.
    pub code: &'static str,
    /// One sentence with the value and the limit.
    pub message: String,
}

impl Note {
    fn new(code: &'static str, message: String) -> Note {
        Note { code, message }
    }
}

/// A condition to look for.
type Look = fn(&Inputs, &Solution) -> Option<Note>;

/// Every condition, in the order in which a reader meets them.
const LOOKS: &[Look] = &[withheld, high_contact_ratio, low_contact_ratio, impulse, outlasting, beyond_stick];

/// What a reader must know beside the result.
#[must_use]
pub fn notes(inputs: &Inputs, solution: &Solution) -> Vec<Note> {
    LOOKS.iter().filter_map(|look| look(inputs, solution)).collect()
}

/// Quantities that could not be computed although the tooth strikes.
fn withheld(_: &Inputs, solution: &Solution) -> Option<Note> {
    let refusal: Refusal = solution.withheld?;
    Some(Note::new(refusal.code(), format!("{refusal}; no force, energy or duration is given: {}", refusal.mend())))
}

fn high_contact_ratio(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let ratio = solution.geometry.contact_ratio;
    let done = if inputs.deflection.is_some() {
        "the deflection is the case's own"
    } else {
        "the pairs beside the incoming one share the load"
    };
    (ratio >= 2.0).then(|| {
        Note::new(
            "contact-ratio-above-2",
            format!("the contact ratio is {ratio:.4}, above 2: no single pair carries the load at F; {done}"),
        )
    })
}

fn low_contact_ratio(_: &Inputs, solution: &Solution) -> Option<Note> {
    let ratio = solution.geometry.contact_ratio;
    (ratio < 1.0).then(|| {
        Note::new(
            "contact-ratio-below-1",
            format!("the contact ratio is {ratio:.4}, below 1: no pair is in contact when the next comes in"),
        )
    })
}

fn outlasting(_: &Inputs, solution: &Solution) -> Option<Note> {
    let duration = solution.impact?.duration * 1e6;
    let transit = solution.velocity?.transit_time * 1e6;
    (duration > transit).then(|| {
        Note::new(
            "impact-outlasts-approach",
            format!("the impact lasts {duration:.4} us and D to E only {transit:.4} us: it runs on into the normal mesh, which this rung does not follow"),
        )
    })
}

fn impulse(_: &Inputs, solution: &Solution) -> Option<Note> {
    const ROUNDING: f64 = 1e-9;
    let ratio = solution.impact?.impulse_ratio;
    let range = 1.0 - ROUNDING..=2.0 + ROUNDING;
    (!range.contains(&ratio)).then(|| {
        Note::new(
            "impulse-ratio",
            format!("the impulse ratio is {ratio:.4}, outside 1..2: force and duration do not belong to one impact"),
        )
    })
}

fn beyond_stick(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let friction = inputs.friction_coefficient?;
    let limit = solution.velocity?.stick_limit;
    Some(if friction < limit {
        Note::new(
            "sliding-throughout",
            format!(
                "the friction coefficient {friction} is below the stick limit {limit:.4}: sliding goes on throughout, and the tangential impulse is {friction} times the normal one"
            ),
        )
    } else {
        Note::new(
            "sticking",
            format!("the friction coefficient {friction} reaches the stick limit {limit:.4}: sliding stops within the impact"),
        )
    })
}
