//! Circles of a gear computed from its coefficients.

use crate::model::Inputs;
use crate::model::inputs::Gear;

/// Whether module and number of teeth, which determine every circle, are known.
pub(super) fn has_size(inputs: &Inputs, gear: &Gear) -> bool {
    inputs.module > 0.0 && gear.teeth > 0
}

/// Tip diameter without a chamfer, d_a = m (z + 2 h_a* + 2 x), in m.
pub(super) fn tip_diameter(inputs: &Inputs, gear: &Gear) -> Option<f64> {
    let addendum = gear.addendum_coefficient(inputs.module);
    has_size(inputs, gear).then(|| diameter(inputs, gear, addendum + gear.profile_shift))
}

/// Root diameter d_f = m (z − 2 h_fP* + 2 x), in m.
pub(super) fn root_diameter(inputs: &Inputs, gear: &Gear) -> Option<f64> {
    let dedendum = gear.dedendum_coefficient(inputs.module);
    has_size(inputs, gear).then(|| diameter(inputs, gear, gear.profile_shift - dedendum))
}

/// The diameter of a circle at a height above the reference circle, times the module.
fn diameter(inputs: &Inputs, gear: &Gear, height: f64) -> f64 {
    inputs.module * (f64::from(gear.teeth) + 2.0 * height)
}
