//! Steps of the motion with the same touching pairs, by the power series of the displacement.

use std::rc::Rc;

use super::motion::{Acting, Motion, State, Stretch, Window};
use super::side::{FORCE_TERMS, Lead, Side, TERMS};
use crate::model::Refusal;
use crate::model::pair_forces::Touching;
use crate::numeric::polynomial::{Bernstein, Polynomial};
use crate::numeric::taylor::{Oscillator, convergent_part};

/// Stiffness and load for a set of touching pairs.
#[derive(Clone)]
pub(super) struct Course<'a> {
    pub(super) motion: &'a Motion<'a>,
    pub(super) window: &'a Window,
    touching: Touching,
    working: Side<'a>,
    /// `None` if no back flank is within reach.
    back: Option<Side<'a>>,
}

/// A computed step.
pub(super) struct StepResult {
    pub(super) step: Step,
    /// Whether the step ends where a pair passes to another polynomial. A step of the next base
    /// pitch ends at the same place.
    pub(super) ends_even: bool,
}

/// A step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// Start time, in s.
    pub(super) t: f64,
    /// Duration, in s.
    pub(super) length: f64,
    /// Displacement of the driver as a function of the part of the step, in m.
    pub(super) ahead: Polynomial<TERMS>,
}

impl Step {
    /// Displacement and rate after a part of the step.
    pub(super) fn state(&self, part: f64) -> State {
        State::new(self.ahead.at(part), self.ahead.slope(part) / self.length)
    }

    /// Bounds of the displacement, in m.
    pub(super) fn range(&self) -> (f64, f64) {
        Bernstein::of(&self.ahead).bounds()
    }

    /// End time, in s.
    pub(super) fn end(&self) -> f64 {
        self.t + self.length
    }

    /// The first part of the step, as a step.
    pub(super) fn cut(&self, part: f64) -> Step {
        Step { length: part * self.length, ahead: self.ahead.stretched(part), ..*self }
    }
}

