//! Figures of a sample: percentiles, mean, probabilities with 95 % intervals, a histogram.

use serde::Serialize;
use statrs::distribution::{Binomial, ContinuousCDF, Discrete, StudentsT};

/// Confidence of every interval.
const CONFIDENCE: f64 = 0.95;

/// The 97.5 % quantile of the normal distribution.
const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A value and the ends of its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
}

/// A figure of a sample and, if the sample is large enough, the ends of its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figure {
    /// The value.
    pub value: f64,
    /// The ends of the interval.
    pub interval: Option<(f64, f64)>,
}

/// The percentiles of a summary, in percent.
pub const PERCENTILES: [f64; 3] = [5.0, 50.0, 95.0];

/// The figures of a quantity over the samples that have a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Number of values.
    pub count: usize,
    /// The [`PERCENTILES`].
    pub percentiles: [Figure; 3],
    /// Mean.
    pub mean: Figure,
    /// Standard deviation of the values.
    pub deviation: f64,
    /// The least and the greatest value.
    pub range: (f64, f64),
    /// Number of values in bins of equal width over the range.
    pub histogram: Vec<usize>,
}

impl Figures {
    /// Whether the values differ by less than the accuracy of the motion.
    pub fn is_constant(&self) -> bool {
        const ACCURACY: f64 = 1e-7;
        let (from, to) = self.range;
        to - from <= ACCURACY * from.abs().max(to.abs())
    }
}

/// The figures of values; `None` without values.
///
/// A percentile is interpolated between two values (type 7 of Hyndman & Fan 1996). The ends of its
/// interval are the values at two ranks, see [`least_count`]. The interval of the mean is that of
/// Student's t.
pub fn figures(values: &[f64], bins: usize) -> Option<Figures> {
    let count = values.len();
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let range = (*sorted.first()?, *sorted.last()?);
    let mean = sum(values, |value| value) / count as f64;
    let squares = sum(values, |value| (value - mean) * (value - mean));
    let deviation = (squares / (count as f64 - 1.0).max(1.0)).sqrt();
    let freedom = StudentsT::new(0.0, 1.0, count as f64 - 1.0).ok();
    let of_mean = freedom.map(|freedom| {
        let quantile = freedom.inverse_cdf(0.5 + 0.5 * CONFIDENCE);
        let half = quantile * deviation / (count as f64).sqrt();
        (mean - half, mean + half)
    });
    let percentile = |percent: f64| {
        let rank = percent / 100.0 * (count - 1) as f64;
        let [below, above] = [rank.floor(), rank.ceil()].map(|rank| sorted[rank as usize]);
        let ends = interval(percent / 100.0, count);
        Figure {
            value: below + (rank - rank.floor()) * (above - below),
            interval: ends.map(|[from, to]| (sorted[from], sorted[to])),
        }
    };
    Some(Figures {
        count,
        percentiles: PERCENTILES.map(percentile),
        mean: Figure { value: mean, interval: of_mean },
        deviation,
        range,
        histogram: histogram(values, range, bins),
    })
}

/// Number of values in each bin; equal values have one bin. Each bin consists of equally many narrow
/// parts, whose borders decide.
fn histogram(values: &[f64], (least, most): (f64, f64), bins: usize) -> Vec<usize> {
    const PARTS: usize = 4096;
    let bins = if least < most { bins } else { 1 };
    let of_bin = PARTS / bins;
    let scale = (of_bin * bins) as f64 / (most - least);
    let mut counts = vec![0; bins];
    for value in values {
        // NaN, the product of 0 and infinity, becomes 0.
        let part = ((value - least) * scale) as usize;
        counts[(part / of_bin).min(bins - 1)] += 1;
    }
    counts
}

/// Sums in four lanes, which the processor computes side by side. The result does not depend on the
/// machine.
fn sum(values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let (blocks, rest) = values.as_chunks::<4>();
    let mut lanes = [0.0; 4];
    for block in blocks {
        for (lane, &value) in lanes.iter_mut().zip(block) {
            *lane += of(value);
        }
    }
    for &value in rest {
        lanes[0] += of(value);
    }
    let [a, b, c, d] = lanes;
    (a + b) + (c + d)
}

