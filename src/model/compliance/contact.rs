//! Compliance of the contact between two flanks, and the list of its models. A new model needs one
//! file in this folder and one entry in [`MODELS`].

mod constant;
mod logarithmic;
mod weber;

use std::f64::consts::PI;
use std::ops::Add;

use super::list::listed;
use super::{ContactPlace, ElasticGear, Elasticity};
use crate::model::Refusal;
use crate::model::explanation::{Context, Step};
use crate::model::geometry::Geometry;
use crate::model::inputs::ContactCompliance;
use crate::numeric::real::logarithm_near_one;

/// Every model; the first is the default of a case.
pub const MODELS: [&ContactModel; 3] = [&logarithmic::MODEL, &constant::MODEL, &weber::MODEL];

/// A model of the compliance of a contact.
#[derive(Debug)]
pub struct ContactModel {
    /// The name in a case file.
    pub name: &'static str,
    /// The index in a symbol such as F_fit,log.
    pub index: &'static str,
    /// Help text in the form, without a full stop.
    pub help: &'static str,
    /// Whether the compliance depends on the half-width, and so on load and curvature.
    pub reads_half_width: bool,
    /// Whether the compliance depends on the root of the tooth, and so on the dedendum.
    pub reads_root: bool,
    /// The steps of q_H at the impact force.
    pub steps: &'static [Step],
    /// Dependence of q_H on the half-width.
    pub law: Law,
}

/// Computes the [`ContactLaw`] of a pair.
#[derive(Debug, Clone, Copy)]
pub enum Law {
    /// Independent of the place.
    Everywhere(fn(&Elasticity) -> ContactLaw),
    /// Computed at each place.
    AtPlace(LawAtPlace),
}

type LawAtPlace = fn(&Elasticity, &Geometry, &ContactPlace) -> Result<ContactLaw, Refusal>;

/// The compliance of a contact as a function of the force.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSpring {
    law: ContactLaw,
    /// Lower limit of q_H, which q_H must exceed.
    least: f64,
    width_per_root_force: f64,
}

/// A contact compliance over the half-width a of the contact, q_H = offset − slope ln(a/1 m), per
/// unit width, in m²/N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactLaw {
    /// q_H at a half-width of 1 m.
    pub offset: f64,
    /// Decrease of q_H per unit of ln a.
    pub slope: f64,
}

impl Add for ContactLaw {
    type Output = ContactLaw;

    fn add(self, other: ContactLaw) -> ContactLaw {
        ContactLaw { offset: self.offset + other.offset, slope: self.slope + other.slope }
    }
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
    /// Hertz 1882. The paper does not define a in its Eq. 55.
    #[must_use]
    pub fn half_width(&self, force: f64) -> f64 {
        self.width_per_root_force * force.sqrt()
    }

    /// Contact compliance q_H at a force, in m²/N.
    ///
    /// # Errors
    /// [`Refusal::HertzWidthTooLarge`] if q_H is not above 0. If the tooth model includes the
    /// contact, the compliance of the pair must be above 0 instead.
    pub fn compliance(&self, force: f64) -> Result<f64, Refusal> {
        let half_width = self.half_width(force);
        let ContactLaw { offset, slope } = self.law;
        let compliance = if slope > 0.0 { offset - slope * half_width.ln() } else { offset };
        if compliance > self.least { Ok(compliance) } else { Err(self.too_wide(half_width)) }
    }

    /// The force F of an impact with `F = momentum/√q` and `q = teeth + qH(F)`, in N, and q in
    /// m²/N.
    ///
    /// Newton's method on y = ln F/F₀ with `y + ln(q/teeth)/2 = 0`, where F₀ is the force without
    /// contact compliance. q falls slowly with y, so that few steps give all digits. ln F and ln q
    /// themselves can be so large that their rounding prevents convergence.
    ///
    /// # Errors
    /// [`Refusal::HertzWidthTooLarge`] if the half-width leaves the range of the formula.
    pub fn impact(&self, teeth: f64, momentum: f64) -> Result<(f64, f64), Refusal> {
        const STEPS: usize = 50;
        /// After a step the error of y is the square of `step · slope/q`, divided by 16.
        const SETTLED: f64 = 1e-8;
        let stiffest = momentum / teeth.sqrt();
        let ContactLaw { offset, slope } = self.law;
        let at_stiffest = teeth + offset - slope * self.half_width(stiffest).ln();
        let (mut force_logarithm, mut compliance) = (0.0, at_stiffest);
        // ln(q/teeth), updated without the logarithm of a large number.
        let mut compliance_logarithm = (compliance / teeth).ln();
        for _ in 0..STEPS {
            if compliance <= 0.5 * slope {
                break;
            }
            let residual = force_logarithm + 0.5 * compliance_logarithm;
            let relative_slope = slope / compliance;
            let step = residual / (1.0 - 0.25 * relative_slope);
            force_logarithm -= step;
            compliance = at_stiffest - 0.5 * slope * force_logarithm;
            if step.abs() * relative_slope.min(1.0) <= SETTLED {
                let force = momentum / compliance.sqrt();
                return if compliance - teeth > self.least {
                    Ok((force, compliance))
                } else {
                    Err(self.too_wide(self.half_width(force)))
                };
            }
            compliance_logarithm += logarithm_near_one(0.5 * relative_slope * step);
        }
        Err(self.too_wide(self.half_width(stiffest)))
    }

