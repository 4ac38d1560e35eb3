//! The force along the line of action.

use super::geometry::Geometry;
use super::inputs::Inputs;

/// Inputs of the mesh force, besides the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadInputs {
    /// Torque on the driver T₁, in N m.
    pub torque: f64,
}

impl LoadInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> LoadInputs {
        LoadInputs { torque: inputs.torque() }
    }
}

/// Mesh force F₀ = T₁/r_b1, in N.
#[must_use]
pub fn mesh_force(inputs: &LoadInputs, geometry: &Geometry) -> f64 {
    inputs.torque / geometry.driver.base
}
