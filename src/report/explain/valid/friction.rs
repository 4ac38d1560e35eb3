//! Ranges of the friction ratio.

use super::{Finding, finding, four, micro};
use crate::report::explain::context::Known;

/// The case's own coefficient against what would stop the sliding.
pub(in crate::report::explain) fn coulomb(known: &Known) -> Option<Finding> {
    let limit = known.solution.velocity?.stick_limit;
    let Some(friction) = known.inputs.friction_coefficient else {
        return finding(
            "μ of the case below stick_limit: sliding throughout",
            "the case gives no μ",
            true,
        );
    };
    let here = format!("μ = {friction}, stick_limit = {}", four(limit));
    finding(
        "μ of the case below stick_limit: sliding throughout",
        here,
        friction < limit,
    )
}

/// D' lies before E.
pub(in crate::report::explain) fn before_start(known: &Known) -> Option<Finding> {
    let (printed, transit) = (
        known.solution.impact?.duration_printed,
        known.solution.velocity?.transit_time,
    );
    let here = format!("{} against {}", micro(printed, "us"), micro(transit, "us"));
    finding("T_S,32 <= t_DE: D' lies before E", here, printed <= transit)
}