    /// The refusal, with the half-width at which q_H reaches its lower limit.
    fn too_wide(&self, half_width: f64) -> Refusal {
        Refusal::HertzWidthTooLarge {
            half_width,
            limit: ((self.law.offset - self.least) / self.law.slope).exp(),
        }
    }
}

/// The contact of a pair by the model of the case, prepared for any place.
#[derive(Debug, Clone, Copy)]
pub struct PairContact {
    law: PairLaw,
    half_width: HalfWidth,
}

#[derive(Debug, Clone, Copy)]
enum PairLaw {
    Everywhere(ContactLaw),
    AtPlace(LawAtPlace),
}

impl PairContact {
    /// The contact of a pair.
    #[must_use]
    pub fn of(elasticity: &Elasticity) -> PairContact {
        PairContact {
            law: match elasticity.contact.model().law {
                Law::Everywhere(law) => PairLaw::Everywhere(law(elasticity)),
                Law::AtPlace(law) => PairLaw::AtPlace(law),
            },
            half_width: HalfWidth::of(elasticity),
        }
    }

    /// 1/E' of the pair, in 1/Pa.
    #[must_use]
    pub fn give(&self) -> f64 {
        self.half_width.give
    }

    /// The contact at a place.
    ///
    /// # Errors
    /// Those of the tooth profile, because `weber` needs the thickness.
    pub fn spring(
        &self,
        elasticity: &Elasticity,
        geometry: &Geometry,
        place: &ContactPlace,
    ) -> Result<ContactSpring, Refusal> {
        let law = match self.law {
            PairLaw::Everywhere(law) => law,
            PairLaw::AtPlace(law) => law(elasticity, geometry, place)?,
        };
        Ok(self.half_width.spring(place, 0.0, law))
    }
}

/// Hertz half-width of the contact of a pair, independent of the compliance model.
#[derive(Debug, Clone, Copy)]
pub struct HalfWidth {
    /// 1/E', in 1/Pa.
    give: f64,
    /// Common face width b, in m.
    width: f64,
}

impl HalfWidth {
    /// The half-width of a pair.
    #[must_use]
    pub fn of(elasticity: &Elasticity) -> HalfWidth {
        HalfWidth { give: plane_strain_compliance(elasticity), width: elasticity.width }
    }

    /// Half-width at a place and a force, in m, by the formula of [`ContactSpring::half_width`].
    #[must_use]
    pub fn at(&self, place: &ContactPlace, force: f64) -> f64 {
        self.per_root_force(place) * force.sqrt()
    }

    /// The contact with a given law at a place. `teeth` is the compliance without contact, in m²/N,
    /// if the tooth model includes the contact, otherwise 0.
    #[must_use]
    pub fn spring(&self, place: &ContactPlace, teeth: f64, law: ContactLaw) -> ContactSpring {
        ContactSpring { law, least: -teeth, width_per_root_force: self.per_root_force(place) }
    }

    fn per_root_force(&self, place: &ContactPlace) -> f64 {
        (4.0 * place.curvature_radius * self.give / (PI * self.width)).sqrt()
    }
}

/// 1/E' = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, in 1/Pa.
#[must_use]
pub fn plane_strain_compliance(elasticity: &Elasticity) -> f64 {
    give(&elasticity.driver) + give(&elasticity.driven)
}

/// (1 − ν²)/E, in 1/Pa.
fn give(gear: &ElasticGear) -> f64 {
    (1.0 - gear.poisson) * (1.0 + gear.poisson) / gear.young
}

/// The contact under the impact force, for the step q_H.
fn at_impact(context: &Context) -> Option<f64> {
    let (elasticity, geometry) = (context.inputs.elasticity(), &context.solution.geometry);
    let contact = PairContact::of(&elasticity);
    let spring = contact.spring(&elasticity, geometry, &place_at_d(context)?).ok()?;
    spring.compliance(context.solution.impact?.force).ok()
}

fn place_at_d(context: &Context) -> Option<ContactPlace> {
    let tip = context.solution.position?.contact;
    Some(ContactPlace::at_tip(context.inputs.driven.tip_radius, &context.solution.geometry, &tip))
}

listed!(ContactCompliance, ContactModel);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::compliance::Teeth;
    use crate::model::geometry::geometry;
    use crate::model::sample::standard_pair;

    #[test]
    fn the_force_converges_at_every_magnitude() {
        let (offset, slope) = (1e-11, 3e-12);
        let spring = ContactSpring {
            law: ContactLaw { offset, slope },
            least: 0.0,
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
    fn a_pointed_tooth_has_no_depth() {
        let mut inputs = standard_pair(8, 60, 5e-3);
        inputs.contact_compliance = ContactCompliance::WEBER;
        inputs.driver.profile_shift = 0.6;
        let pair = geometry::<f64>(&inputs.shape()).unwrap();
        let beyond = ContactPlace {
            radius_driver: pair.driver.tip * 1.2,
            radius_driven: pair.driven.tip,
            curvature_radius: inputs.module,
        };
        let elasticity = inputs.elasticity();
        let teeth = Teeth::of(&elasticity, &pair).unwrap();
        let refused = teeth.pair_at_load(&beyond, 100.0);
        assert!(matches!(refused, Err(Refusal::PointedTip { .. })), "{refused:?}");
    }
}
