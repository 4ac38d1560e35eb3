//! Compliance of the contact between two flanks, and its models. A new model needs one entry in
//! [`MODELS`].

use std::f64::consts::PI;
use std::ops::Add;

use super::{ContactPlace, ElasticGear, Elasticity};
use crate::model::Refusal;
use crate::model::explanation::Formula::{Text, Words};
use crate::model::explanation::{Context, Step, step};
use crate::model::geometry::{Circles, Geometry};
use crate::model::inputs::{ContactCompliance, GearSide};
use crate::model::profile::{Profile, Rack};
use crate::numeric::real::logarithm_near_one;

/// Every model; the first is the default of a case.
pub const MODELS: [&ContactModel; 3] = [&LOGARITHMIC, &CONSTANT, &WEBER];

/// A model of the compliance of a contact.
#[derive(Debug)]
pub struct ContactModel {
    /// The name in a case file.
    pub name: &'static str,
    /// The index in a symbol such as F_fit,log.
    pub index: &'static str,
    /// Whether the compliance depends on the root of the tooth, and so on the dedendum.
    pub reads_root: bool,
    /// The steps of q_H at the impact force.
    pub steps: &'static [Step],
    /// Computes the dependence of q_H on the half-width.
    pub law: Law,
}

/// Computes the law of a contact at a place.
pub type Law = fn(&Elasticity, &Geometry, &ContactPlace) -> Result<ContactLaw, Refusal>;

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
    /// a = √(4 (F/b) ρS/(cos β_b π E')),   1/E' = (1 − ν1²)/E1 + (1 − ν2²)/E2
    /// ```
    ///
    /// # Source
    /// Hertz 1882. The paper does not define a in its Eq. 55.
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

impl Elasticity {
    /// The contact at a place by the contact model of the case.
    ///
    /// # Errors
    /// Those of the tooth profile, because `weber` needs the thickness.
    pub fn contact_spring(
        &self,
        geometry: &Geometry,
        place: &ContactPlace,
    ) -> Result<ContactSpring, Refusal> {
        let ContactLaw { offset, slope } = (self.contact.model().law)(self, geometry, place)?;
        let oblique = self.driver.oblique;
        let law = ContactLaw { offset: oblique * offset, slope: oblique * slope };
        Ok(self.spring(place, 0.0, law))
    }

    /// The contact with a given law at a place. `teeth` is the compliance without contact, in m²/N,
    /// if the tooth model includes the contact, otherwise 0.
    pub fn spring(&self, place: &ContactPlace, teeth: f64, law: ContactLaw) -> ContactSpring {
        ContactSpring { law, least: -teeth, width_per_root_force: self.width_per_root_force(place) }
    }

    /// Hertz half-width at a place and a force, in m, independent of the compliance model, by the
    /// formula of [`ContactSpring::half_width`].
    pub fn half_width(&self, place: &ContactPlace, force: f64) -> f64 {
        self.width_per_root_force(place) * force.sqrt()
    }

    /// 1/E' = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, in 1/Pa.
    pub fn give(&self) -> f64 {
        self.driver.give() + self.driven.give()
    }

    fn width_per_root_force(&self, place: &ContactPlace) -> f64 {
        let curvature_radius = self.driver.oblique * place.curvature_radius;
        (4.0 * curvature_radius * self.give() / (PI * self.width)).sqrt()
    }
}

impl ElasticGear {
    /// (1 − ν²)/E, in 1/Pa.
    fn give(&self) -> f64 {
        (1.0 - self.poisson) * (1.0 + self.poisson) / self.young
    }
}

/// The contact under the impact force, for the step q_H.
fn at_impact(context: &Context) -> Option<f64> {
    let (elasticity, geometry) = (context.inputs.elasticity(), &context.solution.geometry);
    let spring = elasticity.contact_spring(geometry, &place_at_d(context)?).ok()?;
    spring.compliance(context.solution.impact?.force).ok()
}

fn place_at_d(context: &Context) -> Option<ContactPlace> {
    let tip = context.solution.position?.contact;
    Some(ContactPlace::at_tip(context.inputs.driven.tip_radius, &context.solution.geometry, &tip))
}

impl ContactCompliance {
    /// Every model, in the order of the list.
    pub const ALL: [ContactCompliance; MODELS.len()] =
        [ContactCompliance::LOGARITHMIC, ContactCompliance::CONSTANT, ContactCompliance::WEBER];

    /// The names in a case file.
    pub const NAMES: [&str; MODELS.len()] = [MODELS[0].name, MODELS[1].name, MODELS[2].name];

    /// One sentence for each model, for the form.
    pub const HELP: &str = "logarithmic: Eq. 55. constant: Yang & Sun 1985. weber: Weber & Banaschek \
        1953, from the thickness of the teeth.";

    /// The entry of the list.
    pub fn model(self) -> &'static ContactModel {
        MODELS.into_iter().find(|model| model.name == self.name()).unwrap_or(MODELS[0])
    }
}

const LOGARITHMIC: ContactModel = ContactModel {
    name: "logarithmic",
    index: "log",
    reads_root: false,
    steps: &[step(
        "q_H",
        "contact at the impact force, Eq. 55",
        "um mm/N",
        Text("(1.27 + 0.781 ln(m/a_H))/(π E')"),
        at_impact,
    )],
    law: |elasticity, _, _| Ok(logarithmic(elasticity)),
};

