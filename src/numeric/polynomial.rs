//! Polynomials as coefficients of powers, mostly on an interval from 0 to 1.

/// Σ a_k t^k of `N` terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polynomial<const N: usize>(pub [f64; N]);

impl<const N: usize> Polynomial<N> {
    /// The polynomial that is 0 everywhere.
    pub const ZERO: Polynomial<N> = Polynomial([0.0; N]);

    /// The coefficients up to the last nonzero coefficient.
    #[must_use]
    pub fn terms(&self) -> &[f64] {
        let count =
            self.0.iter().rposition(|&coefficient| coefficient != 0.0).map_or(0, |last| last + 1);
        &self.0[..count]
    }

    /// Its value at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        horner(&self.0, t)
    }

    /// Its slope at `t`.
    #[must_use]
    pub fn slope(&self, t: f64) -> f64 {
        self.derivative().at(t)
    }

    /// Its derivative. The last coefficient is 0.
    #[must_use]
    pub fn derivative(&self) -> Polynomial<N> {
        let mut derivative = [0.0; N];
        for power in 1..N {
            derivative[power - 1] = power as f64 * self.0[power];
        }
        Polynomial(derivative)
    }

    /// Its integral from 0 to 1.
    #[must_use]
    pub fn integral(&self) -> f64 {
        self.0.iter().enumerate().map(|(power, coefficient)| coefficient / (power + 1) as f64).sum()
    }

    /// The polynomial a(`by` t).
    #[must_use]
    pub fn stretched(mut self, by: f64) -> Polynomial<N> {
        self.stretch(by);
        self
    }

    /// Replaces the polynomial a(t) by a(`by` t).
    pub fn stretch(&mut self, by: f64) {
        let square = by * by;
        let (mut factors, fourth) = ([1.0, by, square, square * by], square * square);
        for four in self.0.chunks_mut(factors.len()) {
            for (coefficient, factor) in four.iter_mut().zip(&mut factors) {
                *coefficient *= *factor;
                *factor *= fourth;
            }
        }
    }

    /// Every coefficient times `factor`.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Polynomial<N> {
        self.0.iter_mut().for_each(|coefficient| *coefficient *= factor);
        self
    }

    /// The sum of this polynomial and `factor` times `other`, which has at most as many terms.
    #[must_use]
    pub fn plus<const M: usize>(mut self, factor: f64, other: &Polynomial<M>) -> Polynomial<N> {
        self.0.iter_mut().zip(other.0).for_each(|(sum, coefficient)| *sum += factor * coefficient);
        self
    }

    /// The product with `other`, truncated to `P` terms.
    #[must_use]
    pub fn times<const M: usize, const P: usize>(&self, other: &Polynomial<M>) -> Polynomial<P> {
        let mut product = [0.0; P];
        // Each round adds to all powers, so that the sums of a round are independent of each other.
        for (power, &factor) in other.terms().iter().enumerate().take(P) {
            for (sum, coefficient) in product[power..].iter_mut().zip(&self.0) {
                *sum += factor * coefficient;
            }
        }
        Polynomial(product)
    }

    /// a(t)/t for a polynomial with a(0) = 0.
    #[must_use]
    pub fn over_argument(&self) -> Polynomial<N> {
        let mut rest = [0.0; N];
        rest[..N - 1].copy_from_slice(&self.0[1..]);
        Polynomial(rest)
    }
}

/// Σ a_k t^k by Horner's rule with every fourth term, in four independent sums.
fn horner(powers: &[f64], t: f64) -> f64 {
    let (fours, rest) = powers.as_chunks::<4>();
    let (square, mut sums) = (t * t, [0.0; 4]);
    rest.iter().zip(&mut sums).for_each(|(coefficient, sum)| *sum = *coefficient);
    for four in fours.iter().rev() {
        for lane in 0..4 {
            sums[lane] = sums[lane] * (square * square) + four[lane];
        }
    }
    (sums[0] + sums[1] * t) + (sums[2] + sums[3] * t) * square
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (1 + t)(2 − t)(t + 3), and 1 − 2t.
    const CUBIC: Polynomial<4> = Polynomial([6.0, 5.0, -2.0, -1.0]);
    const LINE: Polynomial<2> = Polynomial([1.0, -2.0]);

    #[test]
    fn values_slopes_and_integrals_agree_with_the_formula() {
        for step in -4..=4 {
            let t = 0.5 * f64::from(step);
            assert!((CUBIC.at(t) - (1.0 + t) * (2.0 - t) * (t + 3.0)).abs() < 1e-13);
            assert!((CUBIC.slope(t) - (5.0 - 4.0 * t - 3.0 * t * t)).abs() < 1e-13);
            assert!((CUBIC.derivative().at(t) - CUBIC.slope(t)).abs() < 1e-13);
            assert!((CUBIC.stretched(0.3).at(t) - CUBIC.at(0.3 * t)).abs() < 1e-13);
            let product: Polynomial<5> = CUBIC.times(&LINE);
            assert!((product.at(t) - CUBIC.at(t) * LINE.at(t)).abs() < 1e-12);
            assert!((CUBIC.plus(-2.0, &LINE).at(t) - CUBIC.at(t) + 2.0 * LINE.at(t)).abs() < 1e-13);
            assert!(
                (Polynomial([0.0, 1.0, -2.0]).over_argument().at(t) - LINE.at(t)).abs() < 1e-13
            );
        }
        assert!((CUBIC.integral() - (6.0 + 2.5 - 2.0 / 3.0 - 0.25)).abs() < 1e-14);
    }

    #[test]
    fn a_product_can_be_truncated() {
        let cut: Polynomial<3> = CUBIC.times(&LINE);
        let whole: Polynomial<5> = CUBIC.times(&LINE);
        assert_eq!(cut.0[..], whole.0[..3]);
    }
}
