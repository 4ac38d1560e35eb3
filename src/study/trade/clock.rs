//! Benchmark of solves on this machine: all solves in rounds, so that a disturbance affects all of
//! them alike.

use std::hint::black_box;
use std::time::{Duration, Instant};

use crate::model::compliance::ElasticGear;
use crate::model::compliance::tooth::field_gear;
use crate::model::inputs::Gear;
use crate::model::{Inputs, Refusal};

/// Time limits of the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience {
    /// In each round a solve repeats for this time, at least once.
    pub batch: Duration,
    /// No new round starts after this time.
    pub most: Duration,
}

impl Patience {
    /// Enough time for a reliable figure.
    pub const STEADY: Patience =
        Patience { batch: Duration::from_micros(300), most: Duration::from_millis(2500) };
    /// A single run, if only the errors matter.
    pub const ONCE: Patience = Patience { batch: Duration::ZERO, most: Duration::ZERO };
}

/// The run time of a solve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// The median of the batches, in s.
    pub seconds: f64,
    /// Half the interquartile range of the batches, in s.
    pub spread: f64,
    /// The 95 % interval of the median, relative to the median; of too few batches, their range.
    pub between: (f64, f64),
    /// Number of measured runs.
    pub runs: u64,
}

/// The batches of a solve.
#[derive(Debug, Clone, Default)]
pub(super) struct Batches {
    /// Seconds per solve of each batch.
    seconds: Vec<f64>,
    runs: u64,
}

impl Batches {
    /// Repeats `once` for the time `batch`, at least once, while it returns true; returns whether
    /// all runs returned true.
    pub(super) fn add(&mut self, batch: Duration, mut once: impl FnMut() -> bool) -> bool {
        let solves = self.seconds.last().map_or(1, |&last| {
            (batch.as_secs_f64() / last.max(1e-9)).ceil().clamp(1.0, 1e6) as u64
        });
        let begin = Instant::now();
        let done = (0..solves).all(|_| once());
        if done {
            // The first run fills the caches: it is dropped once there are other runs.
            if self.runs == 1 {
                self.seconds.clear();
            }
            self.seconds.push(begin.elapsed().as_secs_f64() / solves as f64);
            self.runs += solves;
        }
        done
    }

    /// Whether more batches would hardly change the median.
    pub(super) fn are_steady(&self) -> bool {
        /// Width of the interval of the median, relative to the median.
        const FEW_PERCENT: f64 = 0.03;
        /// With fewer batches the interval is not defined.
        const LEAST: usize = 6;
        let is_narrow = |time: Time| time.between.1 - time.between.0 <= FEW_PERCENT;
        self.seconds.len() >= LEAST && self.time().is_some_and(is_narrow)
    }

    /// The run time from the batches; `None` without batches.
    pub(super) fn time(&self) -> Option<Time> {
        let mut times = self.seconds.clone();
        times.sort_by(f64::total_cmp);
        let last = times.len().checked_sub(1)?;
        let quarter = |part: usize| times[last * part / 4];
        let seconds = quarter(2);
        let aside = outside(times.len());
        let between = (times[aside] / seconds, times[last - aside] / seconds);
        Some(Time { seconds, spread: 0.5 * (quarter(3) - quarter(1)), between, runs: self.runs })
    }
}

impl Time {
    /// Whether the batches cannot show which of two solves is faster.
    #[must_use]
    pub fn ties(&self, other: &Time) -> bool {
        let ends = |time: &Time| (time.seconds * time.between.0, time.seconds * time.between.1);
        let ((from, to), (other_from, other_to)) = (ends(self), ends(other));
        from <= other_to && other_from <= to
    }
}

