//! The pairs of one side of the teeth over a step: the working flanks, or the back flanks across the
//! backlash.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use crate::model::mesh::{Mesh, Of, Shares};
use crate::model::pair_forces::Touching;
use crate::numeric::bounds;
use crate::numeric::chebyshev;
use crate::numeric::polynomial::{Bernstein, Polynomial, extremes, first_fall};

/// The pairs of a side, with stiffness and load for a set of touching pairs.
#[derive(Clone)]
pub(super) struct Side<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) pairs: &'a [Standing],
    /// The touching pairs of this side.
    pub(super) touching: Touching,
    /// Load sharing of coupled pairs. `None` if each pair is an independent spring.
    pub(super) shares: Option<Arc<Shares>>,
    /// Place of the pair with the number 0 minus that of the incoming pair, in m.
    pub(super) offset: f64,
    /// Distance that the driver falls behind until the flanks touch, in m.
    pub(super) backlash: f64,
    /// 1 if the pairs carry when the driver gets ahead, −1 if they carry when it falls behind.
    pub(super) sign: f64,
}

impl Side<'_> {
    /// The place of the incoming pair up to which every function is one polynomial, from `s` on.
    pub(super) fn serves_until(&self, s: f64) -> f64 {
        let own = s + self.offset;
        let zones_end = |pair: &Standing| self.mesh.serves_until(pair.ahead, pair.zone, own);
        let end = match &self.shares {
            Some(shares) => {
                let (at, least) = self.mesh.above(self.rearmost(), own);
                own + (shares.serves_until((at, least)) - at)
            }
            None => self.pairs.iter().map(zones_end).fold(f64::INFINITY, f64::min),
        };
        // The arms and the sliding of the touching pairs come from the zones.
        let rubbing = self.touching.pairs().filter(|_| self.mesh.friction() > 0.0);
        let rubbing = rubbing.map(|pair| zones_end(&self.pairs[pair]));
        let end = rubbing.fold(end, f64::min) - self.offset;
        if self.offset > 0.0 {
            // Rounding of the two places can make the length of a short piece 0.
            end.max(s + 64.0 * f64::EPSILON * (s.abs() + self.offset))
        } else {
            end
        }
    }

    /// Adds stiffness and load of the touching pairs, and the leads of all pairs.
    pub(super) fn add(
        &self,
        (s, way): (f64, f64),
        (stiffness, load): (&mut Polynomial<TERMS>, &mut Polynomial<TERMS>),
    ) {
        if let Some(shares) = &self.shares {
            let (slope, offset) = self.line(shares, Of::Sum, (s, way));
            *stiffness = stiffness.plus(1.0, &slope);
            *load = load.plus(self.sign, &offset);
            return;
        }
        for pair in self.touching.pairs().map(|pair| &self.pairs[pair]) {
            let [spring, gap] = self.spring_along(pair, s, way);
            let carrying = self.turning(pair, &spring, s, way);
            *stiffness = stiffness.plus(1.0, &carrying);
            let pushed = carrying.times::<{ chebyshev::TERMS }, TERMS>(&gap);
            *load = load.plus(self.sign, &pushed);
        }
    }

    /// Slope and offset over the displacement of this side, the deviation and the backlash counted.
    fn line(&self, shares: &Shares, of: Of, (s, way): (f64, f64)) -> (Along, Along) {
        let place = self.mesh.above(self.rearmost(), s + self.offset);
        let line = shares.along(of, place, way);
        let mut offset = line.offset.plus(self.backlash, &line.slope);
        if let Some(deviated) = line.deviated {
            offset = offset.plus(-self.mesh.error, &deviated);
        }
        offset.0[0] -= self.error_apart(of);
        (line.slope, offset)
    }

    /// The error by which a pair that does not touch overlaps more, in m.
    fn error_apart(&self, of: Of) -> f64 {
        match of {
            Of::Pair(pair) if !self.touching.has(pair) => {
                self.mesh.error_of(self.pairs[pair].ahead)
            }
            _ => 0.0,
        }
    }

    /// The lead of a pair that is an independent spring.
    fn lead_of_gap(&self, gap: Along) -> Lead {
        if self.sign > 0.0 {
            return Lead::Gap(gap);
        }
        let mut slope = Along::ZERO;
        slope.0[0] = self.sign;
        Lead::Shared { slope, offset: gap }
    }

    /// Stiffness in N/m, and displacement of the driver at which the pair touches, in m.
    pub(super) fn spring_along(&self, pair: &Standing, s: f64, way: f64) -> [Along; 2] {
        let own = s + self.offset;
        let [spring, mut gap] = self.mesh.spring_along(pair.ahead, pair.zone, own, way);
        gap.0[0] += self.backlash;
        [spring, gap]
    }

    /// The part of a pair's force or stiffness that turns the driver.
    pub(super) fn turning<const N: usize>(
        &self,
        pair: &Standing,
        force: &Polynomial<N>,
        s: f64,
        way: f64,
    ) -> Polynomial<TERMS> {
        let friction = self.mesh.friction();
        let whole = Polynomial::ZERO.plus(1.0, force);
        if friction == 0.0 {
            return whole;
        }
        let own = s + self.offset;
        let [lever, _] = self.mesh.slide_along(pair.ahead, pair.zone, own, way);
        whole.plus(-friction * pair.direction, &force.times::<{ chebyshev::TERMS }, TERMS>(&lever))
    }

    /// Whether a pair goes on to touch, or to be apart, wherever the displacement ahead is in a
    /// range, all the way on which what is known from `s` on is one polynomial.
    pub(super) fn is_clear(&self, pair: usize, s: f64, (least, most): (f64, f64)) -> bool {
        let displaced = [self.sign * least, self.sign * most];
        let displaced = [displaced[0].min(displaced[1]), displaced[0].max(displaced[1])];
        let displaced = displaced.map(|displaced| displaced - self.backlash);
        let own = s + self.offset;
        let (low, high) = match &self.shares {
            None => {
                let Standing { ahead, zone, .. } = self.pairs[pair];
                let (low, high) = self.mesh.gap_bounds(ahead, zone, own);
                (displaced[0] - high, displaced[1] - low)
            }
            Some(shares) => {
                let of = Of::Pair(pair);
                let line = shares.bounds(of, self.mesh.above(self.rearmost(), own));
                let (low, high) = product(line.slope, displaced);
                let error = [self.mesh.error; 2];
                let deviated = line.deviated.map_or((0.0, 0.0), |line| product(line, error));
                let apart = self.error_apart(of);
                (
                    low - line.offset.1 + deviated.0 + apart,
                    high - line.offset.0 + deviated.1 + apart,
                )
            }
        };
        if self.touching.has(pair) { low > 0.0 } else { high < 0.0 }
    }

    /// The lead of a pair over a step.
    pub(super) fn lead_along(&self, pair: usize, s: f64, way: f64) -> Lead {
        let Some(shares) = &self.shares else {
            let [_, gap] = self.spring_along(&self.pairs[pair], s, way);
            return self.lead_of_gap(gap);
        };
        let (slope, offset) = self.line(shares, Of::Pair(pair), (s, way));
        Lead::Shared { slope: slope.scaled(self.sign), offset }
    }

    /// Force of a touching pair over a step, in N.
    pub(super) fn force_along(
        &self,
        pair: usize,
        ahead: &Polynomial<TERMS>,
        (s, way): (f64, f64),
    ) -> Polynomial<FORCE_TERMS> {
        if self.shares.is_some() {
            return self.lead_along(pair, s, way).over(ahead);
        }
        let [stiffness, gap] = self.spring_along(&self.pairs[pair], s, way);
        let displaced = ahead.scaled(self.sign);
        displaced.plus(-1.0, &gap).times(&stiffness)
    }

    /// Friction power of a touching pair over a step, divided by the friction coefficient, in W.
    pub(super) fn rubbing_along(
        &self,
        pair: usize,
        ahead: &Polynomial<TERMS>,
        (s, way): (f64, f64),
    ) -> f64 {
        let pitches = self.pairs[pair].ahead;
        let Standing { zone, direction, .. } = self.pairs[pair];
        let own = s + self.offset;
        let [_, sliding] = self.mesh.slide_along(pitches, zone, own, way);
        let force = self.force_along(pair, ahead, (s, way));
        let power: Polynomial<{ FORCE_TERMS + chebyshev::TERMS }> = force.times(&sliding);
        direction * power.integral()
    }

    /// Displacement of the driver at which a pair touches, in m.
    pub(super) fn gap(&self, pair: usize, s: f64) -> f64 {
        self.spring(pair, s).1
    }

    /// Force of a touching pair for a displacement of the driver, in N.
    pub(super) fn force(&self, pair: usize, s: f64, ahead: f64) -> f64 {
        let Some(shares) = &self.shares else {
            let (stiffness, gap) = self.spring(pair, s);
            return stiffness * (self.sign * ahead - gap);
        };
        let (place, _) = self.mesh.above(self.rearmost(), s + self.offset);
        let line = shares.at(Of::Pair(pair), place);
        let deviated = line.deviated.unwrap_or(0.0) * self.mesh.error;
        line.slope * (self.sign * ahead - self.backlash) - line.offset + deviated
    }

    /// Sum of the forces of all touching pairs, in N.
    pub(super) fn total(&self, s: f64, ahead: f64) -> f64 {
        let touching = (0..self.pairs.len()).filter(|&pair| self.touching.has(pair));
        touching.map(|pair| self.force(pair, s, ahead)).sum()
    }

    fn spring(&self, pair: usize, s: f64) -> (f64, f64) {
        let Standing { ahead, zone, .. } = self.pairs[pair];
        let (stiffness, gap) = self.mesh.spring(ahead, zone, s + self.offset);
        (stiffness, gap + self.backlash)
    }

    /// Number of base pitches that the rearmost pair is ahead.
    pub(super) fn rearmost(&self) -> i32 {
        self.pairs.first().map_or(0, |pair| pair.ahead)
    }
}

