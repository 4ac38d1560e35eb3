//! How coupled pairs share a displacement between two borders of the mesh, as polynomials.

use std::array::from_fn;
use std::cell::RefCell;
use std::rc::Rc;

use crate::model::mesh::Mesh;
use crate::model::pair_forces::{Compliances, PITCHES, Touching};
use crate::numeric::chebyshev::{Series, TERMS};
use crate::numeric::polynomial::Polynomial;

/// Functions that are evaluated side by side.
const LANES: usize = 4;

/// The shares of one set of pairs that may touch, for the sets of touching pairs that were needed.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    known: RefCell<Vec<(Touching, Rc<Shares>)>>,
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
pub(super) struct Shares {
    /// The touching pairs.
    pub(super) touching: Vec<usize>,
    /// Where the row of each pair begins among the functions; none for a pair that no touching pair
    /// displaces.
    rows: Vec<Option<usize>>,
    functions: Vec<Series<LANES>>,
}

impl Sharing {
    /// The shares of pairs, each with its zone, while some of them touch and the incoming one goes
    /// from one of the `ends` to the other; and how often they were computed for it.
    pub(super) fn of(
        &self,
        mesh: &Mesh,
        standing: &[(i32, usize)],
        ends: (f64, f64),
        touching: Touching,
    ) -> (Rc<Shares>, usize) {
        let mut known = self.known.borrow_mut();
        if let Some((_, shares)) = known.iter().find(|(set, _)| *set == touching) {
            return (Rc::clone(shares), 0);
        }
        let shares = Rc::new(Shares::of(mesh, standing, ends, touching));
        known.push((touching, Rc::clone(&shares)));
        let evaluations = shares.functions.first().map_or(0, Series::evaluations);
        (shares, evaluations)
    }

    /// What they take, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let of = |(_, shares): &(Touching, Rc<Shares>)| {
            shares.functions.iter().map(Series::bytes).sum::<usize>()
        };
        self.known.borrow().iter().map(of).sum()
    }
}

impl Shares {
    fn of(
        mesh: &Mesh,
        standing: &[(i32, usize)],
        (from, to): (f64, f64),
        touching: Touching,
    ) -> Shares {
        /// Of the size of a function.
        const REST: f64 = 1e-13;
        let touching: Vec<usize> = touching.pairs().collect();
        let first = f64::from(standing[0].0) * mesh.base_pitch;
        let inside = f64::midpoint(from, to);
        let (rows, count) = rows(standing.len(), &touching);
        let groups = count.div_ceil(LANES);
        let fill = |s: f64, values: &mut [[f64; LANES]]| {
            mesh.with_compliances(standing, (s, inside), |compliances| {
                fill(compliances, &touching, &rows, values.as_flattened_mut());
            });
        };
        let mut sizes = vec![[0.0; LANES]; groups];
        fill(inside, &mut sizes);
        let largest = sizes
            .as_flattened()
            .iter()
            .fold(0.0f64, |most, value| most.max(value.abs()));
        let stiffness = touching.len() * touching.len();
        for (at, size) in sizes.as_flattened_mut().iter_mut().enumerate() {
            // Forces come first; a pair apart is displaced by a part of the others' displacement.
            *size = REST * if at < stiffness { largest } else { 1.0 };
        }
        let functions = Series::groups(from + first, to + first, &sizes, &|at, values| {
            fill(at - first, values);
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

    /// Where the functions end that serve from a place of the rearmost pair up.
    pub(super) fn serves_until(&self, (at, least): (f64, f64)) -> f64 {
        self.functions
            .first()
            .map_or(f64::INFINITY, |functions| functions.serves_until(at, least))
    }

    /// All functions over the way from a place of the rearmost pair up by `length`.
    pub(super) fn along(&self, place: (f64, f64), length: f64) -> Vec<[Polynomial<TERMS>; LANES]> {
        let functions = self.functions.iter();
        functions
            .map(|functions| functions.local(0, place, length))
            .collect()
    }

    /// The row of a pair among all functions: one for each touching pair.
    pub(super) fn row_along<'a>(
        &self,
        pair: usize,
        along: &'a [[Polynomial<TERMS>; LANES]],
    ) -> Option<&'a [Polynomial<TERMS>]> {
        let row = self.rows[pair]?;
        Some(&along.as_flattened()[row..row + self.touching.len()])
    }

    /// The same at one place of the rearmost pair.
    pub(super) fn row_at(&self, pair: usize, at: f64) -> Option<Vec<f64>> {
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
