//! Ranges of the stiffness models.

use super::{Finding, finding, four, mm};
use crate::model::compliance::beam::{FOUNDATION_ANGLE, FOUNDATION_BODY};
use crate::model::compliance::profile::Profile;
use crate::model::compliance::{kuang_yang, model_of};
use crate::model::inputs::{Gear, ToothCompliance};
use crate::report::explain::context::Known;

/// The tooth compliance, by the method that serves.
pub(in crate::report::explain) fn teeth(known: &Known) -> Option<Finding> {
    match model_of(known.inputs) {
        ToothCompliance::KuangYang => fit(known),
        ToothCompliance::Beam => foundation(known),
    }
}

/// The same for a deflection, where it is computed.
pub(in crate::report::explain) fn teeth_of_deflection(known: &Known) -> Option<Finding> {
    if known.inputs.deflection.is_some() {
        None
    } else {
        teeth(known)
    }
}

fn fit(known: &Known) -> Option<Finding> {
    let (inputs, degrees) = (known.inputs, known.inputs.pressure_angle.to_degrees());
    let (driver, driven) = (&inputs.driver, &inputs.driven);
    let here = format!(
        "z {} and {}, x {} and {}, {} deg, ha* {} and {}, E {} and {} GPa",
        driver.teeth,
        driven.teeth,
        driver.profile_shift,
        driven.profile_shift,
        four(degrees),
        driver.addendum,
        driven.addendum,
        four(driver.young * 1e-9),
        four(driven.young * 1e-9)
    );
    finding(
        format!("the fit of Eq. 56: {}", kuang_yang::RANGE),
        here,
        kuang_yang::covers(inputs),
    )
}

fn foundation(known: &Known) -> Option<Finding> {
    let geometry = &known.solution.geometry;
    let angle = |gear: &Gear, circles| Profile::of(known.inputs, gear, circles).root_half_angle();
    let angles = [
        angle(&known.inputs.driver, &geometry.driver),
        angle(&known.inputs.driven, &geometry.driven),
    ];
    let bodies = [
        geometry.driver.root / known.inputs.driver.bore_radius,
        geometry.driven.root / known.inputs.driven.bore_radius,
    ];
    let inside = bodies
        .iter()
        .all(|body| !body.is_finite() || (FOUNDATION_BODY.0..=FOUNDATION_BODY.1).contains(body))
        && angles
            .iter()
            .all(|angle| (FOUNDATION_ANGLE.0..=FOUNDATION_ANGLE.1).contains(angle));
    let body = |body: f64| {
        if body.is_finite() {
            four(body)
        } else {
            "none (no bore: held at a third of r_f)".to_owned()
        }
    };
    let here = format!(
        "h {} and {}, θ {} and {} rad",
        body(bodies[0]),
        body(bodies[1]),
        four(angles[0]),
        four(angles[1])
    );
    let ((body_from, body_to), (angle_from, angle_to)) = (FOUNDATION_BODY, FOUNDATION_ANGLE);
    let range = format!(
        "the beam's foundation: h = r_f/r_h {body_from}..{body_to}, half angle at the root θ {angle_from}..{angle_to} rad; outside, the end of the range serves"
    );
    finding(range, here, inside)
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
