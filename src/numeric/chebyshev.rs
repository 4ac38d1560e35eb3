//! Functions of one variable as pieces of Chebyshev series, cheap to evaluate and as exact as the digits allow.

use std::f64::consts::PI;

/// Terms of a piece.
const TERMS: usize = 16;
/// The last terms of a piece, in which the rest of the series shows.
const TAIL: usize = 3;
/// A piece is halved no further: a function that is still not smooth there has a branch point.
const MOST_HALVINGS: u32 = 30;

/// `N` functions on one interval, each a Chebyshev series on every piece of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Series<const N: usize> {
    pieces: Vec<Piece<N>>,
}

#[derive(Debug, Clone, PartialEq)]
struct Piece<const N: usize> {
    from: f64,
    to: f64,
    terms: [[f64; TERMS]; N],
}

impl<const N: usize> Series<N> {
    /// The functions `f` from `from` to `to`, halved until the last terms of each series are below what `rest` allows on
    /// the piece from one end to the other.
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
        let mut pieces = Vec::new();
        halve(from, to, rest, MOST_HALVINGS, f, &mut pieces)?;
        Ok(Series { pieces })
    }

    /// The values at `x`; outside the interval its end pieces go on.
    #[must_use]
    pub fn at(&self, x: f64) -> [f64; N] {
        let Some(piece) = self.piece(x) else { return [f64::NAN; N] };
        let t = piece.inner(x);
        std::array::from_fn(|function| clenshaw(&piece.terms[function], t))
    }

    /// The value of one function at `x`.
    #[must_use]
    pub fn one(&self, function: usize, x: f64) -> f64 {
        self.piece(x).map_or(f64::NAN, |piece| clenshaw(&piece.terms[function], piece.inner(x)))
    }

    /// The slope of one function at `x`.
    #[must_use]
    pub fn slope(&self, function: usize, x: f64) -> f64 {
        let Some(piece) = self.piece(x) else { return f64::NAN };
        slope(&piece.terms[function], piece.inner(x)) * 2.0 / (piece.to - piece.from)
    }

    /// The integral of one function over the whole interval.
    #[must_use]
    pub fn integral(&self, function: usize) -> f64 {
        self.pieces.iter().map(|piece| 0.5 * (piece.to - piece.from) * integral(&piece.terms[function])).sum()
    }

    fn piece(&self, x: f64) -> Option<&Piece<N>> {
        if let [only] = self.pieces.as_slice() {
            return Some(only);
        }
        let after = self.pieces.partition_point(|piece| piece.to < x);
        self.pieces.get(after).or_else(|| self.pieces.last())
    }
}

impl<const N: usize> Piece<N> {
    /// `x` on the piece, from −1 to 1.
    fn inner(&self, x: f64) -> f64 {
        ((x - self.from) - (self.to - x)) / (self.to - self.from)
    }
}

fn halve<const N: usize, E>(
    from: f64,
    to: f64,
    rest: &impl Fn(f64, f64) -> [f64; N],
    halvings: u32,
    f: &impl Fn(f64) -> Result<[f64; N], E>,
    pieces: &mut Vec<Piece<N>>,
) -> Result<(), E> {
    let terms = interpolate(from, to, f)?;
    let middle = f64::midpoint(from, to);
    if halvings == 0 || terms.iter().zip(rest(from, to)).all(|(terms, rest)| has_settled(terms, rest)) {
        pieces.push(Piece { from, to, terms });
        return Ok(());
    }
    halve(from, middle, rest, halvings - 1, f, pieces)?;
    halve(middle, to, rest, halvings - 1, f, pieces)
}

/// The terms of the polynomials through the function's values at the Chebyshev points of the first kind.
fn interpolate<const N: usize, E>(from: f64, to: f64, f: &impl Fn(f64) -> Result<[f64; N], E>) -> Result<[[f64; TERMS]; N], E> {
    let angle = |point: usize| PI * (point as f64 + 0.5) / TERMS as f64;
    let mut values = [[0.0; TERMS]; N];
    for point in 0..TERMS {
        let x = f64::midpoint(from, to) + 0.5 * (to - from) * angle(point).cos();
        for (value, found) in values.iter_mut().zip(f(x)?) {
            value[point] = found;
        }
    }
    Ok(values.map(|value| {
        std::array::from_fn(|order| {
            let sum: f64 = (0..TERMS).map(|point| value[point] * (order as f64 * angle(point)).cos()).sum();
            sum * if order == 0 { 1.0 } else { 2.0 } / TERMS as f64
        })
    }))
}

/// Whether the last terms are small enough, or so large that no halving would help.
fn has_settled(terms: &[f64; TERMS], rest: f64) -> bool {
    terms[TERMS - TAIL..].iter().all(|term| !term.is_finite() || term.abs() <= rest)
}

/// Σ c_n T_n(t) by Clenshaw's recurrence.
fn clenshaw(terms: &[f64; TERMS], t: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for term in terms[1..].iter().rev() {
        (one, two) = (term + 2.0 * t * one - two, one);
    }
    terms[0] + t * one - two
}

/// Σ n c_n U_(n−1)(t), the derivative of the series, by the same recurrence.
fn slope(terms: &[f64; TERMS], t: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for (order, term) in terms.iter().enumerate().skip(1).rev() {
        (one, two) = (order as f64 * term + 2.0 * t * one - two, one);
    }
    one
}

/// ∫ of the series from −1 to 1.
fn integral(terms: &[f64; TERMS]) -> f64 {
    let even = terms.iter().enumerate().step_by(2);
    even.map(|(order, term)| 2.0 * term / (1.0 - (order * order) as f64)).sum()
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
            assert!((sine - x.sin()).abs() < 2e-14 && (growth / (0.3 * x).exp() - 1.0).abs() < 2e-14, "{x}");
            assert!((found.slope(0, x) - x.cos()).abs() < 1e-11, "{x}: {}", found.slope(0, x));
            assert!((found.one(1, x) - growth).abs() == 0.0);
        }
        assert!((found.integral(0) - (2f64.cos() - 7f64.cos())).abs() < 1e-13);
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
    fn what_the_function_refuses_is_passed_on() {
        let refused = Series::of(0.0, 1.0, &|_, _| [1e-14], &|x| if x > 0.5 { Err("beyond") } else { Ok([x]) });
        assert_eq!(refused, Err("beyond"));
    }
}
