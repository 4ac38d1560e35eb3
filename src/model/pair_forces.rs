//! The tooth pairs at one position of the mesh, and the forces that they share.

use crate::numeric::banded::Banded;

/// Pitches over which the force on one tooth displaces another.
pub const PITCHES: usize = 2;

/// A pair at a place of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Stiffness b/q of the pair alone, in N/m.
    pub stiffness: f64,
    /// Normal gap of the unloaded flanks, reliefs included, in m.
    pub gap: f64,
    /// Arm of the friction force on the driver over its base radius, ρ₁/r_b1.
    pub lever: f64,
    /// Sliding velocity of the driven flank on the driver's, in m/s.
    pub sliding: f64,
}

/// A tooth pair at a position of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// How many base pitches it is ahead of the incoming one; below 0 behind.
    pub ahead: i32,
    /// Its place.
    pub place: Place,
    /// The part of its force that turns the driver, 1 without friction.
    pub weight: f64,
}

impl Pair {
    /// Force of a pair that is a spring of its own, in N.
    fn alone(&self, displacement: f64) -> f64 {
        self.place.stiffness * (displacement - self.place.gap).max(0.0)
    }
}

/// The pairs that may touch at a position of the mesh, the rearmost first and without omission.
#[derive(Debug, Clone, PartialEq)]
pub struct PairSet {
    pairs: Vec<Pair>,
    /// Displacement of each pair by the force on the pair one and two pitches behind, in m/N; empty
    /// if the pairs are independent springs.
    couplings: Vec<[f64; PITCHES]>,
}

/// The balance at a position of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Displacement of the driver ahead x, in m; infinite where no pair can carry.
    pub displacement: f64,
    /// Force of the incoming tooth, in N.
    pub force: f64,
    /// Forces of all pairs together, in N.
    pub total: f64,
}

/// Some pairs of a set, a bit each: mostly those in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Touching(u64);

impl Touching {
    /// No pair.
    pub const NONE: Touching = Touching(0);

    /// Whether the pair is one of them.
    #[must_use]
    pub fn has(self, pair: usize) -> bool {
        self.0 & 1 << pair != 0
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_none(self) -> bool {
        self.0 == 0
    }

    /// The set with the pair touching where it did not, and the other way round.
    #[must_use]
    pub fn toggled(self, pair: usize) -> Touching {
        Touching(self.0 ^ 1 << pair)
    }

    /// The set with the pair.
    #[must_use]
    pub fn with(self, pair: usize) -> Touching {
        Touching(self.0 | 1 << pair)
    }

    /// The pairs, the rearmost first.
    pub fn pairs(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let pair = (rest != 0).then(|| rest.trailing_zeros() as usize);
            rest &= rest.wrapping_sub(1);
            pair
        })
    }
}

/// The compliances of a set of pairs, Q/b.
#[derive(Debug, Clone, Copy)]
pub struct Compliances<'a> {
    /// Of each pair under its own force, in m/N.
    pub own: &'a [f64],
    /// See [`PairSet`].
    pub couplings: &'a [[f64; PITCHES]],
}

impl Compliances<'_> {
    /// Displacement of one pair by the force on another, in m/N.
    #[must_use]
    pub fn at(&self, one: usize, other: usize) -> f64 {
        let (behind, ahead) = (one.min(other), one.max(other));
        match ahead - behind {
            0 => self.own[one],
            distance if distance <= PITCHES => self.couplings[ahead][distance - 1],
            _ => 0.0,
        }
    }

    /// The matrix of the touching pairs, which comes first, and factored; `None` if it is not
    /// positive definite.
    #[must_use]
    pub fn among(&self, touching: &[usize]) -> Option<Banded> {
        let entry = |at: usize, distance: usize| {
            let other = at.checked_sub(distance).map(|other| touching[other]);
            other.map_or(0.0, |other| self.at(touching[at], other))
        };
        let rows = (0..touching.len()).map(|at| [0, 1, 2].map(|distance| entry(at, distance)));
        Banded::factored(rows.collect())
    }

    /// Displacement of a pair by unit forces, without its own.
    fn pushed<const M: usize>(
        &self,
        pair: usize,
        touching: &[usize],
        forces: &[[f64; M]],
    ) -> [f64; M] {
        let mut sums = [0.0; M];
        for (&other, force) in touching.iter().zip(forces) {
            let coupling = self.at(pair, other);
            for (sum, force) in sums.iter_mut().zip(force) {
                *sum += coupling * force;
            }
        }
        sums
    }
}

