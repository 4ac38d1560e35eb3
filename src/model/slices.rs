//! The face width in slices. In a plane across the axis a helical pair is a spur pair, so that each
//! slice is the mesh of the transverse section in another phase and with another gap.

pub mod balance;
mod course;
pub mod load;
pub(super) mod motion;

use std::sync::Arc;

use super::Refusal;
use super::face::FaceInputs;
use super::geometry::Geometry;
use super::mesh::Mesh;
use crate::numeric::chebyshev::Series;

/// A slice: its middle, or at an end of the face its end.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Slice {
    z: f64,
    /// Width that the slice stands for, in m.
    width: f64,
    /// Distance of the next slice; 0 at the last, in m.
    step: f64,
    /// Path ahead of the middle of the face, in m.
    ahead: f64,
    /// Gap by misalignment and flank lines, in m.
    gap: f64,
    /// Factors of the compliance of driver's and driven tooth.
    ends: [f64; 2],
}

impl Slice {
    /// The slice at z without its width.
    fn at(inputs: &FaceInputs, z: f64) -> Slice {
        let ends = [0, 1].map(|gear| inputs.end_factor(gear, z));
        Slice { z, width: 0.0, step: 0.0, ahead: inputs.lead * z, gap: inputs.gap(z), ends }
    }
}

/// The face width of a mesh in slices.
#[derive(Debug, Clone)]
pub struct Face {
    inputs: FaceInputs,
    mesh: Arc<Mesh>,
    /// The section over the path of a pair, see [`Mesh::sections`].
    sections: Arc<Series<5>>,
    slices: Vec<Slice>,
    /// Greatest path of a slice ahead of the middle, in m.
    reach: f64,
    /// Least gap by misalignment and flank lines, in m.
    least_gap: f64,
}

impl Face {
    /// The face width of a mesh in slices.
    ///
    /// # Formula
    /// ```text
    /// s_k(z) = s + k p_bt + h z tan β_b,   gap = S(s_k) + reliefs(s_k) + e(z) − e_k
    /// ```
    /// s is the path of the incoming pair since E in the middle of the face, and e(z) the opening
    /// by misalignment and flank lines.
    ///
    /// # Source
    /// A turn about parallel axes keeps each point in its plane across the axis, so that flanks and
    /// tip edges close their gaps in each plane as the spur section does.
    ///
    /// # Errors
    /// A [`Refusal`] if a compliance cannot be computed.
    pub fn new(
        inputs: &FaceInputs,
        geometry: &Geometry,
        mesh: &Arc<Mesh>,
    ) -> Result<Face, Refusal> {
        let places = inputs.places(inputs.count(mesh.base_pitch));
        let slice = |number: usize| {
            let z = places[number];
            let before = number.checked_sub(1).map_or(z, |before| places[before]);
            let after = places.get(number + 1).copied().unwrap_or(z);
            Slice { width: 0.5 * (after - before), step: after - z, ..Slice::at(inputs, z) }
        };
        let slices: Vec<Slice> = (0..places.len()).map(slice).collect();
        Ok(Face {
            inputs: *inputs,
            mesh: Arc::clone(mesh),
            sections: mesh.sections(geometry)?,
            reach: 0.5 * inputs.width * inputs.lead.abs(),
            least_gap: slices.iter().map(|slice| slice.gap).fold(f64::INFINITY, f64::min),
            slices,
        })
    }

    /// z of each slice, in m.
    pub fn places(&self) -> impl Iterator<Item = f64> {
        self.slices.iter().map(|slice| slice.z)
    }
}
