//! Force, energy and duration of the impact.

use std::f64::consts::PI;

use super::compliance::ComplianceInputs;
use super::compliance::contact::{ContactSpring, plane_strain_compliance};
use super::geometry::Geometry;
use super::inputs::{Inputs, Method};
use super::masses::Masses;
use super::position::reduced_curvature;
use super::tip_gap::TipContact;
use super::{Refusal, TeethCompliance, Velocity};

/// The impact at D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Greatest impact force F_S, in N.
    pub force: f64,
    /// Effective mass M of Eq. 50, in kg.
    pub effective_mass: f64,
    /// Pair compliance q_s, in m²/N.
    pub pair_compliance: f64,
    /// Normal kinetic energy E_k of the whole width, in J.
    pub energy: f64,
    /// Energy of the sliding W_f, whole width, in J.
    pub sliding_energy: f64,
    /// Values for the durations and the half-width, which are computed on demand: a study of the
    /// force does not need them.
    terms: Terms,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Terms {
    method: Method,
    /// Common face width b, in m.
    width: f64,
    /// Approach velocity ΔV_n, in m/s.
    approach: f64,
    /// Reduced mass of Eq. 33, in kg.
    reduced_mass: f64,
    /// Reduced radius of curvature ρ_S, in m.
    curvature_radius: f64,
    /// 1/E', in 1/Pa.
    give: f64,
    /// The contact.
    spring: ContactSpring,
}

impl Impact {
    /// Hertz half-width at F_S, in m.
    #[must_use]
    pub fn hertz_half_width(&self) -> f64 {
        self.terms.spring.half_width(self.force)
    }

    /// Impact duration T_S of the method, in s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        match self.terms.method {
            Method::Paper => self.duration_printed(),
            _ => self.duration_spring(),
        }
    }

    /// Impact duration by Eq. 32 as printed, in s.
    ///
    /// # Formula
    /// ```text
    /// TS = (m_red²/(π² ΔVn ρS E'²))^(1/5)
    /// ```
    ///
    /// # Source
    /// Zhou & Chen 2014, Eq. 32, with the reduced mass of Eq. 33 in kg. Hertz's duration for two
    /// spheres is 4.53398 times as long, because the paper omits the prefactor.
    #[must_use]
    pub fn duration_printed(&self) -> f64 {
        let Terms { approach, curvature_radius, .. } = self.terms;
        let ratio = self.terms.reduced_mass * self.terms.give / PI;
        (ratio * ratio / (approach * curvature_radius)).powf(0.2)
    }

    /// Eq. 32 with Hertz's prefactor, in s.
    #[must_use]
    pub fn duration_hertz(&self) -> f64 {
        HERTZ_PREFACTOR * self.duration_printed()
    }

    /// Half period of the model's spring, in s.
    #[must_use]
    pub fn duration_spring(&self) -> f64 {
        PI * (self.effective_mass * self.pair_compliance / self.terms.width).sqrt()
    }

    /// (2/π) F_S T_S/(M ΔV_n): 2 for the elastic spring, impossible below 1.
    #[must_use]
    pub fn impulse_ratio(&self) -> f64 {
        2.0 / PI * self.force * self.duration() / (self.effective_mass * self.terms.approach)
    }
}

/// Inputs of force, energy and duration of an impact, besides geometry, masses, place and velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImpactInputs {
    /// `paper` uses Eq. 32 as printed.
    pub method: Method,
    /// Inputs of the compliance at the place of the impact.
    pub compliance: ComplianceInputs,
    /// 1/E' of the pair, in 1/Pa.
    pub give: f64,
}

impl ImpactInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> ImpactInputs {
        let compliance = ComplianceInputs::of(inputs);
        ImpactInputs {
            method: inputs.method,
            give: plane_strain_compliance(&compliance.elasticity),
            compliance,
        }
    }
}

/// The impact of the driven tip on the driver's flank: force, energy, duration.
///
/// # Formula
/// ```text
/// Ek = M ΔVn²/2,  Wf = M ΔVτ²/2,  FS = ΔVn √(b M/qs),  qs = q1 + q2 + qH(FS)
/// ```
/// The Hertz half-width in q_H and F_S are solved together.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 50-57. Corrected: Eq. 53 is inverted (δ_s = F_S q_s/b, which agrees with
/// Eq. 57). The pair of Eq. 54 is the pair in contact at D, with the load at the tip of the driven
/// tooth. The energies apply to the whole width.
///
/// # Errors
/// [`Refusal::HertzWidthTooLarge`] if Eq. 55 has no solution.
pub fn impact(
    inputs: &ImpactInputs,
    geometry: &Geometry,
    masses: &Masses,
    tip: &TipContact,
    (teeth, spring): (&TeethCompliance, &ContactSpring),
    velocity: &Velocity,
) -> Result<Impact, Refusal> {
    let width = inputs.compliance.elasticity.width;
    let effective_mass = masses.effective(geometry, tip);
    let (force, pair_compliance) =
        spring.impact(teeth.sum(), velocity.normal * (width * effective_mass).sqrt())?;
    Ok(Impact {
        force,
        effective_mass,
        pair_compliance,
        energy: 0.5 * effective_mass * velocity.normal * velocity.normal,
        sliding_energy: 0.5 * effective_mass * velocity.sliding * velocity.sliding,
        terms: Terms {
            method: inputs.method,
            width,
            approach: velocity.normal,
            reduced_mass: masses.reduced(),
            curvature_radius: reduced_curvature(inputs.compliance.tip_radius, geometry, tip),
            give: inputs.give,
            spring: *spring,
        },
    })
}

/// The factor of Hertz's duration that Eq. 32 omits: 2.868265699 π^(2/5). The first factor is 2
/// (15/16)^(2/5) ∫₀¹ dx/√(1 − x^(5/2)).
pub const HERTZ_PREFACTOR: f64 = 4.533_977_164_008_488;
