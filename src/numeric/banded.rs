//! Symmetric positive definite band matrices.

/// The factors L and D of a matrix with the rows `[a_ii, a_(i,i−1), a_(i,i−2), ..]`.
#[derive(Debug, Clone, PartialEq)]
pub struct Banded<const ROW: usize> {
    /// d_i, l_(i,i−1), l_(i,i−2), ..
    rows: Vec<[f64; ROW]>,
}

impl<const ROW: usize> Banded<ROW> {
    /// The factors of the matrix, A = L D Lᵀ. `None` if it is not positive definite.
    ///
    /// # Source
    /// Golub & Van Loan 2013, "Matrix Computations", section 4.3.6.
    #[must_use]
    pub fn factored(mut rows: Vec<[f64; ROW]>) -> Option<Banded<ROW>> {
        for at in 0..rows.len() {
            let (known, rest) = rows.split_at_mut(at);
            let (row, reach) = (&mut rest[0], ROW.min(at + 1));
            for distance in (1..reach).rev() {
                let other = &known[at - distance];
                for far in distance + 1..reach {
                    row[distance] -= row[far] * other[far - distance];
                }
            }
            for distance in 1..reach {
                let share = row[distance] / known[at - distance][0];
                row[0] -= share * row[distance];
                row[distance] = share;
            }
            if row[0].is_nan() || row[0] <= 0.0 {
                return None;
            }
        }
        Some(Banded { rows })
    }

    /// Solves A x = `right` for several right sides, in place.
    pub fn solve<const M: usize>(&self, right: &mut [[f64; M]]) {
        let rows = &self.rows;
        for (at, row) in rows.iter().enumerate().skip(1) {
            let (known, rest) = right.split_at_mut(at);
            for (known, factor) in known.iter().rev().zip(&row[1..]) {
                subtract(&mut rest[0], *factor, known);
            }
        }
        for (at, row) in rows.iter().enumerate().rev() {
            let (rest, known) = right.split_at_mut(at + 1);
            let sums = &mut rest[at];
            for sum in sums.iter_mut() {
                *sum /= row[0];
            }
            for (distance, (known, row)) in (1..ROW).zip(known.iter().zip(&rows[at + 1..])) {
                subtract(sums, row[distance], known);
            }
        }
    }
}

fn subtract<const M: usize>(sums: &mut [f64; M], factor: f64, known: &[f64; M]) {
    for (sum, known) in sums.iter_mut().zip(known) {
        *sum -= factor * known;
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
            let expected: Vec<[f64; 2]> = (0..size)
                .map(|at| [1.0 + at as f64, (at as f64).cos()])
                .collect();
            let entry = |row: usize, column: usize| {
                let (low, high) = (row.min(column), row.max(column));
                rows[high].get(high - low).copied().unwrap_or(0.0)
            };
            let mut right: Vec<[f64; 2]> = (0..size)
                .map(|row| {
                    std::array::from_fn(|side| {
                        (0..size)
                            .map(|column| entry(row, column) * expected[column][side])
                            .sum()
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
            assert_eq!(Banded::factored(rows), None);
        }
    }
}