/// Between what values a product is, of a factor between two values and one between two others.
fn product((low, high): (f64, f64), others: [f64; 2]) -> (f64, f64) {
    bounds(others.into_iter().flat_map(|other| [low * other, high * other]))
}

/// Number of terms of a step's series, the fastest choice at tolerances from 1e-3 to 1e-11.
pub(super) const TERMS: usize = 28;

/// Number of terms of the incoming tooth's force, the product of stiffness and deflection.
pub(super) const FORCE_TERMS: usize = TERMS + chebyshev::TERMS;

/// A value of the mesh over a step.
pub(super) type Along = Polynomial<{ chebyshev::TERMS }>;

/// The force of a touching pair, or the overlap of another pair. A pair gains or loses contact
/// where its sign changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Lead {
    /// x minus this gap, in m, for a pair that is an independent spring.
    Gap(Along),
    /// `slope · x − offset` of a coupled pair: its force in N if it touches, otherwise its overlap
    /// in m.
    Shared { slope: Along, offset: Along },
}

impl Lead {
    /// The first part of the step where the lead times `sign` falls below 0. If the pair `turned`
    /// at the beginning, the lead is 0 there within rounding.
    pub(super) fn first_fall(
        &self,
        ahead: &Polynomial<TERMS>,
        sign: f64,
        turned: bool,
    ) -> Option<f64> {
        match self {
            Lead::Gap(gap) => fall(&ahead.plus(-1.0, gap).scaled(sign), turned),
            Lead::Shared { .. } => fall(&self.over(ahead).scaled(sign), turned),
        }
    }

