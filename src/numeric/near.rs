//! Logarithm and exponential near 1 and 0, faster than the functions of the standard library.

/// The sixth power of a smaller number is below rounding.
const SMALL: f64 = 1e-3;

/// The tenth power of half of a smaller number is below rounding.
const NEAR: f64 = 0.05;

/// ln(1 + x).
///
/// # Formula
/// ```text
/// ln(1 + x) = 2 artanh s = x − x²/2 + s (x²/2 + 2 s²/3 + 2 s⁴/5 + ..),  s = x/(2 + x)
/// ```
///
/// # Source
/// The arrangement of `log1p` in Sun's fdlibm, with series terms instead of fitted coefficients.
#[must_use]
pub fn logarithm(x: f64) -> f64 {
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
#[must_use]
pub fn exponential(x: f64) -> f64 {
    if x.abs() < SMALL {
        let rest = 1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0));
        1.0 + x * (1.0 + x * (0.5 + x * rest))
    } else {
        x.exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_agree_with_the_standard_library_to_the_last_digits() {
        for power in 0..200 {
            let size = 0.5 * 0.9_f64.powi(power);
            for x in [size, -size] {
                let logarithm = logarithm(x) / x.ln_1p() - 1.0;
                assert!(logarithm.abs() < 1e-15, "ln(1 + {x}): {logarithm:e}");
                let exponential = exponential(x) / x.exp() - 1.0;
                assert!(exponential.abs() < 1e-15, "exp {x}: {exponential:e}");
            }
        }
    }
}
