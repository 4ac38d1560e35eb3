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

/// The figures of values, of which those that a percentile needs are put in their places in order.
/// `None` without values.
///
/// A percentile is interpolated between two values (type 7 of Hyndman & Fan 1996). Its interval
/// ends at values whose ranks enclose it with 95 % by the normal approximation of the binomial
/// distribution, whatever the distribution of the values.
#[must_use]
pub fn figures(values: &mut [f64], bins: usize) -> Option<Figures> {
    let least = values.iter().copied().min_by(f64::total_cmp)?;
    let most = values.iter().copied().max_by(f64::total_cmp)?;
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares = values
        .iter()
        .map(|value| (value - mean).powi(2))
        .sum::<f64>();
    let deviation = (squares / (count - 1.0).max(1.0)).sqrt();
    let error = NORMAL_95 * deviation / count.sqrt();
    let places = PERCENTILES.map(|percent| Places::of(percent / 100.0, values.len()));
    let mut ranks: Vec<usize> = places.iter().flat_map(|places| places.ranks).collect();
    ranks.sort_unstable();
    ranks.dedup();
    put_in_order(values, 0, &ranks);
    Some(Figures {
        count: values.len(),
        mean: Estimate {
            value: mean,
            from: mean - error,
            to: mean + error,
        },
        deviation,
        percentiles: places.map(|places| places.percentile(values)),
        range: (least, most),
        histogram: histogram(values, (least, most), bins),
    })
}

/// The places of a percentile among values in order.
struct Places {
    /// Of the values below and above the percentile, and of the ends of its interval.
    ranks: [usize; 4],
    /// The part of the way from the value below to the one above.
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

    fn percentile(&self, values: &[f64]) -> Estimate {
        let [below, above, from, to] = self.ranks.map(|rank| values[rank]);
        Estimate {
            value: below + self.part * (above - below),
            from,
            to,
        }
    }
}

/// Puts the values of these ranks, which are in order, in their places; `first` is the rank of the
/// first value. Sorting all values would take several times as long.
fn put_in_order(values: &mut [f64], first: usize, ranks: &[usize]) {
    let (low, rest) = ranks.split_at(ranks.len() / 2);
    let Some((&middle, high)) = rest.split_first() else {
        return;
    };
    let (below, _, above) = values.select_nth_unstable_by(middle - first, f64::total_cmp);
    put_in_order(below, first, low);
    put_in_order(above, middle + 1, high);
}

fn histogram(values: &[f64], (least, most): (f64, f64), bins: usize) -> Vec<usize> {
    let bins = if least < most { bins } else { 1 };
    let mut counts = vec![0; bins];
    let width = (most - least) / bins as f64;
    for value in values {
        let bin = ((value - least) / width) as usize;
        counts[bin.min(bins - 1)] += 1;
    }
    counts
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
        let mut values: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        let found = figures(&mut values, 10).unwrap();
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
    fn equal_values_and_a_single_one_have_figures_without_nan() {
        for mut values in [vec![3.0], vec![3.0; 7]] {
            let found = figures(&mut values, 10).unwrap();
            assert_eq!(found.histogram.len(), 1);
            assert!(found.deviation.abs() < f64::MIN_POSITIVE);
            assert!(found.mean.from.is_finite() && found.percentiles[0].to.is_finite());
        }
        assert_eq!(figures(&mut [], 10), None);
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
