//! Half a tooth pitch condensed to the cut in the middle of the space.

use super::element::{self, Stiffness};
use super::envelope::{Envelope, dot};
use super::load::{Load, NodeVector};
use super::mesh::Mesh;

/// Marks a fixed displacement component.
const FIXED: usize = usize::MAX;

/// Symmetry of a displacement about the centre line of the tooth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    /// No displacement across the centre line.
    Symmetric,
    /// No displacement along the centre line.
    Antisymmetric,
}

/// Half a pitch condensed to the cut, radial components before tangential ones.
#[derive(Debug, Clone)]
pub(super) struct Condensed {
    /// Nodes on the cut.
    pub(super) nodes: usize,
    /// Stiffness, row by row.
    pub(super) stiffness: Vec<f64>,
    /// One entry for each load.
    pub(super) loads: Vec<CondensedLoad>,
}

/// A load condensed to the cut.
#[derive(Debug, Clone)]
pub(super) struct CondensedLoad {
    /// Force on the cut, for half of the load on each flank.
    pub(super) force: Vec<f64>,
    /// Weights of the cut's displacement in the displacement at the centre of the patch.
    pub(super) surface: Vec<f64>,
    /// Weights of the cut's displacement in the displacement on the centre line.
    pub(super) centre: Vec<f64>,
    /// Displacement at the centre of the patch with a fixed cut.
    pub(super) held_surface: f64,
    /// Displacement on the centre line with a fixed cut.
    pub(super) held_centre: f64,
}

/// Numbers of the unknowns of a mode.
struct Unknowns {
    /// The unknowns of each node: across and along the centre line, or on the cut radial and
    /// tangential.
    of_node: Vec<[usize; 2]>,
    /// Unknowns off the cut.
    inner: usize,
    /// All unknowns.
    count: usize,
}

impl Unknowns {
    fn of(mesh: &Mesh, mode: Mode) -> Unknowns {
        let (inner_nodes, cut) = (mesh.inner(), mesh.on_cut());
        let mut is_free = vec![true; inner_nodes];
        for element in &mesh.elements {
            is_free[element[element::MIDDLE]] = false;
        }
        let mut count = 0;
        let mut next = |is_free: bool| {
            let unknown = if is_free { count } else { FIXED };
            count += usize::from(is_free);
            unknown
        };
        let mut of_node: Vec<_> = (0..inner_nodes)
            .map(|node| {
                let is_central = mesh.is_central(node);
                [Mode::Symmetric, Mode::Antisymmetric]
                    .map(|held| next(is_free[node] && (!is_central || mode != held)))
            })
            .collect();
        let inner = count;
        of_node.extend((inner..inner + cut).map(|radial| [radial, radial + cut]));
        of_node.resize(mesh.places.len(), [FIXED; 2]);
        Unknowns { of_node, inner, count: inner + 2 * cut }
    }

    /// First column of each row of the stiffness matrix.
    fn first_columns(&self, mesh: &Mesh) -> Vec<usize> {
        let mut first: Vec<_> = (0..self.count).collect();
        for element in &mesh.elements {
            let unknowns = element.iter().flat_map(|&node| self.of_node[node]);
            let least = unknowns.clone().min().unwrap_or(FIXED);
            for unknown in unknowns.filter(|&unknown| unknown != FIXED) {
                first[unknown] = first[unknown].min(least);
            }
        }
        first
    }

    /// The parts of a vector on free unknowns.
    fn free<'a>(&'a self, vector: &'a NodeVector) -> impl Iterator<Item = (usize, f64)> + 'a {
        let parts = vector.iter().flat_map(|&(node, part)| {
            let [across, along] = self.of_node[node];
            [(across, part.x), (along, part.y)]
        });
        parts.filter(|&(unknown, _)| unknown != FIXED)
    }
}

