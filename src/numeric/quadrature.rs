//! Gauss-Legendre quadrature on a fixed number of nodes.

/// Positive nodes and their weights of the 12-point rule on (-1, 1). The rule is symmetric.
const TWELVE: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_4, 0.203_167_426_723_065_9),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_2),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_4),
    (0.981_560_634_246_719_2, 0.047_175_336_386_511_83),
];

/// Nodes and weights of the 12-point Gauss-Legendre rule from 0 to 1.
pub fn nodes() -> impl Iterator<Item = (f64, f64)> {
    TWELVE
        .into_iter()
        .flat_map(|(node, weight)| [-node, node].map(|node| (0.5 + 0.5 * node, 0.5 * weight)))
}

/// ∫ of `f` from 0 to 1 by the 12-point Gauss-Legendre rule.
pub fn unit_interval(f: impl Fn(f64) -> f64) -> f64 {
    TWELVE
        .iter()
        .map(|&(node, weight)| weight * (f(0.5 - 0.5 * node) + f(0.5 + 0.5 * node)))
        .sum::<f64>()
        * 0.5
}

/// ∫ of `f` from `from` to `to` by the 12-point rule with adaptive halving. Halves a part until its
/// halves agree with it within `tolerance` times the first estimate of the integral. The number of
/// halvings is limited.
pub fn adaptive(from: f64, to: f64, tolerance: f64, f: impl Fn(f64) -> f64) -> f64 {
    const MOST_HALVINGS: u32 = 40;
    let whole = over(from, to, &f);
    let mut halving = Halving { f, tolerance: tolerance * whole.abs(), rest: MOST_PARTS };
    halving.halved((from, to), whole, MOST_HALVINGS)
}

/// Limit of the halved parts. A function that needs more is rough from rounding.
const MOST_PARTS: u32 = 1000;

fn over(from: f64, to: f64, f: &impl Fn(f64) -> f64) -> f64 {
    (to - from) * unit_interval(|part| f(from + part * (to - from)))
}

/// The state of an adaptive integration.
struct Halving<F> {
    f: F,
    tolerance: f64,
    /// Parts that may still be halved.
    rest: u32,
}

impl<F: Fn(f64) -> f64> Halving<F> {
    /// The integral over a part with the estimate `whole`.
    fn halved(&mut self, (from, to): (f64, f64), whole: f64, halvings: u32) -> f64 {
        let middle = f64::midpoint(from, to);
        let (left, right) = (over(from, middle, &self.f), over(middle, to, &self.f));
        let sum = left + right;
        let is_close = (sum - whole).abs() <= self.tolerance;
        if halvings == 0 || self.rest == 0 || !sum.is_finite() || is_close {
            return sum;
        }
        self.rest -= 1;
        self.halved((from, middle), left, halvings - 1)
            + self.halved((middle, to), right, halvings - 1)
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::{MOST_PARTS, adaptive, unit_interval};

    #[test]
    fn the_integration_of_a_rough_function_ends() {
        let looks = Cell::new(0);
        let rough = |x: f64| {
            looks.set(looks.get() + 1);
            (1e9 * x).sin() * (1e12 * x).cos()
        };
        assert!(adaptive(0.0, 1.0, 1e-14, rough).is_finite());
        assert!(looks.get() <= 24 * (2 * MOST_PARTS + 1) + 12, "{}", looks.get());
    }

    #[test]
    fn exact_for_polynomials_up_to_degree_23() {
        for degree in 0..24 {
            let found = unit_interval(|x| x.powi(degree));
            assert!((found * f64::from(degree + 1) - 1.0).abs() < 1e-14, "x^{degree}: {found}");
        }
    }

    #[test]
    fn adaptive_integration_finds_a_peak() {
        let found = adaptive(-1.0, 1.0, 1e-12, |x| 1.0 / (1e-8 + x * x));
        let exact = 2.0 * 1e4 * 1e4f64.atan();
        assert!((found / exact - 1.0).abs() < 1e-11, "{found}");
    }
}
