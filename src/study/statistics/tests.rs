//! Tests of the figures of a sample.

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
            let [below, above] = places.ranks.map(|rank| sorted[rank]);
            let value = below + places.part * (above - below);
            assert_eq!(found.value.to_bits(), value.to_bits());
            let ends = places.interval.map(|ends| ends.map(|rank| sorted[rank]));
            assert_eq!(found.interval, ends.map(|[from, to]| (from, to)));
        }
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
