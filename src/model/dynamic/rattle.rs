//! Strikes of the back flanks.

use super::step::{Course, Step};
use crate::numeric::polynomial::extremes;

/// Strikes and force of the back flanks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rattle {
    /// Number of times that back flanks touch after none touched.
    pub strikes: u32,
    /// Greatest force of a pair of back flanks, in N.
    pub force: f64,
}

/// Observes the back flanks during a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RattleWatch {
    found: Rattle,
    touches: bool,
    /// The results when the incoming pair last lost contact.
    at_leave: Option<Rattle>,
}

impl RattleWatch {
    /// An observer for a run that begins with or without touching back flanks.
    pub(super) fn from(touches: bool) -> RattleWatch {
        RattleWatch { touches, ..RattleWatch::default() }
    }

    /// Observes a step. `counts` is false for steps of the warm-up.
    pub(super) fn see(&mut self, course: &Course<'_>, step: &Step, counts: bool) {
        let touches = course.back_pairs().next().is_some();
        if counts {
            self.found.strikes += u32::from(touches && !self.touches);
            let forces = course
                .back_pairs()
                .map(|pair| extremes(&course.force_along(pair, step)).fold(0.0, f64::max));
            self.found.force = forces.fold(self.found.force, f64::max);
        }
        self.touches = touches;
    }

    /// The incoming pair loses contact. Later steps count only if the pair touches again.
    pub(super) fn leave(&mut self) {
        self.at_leave = Some(self.found);
    }

    pub(super) fn found(&self) -> Rattle {
        self.at_leave.unwrap_or(self.found)
    }
}
