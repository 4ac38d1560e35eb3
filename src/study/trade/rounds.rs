//! The settings of a trade study, timed in rounds until the times are steady; each round runs every
//! setting.

use std::hint::black_box;
use std::time::{Duration, Instant};

use super::answer::{self, Answer};
use super::clock::{Batches, Patience, Time};
use super::setting::Setting;
use super::stopped;
use crate::model::{Inputs, Refusal};

/// Fraction of the progress for the first run of every setting.
const FIRST_LOOK: f64 = 0.2;

pub(super) struct Rounds<'a> {
    inputs: &'a Inputs,
    patience: Patience,
    is_wanted: &'a dyn Fn() -> bool,
    timed: Vec<Timed>,
    begun: Instant,
    /// Total time of the first runs.
    first_look: Duration,
    done: u32,
}

/// A setting and its times, if it solves the case.
struct Timed {
    inputs: Inputs,
    batches: Option<Batches>,
}

impl<'a> Rounds<'a> {
    pub(super) fn begin(
        inputs: &'a Inputs,
        patience: Patience,
        is_wanted: &'a dyn Fn() -> bool,
    ) -> Rounds<'a> {
        let begun = Instant::now();
        Rounds {
            inputs,
            patience,
            is_wanted,
            timed: Vec::new(),
            begun,
            first_look: Duration::ZERO,
            done: 0,
        }
    }

    /// Adds a setting: returns its answer and the time of one solve, or its refusal.
    pub(super) fn first(
        &mut self,
        setting: Setting,
    ) -> Result<Result<(Answer, Time), Refusal>, Refusal> {
        if !(self.is_wanted)() {
            return Err(Refusal::Stopped);
        }
        let inputs = setting.inputs(self.inputs);
        let (mut batches, mut found) = (Batches::default(), None);
        batches
            .add(Duration::ZERO, || found.insert(answer::solve(&inputs, self.is_wanted)).is_ok());
        let found = stopped(found.unwrap_or(Err(Refusal::Stopped)))?;
        let time = batches.time();
        self.timed.push(Timed { inputs, batches: time.is_some().then_some(batches) });
        self.first_look = self.begun.elapsed();
        Ok(found.and_then(|solution| Ok((Answer::of(&solution), time.ok_or(Refusal::Stopped)?))))
    }

    /// Whether to measure another round: a time is not steady yet, and the round ends within the
    /// time limit.
    pub(super) fn go_on(&self) -> bool {
        let gone = self.begun.elapsed().saturating_sub(self.first_look);
        let round = if self.done == 0 { self.first_look } else { gone / self.done };
        let is_unsteady =
            |timed: &Timed| timed.batches.as_ref().is_some_and(|batches| !batches.are_steady());
        gone + round <= self.patience.most && self.timed.iter().any(is_unsteady)
    }

    /// Measures every setting once more; returns the times so far.
    pub(super) fn round(&mut self) -> Result<Vec<Option<Time>>, Refusal> {
        self.done += 1;
        for Timed { inputs, batches } in &mut self.timed {
            let once = || {
                (self.is_wanted)()
                    && black_box(answer::solve(black_box(inputs), self.is_wanted)).is_ok()
            };
            if batches.as_mut().is_some_and(|batches| !batches.add(self.patience.batch, once)) {
                return Err(Refusal::Stopped);
            }
        }
        Ok(self.timed.iter().map(|timed| timed.batches.as_ref()?.time()).collect())
    }

    /// The progress, from 0 to 1, for a number of settings.
    pub(super) fn part(&self, planned: usize) -> f64 {
        if self.timed.len() < planned {
            return FIRST_LOOK * self.timed.len() as f64 / planned as f64;
        }
        if !self.go_on() {
            return 1.0;
        }
        let gone = self.begun.elapsed().saturating_sub(self.first_look);
        let part = gone.as_secs_f64() / self.patience.most.as_secs_f64().max(1e-9);
        FIRST_LOOK + (1.0 - FIRST_LOOK) * part.min(1.0)
    }
}
