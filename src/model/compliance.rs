//! Compliance of the teeth and of the contact between them, per unit width.

use std::f64::consts::PI;

use super::Refusal;
use super::geometry::{Circles, Geometry};
use super::inputs::{Gear, Inputs};
use super::position::TipContact;

/// Compliance of the two teeth at D, contact excluded, per unit width, in m²/N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TeethCompliance {
    /// Driver's tooth q₁, loaded at O₁D.
    pub driver: f64,
    /// Driven tooth q₂, loaded at its tip.
    pub driven: f64,
}

impl TeethCompliance {
    /// q₁ + q₂, in m²/N.
    #[must_use]
    pub fn sum(&self) -> f64 {
        self.driver + self.driven
    }
}

/// Where two flanks touch: the load radii and the reduced curvature, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactPlace {
    /// Radius of the load point on the driver.
    pub radius_driver: f64,
    /// Radius of the load point on the driven gear.
    pub radius_driven: f64,
    /// Reduced radius of curvature ρ_S.
    pub curvature_radius: f64,
}

impl ContactPlace {
    /// The point of the line of action at the distance `along` from N₁.
    #[must_use]
    pub fn on_line_of_action(geometry: &Geometry, along: f64) -> ContactPlace {
        let rest = geometry.tangent_length - along;
        ContactPlace {
            radius_driver: geometry.driver.base.hypot(along),
            radius_driven: geometry.driven.base.hypot(rest),
            curvature_radius: along * rest / geometry.tangent_length,
        }
    }

    /// The driven tip on the driver's flank.
    #[must_use]
    pub fn at_tip(inputs: &Inputs, geometry: &Geometry, tip: &TipContact) -> ContactPlace {
        ContactPlace {
            radius_driver: tip.radius_driver,
            radius_driven: geometry.driven.tip,
            curvature_radius: super::position::reduced_curvature(inputs, geometry, tip),
        }
    }
}

/// The compliance of a contact as its half-width grows: q_H = slope (offset − ln a).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSpring {
    slope: f64,
    offset: f64,
    width_per_root_force: f64,
}

impl ContactSpring {
    /// Hertz half-width at a force, in m.
    ///
    /// # Formula
    /// ```text
    /// a = √(4 (F/b) ρS/(π E')),   1/E' = (1 − ν1²)/E1 + (1 − ν2²)/E2
    /// ```
    ///
    /// # Source
    /// Hertz 1882; the paper leaves a in its Eq. 55 undefined.
    #[must_use]
    pub fn half_width(&self, force: f64) -> f64 {
        self.width_per_root_force * force.sqrt()
    }

    /// Contact compliance q_H at a force, in m²/N.
    #[must_use]
    pub fn compliance(&self, force: f64) -> f64 {
        self.slope * (self.offset - self.half_width(force).ln())
    }

    /// The force F of an impact for which `F = momentum/√q` with `q = teeth + qH(F)`, in N, and that q in m²/N.
    ///
    /// Newton's method on ln F; q falls slowly with ln F, so that a few steps reach the last digit.
    ///
    /// # Errors
    /// [`Refusal::HertzWidthTooLarge`] where the half-width grows past the range of Eq. 55 before they agree.
    pub fn impact(&self, teeth: f64, momentum: f64) -> Result<(f64, f64), Refusal> {
        const STEPS: usize = 50;
        const SETTLED: f64 = 1e-15;
        let logarithm = (self.width_per_root_force).ln();
        let compliance_at = |log_force: f64| teeth + self.slope * (self.offset - logarithm - 0.5 * log_force);
        let mut log_force = (momentum / teeth.sqrt()).ln();
        let mut compliance = compliance_at(log_force);
        for _ in 0..STEPS {
            if compliance <= 0.5 * self.slope {
                break;
            }
            let residual = log_force - momentum.ln() + 0.5 * compliance.ln();
            let step = residual / (1.0 - 0.25 * self.slope / compliance);
            log_force -= step;
            compliance = compliance_at(log_force);
            if step.abs() <= SETTLED * log_force.abs().max(1.0) {
                return self.checked(momentum, compliance, log_force.exp());
            }
        }
        Err(Refusal::HertzWidthTooLarge { half_width: self.half_width(log_force.exp()), limit: self.offset.exp() })
    }

