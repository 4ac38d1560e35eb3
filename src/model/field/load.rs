//! Elliptical patches on the flank as nodal forces, and the measured displacements.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Vector2;

use super::boundary::Boundary;
use super::element::line_shapes;
use super::mesh::{LoadPlace, Mesh};

/// Forces on nodes, or the weights of nodal displacements in a measured displacement.
pub(super) type NodeVector = Vec<(usize, Vector2<f64>)>;

/// A unit load on the flank and its measured displacements; lengths in modules.
#[derive(Debug, Clone)]
pub(super) struct Load {
    /// Roll angle at the load, in rad.
    pub(super) roll: f64,
    /// Angle between the force and the normal of the centre line, in rad.
    pub(super) angle: f64,
    /// Half width of the patch.
    pub(super) half_width: f64,
    /// Distance along the force from the flank to the centre line.
    pub(super) depth: f64,
    /// The force, spread over the patch.
    pub(super) force: NodeVector,
    /// The displacement along the force at the centre of the patch.
    pub(super) surface: NodeVector,
    /// The displacement along the force on the centre line.
    pub(super) centre: NodeVector,
}

impl Load {
    /// The load at a place of the mesh.
    pub(super) fn at(mesh: &Mesh, boundary: &Boundary, place: &LoadPlace) -> Load {
        let angle = boundary.load_angle(place.roll);
        let direction = -Vector2::new(angle.cos(), angle.sin());
        let half_width = place.heights[0].min(place.heights[1]);
        let shares = patch_shares(place.heights, half_width);
        let middle = place.nodes[2];
        let along = |node: usize, share: f64| (node, direction * share);
        Load {
            roll: place.roll,
            angle,
            half_width,
            depth: mesh.places[middle].x / angle.cos(),
            force: place
                .nodes
                .into_iter()
                .zip(shares)
                .map(|(node, share)| along(node, share))
                .collect(),
            surface: vec![along(middle, 1.0)],
            centre: centre_shares(mesh, boundary.base / angle.cos())
                .map(|(node, share)| along(node, share))
                .into(),
        }
    }
}

/// Weights of the nodes of two rows under an elliptical pressure centred between the rows.
///
/// # Formula
/// ```text
/// ∫ N p ds,  p = 2/(π w) √(1 − (s/w)²),  s = w sin t:  2/π ∫ N cos² t dt
/// ```
fn patch_shares(heights: [f64; 2], half_width: f64) -> [f64; 5] {
    const STEPS: usize = 24;
    let mut shares = [0.0; 5];
    let step = FRAC_PI_2 / STEPS as f64;
    for index in 0..STEPS {
        let (sine, cosine) = ((index as f64 + 0.5) * step).sin_cos();
        let weight = 2.0 / PI * cosine * cosine * step;
        for (row, height) in heights.into_iter().enumerate() {
            let from_middle = 2.0 * half_width * sine / height - 1.0;
            for (node, shape) in line_shapes(from_middle).into_iter().enumerate() {
                shares[if row == 0 { 2 - node } else { 2 + node }] += weight * shape;
            }
        }
    }
    shares
}

/// Weights of three nodes of the centre line in its displacement at a distance from the gear's
/// centre.
fn centre_shares(mesh: &Mesh, distance: f64) -> [(usize, f64); 3] {
    const STEPS: usize = 8;
    let height = |node: usize| mesh.places[node].y;
    let mut found = [0; 3];
    for edge in mesh.centre_edges() {
        found = edge;
        if height(edge[2]) <= distance {
            break;
        }
    }
    let [top, middle, bottom] = found.map(height);
    let mut at = 0.0;
    for _ in 0..STEPS {
        let shapes = line_shapes(at);
        let here = top * shapes[0] + middle * shapes[1] + bottom * shapes[2];
        let slope = (bottom - top) / 2.0 + at * (top - 2.0 * middle + bottom);
        at = (at + (distance - here) / slope).clamp(-1.0, 1.0);
    }
    let shapes = line_shapes(at);
    std::array::from_fn(|index| (found[index], shapes[index]))
}
