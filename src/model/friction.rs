//! The paper's friction coefficient: a ratio of velocity changes over the impact.

use super::geometry::Geometry;
use super::inputs::{Inputs, Method};
use super::tip_gap::{TipContact, angle_by_growth, seen_from, tip_at};
use super::{Impact, Velocity};

/// Inputs of the friction ratio, besides geometry, masses and the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionInputs {
    /// `paper` uses Eq. 34 as printed.
    pub method: Method,
    /// Speed of the driver ω₁, in rad/s.
    pub speed: f64,
}

impl FrictionInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> FrictionInputs {
        FrictionInputs { method: inputs.method, speed: inputs.speed }
    }
}

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
#[must_use]
pub fn friction(
    inputs: &FrictionInputs,
    geometry: &Geometry,
    tip: &TipContact,
    velocity: &Velocity,
    impact: &Impact,
    reduced_mass: f64,
) -> Friction {
    let speeds = (inputs.speed, inputs.speed / geometry.ratio);
    let turn = speeds.1 * impact.duration_printed();
    let from_contact = seen_from(geometry, tip);
    let end = match inputs.method {
        Method::Paper => printed_end(&from_contact, tip, turn),
        _ => Some(tip_after(geometry, &from_contact, tip, turn)),
    };
    let gained = impact.force * impact.duration_printed() / (reduced_mass * tip.radius_driven);
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

#[cfg(test)]
mod tests {
    use super::below_angle;

    #[test]
    fn the_series_agrees_with_the_difference() {
        assert!((below_angle(0.5) / (0.5 - 0.5f64.sin()) - 1.0).abs() < 1e-14);
        assert!((below_angle(0.5000001) / below_angle(0.4999999) - 1.0).abs() < 2e-6);
        assert!((below_angle(1e-3) / (1e-9 / 6.0) - 1.0 + 5e-8).abs() < 1e-12);
    }
}
