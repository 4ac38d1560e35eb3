//! Steps of the motion while the same pairs touch, by the power series of the displacement.

use std::rc::Rc;

use super::acting::{Acting, Stretch};
use super::lead::{FORCE_TERMS, Lead, TERMS};
use super::motion::{Motion, State, Window};
use super::side::Side;
use crate::model::Refusal;
use crate::model::pair_forces::Touching;
use crate::numeric::bernstein::Bernstein;
use crate::numeric::polynomial::Polynomial;
use crate::numeric::taylor::{Oscillator, convergent_part};

/// What acts while the same pairs stay in contact.
#[derive(Clone)]
pub(super) struct Course<'a> {
    pub(super) motion: &'a Motion<'a>,
    pub(super) window: &'a Window,
    touching: Touching,
    working: Side<'a>,
    /// None where no back flank is within reach.
    back: Option<Side<'a>>,
}

/// A step with what acts over it.
pub(super) struct Taken {
    pub(super) step: Step,
    pub(super) acting: Rc<Acting>,
    /// Whether it ends where a pair passes on to another polynomial: a base pitch later a step ends
    /// there again.
    pub(super) ends_even: bool,
}

/// A step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// When it begins, in s.
    pub(super) t: f64,
    /// How long it takes, in s.
    pub(super) length: f64,
    /// Displacement of the driver ahead over the part of the step, in m.
    pub(super) ahead: Polynomial<TERMS>,
}

impl Step {
    /// Displacement and rate after a part of it.
    pub(super) fn state(&self, part: f64) -> State {
        State::new(self.ahead.at(part), self.ahead.slope(part) / self.length)
    }

    /// Between what values the displacement stays, in m.
    pub(super) fn range(&self) -> (f64, f64) {
        Bernstein::of(&self.ahead).bounds()
    }

    /// When it ends, in s.
    pub(super) fn end(&self) -> f64 {
        self.t + self.length
    }

    /// The first part of it, as a step.
    pub(super) fn cut(&self, part: f64) -> Step {
        Step {
            length: part * self.length,
            ahead: self.ahead.stretched(part),
            ..*self
        }
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

    /// How many pairs may touch.
    pub(super) fn pairs(&self) -> usize {
        self.window.pairs.len()
    }

    pub(super) fn touches(&self, pair: usize) -> bool {
        self.touching.has(pair)
    }

    /// The step from a state on, as long as its series converges, to `end` at most and on one
    /// polynomial of every pair. The last terms of the series are `allowed` to be as large as that,
    /// in m. A step that `begins_even` may be known from the last base pitch.
    ///
    /// # Errors
    /// [`Refusal::Unsettled`] where the series has no numbers.
    pub(super) fn step(
        &self,
        t: f64,
        y: &State,
        end: f64,
        (allowed, begins_even): (f64, bool),
    ) -> Result<Taken, Refusal> {
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
            return Ok(Taken {
                step,
                acting,
                ends_even: length >= whole,
            });
        }
        // Steps to an end are of one length, and the last of them is no splinter.
        let part = if length < whole {
            part
        } else {
            1.0 / (1.0 / part).ceil()
        };
        if part * length <= 0.0 || !part.is_finite() {
            return Err(Refusal::Unsettled);
        }
        let cut = Acting {
            leads: acting
                .leads
                .iter()
                .map(|lead| lead.stretched(part))
                .collect(),
            ..*acting
        };
        Ok(Taken {
            step: step.cut(part),
            acting: Rc::new(cut),
            ends_even: false,
        })
    }

    /// Until when what is known of the pairs from a time on is one polynomial each.
    fn serves_until(&self, t: f64) -> f64 {
        let s = self.motion.place(t);
        let ends = self.sides().map(|side| side.serves_until(s));
        self.motion.time(ends.fold(f64::INFINITY, f64::min))
    }