impl ContactCompliance {
    /// Eq. 55, logarithmic in the Hertz half-width.
    pub const LOGARITHMIC: ContactCompliance = ContactCompliance::named(LOGARITHMIC.name);
}

/// Offset and slope of Eq. 55.
///
/// # Formula
/// ```text
/// qH = 2 (1 − ν²)/(π E) (1.27 + 0.781 ln(m/a))
/// ```
/// For two materials (1 − ν²)/E is the mean.
///
/// # Source
/// Zhou & Chen 2014, Eq. 55 (from Xiao & Tang 1995).
///
/// # Valid for
/// A half-width small against the module. q_H is negative for a above 5.08 m.
fn logarithmic(elasticity: &Elasticity) -> ContactLaw {
    const CONSTANT: f64 = 1.27;
    const FACTOR: f64 = 0.781;
    let give = elasticity.give();
    ContactLaw {
        offset: give / PI * (CONSTANT + FACTOR * elasticity.driver.rack.module.ln()),
        slope: give / PI * FACTOR,
    }
}

const CONSTANT: ContactModel = ContactModel {
    name: "constant",
    index: "const",
    reads_root: false,
    steps: &[step(
        "q_H",
        "contact at any force, Yang & Sun 1985",
        "um mm/N",
        Text("2/(π E')"),
        at_impact,
    )],
    law: |elasticity, _, _| Ok(constant(elasticity)),
};

impl ContactCompliance {
    /// 4 (1 − ν²)/(π E), Yang & Sun 1985.
    pub const CONSTANT: ContactCompliance = ContactCompliance::named(CONSTANT.name);
}

/// Contact compliance without the half-width, q_H = 4 (1 − ν²)/(π E), in m²/N.
///
/// # Source
/// Yang & Sun 1985, "A rotary model for spur gear dynamics". For two materials (1 − ν²)/E is the
/// mean.
fn constant(elasticity: &Elasticity) -> ContactLaw {
    ContactLaw { offset: 2.0 * elasticity.give() / PI, slope: 0.0 }
}

/// The step of the depth h at a gear.
macro_rules! depth_step {
    ($symbol:literal, $meaning:literal, $gear:ident, $radius:ident) => {
        step($symbol, $meaning, "mm", Words("from the tooth profile"), |k| {
            let rack = Rack::of(k.inputs, &k.inputs.$gear);
            let profile = Profile::of(&rack, &k.solution.geometry.$gear);
            Some(profile.depth_along_force(place_at_d(k)?.$radius))
        })
    };
}

const WEBER: ContactModel = ContactModel {
    name: "weber",
    index: "weber",
    reads_root: true,
    steps: &[
        step(
            "q_H",
            "contact at the impact force, Weber & Banaschek 1953",
            "um mm/N",
            Text(
                "(1 - ν1²)/(π E1) (2 ln(2 h_1/a_H) - ν1/(1 - ν1)) + (1 - ν2²)/(π E2) (2 \
                    ln(2 h_2/a_H) - ν2/(1 - ν2))",
            ),
            at_impact,
        ),
        depth_step!(
            "h_1",
            "from the driver's flank at O1D to the centre line of its tooth, along the force",
            driver,
            radius_driver
        ),
        depth_step!(
            "h_2",
            "from the driven tip to the centre line of its tooth, along the force",
            driven,
            radius_driven
        ),
    ],
    law: weber,
};

impl ContactCompliance {
    /// Weber & Banaschek 1953, from the depth to the tooth's centre line.
    pub const WEBER: ContactCompliance = ContactCompliance::named(WEBER.name);
}

/// Offset and slope of Weber's contact term.
///
/// # Formula
/// ```text
/// qH = Σ (1 − ν_i²)/(π E_i) (2 ln(2 h_i/a) − ν_i/(1 − ν_i))
/// ```
/// h_i is the depth from the contact to the centre line of the tooth along the line of force.
///
/// # Source
/// Weber & Banaschek 1953, "Formänderung und Profilrücknahme bei gerad- und schrägverzahnten
/// Rädern".
///
/// # Valid for
/// A half-width small against the depth h.
///
/// # Errors
/// [`Refusal::PointedTip`] if the tooth has no thickness at the load point.
fn weber(
    elasticity: &Elasticity,
    geometry: &Geometry,
    place: &ContactPlace,
) -> Result<ContactLaw, Refusal> {
    let of = |gear: &ElasticGear, depth: f64| {
        let scale = gear.give() / PI;
        ContactLaw {
            offset: scale * (2.0 * (2.0 * depth).ln() - gear.poisson / (1.0 - gear.poisson)),
            slope: 2.0 * scale,
        }
    };
    let depth = |gear: &ElasticGear, circles: &Circles, radius: f64| {
        depth(&Profile::of_flank(&gear.rack, &gear.circles(circles)?), radius + gear.rise)
    };
    let driver = depth(&elasticity.driver, &geometry.driver, place.radius_driver)?;
    let driven = depth(&elasticity.driven, &geometry.driven, place.radius_driven)
        .map_err(Refusal::at_driven)?;
    Ok(of(&elasticity.driver, driver) + of(&elasticity.driven, driven))
}

/// Depth from the flank to the centre line of the tooth at a radius.
fn depth(profile: &Profile, radius: f64) -> Result<f64, Refusal> {
    let depth = profile.depth_along_force(radius);
    if depth > 0.0 {
        Ok(depth)
    } else {
        Err(Refusal::PointedTip { gear: GearSide::Driver, thickness: 2.0 * depth })
    }
}

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
