//! Notes on the geometry of the pair.

use super::{Note, four};
use crate::model::compliance::model_of;
use crate::model::geometry::Circles;
use crate::model::inputs::{Gear, Method};
use crate::model::profile::{Profile, Rack};
use crate::model::{Inputs, Solution};

const MILLI: f64 = 1e3;

/// More than two pairs carry the load.
pub(super) fn contact_ratio_above_two(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let ratio = solution.geometry.contact_ratio;
    let is_coupled = inputs.method != Method::Paper && model_of(inputs).model().has_coupling;
    let done = match (inputs.given_deflection(), is_coupled) {
        (Some(_), _) => "the case gives the deflection",
        (None, true) => {
            "the pairs ahead of the incoming pair share the load and displace each other"
        }
        (None, false) => "the pairs ahead of the incoming pair share the load as parallel springs",
    };
    let message = || {
        format!(
            "the contact ratio is {}, above 2: more than one pair carries the load at F; {done}",
            four(ratio)
        )
    };
    (ratio > 2.0).then(|| Note::new("contact-ratio-above-2", message()))
}

/// At some angles no pair is in contact.
pub(super) fn contact_ratio_below_one(_: &Inputs, solution: &Solution) -> Option<Note> {
    let ratio = solution.geometry.contact_ratio;
    let message = || {
        format!(
            "the contact ratio is {}, below 1: at some angles no pair is in contact",
            four(ratio)
        )
    };
    (ratio < 1.0).then(|| Note::new("contact-ratio-below-1", message()))
}

/// A given centre distance jams the teeth or opens the mesh.
pub(super) fn centre_distance(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    const JAM: f64 = -1e-4;
    const OPEN: f64 = 0.1;
    inputs.centre_distance?;
    let backlash = solution.geometry.backlash(&inputs.shape());
    let value = four(backlash * MILLI);
    if backlash < JAM * inputs.module {
        Some(Note::new(
            "centre-distance-jams",
            format!(
                "the centre distance jams the mesh: the normal backlash is {value} mm and must not \
                    be below 0"
            ),
        ))
    } else if backlash > OPEN * inputs.module {
        let limit = four(OPEN * inputs.module * MILLI);
        let message = format!(
            "the centre distance opens the mesh: the normal backlash is {value} mm, above a tenth \
                of the module, {limit} mm"
        );
        Some(Note::new("centre-distance-opens", message))
    } else {
        None
    }
}

/// The tips are so short that contact starts after the pitch point.
pub(super) fn start_past_pitch(_: &Inputs, solution: &Solution) -> Option<Note> {
    let length = solution.geometry.approach_length;
    let message = || {
        format!(
            "the path of approach is {} mm, below 0: contact starts past the pitch point, at the \
                driven tip without its chamfer",
            four(length * MILLI)
        )
    };
    (length < 0.0).then(|| Note::new("start-past-pitch", message()))
}

/// The driver's tip would touch the driven gear below its base circle.
pub(super) fn interference_at_end(_: &Inputs, solution: &Solution) -> Option<Note> {
    let rest = solution.geometry.tangent_length - solution.geometry.end;
    let message = || {
        format!(
            "interference at the end of contact: N2B is {} mm and must be above 0",
            four(rest * MILLI)
        )
    };
    (rest <= 0.0).then(|| Note::new("interference-at-end", message()))
}

/// The rack cuts into the driver's flank.
pub(super) fn undercut_driver(inputs: &Inputs, _: &Solution) -> Option<Note> {
    undercut("driver", inputs, &inputs.driver)
}

/// The rack cuts into the driven gear's flank.
pub(super) fn undercut_driven(inputs: &Inputs, _: &Solution) -> Option<Note> {
    undercut("driven gear", inputs, &inputs.driven)
}

fn undercut(name: &str, inputs: &Inputs, gear: &Gear) -> Option<Note> {
    let limit = Rack::of(inputs, gear).least_shift();
    let shift = gear.profile_shift;
    let below = shift < limit;
    let limit = four(limit);
    below.then(|| {
        Note::new("undercut", format!(
            "the {name} is undercut: its profile shift is {shift} and should be at least {limit}"))
    })
}

/// The driver's tip is pointed or thin.
pub(super) fn tip_driver(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    tip("driver", inputs, &inputs.driver, &solution.geometry.driver)
}

/// The driven gear's tip is pointed or thin.
pub(super) fn tip_driven(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    tip("driven gear", inputs, &inputs.driven, &solution.geometry.driven)
}

fn tip(name: &str, inputs: &Inputs, gear: &Gear, circles: &Circles) -> Option<Note> {
    const THIN: f64 = 0.2;
    let thickness = Profile::of(&Rack::of(inputs, gear), circles).tip_thickness();
    let (value, limit) = (four(thickness * MILLI), four(THIN * inputs.module * MILLI));
    if thickness <= 0.0 {
        Some(Note::new(
            "pointed-tip",
            format!(
                "the {name}'s tip is pointed: its thickness would be {value} mm and must be above 0"
            ),
        ))
    } else if thickness < THIN * inputs.module {
        Some(Note::new(
            "thin-tip",
            format!(
                "the {name}'s tip is thin: {value} mm, below a fifth of the module, {limit} mm"
            ),
        ))
    } else {
        None
    }
}

/// D or E is below the form circle of the driver.
pub(super) fn form_circle(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let geometry = &solution.geometry;
    let form = Profile::of(&Rack::of(inputs, &inputs.driver), &geometry.driver).form_radius();
    let contact = solution.position.map(|position| ("D", position.contact.radius_driver));
    let start = ("E", geometry.driver.base.hypot(geometry.start));
    let (point, radius) = contact.into_iter().chain([start]).find(|(_, radius)| *radius < form)?;
    let (radius, form) = (distinct_digits(radius, form), distinct_digits(form, radius));
    let message = format!(
        "{point} is below the driver's form circle: O1{point} is {radius} mm and the involute \
            starts at {form} mm"
    );
    Some(Note::new("below-form-circle", message))
}

/// A length in mm with enough digits to distinguish it from another length.
fn distinct_digits(length: f64, other: f64) -> String {
    let digits = 4.0 - ((length - other) * MILLI).abs().log10().floor();
    format!("{:.*}", digits.clamp(4.0, 12.0) as usize - 1, length * MILLI)
}