    /// What acts over a length of time, from the last base pitch if the motion has met it there.
    fn known_acting(&self, t: f64, length: f64) -> Rc<Acting> {
        let mesh = self.motion.mesh;
        let stretch = Stretch {
            touching: self.touching,
            from: mesh.above(self.working.rearmost(), self.motion.place(t)).0,
            way: mesh.speed * length,
        };
        self.window.crossing.acting(stretch, mesh, || {
            let acting = self.acting(t, length);
            self.motion
                .keep(size_of::<Acting>() + size_of_val(&*acting.leads));
            acting
        })
    }

    /// What acts over a length of time.
    fn acting(&self, t: f64, length: f64) -> Acting {
        let mut acting = Acting {
            stiffness: Polynomial::ZERO,
            load: Polynomial::ZERO,
            leads: Vec::with_capacity(self.pairs()),
        };
        acting.load.0[0] = self.motion.mesh.force;
        let way = (self.motion.place(t), self.motion.mesh.speed * length);
        for side in self.sides() {
            let sums = (&mut acting.stiffness, &mut acting.load);
            side.add(way, sums, &mut acting.leads);
        }
        acting
    }

    /// The equation of motion over a length of time, which is its unit.
    fn oscillator(&self, acting: &Acting, length: f64) -> Oscillator<TERMS> {
        let Motion { mass, damping, .. } = *self.motion;
        let damping = if self.touching.is_none() {
            0.0
        } else {
            damping * length / mass
        };
        let scale = length * length / mass;
        Oscillator {
            stiffness: acting.stiffness.scaled(scale),
            load: acting.load.scaled(scale),
            damping,
        }
    }

    /// The pairs of back flanks that touch.
    pub(super) fn back_pairs(&self) -> impl Iterator<Item = usize> {
        self.window.back(self.touching)
    }

    fn sides(&self) -> impl Iterator<Item = &Side<'a>> {
        std::iter::once(&self.working).chain(&self.back)
    }

    /// The side of a pair, and its index there.
    pub(super) fn side_of(&self, pair: usize) -> (&Side<'a>, usize) {
        let working = self.working.pairs.len();
        match &self.back {
            Some(back) if pair >= working => (back, pair - working),
            _ => (&self.working, pair),
        }
    }

    /// Where the incoming pair is at the beginning of a step, and how far it goes, in m.
    pub(super) fn way_of(&self, step: &Step) -> (f64, f64) {
        let speed = self.motion.mesh.speed;
        (self.motion.place(step.t), speed * step.length)
    }

    /// What a pair keeps over a step until it turns.
    pub(super) fn lead_along(&self, pair: usize, step: &Step) -> Lead {
        let (side, index) = self.side_of(pair);
        let (s, way) = self.way_of(step);
        side.lead_along(index, s, way)
    }

    /// Force of a pair over a step in which it touches, in N.
    pub(super) fn force_along(&self, pair: usize, step: &Step) -> Polynomial<FORCE_TERMS> {
        let (side, index) = self.side_of(pair);
        side.force_along(index, &step.ahead, self.way_of(step))
    }

    /// Power of friction at a pair over such a step, over the coefficient, in W.
    pub(super) fn rubbing_along(&self, pair: usize, step: &Step) -> f64 {
        let (side, index) = self.side_of(pair);
        side.rubbing_along(index, &step.ahead, self.way_of(step))
    }

    /// By how much the driver must be displaced until a pair touches, in m.
    pub(super) fn gap(&self, pair: usize, t: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        side.gap(index, self.motion.place(t))
    }

    /// Force of a pair that touches while the driver is so far ahead, in N.
    pub(super) fn force(&self, pair: usize, t: f64, ahead: f64) -> f64 {
        let (side, index) = self.side_of(pair);
        side.force(index, self.motion.place(t), ahead)
    }

    /// Forces of all pairs of working flanks together, in N.
    pub(super) fn total(&self, t: f64, ahead: f64) -> f64 {
        self.working.total(self.motion.place(t), ahead)
    }
}
