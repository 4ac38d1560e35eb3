//! How long a solve takes, here and now.

use std::time::{Duration, Instant};

/// How long a solve is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Patience {
    /// At least this long, where the runs do not suffice before.
    pub least: Duration,
    /// No further run is begun that would go beyond this.
    pub most: Duration,
}

impl Patience {
    /// Enough for a figure that stands.
    pub const STEADY: Patience = Patience { least: Duration::from_millis(20), most: Duration::from_secs(2) };
    /// A single run: for those who want the errors alone.
    pub const ONCE: Patience = Patience { least: Duration::ZERO, most: Duration::ZERO };
}

/// What a solve takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Time {
    /// The median of the batches, in s.
    pub seconds: f64,
    /// Half of what the middle half of the batches lies apart, in s.
    pub spread: f64,
    /// Solves that were run.
    pub runs: u64,
}

/// Batches of a measurement.
const LEAST_BATCHES: u64 = 5;
const MOST_BATCHES: u64 = 11;

/// Run `once`, which says whether to go on, until the time it takes is known; nothing where it said no.
pub(super) fn time(patience: &Patience, mut once: impl FnMut() -> bool) -> Option<Time> {
    let mut batch = |solves: u64| {
        let begin = Instant::now();
        let done = (0..solves).all(|_| once());
        done.then(|| begin.elapsed().as_secs_f64() / solves as f64)
    };
    let first = batch(1)?;
    let (solves, batches) = plan(patience, first);
    let mut times = vec![first; usize::from(batches == 0)];
    for _ in 0..batches {
        times.push(batch(solves)?);
    }
    times.sort_by(f64::total_cmp);
    let quarter = |part: usize| times[(times.len() - 1) * part / 4];
    Some(Time { seconds: quarter(2), spread: 0.5 * (quarter(3) - quarter(1)), runs: 1 + solves * batches })
}

/// How many solves a batch, and how many batches, for a solve that takes about so many seconds.
fn plan(patience: &Patience, seconds: f64) -> (u64, u64) {
    let fit = |duration: Duration| (duration.as_secs_f64() / seconds.max(1e-9)).ceil() as u64;
    let wanted = fit(patience.least).max(LEAST_BATCHES).min(fit(patience.most));
    let batches = wanted.clamp(wanted.min(LEAST_BATCHES), MOST_BATCHES);
    (wanted.div_ceil(batches.max(1)), batches)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quick_solves_are_batched_and_slow_ones_are_not_run_for_ever() {
        assert_eq!(plan(&Patience::STEADY, 1e-6), (1819, 11));
        assert_eq!(plan(&Patience::STEADY, 1e-3), (2, 11));
        assert_eq!(plan(&Patience::STEADY, 0.1), (1, 5));
        assert_eq!(plan(&Patience::STEADY, 0.9), (1, 3));
        assert_eq!(plan(&Patience::STEADY, 60.0), (1, 1));
        assert_eq!(plan(&Patience::ONCE, 1e-6).1, 0);
    }

    #[test]
    fn every_run_is_counted_and_one_that_stops_ends_it() {
        let mut runs = 0;
        let time = super::time(&Patience::STEADY, || {
            runs += 1;
            true
        });
        let time = time.unwrap();
        assert_eq!(time.runs, runs);
        assert!(time.seconds > 0.0 && time.spread >= 0.0 && time.runs >= LEAST_BATCHES);
        assert_eq!(super::time(&Patience::STEADY, || false), None);
    }
}
