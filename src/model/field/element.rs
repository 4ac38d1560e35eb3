//! Stiffness of a nine-node element in plane strain, and elliptical patches on the flank as nodal
//! forces.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::{Matrix2, Vector2};

use super::mesh::{Boundary, LoadPlace, Mesh};

/// Stiffness of an element for Young's modulus 1 and width 1, with two components per node.
pub(super) type Stiffness = [[f64; 18]; 18];

/// Places and weights of the 3-point Gauss rule on (-1, 1).
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 9.0), (0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0)];

/// Lamé's constants for Young's modulus 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Material {
    first: f64,
    shear: f64,
}

impl Material {
    /// λ = ν/((1 + ν)(1 − 2ν)) and μ = 1/(2 (1 + ν)).
    pub(super) fn of(poisson: f64) -> Material {
        Material {
            first: poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
            shear: 0.5 / (1.0 + poisson),
        }
    }
}

/// The quadratic shape functions of a line from −1 to 1.
fn line_shapes(at: f64) -> [f64; 3] {
    [0.5 * at * (at - 1.0), (1.0 - at) * (1.0 + at), 0.5 * at * (at + 1.0)]
}

/// The slopes of the shape functions.
fn line_slopes(at: f64) -> [f64; 3] {
    [at - 0.5, -2.0 * at, at + 0.5]
}

/// Integrals of products of the shape functions' gradients.
#[derive(Default)]
struct Products {
    xx: [[f64; 9]; 9],
    xy: [[f64; 9]; 9],
    yy: [[f64; 9]; 9],
}

/// Stiffness of the element. `None` if the map folds at a point of the rule.
pub(super) fn stiffness(places: &[Vector2<f64>; 9], material: Material) -> Option<Stiffness> {
    let mut products = Products::default();
    for (across, across_weight) in GAUSS {
        for (along, along_weight) in GAUSS {
            let (gradients, area) = gradients(places, across, along)?;
            products.add(&gradients, across_weight * along_weight * area);
        }
    }
    Some(products.stiffness(material))
}

/// The node in the middle of an element, which no other element shares.
pub(super) const MIDDLE: usize = 4;

/// Condenses the middle node, which has no load. Its rows and columns become zero.
pub(super) fn take_middle_out(stiffness: &mut Stiffness) {
    for unknown in [2 * MIDDLE, 2 * MIDDLE + 1] {
        let taken = stiffness[unknown];
        let pivot = taken[unknown];
        for row in stiffness.iter_mut() {
            let share = row[unknown] / pivot;
            for (entry, taken) in row.iter_mut().zip(&taken) {
                *entry -= share * taken;
            }
            row[unknown] = 0.0;
        }
        stiffness[unknown] = [0.0; 18];
    }
}

/// Whether the map folds at a point of the rule.
pub(super) fn folds(places: &[Vector2<f64>; 9]) -> bool {
    let points = GAUSS.map(|(place, _)| place);
    points
        .iter()
        .any(|&across| points.iter().any(|&along| gradients(places, across, along).is_none()))
}

/// Gradients of the shape functions at a point of the element, and the map's determinant.
fn gradients(places: &[Vector2<f64>; 9], across: f64, along: f64) -> Option<([[f64; 9]; 2], f64)> {
    let (a, da) = (line_shapes(across), line_slopes(across));
    let (b, db) = (line_shapes(along), line_slopes(along));
    let slopes: [Vector2<f64>; 9] = std::array::from_fn(|node| {
        Vector2::new(da[node / 3] * b[node % 3], a[node / 3] * db[node % 3])
    });
    let map: Matrix2<f64> =
        places.iter().zip(&slopes).map(|(place, slope)| slope * place.transpose()).sum();
    let determinant = map.determinant();
    if determinant.is_nan() || determinant <= 0.0 {
        return None;
    }
    let inverse = Matrix2::new(map.m22, -map.m12, -map.m21, map.m11) / determinant;
    let gradients = slopes.map(|slope| inverse * slope);
    Some(([gradients.map(|g| g.x), gradients.map(|g| g.y)], determinant))
}

impl Products {
    fn add(&mut self, [x, y]: &[[f64; 9]; 2], weight: f64) {
        for row in 0..9 {
            let (left, up) = (weight * x[row], weight * y[row]);
            for column in 0..9 {
                self.xx[row][column] += left * x[column];
                self.xy[row][column] += left * y[column];
                self.yy[row][column] += up * y[column];
            }
        }
    }

    fn stiffness(&self, material: Material) -> Stiffness {
        let (first, shear) = (material.first, material.shear);
        let normal = first + 2.0 * shear;
        let mut stiffness = [[0.0; 18]; 18];
        for (row, column) in (0..9).flat_map(|row| (0..9).map(move |column| (row, column))) {
            let (xx, yy) = (self.xx[row][column], self.yy[row][column]);
            let (xy, yx) = (self.xy[row][column], self.xy[column][row]);
            stiffness[2 * row][2 * column] = normal * xx + shear * yy;
            stiffness[2 * row][2 * column + 1] = first * xy + shear * yx;
            stiffness[2 * row + 1][2 * column] = first * yx + shear * xy;
            stiffness[2 * row + 1][2 * column + 1] = normal * yy + shear * xx;
        }
        stiffness
    }
}

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