/// What ends the way of the displacement up from the first touch.
#[derive(Debug, Clone, Copy)]
enum Until {
    /// The forces that turn the driver add up to this, in N.
    Total(f64),
    /// The displacement is this, in m.
    Displacement(f64),
}

/// While the same pairs touch: force (or lead, in m, of a pair apart) = slope x − offset.
struct Lines {
    touching: Vec<usize>,
    /// Slope and offset of each touching pair's force.
    forces: Vec<[f64; 2]>,
}

impl PairSet {
    /// Pairs without omission, the rearmost first, and their couplings.
    #[must_use]
    pub fn new(pairs: Vec<Pair>, couplings: Vec<[f64; PITCHES]>) -> PairSet {
        PairSet { pairs, couplings }
    }

    /// The pairs, the rearmost first.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// The same pairs without their gaps; those that are not `kept` do not touch.
    #[must_use]
    pub fn of_no_gap(mut self, kept: impl Fn(i32) -> bool) -> PairSet {
        for pair in &mut self.pairs {
            pair.place.gap = if kept(pair.ahead) { 0.0 } else { f64::INFINITY };
        }
        self
    }

    /// The same pairs with wider gaps; `more` is in m, by the base pitches that a pair is ahead.
    #[must_use]
    pub fn widened(&self, more: impl Fn(i32) -> f64) -> PairSet {
        let mut pairs = self.pairs.clone();
        for pair in &mut pairs {
            pair.place.gap += more(pair.ahead);
        }
        PairSet {
            pairs,
            couplings: self.couplings.clone(),
        }
    }

    /// The balance of the forces that turn the driver with `force`, in N.
    ///
    /// # Formula
    /// ```text
    /// x + e_k − S_k = Σ_j Q_kj F_j/b  where F_k > 0,  x + e_k − S_k <= Σ_j Q_kj F_j/b  where F_k = 0
    /// Σ w_k F_k = F0
    /// ```
    ///
    /// # Source
    /// The linear complementarity problem by its parameter x: Cottle, Pang & Stone 2009, "The Linear
    /// Complementarity Problem", section 4.5.
    #[must_use]
    pub fn balance(&self, force: f64) -> Balance {
        let incoming = self.pairs.iter().position(|pair| pair.ahead == 0);
        if self.couplings.is_empty() {
            let displacement = self.of_springs(force);
            let force = |pair: &Pair| pair.alone(displacement);
            return Balance {
                displacement,
                force: incoming.map_or(0.0, |incoming| force(&self.pairs[incoming])),
                total: self.pairs.iter().map(force).sum(),
            };
        }
        let (displacement, forces) = self.shared(force);
        Balance {
            displacement,
            force: incoming.map_or(0.0, |incoming| forces[incoming]),
            total: forces.iter().sum(),
        }
    }

    /// Displacement of the driver ahead, in m, and the force of each pair, in N, at that balance.
    #[must_use]
    pub fn shared(&self, force: f64) -> (f64, Vec<f64>) {
        if self.couplings.is_empty() {
            let displacement = self.of_springs(force);
            return (displacement, self.forces(displacement));
        }
        self.followed(Until::Total(force))
    }

    /// The force of each pair at a displacement of the driver ahead, in N.
    #[must_use]
    pub fn forces(&self, displacement: f64) -> Vec<f64> {
        if self.couplings.is_empty() {
            return self
                .pairs
                .iter()
                .map(|pair| pair.alone(displacement))
                .collect();
        }
        self.followed(Until::Displacement(displacement)).1
    }

