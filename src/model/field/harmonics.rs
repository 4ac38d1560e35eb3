//! The displacements of the whole gear from half a pitch, by a Fourier sum over its teeth.

use std::f64::consts::TAU;

use super::PITCHES;
use super::envelope::{Envelope, dot};
use super::load::Load;
use super::mode::{Condensed, CondensedLoad};
use crate::numeric::quadrature;

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
    teeth: u32,
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
        let phase = TAU * harmonic / f64::from(teeth);
        let matrix = eliminated([symmetric, antisymmetric], phase)?;
        let share = weight / f64::from(teeth);
        add_harmonic(&mut sums, &matrix, 2 * symmetric.nodes, count, phase, share);
    }
    Some(sums)
}

/// Harmonics of the sum over the teeth with their weights.
///
/// With many teeth the terms of high harmonics vary smoothly. An integral replaces their sum, from
/// half a harmonic before the first one, with the Euler-Maclaurin correction of 1/12 of the slope
/// at this end.
fn harmonics(teeth: u32) -> Vec<(f64, f64)> {
    const SUMMED: u32 = 20;
    const FEW_TEETH: u32 = 4 * SUMMED;
    const WIDE: f64 = 8.0;
    let weight = |harmonic: u32| {
        if harmonic == 0 || 2 * harmonic == teeth { 1.0 } else { 2.0 }
    };
    let single =
        |last: u32| (0..=last).map(move |harmonic| (f64::from(harmonic), weight(harmonic)));
    if teeth <= FEW_TEETH {
        return single(teeth / 2).collect();
    }
    let (from, to) = (f64::from(SUMMED) + 0.5, f64::from(teeth) / 2.0);
    let middle = if to < WIDE * from { to } else { (from * to).sqrt() };
    let smooth = [(from, middle), (middle, to)]
        .into_iter()
        .filter(|(from, to)| from < to)
        .flat_map(|(from, to)| {
            quadrature::nodes()
                .map(move |(part, weight)| (from + part * (to - from), 2.0 * weight * (to - from)))
        });
    single(SUMMED).chain(smooth).collect()
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
