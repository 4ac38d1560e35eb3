//! Polynomials as coefficients of powers, mostly on an interval from 0 to 1, and their sign changes
//! there. The coefficients of the Bernstein form bound the polynomial, so that no sign change is
//! missed.

use super::root;

/// Σ a_k t^k of `N` terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Polynomial<const N: usize>(pub [f64; N]);

impl<const N: usize> Polynomial<N> {
    /// The polynomial that is 0 everywhere.
    pub const ZERO: Polynomial<N> = Polynomial([0.0; N]);

    /// The coefficients up to the last nonzero coefficient.
    pub fn terms(&self) -> &[f64] {
        let count =
            self.0.iter().rposition(|&coefficient| coefficient != 0.0).map_or(0, |last| last + 1);
        &self.0[..count]
    }

    /// Its value at `t`.
    pub fn at(&self, t: f64) -> f64 {
        horner(&self.0, t)
    }

    /// Its slope at `t`.
    pub fn slope(&self, t: f64) -> f64 {
        self.derivative().at(t)
    }

    /// Its derivative. The last coefficient is 0.
    pub fn derivative(&self) -> Polynomial<N> {
        let mut derivative = [0.0; N];
        for power in 1..N {
            derivative[power - 1] = power as f64 * self.0[power];
        }
        Polynomial(derivative)
    }

    /// Its integral from 0 to 1.
    pub fn integral(&self) -> f64 {
        self.0.iter().enumerate().map(|(power, coefficient)| coefficient / (power + 1) as f64).sum()
    }

    /// The polynomial a(`by` t).
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
    pub fn scaled(mut self, factor: f64) -> Polynomial<N> {
        self.0.iter_mut().for_each(|coefficient| *coefficient *= factor);
        self
    }

    /// The sum of this polynomial and `factor` times `other`, which has at most as many terms.
    pub fn plus<const M: usize>(mut self, factor: f64, other: &Polynomial<M>) -> Polynomial<N> {
        self.0.iter_mut().zip(other.0).for_each(|(sum, coefficient)| *sum += factor * coefficient);
        self
    }

    /// The product with `other`, truncated to `P` terms.
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

/// Coefficients computed together; the number of terms is a multiple of it.
const SIDE_BY_SIDE: usize = 4;
/// Limit of the halvings. Two sign changes within 2⁻³⁰ of each other can cancel.
const MOST_HALVINGS: u32 = 30;
/// Limit of the parts in one search: the parts around 32 roots, each halved 30 times. A polynomial
/// of rounding errors has sign changes everywhere.
const MOST_PARTS: u32 = 32 * 2 * MOST_HALVINGS;

/// A polynomial Σ b_i C(N−1, i) t^i (1−t)^(N−1−i). From 0 to 1 its values are between the least and
/// the greatest b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bernstein<const N: usize>([f64; N]);

impl<const N: usize> Bernstein<N> {
    /// C(i, j)/C(N−1, j), the weight of the coefficient of t^j in b_i.
    const WEIGHTS: &'static [[f64; N]; N] = &weights();

    /// The Bernstein form of a polynomial.
    ///
    /// # Source
    /// Farouki & Rajan 1987, "On the numerical condition of polynomials in Bernstein form",
    /// Computer Aided Geometric Design 4, Eq. 6.
    pub fn of(polynomial: &Polynomial<N>) -> Bernstein<N> {
        const { assert!(N.is_multiple_of(SIDE_BY_SIDE), "multiple of four terms") };
        let (terms, mut form) = (polynomial.terms(), [0.0; N]);
        for (part, sums) in form.as_chunks_mut::<SIDE_BY_SIDE>().0.iter_mut().enumerate() {
            for (coefficient, weights) in
                terms.iter().zip(Self::WEIGHTS).take(SIDE_BY_SIDE * (part + 1))
            {
                let weights = &weights.as_chunks::<SIDE_BY_SIDE>().0[part];
                sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum += coefficient * weight);
            }
        }
        Bernstein(form)
    }

    /// A lower and an upper bound of the values from 0 to 1.
    pub fn bounds(&self) -> (f64, f64) {
        super::bounds(self.0)
    }

