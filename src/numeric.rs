//! Numerical methods that know no gears.

pub mod quadrature;
pub mod real;

pub use real::Real;