/// Condenses a mode of the mesh. `stiffnesses` belong to its elements, in the same order.
///
/// Returns `None` if rounding makes the stiffness matrix indefinite.
pub(super) fn condense(
    mesh: &Mesh,
    stiffnesses: &[Stiffness],
    loads: &[Load],
    mode: Mode,
) -> Option<Condensed> {
    let unknowns = Unknowns::of(mesh, mode);
    let vectors: Vec<_> = loads
        .iter()
        .flat_map(|load| [(&load.force, 0.5), (&load.surface, 1.0), (&load.centre, 1.0)])
        .collect();
    let mut first = unknowns.first_columns(mesh);
    first.extend(vectors.iter().map(|(vector, _)| {
        let free = unknowns.free(vector).map(|(unknown, _)| unknown);
        free.min().unwrap_or(unknowns.inner)
    }));
    let mut matrix = Envelope::new(first, unknowns.count);
    for (element, stiffness) in mesh.elements.iter().zip(stiffnesses) {
        let members = element.map(|node| unknowns.of_node[node]);
        add_element(&mut matrix, members.as_flattened(), stiffness);
    }
    for (row, (vector, scale)) in vectors.iter().enumerate() {
        for (unknown, value) in unknowns.free(vector) {
            matrix.add(unknowns.count + row, unknown, scale * value);
        }
    }
    matrix.eliminate(unknowns.inner).then(|| collect(&matrix, &unknowns, loads.len()))
}

/// Adds the stiffness of an element with the given unknowns.
fn add_element(matrix: &mut Envelope, members: &[usize], stiffness: &Stiffness) {
    for (row, entries) in members.iter().zip(stiffness) {
        for (column, entry) in members.iter().zip(entries) {
            if column <= row && *row != FIXED {
                matrix.add(*row, *column, *entry);
            }
        }
    }
}

/// Rotates the unknowns of an element's nodes on the cut to the radial and tangential directions.
/// The angle between cut and centre line is in rad.
pub(super) fn turn(stiffness: &mut Stiffness, is_on_cut: [bool; 9], angle: f64) {
    let (sine, cosine) = angle.sin_cos();
    let polar =
        |across: f64, along: f64| [across * sine + along * cosine, across * cosine - along * sine];
    for node in (0..9).filter(|&node| is_on_cut[node]) {
        let [across, along] = [stiffness[2 * node], stiffness[2 * node + 1]];
        let turned: [_; 18] = std::array::from_fn(|other| polar(across[other], along[other]));
        stiffness[2 * node] = turned.map(|pair| pair[0]);
        stiffness[2 * node + 1] = turned.map(|pair| pair[1]);
        for row in &mut *stiffness {
            [row[2 * node], row[2 * node + 1]] = polar(row[2 * node], row[2 * node + 1]);
        }
    }
}

/// Reads the condensed values from the eliminated matrix.
fn collect(matrix: &Envelope, unknowns: &Unknowns, loads: usize) -> Condensed {
    let (inner, count) = (unknowns.inner, unknowns.count);
    let size = count - inner;
    let mut stiffness = vec![0.0; size * size];
    for row in 0..size {
        let (first, entries) = matrix.row(inner + row, inner);
        for (column, entry) in (first - inner..).zip(entries) {
            stiffness[row * size + column] = *entry;
            stiffness[column * size + row] = *entry;
        }
    }
    let on_cut = |row: usize| {
        let mut values = vec![0.0; size];
        let (first, entries) = matrix.row(count + row, inner);
        values[first - inner..].copy_from_slice(entries);
        values
    };
    let held = |left: usize, right: usize| {
        let from = matrix.row(count + left, 0).0.max(matrix.row(count + right, 0).0);
        let (left, right) = (matrix.row(count + left, from).1, matrix.row(count + right, from).1);
        let inner = left.len().saturating_sub(size);
        dot(&left[..inner], &right[..inner])
    };
    let load = |index: usize| CondensedLoad {
        force: on_cut(3 * index),
        surface: on_cut(3 * index + 1),
        centre: on_cut(3 * index + 2),
        held_surface: held(3 * index, 3 * index + 1),
        held_centre: held(3 * index, 3 * index + 2),
    };
    Condensed { nodes: size / 2, stiffness, loads: (0..loads).map(load).collect() }
}
