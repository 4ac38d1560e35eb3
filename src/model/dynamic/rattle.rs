//! The strikes of the back flanks.

use super::step::{Course, Step};
use crate::numeric::bernstein::extremes;

/// What the back flanks carry where the driver falls behind by the backlash.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rattle {
    /// How often back flanks touch while none did before.
    pub strikes: u32,
    /// Greatest force of a pair of back flanks, in N.
    pub force: f64,
}

/// The back flanks on the way.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RattleWatch {
    found: Rattle,
    touches: bool,
    /// What was found when the incoming pair last left.
    at_leave: Option<Rattle>,
}

impl RattleWatch {
    /// One that begins where back flanks touch or not.
    pub(super) fn from(touches: bool) -> RattleWatch {
        RattleWatch {
            touches,
            ..RattleWatch::default()
        }
    }

    /// A step, which counts or only leads to those that do.
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

    /// The incoming pair leaves: later steps count only if it touches and leaves again.
    pub(super) fn leave(&mut self) {
        self.at_leave = Some(self.found);
    }

    pub(super) fn found(&self) -> Rattle {
        self.at_leave.unwrap_or(self.found)
    }
}
