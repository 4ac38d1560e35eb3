//! The mesh frequency and the natural frequency of the pair.

use std::f64::consts::TAU;

use super::inputs::Inputs;
use super::mesh::Mesh;

/// Inputs of the frequencies, besides mesh and masses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResonanceInputs {
    /// Speed of the driver ω₁, in rad/s.
    pub speed: f64,
}

impl ResonanceInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> ResonanceInputs {
        ResonanceInputs { speed: inputs.speed }
    }
}

/// Frequencies of a pair, in Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resonance {
    /// Tooth engagements per second, f_z = z₁ n₁.
    pub mesh_frequency: f64,
    /// Natural frequency f_n of the pair with the mean mesh stiffness.
    pub natural_frequency: f64,
}

impl Resonance {
    /// The frequencies of a mesh with the reduced mass in kg.
    ///
    /// # Formula
    /// ```text
    /// f_z = ω1 rb1/pb = z1 ω1/(2 π),   f_n = √(k_m/m_red)/(2 π),   N = f_z/f_n
    /// ```
    ///
    /// # Source
    /// ISO 6336-1:2019, 6.5: N = n1/n_E1, n_E1 = 30 000 √(c_γ/m_red)/(π z1).
    ///
    /// # Valid for
    /// Rigid shafts: one mass on the mesh stiffness.
    #[must_use]
    pub fn of(inputs: &ResonanceInputs, mesh: &Mesh, mass: f64) -> Resonance {
        Resonance {
            mesh_frequency: inputs.speed * mesh.base_radii.0 / mesh.base_pitch,
            natural_frequency: (mesh.mean_stiffness() / mass).sqrt() / TAU,
        }
    }

    /// N = f_z/f_n.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.mesh_frequency / self.natural_frequency
    }
}
