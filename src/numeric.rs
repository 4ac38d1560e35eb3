//! Numerical methods that know no gears.

pub mod decimal;
pub mod quadrature;
pub mod real;

pub use real::Real;
