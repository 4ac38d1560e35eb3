//! Numerical methods that know no gears.

pub mod chebyshev;
pub mod decimal;
pub mod extrapolated;
pub mod ode;
pub mod quadrature;
pub mod real;
pub mod root;

pub use real::Real;