/// The least number of values with a 95 % interval of a percentile, in percent.
///
/// # Formula
/// ```text
/// P(x_(r) <= quantile <= x_(s)) >= Σ_{k=r}^{s−1} C(n, k) p^k (1 − p)^(n−k) >= 0.95,   1 <= r < s <= n
/// ```
/// for any distribution of n independent values, x_(r) the value at rank r. The interval has the
/// fewest ranks for which the sum is at least 0.95. Fewer values have no such ranks.
///
/// # Source
/// Hahn & Meeker 1991, "Statistical Intervals", section 5.2.
pub fn least_count(percent: f64) -> usize {
    let mut counts = 2..;
    let has_interval = |count: &usize| interval(percent / 100.0, *count).is_some();
    counts.find(has_interval).unwrap_or(usize::MAX)
}

/// Ranks, from 0, of the ends of the interval of a quantile, see [`least_count`].
fn interval(part: f64, count: usize) -> Option<[usize; 2]> {
    let (n, odds) = (count as f64, part / (1.0 - part));
    if count < 2 {
        return None;
    }
    // The number of values below the quantile, from `low` to `high`.
    let mode = ((n + 1.0) * part).floor().clamp(1.0, n - 1.0);
    let mode_mass = Binomial::new(part, count as u64).ok()?.pmf(mode as u64);
    let (mut low, mut high) = ((mode, mode_mass), (mode, mode_mass));
    let mut covered = mode_mass;
    while covered < CONFIDENCE {
        let less = low.1 * low.0 / ((n - low.0 + 1.0) * odds);
        let more = high.1 * (n - high.0) * odds / (high.0 + 1.0);
        let less = Some(less).filter(|_| low.0 > 1.0);
        let more = Some(more).filter(|_| high.0 < n - 1.0);
        if less > more {
            low = (low.0 - 1.0, less?);
            covered += low.1;
        } else {
            high = (high.0 + 1.0, more?);
            covered += high.1;
        }
    }
    Some([low.0 as usize - 1, high.0 as usize])
}

/// A probability from the number of events.
///
/// # Source
/// Wilson 1927, J. Am. Stat. Assoc. 22, 209-212: the score interval.
pub fn probability(events: usize, samples: usize) -> Option<Estimate> {
    if samples == 0 {
        return None;
    }
    let (count, part) = (samples as f64, events as f64 / samples as f64);
    let square = NORMAL_95 * NORMAL_95;
    let centre = (part + square / (2.0 * count)) / (1.0 + square / count);
    let spread = part * (1.0 - part) / count + square / (4.0 * count * count);
    let half = NORMAL_95 / (1.0 + square / count) * spread.sqrt();
    Some(Estimate {
        value: part,
        from: (centre - half).max(0.0).min(part),
        to: (centre + half).min(1.0).max(part),
    })
}

/// The indices of one field, with 95 % intervals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Indices {
    /// The part of the variance that the field causes on its own.
    pub first_order: Estimate,
    /// The part of the variance that the field causes alone or together with others.
    pub total: Estimate,
}

/// The results of one sample of the ranking.
#[derive(Debug, Clone, PartialEq)]
pub struct Ranked {
    /// Result of the first sample.
    pub first: f64,
    /// Result of the second sample.
    pub second: f64,
    /// Results of the first sample with the value of the second sample in each field.
    pub swapped: Vec<f64>,
}

