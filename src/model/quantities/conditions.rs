//! Conditions on the inputs, by which rows choose formulas and words.

use crate::model::inputs::{Drive, Inputs, Method};

/// In every case.
#[must_use]
pub const fn always(_: &Inputs) -> bool {
    true
}

/// Method `paper`.
#[must_use]
pub fn paper(inputs: &Inputs) -> bool {
    inputs.method == Method::Paper
}

/// Method `static`.
#[must_use]
pub fn at_rest(inputs: &Inputs) -> bool {
    inputs.method == Method::Static
}

/// Method `dynamic`.
#[must_use]
pub fn in_motion(inputs: &Inputs) -> bool {
    inputs.method == Method::Dynamic
}

/// A method in which every pair carries its share of the load: `static` or `dynamic`.
#[must_use]
pub fn shared_load(inputs: &Inputs) -> bool {
    inputs.method.shares_load()
}

/// Method `auto`, which may choose any other method.
#[must_use]
pub fn auto(inputs: &Inputs) -> bool {
    inputs.method == Method::Auto
}

/// The case gives the power.
#[must_use]
pub fn power_given(inputs: &Inputs) -> bool {
    matches!(inputs.drive, Drive::Power(_))
}

/// The case gives the centre distance.
#[must_use]
pub fn distance_given(inputs: &Inputs) -> bool {
    inputs.centre_distance.is_some()
}

/// The case gives the deflection and the method uses it.
#[must_use]
pub fn deflection_used(inputs: &Inputs) -> bool {
    inputs.deflection_taken().is_some()
}

/// The case gives a friction coefficient.
#[must_use]
pub fn friction_given(inputs: &Inputs) -> bool {
    inputs.friction_coefficient.is_some()
}

/// The case gives the edge radius of the driven tip.
#[must_use]
pub fn edge_given(inputs: &Inputs) -> bool {
    inputs.driven.tip_radius.is_some()
}
