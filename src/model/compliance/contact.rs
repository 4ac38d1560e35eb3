//! Compliance of the contact between two flanks.

use std::f64::consts::PI;

use super::ContactPlace;
use super::profile::Profile;
use crate::model::Refusal;
use crate::model::geometry::Geometry;
use crate::model::inputs::{ContactCompliance, Gear, Inputs};

/// The compliance of a contact as its half-width a grows: q_H = offset − slope ln a.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSpring {
    offset: f64,
    slope: f64,
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
    ///
    /// # Errors
    /// [`Refusal::HertzWidthTooLarge`] where the formula gives none above 0.
    pub fn compliance(&self, force: f64) -> Result<f64, Refusal> {
        let half_width = self.half_width(force);
        let compliance = if self.slope > 0.0 {
            self.offset - self.slope * half_width.ln()
        } else {
            self.offset
        };
        if compliance > 0.0 {
            Ok(compliance)
        } else {
            Err(self.too_wide(half_width))
        }
    }

    /// The force F of an impact for which `F = momentum/√q` with `q = teeth + qH(F)`, in N, and
    /// that q in m²/N.
    ///
    /// Newton's method on y = ln F/F₀ where F₀ is the force without contact compliance, `y +
    /// ln(q/teeth)/2 = 0`; q falls slowly with y, so that a few steps reach the last digit. The
    /// logarithms of F and q themselves may be so large that their rounding would keep the steps
    /// from settling.
    ///
    /// # Errors
    /// [`Refusal::HertzWidthTooLarge`] where the half-width outgrows the formula before they agree.
    pub fn impact(&self, teeth: f64, momentum: f64) -> Result<(f64, f64), Refusal> {
        const STEPS: usize = 50;
        const SETTLED: f64 = 1e-8;
        let stiffest = momentum / teeth.sqrt();
        let at_stiffest = teeth + self.offset - self.slope * self.half_width(stiffest).ln();
        let compliance_at = |logarithm: f64| at_stiffest - 0.5 * self.slope * logarithm;
        let (mut logarithm, mut compliance) = (0.0, at_stiffest);
        for _ in 0..STEPS {
            if compliance <= 0.5 * self.slope {
                break;
            }
            let residual = logarithm + 0.5 * (compliance / teeth).ln();
            let step = residual / (1.0 - 0.25 * self.slope / compliance);
            logarithm -= step;
            compliance = compliance_at(logarithm);
            if step.abs() <= SETTLED {
                let force = momentum / compliance.sqrt();
                return self.compliance(force).map(|_| (force, compliance));
            }
        }
        Err(self.too_wide(self.half_width(stiffest)))
    }

    /// The refusal, with the half-width at which the formula gives no compliance any more.
    fn too_wide(&self, half_width: f64) -> Refusal {
        Refusal::HertzWidthTooLarge {
            half_width,
            limit: (self.offset / self.slope).exp(),
        }
    }
}

/// The spring between two flanks, by the case's formula.
///
/// # Errors
/// Those of the tooth's profile, whose thickness `weber` reads.
pub fn spring(
    inputs: &Inputs,
    geometry: &Geometry,
    place: &ContactPlace,
) -> Result<ContactSpring, Refusal> {
    let give = plane_strain_compliance(inputs);
    let (offset, slope) = match inputs.contact_compliance {
        ContactCompliance::Logarithmic => logarithmic(inputs.module, give),
        ContactCompliance::Constant => (constant(give), 0.0),
        ContactCompliance::Weber => weber(inputs, geometry, place)?,
    };
    let width_per_root_force =
        (4.0 * place.curvature_radius * give / (PI * inputs.common_width())).sqrt();
    Ok(ContactSpring {
        offset,
        slope,
        width_per_root_force,
    })
}

/// 1/E' = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, in 1/Pa.
#[must_use]
pub fn plane_strain_compliance(inputs: &Inputs) -> f64 {
    give(&inputs.driver) + give(&inputs.driven)
}

/// (1 − ν²)/E, in 1/Pa.
fn give(gear: &Gear) -> f64 {
    (1.0 - gear.poisson) * (1.0 + gear.poisson) / gear.young
}

