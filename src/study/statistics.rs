//! Figures of a sample: percentiles, mean, probabilities with 95 % intervals, a histogram.

/// The 97.5 % quantile of the normal distribution.
pub(super) const NORMAL_95: f64 = 1.959_963_984_540_054;

/// A value and the ends of its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// The lower end.
    pub from: f64,
    /// The upper end.
    pub to: f64,
}

/// The percentiles of a summary, in percent.
pub const PERCENTILES: [f64; 3] = [5.0, 50.0, 95.0];

/// The figures of a quantity over the samples that have a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Figures {
    /// Number of values.
    pub count: usize,
    /// Mean.
    pub mean: Estimate,
    /// Standard deviation of the values.
    pub deviation: f64,
    /// The [`PERCENTILES`].
    pub percentiles: [Estimate; 3],
    /// The least and the greatest value.
    pub range: (f64, f64),
    /// Number of values in bins of equal width over the range.
    pub histogram: Vec<usize>,
}

/// The figures of values; `None` without values.
///
/// A percentile is interpolated between two values (type 7 of Hyndman & Fan 1996). The ends of its
/// interval are the values at two ranks, from the normal approximation of the binomial distribution
/// with 95 %. This is valid for any distribution of the values.
#[must_use]
pub fn figures(values: &[f64], bins: usize) -> Option<Figures> {
    let count = values.len();
    if count == 0 {
        return None;
    }
    let least = lanes(values, f64::INFINITY, f64::min, f64::min);
    let most = lanes(values, f64::NEG_INFINITY, f64::max, f64::max);
    let mean = lanes(values, 0.0, |sum, value| sum + value, |a, b| a + b) / count as f64;
    let square = |value: f64| (value - mean) * (value - mean);
    let squares = lanes(values, 0.0, |sum, value| sum + square(value), |a, b| a + b);
    let counted = Counted::of(values, (least, most), bins);
    let deviation = (squares / (count as f64 - 1.0).max(1.0)).sqrt();
    let error = NORMAL_95 * deviation / (count as f64).sqrt();
    let places = PERCENTILES.map(|percent| Places::of(percent / 100.0, count));
    let mut ranks: Vec<usize> = places.iter().flat_map(|places| places.ranks).collect();
    ranks.sort_unstable();
    ranks.dedup();
    let at_ranks = counted.ordered(values, &ranks);
    Some(Figures {
        count,
        mean: Estimate {
            value: mean,
            from: mean - error,
            to: mean + error,
        },
        deviation,
        percentiles: places.map(|places| places.percentile(&at_ranks)),
        range: (least, most),
        histogram: counted.histogram(),
    })
}

/// Folds the values in four lanes, which the processor computes side by side. The result does not
/// depend on the machine.
fn lanes(
    values: &[f64],
    empty: f64,
    add: impl Fn(f64, f64) -> f64,
    join: impl Fn(f64, f64) -> f64,
) -> f64 {
    let (blocks, rest) = values.as_chunks::<4>();
    let mut lanes = [empty; 4];
    for block in blocks {
        for (lane, &value) in lanes.iter_mut().zip(block) {
            *lane = add(*lane, value);
        }
    }
    for &value in rest {
        lanes[0] = add(lanes[0], value);
    }
    let [a, b, c, d] = lanes;
    join(join(a, b), join(c, d))
}

/// Ranks for a percentile of sorted values.
struct Places {
    /// Ranks of the values below and above the percentile and of the ends of its interval.
    ranks: [usize; 4],
    /// Position of the percentile between the value below and the value above, from 0 to 1.
    part: f64,
}

impl Places {
    fn of(part: f64, count: usize) -> Places {
        let (count, last) = (count as f64, (count - 1) as f64);
        let rank = part * last;
        let margin = NORMAL_95 * (count * part * (1.0 - part)).sqrt();
        let (from, to) = (
            (count * part - margin).floor() - 1.0,
            (count * part + margin).ceil(),
        );
        let ranks = [rank.floor(), rank.ceil(), from, to];
        Places {
            ranks: ranks.map(|rank| rank.clamp(0.0, last) as usize),
            part: rank - rank.floor(),
        }
    }

    fn percentile(&self, values: &Ordered) -> Estimate {
        let [below, above, from, to] = self.ranks.map(|rank| values.at(rank));
        Estimate {
            value: below + self.part * (above - below),
            from,
            to,
        }
    }
}

/// Values counted in many intervals of equal width, of which each bin of the histogram has the same
/// number.
struct Counted {
    least: f64,
    /// Intervals per unit of the values.
    scale: f64,
    /// Number of values in each interval.
    counts: Vec<u32>,
    bins: usize,
}

impl Counted {
    fn of(values: &[f64], (least, most): (f64, f64), bins: usize) -> Counted {
        const INTERVALS: usize = 4096;
        let bins = if least < most { bins } else { 1 };
        let intervals = INTERVALS / bins * bins;
        let mut counted = Counted {
            least,
            scale: intervals as f64 / (most - least),
            counts: vec![0; intervals],
            bins,
        };
        for &value in values {
            let interval = counted.interval(value);
            counted.counts[interval] += 1;
        }
        counted
    }

