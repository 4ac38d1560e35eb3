//! Root of a function in a bracket, the end of the range where a condition holds, and the greatest
//! value of a function, by samples and a search between them.

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

/// Values that differ by this part of them are equal.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// The range that contains the greatest value, and the best samples of it.
#[derive(Debug, Clone, Copy)]
struct Bracket {
    from: f64,
    to: f64,
    best: Sample,
    second: Sample,
    third: Sample,
    /// No value in the range is greater.
    limit: f64,
}

impl Bracket {
    /// Narrows the range by a new sample.
    fn add(&mut self, new: Sample) {
        let is_later = new.0 >= self.best.0;
        if new.1 > self.best.1 {
            *(if is_later { &mut self.from } else { &mut self.to }) = self.best.0;
            (self.best, self.second, self.third) = (new, self.best, self.second);
            return;
        }
        *(if is_later { &mut self.to } else { &mut self.from }) = new.0;
        if new.1 > self.second.1 {
            (self.second, self.third) = (new, self.second);
        } else if new.1 > self.third.1 {
            self.third = new;
        }
    }

    fn width(&self) -> f64 {
        self.to - self.from
    }

    /// Whether the best samples have the same value.
    fn is_flat(&self) -> bool {
        self.best.1 - self.third.1 <= ROUNDING * self.best.1.abs()
    }

    /// The peak in the range. The search ends early if the peak is below `least_value`.
    fn peak(
        mut self,
        least_value: f64,
        (least, flat): (f64, f64),
        at: &impl Fn(f64) -> f64,
    ) -> Sample {
        const STEPS: usize = 60;
        /// Of the rise of a parabola.
        const SAFETY: f64 = 4.0;
        let least = least * self.width();
        if self.is_at_best(flat, at) {
            return self.best;
        }
        let (mut step, mut earlier) = (self.width(), self.width());
        let mut was_flat = false;
        for _ in 0..STEPS {
            if self.width() <= 4.0 * least || self.is_flat() {
                break;
            }
            let top = self.top();
            let rise = top.map_or(f64::INFINITY, |(_, rise)| SAFETY * rise);
            // The parabola may hide a bend: the next one must be as flat.
            let is_flat = rise < flat * self.best.1.abs();
            if self.best.1 + self.most_rise() < least_value || is_flat && was_flat {
                break;
            }
            was_flat = is_flat;
            let next = top.map(|(step, _)| step);
            let next = next.filter(|next| next.abs() < 0.5 * earlier.abs());
            let next = next.unwrap_or_else(|| {
                step = 0.5 * self.width();
                self.golden_step()
            });
            (earlier, step) = (step, next);
            let length = next.abs().max(least);
            let place = self.best.0 + length.copysign(next);
            self.add((place, at(place)));
        }
        self.best
    }

    /// Whether the best sample is the peak itself: an end of the range, or a bend. Narrows the
    /// range. Values that differ by less than a tenth of their tolerance do not decide.
    fn is_at_best(&mut self, flat: f64, at: &impl Fn(f64) -> f64) -> bool {
        /// Of the way to the ends of the range. Farther away first, where errors of values count less.
        const NEAR: [f64; 3] = [1e-2, 1e-5, 1e-5];
        let (peak, noise) = (self.best.0, 0.1 * flat * self.best.1.abs());
        for near in &NEAR[usize::from(flat <= 0.0)..] {
            for end in [self.from, self.to] {
                let place = peak + near * (end - peak);
                if place.to_bits() != peak.to_bits() {
                    let value = at(place);
                    if (value - self.best.1).abs() < noise {
                        return false;
                    }
                    self.add((place, value));
                }
                if self.best.0.to_bits() != peak.to_bits() {
                    return false;
                }
            }
        }
        true
    }

    /// Slope and bend at the best sample, of the parabola through the three samples.
    fn parabola(&self) -> [f64; 2] {
        let [one, other] = [self.second, self.third]
            .map(|sample| (sample.0 - self.best.0, sample.1 - self.best.1));
        let slopes = [one.1 / one.0, other.1 / other.0];
        let bend = (slopes[0] - slopes[1]) / (one.0 - other.0);
        [slopes[0] - bend * one.0, bend]
    }

    /// Rise above the best sample at the most: along the slope, and that of two lines that meet in the
    /// range, by the second difference.
    fn most_rise(&self) -> f64 {
        let way = (self.best.0 - self.from).max(self.to - self.best.0);
        let [slope, bend] = self.parabola();
        // Equal samples have no parabola.
        let rise = (slope.abs() + 2.0 * bend.abs() * way) * way;
        if rise.is_finite() { rise } else { f64::INFINITY }
    }

