//! Force, energy and duration of the impact, its friction, and the spread of its force over the
//! stiffness models.

use std::f64::consts::PI;

use super::compliance::{ContactPlace, Teeth, model_of};
use super::geometry::Geometry;
use super::inputs::{ContactCompliance, Inputs, Method, ToothCompliance};
use super::masses::Masses;
use super::position::{TipContact, angle_by_growth, seen_from, tip_at};
use super::{Refusal, TeethCompliance, Velocity};
use crate::numeric::bounds;

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
    /// Hertz half-width at F_S, in m.
    pub hertz_half_width: f64,
    /// Hertz pressure of the rounded tip edge at F_S, in Pa. `None` for a sharp edge.
    pub corner_pressure: Option<f64>,
    /// Impact duration T_S of the method, in s.
    pub duration: f64,
    /// Impact duration by Eq. 32 as printed, in s.
    pub duration_printed: f64,
    /// Half period of the model's spring, in s.
    pub duration_spring: f64,
    /// (2/π) F_S T_S/(M ΔV_n): 2 for the elastic spring, impossible below 1.
    pub impulse_ratio: f64,
}

impl Impact {
    /// Eq. 32 with Hertz's prefactor, in s.
    pub fn duration_hertz(&self) -> f64 {
        HERTZ_PREFACTOR * self.duration_printed
    }

    /// Whether force and duration can belong to one impact.
    pub(super) fn is_possible(&self) -> bool {
        const ROUNDING: f64 = 1e-9;
        (1.0 - ROUNDING..=2.0 + ROUNDING).contains(&self.impulse_ratio)
    }
}

/// The impact of the driven tip on the driver's flank: force, energy, duration.
///
/// # Formula
/// ```text
/// Ek = M ΔVn²/2,  Wf = M ΔVτ²/2,  FS = ΔVn √(b M/qs),  qs = q1 + q2 + qH(FS)
/// TS = (m_red²/(π² ΔVn ρS E'²))^(1/5)  as printed,  π √(M qs/b)  of the spring
/// ```
/// The Hertz half-width in q_H and F_S are solved together.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 50-57. Corrected: Eq. 53 is inverted (δ_s = F_S q_s/b, which agrees with
/// Eq. 57). The pair of Eq. 54 is the pair in contact at D, with the load at the tip of the driven
/// tooth. The energies apply to the whole width. Eq. 32 has the reduced mass of Eq. 33 in kg; Hertz's
/// duration for two spheres is 4.53398 times as long, because the paper omits the prefactor.
///
/// # Errors
/// [`Refusal::HertzWidthTooLarge`] if Eq. 55 has no solution.
pub fn impact(
    inputs: &Inputs,
    teeth: &Teeth,
    masses: &Masses,
    tip: &TipContact,
    compliance: &TeethCompliance,
    velocity: &Velocity,
) -> Result<Impact, Refusal> {
    let (geometry, width) = (teeth.geometry(), teeth.width());
    let place = ContactPlace::at_tip(inputs.driven.tip_radius, geometry, tip);
    let spring = teeth.spring(&place)?;
    let effective_mass = masses.effective(geometry, tip);
    let (force, pair_compliance) =
        spring.impact(compliance.sum(), velocity.normal * (width * effective_mass).sqrt())?;
    let ratio = masses.reduced() * teeth.give() / PI;
    let duration_printed = (ratio * ratio / (velocity.normal * place.curvature_radius)).powf(0.2);
    let duration_spring = PI * (effective_mass * pair_compliance / width).sqrt();
    let is_printed = inputs.method == Method::Paper;
    let duration = if is_printed { duration_printed } else { duration_spring };
    let half_width = spring.half_width(force);
    let pressure = 2.0 * force / (PI * half_width * width);
    Ok(Impact {
        force,
        effective_mass,
        pair_compliance,
        energy: 0.5 * effective_mass * velocity.normal * velocity.normal,
        sliding_energy: 0.5 * effective_mass * velocity.sliding * velocity.sliding,
        hertz_half_width: half_width,
        corner_pressure: inputs.driven.tip_radius.map(|_| pressure),
        duration,
        duration_printed,
        duration_spring,
        impulse_ratio: 2.0 / PI * force * duration / (effective_mass * velocity.normal),
    })
}

/// The factor of Hertz's duration that Eq. 32 omits: 2.868265699 π^(2/5). The first factor is 2
/// (15/16)^(2/5) ∫₀¹ dx/√(1 − x^(5/2)).
pub const HERTZ_PREFACTOR: f64 = 4.533_977_164_008_488;

/// Change of the velocities between D and D'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// |change of ΔV_τ|/|change of ΔV_n|, Eqs. 44, 45, 64. `None` if D' does not exist.
    pub ratio: Option<f64>,
}