/// Offset and slope of Eq. 55.
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
fn logarithmic(module: f64, give: f64) -> (f64, f64) {
    const CONSTANT: f64 = 1.27;
    const FACTOR: f64 = 0.781;
    (
        give / PI * (CONSTANT + FACTOR * module.ln()),
        give / PI * FACTOR,
    )
}

/// Contact compliance without the half-width, q_H = 4 (1 − ν²)/(π E), in m²/N.
///
/// # Source
/// Yang & Sun 1985, "A rotary model for spur gear dynamics". For two materials (1 − ν²)/E is the
/// mean of both.
fn constant(give: f64) -> f64 {
    2.0 * give / PI
}

/// Offset and slope of Weber's contact term.
///
/// # Formula
/// ```text
/// qH = Σ (1 − ν_i²)/(π E_i) (2 ln(2 h_i/a) − ν_i/(1 − ν_i))
/// ```
/// where h_i is the depth from the contact to the tooth's centre line along the line of force.
///
/// # Source
/// Weber & Banaschek 1953, "Formänderung und Profilrücknahme bei gerad- und schrägverzahnten
/// Rädern".
///
/// # Valid for
/// A half-width small against the depth h.
///
/// # Errors
/// [`Refusal::PointedTip`] where no tooth is left at the load point.
fn weber(
    inputs: &Inputs,
    geometry: &Geometry,
    place: &ContactPlace,
) -> Result<(f64, f64), Refusal> {
    let of = |gear: &Gear, depth: f64| {
        let scale = give(gear) / PI;
        (
            scale * (2.0 * (2.0 * depth).ln() - gear.poisson / (1.0 - gear.poisson)),
            2.0 * scale,
        )
    };
    let driver = depth(
        &Profile::of(inputs, &inputs.driver, &geometry.driver),
        place.radius_driver,
    )?;
    let driven = depth(
        &Profile::of(inputs, &inputs.driven, &geometry.driven),
        place.radius_driven,
    )?;
    let (first, second) = (of(&inputs.driver, driver), of(&inputs.driven, driven));
    Ok((first.0 + second.0, first.1 + second.1))
}

/// Depth from the flank to the tooth's centre line at a radius, where there is a tooth.
fn depth(profile: &Profile, radius: f64) -> Result<f64, Refusal> {
    let depth = profile.depth_along_force(radius);
    if depth > 0.0 {
        Ok(depth)
    } else {
        Err(Refusal::PointedTip {
            thickness: 2.0 * depth,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::compliance::pair_at_load;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn force_settles_whatever_its_size() {
        let (offset, slope) = logarithmic(5e-3, 1e-11);
        let spring = ContactSpring {
            offset,
            slope,
            width_per_root_force: 1e-6,
        };
        for teeth in [1e-13, 7e-12, 3e-11, 1e-9] {
            for step in 0..2_000 {
                let momentum = 1e-14 * 1.0123f64.powi(step);
                let (force, compliance) = spring.impact(teeth, momentum).unwrap();
                let back = force * (teeth + spring.compliance(force).unwrap()).sqrt();
                assert!(
                    (back / momentum - 1.0).abs() < 1e-14,
                    "teeth {teeth}, momentum {momentum}: {back}"
                );
                assert!(compliance > teeth);
            }
        }
    }

    #[test]
    fn no_depth_is_left_on_a_pointed_tooth() {
        let mut inputs = standard_pair(8, 60, 5e-3);
        inputs.contact_compliance = ContactCompliance::Weber;
        inputs.driver.profile_shift = 0.6;
        let pair = geometry::<f64>(&inputs.shape()).unwrap();
        let beyond = ContactPlace {
            radius_driver: pair.driver.tip * 1.2,
            radius_driven: pair.driven.tip,
            curvature_radius: inputs.module,
        };
        let refused = pair_at_load(&inputs, &pair, &beyond, 100.0);
        assert!(
            matches!(refused, Err(Refusal::PointedTip { .. })),
            "{refused:?}"
        );
    }
}
