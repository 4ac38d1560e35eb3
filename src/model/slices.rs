//! The face width in slices. In a plane across the axis a helical pair is a spur pair, so that each
//! slice is the mesh of the transverse section in another phase and with another gap.

pub mod balance;
mod carried;
mod course;
pub mod load;
pub mod loads;
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
    /// What a difference of v to the slice before and after takes from one to the other, in m.
    exchange: [f64; 2],
    /// v of the slice before and after over that of this one, where no load acts on all slices beyond.
    tail: [f64; 2],
    /// Mean of a function over the slice less its value in the middle, over its change of slope, in m².
    spread: f64,
    /// z of both borders to the next slices, and the part of the slice before an end relief begins in it.
    borders: [f64; 2],
    bend: Option<f64>,
    /// Path ahead of the middle of the face, in m.
    ahead: f64,
    /// Gap by misalignment and flank lines, its mean over the slice, and at both borders, in m.
    gap: f64,
    mean_gap: f64,
    border_gaps: [f64; 2],
    /// Factors of the compliance of driver's and driven tooth, and their changes over the slice.
    ends: [f64; 2],
    end_changes: [f64; 2],
}

impl Slice {
    /// The slice at z without its width.
    fn at(inputs: &FaceInputs, z: f64) -> Slice {
        let ends = [0, 1].map(|gear| inputs.end_factor(gear, z));
        let gap = inputs.gap(z);
        Slice {
            z,
            width: 0.0,
            step: 0.0,
            exchange: [0.0; 2],
            tail: [0.0; 2],
            spread: 0.0,
            borders: [z; 2],
            bend: None,
            ahead: inputs.lead * z,
            gap,
            mean_gap: gap,
            border_gaps: [gap; 2],
            ends,
            end_changes: [0.0; 2],
        }
    }

    /// The slice from one place to another.
    fn between(inputs: &FaceInputs, z: f64, [from, to]: [f64; 2]) -> Slice {
        /// Of the width: the place is in the middle.
        const SAME: f64 = 1e-6;
        let (slice, width) = (Slice::at(inputs, z), to - from);
        Slice {
            width,
            spread: ((to - z).powi(3) - (from - z).powi(3)) / (6.0 * width),
            borders: [from, to],
            bend: inputs
                .bends()
                .find(|bend| (bend - z).abs() < SAME * width)
                .map(|_| (z - from) / width),
            mean_gap: mean(z, [from, to], |z| inputs.gap(z)),
            border_gaps: [from, to].map(|end| inputs.gap(end)),
            ends: [0, 1].map(|gear| mean(z, [from, to], |z| inputs.end_factor(gear, z))),
            end_changes: [0, 1]
                .map(|gear| inputs.end_factor(gear, to) - inputs.end_factor(gear, from)),
            ..slice
        }
    }

    /// q_t of a pair by the means of its sections for driver and driven tooth, and their changes over
    /// the slice.
    fn teeth(&self, teeth: [f64; 2], changes: [f64; 2]) -> f64 {
        let of = |gear: usize| {
            teeth[gear] * self.ends[gear] + changes[gear] * self.end_changes[gear] / 12.0
        };
        (of(0) + of(1)).max(0.0)
    }
}

/// Mean of a function between two places by Simpson's rule: a flank line is a parabola at most, and
/// bends at the middle z of a slice alone.
fn mean(z: f64, [from, to]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let bend = z.clamp(from.min(to), from.max(to));
    let part = |end: f64| {
        (bend - end).abs() * (of(bend) + 4.0 * of(f64::midpoint(bend, end)) + of(end)) / 6.0
    };
    (part(from) + part(to)) / (to - from).abs()
}