/// The ratio of the changes of sliding and approach velocity between D and D'.
///
/// # Formula
/// ```text
/// f = |ΔV_D'τ − ΔV_Dτ|/|ΔV_D'n − ΔV_Dn|,   V_D2' = V_D2 + FS TS/m_red,   TS by Eq. 32 as printed
/// ```
///
/// # Source
/// Zhou & Chen 2014, Eqs. 29-45 and 64. Corrected: m_red in kg in Eq. 31; in Eq. 34, O₁D' follows
/// from the chord instead of the arc of Eq. 36; Eq. 42 is the law of cosines; Eqs. 44 and 45 are
/// the changes between D and D'. The method `paper` uses D' of Eq. 34, although the angle at O₁ in
/// its triangle is not Δθ. `exact` uses the driven tip at u − ω₂ T_S, at most at E.
///
/// # Valid for
/// The ratio is kinematic. Coulomb's coefficient does not limit it.
pub fn friction(
    inputs: &Inputs,
    geometry: &Geometry,
    tip: &TipContact,
    velocity: &Velocity,
    impact: &Impact,
    reduced_mass: f64,
) -> Friction {
    let speeds = (inputs.speed, inputs.speed / geometry.ratio);
    let turn = speeds.1 * impact.duration_printed;
    let from_contact = seen_from(geometry, tip);
    let end = match inputs.method {
        Method::Paper => printed_end(&from_contact, tip, turn),
        _ => Some(tip_after(geometry, &from_contact, tip, turn)),
    };
    let gained = impact.force * impact.duration_printed / (reduced_mass * tip.radius_driven);
    let ratio = end
        .map(|end| changes_ratio(speeds, &end, gained))
        .filter(|ratio| ratio.is_finite() && velocity.normal > 0.0);
    Friction { ratio }
}

/// |change of ΔV_τ|/|change of ΔV_n| to the end of the impact. The driven gear gains `gained`
/// rad/s.
fn changes_ratio((driver_speed, driven_speed): (f64, f64), end: &TipContact, gained: f64) -> f64 {
    let normal = driven_speed * end.normal_radius_drop - gained * end.normal_radius_driven;
    let sliding = driven_speed * end.normal_length_growth - driver_speed * end.curvature_growth
        + gained * end.normal_length_driven;
    (sliding / normal).abs()
}

/// D' after a rotation of the tip by `turn` from D, at most at E, with the changes since D. For a
/// short path they are increments from D, for a long path differences of two increments from E.
fn tip_after(
    geometry: &Geometry,
    from_contact: &Geometry,
    tip: &TipContact,
    turn: f64,
) -> TipContact {
    let rest = tip.angle - turn;
    if rest > 0.5 * tip.angle {
        return tip_at(from_contact, -turn);
    }
    let end = tip_at(geometry, rest.max(0.0));
    TipContact {
        normal_radius_drop: end.normal_radius_drop - tip.normal_radius_drop,
        normal_length_growth: end.normal_length_growth - tip.normal_length_growth,
        curvature_growth: end.curvature_growth - tip.curvature_growth,
        ..end
    }
}

/// D' by Eq. 34, relative to D: the driven tip where O₁D' closes the triangle O₁DD' with the angle
/// Δθ = i `turn` at O₁ and the chord of `turn` as DD'. `None` if the triangle does not close.
///
/// Near the pitch point r_a2 is nearly i O₁D, and the chord nearly the needed length across O₁D.
/// Small terms give their difference without cancellation.
fn printed_end(from_contact: &Geometry, tip: &TipContact, turn: f64) -> Option<TipContact> {
    let at_driver = turn * from_contact.ratio;
    let chord = 2.0 * from_contact.driven.tip * (turn / 2.0).sin();
    let lateral = tip.radius_driver * at_driver.sin();
    let rest = tip_excess(from_contact, tip) * turn
        - 2.0 * from_contact.driven.tip * below_angle(turn / 2.0)
        + tip.radius_driver * below_angle(at_driver);
    let closing = rest * (chord + lateral);
    let shortened = -2.0 * tip.radius_driver * (at_driver / 2.0).sin().powi(2) - closing.sqrt();
    let end_radius = tip.radius_driver + shortened;
    let end = tip_at(
        from_contact,
        angle_by_growth(from_contact, shortened * (tip.radius_driver + end_radius)),
    );
    (end_radius > 0.0 && end.radius_driver.is_finite()).then_some(end)
}

/// r_a2 − i O₁D, in m, from the arms of the velocities: `r_a2² − i² O₁D² = (N2'D² − i² ρ1²) −
/// (r_b2² − r_b2'²)`.
fn tip_excess(from_contact: &Geometry, tip: &TipContact) -> f64 {
    let (ratio, base) = (from_contact.ratio, from_contact.driver.base);
    let along = tip.sliding_arm * (tip.normal_length_driven + ratio * tip.curvature_driver);
    let across = tip.normal_radius_drop * (ratio * base + tip.normal_radius_driven);
    (along - across) / (from_contact.driven.tip + ratio * tip.radius_driver)
}

