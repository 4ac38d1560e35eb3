//! Rise and fall of the incoming tooth's force over the steps of a run.

use super::lead::FORCE_TERMS;
use super::step::Step;
use crate::numeric::polynomial::{Polynomial, sign_changes};

/// A step in which the incoming tooth carries load.
pub(super) struct Swing {
    /// Start time and duration, in s.
    begin: f64,
    length: f64,
    force: Polynomial<FORCE_TERMS>,
    /// Parts of the step at the turning points of the force.
    turns: Vec<f64>,
}

/// A stretch with a monotonic force.
pub(super) struct Phase {
    /// End time, in s.
    end: f64,
    /// Rise of the force, in N.
    rise: f64,
    /// Whether the tooth is apart before the stretch.
    follows_gap: bool,
}

impl Swing {
    /// The rise and fall of a force over a step, in N.
    pub(super) fn of(step: &Step, force: &Polynomial<FORCE_TERMS>) -> Swing {
        Swing {
            begin: step.t,
            length: step.length,
            force: *force,
            turns: sign_changes(&force.derivative()),
        }
    }

    /// Whether the step is before E. A step ends at E within rounding.
    pub(super) fn is_before_start(&self) -> bool {
        self.begin + 0.5 * self.length < 0.0
    }

    fn time(&self, part: f64) -> f64 {
        self.begin + part * self.length
    }

    /// Times of the turning points of the force, in s.
    pub(super) fn turns(&self) -> impl Iterator<Item = f64> {
        self.turns.iter().map(|&part| self.time(part))
    }

    /// The stretches of the step. `follows_gap` says whether the tooth is apart before the step.
    pub(super) fn phases(&self, follows_gap: bool) -> impl Iterator<Item = Phase> {
        let begins = std::iter::once(0.0).chain(self.turns.iter().copied());
        let ends = self.turns.iter().copied().chain([1.0]);
        let stretches = begins.zip(ends).enumerate();
        stretches.map(move |(index, (begin, end))| Phase {
            end: self.time(end),
            rise: self.force.at(end) - self.force.at(begin),
            follows_gap: follows_gap && index == 0,
        })
    }

    /// The greatest force, in N.
    pub(super) fn peak(&self) -> f64 {
        let ends = [0.0, 1.0];
        self.turns.iter().chain(&ends).map(|&part| self.force.at(part)).fold(0.0, f64::max)
    }
}

/// Time of the first minimum of the force after its first peak, or of the loss of contact. `peak`
/// is the greatest force of all phases, in N.
pub(super) fn end_of_first_impact(phases: &[Phase], peak: f64) -> Option<f64> {
    const ROUNDING: f64 = 1e-12;
    let none = ROUNDING * peak;
    let (mut has_fallen, mut last) = (false, None);
    for phase in phases {
        if has_fallen && (phase.rise > none || phase.follows_gap) {
            return last;
        }
        has_fallen |= phase.rise < -none;
        last = Some(phase.end);
    }
    last.filter(|_| has_fallen)
}