    /// By how much the displacement under the others' forces is beyond a pair's gap, in m: above 0
    /// the pair carries.
    #[must_use]
    pub fn lead(mut self, ahead: i32, force: f64) -> f64 {
        let Some(index) = self.pairs.iter().position(|pair| pair.ahead == ahead) else {
            return f64::NEG_INFINITY;
        };
        // A pair out of reach does not touch, and the pitches between the others stay.
        let gap = std::mem::replace(&mut self.pairs[index].place.gap, f64::INFINITY);
        if self.couplings.is_empty() {
            return self.of_springs(force) - gap;
        }
        let (displacement, forces) = self.shared(force);
        displacement - gap - self.pushed(index, &forces)
    }

    /// For each pair, x less gap and couplings, in m, if just these pairs touch: above 0 a touching
    /// pair pushes, and a pair apart would overlap.
    #[must_use]
    pub fn leads(&self, touching: Touching, displacement: f64) -> Vec<f64> {
        let gap = |index: usize| self.pairs[index].place.gap;
        if self.couplings.is_empty() {
            return (0..self.pairs.len())
                .map(|index| displacement - gap(index))
                .collect();
        }
        let own = self.own();
        let Some(lines) = self.lines(&own, touching) else {
            return vec![f64::NAN; self.pairs.len()];
        };
        let mut leads: Vec<f64> = (0..self.pairs.len())
            .map(|index| at(self.apart(&own, &lines, index), displacement))
            .collect();
        for (&index, &force) in lines.touching.iter().zip(&lines.forces) {
            leads[index] = at(force, displacement) * own[index];
        }
        leads
    }

    /// Displacement of a pair by the forces of the others, in m.
    #[must_use]
    pub fn pushed(&self, index: usize, forces: &[f64]) -> f64 {
        if self.couplings.is_empty() {
            return 0.0;
        }
        let own = self.own();
        let compliances = self.compliances(&own);
        let others = (0..forces.len()).filter(|&other| other != index);
        others
            .map(|other| compliances.at(index, other) * forces[other])
            .sum()
    }

    /// Whether the compliances are positive definite, so that the forces are those of one set of
    /// touching pairs.
    #[must_use]
    pub fn is_definite(&self) -> bool {
        let all: Vec<usize> = (0..self.pairs.len()).collect();
        self.couplings.is_empty() || self.compliances(&self.own()).among(&all).is_some()
    }

    /// The displacement at which the springs together balance the force, found by taking in one
    /// pair after the other, the smallest gap first.
    fn of_springs(&self, force: f64) -> f64 {
        let (mut stiffness, mut preload, mut displacement) = (0.0, force, f64::INFINITY);
        let mut last: Option<(f64, usize)> = None;
        loop {
            let gaps = self
                .pairs
                .iter()
                .enumerate()
                .map(|(index, pair)| (pair.place.gap, index));
            let further = gaps.filter(|gap| last.is_none_or(|last| *gap > last));
            let next = further.min_by(|one, other| one.0.total_cmp(&other.0));
            let Some((gap, index)) = next.filter(|(gap, _)| *gap < displacement) else {
                return displacement;
            };
            let pair = &self.pairs[index];
            stiffness += pair.weight * pair.place.stiffness;
            preload += pair.weight * pair.place.stiffness * gap;
            displacement = preload / stiffness;
            last = Some((gap, index));
        }
    }

    /// Displacement and forces where the way of the displacement up from the first touch ends: the
    /// sum of forces grows along it in straight pieces, from one touch or loss of a pair to the
    /// next.
    fn followed(&self, until: Until) -> (f64, Vec<f64>) {
        let own = self.own();
        let mut forces = vec![0.0; self.pairs.len()];
        let (mut x, mut touching) = (f64::NEG_INFINITY, Touching::NONE);
        // Each pair turns once; few turn again.
        for _ in 0..=4 * self.pairs.len() {
            let Some(lines) = self.lines(&own, touching) else {
                break;
            };
            let (end, next) = (self.end(&lines, until), self.next(&own, &lines, x));
            match next {
                Some((at, pair)) if at < end => (x, touching) = (at, touching.toggled(pair)),
                _ => {
                    for (&index, &force) in lines.touching.iter().zip(&lines.forces) {
                        forces[index] = at(force, end).max(0.0);
                    }
                    return (end, forces);
                }
            }
        }
        (f64::INFINITY, forces)
    }

