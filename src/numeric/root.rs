//! Root of a function in a bracket, and the end of the range where a condition holds.

/// The root of `f` between `from` and `to`, where `f` changes its sign, by Brent's method to full
/// f64 precision.
///
/// # Source
/// Brent 1973, "Algorithms for Minimization without Derivatives", chapter 4.
#[must_use]
pub fn between(from: f64, to: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    const STEPS: usize = 200;
    let (mut best, mut other) = (to, from);
    let (mut at_best, mut at_other) = (f(best), f(other));
    let (mut opposite, mut at_opposite) = (other, at_other);
    let mut step = best - other;
    let mut before = step;
    for _ in 0..STEPS {
        if (at_best > 0.0) == (at_opposite > 0.0) {
            (opposite, at_opposite) = (other, at_other);
            step = best - other;
            before = step;
        }
        if at_opposite.abs() < at_best.abs() {
            (other, best, opposite) = (best, opposite, best);
            (at_other, at_best, at_opposite) = (at_best, at_opposite, at_best);
        }
        let half = 0.5 * (opposite - best);
        let least = 2.0 * f64::EPSILON * best.abs() + f64::MIN_POSITIVE;
        if half.abs() <= least || at_best == 0.0 {
            break;
        }
        let bold = (before.abs() >= least && at_other.abs() > at_best.abs())
            .then(|| bold_step((best, at_best), (other, at_other), (opposite, at_opposite)))
            .filter(|bold| {
                2.0 * bold.abs() < (3.0 * half.abs() - least).min(before.abs()) && bold * half > 0.0
            });
        (before, step) = bold.map_or((half, half), |bold| (step, bold));
        (other, at_other) = (best, at_best);
        best += if step.abs() > least { step } else { least.copysign(half) };
        at_best = f(best);
    }
    best
}

/// The step of inverse quadratic interpolation, or of the secant if two of the points coincide.
fn bold_step(best: (f64, f64), other: (f64, f64), opposite: (f64, f64)) -> f64 {
    let s = best.1 / other.1;
    let is_secant = other.0.to_bits() == opposite.0.to_bits();
    if is_secant {
        return -(opposite.0 - best.0) * s / (1.0 - s);
    }
    let (q, r) = (other.1 / opposite.1, best.1 / opposite.1);
    let p = s * ((opposite.0 - best.0) * q * (q - r) - (best.0 - other.0) * (r - 1.0));
    -p / ((q - 1.0) * (r - 1.0) * (s - 1.0))
}

/// The greatest value at which the condition holds, by bisection. The condition holds at `from` and
/// changes at most once up to `to`.
#[must_use]
pub fn last_where(from: f64, to: f64, holds: impl Fn(f64) -> bool) -> f64 {
    const HALVINGS: usize = 54;
    if holds(to) {
        return to;
    }
    let (mut low, mut high) = (from, to);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::between;

    #[test]
    fn roots_are_found_to_the_last_digits_in_few_steps() {
        type Case = (f64, f64, fn(f64) -> f64, f64);
        let cases: [Case; 5] = [
            (0.0, 2.0, |x| x * x - 2.0, 2f64.sqrt()),
            (-1.0, 4.0, |x| x.tanh(), 0.0),
            (0.0, 3.0, |x| x.cos(), std::f64::consts::FRAC_PI_2),
            (1e-12, 1.0, |x| x.ln() + 20.0, (-20f64).exp()),
            (
                0.0,
                1.0,
                |x| {
                    if x < 0.3 { -1.0 } else { 1e-3 * (x - 0.3) + 1e-9 }
                },
                0.3,
            ),
        ];
        for (from, to, f, root) in cases {
            let mut calls = 0;
            let found = between(from, to, |x| {
                calls += 1;
                f(x)
            });
            assert!((found - root).abs() <= 4e-15 * root.abs(), "{found} for {root}");
            assert!(calls < 90, "{calls} for {root}");
        }
    }

    #[test]
    fn a_root_at_an_end_is_found() {
        assert!(between(0.0, 1.0, |x| x).abs() < f64::EPSILON);
        assert!((between(0.0, 1.0, |x| x - 1.0) - 1.0).abs() < f64::EPSILON);
    }
}
