//! Notes on the range of the stiffness models.

use super::{Note, four};
use crate::model::compliance::beam::{FOUNDATION_ANGLE, FOUNDATION_BODY};
use crate::model::compliance::profile::Profile;
use crate::model::compliance::{kuang_yang, model_of};
use crate::model::geometry::Circles;
use crate::model::inputs::{Gear, ToothCompliance};
use crate::model::{Inputs, Solution};

/// The method was chosen by its range.
pub(super) fn chosen_by_range(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let served = solution.compliance?.model;
    let chosen = inputs.tooth_compliance.is_none() && served == ToothCompliance::Beam;
    let message = || {
        format!(
            "the tooth compliance is `beam`: the pair lies outside the Kuang-Yang fit, {}",
            kuang_yang::RANGE
        )
    };
    chosen.then(|| Note::new("tooth-compliance-beam", message()))
}

/// The fit is used where it was not made.
pub(super) fn outside_fit(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let served = solution.compliance?.model;
    let outside = served == ToothCompliance::KuangYang && !kuang_yang::covers(inputs);
    outside.then(|| {
        Note::new(
            "outside-fit",
            format!(
                "the tooth compliance `kuang-yang` is used outside its fit, {}",
                kuang_yang::RANGE
            ),
        )
    })
}

/// The foundation's coefficients are taken at the end of their range.
pub(super) fn foundation(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    solution.compliance?;
    if model_of(inputs) != ToothCompliance::Beam {
        return None;
    }
    let outside = |name: &str, gear: &Gear, circles: &Circles| {
        let angle = Profile::of(inputs, gear, circles).root_half_angle();
        let body = circles.root / gear.bore_radius;
        let by_body = body.is_finite() && !(FOUNDATION_BODY.0..=FOUNDATION_BODY.1).contains(&body);
        let by_angle = !(FOUNDATION_ANGLE.0..=FOUNDATION_ANGLE.1).contains(&angle);
        let bore = if body.is_finite() {
            format!("r_f/r_bore is {body:.3}")
        } else {
            "body has no bore".to_owned()
        };
        (by_body || by_angle).then(|| {
            format!(
                "the {name}'s {bore} and its half angle at the root {} rad",
                four(angle)
            )
        })
    };
    let driver = outside("driver", &inputs.driver, &solution.geometry.driver);
    let found =
        driver.or_else(|| outside("driven gear", &inputs.driven, &solution.geometry.driven))?;
    let ((body_from, body_to), (angle_from, angle_to)) = (FOUNDATION_BODY, FOUNDATION_ANGLE);
    let message = format!(
        "{found}, outside {body_from}..{body_to} and {angle_from}..{angle_to}, where the foundation was fitted: the end of the range serves"
    );
    Some(Note::new("foundation-outside-range", message))
}

/// The contact is not small against the tooth.
pub(super) fn hertz_width(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    const SMALL: f64 = 0.1;
    let half_width = solution.impact?.hertz_half_width;
    let limit = SMALL * inputs.module;
    let message = || {
        format!(
            "the Hertz half-width is {} mm and should be below {} mm, a tenth of the module",
            four(half_width * 1e3),
            four(limit * 1e3)
        )
    };
    (half_width > limit).then(|| Note::new("hertz-width-not-small", message()))
}
