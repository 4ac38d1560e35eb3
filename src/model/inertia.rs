//! Polar moment of a gear's section from its true outline.

use std::f64::consts::{FRAC_PI_2, PI};

use super::profile::Profile;
use crate::numeric::quadrature;

/// Relative tolerance of the integrals.
const TOLERANCE: f64 = 1e-14;

/// Polar moment of area of the gear's section, in m⁴: times density and face width it is the moment
/// of inertia J.
///
/// # Formula
/// ```text
/// π/2 (r_f⁴ − r_h⁴) + z ∫ 2 θ(r) r³ dr,  r = r_f .. r_a
/// ```
/// where θ is half of the tooth's angle. A pointed tooth ends where its flanks meet.
///
/// # Source
/// The profile is the rack's, see [`Profile`].
#[must_use]
pub fn polar_moment(profile: &Profile, teeth: u32, bore_radius: f64) -> f64 {
    let root = profile.circles().root;
    let ring = PI / 2.0
        * (root - bore_radius)
        * (root + bore_radius)
        * (root * root + bore_radius * bore_radius);
    ring + 2.0 * f64::from(teeth) * (flank_moment(profile) + fillet_moment(profile))
}

/// ∫ θ r³ dr over the involute; r = r_b √(1 + φ²).
fn flank_moment(profile: &Profile) -> f64 {
    let base = profile.circles().base;
    let half_angle = |roll: f64| profile.base_half_angle() - roll + roll.atan();
    let tip = profile.circles().tip_curvature / base;
    let start = profile.junction.roll.min(tip);
    let end = if half_angle(tip) < 0.0 {
        pointed_end(start, tip, half_angle)
    } else {
        tip
    };
    let integral = quadrature::adaptive(start, end, TOLERANCE, |roll| {
        half_angle(roll) * (1.0 + roll * roll) * roll
    });
    base.powi(4) * integral
}

/// Roll angle at which the flanks meet, by bisection.
fn pointed_end(mut low: f64, mut high: f64, half_angle: impl Fn(f64) -> f64) -> f64 {
    const HALVINGS: usize = 60;
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if half_angle(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// ∫ θ r³ dr over the fillet.
fn fillet_moment(profile: &Profile) -> f64 {
    quadrature::adaptive(FRAC_PI_2, profile.junction.normal, TOLERANCE, |normal| {
        let section = profile.fillet_at(normal);
        let squared =
            section.along * section.along + section.half_thickness * section.half_thickness;
        section.half_thickness.atan2(section.along) * squared * profile.fillet_rise(normal)
    })
}
