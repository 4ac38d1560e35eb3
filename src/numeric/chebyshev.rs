//! Functions of one variable as polynomials on pieces, computed from Chebyshev series to full f64
//! precision and cheap to evaluate.

use std::array::from_fn;
use std::convert::Infallible;
use std::f64::consts::PI;
use std::sync::LazyLock;

use super::polynomial::Polynomial;
use super::real::Lanes;

/// As many places as a piece has terms.
pub type Places = [f64; TERMS];

/// Limit of the halvings. A function that is still not smooth has a branch point in the piece.
const MOST_HALVINGS: u32 = 30;
/// Limit of the pieces, for a function that is rough from rounding.
const MOST_PIECES: usize = 128;

/// Least width of a halved piece relative to its position. Points of a narrower piece round
/// together.
const NARROWEST: f64 = 256.0 * f64::EPSILON;

/// `N` functions on one interval, each a polynomial on every piece of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Series<const N: usize> {
    pieces: Vec<Piece<N>>,
}

#[derive(Debug, Clone, PartialEq)]
struct Piece<const N: usize> {
    from: f64,
    to: f64,
    /// Coefficients of the powers of the place on the piece from −1 to 1. The terms of a converged
    /// series fall so fast that the powers keep its digits.
    powers: Terms<N>,
}

impl<const N: usize> Series<N> {
    /// Samples the functions `f` from `from` to `to`. Halves the interval until the last terms of
    /// each series are below `rest(from, to)` of the piece.
    ///
    /// # Source
    /// Trefethen 2013, "Approximation Theory and Approximation Practice", chapters 3 and 4.
    ///
    /// # Errors
    /// Those of `f`.
    pub fn of<E>(
        from: f64,
        to: f64,
        rest: &impl Fn(f64, f64) -> [f64; N],
        f: &impl Fn(f64) -> Result<[f64; N], E>,
    ) -> Result<Series<N>, E> {
        let mut series = [Series { pieces: Vec::new() }];
        let fill = |places: &Places, values: &mut [Terms<N>]| {
            let mut values = places.iter().zip(&mut values[0]);
            values.try_for_each(|(place, value)| f(*place).map(|found| *value = found))
        };
        let rest = |_, from, to| rest(from, to);
        halve((from, to), &rest, MOST_HALVINGS, &fill, &mut series)?;
        let [series] = series;
        Ok(series)
    }

    /// Samples groups of functions on common pieces. `f` writes the values of all groups at several
    /// places, place by place.
    pub fn groups(
        from: f64,
        to: f64,
        rest: &[[f64; N]],
        f: &impl Fn(&Places, &mut [Terms<N>]),
    ) -> Vec<Series<N>> {
        let mut groups = vec![Series { pieces: Vec::new() }; rest.len()];
        let fill = |places: &Places, values: &mut [Terms<N>]| {
            f(places, values);
            Ok::<(), Infallible>(())
        };
        let Ok(()) =
            halve((from, to), &|group, _, _| rest[group], MOST_HALVINGS, &fill, &mut groups);
        groups
    }

    /// The functions on one interval after the other.
    pub fn joined(parts: impl IntoIterator<Item = Series<N>>) -> Series<N> {
        Series { pieces: parts.into_iter().flat_map(|part| part.pieces).collect() }
    }

    /// The values of the first `M` functions at `x`. `x` may be beyond the interval by rounding.
    pub fn at<const M: usize>(&self, x: f64) -> [f64; M] {
        self.piece(x).map_or([f64::NAN; M], |piece| values(&piece.powers, 0, piece.inner(x)))
    }

    /// The values of `M` functions, from `first` on, at several places.
    pub fn many<const M: usize>(&self, first: usize, places: &Places) -> [Lanes<TERMS>; M] {
        let low = places.iter().copied().fold(f64::INFINITY, f64::min);
        let high = places.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        match (self.piece(low), self.piece(high)) {
            (Some(one), Some(other)) if std::ptr::eq(one, other) => {
                values_at(&one.powers, first, &places.map(|x| one.inner(x)))
            }
            _ => {
                let mut all = [Lanes::all(0.0); M];
                for (lane, x) in places.iter().enumerate() {
                    for (function, values) in all.iter_mut().enumerate() {
                        values.0[lane] = self.one(first + function, *x);
                    }
                }
                all
            }
        }
    }

