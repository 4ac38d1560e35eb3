//! Conditions on the inputs, by which rows choose formulas, words and what a value reads.

use crate::model::compliance::contact_of;
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

/// Every method but `paper`.
#[must_use]
pub fn not_paper(inputs: &Inputs) -> bool {
    !paper(inputs)
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

/// A method of one free impact: `paper`, `exact`, or `auto` before its choice.
#[must_use]
pub fn free_impact(inputs: &Inputs) -> bool {
    !shared_load(inputs)
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

/// Method `static` or `dynamic`, or `auto`, which may choose one of them.
#[must_use]
pub fn may_share_load(inputs: &Inputs) -> bool {
    shared_load(inputs) || auto(inputs)
}

/// Method `dynamic`, or `auto`, which may choose it.
#[must_use]
pub fn may_move(inputs: &Inputs) -> bool {
    in_motion(inputs) || auto(inputs)
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

/// The profile shifts give the centre distance.
#[must_use]
pub fn distance_computed(inputs: &Inputs) -> bool {
    !distance_given(inputs)
}

/// The case gives the deflection and the method uses it.
#[must_use]
pub fn deflection_used(inputs: &Inputs) -> bool {
    inputs.deflection_taken().is_some()
}

/// The load gives the deflection, in this method or in one that `auto` may choose.
#[must_use]
pub fn deflection_computed(inputs: &Inputs) -> bool {
    inputs.deflection.is_none() || may_share_load(inputs)
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

/// A contact compliance of its own: that of the teeth does not include the contact.
#[must_use]
pub fn contact_read(inputs: &Inputs) -> bool {
    contact_of(inputs).is_some()
}

/// The contact compliance depends on load and curvature.
#[must_use]
pub fn half_width_read(inputs: &Inputs) -> bool {
    contact_of(inputs).is_none_or(|contact| contact.model().reads_half_width)
}

/// The edge of a tip changes the compliance off the line of action.
#[must_use]
pub fn edges_read(inputs: &Inputs) -> bool {
    may_share_load(inputs) && half_width_read(inputs)
}
