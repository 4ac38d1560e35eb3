//! Root of a function in a bracket, the end of the range where a condition holds, and the greatest
//! value of a function, by samples and a search between them.

use std::mem::replace;

/// The root of `f` between `from` and `to`, where `f` changes its sign, by Brent's method to full
/// f64 precision.
///
/// # Source
/// Brent 1973, "Algorithms for Minimization without Derivatives", chapter 4.
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
pub fn last_where(from: f64, to: f64, holds: impl Fn(f64) -> bool) -> f64 {
    const HALVINGS: usize = 60;
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

/// A place and the value of the function there.
type Sample = (f64, f64);

/// Relative error of values that are computed without an iteration.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The range about the best of some samples. The function is concave there, so that it is nowhere
/// above the continuation of a chord; elsewhere the chord of the other side is the bound.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    best: Sample,
    /// The samples before and after the best one, and those beyond them. At an end a sample stands for
    /// the missing one.
    beside: [Sample; 2],
    beyond: [Sample; 2],
}

impl Bracket {
    /// The range about a sample of a smooth part. `None` if a neighbour is above it.
    fn of(part: &[Sample], index: usize) -> Option<Bracket> {
        let (best, last) = (part[index], part.len() - 1);
        let [beside, beyond] =
            [1, 2].map(|by| [part[index.saturating_sub(by)], part[last.min(index + by)]]);
        let is_top = beside[0].1.max(beside[1].1) <= best.1;
        is_top.then_some(Bracket { best, beside, beyond })
    }

    /// Narrows the range by a new sample.
    fn add(&mut self, new: Sample) {
        let side = usize::from(new.0 >= self.best.0);
        let (side, beside) = if new.1 > self.best.1 {
            (1 - side, replace(&mut self.best, new))
        } else {
            (side, new)
        };
        self.beyond[side] = replace(&mut self.beside[side], beside);
    }

    fn width(&self) -> f64 {
        self.beside[1].0 - self.beside[0].0
    }

    /// How far the function can rise above the best sample before or after it, and where: at the
    /// crossing of the chord of the other side and that beyond the next sample.
    fn bound(&self, side: usize, error: f64) -> (f64, f64) {
        let fall = |from: Sample, to: Sample| (from.1 - to.1) / (to.0 - from.0).abs();
        let (best, beside, opposite) = (self.best, self.beside[side], self.beside[1 - side]);
        let way = beside.0 - best.0;
        if way == 0.0 {
            return (0.0, 0.0);
        }
        let is_end = opposite.0.to_bits() == best.0.to_bits();
        let slope = fall(best, if is_end { beside } else { opposite });
        let beyond = fall(beside, self.beyond[side]);
        let over = beside.1 + beyond * way.abs() - best.1;
        if over.is_nan() || over < -error {
            let middle = if is_end { 0.0 } else { 0.5 * way };
            return (slope * way.abs(), middle);
        }
        if is_end || over <= 0.0 {
            return (over, 0.0);
        }
        let at = (over / (slope + beyond)).min(way.abs());
        (slope * at, at.copysign(way))
    }

    /// The peak in the range, to a part of its value. Ends early if the peak is not above the `least`
    /// value.
    fn peak(mut self, least: f64, tolerance: f64, at: &impl Fn(f64) -> f64) -> Sample {
        const STEPS: usize = 60;
        /// Of the tolerance: the narrowest range over the first one.
        const NARROWEST: f64 = 40.0;
        /// Of the way on which a parabola falls by the error.
        const CLOSE: f64 = 0.125;
        let narrowest = NARROWEST * tolerance * self.width();
        let (mut step, mut earlier) = (self.width(), self.width());
        for _ in 0..STEPS {
            let error = tolerance * self.best.1.abs();
            let bounds = [0, 1].map(|side| self.bound(side, error));
            let side = usize::from(bounds[1].0 >= bounds[0].0);
            let (rise, place) = bounds[side];
            if self.best.1 + rise <= self.best.1.max(least) + error || self.width() <= narrowest {
                break;
            }
            let top = self.top().filter(|(top, rise)| {
                *rise <= bounds[usize::from(*top > 0.0)].0 && top.abs() < 0.5 * earlier.abs()
            });
            (earlier, step) = (step, top.map_or(place, |(top, _)| top));
            let close = (CLOSE * self.flat(error)).max(0.25 * narrowest);
            let way = self.beside[side].0 - self.best.0;
            let beside = close.min(0.5 * way.abs()).copysign(way);
            let place = self.best.0 + if step.abs() < close { beside } else { step };
            if place.to_bits() == self.best.0.to_bits() {
                break;
            }
            self.add((place, at(place)));
        }
        self.best
    }