    /// The forms on the first and the second half of the interval, by de Casteljau's algorithm.
    fn halves(&self) -> (Bernstein<N>, Bernstein<N>) {
        let (mut left, mut right) = (*self, *self);
        for size in (1..N).rev() {
            left.0[N - 1 - size] = right.0[0];
            for at in 0..size {
                right.0[at] = 0.5 * (right.0[at] + right.0[at + 1]);
            }
        }
        left.0[N - 1] = right.0[0];
        (left, right)
    }
}

const fn weights<const N: usize>() -> [[f64; N]; N] {
    let mut weights = [[0.0; N]; N];
    let mut power = 0;
    while power < N {
        // C(i+1, j)/C(i, j) = (i+1)/(i+1−j), backwards from 1 at i = N−1.
        let mut at = N - 1;
        weights[power][at] = 1.0;
        while at > power {
            weights[power][at - 1] = weights[power][at] * (at - power) as f64 / at as f64;
            at -= 1;
        }
        power += 1;
    }
    weights
}

/// The first place from 0 to 1 where the polynomial falls below 0. `Some(0.0)` if the polynomial
/// begins below 0, `None` if it does not fall below 0.
///
/// # Source
/// Descartes' rule for the Bernstein form: the coefficients change sign as often as the polynomial,
/// or more often by an even number. No change and one change are therefore certain. With more
/// changes the search halves the interval. Lane & Riesenfeld 1981, "Bounds on a polynomial", BIT
/// 21.
pub fn first_fall<const N: usize>(polynomial: &Polynomial<N>) -> Option<f64> {
    let form = Bernstein::of(polynomial);
    if form.0.iter().all(|&value| value >= 0.0) {
        return None;
    }
    let (mut first, mut sign) = (None, 1);
    let mut search = Search {
        polynomial,
        floor: 0.0,
        sign: &mut sign,
        rest: MOST_PARTS,
        found: &mut |at| first.replace(at).is_some(),
    };
    search.within(&form, 0.0, 1.0, MOST_HALVINGS);
    first
}

/// The places between 0 and 1 where the polynomial changes its sign, in order. Values within
/// rounding have no sign.
pub fn sign_changes<const N: usize>(polynomial: &Polynomial<N>) -> Vec<f64> {
    const ROUNDING: f64 = 64.0 * f64::EPSILON;
    let form = Bernstein::of(polynomial);
    let (low, high) = form.bounds();
    let (mut all, mut sign) = (Vec::new(), 0);
    if low < 0.0 && high > 0.0 {
        let mut keep = |at| {
            all.push(at);
            true
        };
        let mut search = Search {
            polynomial,
            floor: ROUNDING * high.max(-low),
            sign: &mut sign,
            rest: MOST_PARTS,
            found: &mut keep,
        };
        search.within(&form, 0.0, 1.0, MOST_HALVINGS);
    }
    all
}

/// A search for changes of sign, from left to right.
struct Search<'a, const N: usize> {
    polynomial: &'a Polynomial<N>,
    /// Coefficients up to this absolute value have no sign.
    floor: f64,
    /// The last sign, or 0 before the first sign.
    sign: &'a mut i8,
    /// Parts that the search may still examine.
    rest: u32,
    /// Receives each sign change; returns whether the search continues.
    found: &'a mut dyn FnMut(f64) -> bool,
}

impl<const N: usize> Search<'_, N> {
    /// Searches one part of the interval. Returns whether the search continues.
    fn within(&mut self, form: &Bernstein<N>, from: f64, to: f64, halvings: u32) -> bool {
        self.rest = self.rest.saturating_sub(1);
        let (at_once, inside, last) = self.changes(form);
        let go_on = match (at_once, inside) {
            (false, 0) => true,
            (true, 0) => (self.found)(from),
            (false, 1) => (self.found)(root::between(from, to, |t| self.polynomial.at(t))),
            _ if halvings == 0 || self.rest == 0 => last == *self.sign || (self.found)(to),
            _ => {
                let (left, right) = form.halves();
                let middle = f64::midpoint(from, to);
                return self.within(&left, from, middle, halvings - 1)
                    && self.within(&right, middle, to, halvings - 1);
            }
        };
        *self.sign = last;
        go_on
    }

    /// Whether the first coefficient with a sign differs from the last sign before; the number of
    /// sign changes after this coefficient; the last sign.
    fn changes(&self, form: &Bernstein<N>) -> (bool, usize, i8) {
        let mut signs = form
            .0
            .iter()
            .filter(|value| value.abs() > self.floor)
            .map(|&value| if value > 0.0 { 1 } else { -1 });
        let Some(first) = signs.next() else {
            return (false, 0, *self.sign);
        };
        let (inside, last) = signs
            .fold((0, first), |(inside, last), sign| (inside + usize::from(sign != last), sign));
        (*self.sign == -first, inside, last)
    }
}

