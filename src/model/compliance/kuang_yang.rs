//! Tooth compliance by the fit of Kuang and Yang.

use std::ops::RangeInclusive;

use crate::model::Refusal;
use crate::model::geometry::Circles;
use crate::model::inputs::{Gear, Inputs};

/// Tooth numbers that the fit of Eq. 56 covers.
pub const TEETH: (u32, u32) = (12, 100);
/// Greatest profile shift, either way, that the fit of Eq. 56 covers.
pub const SHIFT: f64 = 0.6;

/// The range of the fit, in words.
pub const RANGE: &str = "z 12..100, |x| <= 0.6, 20 deg full-depth steel teeth";

/// Whether both gears lie in the range of the fit: tooth number, profile shift, 20° full depth,
/// steel.
#[must_use]
pub fn covers(inputs: &Inputs) -> bool {
    const PRESSURE_ANGLE_DEGREES: f64 = 20.0;
    const ADDENDUM: RangeInclusive<f64> = 0.9..=1.1;
    const YOUNG: RangeInclusive<f64> = 190e9..=220e9;
    let covered = |gear: &Gear| {
        (TEETH.0..=TEETH.1).contains(&gear.teeth)
            && gear.profile_shift.abs() <= SHIFT
            && ADDENDUM.contains(&gear.addendum)
            && YOUNG.contains(&gear.young)
    };
    let standard_angle = (inputs.pressure_angle.to_degrees() - PRESSURE_ANGLE_DEGREES).abs() < 1e-6;
    standard_angle && covered(&inputs.driver) && covered(&inputs.driven)
}

/// Compliance of one tooth loaded at a radius, in m²/N.
///
/// # Formula
/// ```text
/// 1/q = (A0 + A1 x) + (A2 + A3 x)(radius − r)/((1 + x) m),   A_k cubic in z, in N/(µm mm)
/// ```
///
/// # Source
/// Kuang & Yang 1992; Zhou & Chen 2014, Eq. 56. Contact excluded.
///
/// # Valid for
/// z = 12..100, |x| ≤ 0.6, 20° full-depth steel teeth. Being cubic in z it explodes outside.
///
/// # Errors
/// [`Refusal::TeethOutsideFit`], [`Refusal::ShiftOutsideFit`]; [`Refusal::HeightOutsideFit`] on a
/// tooth so high that the fit, linear in the height, falls below 0.
pub fn tooth(module: f64, gear: &Gear, circles: &Circles, radius: f64) -> Result<f64, Refusal> {
    const NEWTON_PER_MICRON_MILLIMETRE: f64 = 1e9;
    let (least, most) = TEETH;
    if !(least..=most).contains(&gear.teeth) {
        return Err(Refusal::TeethOutsideFit { teeth: gear.teeth });
    }
    let shift = gear.profile_shift;
    if shift.abs() > SHIFT {
        return Err(Refusal::ShiftOutsideFit { shift });
    }
    let [a0, a1, a2, a3] = coefficients(gear.teeth);
    let height = (radius - circles.reference) / ((1.0 + shift) * module);
    let stiffness = NEWTON_PER_MICRON_MILLIMETRE * (a0 + a1 * shift + (a2 + a3 * shift) * height);
    if stiffness > 0.0 {
        Ok(1.0 / stiffness)
    } else {
        Err(Refusal::HeightOutsideFit { height })
    }
}

/// The coefficients A_0 to A_3 of the fit, in N/(µm mm).
#[must_use]
pub fn coefficients(teeth: u32) -> [f64; 4] {
    const A: [[f64; 4]; 4] = [
        [3.867, 1.612, -0.02916, 0.0001553],
        [17.060, 0.7289, -0.01728, 0.0000999],
        [2.637, -1.222, 0.02217, -0.0001179],
        [-6.330, -1.033, 0.02068, -0.0001130],
    ];
    let teeth = f64::from(teeth);
    A.map(|[c0, c1, c2, c3]| c0 + teeth * (c1 + teeth * (c2 + teeth * c3)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn refuses_a_height_at_which_the_fit_has_no_stiffness() {
        let inputs = standard_pair(59, 15, 5e-3);
        let circles = geometry::<f64>(&inputs.shape()).unwrap().driver;
        assert!(tooth(inputs.module, &inputs.driver, &circles, circles.tip).is_ok());
        let high = tooth(
            inputs.module,
            &inputs.driver,
            &circles,
            circles.reference + 5.0 * inputs.module,
        );
        assert!(
            matches!(high, Err(Refusal::HeightOutsideFit { .. })),
            "{high:?}"
        );
    }
}