/// Number of batches on either side of the median's 95 % interval, by order statistics. The number
/// of batches below the median follows a binomial distribution with probability one half, and fewer
/// than this number occur with a probability of 2.5 %.
fn outside(batches: usize) -> usize {
    const CHANCE: f64 = 0.025;
    let mut chance = 0.5f64.powi(i32::try_from(batches).unwrap_or(i32::MAX));
    let (mut aside, mut below) = (0, chance);
    while below <= CHANCE && 2 * aside + 2 < batches {
        aside += 1;
        chance *= (batches + 1 - aside) as f64 / aside as f64;
        below += chance;
    }
    aside.saturating_sub(1)
}

/// Seconds to build the field of each gear; later solves read the cached fields.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Build {
    /// Driver.
    pub driver: f64,
    /// Driven gear.
    pub driven: f64,
}

impl Build {
    /// Builds both fields without the cache, several times if `patience` allows; returns the least
    /// time.
    ///
    /// # Errors
    /// The refusal of a gear without a field.
    pub(super) fn measure(inputs: &Inputs, patience: Patience) -> Result<Build, Refusal> {
        let of = |gear: &Gear| seconds(&ElasticGear::of(inputs, gear), patience);
        Ok(Build { driver: of(&inputs.driver)?, driven: of(&inputs.driven)? })
    }
}

fn seconds(gear: &ElasticGear, patience: Patience) -> Result<f64, Refusal> {
    const REPEATS: usize = 3;
    let repeats = if patience.most == Duration::ZERO { 1 } else { REPEATS };
    let mut least = f64::INFINITY;
    for _ in 0..repeats {
        let begun = Instant::now();
        black_box(field_gear(black_box(gear)).build()?);
        least = least.min(begun.elapsed().as_secs_f64());
    }
    Ok(least)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batches(seconds: &[f64]) -> Batches {
        Batches { seconds: seconds.to_vec(), runs: 100 }
    }

    fn of(seconds: &[f64]) -> Time {
        batches(seconds).time().unwrap()
    }

    #[test]
    fn ranks_of_the_interval_are_those_of_the_tables() {
        // Binomial distribution with probability one half: the 95 % interval of the median of 6, 9,
        // 12, 20, 40 values.
        assert_eq!([1, 5, 6, 8, 9, 12, 20, 40].map(outside), [0, 0, 0, 0, 1, 2, 5, 13]);
    }

    #[test]
    fn quick_solves_are_batched_and_every_run_is_counted() {
        let (mut batches, mut runs) = (Batches::default(), 0u64);
        for _ in 0..7 {
            assert!(batches.add(Duration::from_micros(50), || {
                runs += 1;
                true
            }));
        }
        let time = batches.time().unwrap();
        assert_eq!(time.runs, runs);
        assert!(runs > 7 && batches.seconds.len() == 6, "{runs} runs");
        assert!(time.seconds > 0.0 && time.spread >= 0.0);
    }

    #[test]
    fn a_run_that_stops_ends_it() {
        let mut batches = Batches::default();
        assert!(!batches.add(Duration::ZERO, || false));
        assert_eq!(batches.time(), None);
    }

    #[test]
    fn a_median_is_steady_if_most_batches_agree() {
        let disturbed =
            batches(&[1.0, 1.001, 1.002, 1.0, 1.003, 1.001, 1.002, 1.0, 9.0, 1.001, 5.0, 1.002]);
        assert!(
            disturbed.are_steady() && disturbed.time().unwrap().seconds < 1.01,
            "{disturbed:?}"
        );
        assert!(!batches(&[1.0, 1.3, 1.1, 1.6, 1.2, 1.5, 1.4, 1.0]).are_steady());
        assert!(!batches(&[1.0; 5]).are_steady() && batches(&[1.0; 6]).are_steady());
    }

    #[test]
    fn indistinguishable_times_tie() {
        let (quick, slow) =
            (of(&[1.0, 1.1, 1.2, 1.1, 1.0, 1.2]), of(&[1.3, 1.4, 1.5, 1.4, 1.3, 1.5]));
        let between = of(&[1.15, 1.25, 1.35, 1.25, 1.2, 1.3]);
        assert!(!quick.ties(&slow) && !slow.ties(&quick));
        assert!(between.ties(&quick) && slow.ties(&between));
    }
}
