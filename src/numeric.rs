//! Numerical methods that know no gears.
