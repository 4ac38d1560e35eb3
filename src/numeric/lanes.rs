//! Numbers side by side, on which one operation acts at once.

use std::array::from_fn;
use std::ops::{Add, Div, Mul, Sub};

/// `L` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Lanes<L> {
    /// The same number everywhere.
    #[must_use]
    pub fn all(number: f64) -> Lanes<L> {
        Lanes([number; L])
    }
}

impl<const L: usize> Add for Lanes<L> {
    type Output = Lanes<L>;

    fn add(self, other: Lanes<L>) -> Lanes<L> {
        Lanes(from_fn(|lane| self.0[lane] + other.0[lane]))
    }
}

impl<const L: usize> Sub for Lanes<L> {
    type Output = Lanes<L>;

    fn sub(self, other: Lanes<L>) -> Lanes<L> {
        Lanes(from_fn(|lane| self.0[lane] - other.0[lane]))
    }
}

impl<const L: usize> Mul for Lanes<L> {
    type Output = Lanes<L>;

    fn mul(self, other: Lanes<L>) -> Lanes<L> {
        Lanes(from_fn(|lane| self.0[lane] * other.0[lane]))
    }
}

impl<const L: usize> Mul<f64> for Lanes<L> {
    type Output = Lanes<L>;

    fn mul(self, factor: f64) -> Lanes<L> {
        Lanes(self.0.map(|number| number * factor))
    }
}

impl<const L: usize> Div for Lanes<L> {
    type Output = Lanes<L>;

    fn div(self, other: Lanes<L>) -> Lanes<L> {
        Lanes(from_fn(|lane| self.0[lane] / other.0[lane]))
    }
}
