//! Compliance of the teeth and of the contact between them.

/// Compliance of the two teeth at D, contact excluded, per unit width, in m²/N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TeethCompliance {
    /// Driver's tooth q₁, loaded at O₁D.
    pub driver: f64,
    /// Driven tooth q₂, loaded at its tip.
    pub driven: f64,
}
