//! Involute geometry of the pair: circles, line of action, start of contact.

/// Circles of one gear, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Circles {
    /// Reference radius r = m z/2.
    pub reference: f64,
    /// Base radius r_b = r cos α.
    pub base: f64,
    /// Active tip radius r_a, the chamfer taken off.
    pub tip: f64,
    /// Radius of curvature of the involute at the tip, √(r_a² − r_b²).
    pub tip_curvature: f64,
    /// Root radius r_f of a tooth cut by the standard rack (dedendum 1.25 m).
    pub root: f64,
}

/// Geometry of the pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geometry {
    /// Circles of the driver.
    pub driver: Circles,
    /// Circles of the driven gear.
    pub driven: Circles,
    /// Centre distance a, in m.
    pub centre_distance: f64,
    /// Working pressure angle α_w, in rad.
    pub working_pressure_angle: f64,
    /// Base pitch p_b = π m cos α, in m.
    pub base_pitch: f64,
    /// N₁E: from the driver's point of tangency to the start of contact, in m.
    pub start: f64,
    /// N₁B: from the driver's point of tangency to the end of contact, in m.
    pub end: f64,
    /// N₁N₂, in m.
    pub tangent_length: f64,
    /// Contact ratio ε = EB/p_b.
    pub contact_ratio: f64,
    /// γ₂: angle at O₂ between the centre line and the tip at E, in rad.
    pub start_angle_driven: f64,
}