    /// The displacement at which the way ends if no other pair turns before.
    fn end(&self, lines: &Lines, until: Until) -> f64 {
        match until {
            Until::Displacement(displacement) => displacement,
            Until::Total(total) => {
                let mut sums = [0.0; 2];
                for (&index, force) in lines.touching.iter().zip(&lines.forces) {
                    let weight = self.pairs[index].weight;
                    sums = [sums[0] + weight * force[0], sums[1] + weight * force[1]];
                }
                if sums[0] > 0.0 {
                    (total + sums[1]) / sums[0]
                } else {
                    f64::INFINITY
                }
            }
        }
    }

    /// The next pair that touches or leaves as the displacement grows from `x`, and where.
    fn next(&self, own: &[f64], lines: &Lines, x: f64) -> Option<(f64, usize)> {
        let leaves = lines
            .touching
            .iter()
            .zip(&lines.forces)
            .filter(|(_, force)| force[0] < 0.0)
            .map(|(&index, force)| (force[1] / force[0], index));
        let apart = (0..self.pairs.len())
            .filter(|index| !lines.touching.contains(index))
            .map(|index| (self.apart(own, lines, index), index));
        let touches = apart
            .filter(|(lead, _)| lead[0] > 0.0 && lead[1] < f64::INFINITY)
            .map(|(lead, index)| (lead[1] / lead[0], index));
        leaves
            .chain(touches)
            .map(|(at, index)| (at.max(x), index))
            .min_by(|one, other| one.0.total_cmp(&other.0))
    }

    /// The forces if just these pairs touch; `None` if their compliances are not positive definite.
    fn lines(&self, own: &[f64], touching: Touching) -> Option<Lines> {
        let touching: Vec<usize> = touching.pairs().collect();
        let factored = self.compliances(own).among(&touching)?;
        let mut forces: Vec<[f64; 2]> = touching
            .iter()
            .map(|&index| [1.0, self.pairs[index].place.gap])
            .collect();
        factored.solve(&mut forces);
        Some(Lines { touching, forces })
    }

    /// Slope and offset of x less gap and couplings of a pair apart.
    fn apart(&self, own: &[f64], lines: &Lines, index: usize) -> [f64; 2] {
        let [slope, offset] = self
            .compliances(own)
            .pushed(index, &lines.touching, &lines.forces);
        [1.0 - slope, self.pairs[index].place.gap - offset]
    }

    fn own(&self) -> Vec<f64> {
        self.pairs
            .iter()
            .map(|pair| pair.place.stiffness.recip())
            .collect()
    }

    fn compliances<'a>(&'a self, own: &'a [f64]) -> Compliances<'a> {
        Compliances {
            own,
            couplings: &self.couplings,
        }
    }
}