/// The indices of every field; `None` if the results do not vary.
///
/// # Formula
/// ```text
/// f0 = mean(A, B),   c = mean(A, B, AB_1, AB_2, ..),   V = mean((A - f0)², (B - f0)²)
/// S_i  = mean((B - c)(AB_i - A))/V
/// ST_i = mean((A - AB_i)²)/(2 V)
/// ```
/// where AB_i is the result of A with field i of B. The intervals are ±1.96 standard errors of the
/// quotients (delta method).
///
/// # Source
/// Saltelli et al. 2010, Comput. Phys. Commun. 181, 259-270, Table 2 (b) for S_i and (f) for ST_i
/// (Jansen 1999).
pub fn indices(samples: &[Ranked]) -> Option<Vec<Indices>> {
    let count = samples.len() as f64;
    let mean = samples.iter().map(|s| s.first + s.second).sum::<f64>() / (2.0 * count);
    let variance_of = |s: &Ranked| {
        let (first, second) = (s.first - mean, s.second - mean);
        0.5 * (first * first + second * second)
    };
    let variance = samples.iter().map(variance_of).sum::<f64>() / count;
    let is_varied = variance > (f64::EPSILON * mean).powi(2);
    let fields = samples.first()?.swapped.len();
    let sum = |s: &Ranked| s.first + s.second + s.swapped.iter().sum::<f64>();
    let centre = samples.iter().map(sum).sum::<f64>() / ((fields + 2) as f64 * count);
    let of_field = |field: usize| {
        let first_order = |s: &Ranked| (s.second - centre) * (s.swapped[field] - s.first);
        let total = |s: &Ranked| 0.5 * (s.first - s.swapped[field]).powi(2);
        Indices {
            first_order: quotient(samples, first_order, variance_of),
            total: quotient(samples, total, variance_of),
        }
    };
    is_varied.then(|| (0..fields).map(of_field).collect())
}

