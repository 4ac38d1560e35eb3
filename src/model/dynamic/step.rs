//! Steps of the motion while the same pairs touch, by the power series of the displacement.

use std::rc::Rc;
use std::sync::Arc;

use super::acting::{Acting, Stretch};
use super::lead::{Along, FORCE_TERMS, Lead, Product, TERMS};
use super::motion::{Motion, Standing, State, Window};
use crate::model::Refusal;
use crate::model::mesh::Shares;
use crate::model::pair_forces::Touching;
use crate::numeric::bernstein::Bernstein;
use crate::numeric::chebyshev;
use crate::numeric::polynomial::Polynomial;
use crate::numeric::taylor::{Oscillator, convergent_part};

/// What acts while the same pairs stay in contact.
#[derive(Clone)]
pub(super) struct Course<'a> {
    pub(super) motion: &'a Motion<'a>,
    pub(super) window: &'a Window,
    touching: Touching,
    /// How coupled pairs share a displacement; none if each is a spring of its own.
    shares: Option<Arc<Shares>>,
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
            shares: motion.shares(window, touching),
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
        let mesh = self.motion.mesh;
        let pairs = self
            .window
            .pairs
            .iter()
            .map(|pair| mesh.serves_until(pair.ahead, pair.zone, s));
        let shares = self.shares.as_ref().map(|shares| {
            let (at, least) = mesh.above(self.rearmost(), s);
            s + (shares.serves_until((at, least)) - at)
        });
        self.motion
            .time(pairs.chain(shares).fold(f64::INFINITY, f64::min))
    }

    /// What acts over a length of time, from the last base pitch if the motion has met it there.
    fn known_acting(&self, t: f64, length: f64) -> Rc<Acting> {
        let mesh = self.motion.mesh;
        let stretch = Stretch {
            touching: self.touching,
            from: mesh.above(self.rearmost(), self.motion.place(t)).0,
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
        match &self.shares {
            Some(shares) => self.add_shares(shares, (t, length), &mut acting),
            None => self.add_springs((t, length), &mut acting),
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

    fn add_springs(&self, (t, length): (f64, f64), acting: &mut Acting) {
        let mesh = self.motion.mesh;
        let (s, way) = (self.motion.place(t), mesh.speed * length);
        for (index, pair) in self.window.pairs.iter().enumerate() {
            let [spring, gap] = mesh.spring_along(pair.ahead, pair.zone, s, way);
            acting.leads.push(Lead::Gap(gap));
            if self.touches(index) {
                let carrying = self.turning(pair, &spring, s, way);
                let held: Polynomial<TERMS> = carrying.times(&gap);
                acting.stiffness = acting.stiffness.plus(1.0, &carrying);
                acting.load = acting.load.plus(1.0, &held);
            }
        }
    }

    fn add_shares(&self, shares: &Shares, (t, length): (f64, f64), acting: &mut Acting) {
        let (s, way) = (self.motion.place(t), self.motion.mesh.speed * length);
        let along = shares.along(self.motion.mesh.above(self.rearmost(), s), way);
        let gaps = self.gaps_along(s, way);
        for (index, pair) in self.window.pairs.iter().enumerate() {
            let (slope, offset) = self.share(index, shares.row_along(index, &along), &gaps);
            if self.touches(index) {
                let (spring, held) = (
                    self.turning(pair, &slope, s, way),
                    self.turning(pair, &offset, s, way),
                );
                acting.stiffness = acting.stiffness.plus(1.0, &spring);
                acting.load = acting.load.plus(1.0, &held);
            }
            acting.leads.push(Lead::Shared { slope, offset });
        }
    }

    /// The gap of every pair, in m.
    fn gaps_along(&self, s: f64, way: f64) -> Vec<Along> {
        let pairs = self.window.pairs.iter();
        pairs
            .map(|pair| self.motion.mesh.gap_along(pair.ahead, pair.zone, s, way))
            .collect()
    }

    /// Slope and offset of the force of a touching pair, or of the overlap of one apart, by its row
    /// of the shares.
    fn share(&self, pair: usize, row: Option<&[Along]>, gaps: &[Along]) -> (Along, Product) {
        let (mut slope, mut offset) = (Along::ZERO, Product::ZERO);
        let touching = self.shares.iter().flat_map(|shares| &shares.touching);
        for (share, &other) in row.into_iter().flatten().zip(touching) {
            let pushed: Product = share.times(&gaps[other]);
            (slope, offset) = (slope.plus(1.0, share), offset.plus(1.0, &pushed));
        }
        if !self.touches(pair) {
            (slope, offset) = (
                slope.scaled(-1.0),
                offset.scaled(-1.0).plus(1.0, &gaps[pair]),
            );
            slope.0[0] += 1.0;
        }
        (slope, offset)
    }

    /// The part of a pair's force, or of its stiffness, that turns the driver.
    pub(super) fn turning<const N: usize>(
        &self,
        pair: &Standing,
        force: &Polynomial<N>,
        s: f64,
        way: f64,
    ) -> Polynomial<TERMS> {
        let friction = self.motion.mesh.friction();
        let whole = Polynomial::ZERO.plus(1.0, force);
        if friction == 0.0 {
            return whole;
        }
        let [lever, _] = self.motion.mesh.slide_along(pair.ahead, pair.zone, s, way);
        whole.plus(
            -friction * pair.direction,
            &force.times::<{ chebyshev::TERMS }, TERMS>(&lever),
        )
    }

    /// What a pair keeps over a step until it turns.
    pub(super) fn lead_along(&self, pair: usize, step: &Step) -> Lead {
        let Standing { ahead, zone, .. } = self.window.pairs[pair];
        let mesh = self.motion.mesh;
        let (s, way) = (self.motion.place(step.t), mesh.speed * step.length);
        let Some(shares) = &self.shares else {
            return Lead::Gap(mesh.gap_along(ahead, zone, s, way));
        };
        let along = shares.along(mesh.above(self.rearmost(), s), way);
        let gaps = self.gaps_along(s, way);
        let (slope, offset) = self.share(pair, shares.row_along(pair, &along), &gaps);
        Lead::Shared { slope, offset }
    }

    /// Force of a pair over a step in which it touches, in N.
    pub(super) fn force_along(&self, pair: usize, step: &Step) -> Polynomial<FORCE_TERMS> {
        if self.shares.is_some() {
            return self.lead_along(pair, step).over(&step.ahead);
        }
        let Standing { ahead, zone, .. } = self.window.pairs[pair];
        let motion = self.motion;
        let [stiffness, gap] = motion.mesh.spring_along(
            ahead,
            zone,
            motion.place(step.t),
            motion.mesh.speed * step.length,
        );
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
        let Some(shares) = &self.shares else {
            let (stiffness, gap) = self.spring(pair, t);
            return stiffness * (ahead - gap);
        };
        let at = self.motion.place(t) + f64::from(self.rearmost()) * self.motion.mesh.base_pitch;
        let row = shares.row_at(pair, at).unwrap_or_default();
        let terms = row.iter().zip(&shares.touching);
        terms
            .map(|(share, &other)| share * (ahead - self.gap(other, t)))
            .sum()
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

    /// How many base pitches ahead the rearmost pair is.
    fn rearmost(&self) -> i32 {
        self.window.pairs.first().map_or(0, |pair| pair.ahead)
    }
}
