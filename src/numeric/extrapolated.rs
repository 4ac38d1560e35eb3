//! Steps of a differential equation by the extrapolated midpoint rule, independent of
//! [`super::taylor`] to check its results.

use nalgebra::SVector;

/// An equation y' = f(t, y).
pub trait Equation<const N: usize> {
    /// f(t, y).
    fn slope(&self, t: f64, y: &SVector<f64, N>) -> SVector<f64, N>;
}

/// Number of extrapolations in a step. Each raises the order by two.
const COLUMNS: usize = 6;

/// The state after a step of `length` from the time `t` and the state `y`, of order 12.
///
/// # Formula
/// ```text
/// z1 = z0 + h f(t0, z0),   z(m+1) = z(m−1) + 2 h f(tm, zm),   h = length/n,   n = 2, 4 .. 12
/// T(j, k+1) = T(j, k) + (T(j, k) − T(j−1, k))/((n_j/n_(j−k−1))² − 1)
/// ```
///
/// # Source
/// Gragg's rule without smoothing, extrapolated by Aitken and Neville: Hairer, Norsett & Wanner
/// 1993, "Solving Ordinary Differential Equations I", section II.9.
#[must_use]
pub fn step<const N: usize>(
    equation: &impl Equation<N>,
    t: f64,
    y: &SVector<f64, N>,
    length: f64,
) -> SVector<f64, N> {
    let slope = equation.slope(t, y);
    let mut row_before = [*y; COLUMNS];
    let mut best = *y;
    for row in 0..COLUMNS {
        let parts = 2 * (row + 1);
        best = midpoint(equation, t, (y, &slope), length, parts);
        for (column, before) in row_before.iter_mut().enumerate().take(row) {
            let ratio = parts as f64 / (2 * (row - column)) as f64;
            let better = best + (best - *before) / (ratio * ratio - 1.0);
            *before = best;
            best = better;
        }
        row_before[row] = best;
    }
    best
}

/// The midpoint rule with an even number of parts.
fn midpoint<const N: usize>(
    equation: &impl Equation<N>,
    t: f64,
    (y, slope): (&SVector<f64, N>, &SVector<f64, N>),
    length: f64,
    parts: usize,
) -> SVector<f64, N> {
    let part = length / parts as f64;
    let (mut before, mut here) = (*y, y + slope * part);
    for number in 1..parts {
        let next = before + equation.slope(t + number as f64 * part, &here) * (2.0 * part);
        (before, here) = (here, next);
    }
    here
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;

    /// y'' = 0.1 t - y; from (1, 0.1) on y = cos t + 0.1 t.
    struct Oscillator;

    impl Equation<2> for Oscillator {
        fn slope(&self, t: f64, y: &Vector2<f64>) -> Vector2<f64> {
            Vector2::new(y[1], -y[0] + 0.1 * t)
        }
    }

    fn error_after(steps: u32) -> f64 {
        let length = 6.0 / f64::from(steps);
        let start = Vector2::new(1.0, 0.1);
        let end = (0..steps)
            .fold(start, |y, number| step(&Oscillator, f64::from(number) * length, &y, length));
        (end[0] - 6f64.cos() - 0.6).abs()
    }

    #[test]
    fn halving_the_step_divides_the_error_by_two_to_the_twelfth() {
        let order = (error_after(3) / error_after(6)).log2();
        assert!((11.0..14.0).contains(&order), "order {order}");
        assert!(error_after(24) < 1e-14);
    }
}
