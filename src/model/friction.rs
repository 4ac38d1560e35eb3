//! The paper's friction coefficient: a ratio of velocity changes over the impact.

use super::geometry::Geometry;
use super::inputs::{Inputs, Rung};
use super::position::{TipContact, tip_at};
use super::{Impact, Velocity};

/// Change of the velocities between D and D'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// |change of ΔV_τ|/|change of ΔV_n|, Eqs. 44, 45, 64; absent where D' does not exist.
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
/// Zhou & Chen 2014, Eqs. 29-45 and 64. Mended: m_red in kg in Eq. 31; Eq. 34 finds O₁D' with the chord for Eq. 36's
/// arc; Eq. 42 is the law of cosines; Eqs. 44 and 45 are the changes between D and D'. In the rung `paper` D' is that
/// of Eq. 34, although the angle at O₁ in its triangle is not Δθ; in `exact` it is the driven tip at u − ω₂ T_S, not
/// past E.
///
/// # Valid for
/// A kinematic ratio: it is not bounded by Coulomb's coefficient.
#[must_use]
pub fn friction(
    inputs: &Inputs,
    geometry: &Geometry,
    tip: &TipContact,
    velocity: &Velocity,
    impact: &Impact,
    reduced_mass: f64,
) -> Friction {
    let turn = inputs.driven_speed() * impact.duration_printed;
    let end = match inputs.rung {
        Rung::Paper => printed_end(inputs, geometry, tip, turn),
        Rung::Exact => Some(tip_at(geometry, (tip.angle - turn).max(0.0))),
    };
    let gained = impact.force * impact.duration_printed / (reduced_mass * geometry.driven.tip);
    let ratio =
        end.map(|end| changes_ratio(inputs, tip, &end, gained)).filter(|ratio| ratio.is_finite() && velocity.normal > 0.0);
    Friction { ratio }
}

/// |change of ΔV_τ|/|change of ΔV_n|, the driven gear having gained `gained` rad/s.
fn changes_ratio(inputs: &Inputs, from: &TipContact, to: &TipContact, gained: f64) -> f64 {
    let driven_speed = inputs.driven_speed();
    let normal = driven_speed * (to.normal_radius_drop - from.normal_radius_drop) - gained * to.normal_radius_driven;
    let sliding = driven_speed * (to.normal_length_growth - from.normal_length_growth)
        - inputs.speed * (to.curvature_growth - from.curvature_growth)
        + gained * to.normal_length_driven;
    (sliding / normal).abs()
}

/// D' by Eq. 34: the driven tip where O₁D' closes the triangle O₁DD' with the angle Δθ = i `turn` at O₁ and the chord
/// of `turn` as DD'. `None` where the triangle does not close.
fn printed_end(inputs: &Inputs, geometry: &Geometry, tip: &TipContact, turn: f64) -> Option<TipContact> {
    let at_driver = turn * inputs.ratio();
    let chord = 2.0 * geometry.driven.tip * (turn / 2.0).sin();
    let lateral = tip.radius_driver * at_driver.sin();
    let closing = (chord - lateral) * (chord + lateral);
    if closing < 0.0 {
        return None;
    }
    let shortened = -2.0 * tip.radius_driver * (at_driver / 2.0).sin().powi(2) - closing.sqrt();
    angle_after(geometry, tip, shortened).map(|angle| tip_at(geometry, angle)).filter(|end| end.radius_driver.is_finite())
}

/// The driven tip's angle before E where O₁D has grown by `growth`. `None` where the tip circle does not reach there.
fn angle_after(geometry: &Geometry, tip: &TipContact, growth: f64) -> Option<f64> {
    let grown_square = growth * (2.0 * tip.radius_driver + growth);
    let arm = geometry.centre_distance * geometry.driven.tip;
    let half = f64::midpoint(geometry.start_angle_driven, tip.angle).sin();
    let square = half * half + grown_square / (4.0 * arm);
    ((0.0..=1.0).contains(&square)).then(|| 2.0 * square.sqrt().asin() - geometry.start_angle_driven)
}
