//! Ranges of the first contact D.

use super::{Finding, finding, four, micro, mm};
use crate::model::compliance::profile::{Profile, Rack};
use crate::report::explain::context::Known;

/// The tip has closed the gap that it has to close.
pub(in crate::report::explain) fn gap_closed(known: &Known) -> Option<Finding> {
    const CLOSED: f64 = 1e-9;
    let (closed, total) = (
        known.solution.position?.closed_gap,
        known.solution.deviation.total,
    );
    let part = closed / total;
    let here = format!(
        "S(u) = {} of {}, {} %",
        micro(closed, "um"),
        micro(total, "um"),
        four(100.0 * part)
    );
    finding(
        "the tip has closed Δ at D, S(u) = Δ",
        here,
        (part - 1.0).abs() < CLOSED,
    )
}

/// D lies on the driver's involute.
pub(in crate::report::explain) fn on_flank(known: &Known) -> Option<Finding> {
    let circles = &known.solution.geometry.driver;
    let radius = known.solution.position?.contact.radius_driver;
    let form = Profile::of(&Rack::of(known.inputs, &known.inputs.driver), circles).form_radius();
    let here = format!("{} <= {} <= {}", mm(form), mm(radius), mm(circles.tip));
    finding(
        "D on the driver's involute: form circle <= O1D <= r_a1",
        here,
        (form..=circles.tip).contains(&radius),
    )
}

/// The edge of the tip is known.
pub(in crate::report::explain) fn edge(known: &Known) -> Option<Finding> {
    let given = known.inputs.driven.tip_radius;
    let here = given.map_or_else(
        || "not given: its flank's curvature serves".to_owned(),
        |radius| format!("re2 = {}", mm(radius)),
    );
    finding(
        "the radius of the driven tip's edge is given",
        here,
        given.is_some(),
    )
}

/// The tip slides one way from D to E.
pub(in crate::report::explain) fn keeps_sliding(known: &Known) -> Option<Finding> {
    let at_contact = known.solution.velocity?.sliding;
    let at_start = (known.inputs.speed + known.inputs.driven_speed())
        * known.solution.geometry.approach_length;
    let here = format!("{} m/s at D, {} m/s at E", four(at_contact), four(at_start));
    finding(
        "sliding keeps its direction from D to E",
        here,
        at_contact * at_start > 0.0,
    )
}
