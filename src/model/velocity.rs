//! How fast the tip approaches the flank and slides on it.

/// Velocities at D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Velocity {
    /// Approach velocity ΔV_n, in m/s.
    pub normal: f64,
    /// Sliding velocity ΔV_τ, in m/s.
    pub sliding: f64,
    /// Time from D to E, u/ω₂, in s.
    pub transit_time: f64,
    /// Friction coefficient below which sliding goes on throughout the impact, ΔV_τ/(2 ΔV_n).
    pub stick_limit: f64,
}
