//! Numerical methods, independent of gears.

pub mod banded;
pub mod chebyshev;
pub mod decimal;
pub mod polynomial;
pub mod quadrature;
pub mod real;
pub mod root;
pub mod taylor;

pub use real::Real;

/// The places in rising order, without those at most `least` above another one.
pub fn distinct(mut places: Vec<f64>, least: f64) -> Vec<f64> {
    places.sort_by(f64::total_cmp);
    places.dedup_by(|one, other| *one - *other <= least);
    places
}

/// The ends of `count` equal steps, from the first end to the last.
pub fn steps(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
    (0..=count).map(move |step| from + (to - from) * step as f64 / count as f64)
}

/// The least and the greatest value.
pub fn bounds(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    values.into_iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}