    /// The way from the top on which a parabola through the samples falls by the error.
    fn flat(&self, error: f64) -> f64 {
        let slopes = self.beside.map(|(place, value)| {
            let way = (place - self.best.0).abs();
            if way > 0.0 { (self.best.1 - value) / way } else { 0.0 }
        });
        (error * self.width() / (slopes[0] + slopes[1])).sqrt()
    }

    /// Step from the best sample to the top of the parabola through the three best ones, and the rise
    /// to it. `None` if the top is outside of the range.
    fn top(&self) -> Option<(f64, f64)> {
        let ([before, after], [first, last]) = (self.beside, self.beyond);
        let mut others = [before, after, first, last];
        others.sort_by(|one, other| other.1.total_cmp(&one.1));
        let second = others[0];
        let third = *others.iter().find(|other| other.0.to_bits() != second.0.to_bits())?;
        let [one, other] =
            [second, third].map(|sample| (sample.0 - self.best.0, sample.1 - self.best.1));
        let slopes = [one.1 / one.0, other.1 / other.0];
        let bend = (slopes[0] - slopes[1]) / (one.0 - other.0);
        let slope = slopes[0] - bend * one.0;
        let step = -0.5 * slope / bend;
        let place = self.best.0 + step;
        (place > before.0 && place < after.0).then_some((step, 0.5 * slope * step))
    }
}

/// The greatest value and its place. `known` samples the function in the order of the places, so
/// densely that it has only one peak between neighbours. A peak may be at an end, and may have a
/// bend. At a jump, `known` has a sample of both sides at the same place.
///
/// # Source
/// Parabolas: Brent 1973, "Algorithms for Minimization without Derivatives", chapter 5. Bounds of a
/// concave function, with chords in place of tangents: Rote 1992, "The convergence rate of the sandwich
/// algorithm for approximating convex functions".
pub fn greatest(known: &[Sample], at: impl Fn(f64) -> f64) -> Sample {
    greatest_within(known, ROUNDING, at)
}