    /// The greatest value of the lead over a step, or `least` if that is greater.
    pub(super) fn most(&self, ahead: &Polynomial<TERMS>, least: f64) -> f64 {
        match self {
            Lead::Gap(gap) => most(&ahead.plus(-1.0, gap), least),
            Lead::Shared { .. } => most(&self.over(ahead), least),
        }
    }

    /// The lead for a displacement.
    pub(super) fn over(&self, ahead: &Polynomial<TERMS>) -> Polynomial<FORCE_TERMS> {
        match self {
            Lead::Gap(gap) => Polynomial::ZERO.plus(1.0, ahead).plus(-1.0, gap),
            Lead::Shared { slope, offset } => {
                ahead.times::<{ chebyshev::TERMS }, FORCE_TERMS>(slope).plus(-1.0, offset)
            }
        }
    }

    /// Whether the lead keeps its sign for all displacements in the range: above 0 for a touching
    /// pair, below 0 for another pair.
    pub(super) fn is_clear(&self, touches: bool, (least, most): (f64, f64)) -> bool {
        let (low, high) = match self {
            Lead::Gap(gap) => {
                let varying = variation(gap);
                (least - (gap.0[0] + varying), most - (gap.0[0] - varying))
            }
            Lead::Shared { slope, offset } => {
                let ends = [least * slope.0[0], most * slope.0[0]];
                let varying = variation(slope) * least.abs().max(most.abs()) + variation(offset);
                let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                (low - (offset.0[0] + varying), high - (offset.0[0] - varying))
            }
        };
        if touches { low > 0.0 } else { high < 0.0 }
    }
}

