//! Numerical methods, independent of gears.

pub mod banded;
pub mod bernstein;
pub mod chebyshev;
pub mod decimal;
pub mod extrapolated;
pub mod lanes;
pub mod near;
pub mod peak;
pub mod polynomial;
pub mod quadrature;
pub mod real;
pub mod root;
pub mod taylor;

pub use real::Real;
