//! Flank tolerances of ISO 1328-1:2013.

use std::ops::RangeInclusive;

/// The flank tolerance classes of the standard.
pub const CLASSES: RangeInclusive<u32> = 1..=11;

const MICROMETRES: f64 = 1e6;
const MILLIMETRES: f64 = 1e3;

/// Single pitch tolerance f_pT of a gear with the module m and the reference diameter d, both in m.
/// The result is in m.
///
/// # Formula
/// ```text
/// f_pT = (0.001 d + 0.4 m + 5) 2^((A − 5)/2)   in µm, with d and m in mm
/// ```
/// A is the class. The result is rounded to 1 µm above 10 µm, to 0.5 µm from 5 µm on, otherwise to
/// 0.1 µm.
///
/// # Source
/// ISO 1328-1:2013, section 5.
#[must_use]
pub fn pitch_tolerance(class: u32, module: f64, diameter: f64) -> f64 {
    let fifth = 0.001 * diameter * MILLIMETRES + 0.4 * module * MILLIMETRES + 5.0;
    let exact = fifth * (0.5 * (f64::from(class) - 5.0)).exp2();
    let step = match exact {
        _ if exact > 10.0 => 1.0,
        _ if exact >= 5.0 => 2.0,
        _ => 10.0,
    };
    (exact * step).round() / step / MICROMETRES
}

/// Base pitch tolerance f_pb = f_pT cos α, in m.
#[must_use]
pub fn base_pitch_tolerance(class: u32, module: f64, diameter: f64, pressure_angle: f64) -> f64 {
    pitch_tolerance(class, module, diameter) * pressure_angle.cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_agree_with_the_standard() {
        for (class, module, diameter, micrometres) in
            [(5, 2e-3, 0.1, 6.0), (6, 2e-3, 0.1, 8.5), (7, 5e-3, 0.1, 14.0), (1, 1e-3, 0.02, 1.4)]
        {
            let allowed = pitch_tolerance(class, module, diameter);
            assert!((allowed * 1e6 - micrometres).abs() < 1e-9, "{class}: {allowed}");
        }
    }
}