impl<'a> Course<'a> {
    pub(super) fn new(
        motion: &'a Motion<'a>,
        window: &'a Window,
        touching: Touching,
    ) -> Course<'a> {
        Course {
            motion,
            window,
            touching,
            working: motion.working_side(window, touching),
            back: motion.back_side(window, touching),
        }
    }

    /// Number of pairs that may touch.
    pub(super) fn pairs(&self) -> usize {
        self.window.pairs.len()
    }

    pub(super) fn touches(&self, pair: usize) -> bool {
        self.touching.has(pair)
    }

    /// The step from a state on: as long as its series converges, at most to `end`, and on one
    /// polynomial of every pair. The last terms of the series are at most `allowed`, in m. A step
    /// that `begins_even` can use the cache of the last base pitch.
    ///
    /// # Errors
    /// [`Refusal::NotConverged`] if the series is not finite.
    pub(super) fn step(
        &self,
        t: f64,
        y: &State,
        end: f64,
        (allowed, begins_even): (f64, bool),
    ) -> Result<StepResult, Refusal> {
        let whole = self.serves_until(t).min(end) - t;
        let length = whole.min(self.motion.longest_step());
        let acting = if begins_even {
            self.known_acting(t, length)
        } else {
            Rc::new(self.acting(t, length))
        };
        let oscillator = self.oscillator(&acting, length);
        let ahead = oscillator.series(y[0], y[1] * length);
        let step = Step { t, length, ahead };
        let part = convergent_part(&ahead, allowed);
        if part >= 1.0 {
            return Ok(StepResult { step, ends_even: length >= whole });
        }
        // Divides the rest into steps of equal length, so that the last step is not very short.
        let part = if length < whole { part } else { 1.0 / (1.0 / part).ceil() };
        if part * length <= 0.0 || !part.is_finite() {
            return Err(Refusal::NotConverged);
        }
        Ok(StepResult { step: step.cut(part), ends_even: false })
    }

    /// The time up to which every function of the pairs is one polynomial.
    fn serves_until(&self, t: f64) -> f64 {
        let s = self.motion.place(t);
        let ends = self.sides().map(|side| side.serves_until(s));
        self.motion.time(ends.fold(f64::INFINITY, f64::min))
    }

    /// Stiffness and load over a time interval, from the cache of the last base pitch if possible.
    fn known_acting(&self, t: f64, length: f64) -> Rc<Acting> {
        let mesh = self.motion.mesh;
        let stretch = Stretch {
            touching: self.touching,
            from: mesh.above(self.working.rearmost(), self.motion.place(t)).0,
            way: mesh.speed * length,
        };
        self.window.crossing.acting(stretch, mesh, || {
            self.motion.keep(size_of::<Acting>());
            self.acting(t, length)
        })
    }

    /// Stiffness and load over a time interval.
    fn acting(&self, t: f64, length: f64) -> Acting {
        let mut acting = Acting { stiffness: Polynomial::ZERO, load: Polynomial::ZERO };
        acting.load.0[0] = self.motion.mesh.force;
        let way = (self.motion.place(t), self.motion.mesh.speed * length);
        for side in self.sides() {
            side.add(way, (&mut acting.stiffness, &mut acting.load));
        }
        acting
    }

    /// The equation of motion over a time interval, scaled to the length 1.
    fn oscillator(&self, acting: &Acting, length: f64) -> Oscillator<TERMS> {
        let Motion { mass, damping, .. } = *self.motion;
        let damping = if self.touching.is_none() { 0.0 } else { damping * length / mass };
        let scale = length * length / mass;
        Oscillator {
            stiffness: acting.stiffness.scaled(scale),
            load: acting.load.scaled(scale),
            damping,
        }
    }

    /// The touching pairs of the back flanks.
    pub(super) fn back_pairs(&self) -> impl Iterator<Item = usize> {
        self.window.back(self.touching)
    }

    fn sides(&self) -> impl Iterator<Item = &Side<'a>> {
        std::iter::once(&self.working).chain(&self.back)
    }

    /// The side of a pair, and the index of the pair on this side.
    pub(super) fn side_of(&self, pair: usize) -> (&Side<'a>, usize) {
        let working = self.working.pairs.len();
        match &self.back {
            Some(back) if pair >= working => (back, pair - working),
            _ => (&self.working, pair),
        }
    }

    /// Place of the incoming pair at the beginning of a step, and its path in the step, in m.
    pub(super) fn way_of(&self, step: &Step) -> (f64, f64) {
        let speed = self.motion.mesh.speed;
        (self.motion.place(step.t), speed * step.length)
    }

    /// Whether a pair does not turn in a step wherever in its range the displacement is.
    pub(super) fn is_clear(&self, pair: usize, step: &Step, range: (f64, f64)) -> bool {
        let (side, index) = self.side_of(pair);
        side.is_clear(index, self.motion.place(step.t), range)
    }

    /// The lead of a pair over a step.
    pub(super) fn lead_along(&self, pair: usize, step: &Step) -> Lead {
        let (side, index) = self.side_of(pair);
        let (s, way) = self.way_of(step);
        side.lead_along(index, s, way)
    }

    /// Force of a touching pair over a step, in N.
    pub(super) fn force_along(&self, pair: usize, step: &Step) -> Polynomial<FORCE_TERMS> {
        let (side, index) = self.side_of(pair);
        side.force_along(index, &step.ahead, self.way_of(step))
    }

    /// Friction power of a touching pair over a step, divided by the friction coefficient, in W.
    pub(super) fn rubbing_along(&self, pair: usize, step: &Step) -> f64 {
        let (side, index) = self.side_of(pair);
        side.rubbing_along(index, &step.ahead, self.way_of(step))
    }

    /// Displacement of the driver at which a pair touches, in m.
    pub(super) fn gap(&self, pair: usize, t: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        side.gap(index, self.motion.place(t))
    }

    /// Force of a touching pair for a displacement of the driver, in N.
    pub(super) fn force(&self, pair: usize, t: f64, ahead: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        side.force(index, self.motion.place(t), ahead)
    }

    /// Sum of the forces of all working flanks, in N.
    pub(super) fn total(&self, t: f64, ahead: f64) -> f64 {
        self.working.total(self.motion.place(t), ahead)
    }
}

/// A gain or loss of contact of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    /// The pair's index in the window.
    pub(super) pair: usize,
    /// The part of the step before the event.
    pub(super) part: f64,
}

/// The first event of a step. The lead of a pair is a polynomial over the step, so that no event is
/// missed. Pairs in `turned` begin the step with a lead of 0 within rounding; several of them can
/// change together. The pair `standing_off` has no events.
pub(super) fn first_event(
    course: &Course<'_>,
    (step, range): (&Step, (f64, f64)),
    (turned, standing_off): (Touching, Option<usize>),
) -> Option<Event> {
    let may_turn = (0..course.pairs()).filter(|&pair| Some(pair) != standing_off);
    let events = may_turn.filter_map(|pair| {
        if course.is_clear(pair, step, range) {
            return None;
        }
        let (lead, touches) = (course.lead_along(pair, step), course.touches(pair));
        if lead.is_clear(touches, range) {
            return None;
        }
        let sign = if touches { 1.0 } else { -1.0 };
        let part = lead.first_fall(&step.ahead, sign, turned.has(pair))?;
        Some(Event { pair, part })
    });
    events.min_by(|one, other| one.part.total_cmp(&other.part))
}