fn at([slope, offset]: [f64; 2], displacement: f64) -> f64 {
    slope * displacement - offset
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pseudo-random number from 0 to 1.
    fn random(state: &mut u64) -> f64 {
        *state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    }

    fn pair(ahead: i32, stiffness: f64, gap: f64) -> Pair {
        Pair {
            ahead,
            place: Place {
                stiffness,
                gap,
                lever: 0.0,
                sliding: 0.0,
            },
            weight: 1.0,
        }
    }

    /// Up to six random pairs, coupled strongly; gaps of the size of the deflections.
    fn random_pairs(state: &mut u64) -> PairSet {
        loop {
            let count = 1 + (random(state) * 6.0) as i32;
            let pairs = (0..count).map(|ahead| {
                let stiffness = 0.5 + 2.0 * random(state);
                pair(ahead - 1, stiffness, 2.0 * random(state) - 0.5)
            });
            let pairs: Vec<Pair> = pairs.collect();
            let couplings = (0..count).map(|_| [0.7 * random(state), 0.4 * random(state) - 0.1]);
            let set = PairSet::new(pairs, couplings.collect());
            if set.is_definite() {
                return set;
            }
        }
    }

    /// What is left of the conditions of the complementarity problem, which has one solution.
    fn violation(set: &PairSet, displacement: f64, forces: &[f64]) -> f64 {
        let rest = |(index, pair): (usize, &Pair)| {
            let own = forces[index] / pair.place.stiffness;
            let overlap = displacement - pair.place.gap - own - set.pushed(index, forces);
            let wrong = if forces[index] > 0.0 {
                overlap.abs()
            } else {
                overlap
            };
            wrong.max(-forces[index])
        };
        set.pairs().iter().enumerate().map(rest).fold(0.0, f64::max)
    }

    #[test]
    fn each_pair_has_a_force_and_no_gap_or_a_gap_and_no_force() {
        let mut state = 7;
        for round in 0..20_000 {
            let set = random_pairs(&mut state);
            let total = 3.0 * random(&mut state) + 1e-6;
            let (displacement, forces) = set.shared(total);
            let sum: f64 = forces.iter().sum();
            assert!(
                (sum / total - 1.0).abs() < 1e-9,
                "{round}: {sum} of {total}"
            );
            let off = violation(&set, displacement, &forces);
            assert!(off < 1e-9, "{round}: off by {off:e}, {set:?}");
            for (force, expected) in set.forces(displacement).iter().zip(&forces) {
                assert!(
                    (force - expected).abs() < 1e-8,
                    "{round}: {force} {expected}"
                );
            }
        }
    }

    #[test]
    fn the_lead_of_a_pair_is_above_0_where_it_carries() {
        let mut state = 5;
        for _ in 0..5_000 {
            let set = random_pairs(&mut state);
            let total = random(&mut state) + 1e-3;
            let lead = set.clone().lead(0, total);
            let force = set.balance(total).force;
            let is_close = lead.abs() < 1e-9;
            assert!(
                is_close || (lead > 0.0) == (force > 0.0),
                "{lead} {force} {set:?}"
            );
        }
    }

    #[test]
    fn pairs_of_no_coupling_are_independent_springs() {
        let mut state = 3;
        for _ in 0..2_000 {
            let set = random_pairs(&mut state);
            let total = 2.0 * random(&mut state) + 1e-6;
            let count = set.pairs().len();
            let springs = PairSet::new(set.pairs().to_vec(), Vec::new());
            let uncoupled = PairSet::new(set.pairs().to_vec(), vec![[0.0; PITCHES]; count]);
            let ((x, forces), (expected, springs)) =
                (uncoupled.shared(total), springs.shared(total));
            assert!((x - expected).abs() < 1e-12, "{x} {expected}");
            for (force, expected) in forces.iter().zip(springs) {
                assert!((force - expected).abs() < 1e-12, "{force} {expected}");
            }
        }
    }

    #[test]
    fn equal_pairs_share_the_load_equally_and_deflect_by_all_of_it() {
        let pairs = (0..3).map(|ahead| pair(ahead, 0.5, 0.1)).collect();
        let (x, forces) = PairSet::new(pairs, vec![[0.5; PITCHES]; 3]).shared(3.0);
        for force in forces {
            assert!((force - 1.0).abs() < 1e-14, "{force}");
        }
        assert!((x - 3.1).abs() < 1e-14, "{x}");
    }

    #[test]
    fn leads_of_the_pairs_that_touch_are_their_forces() {
        let mut state = 11;
        for _ in 0..2_000 {
            let set = random_pairs(&mut state);
            let (x, forces) = set.shared(1.0);
            let carries = forces.iter().enumerate().filter(|(_, force)| **force > 0.0);
            let touching = carries.fold(Touching::NONE, |set, (index, _)| set.with(index));
            let leads = set.leads(touching, x);
            for (index, lead) in leads.iter().enumerate() {
                if touching.has(index) {
                    let force = lead * set.pairs()[index].place.stiffness;
                    assert!((force - forces[index]).abs() < 1e-9);
                } else {
                    assert!(*lead < 1e-9, "{lead}");
                }
            }
        }
    }
}
