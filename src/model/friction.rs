//! The paper's friction coefficient: a ratio of velocity changes over the impact.

/// Change of the velocities between D and D'.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    /// |change of ΔV_τ|/|change of ΔV_n|, Eqs. 44, 45, 64; absent where D' does not exist.
    pub ratio: Option<f64>,
}
