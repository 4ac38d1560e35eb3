//! The rack that cuts a gear.

use std::f64::consts::PI;

use crate::model::inputs::{Gear, Inputs};

/// Tip rounding of the standard basic rack, in modules (ISO 53, profile A), if the tip is wide
/// enough.
pub(super) const RACK_ROUNDING: f64 = 0.38;

/// The rack that cuts a gear: the inputs of the tooth profile besides its circles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rack {
    /// Module m, in m.
    pub module: f64,
    /// Pressure angle α, in rad.
    pub pressure_angle: f64,
    /// Number of teeth z of the gear.
    pub teeth: u32,
    /// Profile shift coefficient x.
    pub profile_shift: f64,
    /// Dedendum coefficient h_fP*.
    pub dedendum: f64,
}

impl Rack {
    /// The rack of a gear of the pair.
    #[must_use]
    pub fn of(inputs: &Inputs, gear: &Gear) -> Rack {
        Rack {
            module: inputs.module,
            pressure_angle: inputs.pressure_angle,
            teeth: gear.teeth,
            profile_shift: gear.profile_shift,
            dedendum: gear.dedendum_coefficient(inputs.module),
        }
    }

    /// Radius of the rack's tip rounding, in modules.
    fn rounding(&self) -> f64 {
        self.fitting(RACK_ROUNDING)
    }

    /// The given rounding, or the largest one that fits the tip, in modules.
    pub(super) fn fitting(&self, rounding: f64) -> f64 {
        let (sine, cosine) = self.pressure_angle.sin_cos();
        let room = (PI / 4.0 * cosine - self.dedendum * sine) / (1.0 - sine);
        rounding.min(room).max(0.0)
    }

    /// Least profile shift without undercut, h_fP* − ρ_fP* (1 − sin α) − z sin²α/2.
    #[must_use]
    pub fn least_shift(&self) -> f64 {
        let sine = self.pressure_angle.sin();
        self.dedendum - self.rounding() * (1.0 - sine) - f64::from(self.teeth) * sine * sine / 2.0
    }
}