/// The values at the ends and at the turning points, which include the greatest and the least value
/// from 0 to 1.
pub fn extremes<const N: usize>(polynomial: &Polynomial<N>) -> impl Iterator<Item = f64> {
    let turns = sign_changes(&polynomial.derivative());
    let places = turns.into_iter().chain([0.0, 1.0]);
    places.map(|part| polynomial.at(part))
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

    /// The product of (t − root), times `factor`.
    fn with_roots<const N: usize>(factor: f64, roots: &[f64]) -> Polynomial<N> {
        let mut product = Polynomial::ZERO;
        product.0[0] = factor;
        roots.iter().fold(product, |product, root| product.times(&Polynomial([-root, 1.0])))
    }

    #[test]
    fn sign_changes_are_found_and_double_roots_are_ignored() {
        let cases: [(&[f64], &[f64]); 6] = [
            (&[-0.3, 1.2, 5.0], &[]),
            (&[0.25], &[0.25]),
            (&[0.5, 0.5 + 1e-5, 0.75, -2.0, 1.001], &[0.5, 0.5 + 1e-5, 0.75]),
            (&[0.1, 0.3, 0.3, 0.9, 0.95, 0.97], &[0.1, 0.9, 0.95, 0.97]),
            (&[0.5, 0.5, 0.5], &[0.5]),
            (&[0.4, 0.6, 0.4 + 1e-12], &[0.6]),
        ];
        for (roots, expected) in cases {
            for factor in [1.0, -1e-9] {
                let found = sign_changes(&with_roots::<12>(factor, roots));
                assert_eq!(found.len(), expected.len(), "{roots:?}: {found:?}");
                for (found, expected) in found.iter().zip(expected) {
                    assert!(
                        (found - expected).abs() < 1e-9,
                        "{roots:?}: {found} and not {expected}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_first_fall_is_found_in_a_short_dip() {
        let dip = with_roots::<12>(1.0, &[0.3, 0.3 + 1e-4, 0.7, 0.8]);
        assert!((first_fall(&dip).unwrap() - 0.3).abs() < 1e-10);
        let touches = with_roots::<12>(1.0, &[0.4, 0.4]).plus(1e-9, &Polynomial([1.0]));
        assert_eq!(first_fall(&touches), None);
        assert_eq!(first_fall(&with_roots::<12>(1.0, &[0.25, 2.0]).scaled(-1.0)), Some(0.0));
        assert_eq!(first_fall(&with_roots::<12>(1.0, &[-1.0, -0.1])), None);
        let late = first_fall(&with_roots::<12>(1.0, &[0.999, 1.5])).unwrap();
        assert!((late - 0.999).abs() < 1e-12, "{late}");
    }

    #[test]
    fn the_search_of_a_polynomial_of_rounding_errors_ends() {
        // Terms of both signs have equal sums, so that each value is a rounding error.
        let rough = with_roots::<32>(1e-16, &[0.5; 31]);
        let parts = |polynomial: &Polynomial<32>, floor: f64| {
            let (mut sign, mut changes) = (1, 0);
            let mut search = Search {
                polynomial,
                floor,
                sign: &mut sign,
                rest: MOST_PARTS,
                found: &mut |_| {
                    changes += 1;
                    true
                },
            };
            search.within(&Bernstein::of(polynomial), 0.0, 1.0, u32::MAX);
            MOST_PARTS - search.rest
        };
        assert!(parts(&rough, 0.0) <= MOST_PARTS);
        let planted: Vec<f64> = (1..=11).map(|root| f64::from(root) / 12.0).collect();
        assert!(parts(&with_roots::<32>(1.0, &planted), 0.0) < MOST_PARTS / 4);
    }

    #[test]
    fn the_bounds_contain_all_values() {
        let polynomial = Polynomial([0.3, -2.0, 4.0, 1.0, -3.5, 0.0, 0.0, 0.0]);
        let (low, high) = Bernstein::of(&polynomial).bounds();
        for step in 0..=100 {
            let value = polynomial.at(0.01 * f64::from(step));
            assert!(value >= low && value <= high, "{value} beyond {low} and {high}");
        }
    }
}
