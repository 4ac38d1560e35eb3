//! Units at the door: text with a unit becomes SI, and back.

/// A physical dimension that a field or a quantity has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// A bare number.
    Number,
    /// m.
    Length,
    /// rad.
    Angle,
    /// Pa.
    Pressure,
    /// kg/m³.
    Density,
    /// W.
    Power,
    /// N m.
    Torque,
    /// rad/s.
    AngularVelocity,
    /// N.
    Force,
    /// s.
    Time,
    /// m/s.
    Velocity,
    /// kg.
    Mass,
    /// J.
    Energy,
    /// m²/N.
    Compliance,
}

/// What one of the unit is in SI; `None` for an unknown unit. "1" and "" are the number one.
#[must_use]
pub fn factor(unit: &str) -> Option<f64> {
    Some(match unit {
        "" | "1" | "m" | "N" | "s" | "m/s" | "kg" | "J" | "m2/N" | "rad" => 1.0,
        "mm" => 1e-3,
        "um" | "us" => 1e-6,
        "um mm/N" => 1e-9,
        "deg" => std::f64::consts::PI / 180.0,
        _ => return None,
    })
}
