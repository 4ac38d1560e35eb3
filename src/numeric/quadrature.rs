//! Gauss-Legendre quadrature on a fixed number of nodes.

/// Nodes and weights of the 12-point rule on (-1, 1); the rule is symmetric, so half of it stands here.
const TWELVE: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_4, 0.203_167_426_723_065_9),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_2),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_4),
    (0.981_560_634_246_719_2, 0.047_175_336_386_511_83),
];

/// ∫ of `f` from 0 to 1 by the 12-point Gauss-Legendre rule.
pub fn unit_interval(f: impl Fn(f64) -> f64) -> f64 {
    TWELVE.iter().map(|&(node, weight)| weight * (f(0.5 - 0.5 * node) + f(0.5 + 0.5 * node))).sum::<f64>() * 0.5
}

/// ∫ of `f` from `from` to `to`, cut into `parts` of equal length.
pub fn composite(from: f64, to: f64, parts: usize, f: impl Fn(f64) -> f64) -> f64 {
    let length = (to - from) / parts as f64;
    (0..parts).map(|part| unit_interval(|x| f(from + length * (part as f64 + x)))).sum::<f64>() * length
}

#[cfg(test)]
mod tests {
    use super::unit_interval;

    #[test]
    fn exact_for_polynomials_up_to_degree_23() {
        for degree in 0..24 {
            let found = unit_interval(|x| x.powi(degree));
            assert!((found * f64::from(degree + 1) - 1.0).abs() < 1e-14, "x^{degree}: {found}");
        }
    }
}
