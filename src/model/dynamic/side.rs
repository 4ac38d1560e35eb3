//! The pairs of one side of the teeth over a step: the working flanks, or the back flanks across
//! the backlash.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::lead::{Along, FORCE_TERMS, Lead, TERMS};
use super::pair::Standing;
use crate::model::mesh::{Mesh, Of, Shares};
use crate::model::pair_forces::Touching;
use crate::numeric::chebyshev;
use crate::numeric::polynomial::Polynomial;

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
    fn spring_along(&self, pair: &Standing, s: f64, way: f64) -> [Along; 2] {
        let own = s + self.offset;
        let [spring, mut gap] = self.mesh.spring_along(pair.ahead, pair.zone, own, way);
        gap.0[0] += self.backlash;
        [spring, gap]
    }

    /// Displacement of the driver at which a pair touches, in m.
    pub(super) fn gap_along(&self, pair: &Standing, s: f64, way: f64) -> Along {
        let own = s + self.offset;
        let mut gap = self.mesh.gap_along(pair.ahead, pair.zone, own, way);
        gap.0[0] += self.backlash;
        gap
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
            return self.lead_of_gap(self.gap_along(&self.pairs[pair], s, way));
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
    let products = others.map(|other| [low * other, high * other]);
    let all = products.as_flattened().iter();
    all.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| {
        (low.min(value), high.max(value))
    })
}
