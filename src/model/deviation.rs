//! What brings the tooth in early: equivalent error and combined deflection.

/// Deviation along the line of action, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Equivalent error Δf, Eqs. 1 and 2.
    pub equivalent_error: f64,
    /// Combined deflection δ of the pair that carries the load, Eqs. 3 and 4.
    pub combined_deflection: f64,
    /// Δ = Δf + δ, Eq. 5. Without Δ > 0 no tooth strikes.
    pub total: f64,
}