    /// The interval of a value; 0 if all values are equal, since the product is then NaN.
    fn interval(&self, value: f64) -> usize {
        (((value - self.least) * self.scale) as usize).min(self.counts.len() - 1)
    }

    /// Number of values in each bin.
    fn histogram(&self) -> Vec<usize> {
        let bins = self.counts.chunks(self.counts.len() / self.bins);
        bins.map(|bin| bin.iter().map(|&count| count as usize).sum())
            .collect()
    }

    /// The values at `ranks`, which must be sorted. Only intervals with a requested rank are
    /// sorted: sorting all values would take many times as long.
    fn ordered(&self, values: &[f64], ranks: &[usize]) -> Ordered {
        const OTHER: u8 = u8::MAX;
        let mut parts = Vec::<(usize, Vec<f64>)>::new();
        let mut numbers = vec![OTHER; self.counts.len()];
        let (mut first, mut ranks) = (0, ranks.iter().peekable());
        for (&count, number) in self.counts.iter().zip(&mut numbers) {
            let end = first + count as usize;
            if ranks.next_if(|&&rank| rank < end).is_some() {
                while ranks.next_if(|&&rank| rank < end).is_some() {}
                *number = parts.len() as u8;
                parts.push((first, Vec::with_capacity(count as usize)));
            }
            first = end;
        }
        for &value in values {
            if let Some((_, part)) = parts.get_mut(usize::from(numbers[self.interval(value)])) {
                part.push(value);
            }
        }
        for (_, part) in &mut parts {
            part.sort_unstable_by(f64::total_cmp);
        }
        Ordered { parts }
    }
}

/// The values at some ranks.
struct Ordered {
    /// For each interval with a requested rank: the rank of its first value, and its values in
    /// order.
    parts: Vec<(usize, Vec<f64>)>,
}

impl Ordered {
    /// The value at one of the requested ranks.
    fn at(&self, rank: usize) -> f64 {
        let part = self.parts.partition_point(|(first, _)| *first <= rank);
        let (first, values) = &self.parts[part - 1];
        values[rank - first]
    }
}

/// A probability from the number of events.
///
/// # Source
/// Wilson 1927, J. Am. Stat. Assoc. 22, 209-212: the score interval.
#[must_use]
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_a_known_sample() {
        let found = figures(&(0..=100).rev().map(f64::from).collect::<Vec<_>>(), 10).unwrap();
        let percentiles = found.percentiles.map(|estimate| estimate.value);
        assert!(
            percentiles
                .iter()
                .zip([5.0, 50.0, 95.0])
                .all(|(a, b)| (a - b).abs() < 1e-12)
        );
        assert!((found.mean.value - 50.0).abs() < 1e-12);
        assert!((found.deviation - 29.300_170_647_967_224).abs() < 1e-12);
        assert_eq!(found.range, (0.0, 100.0));
        assert_eq!(found.histogram, [10, 10, 10, 10, 10, 10, 10, 10, 10, 11]);
        let median = found.percentiles[1];
        assert!(median.from < 41.0 && median.from > 38.0 && median.to > 59.0 && median.to < 62.0);
    }

    #[test]
    fn equal_values_and_a_single_value_have_figures_without_nan() {
        for values in [vec![3.0], vec![3.0; 7]] {
            let found = figures(&values, 10).unwrap();
            assert_eq!(found.histogram.len(), 1);
            assert!(found.deviation.abs() < f64::MIN_POSITIVE);
            assert!(found.mean.from.is_finite() && found.percentiles[0].to.is_finite());
        }
        assert_eq!(figures(&[], 10), None);
    }

    #[test]
    fn percentiles_are_those_of_the_sorted_values_whatever_their_distribution() {
        let numbers = || (1..=5000_u32).map(|k| f64::from(k.wrapping_mul(2_654_435_761)));
        let samples: [Vec<f64>; 4] = [
            numbers().collect(),
            // All but a few values are in one interval.
            numbers().map(|x| (x / 2e8).exp()).collect(),
            numbers().map(|x| (x / 1e9).round() - 2.0).collect(),
            vec![-f64::MAX, 0.0, f64::MAX],
        ];
        for values in samples {
            let found = figures(&values, 10).unwrap();
            let mut sorted = values.clone();
            sorted.sort_by(f64::total_cmp);
            let ends = [found.range.0, found.range.1];
            let wanted = [sorted[0], sorted[sorted.len() - 1]];
            assert_eq!(ends.map(f64::to_bits), wanted.map(f64::to_bits));
            for (percent, found) in PERCENTILES.iter().zip(&found.percentiles) {
                let places = Places::of(percent / 100.0, sorted.len());
                let [below, above, from, to] = places.ranks.map(|rank| sorted[rank]);
                let value = below + places.part * (above - below);
                let bits = |estimate: [f64; 3]| estimate.map(f64::to_bits);
                assert_eq!(
                    bits([found.value, found.from, found.to]),
                    bits([value, from, to])
                );
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
        assert!(
            none.from.abs() < 1e-15 && (none.to - 0.036_993_5).abs() < 1e-6,
            "{none:?}"
        );
        assert_eq!(probability(0, 0), None);
    }
}
