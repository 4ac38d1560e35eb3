//! Ranges of the stiffness models.

use super::{Finding, finding, mm};
use crate::model::compliance::model_of;
use crate::model::explanation::Context;
use crate::report::explain::context::Known;

/// The tooth compliance, by the method that serves.
pub(in crate::report::explain) fn teeth(known: &Known) -> Option<Finding> {
    let context = Context {
        inputs: known.inputs,
        given: known.given,
        solution: known.solution,
    };
    let found = (model_of(known.inputs).model().check)(&context)?;
    finding(found.range, found.here, found.inside)
}

/// The same for a deflection, where it is computed.
pub(in crate::report::explain) fn teeth_of_deflection(known: &Known) -> Option<Finding> {
    if known.inputs.deflection.is_some() {
        None
    } else {
        teeth(known)
    }
}

/// The contact is small against the tooth.
pub(in crate::report::explain) fn contact(known: &Known) -> Option<Finding> {
    const SMALL: f64 = 0.1;
    let half_width = known.solution.impact?.hertz_half_width;
    let limit = SMALL * known.inputs.module;
    let here = format!("{} against {}", mm(half_width), mm(limit));
    finding(
        "the contact is small against the tooth: a_H <= m/10",
        here,
        half_width <= limit,
    )
}