/// Greatest difference of a polynomial from its value at 0.
fn variation<const N: usize>(polynomial: &Polynomial<N>) -> f64 {
    let varying = polynomial.0[1..].iter();
    varying.map(|coefficient| coefficient.abs()).sum()
}

fn fall<const N: usize>(kept: &Polynomial<N>, turned: bool) -> Option<f64> {
    if turned && (kept.0[0] < 0.0 || is_rounding(kept)) {
        first_fall(&kept.over_argument())
    } else {
        first_fall(kept)
    }
}

/// Whether the value at 0 is rounding compared with the variation of the polynomial.
fn is_rounding<const N: usize>(kept: &Polynomial<N>) -> bool {
    const ROUNDING: f64 = 1e-9;
    kept.0[0].abs() <= ROUNDING * variation(kept)
}

fn most<const N: usize>(lead: &Polynomial<N>, least: f64) -> f64 {
    if Bernstein::of(lead).bounds().1 <= least {
        return least;
    }
    extremes(lead).fold(least, f64::max)
}

/// A side of the teeth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Flank {
    /// The flanks that transmit the torque.
    Working,
    /// The flanks that touch if the driver falls behind by the backlash.
    Back,
}

/// Side and number of a pair of flanks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct PairName {
    pub(super) flank: Flank,
    /// Number of base pitches ahead of the incoming pair, or of the back pair next to B' in the
    /// mirror.
    pub(super) ahead: i32,
}

impl PairName {
    /// The pair of working flanks `ahead` base pitches ahead of the incoming pair.
    pub(super) fn working(ahead: i32) -> PairName {
        PairName { flank: Flank::Working, ahead }
    }

    /// The pair `pitches` base pitches farther ahead.
    pub(super) fn moved(self, pitches: i32) -> PairName {
        PairName { ahead: self.ahead + pitches, ..self }
    }
}

/// A pair that may touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Standing {
    pub(super) flank: Flank,
    /// Number of base pitches ahead of the incoming pair.
    pub(super) ahead: i32,
    /// The zone of the mesh.
    pub(super) zone: usize,
    /// Sign of the sliding velocity of the driven flank on the driver's.
    pub(super) direction: f64,
}

impl Standing {
    pub(super) fn name(&self) -> PairName {
        PairName { flank: self.flank, ahead: self.ahead }
    }
}
