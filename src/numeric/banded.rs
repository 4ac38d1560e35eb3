//! Symmetric positive definite band matrices.

use std::ops::{Div, Mul, Sub};

use smallvec::SmallVec;

use super::real::Lanes;

/// An entry of a matrix: a number, or the entries of several matrices side by side.
pub trait Entry: Copy + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// Whether it is above 0, in every matrix.
    fn is_positive(&self) -> bool;
}

impl Entry for f64 {
    fn is_positive(&self) -> bool {
        *self > 0.0
    }
}

impl<const L: usize> Entry for Lanes<L> {
    fn is_positive(&self) -> bool {
        self.0.iter().all(|entry| *entry > 0.0)
    }
}

/// The factors L and D of a matrix with the rows `[a_ii, a_(i,i−1), a_(i,i−2), ..]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Banded<const ROW: usize, T = f64> {
    /// d_i, l_(i,i−1), l_(i,i−2), ..
    rows: Rows<T, ROW>,
}

/// Rows of a matrix, without heap if it is small.
pub type Rows<T, const ROW: usize> = SmallVec<[[T; ROW]; 4]>;

impl<const ROW: usize, T: Entry> Banded<ROW, T> {
    /// The factors of the matrix, A = L D Lᵀ. `None` if it is not positive definite.
    ///
    /// # Source
    /// Golub & Van Loan 2013, "Matrix Computations", section 4.3.6.
    pub fn factored(rows: impl IntoIterator<Item = [T; ROW]>) -> Option<Banded<ROW, T>> {
        Banded::of(rows.into_iter().collect())
    }

    /// [`Banded::factored`] in place.
    pub fn of(mut rows: Rows<T, ROW>) -> Option<Banded<ROW, T>> {
        for at in 0..rows.len() {
            let (known, rest) = rows.split_at_mut(at);
            let row = &mut rest[0];
            if at < ROW {
                eliminate(row, known, at + 1);
            } else {
                eliminate(row, known, ROW);
            }
            if !row[0].is_positive() {
                return None;
            }
        }
        Some(Banded { rows })
    }

    /// Solves A x = `right` for several right sides, in place.
    pub fn solve<const M: usize>(&self, right: &mut [[T; M]]) {
        let rows = &self.rows;
        for (at, row) in rows.iter().enumerate() {
            let (known, rest) = right.split_at_mut(at);
            within_reach::<ROW>(at, |reach| {
                for distance in 1..reach {
                    subtract(&mut rest[0], row[distance], &known[at - distance]);
                }
            });
        }
        for (at, row) in rows.iter().enumerate().rev() {
            let (rest, known) = right.split_at_mut(at + 1);
            let sums = &mut rest[at];
            for sum in sums.iter_mut() {
                *sum = *sum / row[0];
            }
            within_reach::<ROW>(known.len(), |reach| {
                for distance in 1..reach {
                    subtract(sums, rows[at + distance][distance], &known[distance - 1]);
                }
            });
        }
    }
}

/// Calls `run` with the length of a row with so many rows on one side, which is known to the compiler for
/// most rows.
#[expect(clippy::inline_always, reason = "loops unroll only where their length is a constant")]
#[inline(always)]
fn within_reach<const ROW: usize>(rows: usize, mut run: impl FnMut(usize)) {
    if rows >= ROW { run(ROW) } else { run(rows + 1) }
}

/// The factors of a row by those of the `known` rows before it.
#[expect(clippy::inline_always, reason = "loops unroll only where their length is a constant")]
#[inline(always)]
fn eliminate<T: Entry, const ROW: usize>(row: &mut [T; ROW], known: &[[T; ROW]], reach: usize) {
    let at = known.len();
    for distance in (1..reach).rev() {
        let other = &known[at - distance];
        for far in distance + 1..reach {
            row[distance] = row[distance] - row[far] * other[far - distance];
        }
    }
    for distance in 1..reach {
        let share = row[distance] / known[at - distance][0];
        row[0] = row[0] - share * row[distance];
        row[distance] = share;
    }
}

fn subtract<T: Entry, const M: usize>(sums: &mut [T; M], factor: T, known: &[T; M]) {
    for (sum, known) in sums.iter_mut().zip(known) {
        *sum = *sum - factor * *known;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(size: usize) -> Vec<[f64; 4]> {
        let wave = |at: usize, speed: f64| (1.0 + at as f64 * speed).sin();
        let row = |at: usize| {
            let next = if at > 0 { 0.5 * wave(at, 1.3) } else { 0.0 };
            let far = if at > 1 { 0.3 * wave(at, 2.1) } else { 0.0 };
            let furthest = if at > 2 { 0.2 * wave(at, 1.7) } else { 0.0 };
            [2.0 + wave(at, 0.7), next, far, furthest]
        };
        (0..size).map(row).collect()
    }

    #[test]
    fn the_solution_satisfies_the_equations_at_every_size() {
        for size in [1, 2, 3, 4, 17, 64] {
            let mut rows = matrix(size);
            for row in &mut rows {
                row[0] += 1.0;
            }
            let expected: Vec<[f64; 2]> =
                (0..size).map(|at| [1.0 + at as f64, (at as f64).cos()]).collect();
            let entry = |row: usize, column: usize| {
                let (low, high) = (row.min(column), row.max(column));
                rows[high].get(high - low).copied().unwrap_or(0.0)
            };
            let mut right: Vec<[f64; 2]> = (0..size)
                .map(|row| {
                    std::array::from_fn(|side| {
                        (0..size).map(|column| entry(row, column) * expected[column][side]).sum()
                    })
                })
                .collect();
            Banded::factored(rows.clone()).unwrap().solve(&mut right);
            for (found, expected) in right.iter().zip(&expected) {
                for side in 0..2 {
                    assert!((found[side] - expected[side]).abs() < 1e-12, "{size}");
                }
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_has_no_factors() {
        for rows in [
            vec![[0.0, 0.0, 0.0]],
            vec![[1.0, 0.0, 0.0], [1.0, 1.1, 0.0]],
            vec![[1.0, 0.0, 0.0], [1.0, 0.6, 0.0], [1.0, -0.6, 0.6]],
            vec![[f64::NAN, 0.0, 0.0]],
        ] {
            assert_eq!(Banded::factored(rows.clone()), None);
            let beside = |entry: f64| Lanes([1.0 + entry, entry]);
            let both: Vec<_> = rows.into_iter().map(|row| row.map(beside)).collect();
            assert_eq!(Banded::factored(both), None);
        }
    }

    #[test]
    fn matrices_side_by_side_have_the_solutions_of_each_of_them() {
        let mut one = matrix(7);
        for row in &mut one {
            row[0] += 1.0;
        }
        let other: Vec<[f64; 4]> = one.iter().map(|row| [3.0 + row[0], 0.5, 0.2, 0.1]).collect();
        let beside = |(one, other): (&[f64; 4], &[f64; 4])| -> [Lanes<2>; 4] {
            std::array::from_fn(|at| Lanes([one[at], other[at]]))
        };
        let both: Vec<_> = one.iter().zip(&other).map(beside).collect();
        let mut right = [[Lanes([1.0, 2.0])]; 7];
        Banded::factored(both).unwrap().solve(&mut right);
        for (lane, rows) in [one, other].into_iter().enumerate() {
            let mut alone = [[1.0 + lane as f64]; 7];
            Banded::factored(rows).unwrap().solve(&mut alone);
            for (found, expected) in right.iter().zip(alone) {
                assert!((found[0].0[lane] - expected[0]).abs() < 1e-15);
            }
        }
    }
}
