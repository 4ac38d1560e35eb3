//! The pairs of one side of the teeth over a step: the working flanks, or the back flanks across
//! the backlash.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::lead::{Along, FORCE_TERMS, Lead, Product, TERMS};
use super::pair::Standing;
use crate::model::mesh::{Mesh, Shares};
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
        let pairs = self
            .pairs
            .iter()
            .map(|pair| self.mesh.serves_until(pair.ahead, pair.zone, own));
        let shares = self.shares.as_ref().map(|shares| {
            let (at, least) = self.mesh.above(self.rearmost(), own);
            own + (shares.serves_until((at, least)) - at)
        });
        let end = pairs.chain(shares).fold(f64::INFINITY, f64::min) - self.offset;
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
        leads: &mut Vec<Lead>,
    ) {
        let Some(shares) = &self.shares else {
            return self.add_springs((s, way), (stiffness, load), leads);
        };
        let own = s + self.offset;
        let along = shares.along(self.mesh.above(self.rearmost(), own), way);
        let gaps = self.gaps_along(s, way);
        for (index, pair) in self.pairs.iter().enumerate() {
            let (slope, offset) = self.share(index, shares.row_along(index, &along), &gaps);
            if self.touching.has(index) {
                let carrying = self.turning(pair, &slope, s, way);
                *stiffness = stiffness.plus(self.sign, &carrying);
                *load = load.plus(self.sign, &self.turning(pair, &offset, s, way));
            }
            leads.push(Lead::Shared { slope, offset });
        }
    }

    fn add_springs(
        &self,
        (s, way): (f64, f64),
        (stiffness, load): (&mut Polynomial<TERMS>, &mut Polynomial<TERMS>),
        leads: &mut Vec<Lead>,
    ) {
        for (index, pair) in self.pairs.iter().enumerate() {
            let [spring, gap] = self.spring_along(pair, s, way);
            leads.push(self.lead_of_gap(gap));
            if self.touching.has(index) {
                let carrying = self.turning(pair, &spring, s, way);
                *stiffness = stiffness.plus(1.0, &carrying);
                let pushed = carrying.times::<{ chebyshev::TERMS }, TERMS>(&gap);
                *load = load.plus(self.sign, &pushed);
            }
        }
    }

    /// The lead of a pair that is an independent spring.
    fn lead_of_gap(&self, gap: Along) -> Lead {
        if self.sign > 0.0 {
            return Lead::Gap(gap);
        }
        let mut slope = Along::ZERO;
        slope.0[0] = self.sign;
        Lead::Shared {
            slope,
            offset: Product::ZERO.plus(1.0, &gap),
        }
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

    fn gaps_along(&self, s: f64, way: f64) -> Vec<Along> {
        let pairs = self.pairs.iter();
        pairs.map(|pair| self.gap_along(pair, s, way)).collect()
    }

    /// Slope and offset over the displacement, by a row of the shares: for the force of a touching
    /// pair, or for the overlap of another pair.
    fn share(&self, pair: usize, row: Option<&[Along]>, gaps: &[Along]) -> (Along, Product) {
        let (mut slope, mut offset) = (Along::ZERO, Product::ZERO);
        let touching = self.shares.iter().flat_map(|shares| &shares.touching);
        for (share, &other) in row.into_iter().flatten().zip(touching) {
            let pushed: Product = share.times(&gaps[other]);
            (slope, offset) = (slope.plus(1.0, share), offset.plus(1.0, &pushed));
        }
        if !self.touching.has(pair) {
            (slope, offset) = (
                slope.scaled(-1.0),
                offset.scaled(-1.0).plus(1.0, &gaps[pair]),
            );
            slope.0[0] += 1.0;
        }
        (slope.scaled(self.sign), offset)
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
        whole.plus(
            -friction * pair.direction,
            &force.times::<{ chebyshev::TERMS }, TERMS>(&lever),
        )
    }

    /// The lead of a pair over a step.
    pub(super) fn lead_along(&self, pair: usize, s: f64, way: f64) -> Lead {
        let Some(shares) = &self.shares else {
            return self.lead_of_gap(self.gap_along(&self.pairs[pair], s, way));
        };
        let own = s + self.offset;
        let along = shares.along(self.mesh.above(self.rearmost(), own), way);
        let gaps = self.gaps_along(s, way);
        let (slope, offset) = self.share(pair, shares.row_along(pair, &along), &gaps);
        Lead::Shared { slope, offset }
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
        let Standing {
            zone, direction, ..
        } = self.pairs[pair];
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

    /// Difference of the displacement and the gap of a pair, in m.
    pub(super) fn overlap(&self, pair: usize, s: f64, ahead: f64) -> f64 {
        self.sign * ahead - self.gap(pair, s)
    }

    /// Force of a touching pair for a displacement of the driver, in N.
    pub(super) fn force(&self, pair: usize, s: f64, ahead: f64) -> f64 {
        let Some(shares) = &self.shares else {
            let (stiffness, gap) = self.spring(pair, s);
            return stiffness * (self.sign * ahead - gap);
        };
        let at = s + self.offset + f64::from(self.rearmost()) * self.mesh.base_pitch;
        let row = shares.row_at(pair, at).unwrap_or_default();
        let terms = row.iter().zip(&shares.touching);
        terms
            .map(|(share, &other)| share * self.overlap(other, s, ahead))
            .sum()
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
