//! The pairs of one side of the teeth over a step: those of the working flanks, or those of the
//! back flanks across the backlash.

#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::lead::{Along, FORCE_TERMS, Lead, Product, TERMS};
use super::pair::Standing;
use crate::model::mesh::{Mesh, Shares};
use crate::model::pair_forces::Touching;
use crate::numeric::chebyshev;
use crate::numeric::polynomial::Polynomial;

/// The pairs of a side, and what acts on them while the same ones touch.
#[derive(Clone)]
pub(super) struct Side<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) pairs: &'a [Standing],
    /// The pairs of this side that touch.
    pub(super) touching: Touching,
    /// How coupled pairs share a displacement; none if each is a spring of its own.
    pub(super) shares: Option<Arc<Shares>>,
    /// The place of a pair that is no pitch ahead, less that of the incoming pair, in m.
    pub(super) offset: f64,
    /// By how much the driver falls behind until the flanks meet, in m.
    pub(super) backlash: f64,
    /// 1 where the pairs carry as the driver gets ahead, −1 where they do as it falls behind.
    pub(super) sign: f64,
}

impl Side<'_> {
    /// Until which place of the incoming pair what is known from `s` on is one polynomial each.
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
            // The difference of two places may round a short piece to nothing.
            end.max(s + 64.0 * f64::EPSILON * (s.abs() + self.offset))
        } else {
            end
        }
    }

    /// Adds the stiffness and the load of the pairs that touch, and shows every pair's lead.
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

    /// The lead of a pair that is a spring of its own.
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

    /// Stiffness in N/m, and by how much the driver must be displaced until the pair touches, in m.
    fn spring_along(&self, pair: &Standing, s: f64, way: f64) -> [Along; 2] {
        let own = s + self.offset;
        let [spring, mut gap] = self.mesh.spring_along(pair.ahead, pair.zone, own, way);
        gap.0[0] += self.backlash;
        [spring, gap]
    }

    /// By how much the driver must be displaced until a pair touches, in m.
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

    /// Slope and offset over the displacement ahead: of the force of a touching pair, or of the
    /// overlap of one apart, by its row of the shares.
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

    /// The part of a pair's force, or of its stiffness, that turns the driver.
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

    /// What a pair keeps over a step until it turns.
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

    /// Force of a pair over a step in which it touches, in N.
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

    /// Power of friction at a pair over such a step, over the coefficient, in W.
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

    /// By how much the driver must be displaced until a pair touches, in m.
    pub(super) fn gap(&self, pair: usize, s: f64) -> f64 {
        self.spring(pair, s).1
    }

    /// By how much a displacement ahead is beyond a pair's gap, in m.
    pub(super) fn overlap(&self, pair: usize, s: f64, ahead: f64) -> f64 {
        self.sign * ahead - self.gap(pair, s)
    }

    /// Force of a pair that touches while the driver is so far ahead, in N.
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

    /// Forces of all pairs that touch, in N.
    pub(super) fn total(&self, s: f64, ahead: f64) -> f64 {
        let touching = (0..self.pairs.len()).filter(|&pair| self.touching.has(pair));
        touching.map(|pair| self.force(pair, s, ahead)).sum()
    }

    fn spring(&self, pair: usize, s: f64) -> (f64, f64) {
        let Standing { ahead, zone, .. } = self.pairs[pair];
        let (stiffness, gap) = self.mesh.spring(ahead, zone, s + self.offset);
        (stiffness, gap + self.backlash)
    }

    /// How many base pitches ahead the rearmost pair is.
    pub(super) fn rearmost(&self) -> i32 {
        self.pairs.first().map_or(0, |pair| pair.ahead)
    }
}
