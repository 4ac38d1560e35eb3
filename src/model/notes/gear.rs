//! Notes on the gears: their inertia and their own base pitch deviations.

use super::{Note, four};
use crate::model::deviation::{Origin, out_of_range};
use crate::model::explanation::tidy;
use crate::model::inputs::{Gear, InertiaModel};
use crate::model::{Inputs, Solution};

const MICRO: f64 = 1e6;

/// An undercut cuts the driver's teeth through.
pub(super) fn inertia_driver(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    inertia("driver", 0, inputs, solution)
}

/// An undercut cuts the driven gear's teeth through.
pub(super) fn inertia_driven(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    inertia("driven gear", 1, inputs, solution)
}

fn inertia(name: &str, gear: usize, inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let is_fallback = solution.kept.masses.inertias[gear].is_fallback
        && inputs.inertia_model() == InertiaModel::Outline;
    is_fallback.then(|| {
        Note::new(
            "inertia-base-circle",
            format!(
                "the inertia of the {name} is that of a disc to its base circle, Eq. 47: the \
                 undercut cuts its teeth through"
            ),
        )
    })
}

/// Both gears have their own base pitch deviations.
pub(super) fn common_base_pitch(inputs: &Inputs, _: &Solution) -> Option<Note> {
    let common = inputs.base_pitch_deviation;
    let is_used = [&inputs.driver, &inputs.driven]
        .into_iter()
        .any(|gear| inputs.base_pitch_of(gear).1 == Origin::Common);
    (common != 0.0 && !is_used).then(|| {
        Note::new(
            "base-pitch-not-used",
            format!(
                "deviations.base_pitch = {} um is not used: both gears have their own",
                four(common * MICRO)
            ),
        )
    })
}

pub(super) fn grade_driver(inputs: &Inputs, _: &Solution) -> Option<Note> {
    grade("driver", inputs, &inputs.driver)
}

pub(super) fn grade_driven(inputs: &Inputs, _: &Solution) -> Option<Note> {
    grade("driven", inputs, &inputs.driven)
}

fn grade(table: &str, inputs: &Inputs, gear: &Gear) -> Option<Note> {
    let grade = gear.grade?;
    if let Some(own) = gear.base_pitch {
        let message = format!(
            "{table}.grade = {grade} is not used: {table}.base_pitch = {} um replaces it",
            four(own * MICRO)
        );
        return Some(Note::new("grade-not-used", message));
    }
    let pitch = inputs.graded_pitch(gear)?;
    let (base_pitch, _) = inputs.base_pitch_of(gear);
    let outside = out_of_range(inputs.module, gear.teeth)
        .map(|range| format!("; the standard covers {range}, and this gear is outside"));
    Some(Note::new(
        "grade",
        format!(
            "{table}.grade = {grade}: ISO 1328-1 gives f_pT = {} um and f_pb = {} um{}",
            tidy(pitch * MICRO, 4),
            four(base_pitch * MICRO),
            outside.unwrap_or_default()
        ),
    ))
}