/// [`greatest`] of values with this relative error. Equal tops are searched in the order of their
/// places, so that errors do not choose among those of a periodic function.
pub fn greatest_within(known: &[Sample], tolerance: f64, at: impl Fn(f64) -> f64) -> Sample {
    let parts = known.chunk_by(|one, other| one.0.to_bits() != other.0.to_bits());
    let tops = parts.flat_map(|part| (0..part.len()).filter_map(|at| Bracket::of(part, at)));
    let mut tops: Vec<Bracket> = tops.collect();
    let size = tops.iter().map(|top| top.best.1.abs()).fold(0.0, f64::max);
    let rank = |top: &Bracket| (top.best.1 / (tolerance * size)).round();
    tops.sort_by(|one, other| rank(other).total_cmp(&rank(one)));
    let first = tops.first().map_or((0.0, f64::NEG_INFINITY), |top| top.best);
    tops.into_iter().fold(first, |best, top| {
        let top = top.peak(best.1, tolerance, &at);
        if top.1 > best.1 { top } else { best }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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

    /// The greatest value of `f` from 0 to 1 and the number of calls, from a few samples.
    fn peak_of(samples: u32, f: impl Fn(f64) -> f64) -> ((f64, f64), usize) {
        let places = (0..=samples).map(|step| f64::from(step) / f64::from(samples));
        let known: Vec<_> = places.map(|x| (x, f(x))).collect();
        let calls = std::cell::Cell::new(0);
        let counted = |x: f64| {
            calls.set(calls.get() + 1);
            f(x)
        };
        (greatest(&known, counted), calls.get())
    }

    #[test]
    fn smooth_peaks_are_found_to_the_last_digits_in_few_steps() {
        for shift in [0.11, 0.3, 0.5, 0.71, 0.999] {
            let f = |x: f64| 3.0 + (2.0 * (x - shift)).cos() + 0.1 * (x - shift).powi(3);
            let ((place, value), calls) = peak_of(6, f);
            assert!((value - 4.0).abs() <= 4e-15, "{shift}: {value}");
            assert!((place - shift).abs() < 1e-6, "{shift}: {place}");
            assert!(calls <= 12, "{shift}: {calls} calls");
        }
    }

    #[test]
    fn a_peak_at_an_end_or_at_a_sample_is_found_in_few_steps() {
        let ends: [fn(f64) -> f64; 3] = [|x| 2.0 + x, |x| (-x).exp(), |x| 2.0 - (x - 0.5).abs()];
        for f in ends {
            let ((_, value), calls) = peak_of(8, f);
            let most = [0.0, 0.5, 1.0].map(f).into_iter().fold(0.0, f64::max);
            assert_eq!(value.to_bits(), most.to_bits());
            assert!(calls <= 12, "{calls} calls");
        }
    }

    #[test]
    fn a_bend_between_samples_is_found() {
        for bend in [0.13, 0.4, 0.81] {
            let f = |x: f64| {
                if x < bend { 1.0 + x } else { 1.0 + bend - 3.0 * (x - bend) }
            };
            let ((place, value), calls) = peak_of(8, f);
            assert!((value - 1.0 - bend).abs() < 1e-11, "{bend}: {value}");
            assert!((place - bend).abs() < 1e-11, "{bend}: {place}");
            assert!(calls <= 12, "{bend}: {calls} calls");
        }
    }

    #[test]
    fn a_peak_whose_samples_are_not_the_greatest_is_found() {
        // The narrow peak at 0.45 is higher than the wide one, its nearest samples are lower.
        let peak = |x: f64, top: f64, place: f64, width: f64| top - ((x - place) / width).powi(2);
        let f = |x: f64| peak(x, 1.0, 0.8, 1.0).max(peak(x, 1.05, 0.45, 0.2));
        let ((place, value), _) = peak_of(10, f);
        assert!((place - 0.45).abs() < 1e-7, "{place}");
        assert!((value - 1.05).abs() < 1e-14, "{value}");
    }

    #[test]
    fn both_sides_of_a_jump_are_searched() {
        let side = |x: f64, is_left: bool| {
            if is_left { 2.0 + x } else { 2.6 - 40.0 * (x - 0.53).powi(2) }
        };
        let f = |x: f64| side(x, x <= 0.5);
        let mut known: Vec<_> =
            (0..=10).map(|step| f64::from(step) / 10.0).map(|x| (x, f(x))).collect();
        known.insert(6, (0.5, side(0.5, false)));
        let (place, value) = greatest(&known, f);
        assert!((place - 0.53).abs() < 1e-7, "{place}");
        assert!((value - 2.6).abs() < 1e-14, "{value}");
        known[5].1 = 3.0;
        assert_eq!(greatest(&known, f), (0.5, 3.0));
    }

    #[test]
    fn a_constant_function_needs_no_search() {
        let ((_, value), calls) = peak_of(4, |_| 2.0);
        assert_eq!((value, calls <= 4), (2.0, true));
    }
}
