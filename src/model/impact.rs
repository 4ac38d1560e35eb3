//! Force, energy and duration of the impact at D.

/// The impact at D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Greatest impact force F_S, in N.
    pub force: f64,
    /// Effective mass M of Eq. 50, in kg.
    pub effective_mass: f64,
    /// Pair compliance q_s, in m²/N.
    pub pair_compliance: f64,
    /// Hertz half-width at F_S, in m.
    pub hertz_half_width: f64,
    /// Normal kinetic energy E_k of the whole width, in J.
    pub energy: f64,
    /// Energy of the sliding W_f, whole width, in J.
    pub sliding_energy: f64,
    /// Impact duration T_S of the rung, in s.
    pub duration: f64,
    /// Eq. 32 as printed, in s.
    pub duration_printed: f64,
    /// Eq. 32 with Hertz's prefactor, in s.
    pub duration_hertz: f64,
    /// Half period of the model's spring, in s.
    pub duration_spring: f64,
    /// (2/π) F_S T_S/(M ΔV_n): 2 for the elastic spring, below 1 impossible.
    pub impulse_ratio: f64,
}
