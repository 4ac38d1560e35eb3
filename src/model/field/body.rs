//! Displacements of the gear body in a field: twist about the bore, and shift.

use std::f64::consts::PI;

/// Displacement of all teeth along the line of action from the body's twist about its clamped
/// bore, dimensionless: per force and face width, times Young's modulus. Radii in m.
///
/// # Formula
/// ```text
/// r_b² (1 + ν)/(2π) (1/r_h² − 1/r_f²)
/// ```
///
/// # Source
/// A ring under shear at its rim (Timoshenko & Goodier, "Theory of Elasticity").
///
/// # Valid for
/// 0 < r_h < r_f.
#[must_use]
pub fn twist(base: f64, root: f64, bore: f64, poisson: f64) -> f64 {
    base * base * (1.0 + poisson) / (2.0 * PI) * (root - bore) * (root + bore)
        / (bore * root * bore * root)
}

/// Displacement of the body along the net force for each unit of ln(r_f/r_h), dimensionless: per
/// force and face width, times Young's modulus.
///
/// # Formula
/// ```text
/// (3 − 4ν)(1 + ν)/(4π (1 − ν))
/// ```
///
/// # Source
/// A line load in plane strain (Kelvin's solution, Timoshenko & Goodier, "Theory of Elasticity").
///
/// # Valid for
/// 0 <= ν < 1/2.
#[must_use]
pub fn shift(poisson: f64) -> f64 {
    (3.0 - 4.0 * poisson) * (1.0 + poisson) / (4.0 * PI * (1.0 - poisson))
}
