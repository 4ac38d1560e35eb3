//! Half a tooth pitch condensed to the cut in the middle of the space, and the displacements of the
//! whole gear by a Fourier sum over its teeth.

use std::f64::consts::TAU;

use super::element::{Load, NodeVector, Stiffness};
use super::mesh::Mesh;
use super::{PITCHES, element};
use crate::numeric::quadrature;

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
    held_surface: f64,
    /// Displacement on the centre line with a fixed cut.
    held_centre: f64,
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

/// Displacements under unit loads, for Young's modulus 1.
#[derive(Debug, Clone)]
pub(super) struct Displacements {
    /// On the loaded tooth at the centre of each patch.
    pub(super) surface: Vec<f64>,
    /// On the loaded tooth on the centre line.
    pub(super) centre: Vec<f64>,
    /// On the teeth up to [`PITCHES`] pitches clockwise, for a load on the right flank, averaged
    /// over the patch. Rows are loads, columns are measured places.
    pub(super) cross: [Vec<f64>; PITCHES],
}

/// The vectors of one mode for each load after the elimination of a harmonic.
struct Solved<'a> {
    matrix: &'a Envelope,
    size: usize,
    row: usize,
}

impl Solved<'_> {
    fn vector(&self, load: usize, kind: usize) -> &[f64] {
        self.matrix.row(self.size + self.row + 3 * load + kind, 0).1
    }
}

/// Displacements of the gear with the two condensed modes.
///
/// # Formula
/// ```text
/// u_k = [k = 0] held + 1/z Σ_n w_n (A cos μk − B sin μk),  μ = 2π n/z
/// H = Ds Ss Ds + Da Sa Da,  Ds = diag(cos μ/2, sin μ/2),  Da = diag(sin μ/2, −cos μ/2)
/// A = γs Ds H⁻¹ Ds gs + γa Da H⁻¹ Da ga,  B = γa Da H⁻¹ Ds gs − γs Ds H⁻¹ Da ga
/// ```
/// w_n is 1 for n = 0 and n = z/2, otherwise 2. g belongs to the load, γ to the measured place.
///
/// Returns `None` if rounding makes a stiffness matrix indefinite.
pub(super) fn displacements(
    symmetric: &Condensed,
    antisymmetric: &Condensed,
    loads: &[Load],
    teeth: f64,
) -> Option<Displacements> {
    let count = loads.len();
    let held = |of: fn(&CondensedLoad) -> f64| {
        let pairs = symmetric.loads.iter().zip(&antisymmetric.loads);
        pairs.map(|(left, right)| of(left) + of(right)).collect()
    };
    let mut sums = Displacements {
        surface: held(|load| load.held_surface),
        centre: held(|load| load.held_centre),
        cross: [(); PITCHES].map(|()| vec![0.0; count * count]),
    };
    for (harmonic, weight) in harmonics(teeth) {
        let phase = TAU * harmonic / teeth;
        let matrix = eliminated([symmetric, antisymmetric], phase)?;
        let share = weight / teeth;
        add_harmonic(&mut sums, &matrix, 2 * symmetric.nodes, count, phase, share);
    }
    Some(sums)
}

