//! Load sharing of coupled pairs between two borders of the mesh, as polynomials.

use std::array::from_fn;
use std::sync::{Arc, Mutex, PoisonError};

use crate::model::pair_forces::{Compliances, PITCHES, Touching};
use crate::numeric::chebyshev::{Series, TERMS};
use crate::numeric::polynomial::Polynomial;

/// Number of functions evaluated together.
const LANES: usize = 4;

/// Cached shares of a mesh. All motions on the mesh use them, because they do not depend on speed
/// and deviation.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    known: Mutex<Vec<Known>>,
}

/// This is a cache, which does not affect the equality of meshes.
impl PartialEq for Sharing {
    fn eq(&self, _: &Sharing) -> bool {
        true
    }
}

#[derive(Debug)]
struct Known {
    zones: Vec<usize>,
    touching: Touching,
    shares: Arc<Shares>,
}

impl Sharing {
    /// The shares of the pairs in these zones for a set of touching pairs. Calls `new` if they are
    /// not cached.
    pub(super) fn of(
        &self,
        zones: &[usize],
        touching: Touching,
        new: impl FnOnce() -> Shares,
    ) -> Arc<Shares> {
        let mut all = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let known = all
            .iter()
            .find(|known| known.touching == touching && known.zones == zones);
        if let Some(known) = known {
            return Arc::clone(&known.shares);
        }
        let shares = Arc::new(new());
        all.push(Known {
            zones: zones.to_vec(),
            touching,
            shares: Arc::clone(&shares),
        });
        shares
    }
}

/// The shares of pairs in a displacement for a set of touching pairs.
///
/// # Formula
/// ```text
/// F_k = Σ_j M_kj (x − g_j)  of a touching pair,   x − g_k − Σ_j M_kj (x − g_j)  of a pair apart
/// ```
/// j are the touching pairs and g their gaps. M = Q⁻¹ b for a touching pair, and M = Q Q⁻¹ for
/// another pair.
#[derive(Debug)]
pub struct Shares {
    /// The touching pairs.
    pub touching: Vec<usize>,
    /// Index of the first function of each pair's row. `None` for a pair that no touching pair
    /// displaces.
    rows: Vec<Option<usize>>,
    functions: Vec<Series<LANES>>,
}

/// Passes the compliances of all pairs at a place of the rearmost pair.
type AtPlace<'a> = &'a dyn Fn(f64, &mut dyn FnMut(&Compliances<'_>));

impl Shares {
    /// The shares of `pairs` pairs while the rearmost pair moves between the `ends`.
    pub(super) fn of(
        pairs: usize,
        (from, to): (f64, f64),
        touching: Touching,
        compliances: AtPlace<'_>,
    ) -> Shares {
        /// Relative to the size of a function.
        const REST: f64 = 1e-13;
        let touching: Vec<usize> = touching.pairs().collect();
        let (rows, count) = rows(pairs, &touching);
        let groups = count.div_ceil(LANES);
        let fill = |at: f64, values: &mut [[f64; LANES]]| {
            compliances(at, &mut |found| {
                fill(found, &touching, &rows, values.as_flattened_mut());
            });
        };
        let mut sizes = vec![[0.0; LANES]; groups];
        fill(f64::midpoint(from, to), &mut sizes);
        let largest = sizes
            .as_flattened()
            .iter()
            .fold(0.0f64, |most, value| most.max(value.abs()));
        let stiffness = touching.len() * touching.len();
        for (at, size) in sizes.as_flattened_mut().iter_mut().enumerate() {
            // Forces come first. The displacement of another pair is a part of the displacement of
            // the touching pairs.
            *size = REST * if at < stiffness { largest } else { 1.0 };
        }
        let functions = Series::groups(from, to, &sizes, &|at, values| {
            fill(at, values);
            Ok::<_, std::convert::Infallible>(())
        });
        Shares {
            touching,
            rows,
            functions: match functions {
                Ok(functions) => functions,
                Err(never) => match never {},
            },
        }
    }

    /// Number of evaluations of the compliances.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.functions.first().map_or(0, Series::evaluations)
    }

    /// Memory of the functions, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.functions.iter().map(Series::bytes).sum()
    }

    /// End of the functions that are valid from a place of the rearmost pair on.
    #[must_use]
    pub fn serves_until(&self, (at, least): (f64, f64)) -> f64 {
        self.functions
            .first()
            .map_or(f64::INFINITY, |functions| functions.serves_until(at, least))
    }

    /// All functions from a place of the rearmost pair over `length`.
    #[must_use]
    pub fn along(&self, place: (f64, f64), length: f64) -> Vec<[Polynomial<TERMS>; LANES]> {
        let functions = self.functions.iter();
        functions
            .map(|functions| functions.local(0, place, length))
            .collect()
    }

    /// The row of a pair among all functions, with one function for each touching pair.
    #[must_use]
    pub fn row_along<'a>(
        &self,
        pair: usize,
        along: &'a [[Polynomial<TERMS>; LANES]],
    ) -> Option<&'a [Polynomial<TERMS>]> {
        let row = self.rows[pair]?;
        Some(&along.as_flattened()[row..row + self.touching.len()])
    }

    /// The row of a pair at one place of the rearmost pair.
    #[must_use]
    pub fn row_at(&self, pair: usize, at: f64) -> Option<Vec<f64>> {
        let row = self.rows[pair]?;
        let function = |index: usize| self.functions[index / LANES].one(index % LANES, at);
        Some((row..row + self.touching.len()).map(function).collect())
    }
}

/// First function of each pair's row, touching pairs first, and the number of functions.
fn rows(pairs: usize, touching: &[usize]) -> (Vec<Option<usize>>, usize) {
    let mut rows = vec![None; pairs];
    let is_near = |pair: usize| {
        touching
            .iter()
            .any(|&other| other.abs_diff(pair) <= PITCHES)
    };
    let apart = (0..pairs).filter(|pair| !touching.contains(pair) && is_near(*pair));
    let mut count = 0;
    for pair in touching.iter().copied().chain(apart) {
        rows[pair] = Some(count);
        count += touching.len();
    }
    (rows, count)
}

/// The rows of all pairs at a place. NaN if the compliances are not positive definite.
fn fill(
    compliances: &Compliances<'_>,
    touching: &[usize],
    rows: &[Option<usize>],
    values: &mut [f64],
) {
    let size = touching.len();
    let Some(factored) = compliances.among(touching) else {
        values.fill(f64::NAN);
        return;
    };
    // Computes several columns of the inverse together.
    for columns in (0..size).step_by(LANES) {
        let mut inverse = vec![[0.0; LANES]; size];
        for lane in 0..LANES.min(size - columns) {
            inverse[columns + lane][lane] = 1.0;
        }
        factored.solve(&mut inverse);
        for (pair, row) in rows.iter().enumerate() {
            let Some(row) = *row else { continue };
            let found: [f64; LANES] = match touching.iter().position(|&other| other == pair) {
                Some(at) => inverse[at],
                None => from_fn(|lane| {
                    let terms = touching.iter().zip(&inverse);
                    terms
                        .map(|(&other, force)| compliances.at(pair, other) * force[lane])
                        .sum()
                }),
            };
            let end = (columns + LANES).min(size);
            values[row + columns..row + end].copy_from_slice(&found[..end - columns]);
        }
    }
}
