//! Conditions on the inputs that select formulas and texts of rows.

use crate::model::deviation::Origin;
use crate::model::inputs::{Combination, Drive, Gear, Inputs, Method};

/// Always true.
pub const fn always(_: &Inputs) -> bool {
    true
}

/// Method `paper`.
pub fn paper(inputs: &Inputs) -> bool {
    inputs.method == Method::Paper
}

/// Method `static`.
pub fn at_rest(inputs: &Inputs) -> bool {
    inputs.method == Method::Static
}

/// Method `dynamic`.
pub fn in_motion(inputs: &Inputs) -> bool {
    inputs.method == Method::Dynamic
}

/// A method with load sharing: `static` or `dynamic`.
pub fn shared_load(inputs: &Inputs) -> bool {
    inputs.method.shares_load()
}

/// The case gives the power.
pub fn power_given(inputs: &Inputs) -> bool {
    matches!(inputs.drive, Drive::Power(_))
}

/// The case gives the centre distance.
pub fn distance_given(inputs: &Inputs) -> bool {
    inputs.centre_distance.is_some()
}

/// The case gives the deflection and the method uses it.
pub fn deflection_used(inputs: &Inputs) -> bool {
    inputs.given_deflection().is_some()
}

/// The case gives a friction coefficient.
pub fn friction_given(inputs: &Inputs) -> bool {
    inputs.friction_coefficient.is_some()
}

/// The case gives the edge radius of the driven tip.
pub fn edge_given(inputs: &Inputs) -> bool {
    inputs.driven.tip_radius.is_some()
}

/// The driven tip is rounded, and the method includes the rounding.
pub fn driven_rounded(inputs: &Inputs) -> bool {
    edge_given(inputs) && !paper(inputs)
}

/// The driver's tip is rounded, and the method includes the rounding.
pub fn driver_rounded(inputs: &Inputs) -> bool {
    inputs.driver.tip_radius.is_some() && !paper(inputs)
}

/// A gear has its own base pitch deviation or flank tolerance class, or the deviations are known.
pub fn any_base_pitch(inputs: &Inputs) -> bool {
    inputs.has_own_base_pitch() || inputs.combination == Combination::Sum
}

/// The load varies over the face width: the pair is solved in slices.
pub fn in_slices(inputs: &Inputs) -> bool {
    inputs.face().is_some()
}

/// The pair is helical.
pub fn helical(inputs: &Inputs) -> bool {
    inputs.helix_angle > 0.0
}

/// The middles of the faces differ.
pub fn offset(inputs: &Inputs) -> bool {
    inputs.face_offset != 0.0
}

/// The driver has more teeth than the driven gear.
pub fn driver_larger(inputs: &Inputs) -> bool {
    inputs.driver.teeth > inputs.driven.teeth
}

/// A flank tolerance class gives a base pitch deviation.
pub fn any_class(inputs: &Inputs) -> bool {
    [&inputs.driver, &inputs.driven].iter().any(|gear| inputs.class_of(gear).is_some())
}

/// A flank tolerance class is too coarse for the effect of a tip relief in ISO 6336-1.
pub fn any_coarse(inputs: &Inputs) -> bool {
    !inputs.counts_relief()
}

/// The gears of a pair: driver 0, driven gear 1.
fn gear<const GEAR: usize>(inputs: &Inputs) -> &Gear {
    [&inputs.driver, &inputs.driven][GEAR]
}

/// The flank tolerance class of the gear gives its base pitch deviation.
pub fn graded<const GEAR: usize>(inputs: &Inputs) -> bool {
    inputs.base_pitch_of(gear::<GEAR>(inputs)).1 == Origin::Grade
}

/// The case gives the own base pitch deviation of the gear.
pub fn pitch_given<const GEAR: usize>(inputs: &Inputs) -> bool {
    gear::<GEAR>(inputs).base_pitch.is_some()
}

/// The case gives the moment of inertia of the gear.
pub fn inertia_given<const GEAR: usize>(inputs: &Inputs) -> bool {
    gear::<GEAR>(inputs).inertia.is_some()
}