/// Harmonics of the sum over the teeth with their weights. Their terms are even about z/2. Of a virtual gear
/// with another than a whole number of teeth, what the whole harmonics leave to z is at z/2 and half a harmonic
/// beside it, so that the sum has no jumps over z.
///
/// With many teeth the terms of high harmonics vary smoothly. An integral replaces their sum, from
/// half a harmonic before the first one, with the Euler-Maclaurin correction of 1/12 of the slope
/// at this end.
fn harmonics(teeth: f64) -> Vec<(f64, f64)> {
    const SUMMED: u32 = 20;
    const FEW_TEETH: f64 = 4.0 * SUMMED as f64;
    const WIDE: f64 = 8.0;
    let single = |last: u32| {
        (0..=last).map(|harmonic| (f64::from(harmonic), if harmonic == 0 { 1.0 } else { 2.0 }))
    };
    if teeth <= FEW_TEETH {
        let last = ((teeth - 1.0) / 2.0).floor();
        let rest = teeth - 1.0 - 2.0 * last;
        let middle = 1.0 - (rest - 1.0).abs();
        let ends = [(teeth / 2.0, middle), (teeth / 2.0 - 0.5, rest - middle)];
        return single(last as u32).chain(ends.into_iter().filter(|end| end.1 > 0.0)).collect();
    }
    let (from, to) = (f64::from(SUMMED) + 0.5, teeth / 2.0);
    let middle = if to < WIDE * from { to } else { (from * to).sqrt() };
    let smooth = [(from, middle), (middle, to)]
        .into_iter()
        .filter(|(from, to)| from < to)
        .flat_map(|(from, to)| {
            quadrature::nodes()
                .map(move |(part, weight)| (from + part * (to - from), 2.0 * weight * (to - from)))
        });
    let slope = [(from - 0.5, -1.0 / 12.0), (from + 0.5, 1.0 / 12.0)];
    single(SUMMED).chain(slope).chain(smooth).collect()
}

/// The eliminated matrix of a harmonic, bordered by the vectors of both modes.
fn eliminated(modes: [&Condensed; 2], phase: f64) -> Option<Envelope> {
    let size = 2 * modes[0].nodes;
    let (sine, cosine) = (phase / 2.0).sin_cos();
    let scales = [[cosine, sine], [sine, -cosine]];
    let part = |index: usize| usize::from(2 * index >= size);
    let rows = modes.map(|mode| 3 * mode.loads.len()).iter().sum::<usize>();
    let mut matrix = Envelope::new(vec![0; size + rows], size);
    for (mode, scale) in modes.iter().zip(&scales) {
        for row in 0..size {
            for column in 0..=row {
                let factor = scale[part(row)] * scale[part(column)];
                matrix.add(row, column, factor * mode.stiffness[row * size + column]);
            }
        }
    }
    let vectors = modes.iter().zip(&scales).flat_map(|(mode, scale)| {
        let loads = mode.loads.iter();
        loads.flat_map(move |load| {
            [&load.force, &load.surface, &load.centre].map(|all| (all, scale))
        })
    });
    for (row, (vector, scale)) in vectors.enumerate() {
        for (column, value) in vector.iter().enumerate() {
            matrix.add(size + row, column, value * scale[part(column)]);
        }
    }
    matrix.eliminate(size).then_some(matrix)
}

/// Adds the terms of a harmonic to the sums.
fn add_harmonic(
    sums: &mut Displacements,
    matrix: &Envelope,
    size: usize,
    count: usize,
    phase: f64,
    share: f64,
) {
    let [even, odd] = [0, 3 * count].map(|row| Solved { matrix, size, row });
    let turns: [_; PITCHES] = std::array::from_fn(|pitch| (phase * (pitch + 1) as f64).sin_cos());
    for load in 0..count {
        let (from_even, from_odd) = (even.vector(load, 0), odd.vector(load, 0));
        let own = |kind: usize| {
            dot(from_even, even.vector(load, kind)) + dot(from_odd, odd.vector(load, kind))
        };
        sums.surface[load] += share * own(1);
        sums.centre[load] += share * own(2);
        for measured in 0..count {
            let (to_even, to_odd) = (even.vector(measured, 0), odd.vector(measured, 0));
            let in_phase = dot(from_even, to_even) + dot(from_odd, to_odd);
            let across = dot(from_even, to_odd) - dot(from_odd, to_even);
            for (sum, (sine, cosine)) in sums.cross.iter_mut().zip(turns) {
                sum[load * count + measured] += 2.0 * share * (cosine * in_phase - sine * across);
            }
        }
    }
}