    /// Step from the best sample to the top of the parabola through the three samples, and the rise
    /// to it. `None` if the top is outside of the range.
    fn top(&self) -> Option<(f64, f64)> {
        let [slope, bend] = self.parabola();
        let step = -0.5 * slope / bend;
        let place = self.best.0 + step;
        (place > self.from && place < self.to).then_some((step, 0.5 * slope * step))
    }

    /// Step of the golden section into the longer side.
    fn golden_step(&self) -> f64 {
        const GOLDEN: f64 = 0.381_966_011_250_105_1;
        let (before, after) = (self.from - self.best.0, self.to - self.best.0);
        GOLDEN * if after > -before { after } else { before }
    }
}

/// Tolerance of the place of a peak, relative to the distance of the samples.
const LEAST: f64 = 1e-13;

/// The greatest value and its place. `known` samples the function in the order of the places, so
/// densely that it has only one peak between neighbours. A peak may be at an end, and may have a
/// bend. At a jump, `known` has a sample of both sides at the same place.
///
/// # Source
/// Parabolas and golden section: Brent 1973, "Algorithms for Minimization without Derivatives",
/// chapter 5.
pub fn greatest(known: &[Sample], at: impl Fn(f64) -> f64) -> Sample {
    greatest_within(known, (LEAST, 0.0), at)
}

/// [`greatest`] with a place to the first tolerance, relative to the distance of the samples, or a
/// value to the second, relative to itself, by the rise of the parabola.
pub fn greatest_within(
    known: &[Sample],
    (least, flat): (f64, f64),
    at: impl Fn(f64) -> f64,
) -> Sample {
    /// Tops that differ by less, relative to the greatest, are searched in the order of their places:
    /// rounding does not choose among the equal tops of a periodic function.
    const EQUAL: f64 = 1e-9;
    let mut tops: Vec<Bracket> = brackets(known).collect();
    let size = tops.iter().map(|top| top.best.1.abs()).fold(0.0, f64::max);
    let rank = |top: &Bracket| (top.best.1 / (EQUAL * size)).round();
    tops.sort_by(|one, other| rank(other).total_cmp(&rank(one)));
    let mut best = tops.first().map_or((0.0, f64::NEG_INFINITY), |top| top.best);
    for bracket in tops {
        if bracket.limit > best.1 + ROUNDING * best.1.abs() {
            let top = bracket.peak(best.1, (least, flat), &at);
            if top.1 > best.1 {
                best = top;
            }
        }
    }
    best
}

/// The ranges between the neighbours of each sample that is not below them. Two samples at the same
/// place are the ends of two smooth parts.
fn brackets(known: &[Sample]) -> impl Iterator<Item = Bracket> {
    known
        .chunk_by(|one, other| one.0.to_bits() != other.0.to_bits())
        .flat_map(|part| (0..part.len()).filter_map(|index| bracket(part, index)))
}

/// The range about a sample of a smooth part. `None` if a neighbour is above it.
fn bracket(part: &[Sample], index: usize) -> Option<Bracket> {
    /// Of a second difference. Above its best sample a parabola rises by at most an eighth of it, two lines
    /// that meet between samples by less than the whole.
    const RISE: f64 = 1.0;
    let best = part[index];
    let before = index.checked_sub(1).map_or(best, |before| part[before]);
    let after = part.get(index + 1).copied().unwrap_or(best);
    let (second, third) = if before.1 > after.1 { (before, after) } else { (after, before) };
    let middle = index.clamp(1, part.len().saturating_sub(2).max(1));
    let bend = part.get(middle - 1..=middle + 1);
    let bend = bend.map_or(f64::INFINITY, |part| part[0].1 - 2.0 * part[1].1 + part[2].1);
    (second.1 <= best.1).then_some(Bracket {
        from: before.0,
        to: after.0,
        best,
        second,
        third,
        limit: best.1 + RISE * bend.abs(),
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

    #[test]
    fn a_peak_between_two_lines_is_found_beside_a_higher_sample() {
        let f = |x: f64| (1.0 - 8.0 * (x - 0.34).abs()).max(0.95 - 4.0 * (x - 0.7).powi(2));
        let ((place, value), _) = peak_of(10, f);
        assert!((place - 0.34).abs() < 1e-9 && value > 1.0 - 1e-8, "{value} at {place}");
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
            assert!(calls <= 20, "{shift}: {calls} calls");
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
            assert!(calls <= 64, "{bend}: {calls} calls");
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