/// The face width of a mesh in slices.
#[derive(Debug, Clone)]
pub struct Face {
    inputs: FaceInputs,
    mesh: Arc<Mesh>,
    /// The section over the path of a pair, see [`Mesh::sections`].
    sections: Arc<Series<6>>,
    slices: Vec<Slice>,
    /// ε of [`Face::new`], and 1/L² by it, in 1/m².
    excess: f64,
    stiffening: f64,
    /// The places of a pair at which it passes into another zone.
    edges: Vec<f64>,
    /// Greatest path of a slice ahead of the middle, in m.
    reach: f64,
    /// Least gap by misalignment and flank lines, in m.
    least_gap: f64,
    /// Distance N1E, and length of the line of action N1N2, in m.
    line: (f64, f64),
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
    /// ```text
    /// u = (1 + ε) v − ε f,   v − L²/(1 + ε) v'' = f,   ε = h²/(12 L² − h²)
    /// ```
    /// With this v in slices of the width h, the mean of u over a slice has an error of fourth order in
    /// h, for u − L² u'' = f. In the middle of a slice u is smaller than this mean by u'' h²/24, and between
    /// two slices the cubic with both u and both u''.
    ///
    /// # Source
    /// A turn about parallel axes keeps each point in its plane across the axis, so that flanks and
    /// tip edges close their gaps in each plane as the spur section does. The compact differences of
    /// Collatz 1960, "The Numerical Treatment of Differential Equations", table III.
    ///
    /// # Errors
    /// A [`Refusal`] if a compliance cannot be computed.
    pub fn new(
        inputs: &FaceInputs,
        geometry: &Geometry,
        mesh: &Arc<Mesh>,
    ) -> Result<Face, Refusal> {
        let sections = mesh.sections(geometry)?;
        let places = inputs.places(inputs.count(mesh.base_pitch));
        let square = inputs.coupling_length * inputs.coupling_length;
        let step = inputs.width / (places.len() - 1).max(1) as f64;
        let excess = Face::excess(inputs, (mesh, &sections), step);
        let slice = |number: usize| {
            let z = places[number];
            let before = number.checked_sub(1).map_or(z, |before| places[before]);
            let after = places.get(number + 1).copied().unwrap_or(z);
            let exchange =
                |step: f64| if step > 0.0 { square / (1.0 + excess) / step } else { 0.0 };
            let borders = [before, after].map(|beside| f64::midpoint(z, beside));
            Slice {
                step: after - z,
                exchange: [exchange(z - before), exchange(after - z)],
                ..Slice::between(inputs, z, borders)
            }
        };
        let mut slices: Vec<Slice> = (0..places.len()).map(slice).collect();
        for side in [0, 1] {
            let mut pivot = f64::INFINITY;
            for at in 0..slices.len() {
                let at = if side == 0 { at } else { slices.len() - 1 - at };
                let slice = &mut slices[at];
                slice.tail[side] = slice.exchange[side] / pivot;
                let own = slice.width + slice.exchange[0] + slice.exchange[1];
                pivot = own - slice.exchange[side] * slice.tail[side];
            }
        }
        Ok(Face {
            inputs: *inputs,
            mesh: Arc::clone(mesh),
            sections,
            excess,
            stiffening: 12.0 * excess / ((1.0 + excess) * step * step),
            edges: mesh.edges().collect(),
            reach: 0.5 * inputs.width * inputs.lead.abs(),
            least_gap: slices.iter().map(|slice| slice.gap).fold(f64::INFINITY, f64::min),
            slices,
            line: (geometry.start, geometry.tangent_length),
        })
    }

    /// ε of [`Face::new`] for slices of a width, in m.
    fn excess(inputs: &FaceInputs, (mesh, sections): (&Mesh, &Series<6>), width: f64) -> f64 {
        /// Greatest ε: that of two slices in a coupling length.
        const MOST_EXCESS: f64 = 1.0 / 47.0;
        /// Greatest ε q_t/q_c, so that the loads stay definite.
        const MOST_TAKEN: f64 = 0.25;
        /// Steps over the path.
        const STEPS: usize = 16;
        let square = inputs.coupling_length * inputs.coupling_length;
        if square <= 0.0 {
            return 0.0;
        }
        let ((from, to), end) = (mesh.ends(), 0.5 * inputs.width);
        let ends =
            [0, 1].map(|gear| inputs.end_factor(gear, -end).max(inputs.end_factor(gear, end)));
        let softness = |step: usize| {
            let path = from + (to - from) * step as f64 / STEPS as f64;
            let [local, driver, driven] = [2, 3, 4].map(|at| sections.slope(at, path));
            (driver * ends[0] + driven * ends[1]) / local
        };
        let softest = (0..=STEPS).map(softness).fold(0.0, f64::max);
        let most = MOST_EXCESS.min(MOST_TAKEN / softest);
        let excess = width * width / (12.0 * square - width * width);
        if excess > 0.0 { excess.min(most) } else { most }
    }
}