    /// The settled force, its contact still a compliance.
    fn checked(&self, momentum: f64, compliance: f64, estimate: f64) -> Result<(f64, f64), Refusal> {
        let force = momentum / compliance.sqrt();
        if force > 0.0 && self.compliance(force) > 0.0 {
            return Ok((force, compliance));
        }
        Err(Refusal::HertzWidthTooLarge { half_width: self.half_width(estimate), limit: self.offset.exp() })
    }
}

/// The spring between two flanks.
///
/// # Formula
/// ```text
/// qH = 2 (1 − ν²)/(π E) (1.27 + 0.781 ln(m/a))
/// ```
/// where for two materials (1 − ν²)/E is the mean of both.
///
/// # Source
/// Zhou & Chen 2014, Eq. 55 (from Xiao & Tang 1995).
///
/// # Valid for
/// A half-width small against the module: q_H is negative from a = 5.08 m on.
#[must_use]
pub fn contact_spring(inputs: &Inputs, place: &ContactPlace) -> ContactSpring {
    const CONSTANT: f64 = 1.27;
    const FACTOR: f64 = 0.781;
    let give = plane_strain_compliance(inputs);
    ContactSpring {
        slope: FACTOR * give / PI,
        offset: CONSTANT / FACTOR + inputs.module.ln(),
        width_per_root_force: (4.0 * place.curvature_radius * give / (PI * inputs.common_width())).sqrt(),
    }
}

/// 1/E' = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, in 1/Pa.
#[must_use]
pub fn plane_strain_compliance(inputs: &Inputs) -> f64 {
    let give = |gear: &Gear| (1.0 - gear.poisson) * (1.0 + gear.poisson) / gear.young;
    give(&inputs.driver) + give(&inputs.driven)
}

/// Compliance of the two teeth at a place, in m²/N.
///
/// # Errors
/// A [`Refusal`] outside the range of the fit.
pub fn teeth(inputs: &Inputs, geometry: &Geometry, place: &ContactPlace) -> Result<TeethCompliance, Refusal> {
    Ok(TeethCompliance {
        driver: kuang_yang(inputs, &inputs.driver, &geometry.driver, place.radius_driver)?,
        driven: kuang_yang(inputs, &inputs.driven, &geometry.driven, place.radius_driven)?,
    })
}

/// Compliance of a pair at a place under a given force, in m²/N.
///
/// # Errors
/// A [`Refusal`] outside the range of the fit.
pub fn pair_at_load(inputs: &Inputs, geometry: &Geometry, place: &ContactPlace, force: f64) -> Result<f64, Refusal> {
    let spring = contact_spring(inputs, place);
    let contact = spring.compliance(force);
    if contact <= 0.0 {
        return Err(Refusal::HertzWidthTooLarge { half_width: spring.half_width(force), limit: spring.offset.exp() });
    }
    Ok(teeth(inputs, geometry, place)?.sum() + contact)
}

/// Tooth numbers that the fit of Eq. 56 covers.
pub const KUANG_YANG_TEETH: (u32, u32) = (12, 100);
/// Greatest profile shift, either way, that the fit of Eq. 56 covers.
pub const KUANG_YANG_SHIFT: f64 = 0.6;

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
/// [`Refusal::TeethOutsideFit`], [`Refusal::ShiftOutsideFit`].
fn kuang_yang(inputs: &Inputs, gear: &Gear, circles: &Circles, radius: f64) -> Result<f64, Refusal> {
    const A: [[f64; 4]; 4] = [
        [3.867, 1.612, -0.02916, 0.0001553],
        [17.060, 0.7289, -0.01728, 0.0000999],
        [2.637, -1.222, 0.02217, -0.0001179],
        [-6.330, -1.033, 0.02068, -0.0001130],
    ];
    const NEWTON_PER_MICRON_MILLIMETRE: f64 = 1e9;
    let (least, most) = KUANG_YANG_TEETH;
    if !(least..=most).contains(&gear.teeth) {
        return Err(Refusal::TeethOutsideFit { teeth: gear.teeth });
    }
    let shift = gear.profile_shift;
    if shift.abs() > KUANG_YANG_SHIFT {
        return Err(Refusal::ShiftOutsideFit { shift });
    }
    let teeth = f64::from(gear.teeth);
    let [a0, a1, a2, a3] = A.map(|[c0, c1, c2, c3]| c0 + teeth * (c1 + teeth * (c2 + teeth * c3)));
    let height = (radius - circles.reference) / ((1.0 + shift) * inputs.module);
    Ok(1.0 / (NEWTON_PER_MICRON_MILLIMETRE * (a0 + a1 * shift + (a2 + a3 * shift) * height)))
}
