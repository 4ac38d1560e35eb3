//! Base pitch deviation of a gear: given by the case, or from its flank tolerance class.

use std::f64::consts::SQRT_2;

use super::deviation::pitch_error;
use super::inputs::{Combination, Gear, Inputs};
use super::iso_1328::{base_pitch_tolerance, pitch_tolerance};
use crate::numeric::Real;

/// Source of a gear's base pitch deviation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The gear's own value.
    Own,
    /// The gear's flank tolerance class.
    Grade,
    /// The value that both gears share.
    Common,
}

/// Why ISO 1328-1:2013 does not cover a gear, or `None` if it does.
#[must_use]
pub fn out_of_range(module: f64, teeth: u32) -> Option<&'static str> {
    let diameter = module * f64::from(teeth);
    if !(0.5e-3..=70e-3).contains(&module) {
        Some("modules from 0.5 to 70 mm")
    } else if !(5e-3..=15.0).contains(&diameter) {
        Some("reference diameters from 5 to 15000 mm")
    } else {
        None
    }
}

impl Inputs {
    /// Base pitch deviation f_pb of a gear of the pair, in m, and its source. The gear's own value
    /// has priority over its flank tolerance class, and the class over the common value.
    ///
    /// # Formula
    /// ```text
    /// f_pb = f_pT cos α  for a flank tolerance class
    /// ```
    #[must_use]
    pub fn base_pitch_of(&self, gear: &Gear) -> (f64, Origin) {
        match (gear.base_pitch, gear.grade) {
            (Some(own), _) => (own, Origin::Own),
            (None, Some(grade)) => {
                let diameter = self.module * f64::from(gear.teeth);
                let allowed =
                    base_pitch_tolerance(grade, self.module, diameter, self.pressure_angle);
                (allowed, Origin::Grade)
            }
            (None, None) => (self.base_pitch_deviation, Origin::Common),
        }
    }

    /// Single pitch deviation f_pT of a gear's flank tolerance class, in m.
    #[must_use]
    pub fn graded_pitch(&self, gear: &Gear) -> Option<f64> {
        let diameter = self.module * f64::from(gear.teeth);
        Some(pitch_tolerance(gear.grade?, self.module, diameter))
    }

    /// Base pitch deviations of driver and driven gear, in m.
    #[must_use]
    pub fn base_pitches(&self) -> [f64; 2] {
        [&self.driver, &self.driven].map(|gear| self.base_pitch_of(gear).0)
    }

    /// How the base pitch deviations add. Deviations of unlike sign are known with their signs, so
    /// that they add.
    #[must_use]
    pub fn effective_combination(&self) -> Combination {
        let [driver, driven] = self.base_pitches();
        if driver * driven < 0.0 { Combination::Sum } else { self.combination }
    }

    /// The common base pitch deviation of both gears whose combined deviation is that of this pair
    /// plus `more`, in m.
    #[must_use]
    pub fn common_base_pitch(&self, more: f64) -> f64 {
        let error = pitch_error(self.base_pitches(), self.effective_combination()).rounded();
        let times = match self.combination {
            Combination::Independent => SQRT_2,
            Combination::Sum => 2.0,
        };
        (error + more) / times
    }

    /// Whether a gear has its own base pitch deviation or flank tolerance class.
    #[must_use]
    pub fn has_own_base_pitch(&self) -> bool {
        [&self.driver, &self.driven]
            .into_iter()
            .any(|gear| self.base_pitch_of(gear).1 != Origin::Common)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_own_value_replaces_the_class_and_the_class_replaces_the_common_value() {
        let mut inputs = crate::model::sample::standard_pair(20, 20, 5e-3);
        inputs.base_pitch_deviation = 3e-6;
        let bits = |inputs: &crate::model::Inputs| inputs.base_pitches().map(f64::to_bits);
        let of = |values: [f64; 2]| values.map(f64::to_bits);
        assert_eq!(bits(&inputs), of([3e-6, 3e-6]));
        inputs.driver.grade = Some(7);
        let by_grade = 14e-6 * 20f64.to_radians().cos();
        assert_eq!(bits(&inputs), of([by_grade, 3e-6]));
        inputs.driver.base_pitch = Some(5e-6);
        assert_eq!(bits(&inputs), of([5e-6, 3e-6]));
    }
}