/// x − sin x. Uses the series if the difference would lose digits.
fn below_angle(angle: f64) -> f64 {
    const SMALL: f64 = 0.5;
    if angle.abs() > SMALL {
        return angle - angle.sin();
    }
    let square = angle * angle;
    let rest = (2..=7).rev().fold(1.0, |rest, half| {
        let order = f64::from(2 * half);
        1.0 - square / (order * (order + 1.0)) * rest
    });
    angle * square / 6.0 * rest
}

/// Least and greatest impact force over the stiffness models that cover the pair, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// By the most compliant models.
    pub low: f64,
    /// By the stiffest models.
    pub high: f64,
}

/// A tooth compliance with a contact compliance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StiffnessModels {
    /// Model of the teeth.
    pub tooth: ToothCompliance,
    /// Model of the contact; `None` if the model of the teeth includes the contact.
    pub contact: Option<ContactCompliance>,
}

impl StiffnessModels {
    /// The models of a pair: given by the case, otherwise by range and method.
    pub fn of(inputs: &Inputs) -> StiffnessModels {
        let tooth = model_of(inputs);
        let contact = (!tooth.model().has_contact).then_some(inputs.contact_compliance);
        StiffnessModels { tooth, contact }
    }

    /// The models that cover the pair, without the models of the case.
    pub fn others(inputs: &Inputs) -> impl Iterator<Item = StiffnessModels> {
        let own = StiffnessModels::of(inputs);
        StiffnessModels::covering(inputs).filter(move |models| *models != own)
    }

    /// The models of a pair whose case names no tooth compliance.
    pub fn by_default(inputs: &Inputs) -> StiffnessModels {
        StiffnessModels::of(&Inputs { tooth_compliance: None, ..inputs.clone() })
    }

    /// Every tooth model with every contact model that it needs.
    pub fn all() -> impl Iterator<Item = StiffnessModels> {
        ToothCompliance::ALL.into_iter().flat_map(|tooth| {
            let has_contact = tooth.model().has_contact;
            let others = ContactCompliance::ALL.map(Some).into_iter().filter(move |_| !has_contact);
            let own = has_contact.then_some(None);
            own.into_iter().chain(others).map(move |contact| StiffnessModels { tooth, contact })
        })
    }

    /// The models whose tooth model covers the pair.
    pub fn covering(inputs: &Inputs) -> impl Iterator<Item = StiffnessModels> {
        let covers = ToothCompliance::ALL.map(|tooth| (tooth, (tooth.model().covers)(inputs)));
        StiffnessModels::all().filter(move |models| covers.contains(&(models.tooth, true)))
    }

    /// The inputs with these models.
    pub fn in_place_of(&self, inputs: &Inputs) -> Inputs {
        Inputs {
            tooth_compliance: Some(self.tooth),
            contact_compliance: self.contact.unwrap_or(inputs.contact_compliance),
            // The switch of the case applies to its own tooth model alone.
            tooth_coupling: inputs.tooth_coupling || self.tooth != model_of(inputs),
            ..inputs.clone()
        }
    }

    /// The symbol of the impact force by these models.
    pub fn symbol(&self) -> String {
        let contact = self.contact.map(|contact| format!(",{}", contact.model().index));
        format!("F_{}{}", self.tooth.model().index, contact.unwrap_or_default())
    }

    /// The names of the models.
    pub fn names(&self) -> String {
        let contact = self.contact.map(|contact| format!(" and {}", contact.name()));
        format!("{}{}", self.tooth.name(), contact.unwrap_or_default())
    }
}

/// The range of the impact force over every pair of stiffness models that covers the pair, and the
/// models of the case. Each force uses its own deflection unless the case gives the deflection.
/// `force` is the result of the case's models. `solved` computes the others, or `None` if a model
/// has no result.
pub fn band(inputs: &Inputs, force: f64, solved: impl Fn(&Inputs) -> Option<f64>) -> Band {
    let others = StiffnessModels::others(inputs);
    let others = others.filter_map(|models| solved(&models.in_place_of(inputs)));
    let (low, high) = bounds(others.chain([force]));
    Band { low, high }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_agrees_with_the_difference() {
        assert!((below_angle(0.5) / (0.5 - 0.5f64.sin()) - 1.0).abs() < 1e-14);
        assert!((below_angle(0.5000001) / below_angle(0.4999999) - 1.0).abs() < 2e-6);
        assert!((below_angle(1e-3) / (1e-9 / 6.0) - 1.0 + 5e-8).abs() < 1e-12);
    }
}