    /// No value of one function is below the first and none above the second, on the piece that
    /// serves from `x` up by [`Series::serves_until`].
    pub fn bounds(&self, function: usize, (x, least): (f64, f64)) -> (f64, f64) {
        self.piece_above(x, least).map_or((f64::NEG_INFINITY, f64::INFINITY), |piece| {
            let middle = piece.powers[0][function];
            let varying = piece.powers[1..].iter();
            let varying: f64 = varying.map(|terms| terms[function].abs()).sum();
            (middle - varying, middle + varying)
        })
    }

    /// The value of one function at `x`.
    pub fn one(&self, function: usize, x: f64) -> f64 {
        let [value] = self
            .piece(x)
            .map_or([f64::NAN], |piece| values(&piece.powers, function, piece.inner(x)));
        value
    }

    /// The slope of one function at `x`.
    pub fn slope(&self, function: usize, x: f64) -> f64 {
        self.piece(x).map_or(f64::NAN, |piece| {
            let t = piece.inner(x);
            let terms = piece.powers.iter().enumerate().skip(1).rev();
            terms.fold(0.0, |sum, (power, terms)| sum * t + power as f64 * terms[function]) * 2.0
                / (piece.to - piece.from)
        })
    }

    /// `M` functions, starting with function `first`, from `x` to `x + length` as polynomials from
    /// 0 to 1. The piece is the piece of [`Series::serves_until`].
    pub fn local<const M: usize>(
        &self,
        first: usize,
        (x, least): (f64, f64),
        length: f64,
    ) -> [Polynomial<TERMS>; M] {
        self.piece_above(x, least).map_or([Polynomial([f64::NAN; TERMS]); M], |piece| {
            let scale = 2.0 * length / (piece.to - piece.from);
            let mut functions = about(&piece.powers, first, piece.inner(x));
            for function in &mut functions {
                function.stretch(scale);
            }
            functions
        })
    }

    /// End of the piece used from `x` on. A piece with less than `least` left is skipped. Infinite
    /// for the last piece.
    pub fn serves_until(&self, x: f64, least: f64) -> f64 {
        let last = self.pieces.last().map_or(f64::NAN, |piece| piece.from);
        self.piece_above(x, least)
            .filter(|piece| piece.from < last)
            .map_or(f64::INFINITY, |piece| piece.to)
    }

    /// The functions of `about` − x, each multiplied by its sign.
    pub fn reversed(&self, about: f64, signs: [f64; N]) -> Series<N> {
        let pieces = self.pieces.iter().rev();
        Series { pieces: pieces.map(|piece| piece.reversed(about, signs)).collect() }
    }

    /// The first function, and the integral of each function from the start on. `M` is `N` + 1.
    pub fn with_integrals<const M: usize>(&self) -> Series<M> {
        let mut sums = [0.0; N];
        let pieces = self.pieces.iter().map(|piece| {
            let mut powers = [[0.0; M]; TERMS];
            let half = 0.5 * (piece.to - piece.from);
            for (power, terms) in piece.powers.iter().enumerate() {
                powers[power][0] = terms[0];
                // The last of the terms is below the rest of the series.
                if let Some(next) = powers.get_mut(power + 1) {
                    let parts = next[1..].iter_mut().zip(terms);
                    parts.for_each(|(part, term)| *part = half * term / (power + 1) as f64);
                }
            }
            for (function, sum) in sums.iter_mut().enumerate() {
                let integral = |t: f64| {
                    let terms = powers.iter().rev();
                    terms.fold(0.0, |sum, terms| sum * t + terms[function + 1])
                };
                let [start, whole] = [integral(-1.0), integral(1.0) - integral(-1.0)];
                powers[0][function + 1] = *sum - start;
                *sum += whole;
            }
            Piece { from: piece.from, to: piece.to, powers }
        });
        Series { pieces: pieces.collect() }
    }

