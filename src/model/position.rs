//! Where the driven tip first touches the driver's flank: D.

/// A place of the driven tip on its circle, and the driver's flank that it would touch there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipContact {
    /// Driven gear's angle before E, u, in rad.
    pub angle: f64,
    /// O₁D, in m.
    pub radius_driver: f64,
    /// Radius of curvature of the driver's flank ρ₁ = N₁'D, in m.
    pub curvature_driver: f64,
    /// Rise of the contact normal's angle over E, χ − α_w, in rad.
    pub normal_turn: f64,
    /// Distance from O₂ to the contact normal r_b2', in m.
    pub normal_radius_driven: f64,
    /// r_b2 − r_b2' = dS/du, in m.
    pub normal_radius_drop: f64,
    /// N₂'D along the contact normal, in m.
    pub normal_length_driven: f64,
    /// Reduced radius of curvature ρ_S, in m.
    pub curvature_radius: f64,
}

/// The first contact D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Driver's angle from D to E, θ₁, in rad.
    pub approach_angle_driver: f64,
    /// Driven gear's angle from D to E, u, in rad.
    pub approach_angle_driven: f64,
    /// The contact at D.
    pub contact: TipContact,
    /// Gap that the tip has closed there, S(u), in m: Δ in the rung `exact`, far less in `paper`.
    pub closed_gap: f64,
}
