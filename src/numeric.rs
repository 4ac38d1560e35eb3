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