    /// The start of the first piece.
    pub fn start(&self) -> f64 {
        self.pieces.first().map_or(f64::NAN, |piece| piece.from)
    }

    /// Number of evaluations of the functions that the construction needed.
    pub fn evaluations(&self) -> usize {
        // N pieces come from N − 1 halvings, so the construction sampled 2 N − 1 intervals.
        TERMS * (2 * self.pieces.len()).saturating_sub(1)
    }

    /// Memory of the pieces, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.pieces)
    }

    /// The integral of one function over the whole interval.
    pub fn integral(&self, function: usize) -> f64 {
        self.pieces
            .iter()
            .map(|piece| 0.5 * (piece.to - piece.from) * integral(&piece.powers, function))
            .sum()
    }

    fn piece(&self, x: f64) -> Option<&Piece<N>> {
        if let [only] = self.pieces.as_slice() {
            return Some(only);
        }
        let after = self.pieces.partition_point(|piece| piece.to < x);
        self.pieces.get(after).or_else(|| self.pieces.last())
    }

    /// The piece used from `x` on. Skips a piece that ends here.
    fn piece_above(&self, x: f64, least: f64) -> Option<&Piece<N>> {
        const NOTHING: f64 = 1e-6;
        if let [only] = self.pieces.as_slice() {
            return Some(only);
        }
        let is_done =
            |piece: &Piece<N>| piece.to - x <= least.max(NOTHING * (piece.to - piece.from));
        let after = self.pieces.partition_point(is_done);
        self.pieces.get(after).or_else(|| self.pieces.last())
    }
}

impl<const N: usize> Piece<N> {
    fn reversed(&self, about: f64, signs: [f64; N]) -> Piece<N> {
        let mut powers = self.powers;
        for (power, terms) in powers.iter_mut().enumerate() {
            let turned = if power % 2 == 0 { 1.0 } else { -1.0 };
            for (term, sign) in terms.iter_mut().zip(signs) {
                *term *= turned * sign;
            }
        }
        Piece { from: about - self.to, to: about - self.from, powers }
    }

    /// Maps `x` to the piece from −1 to 1. Rounding can put `x` beyond an end of a narrow piece;
    /// the result is clamped near the end.
    fn inner(&self, x: f64) -> f64 {
        const BEYOND: f64 = 1.0 + 1e-3;
        (((x - self.from) - (self.to - x)) / (self.to - self.from)).clamp(-BEYOND, BEYOND)
    }
}

/// Halves the interval until the last terms of each function are below the `rest` of its group and
/// of the piece.
fn halve<const N: usize, E>(
    (from, to): (f64, f64),
    rest: &impl Fn(usize, f64, f64) -> [f64; N],
    halvings: u32,
    f: &impl Fn(&Places, &mut [Terms<N>]) -> Result<(), E>,
    groups: &mut [Series<N>],
) -> Result<(), E> {
    let mut terms = vec![[[0.0; N]; TERMS]; groups.len()];
    f(&from_fn(|point| place(from, to, point)), &mut terms)?;
    for terms in &mut terms {
        *terms = terms_of(terms);
    }
    let middle = f64::midpoint(from, to);
    let pieces = groups.first().map_or(0, |group| group.pieces.len());
    let has_settled =
        |(group, terms): (usize, &Terms<N>)| has_settled(terms, &rest(group, from, to));
    if may_not_halve((from, to), halvings, pieces) || terms.iter().enumerate().all(has_settled) {
        for (group, terms) in groups.iter_mut().zip(&terms) {
            group.pieces.push(Piece { from, to, powers: powers(terms) });
        }
        return Ok(());
    }
    halve((from, middle), rest, halvings - 1, f, groups)?;
    halve((middle, to), rest, halvings - 1, f, groups)
}

/// Whether the interval has its least width, or the halvings or the pieces reached their limit.
fn may_not_halve((from, to): (f64, f64), halvings: u32, pieces: usize) -> bool {
    let is_narrow = to - from <= NARROWEST * from.abs().max(to.abs());
    halvings == 0 || is_narrow || pieces >= MOST_PIECES
}

