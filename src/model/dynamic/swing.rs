//! How the incoming tooth's force rises and falls over the steps of a run.

use super::lead::FORCE_TERMS;
use super::step::Step;
use crate::numeric::bernstein::sign_changes;
use crate::numeric::polynomial::Polynomial;

/// A step in which the incoming tooth carries.
pub(super) struct Swing {
    /// When it begins and how long it takes, in s.
    begin: f64,
    length: f64,
    force: Polynomial<FORCE_TERMS>,
    /// The parts of the step after which the force turns.
    turns: Vec<f64>,
}

/// A stretch on which the force rises throughout or falls throughout: when its step begins and when
/// it ends, in s, and by how much it rises, in N.
pub(super) struct Phase {
    step: f64,
    end: f64,
    rise: f64,
}

impl Swing {
    /// The swing of a force over a step, in N.
    pub(super) fn of(step: &Step, force: &Polynomial<FORCE_TERMS>) -> Swing {
        Swing {
            begin: step.t,
            length: step.length,
            force: *force,
            turns: sign_changes(&force.derivative()),
        }
    }

    /// Whether it lies before E, where a step ends within rounding.
    pub(super) fn is_before_start(&self) -> bool {
        self.begin + 0.5 * self.length < 0.0
    }

    fn time(&self, part: f64) -> f64 {
        self.begin + part * self.length
    }

    /// When the force neither grows nor falls, in s.
    pub(super) fn turns(&self) -> impl Iterator<Item = f64> {
        self.turns.iter().map(|&part| self.time(part))
    }

    pub(super) fn phases(&self) -> impl Iterator<Item = Phase> {
        let begins = std::iter::once(0.0).chain(self.turns.iter().copied());
        let ends = self.turns.iter().copied().chain([1.0]);
        begins.zip(ends).map(|(begin, end)| Phase {
            step: self.begin,
            end: self.time(end),
            rise: self.force.at(end) - self.force.at(begin),
        })
    }

    /// The greatest force, in N.
    pub(super) fn peak(&self) -> f64 {
        let ends = [0.0, 1.0];
        self.turns
            .iter()
            .chain(&ends)
            .map(|&part| self.force.at(part))
            .fold(0.0, f64::max)
    }
}

/// When the force is least for the first time after its first peak, or the contact is lost; `peak`
/// is the greatest force of all phases, in N.
pub(super) fn end_of_first_impact(phases: &[Phase], peak: f64) -> Option<f64> {
    const ROUNDING: f64 = 1e-12;
    let none = ROUNDING * peak;
    let (mut has_fallen, mut last) = (false, None);
    for phase in phases {
        let is_apart = |last: f64| phase.step - last > ROUNDING * phase.step.abs();
        if has_fallen && (phase.rise > none || last.is_some_and(is_apart)) {
            return last;
        }
        has_fallen |= phase.rise < -none;
        last = Some(phase.end);
    }
    last.filter(|_| has_fallen)
}
