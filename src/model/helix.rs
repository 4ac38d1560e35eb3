//! Helical geometry of ISO 21771 besides the transverse section.

use std::f64::consts::PI;

use super::geometry::Geometry;
use super::inputs::{Gear, Inputs};

/// Helical geometry and axial force of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Helix {
    /// Transverse module m_t, in m.
    pub transverse_module: f64,
    /// Transverse pressure angle α_t, in rad.
    pub transverse_pressure_angle: f64,
    /// Base helix angle β_b, in rad.
    pub base_helix_angle: f64,
    /// Virtual number of teeth z_n of driver and driven gear.
    pub virtual_teeth: [f64; 2],
    /// Axial pitch p_x, in m; infinite for β = 0.
    pub axial_pitch: f64,
    /// Overlap ratio ε_β.
    pub overlap_ratio: f64,
    /// Axial force on the driver towards +z, in N.
    pub axial_force: f64,
}

impl Inputs {
    /// Virtual number of teeth of a gear, z_n = z/(cos² β_b cos β).
    pub fn virtual_teeth(&self, gear: &Gear) -> f64 {
        let across = self.base_helix_angle().cos();
        f64::from(gear.teeth) / (across * across * self.helix_cosine())
    }

    /// Helical geometry. A spur pair has β = 0, and no axial pitch.
    ///
    /// # Formula
    /// ```text
    /// m_t = m_n/cos β,   tan α_t = tan α_n/cos β,   sin β_b = sin β cos α_n
    /// z_n = z/(cos² β_b cos β),   p_x = π m_n/sin β,   ε_β = b sin β/(π m_n)
    /// F_a = h F_0 tan β_b on the driver towards +z,   h = 1 for a right-hand driver, otherwise −1
    /// ```
    ///
    /// # Source
    /// ISO 21771:2007.
    pub fn helix(&self, geometry: &Geometry, mesh_force: f64) -> Helix {
        let base_helix_angle = self.base_helix_angle();
        let axial_pitch = PI * self.module / self.helix_angle.sin();
        Helix {
            transverse_module: self.transverse_module(),
            transverse_pressure_angle: self.transverse_pressure_angle(),
            base_helix_angle,
            virtual_teeth: [self.virtual_teeth(&self.driver), self.virtual_teeth(&self.driven)],
            axial_pitch,
            overlap_ratio: self.common_width() * base_helix_angle.tan() / geometry.base_pitch,
            // Zero has no sign.
            axial_force: self.driver_hand.sign() * mesh_force * base_helix_angle.tan() + 0.0,
        }
    }
}
