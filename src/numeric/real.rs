//! The number types of the model: f64, and double-double to check the last digits.

use std::f64::consts;
use std::ops::Neg;

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
    #[must_use]
    fn over(self, divisor: Self) -> Self;

    /// √x.
    #[must_use]
    fn root(self) -> Self;

    /// Sine and cosine of an angle within a turn.
    #[must_use]
    fn sine_cosine(self) -> (Self, Self);

    /// The angle whose tangent is `self/x`, in the quadrant of `(x, self)`.
    #[must_use]
    fn angle_to(self, x: Self) -> Self;

    /// Rounded to f64.
    #[must_use]
    fn rounded(self) -> f64 {
        self.into()
    }

    /// Converts a whole number.
    #[must_use]
    fn count(count: u32) -> Self {
        f64::from(count).into()
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
}
