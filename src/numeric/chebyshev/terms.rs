//! The Chebyshev series on one piece and its conversion to powers.

use std::array::from_fn;
use std::f64::consts::PI;
use std::sync::LazyLock;

use crate::numeric::lanes::Lanes;
use crate::numeric::polynomial::Polynomial;

/// One value of every function for each order. This layout allows sums of several functions at
/// once.
pub(super) type Terms<const N: usize> = [[f64; N]; TERMS];

/// cos(k π/(2 TERMS)) over a whole turn.
static COSINES: LazyLock<[f64; 4 * TERMS]> =
    LazyLock::new(|| from_fn(|k| (k as f64 * PI / (2 * TERMS) as f64).cos()));

/// The coefficients of the powers in each Chebyshev polynomial.
static POLYNOMIALS: LazyLock<[[f64; TERMS]; TERMS]> = LazyLock::new(|| {
    let (mut before, mut polynomial) = ([0.0; TERMS], [0.0; TERMS]);
    polynomial[0] = 1.0;
    from_fn(|order| {
        let found = polynomial;
        // T_1 = t, T_(n+1) = 2 t T_n − T_(n−1).
        let scale = if order == 0 { 1.0 } else { 2.0 };
        polynomial = from_fn(|power: usize| {
            let lower = power.checked_sub(1).map_or(0.0, |lower| scale * found[lower]);
            lower - before[power]
        });
        before = found;
        found
    })
});

/// Number of terms of a piece.
pub const TERMS: usize = 16;

/// Number of last terms that estimate the truncation error.
const TAIL: usize = 3;

/// The Chebyshev point of the first kind.
pub(super) fn place(from: f64, to: f64, point: usize) -> f64 {
    f64::midpoint(from, to) + 0.5 * (to - from) * COSINES[2 * point + 1]
}

/// The Chebyshev coefficients of the polynomials through the function's values at the Chebyshev
/// points of the first kind.
pub(super) fn interpolate<const N: usize, E>(
    from: f64,
    to: f64,
    f: &impl Fn(f64) -> Result<[f64; N], E>,
) -> Result<Terms<N>, E> {
    let mut values = [[0.0; N]; TERMS];
    for (point, value) in values.iter_mut().enumerate() {
        *value = f(place(from, to, point))?;
    }
    Ok(terms_of(&values))
}

/// The Chebyshev coefficients from the values at these points. The points are symmetric: terms of
/// even order need the sums of opposite values, terms of odd order their differences.
pub(super) fn terms_of<const N: usize>(values: &Terms<N>) -> Terms<N> {
    let cosines = &*COSINES;
    let mut terms = [[0.0; N]; TERMS];
    for (point, (value, opposite)) in values.iter().zip(values.iter().rev()).enumerate() {
        if point == TERMS / 2 {
            break;
        }
        let parts: [[f64; N]; 2] = [
            from_fn(|function| value[function] + opposite[function]),
            from_fn(|function| value[function] - opposite[function]),
        ];
        for (order, sums) in terms.iter_mut().enumerate() {
            let weight = cosines[order * (2 * point + 1) % cosines.len()];
            sums.iter_mut().zip(&parts[order % 2]).for_each(|(sum, part)| *sum += part * weight);
        }
    }
    for (order, sums) in terms.iter_mut().enumerate() {
        let scale = if order == 0 { 1.0 } else { 2.0 } / TERMS as f64;
        for sum in sums.iter_mut() {
            *sum *= scale;
        }
    }
    terms
}

/// Whether the last terms of each function are at most `rest`, or are not finite, so that halving
/// would not help.
pub(super) fn has_settled<const N: usize>(terms: &Terms<N>, rest: &[f64; N]) -> bool {
    let tail = &terms[TERMS - TAIL..];
    tail.iter()
        .flat_map(|terms| terms.iter().zip(rest))
        .all(|(term, rest)| !term.is_finite() || term.abs() <= *rest)
}

/// Converts Chebyshev coefficients to powers: Σ c_n T_n(t) = Σ a_k t^k.
pub(super) fn powers<const N: usize>(terms: &Terms<N>) -> Terms<N> {
    let mut powers = [[0.0; N]; TERMS];
    for (order, (terms, polynomial)) in terms.iter().zip(&*POLYNOMIALS).enumerate() {
        // T_n is even or odd.
        for power in (order % 2..=order).step_by(2) {
            let coefficient = polynomial[power];
            powers[power].iter_mut().zip(terms).for_each(|(sum, term)| *sum += coefficient * term);
        }
    }
    powers
}

/// Σ a_k t^k of `M` functions, starting with function `first`, by Estrin's scheme. Its partial sums
/// are independent of each other.
#[inline]
pub(super) fn values<const N: usize, const M: usize>(
    powers: &Terms<N>,
    first: usize,
    t: f64,
) -> [f64; M] {
    let (square, fourth) = (t * t, (t * t) * (t * t));
    let pair = |at: usize, function: usize| powers[at][function] + powers[at + 1][function] * t;
    let four = |at: usize, function: usize| pair(at, function) + pair(at + 2, function) * square;
    let eight = |at: usize, function: usize| four(at, function) + four(at + 4, function) * fourth;
    from_fn(|function| eight(0, first + function) + eight(8, first + function) * (fourth * fourth))
}

/// The same at several places at once, by Horner's rule.
pub(super) fn values_at<const N: usize, const M: usize>(
    powers: &Terms<N>,
    first: usize,
    t: &[f64; TERMS],
) -> [Lanes<TERMS>; M] {
    let mut all = [Lanes::all(0.0); M];
    for powers in powers.iter().rev() {
        for (sums, power) in all.iter_mut().zip(&powers[first..first + M]) {
            for (sum, t) in sums.0.iter_mut().zip(t) {
                *sum = *sum * t + power;
            }
        }
    }
    all
}

/// The coefficients of the powers of t − `at`, by Horner's rule for all coefficients together. The
/// sums of one round are independent of each other.
pub(super) fn about<const N: usize, const M: usize>(
    powers: &Terms<N>,
    first: usize,
    at: f64,
) -> [Polynomial<TERMS>; M] {
    let mut rest = [[0.0; M]; TERMS];
    rest.iter_mut()
        .zip(powers)
        .for_each(|(rest, powers)| rest.copy_from_slice(&powers[first..first + M]));
    for lowest in (0..TERMS - 1).rev() {
        for power in lowest..TERMS - 1 {
            let above = rest[power + 1];
            for (sum, above) in rest[power].iter_mut().zip(above) {
                *sum += at * above;
            }
        }
    }
    let mut all = [Polynomial::ZERO; M];
    for (power, values) in rest.iter().enumerate() {
        all.iter_mut().zip(values).for_each(|(function, value)| function.0[power] = *value);
    }
    all
}

/// ∫ of a function from −1 to 1.
pub(super) fn integral<const N: usize>(powers: &Terms<N>, function: usize) -> f64 {
    let even = powers.iter().enumerate().step_by(2);
    even.map(|(order, powers)| 2.0 * powers[function] / (order + 1) as f64).sum()
}
