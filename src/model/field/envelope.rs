//! Cholesky factorisation of a symmetric matrix within its envelope, which can stop at any row.

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
