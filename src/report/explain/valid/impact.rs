//! Ranges of the impact.

use super::{Finding, finding, four, micro};
use crate::report::explain::context::Known;

/// The pair ahead stays in contact while the incoming tooth carries its error; a method that
/// follows every pair asks no such thing.
pub(in crate::report::explain) fn pair_ahead(known: &Known) -> Option<Finding> {
    if known.solution.method.shares_load() {
        return None;
    }
    let deviation = known.solution.deviation;
    let (deflection, error) = (deviation.combined_deflection, deviation.equivalent_error);
    let here = format!(
        "δ = {}, Δf = {}",
        micro(deflection, "um"),
        micro(error, "um")
    );
    finding(
        "δ >= Δf: the load holds the pair ahead in contact",
        here,
        deflection >= error,
    )
}

/// The impact is over before E.
pub(in crate::report::explain) fn within_approach(known: &Known) -> Option<Finding> {
    let (duration, transit) = (
        known.solution.impact?.duration,
        known.solution.velocity?.transit_time,
    );
    let here = format!("{} against {}", micro(duration, "us"), micro(transit, "us"));
    finding(
        "T_S <= t_DE: the impact is over before the normal mesh begins",
        here,
        duration <= transit,
    )
}

/// Force and duration belong to one impact.
pub(in crate::report::explain) fn possible(known: &Known) -> Option<Finding> {
    const ROUNDING: f64 = 1e-9;
    let ratio = known.solution.impact?.impulse_ratio;
    let possible = 1.0 - ROUNDING..=2.0 + ROUNDING;
    finding(
        "1 <= κ <= 2: force and duration belong to one impact",
        format!("κ = {}", four(ratio)),
        possible.contains(&ratio),
    )
}

/// The printed duration is that of Hertz.
pub(in crate::report::explain) fn printed_shorter(known: &Known) -> Option<Finding> {
    let impact = known.solution.impact?;
    let here = format!(
        "{} against {}",
        micro(impact.duration_printed, "us"),
        micro(impact.duration_hertz, "us")
    );
    finding("as long as Hertz's duration", here, false)
}
