//! Ranges of the pair itself.

use super::{Finding, finding, four, mm};
use crate::report::explain::context::Known;

/// No interference where contact begins.
pub(in crate::report::explain) fn start(known: &Known) -> Option<Finding> {
    let start = known.solution.geometry.start;
    finding(
        "N1E > 0: the driven tip meets the driver above its base circle",
        format!("N1E = {}", mm(start)),
        start > 0.0,
    )
}

/// No interference where contact ends.
pub(in crate::report::explain) fn end(known: &Known) -> Option<Finding> {
    let rest = known.solution.geometry.tangent_length - known.solution.geometry.end;
    finding(
        "N2B > 0: the driver's tip meets the driven gear above its base circle",
        format!("N2B = {}", mm(rest)),
        rest > 0.0,
    )
}

/// A pair carries the load while the next comes in.
pub(in crate::report::explain) fn contact_ratio(known: &Known) -> Option<Finding> {
    let ratio = known.solution.geometry.contact_ratio;
    let range = "ε > 1: a pair carries the load while the next comes in; above 2 several share it";
    finding(range, format!("ε = {}", four(ratio)), ratio > 1.0)
}

/// A given centre distance neither jams nor opens the mesh.
pub(in crate::report::explain) fn distance(known: &Known) -> Option<Finding> {
    const JAM: f64 = -1e-4;
    const OPEN: f64 = 0.1;
    known.inputs.centre_distance?;
    let backlash = known.solution.geometry.backlash(&known.inputs.shape());
    let part = backlash / known.inputs.module;
    let here = format!("{}, {} of the module", mm(backlash), four(part));
    finding(
        "a given centre distance leaves a normal backlash of 0 to a tenth of the module",
        here,
        (JAM..=OPEN).contains(&part),
    )
}

/// The bores are within the discs.
pub(in crate::report::explain) fn discs(known: &Known) -> Option<Finding> {
    let (inputs, geometry) = (known.inputs, &known.solution.geometry);
    let parts = [
        inputs.driver.bore_radius / geometry.driver.base,
        inputs.driven.bore_radius / geometry.driven.base,
    ];
    let here = format!(
        "rh1/r_b1 = {}, rh2/r_b2 = {}",
        four(parts[0]),
        four(parts[1])
    );
    finding(
        "the bores leave a disc, r_h < r_b",
        here,
        parts.iter().all(|&part| part < 1.0),
    )
}
