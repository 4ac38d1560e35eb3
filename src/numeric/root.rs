//! The root of a function in a bracket.

/// A place with the value of a function and its slope there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Where.
    pub at: f64,
    /// f.
    pub value: f64,
    /// f'.
    pub slope: f64,
}

/// The root of a function between two places where its sign differs, to the last digits. For functions that cost much:
/// each look is at the root of the cubic through values and slopes of the places on both sides, three or four where the
/// function is smooth.
#[must_use]
pub fn between_known(mut from: Known, mut to: Known, mut f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    const LOOKS: usize = 12;
    let mut last = f64::NAN;
    for _ in 0..LOOKS {
        let at = root_of_cubic(&from, &to);
        if at <= from.at || at >= to.at || (at - last).abs() <= 2.0 * f64::EPSILON * at.abs() {
            return at.clamp(from.at, to.at);
        }
        let (value, slope) = f(at);
        if value == 0.0 {
            return at;
        }
        let end = if (value > 0.0) == (from.value > 0.0) { &mut from } else { &mut to };
        *end = Known { at, value, slope };
        last = at;
    }
    between(from.at, to.at, |at| f(at).0)
}

fn root_of_cubic(from: &Known, to: &Known) -> f64 {
    from.at + (to.at - from.at) * between(0.0, 1.0, |part| cubic(from, to, part))
}

/// Hermite's cubic through values and slopes at two places, a part of the way from one to the other.
#[must_use]
pub fn cubic(from: &Known, to: &Known, part: f64) -> f64 {
    let (length, rest) = (to.at - from.at, 1.0 - part);
    let (rise, fall) = (from.slope * length, to.slope * length);
    let near_start = (1.0 + 2.0 * part) * from.value + part * rise;
    let near_end = (1.0 + 2.0 * rest) * to.value - rest * fall;
    rest * rest * near_start + part * part * near_end
}

/// The slope of the same.
#[must_use]
pub fn cubic_slope(from: &Known, to: &Known, part: f64) -> f64 {
    let (mean, rest) = ((to.value - from.value) / (to.at - from.at), 1.0 - part);
    6.0 * part * rest * mean + rest * (1.0 - 3.0 * part) * from.slope + part * (3.0 * part - 2.0) * to.slope
}

/// The root of `f` between `from` and `to`, where it changes its sign, by Brent's method, to the last digits.
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
            .filter(|bold| 2.0 * bold.abs() < (3.0 * half.abs() - least).min(before.abs()) && bold * half > 0.0);
        (before, step) = bold.map_or((half, half), |bold| (step, bold));
        (other, at_other) = (best, at_best);
        best += if step.abs() > least { step } else { least.copysign(half) };
        at_best = f(best);
    }
    best
}

/// The step of inverse quadratic interpolation, or of the secant where two of the points are one.
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

#[cfg(test)]
mod tests {
    use super::{Known, between, between_known, cubic, cubic_slope};

    #[test]
    fn roots_are_found_to_the_last_digits_in_few_steps() {
        type Case = (f64, f64, fn(f64) -> f64, f64);
        let cases: [Case; 5] = [
            (0.0, 2.0, |x| x * x - 2.0, 2f64.sqrt()),
            (-1.0, 4.0, |x| x.tanh(), 0.0),
            (0.0, 3.0, |x| x.cos(), std::f64::consts::FRAC_PI_2),
            (1e-12, 1.0, |x| x.ln() + 20.0, (-20f64).exp()),
            (0.0, 1.0, |x| if x < 0.3 { -1.0 } else { 1e-3 * (x - 0.3) + 1e-9 }, 0.3),
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
    fn known_slopes_leave_few_looks() {
        type Case = (f64, fn(f64) -> (f64, f64), f64, usize);
        let cases: [Case; 4] = [
            (2.0, |x| (x * x - 2.0, 2.0 * x), 2f64.sqrt(), 5),
            (3.0, |x| (x.cos(), -x.sin()), std::f64::consts::FRAC_PI_2, 5),
            (0.3, |x| (1e-9 - x * (1.0 + x), -1.0 - 2.0 * x), 1e-9 - 1e-18, 5),
            (1.0, |x| if x < 0.3 { (-1.0, 0.0) } else { (x - 0.3 + 1e-9, 1.0) }, 0.3, 90),
        ];
        for (to, f, root, most) in cases {
            let mut looks = 0;
            let known = |at: f64| Known { at, value: f(at).0, slope: f(at).1 };
            let found = between_known(known(0.0), known(to), |x| {
                looks += 1;
                f(x)
            });
            assert!((found - root).abs() <= 4e-15 * root.abs(), "{found} for {root}");
            assert!(looks <= most, "{looks} for {root}");
        }
    }

    #[test]
    fn a_cubic_is_its_own_cubic() {
        let known = |at: f64| Known { at, value: at * at * at - 2.0 * at, slope: 3.0 * at * at - 2.0 };
        let (from, to) = (known(-1.0), known(3.0));
        for step in 0..=8 {
            let part = f64::from(step) / 8.0;
            let there = known(-1.0 + 4.0 * part);
            let slope = cubic_slope(&from, &to, part);
            assert!((cubic(&from, &to, part) - there.value).abs() < 1e-13 && (slope - there.slope).abs() < 1e-13, "{part}");
        }
    }

    #[test]
    fn a_root_at_an_end_is_found() {
        assert!(between(0.0, 1.0, |x| x).abs() < f64::EPSILON);
        assert!((between(0.0, 1.0, |x| x - 1.0) - 1.0).abs() < f64::EPSILON);
    }
}