/// The quotient of two means and its interval.
fn quotient(
    samples: &[Ranked],
    part: impl Fn(&Ranked) -> f64,
    whole: impl Fn(&Ranked) -> f64,
) -> Estimate {
    let count = samples.len() as f64;
    let (mut parts, mut wholes) = (0.0, 0.0);
    for sample in samples {
        parts += part(sample);
        wholes += whole(sample);
    }
    let value = parts / wholes;
    let squares =
        samples.iter().map(|sample| (part(sample) - value * whole(sample)).powi(2)).sum::<f64>();
    let error = (squares / (count - 1.0).max(1.0) / count).sqrt() * count / wholes;
    Estimate { value, from: value - NORMAL_95 * error, to: value + NORMAL_95 * error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_known_sample() {
        let found = figures(&(0..=100).rev().map(f64::from).collect::<Vec<_>>(), 10).unwrap();
        let percentiles = found.percentiles.map(|estimate| estimate.value);
        assert!(percentiles.iter().zip([5.0, 50.0, 95.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert!((found.mean.value - 50.0).abs() < 1e-12);
        assert!((found.deviation - 29.300_170_647_967_224).abs() < 1e-12);
        assert_eq!(found.range, (0.0, 100.0));
        assert_eq!(found.histogram, [10, 10, 10, 10, 10, 10, 10, 10, 10, 11]);
        // Ranks 41 and 61 of 101 values: scipy.stats.binom(101, 0.5) from 41 to 60 has 0.9537.
        let median = found.percentiles[1];
        assert_eq!(median.interval, Some((40.0, 60.0)));
        // scipy.stats.t.ppf(0.975, 100) = 1.9839715185
        let half = 1.983_971_518_5 * found.deviation / 101f64.sqrt();
        let (from, to) = found.mean.interval.unwrap();
        assert!((0.5 * (to - from) / half - 1.0).abs() < 1e-9);
    }

    #[test]
    fn equal_values_and_a_single_value_have_figures_without_nan() {
        for values in [vec![3.0], vec![3.0; 7]] {
            let found = figures(&values, 10).unwrap();
            assert_eq!(found.histogram.len(), 1);
            assert!(found.deviation.abs() < f64::MIN_POSITIVE);
            let is_single = values.len() == 1;
            assert_eq!(found.mean.interval.is_none(), is_single);
            assert_eq!(found.percentiles[0].interval, None);
        }
        assert_eq!(figures(&[], 10), None);
    }

    #[test]
    fn every_value_is_in_one_bin() {
        let skewed = (1..=5000).map(|at| (f64::from(at) / 220.0).exp()).collect();
        for values in [skewed, vec![-f64::MAX, 0.0, f64::MAX]] {
            let found = figures(&values, 10).unwrap();
            assert_eq!(found.histogram.iter().sum::<usize>(), values.len());
            assert_eq!(found.range, (values[0], values[values.len() - 1]));
        }
    }

    #[test]
    fn the_interval_of_a_percentile_has_at_least_95_percent_and_hardly_more() {
        let covered = |part: f64, count: usize| {
            let [from, to] = interval(part, count)?;
            let binomial = Binomial::new(part, count as u64).unwrap();
            Some((from as u64 + 1..=to as u64).map(|k| binomial.pmf(k)).sum::<f64>())
        };
        assert_eq!(PERCENTILES.map(least_count), [59, 6, 59]);
        for percent in PERCENTILES {
            let part = percent / 100.0;
            let least = least_count(percent);
            assert_eq!(covered(part, least - 1), None);
            for count in (least..400).chain([1000, 20_000]) {
                let found = covered(part, count).unwrap();
                // The mass of one rank is all that an interval can have too much.
                let mode = ((count + 1) as f64 * part).floor() as u64;
                let rank = Binomial::new(part, count as u64).unwrap().pmf(mode);
                assert!((0.95..0.95 + rank).contains(&found), "P{percent} of {count}: {found}");
            }
        }
        // The ranks of the normal approximation differ by few ranks of many.
        let [from, to] = interval(0.05, 100_000_000).unwrap();
        let half = NORMAL_95 * (1e8 * 0.05 * 0.95_f64).sqrt();
        assert!((5e6 - from as f64 - half).abs() < 3.0 && (to as f64 - 5e6 - half).abs() < 3.0);
    }

    #[test]
    fn intervals_hold_the_percentiles_of_random_samples_as_often_as_they_say() {
        use rand_chacha::rand_core::{Rng, SeedableRng};
        const TRIALS: usize = 4000;
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(11);
        for count in [10, 20, 40, 100, 1000] {
            let mut held = [0; 3];
            let mut without = [0; 3];
            for _ in 0..TRIALS {
                // The percentiles of the cubes are the cubes of the percentiles.
                let mut uniform = |_| f64::from(random.next_u32()) / f64::from(u32::MAX);
                let values: Vec<f64> = (0..count).map(|at| uniform(at).powi(3)).collect();
                let found = figures(&values, 1).unwrap();
                for (at, percent) in PERCENTILES.into_iter().enumerate() {
                    match found.percentiles[at].interval {
                        Some((from, to)) => {
                            let exact = (percent / 100.0_f64).powi(3);
                            held[at] += usize::from((from..=to).contains(&exact));
                        }
                        None => without[at] += 1,
                    }
                }
            }
            for (at, percent) in PERCENTILES.into_iter().enumerate() {
                let is_small = count < least_count(percent);
                assert_eq!(without[at], if is_small { TRIALS } else { 0 });
                if !is_small {
                    // Three standard errors of the trials, and the greatest mass of one rank.
                    let part = held[at] as f64 / TRIALS as f64;
                    let error = 3.0 * (0.95 * 0.05 / TRIALS as f64).sqrt();
                    let most = if count < 100 { 0.99 } else { 0.98 };
                    assert!(
                        (0.95 - error..most + error).contains(&part),
                        "P{percent} of {count}: {part}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_probability_has_wilsons_interval() {
        // statsmodels.stats.proportion.proportion_confint(10, 100, method="wilson")
        let found = probability(10, 100).unwrap();
        assert!((found.from - 0.055_229_137).abs() < 1e-8, "{found:?}");
        assert!((found.to - 0.174_365_661).abs() < 1e-8, "{found:?}");
        let none = probability(0, 100).unwrap();
        assert!(none.from.abs() < 1e-15 && (none.to - 0.036_993_5).abs() < 1e-6, "{none:?}");
        assert_eq!(probability(0, 0), None);
    }
}
