//! The number types of the model: f64, double-double to check the last digits, and numbers side by
//! side; logarithm and exponential near 1 and 0.

use std::array::from_fn;
use std::f64::consts;
use std::ops::{Add, Div, Mul, Neg, Sub};

use nalgebra::{ClosedAddAssign, ClosedMulAssign, ClosedSubAssign, Scalar};
use num_traits::{One, Zero};
use twofloat::TwoFloat;

/// A real number of some precision, with the functions that plane geometry needs.
pub trait Real:
    Scalar
    + Copy
    + Zero
    + One
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + Neg<Output = Self>
    + PartialOrd
    + From<f64>
    + Into<f64>
{
    /// Relative size of a rounding error.
    const EPSILON: f64;
    /// π.
    const PI: Self;

    /// `self/divisor`.
    fn over(self, divisor: Self) -> Self;

    /// √x.
    fn root(self) -> Self;

    /// Sine and cosine of an angle within a turn.
    fn sine_cosine(self) -> (Self, Self);

    /// The angle whose tangent is `self/x`, in the quadrant of `(x, self)`.
    fn angle_to(self, x: Self) -> Self;

    /// Rounded to f64.
    fn rounded(self) -> f64 {
        self.into()
    }
}

impl Real for f64 {
    const EPSILON: f64 = f64::EPSILON;
    const PI: f64 = consts::PI;

    fn over(self, divisor: f64) -> f64 {
        self / divisor
    }

    fn root(self) -> f64 {
        self.sqrt()
    }

    fn sine_cosine(self) -> (f64, f64) {
        self.sin_cos()
    }

    fn angle_to(self, x: f64) -> f64 {
        self.atan2(x)
    }
}

/// Only sums, products and roots of the crate `twofloat` have 31 digits. Its quotient of two
/// double-doubles has 17 digits, its sine, cosine and arctangent 17 to 21. This implementation
/// corrects or replaces these functions.
impl Real for TwoFloat {
    const EPSILON: f64 = 1e-30;
    const PI: TwoFloat = twofloat::consts::PI;

    fn over(self, divisor: TwoFloat) -> TwoFloat {
        let near = self / divisor;
        near + (self - near * divisor) / divisor
    }

    fn root(self) -> TwoFloat {
        self.sqrt()
    }

    /// Taylor's series of a sixteenth of the angle, doubled four times. The recurrence computes 1 −
    /// cos, so that small angles keep their digits.
    fn sine_cosine(self) -> (TwoFloat, TwoFloat) {
        const HALVINGS: i32 = 4;
        const LAST_ORDER: u32 = 22;
        let angle = self / f64::from(1 << HALVINGS);
        let square = angle * angle;
        let mut sine = TwoFloat::from(0.0);
        let mut versine = TwoFloat::from(0.0);
        for order in (1..=LAST_ORDER / 2).rev() {
            let (even, odd) = (f64::from(2 * order), f64::from(2 * order + 1));
            sine = square / (even * odd) * (1.0 - sine);
            versine = square / (even * (even - 1.0)) * (1.0 - versine);
        }
        sine = angle * (1.0 - sine);
        for _ in 0..HALVINGS {
            (sine, versine) = (2.0 * sine * (1.0 - versine), 2.0 * sine * sine);
        }
        (sine, 1.0 - versine)
    }

    /// One Newton step from the f64 angle. The correction is so small that it equals its tangent.
    fn angle_to(self, x: TwoFloat) -> TwoFloat {
        let near = self.hi().atan2(x.hi());
        let (sine, cosine) = TwoFloat::from(near).sine_cosine();
        (self * cosine - x * sine).over(x * cosine + self * sine) + near
    }
}

/// The sixth power of a smaller number is below rounding.
const SMALL: f64 = 1e-3;

/// The tenth power of half of a smaller number is below rounding.
const NEAR: f64 = 0.05;

/// ln(1 + x), faster than the function of the standard library.
///
/// # Formula
/// ```text
/// ln(1 + x) = 2 artanh s = x − x²/2 + s (x²/2 + 2 s²/3 + 2 s⁴/5 + ..),  s = x/(2 + x)
/// ```
///
/// # Source
/// The arrangement of `log1p` in Sun's fdlibm, with series terms instead of fitted coefficients.
pub fn logarithm_near_one(x: f64) -> f64 {
    if x.abs() < SMALL {
        let rest = 1.0 / 3.0 - x * (0.25 - x * (0.2 - x * (1.0 / 6.0)));
        x * (1.0 - x * (0.5 - x * rest))
    } else if x.abs() < NEAR {
        let (half_square, s) = (0.5 * x * x, x / (2.0 + x));
        let square = s * s;
        let rest = 2.0 / 5.0 + square * (2.0 / 7.0 + square * (2.0 / 9.0));
        let rest = square * (2.0 / 3.0 + square * rest);
        x - (half_square - s * (half_square + rest))
    } else {
        x.ln_1p()
    }
}

/// e^x.
pub fn exponential_near_zero(x: f64) -> f64 {
    if x.abs() < SMALL {
        let rest = 1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0));
        1.0 + x * (1.0 + x * (0.5 + x * rest))
    } else {
        x.exp()
    }
}

/// `L` numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lanes<const L: usize>(pub [f64; L]);

impl<const L: usize> Lanes<L> {
    /// The same number everywhere.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn double_double_quotient_keeps_thirty_digits() {
        let (dividend, divisor) = (TwoFloat::PI, TwoFloat::from(0.7).root());
        let rest = dividend.over(divisor) * divisor - dividend;
        assert!(rest.hi().abs() < 1e-30, "{rest:e}");
    }

    #[test]
    fn double_double_functions_keep_thirty_digits() {
        let (sine, cosine) = TwoFloat::from(0.7).sine_cosine();
        let identity = sine * sine + cosine * cosine - 1.0;
        assert!(identity.hi().abs() < 1e-30, "sin² + cos² − 1 = {identity:e}");
        for angle in [1e-9f64, 1e-3, 0.1, 0.35, 0.7, 1.2, 1.5] {
            let (sine, cosine) = TwoFloat::from(angle).sine_cosine();
            assert!(((sine.hi() - angle.sin()) / angle).abs() < 1e-15, "sin {angle}");
            let back = sine.angle_to(cosine) - angle;
            assert!((back.hi() / angle).abs() < 1e-29, "error of the angle {angle}: {back:e}");
        }
    }

    #[test]
    fn both_agree_with_the_standard_library_to_the_last_digits() {
        for power in 0..200 {
            let size = 0.5 * 0.9_f64.powi(power);
            for x in [size, -size] {
                let logarithm = logarithm_near_one(x) / x.ln_1p() - 1.0;
                assert!(logarithm.abs() < 1e-15, "ln(1 + {x}): {logarithm:e}");
                let exponential = exponential_near_zero(x) / x.exp() - 1.0;
                assert!(exponential.abs() < 1e-15, "exp {x}: {exponential:e}");
            }
        }
    }
}
