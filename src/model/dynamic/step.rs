//! Steps of the motion while the same pairs touch, by the power series of the displacement.

use super::motion::{Motion, Standing, State, Touching, Window};
use crate::model::Refusal;
use crate::numeric::bernstein::{Bernstein, sign_changes};
use crate::numeric::chebyshev;
use crate::numeric::polynomial::Polynomial;
use crate::numeric::taylor::{Oscillator, convergent_part};

/// Terms of a step's series: as many as take the least time, at tolerances from 1e-3 to 1e-11.
pub(super) const TERMS: usize = 28;

/// Terms of the incoming tooth's force, all that its stiffness times its deflection has.
pub(super) const FORCE_TERMS: usize = TERMS + chebyshev::TERMS;

/// What is known of the mesh over a step.
pub(super) type Along = Polynomial<{ chebyshev::TERMS }>;

/// What acts while the same pairs stay in contact.
#[derive(Clone, Copy)]
pub(super) struct Course<'a> {
    pub(super) motion: &'a Motion<'a>,
    pub(super) window: &'a Window,
    touching: Touching,
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

    /// The most by which the displacement is beyond the gap in it, in m, where that is more than
    /// `least`.
    pub(super) fn most_beyond(&self, gap: &Along, least: f64) -> f64 {
        let beyond: Polynomial<TERMS> = self.ahead.plus(-1.0, gap);
        if Bernstein::of(&beyond).bounds().1 <= least {
            return least;
        }
        let turns = sign_changes(&beyond.derivative());
        turns
            .into_iter()
            .chain([0.0, 1.0])
            .map(|part| beyond.at(part))
            .fold(least, f64::max)
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
    /// polynomial of every pair; and every pair's gap over it, in m. The last terms of the series
    /// are `allowed` to be as large as that, in m.
    ///
    /// # Errors
    /// [`Refusal::Unsettled`] where the series has no numbers.
    pub(super) fn step(
        &self,
        t: f64,
        y: &State,
        end: f64,
        allowed: f64,
    ) -> Result<(Step, Vec<Along>), Refusal> {
        let whole = self.serves_until(t).min(end) - t;
        let length = whole.min(self.motion.longest_step());
        let mut gaps = Vec::with_capacity(self.pairs());
        let ahead = self
            .oscillator(t, length, &mut gaps)
            .series(y[0], y[1] * length);
        let step = Step { t, length, ahead };
        let part = convergent_part(&ahead, allowed);
        if part >= 1.0 {
            return Ok((step, gaps));
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
        for gap in &mut gaps {
            *gap = gap.stretched(part);
        }
        Ok((step.cut(part), gaps))
    }

    /// Until when what is known of the pairs from a time on is one polynomial each.
    fn serves_until(&self, t: f64) -> f64 {
        let s = self.motion.place(t);
        let pairs = self
            .window
            .pairs
            .iter()
            .map(|pair| self.motion.mesh.serves_until(pair.ahead, pair.zone, s));
        self.motion.time(pairs.fold(f64::INFINITY, f64::min))
    }

    /// The equation of motion over a length of time, which is its unit.
    fn oscillator(&self, t: f64, length: f64, gaps: &mut Vec<Along>) -> Oscillator<TERMS> {
        let Motion {
            mesh,
            mass,
            damping,
            ..
        } = *self.motion;
        let (s, way) = (self.motion.place(t), mesh.speed * length);
        let (mut stiffness, mut load) = (Polynomial::<TERMS>::ZERO, Polynomial::<TERMS>::ZERO);
        load.0[0] = mesh.force;
        for (index, pair) in self.window.pairs.iter().enumerate() {
            let [spring, gap] = mesh.spring_along(pair.ahead, pair.zone, s, way);
            gaps.push(gap);
            if self.touches(index) {
                let carrying = self.carrying(pair, &spring, s, way);
                stiffness = stiffness.plus(1.0, &carrying);
                load = load.plus(1.0, &carrying.times::<{ chebyshev::TERMS }, TERMS>(&gap));
            }
        }
        let damping = if self.touching.is_none() {
            0.0
        } else {
            damping * length / mass
        };
        let scale = length * length / mass;
        Oscillator {
            stiffness: stiffness.scaled(scale),
            load: load.scaled(scale),
            damping,
        }
    }

    /// The stiffness by which a pair turns the driver.
    pub(super) fn carrying(
        &self,
        pair: &Standing,
        spring: &Along,
        s: f64,
        way: f64,
    ) -> Polynomial<TERMS> {
        let friction = self.motion.mesh.friction();
        let whole = Polynomial::ZERO.plus(1.0, spring);
        if friction == 0.0 {
            return whole;
        }
        let [lever, _] = self.motion.mesh.slide_along(pair.ahead, pair.zone, s, way);
        whole.plus(
            -friction * pair.direction,
            &spring.times::<{ chebyshev::TERMS }, TERMS>(&lever),
        )
    }

    /// Stiffness of a pair over a step, in N/m, and its gap, in m.
    pub(super) fn spring_along(&self, pair: usize, step: &Step) -> [Along; 2] {
        let Standing { ahead, zone, .. } = self.window.pairs[pair];
        let motion = self.motion;
        motion.mesh.spring_along(
            ahead,
            zone,
            motion.place(step.t),
            motion.mesh.speed * step.length,
        )
    }

    /// Force of a pair over a step in which it touches, in N.
    pub(super) fn force_along(&self, pair: usize, step: &Step) -> Polynomial<FORCE_TERMS> {
        let [stiffness, gap] = self.spring_along(pair, step);
        step.ahead.plus(-1.0, &gap).times(&stiffness)
    }

    /// Power of friction at a pair over such a step, over the coefficient, in W.
    pub(super) fn rubbing_along(&self, pair: usize, step: &Step) -> f64 {
        let Standing {
            ahead,
            zone,
            direction,
        } = self.window.pairs[pair];
        let (s, way) = (
            self.motion.place(step.t),
            self.motion.mesh.speed * step.length,
        );
        let [_, sliding] = self.motion.mesh.slide_along(ahead, zone, s, way);
        let power: Polynomial<{ FORCE_TERMS + chebyshev::TERMS }> =
            self.force_along(pair, step).times(&sliding);
        direction * power.integral()
    }

    /// Gap of a pair, in m.
    pub(super) fn gap(&self, pair: usize, t: f64) -> f64 {
        self.spring(pair, t).1
    }

    /// Force of a pair that touches while the driver is so far ahead, in N.
    pub(super) fn force(&self, pair: usize, t: f64, ahead: f64) -> f64 {
        let (stiffness, gap) = self.spring(pair, t);
        stiffness * (ahead - gap)
    }

    /// Forces of all pairs together, in N.
    pub(super) fn total(&self, t: f64, ahead: f64) -> f64 {
        (0..self.pairs())
            .filter(|&pair| self.touches(pair))
            .map(|pair| self.force(pair, t, ahead))
            .sum()
    }

    fn spring(&self, pair: usize, t: f64) -> (f64, f64) {
        let Standing { ahead, zone, .. } = self.window.pairs[pair];
        self.motion.mesh.spring(ahead, zone, self.motion.place(t))
    }
}
