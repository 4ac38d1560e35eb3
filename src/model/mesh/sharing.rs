//! How coupled pairs share a displacement between two borders of the mesh, as polynomials.

use std::array::from_fn;
use std::sync::{Arc, Mutex, PoisonError};

use crate::model::pair_forces::{Compliances, PITCHES, Touching};
use crate::numeric::chebyshev::{Series, TERMS};
use crate::numeric::polynomial::Polynomial;

/// Functions that are evaluated side by side.
const LANES: usize = 4;

/// The shares of a mesh that were needed so far. Every motion on the mesh reads the same ones: they
/// depend on neither speed nor deviation.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    known: Mutex<Vec<Known>>,
}

/// Nothing but a cache: meshes are equal whatever it has.
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
    /// The shares of pairs that stand in these zones while some of them touch, computed by `new` if
    /// they are not known.
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

/// How the pairs share a displacement while some of them touch.
///
/// # Formula
/// ```text
/// F_k = Σ_j M_kj (x − g_j)  of a touching pair,   x − g_k − Σ_j M_kj (x − g_j)  of a pair apart
/// ```
/// where j are the touching pairs, g their gaps, M = Q⁻¹ b of the touching pairs, and M = Q Q⁻¹ of
/// a pair apart.
#[derive(Debug)]
pub struct Shares {
    /// The touching pairs.
    pub touching: Vec<usize>,
    /// Where the row of each pair begins among the functions; none for a pair that no touching pair
    /// displaces.
    rows: Vec<Option<usize>>,
    functions: Vec<Series<LANES>>,
}

/// Shows the compliances of all pairs at a place of the rearmost one.
type AtPlace<'a> = &'a dyn Fn(f64, &mut dyn FnMut(&Compliances<'_>));

impl Shares {
    /// The shares of so many pairs while the rearmost goes from one of the `ends` to the other.
    pub(super) fn of(
        pairs: usize,
        (from, to): (f64, f64),
        touching: Touching,
        compliances: AtPlace<'_>,
    ) -> Shares {
        /// Of the size of a function.
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
            // Forces come first; a pair apart is displaced by a part of the others' displacement.
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

    /// How often the compliances were computed for it.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        self.functions.first().map_or(0, Series::evaluations)
    }

    /// What the functions take, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.functions.iter().map(Series::bytes).sum()
    }

    /// Where the functions end that serve from a place of the rearmost pair up.
    #[must_use]
    pub fn serves_until(&self, (at, least): (f64, f64)) -> f64 {
        self.functions
            .first()
            .map_or(f64::INFINITY, |functions| functions.serves_until(at, least))
    }

    /// All functions over the way from a place of the rearmost pair up by `length`.
    #[must_use]
    pub fn along(&self, place: (f64, f64), length: f64) -> Vec<[Polynomial<TERMS>; LANES]> {
        let functions = self.functions.iter();
        functions
            .map(|functions| functions.local(0, place, length))
            .collect()
    }

    /// The row of a pair among all functions: one for each touching pair.
    #[must_use]
    pub fn row_along<'a>(
        &self,
        pair: usize,
        along: &'a [[Polynomial<TERMS>; LANES]],
    ) -> Option<&'a [Polynomial<TERMS>]> {
        let row = self.rows[pair]?;
        Some(&along.as_flattened()[row..row + self.touching.len()])
    }

    /// The same at one place of the rearmost pair.
    #[must_use]
    pub fn row_at(&self, pair: usize, at: f64) -> Option<Vec<f64>> {
        let row = self.rows[pair]?;
        let function = |index: usize| self.functions[index / LANES].one(index % LANES, at);
        Some((row..row + self.touching.len()).map(function).collect())
    }
}

/// Where the row of each pair begins, those of the touching pairs first, and how many functions
/// there are.
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

/// The rows of all pairs at a place; NaN if the compliances are not positive definite.
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
    // Columns of the inverse, some at a time.
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
