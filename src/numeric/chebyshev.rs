//! Functions of one variable as polynomials on pieces, computed from Chebyshev series to full f64
//! precision and cheap to evaluate.

mod terms;
#[cfg(test)]
mod tests;

use std::array::from_fn;

use super::lanes::Lanes;
use super::polynomial::Polynomial;
pub use terms::TERMS;
use terms::{
    Terms, about, has_settled, integral, interpolate, place, powers, terms_of, values, values_at,
};

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
        let mut pieces = Vec::new();
        halve(from, to, rest, MOST_HALVINGS, f, &mut pieces)?;
        Ok(Series { pieces })
    }

    /// Samples groups of functions on common pieces. `f` writes the values of all groups at several
    /// places, place by place.
    pub fn groups(
        from: f64,
        to: f64,
        rest: &[[f64; N]],
        f: &impl Fn(&Places, &mut [[[f64; N]; TERMS]]),
    ) -> Vec<Series<N>> {
        let mut groups = vec![Series { pieces: Vec::new() }; rest.len()];
        halve_groups((from, to), rest, MOST_HALVINGS, f, &mut groups);
        groups
    }

    /// The values of the first `M` functions at `x`. `x` may be beyond the interval by rounding.
    #[must_use]
    pub fn at<const M: usize>(&self, x: f64) -> [f64; M] {
        self.piece(x).map_or([f64::NAN; M], |piece| values(&piece.powers, 0, piece.inner(x)))
    }

    /// The values of `M` functions, from `first` on, at several places.
    #[must_use]
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
    #[must_use]
    pub fn bounds(&self, function: usize, (x, least): (f64, f64)) -> (f64, f64) {
        self.piece_above(x, least).map_or((f64::NEG_INFINITY, f64::INFINITY), |piece| {
            let middle = piece.powers[0][function];
            let varying = piece.powers[1..].iter();
            let varying: f64 = varying.map(|terms| terms[function].abs()).sum();
            (middle - varying, middle + varying)
        })
    }

    /// The value of one function at `x`.
    #[must_use]
    pub fn one(&self, function: usize, x: f64) -> f64 {
        let [value] = self
            .piece(x)
            .map_or([f64::NAN], |piece| values(&piece.powers, function, piece.inner(x)));
        value
    }

    /// The slope of one function at `x`.
    #[must_use]
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
    #[must_use]
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
    #[must_use]
    pub fn serves_until(&self, x: f64, least: f64) -> f64 {
        let last = self.pieces.last().map_or(f64::NAN, |piece| piece.from);
        self.piece_above(x, least)
            .filter(|piece| piece.from < last)
            .map_or(f64::INFINITY, |piece| piece.to)
    }

    /// The functions of `about` − x, each multiplied by its sign.
    #[must_use]
    pub fn reversed(&self, about: f64, signs: [f64; N]) -> Series<N> {
        let pieces = self.pieces.iter().rev();
        Series { pieces: pieces.map(|piece| piece.reversed(about, signs)).collect() }
    }

    /// The start of the first piece.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.pieces.first().map_or(f64::NAN, |piece| piece.from)
    }

    /// Number of evaluations of the functions that the construction needed.
    #[must_use]
    pub fn evaluations(&self) -> usize {
        // N pieces come from N − 1 halvings, so the construction sampled 2 N − 1 intervals.
        TERMS * (2 * self.pieces.len()).saturating_sub(1)
    }

    /// Memory of the pieces, in bytes.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.pieces)
    }

    /// The integral of one function over the whole interval.
    #[must_use]
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
    if may_not_halve((from, to), halvings, pieces.len()) || has_settled(&terms, &rest(from, to)) {
        pieces.push(Piece { from, to, powers: powers(&terms) });
        return Ok(());
    }
    halve(from, middle, rest, halvings - 1, f, pieces)?;
    halve(middle, to, rest, halvings - 1, f, pieces)
}

fn halve_groups<const N: usize>(
    (from, to): (f64, f64),
    rest: &[[f64; N]],
    halvings: u32,
    f: &impl Fn(&Places, &mut [[[f64; N]; TERMS]]),
    groups: &mut [Series<N>],
) {
    let mut terms = vec![[[0.0; N]; TERMS]; groups.len()];
    f(&from_fn(|point| place(from, to, point)), &mut terms);
    for terms in &mut terms {
        *terms = terms_of(terms);
    }
    let middle = f64::midpoint(from, to);
    let pieces = groups.first().map_or(0, |group| group.pieces.len());
    let has_settled = terms.iter().zip(rest).all(|(terms, rest)| has_settled(terms, rest));
    if has_settled || may_not_halve((from, to), halvings, pieces) {
        for (group, terms) in groups.iter_mut().zip(&terms) {
            group.pieces.push(Piece { from, to, powers: powers(terms) });
        }
        return;
    }
    halve_groups((from, middle), rest, halvings - 1, f, groups);
    halve_groups((middle, to), rest, halvings - 1, f, groups);
}

/// Whether the interval has its least width, or the halvings or the pieces reached their limit.
fn may_not_halve((from, to): (f64, f64), halvings: u32, pieces: usize) -> bool {
    let is_narrow = to - from <= NARROWEST * from.abs().max(to.abs());
    halvings == 0 || is_narrow || pieces >= MOST_PIECES
}