/// A symmetric positive definite matrix with additional border rows for right-hand sides.
///
/// Each row stores the entries from its first nonzero entry to the diagonal. A border row stores
/// entries up to the last column of the matrix.
#[derive(Debug, Clone)]
pub(super) struct Envelope {
    /// Column of the first entry of each row.
    first: Vec<usize>,
    /// Index of the first entry of each row, and one past the last.
    offset: Vec<usize>,
    values: Vec<f64>,
    /// Columns of the matrix.
    columns: usize,
}

impl Envelope {
    /// A zero matrix with the given first columns. Rows past `columns` belong to the border.
    pub(super) fn new(first: Vec<usize>, columns: usize) -> Envelope {
        let mut offset = Vec::with_capacity(first.len() + 1);
        offset.push(0);
        let mut end = 0;
        for (row, first) in first.iter().enumerate() {
            end += columns.min(row + 1) - first;
            offset.push(end);
        }
        Envelope { values: vec![0.0; end], first, offset, columns }
    }

    /// Adds to an entry on or below the diagonal, within the envelope.
    pub(super) fn add(&mut self, row: usize, column: usize, value: f64) {
        let index = self.offset[row] + column - self.first[row];
        self.values[index] += value;
    }

    /// The entries of a row from column `from`, without zeros left of the envelope, and the column
    /// of the first entry.
    pub(super) fn row(&self, row: usize, from: usize) -> (usize, &[f64]) {
        let start = from.max(self.first[row]);
        let values = &self.values[self.offset[row]..self.offset[row + 1]];
        (start, &values[start - self.first[row]..])
    }

    /// Eliminates the first `count` columns. These become Cholesky's factor L, the rest of the
    /// matrix its Schur complement, and each border row b becomes L⁻¹ b with the reduced b in the
    /// other columns.
    ///
    /// Returns `false` if the matrix is not positive definite.
    ///
    /// # Source
    /// George & Liu 1981, "Computer Solution of Large Sparse Positive Definite Systems", chapter 4.
    pub(super) fn eliminate(&mut self, count: usize) -> bool {
        let mut inverse = Vec::with_capacity(count);
        for row in 0..self.first.len() {
            let first = self.first[row];
            let (done, rest) = self.values.split_at_mut(self.offset[row]);
            let current = &mut rest[..self.offset[row + 1] - self.offset[row]];
            for column in first..self.columns.min(row) {
                let from = first.max(self.first[column]);
                let to = column.min(count);
                let above = &done[self.offset[column]..];
                let start = self.first[column];
                let removed = if from < to {
                    dot(&current[from - first..to - first], &above[from - start..to - start])
                } else {
                    0.0
                };
                let value = current[column - first] - removed;
                current[column - first] = inverse.get(column).map_or(value, |scale| value * scale);
            }
            if row < self.columns {
                let known = &current[..row.min(count).saturating_sub(first)];
                let pivot = current[row - first] - dot(known, known);
                if row < count {
                    if pivot.is_nan() || pivot <= 0.0 {
                        return false;
                    }
                    inverse.push(pivot.sqrt().recip());
                }
                current[row - first] = pivot;
            }
        }
        true
    }
}

/// Sum of products, in eight partial sums for vector instructions.
pub(super) fn dot(left: &[f64], right: &[f64]) -> f64 {
    const LANES: usize = 8;
    let (left_chunks, right_chunks) = (left.chunks_exact(LANES), right.chunks_exact(LANES));
    let rest: f64 = left_chunks
        .remainder()
        .iter()
        .zip(right_chunks.remainder())
        .map(|(left, right)| left * right)
        .sum();
    let mut sums = [0.0; LANES];
    for (left, right) in left_chunks.zip(right_chunks) {
        for ((sum, left), right) in sums.iter_mut().zip(left).zip(right) {
            *sum += left * right;
        }
    }
    sums.iter().sum::<f64>() + rest
}
