//! Figures of a sample: percentiles, mean, probabilities with 95 % intervals, a histogram.

#[cfg(test)]
mod tests;

use statrs::distribution::{Binomial, ContinuousCDF, Discrete, StudentsT};

/// Confidence of every interval.
const CONFIDENCE: f64 = 0.95;

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
    /// Mean.
    pub mean: Figure,
    /// Standard deviation of the values.
    pub deviation: f64,
    /// The [`PERCENTILES`].
    pub percentiles: [Figure; 3],
    /// The least and the greatest value.
    pub range: (f64, f64),
    /// Number of values in bins of equal width over the range.
    pub histogram: Vec<usize>,
}

/// The figures of values; `None` without values.
///
/// A percentile is interpolated between two values (type 7 of Hyndman & Fan 1996). The ends of its
/// interval are the values at two ranks, see [`least_count`]. The interval of the mean is that of
/// Student's t.
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
    let freedom = StudentsT::new(0.0, 1.0, count as f64 - 1.0).ok();
    let half = freedom.map(|freedom| {
        freedom.inverse_cdf(0.5 + 0.5 * CONFIDENCE) * deviation / (count as f64).sqrt()
    });
    let places = PERCENTILES.map(|percent| Places::of(percent / 100.0, count));
    let mut ranks: Vec<usize> = places.iter().flat_map(Places::ranks).collect();
    ranks.sort_unstable();
    ranks.dedup();
    let at_ranks = counted.ordered(values, &ranks);
    Some(Figures {
        count,
        mean: Figure { value: mean, interval: half.map(|half| (mean - half, mean + half)) },
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
#[must_use]
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

/// Ranks for a percentile of sorted values.
struct Places {
    /// Ranks of the values below and above the percentile.
    ranks: [usize; 2],
    /// Ranks of the ends of its interval.
    interval: Option<[usize; 2]>,
    /// Position of the percentile between the value below and the value above, from 0 to 1.
    part: f64,
}

impl Places {
    fn of(part: f64, count: usize) -> Places {
        let rank = part * (count - 1) as f64;
        Places {
            ranks: [rank.floor(), rank.ceil()].map(|rank| rank as usize),
            interval: interval(part, count),
            part: rank - rank.floor(),
        }
    }

    fn ranks(&self) -> impl Iterator<Item = usize> {
        self.ranks.into_iter().chain(self.interval.into_iter().flatten())
    }

    fn percentile(&self, values: &Ordered) -> Figure {
        let [below, above] = self.ranks.map(|rank| values.at(rank));
        let ends = self.interval.map(|ends| ends.map(|rank| values.at(rank)));
        Figure {
            value: below + self.part * (above - below),
            interval: ends.map(|[from, to]| (from, to)),
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
        bins.map(|bin| bin.iter().map(|&count| count as usize).sum()).collect()
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