/// One value of every function for each order. This layout allows sums of several functions at
/// once.
pub type Terms<const N: usize> = [[f64; N]; TERMS];

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
fn place(from: f64, to: f64, point: usize) -> f64 {
    f64::midpoint(from, to) + 0.5 * (to - from) * COSINES[2 * point + 1]
}

/// The Chebyshev coefficients from the values at the Chebyshev points. The points are symmetric: terms of
/// even order need the sums of opposite values, terms of odd order their differences.
fn terms_of<const N: usize>(values: &Terms<N>) -> Terms<N> {
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
fn has_settled<const N: usize>(terms: &Terms<N>, rest: &[f64; N]) -> bool {
    let tail = &terms[TERMS - TAIL..];
    tail.iter()
        .flat_map(|terms| terms.iter().zip(rest))
        .all(|(term, rest)| !term.is_finite() || term.abs() <= *rest)
}

/// Converts Chebyshev coefficients to powers: Σ c_n T_n(t) = Σ a_k t^k.
fn powers<const N: usize>(terms: &Terms<N>) -> Terms<N> {
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
fn values<const N: usize, const M: usize>(powers: &Terms<N>, first: usize, t: f64) -> [f64; M] {
    let (square, fourth) = (t * t, (t * t) * (t * t));
    let pair = |at: usize, function: usize| powers[at][function] + powers[at + 1][function] * t;
    let four = |at: usize, function: usize| pair(at, function) + pair(at + 2, function) * square;
    let eight = |at: usize, function: usize| four(at, function) + four(at + 4, function) * fourth;
    from_fn(|function| eight(0, first + function) + eight(8, first + function) * (fourth * fourth))
}

/// The same at several places at once, by Horner's rule.
fn values_at<const N: usize, const M: usize>(
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
fn about<const N: usize, const M: usize>(
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
fn integral<const N: usize>(powers: &Terms<N>, function: usize) -> f64 {
    let even = powers.iter().enumerate().step_by(2);
    even.map(|(order, powers)| 2.0 * powers[function] / (order + 1) as f64).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series<const N: usize>(from: f64, to: f64, f: impl Fn(f64) -> [f64; N]) -> Series<N> {
        Series::of(from, to, &|_, _| [1e-14; N], &|x| Ok::<_, ()>(f(x))).unwrap()
    }

    #[test]
    fn smooth_functions_and_their_slopes_keep_their_digits() {
        let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp()]);
        for step in 0..=900 {
            let x = -2.0 + 0.01 * f64::from(step);
            let [sine, growth] = found.at(x);
            let slope = found.slope(0, x);
            assert!(
                (sine - x.sin()).abs() < 2e-14 && (growth / (0.3 * x).exp() - 1.0).abs() < 2e-14,
                "{x}"
            );
            assert!((slope - x.cos()).abs() < 1e-11, "{x}: {slope}");
            assert!((found.one(1, x) - growth).abs() == 0.0);
        }
        assert!((found.integral(0) - (2f64.cos() - 7f64.cos())).abs() < 1e-13);
    }

    #[test]
    fn groups_on_the_same_pieces_are_the_series_of_their_functions() {
        let functions = |x: f64| [[x.sin(), (0.3 * x).exp()], [x.cos(), 1.0 / (3.0 + x)]];
        let found = Series::<2>::groups(-2.0, 7.0, &[[1e-14; 2]; 2], &|places, values| {
            for (at, &x) in places.iter().enumerate() {
                let [one, other] = functions(x);
                (values[0][at], values[1][at]) = (one, other);
            }
        });
        assert_eq!(found[0].pieces.len(), found[1].pieces.len());
        for step in 0..=90 {
            let x = -2.0 + 0.1 * f64::from(step);
            for (group, expected) in found.iter().zip(functions(x)) {
                let values: [f64; 2] = group.at(x);
                for (value, expected) in values.iter().zip(expected) {
                    assert!((value - expected).abs() < 3e-14 * expected.abs().max(1.0), "{x}");
                }
            }
        }
    }

    #[test]
    fn values_side_by_side_are_those_of_each_place_whatever_its_piece() {
        let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp(), x.cos()]);
        assert!(found.pieces.len() > 1);
        for (from, to) in [(-1.9, -1.8), (-2.0, 7.0), (6.0, 6.0)] {
            let places = std::array::from_fn(|at| to + (from - to) * at as f64 / 15.0);
            let [growth, cosine] = found.many(1, &places);
            for (at, x) in places.iter().enumerate() {
                let off = (growth.0[at] / (0.3 * x).exp() - 1.0).abs();
                assert!(off < 3e-14, "{x}: {off:e}");
                assert!((cosine.0[at] - x.cos()).abs() < 3e-14, "{x}");
            }
        }
    }

    #[test]
    fn no_value_on_a_piece_is_beyond_its_bounds() {
        let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp()]);
        for step in 0..90 {
            let x = -2.0 + 0.1 * f64::from(step);
            let (low, high) = found.bounds(1, (x, 1e-12));
            let value = (0.3 * x).exp();
            assert!(low <= value && value <= high, "{x}: {low} {high}");
        }
    }

    #[test]
    fn reversed_pieces_are_the_functions_from_the_other_end() {
        let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp()]);
        let turned = found.reversed(5.0, [1.0, -1.0]);
        assert!((turned.start() + 2.0).abs() < 1e-15);
        for step in 0..=90 {
            let x = -2.0 + 0.1 * f64::from(step);
            let [sine, growth] = turned.at(5.0 - x);
            let [expected_sine, expected_growth] = found.at(x);
            assert!((sine - expected_sine).abs() < 1e-14, "{x}");
            assert!((growth + expected_growth).abs() < 1e-14 * expected_growth, "{x}");
        }
    }

    #[test]
    fn a_branch_point_at_the_end_costs_pieces_and_no_digits() {
        let found = series(0.0, 1.0, |x| [x.sqrt()]);
        assert!(found.pieces.len() < 50, "{}", found.pieces.len());
        for step in 0..=1000 {
            let x = 1e-3 * f64::from(step);
            let allowed = if step == 0 { 1e-5 } else { 1e-13 };
            assert!((found.one(0, x) - x.sqrt()).abs() < allowed, "{x}");
        }
    }

    #[test]
    fn about_another_place_the_pieces_are_the_same_functions() {
        let found = series(-2.0, 7.0, |x| [x.sin(), (0.3 * x).exp(), x.abs()]);
        let mut x = -2.0;
        while x < 7.0 - 1e-9 {
            let length = found.serves_until(x, 1e-12).min(7.0).min(x + 0.7) - x;
            let [growth, distance] = found.local(1, (x, 1e-12), length);
            for part in [0.0, 0.3, 1.0] {
                let at = x + part * length;
                assert!((growth.at(part) / (0.3 * at).exp() - 1.0).abs() < 1e-13, "{at}");
                assert!((distance.at(part) - at.abs()).abs() < 1e-6, "{at}");
            }
            x += length;
        }
    }

    #[test]
    fn a_place_beside_a_piece_as_narrow_as_rounding_has_the_value_of_its_end() {
        let (from, to) = (1.0, 1.0 + 4.0 * f64::EPSILON);
        assert_eq!(series(from, to, |x| [(1e20 * x).sin()]).pieces.len(), 1);
        let found = series(from, to, |x| [x, (1e20 * x).sin()]);
        for beside in [from - 100.0 * f64::EPSILON, to + 100.0 * f64::EPSILON] {
            let [line, rough] = found.at(beside);
            assert!((line - 1.0).abs() < 1e-13 && rough.abs() < 2.0, "{line} {rough}");
            let [rough] = found.local(1, (beside, 0.0), f64::EPSILON);
            assert!(rough.at(0.0).abs() < 2.0, "{rough:?}");
        }
    }

    #[test]
    fn what_the_function_refuses_is_passed_on() {
        let refused = Series::of(0.0, 1.0, &|_, _| [1e-14], &|x| {
            if x > 0.5 { Err("beyond") } else { Ok([x]) }
        });
        assert_eq!(refused, Err("beyond"));
    }
}
