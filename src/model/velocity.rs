//! Approach velocity and sliding velocity of the tip on the flank.

use super::inputs::Inputs;
use super::tip_gap::TipContact;

/// Inputs of the velocities, besides the place of the tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityInputs {
    /// Speed of the driven gear ω₂, in rad/s.
    pub driven_speed: f64,
}

impl VelocityInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> VelocityInputs {
        VelocityInputs { driven_speed: inputs.driven_speed() }
    }
}

/// Velocities at D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Velocity {
    /// Approach velocity ΔV_n, in m/s.
    pub normal: f64,
    /// Sliding velocity ΔV_τ, in m/s.
    pub sliding: f64,
    /// Time from D to E, u/ω₂, in s.
    pub transit_time: f64,
    /// Friction coefficient below which sliding continues throughout the impact, ΔV_τ/(2 ΔV_n).
    pub stick_limit: f64,
}

/// Velocities of the tip against the flank.
///
/// # Formula
/// ```text
/// ΔVn = ω1 rb1 − ω2 rb2' = ω2 (rb2 − rb2')
/// ΔVτ = ω2 N2'D − ω1 N1'D = ω2 (N2'D − i ρ1)
/// ```
/// Both arms are increments from [`tip_at`](super::tip_gap::tip_at). Differences of the products
/// would lose digits near E and the pitch point.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 21-28. Eq. 27 is corrected to the law of cosines: as printed, ΔV_n at E
/// is 1.32 m/s for Table 1 instead of 0. Eq. 22 is ΔV_Dτ although its label differs.
#[must_use]
pub fn velocity(inputs: &VelocityInputs, tip: &TipContact) -> Velocity {
    let driven_speed = inputs.driven_speed;
    let normal = driven_speed * tip.normal_radius_drop;
    let sliding = driven_speed * tip.sliding_arm;
    Velocity {
        normal,
        sliding,
        transit_time: tip.angle / driven_speed,
        stick_limit: sliding / (2.0 * normal),
    }
}
