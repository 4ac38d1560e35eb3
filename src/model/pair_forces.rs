//! The tooth pairs at one position of the mesh and their forces.

use std::array::from_fn;

use smallvec::{SmallVec, smallvec};

pub use super::field::PITCHES;
use crate::numeric::banded::Banded;

/// A value of each pair, without heap for as many pairs as usual.
pub type OfPairs<T> = SmallVec<[T; 4]>;

/// The contact place of a pair in the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Stiffness b/q of the pair alone, in N/m.
    pub stiffness: f64,
    /// Normal gap of the unloaded flanks, reliefs included, in m.
    pub gap: f64,
    /// Sliding velocity of the driven flank on the driver's, in m/s.
    pub sliding: f64,
}

/// A tooth pair at a position of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Number of base pitches ahead of the incoming pair; negative for pairs behind.
    pub ahead: i32,
    /// Stiffness b/q of the pair alone, in N/m.
    pub stiffness: f64,
    /// Normal gap of the unloaded flanks, reliefs and error of the pair included, in m.
    pub gap: f64,
    /// The part of the force that turns the driver; 1 without friction.
    pub weight: f64,
}

impl Pair {
    /// Force of a pair as an independent spring, in N.
    fn alone(&self, displacement: f64) -> f64 {
        self.stiffness * (displacement - self.gap).max(0.0)
    }
}

/// The pairs that may touch at a position of the mesh, the rearmost first, without gaps in their
/// order.
#[derive(Debug, Clone, PartialEq)]
pub struct PairSet {
    pairs: OfPairs<Pair>,
    /// Displacement of each pair by a unit force on the pair 1, 2, .. pitches behind, in m/N. Empty
    /// if the pairs are independent springs.
    couplings: OfPairs<[f64; PITCHES]>,
}

/// The balance at a position of the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Displacement of the driver ahead x, in m; infinite if no pair can carry.
    pub displacement: f64,
    /// Force of the incoming tooth, in N.
    pub force: f64,
    /// Sum of the forces of all pairs, in N.
    pub total: f64,
    /// Displacement under the forces minus the gap of the incoming pair, in m. `None` if the
    /// incoming pair carries.
    pub lead: Option<f64>,
    /// The pairs that carry.
    pub carrying: Carrying,
}

/// The pairs that carry at a position of the mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Carrying {
    first: i32,
    touching: Touching,
}

impl Carrying {
    /// Whether the pair `ahead` carries.
    pub fn has(self, ahead: i32) -> bool {
        usize::try_from(ahead - self.first).is_ok_and(|index| self.touching.has(index))
    }

    /// The pairs that carry in only one of two positions, as base pitches ahead of the incoming
    /// pair.
    pub fn differences(self, other: Carrying) -> impl Iterator<Item = i32> {
        let pairs = |of: Carrying| {
            of.touching.pairs().map(move |index| of.first.saturating_add_unsigned(index as u32))
        };
        let only = move |one: Carrying, other: Carrying| {
            pairs(one).filter(move |&ahead| !other.has(ahead))
        };
        only(self, other).chain(only(other, self))
    }
}

impl PairSet {
    /// `pairs` begins with the rearmost pair and has no gaps in its order.
    pub fn new(
        pairs: impl IntoIterator<Item = Pair>,
        couplings: impl IntoIterator<Item = [f64; PITCHES]>,
    ) -> PairSet {
        PairSet { pairs: pairs.into_iter().collect(), couplings: couplings.into_iter().collect() }
    }

    /// The pairs, the rearmost first.
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// The pairs without their gaps.
    pub fn of_no_gap(mut self) -> PairSet {
        for pair in &mut self.pairs {
            pair.gap = 0.0;
        }
        self
    }

    /// The pairs with wider gaps. `more` gives the addition in m for the base pitches that a pair
    /// is ahead.
    pub fn widened(&self, more: impl Fn(i32) -> f64) -> PairSet {
        let mut pairs = self.pairs.clone();
        for pair in &mut pairs {
            pair.gap += more(pair.ahead);
        }
        PairSet { pairs, couplings: self.couplings.clone() }
    }

    /// The balance between `force`, in N, and the forces that turn the driver.
    ///
    /// # Formula
    /// ```text
    /// x + e_k − S_k = Σ_j Q_kj F_j/b  if F_k > 0,  x + e_k − S_k <= Σ_j Q_kj F_j/b  where F_k = 0
    /// Σ w_k F_k = F0
    /// ```
    ///
    /// # Source
    /// The linear complementarity problem by its parameter x: Cottle, Pang & Stone 2009, "The
    /// Linear Complementarity Problem", section 4.5.
    pub fn balance(&self, force: f64) -> Balance {
        let incoming = self.pairs.iter().position(|pair| pair.ahead == 0);
        let (displacement, forces) = self.shared(force);
        let lead = |incoming: usize| {
            let gap = self.pairs[incoming].gap;
            (forces[incoming] <= 0.0).then(|| displacement - gap - self.pushed(incoming, &forces))
        };
        Balance {
            displacement,
            force: incoming.map_or(0.0, |incoming| forces[incoming]),
            total: forces.iter().sum(),
            lead: incoming.map_or(Some(f64::NEG_INFINITY), lead),
            carrying: Carrying {
                first: self.pairs.first().map_or(0, |pair| pair.ahead),
                touching: (0..forces.len())
                    .filter(|&index| forces[index] > 0.0)
                    .fold(Touching::NONE, Touching::with),
            },
        }
    }

    /// Displacement of the driver ahead, in m, and the force of each pair, in N, in the balance.
    pub fn shared(&self, force: f64) -> (f64, OfPairs<f64>) {
        if self.couplings.is_empty() {
            let displacement = self.of_springs(force);
            return (displacement, self.forces(displacement));
        }
        self.solved(Until::Total(force))
    }

    /// The force of each pair at a displacement of the driver ahead, in N.
    pub fn forces(&self, displacement: f64) -> OfPairs<f64> {
        if self.couplings.is_empty() {
            return self.pairs.iter().map(|pair| pair.alone(displacement)).collect();
        }
        self.solved(Until::Displacement(displacement)).1
    }

    /// How far the displacement under the other pairs' forces exceeds a pair's gap, in m. Above 0
    /// the pair carries.
    pub fn lead(mut self, ahead: i32, force: f64) -> f64 {
        let Some(index) = self.pairs.iter().position(|pair| pair.ahead == ahead) else {
            return f64::NEG_INFINITY;
        };
        // An infinite gap removes the pair from the contact but keeps the pitches of the others.
        let gap = std::mem::replace(&mut self.pairs[index].gap, f64::INFINITY);
        let (displacement, forces) = self.shared(force);
        displacement - gap - self.pushed(index, &forces)
    }

    /// The overlap x − gap − Σ Q_kj F_j of each pair, in m, if exactly these pairs touch. A
    /// positive value means that a touching pair has a force, or that another pair would overlap.
    pub fn leads(&self, touching: Touching, displacement: f64) -> Vec<f64> {
        let gap = |index: usize| self.pairs[index].gap;
        if self.couplings.is_empty() {
            return (0..self.pairs.len()).map(|index| displacement - gap(index)).collect();
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
    pub fn pushed(&self, index: usize, forces: &[f64]) -> f64 {
        if self.couplings.is_empty() {
            return 0.0;
        }
        let own = self.own();
        let compliances = self.compliances(&own);
        let others = (0..forces.len()).filter(|&other| other != index);
        others.map(|other| compliances.at(index, other) * forces[other]).sum()
    }

    /// Whether the compliances are positive definite, so that the set of touching pairs is unique.
    pub fn is_definite(&self) -> bool {
        let all: Vec<usize> = (0..self.pairs.len()).collect();
        self.couplings.is_empty() || self.compliances(&self.own()).among(&all).is_some()
    }

    /// The displacement at which the independent springs balance the force. Adds one pair after the
    /// other, the smallest gap first.
    fn of_springs(&self, force: f64) -> f64 {
        let (mut stiffness, mut preload, mut displacement) = (0.0, force, f64::INFINITY);
        let mut last: Option<(f64, usize)> = None;
        loop {
            let gaps = self.pairs.iter().enumerate().map(|(index, pair)| (pair.gap, index));
            let further = gaps.filter(|gap| last.is_none_or(|last| *gap > last));
            let next = further.min_by(|one, other| one.0.total_cmp(&other.0));
            let Some((gap, index)) = next.filter(|(gap, _)| *gap < displacement) else {
                return displacement;
            };
            let pair = &self.pairs[index];
            stiffness += pair.weight * pair.stiffness;
            preload += pair.weight * pair.stiffness * gap;
            displacement = preload / stiffness;
            last = Some((gap, index));
        }
    }

    fn own(&self) -> OfPairs<f64> {
        self.pairs.iter().map(|pair| pair.stiffness.recip()).collect()
    }

    fn compliances<'a>(&'a self, own: &'a [f64]) -> Compliances<'a> {
        Compliances { own, couplings: &self.couplings }
    }
}

fn at([slope, offset]: [f64; 2], displacement: f64) -> f64 {
    slope * displacement - offset
}

/// A subset of pairs, one bit per pair, usually the pairs in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Touching(u64);

impl Touching {
    /// No pair.
    pub const NONE: Touching = Touching(0);

    /// Whether the subset includes the pair.
    pub fn has(self, pair: usize) -> bool {
        self.0 & 1 << pair != 0
    }

    /// Whether the subset is empty.
    pub fn is_none(self) -> bool {
        self.0 == 0
    }

    /// The subset with the membership of the pair inverted.
    pub fn toggled(self, pair: usize) -> Touching {
        Touching(self.0 ^ 1 << pair)
    }

    /// The subset with the pair added.
    pub fn with(self, pair: usize) -> Touching {
        Touching(self.0 | 1 << pair)
    }

    /// The members before a pair.
    pub fn before(self, pair: usize) -> Touching {
        Touching(self.0 & !u64::MAX.checked_shl(pair as u32).unwrap_or(0))
    }

    /// The members from a pair on, renumbered from that pair.
    pub fn since(self, pair: usize) -> Touching {
        Touching(self.0.checked_shr(pair as u32).unwrap_or(0))
    }

    /// The members, the rearmost first.
    pub fn pairs(self) -> impl Iterator<Item = usize> {
        let mut rest = self.0;
        std::iter::from_fn(move || {
            let pair = (rest != 0).then(|| rest.trailing_zeros() as usize);
            rest &= rest.wrapping_sub(1);
            pair
        })
    }
}

/// Length of a matrix row: a pair and the coupled pairs before it.
const ROW: usize = 1 + PITCHES;

/// Compliance matrix of a set of pairs, Q/b.
#[derive(Debug, Clone, Copy)]
pub struct Compliances<'a> {
    /// Compliance of each pair, in m/N.
    pub own: &'a [f64],
    /// Displacement of each pair by the force on the pair 1, 2, .. pitches behind, in m/N.
    pub couplings: &'a [[f64; PITCHES]],
}

impl Compliances<'_> {
    /// Displacement of one pair by the force on another, in m/N.
    pub fn at(&self, one: usize, other: usize) -> f64 {
        let (behind, ahead) = (one.min(other), one.max(other));
        match ahead - behind {
            0 => self.own[one],
            distance if distance <= PITCHES => self.couplings[ahead][distance - 1],
            _ => 0.0,
        }
    }

    /// The factors of the matrix of the touching pairs. `None` if it is not positive definite.
    pub fn among(&self, touching: &[usize]) -> Option<Banded<ROW>> {
        let entry = |at: usize, distance: usize| {
            let other = at.checked_sub(distance).map(|other| touching[other]);
            other.map_or(0.0, |other| self.at(touching[at], other))
        };
        let rows = (0..touching.len()).map(|at| from_fn(|distance| entry(at, distance)));
        Banded::factored(rows)
    }

    /// Displacement of a pair by unit forces on the other pairs.
    fn pushed<const M: usize>(
        &self,
        pair: usize,
        touching: &[usize],
        forces: &[[f64; M]],
    ) -> [f64; M] {
        let mut sums = [0.0; M];
        let near = |(other, _): &(&usize, _)| pair.abs_diff(**other) <= PITCHES;
        for (&other, force) in touching.iter().zip(forces).filter(near) {
            let coupling = self.at(pair, other);
            for (sum, force) in sums.iter_mut().zip(force) {
                *sum += coupling * force;
            }
        }
        sums
    }
}

/// End condition of the search upwards from the first touch.
#[derive(Debug, Clone, Copy)]
enum Until {
    /// The sum of the forces that turn the driver, in N.
    Total(f64),
    /// The displacement, in m.
    Displacement(f64),
}

/// For a fixed set of touching pairs: force (or, for a pair without contact, lead in m) = slope x −
/// offset.
struct Lines {
    touching: OfPairs<usize>,
    /// Slope and offset of each touching pair's force.
    forces: OfPairs<[f64; 2]>,
}

impl PairSet {
    /// Displacement and forces at the end condition.
    fn solved(&self, until: Until) -> (f64, OfPairs<f64>) {
        let own = self.own();
        self.guessed(&own, until).unwrap_or_else(|| self.followed(&own, until))
    }

    /// Guesses the touching pairs from independent springs and corrects the guess until no force
    /// and no overlap contradicts it. `None` if this takes more corrections than usual. The
    /// compliances are positive definite, so that no other set of pairs meets the conditions.
    fn guessed(&self, own: &[f64], until: Until) -> Option<(f64, OfPairs<f64>)> {
        const CORRECTIONS: usize = 6;
        let x = match until {
            Until::Total(total) => self.of_springs(total),
            Until::Displacement(displacement) => displacement,
        };
        let gaps = self.pairs.iter().map(|pair| pair.gap).enumerate();
        let near = gaps.filter(|(_, gap)| *gap < x).map(|(index, _)| index);
        let mut touching = near.fold(Touching::NONE, Touching::with);
        for _ in 0..=CORRECTIONS {
            let lines = self.lines(own, touching)?;
            let end = self.end(&lines, until);
            if !end.is_finite() {
                return None;
            }
            let forces = self.forces_of(&lines, end);
            let overlaps = |&index: &usize| {
                if touching.has(index) {
                    forces[index] > 0.0
                } else {
                    at(self.apart(own, &lines, index), end) > 0.0
                }
            };
            let found = (0..self.pairs.len()).filter(overlaps);
            let found = found.fold(Touching::NONE, Touching::with);
            if found == touching {
                return Some((end, forces));
            }
            touching = found;
        }
        None
    }

    /// The force of each pair at a displacement, 0 of a pair without contact.
    fn forces_of(&self, lines: &Lines, displacement: f64) -> OfPairs<f64> {
        let mut forces: OfPairs<f64> = smallvec![0.0; self.pairs.len()];
        for (&index, &force) in lines.touching.iter().zip(&lines.forces) {
            forces[index] = at(force, displacement).max(0.0);
        }
        forces
    }

    /// Displacement and forces at the end condition. The displacement grows from the first touch,
    /// and the sum of forces is linear between the points where a pair gains or loses contact.
    fn followed(&self, own: &[f64], until: Until) -> (f64, OfPairs<f64>) {
        let (mut x, mut touching) = (f64::NEG_INFINITY, Touching::NONE);
        // Each pair changes its contact once; few pairs change again.
        for _ in 0..=4 * self.pairs.len() {
            let Some(lines) = self.lines(own, touching) else {
                break;
            };
            let (end, next) = (self.end(&lines, until), self.next(own, &lines, x));
            match next {
                Some((at, pair)) if at < end => (x, touching) = (at, touching.toggled(pair)),
                _ => return (end, self.forces_of(&lines, end)),
            }
        }
        (f64::INFINITY, smallvec![0.0; self.pairs.len()])
    }

    /// The displacement of the end condition if no other pair gains or loses contact before.
    fn end(&self, lines: &Lines, until: Until) -> f64 {
        match until {
            Until::Displacement(displacement) => displacement,
            Until::Total(total) => {
                let mut sums = [0.0; 2];
                for (&index, force) in lines.touching.iter().zip(&lines.forces) {
                    let weight = self.pairs[index].weight;
                    sums = [sums[0] + weight * force[0], sums[1] + weight * force[1]];
                }
                if sums[0] > 0.0 { (total + sums[1]) / sums[0] } else { f64::INFINITY }
            }
        }
    }

    /// The next pair that gains or loses contact as the displacement grows from `x`, with the
    /// displacement.
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

    /// The forces if exactly these pairs touch. `None` if their compliances are not positive
    /// definite.
    fn lines(&self, own: &[f64], touching: Touching) -> Option<Lines> {
        let touching: OfPairs<usize> = touching.pairs().collect();
        let factored = self.compliances(own).among(&touching)?;
        let mut forces: OfPairs<[f64; 2]> =
            touching.iter().map(|&index| [1.0, self.pairs[index].gap]).collect();
        factored.solve(&mut forces);
        Some(Lines { touching, forces })
    }

    /// The overlap x − gap − Σ Q_kj F_j of a pair without contact, as slope and offset over x.
    fn apart(&self, own: &[f64], lines: &Lines, index: usize) -> [f64; 2] {
        let [slope, offset] = self.compliances(own).pushed(index, &lines.touching, &lines.forces);
        [1.0 - slope, self.pairs[index].gap - offset]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u64) -> f64 {
        *state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 53) as f64
    }

    fn pair(ahead: i32, stiffness: f64, gap: f64) -> Pair {
        Pair { ahead, stiffness, gap, weight: 1.0 }
    }

    /// Up to six random pairs with strong coupling over three pitches. The gaps are as large as the
    /// deflections.
    fn random_pairs(state: &mut u64) -> PairSet {
        loop {
            let count = 1 + (random(state) * 6.0) as i32;
            let pairs = (0..count).map(|ahead| {
                let stiffness = 0.5 + 2.0 * random(state);
                pair(ahead - 1, stiffness, 2.0 * random(state) - 0.5)
            });
            let pairs: Vec<Pair> = pairs.collect();
            let couplings = (0..count).map(|_| {
                [0.7, 0.4, 0.3].map(|most| most * random(state)).map(|coupling| coupling - 0.05)
            });
            let set = PairSet::new(pairs, couplings);
            if set.is_definite() {
                return set;
            }
        }
    }

    /// Violation of the conditions of the complementarity problem, which has one solution.
    fn violation(set: &PairSet, displacement: f64, forces: &[f64]) -> f64 {
        let rest = |(index, pair): (usize, &Pair)| {
            let own = forces[index] / pair.stiffness;
            let overlap = displacement - pair.gap - own - set.pushed(index, forces);
            let wrong = if forces[index] > 0.0 { overlap.abs() } else { overlap };
            wrong.max(-forces[index])
        };
        set.pairs().iter().enumerate().map(rest).fold(0.0, f64::max)
    }

    #[test]
    fn each_pair_has_either_a_force_or_a_gap() {
        let mut state = 7;
        for round in 0..20_000 {
            let set = random_pairs(&mut state);
            let total = 3.0 * random(&mut state) + 1e-6;
            let (displacement, forces) = set.shared(total);
            let sum: f64 = forces.iter().sum();
            assert!((sum / total - 1.0).abs() < 1e-9, "{round}: {sum} of {total}");
            let off = violation(&set, displacement, &forces);
            assert!(off < 1e-9, "{round}: error {off:e}, {set:?}");
            for (force, expected) in set.forces(displacement).iter().zip(&forces) {
                assert!((force - expected).abs() < 1e-8, "{round}: {force} {expected}");
            }
        }
    }

    #[test]
    fn the_lead_of_a_loaded_pair_is_positive() {
        let mut state = 5;
        for _ in 0..5_000 {
            let set = random_pairs(&mut state);
            let total = random(&mut state) + 1e-3;
            let lead = set.clone().lead(0, total);
            let force = set.balance(total).force;
            let is_close = lead.abs() < 1e-9;
            assert!(is_close || (lead > 0.0) == (force > 0.0), "{lead} {force} {set:?}");
        }
    }

    #[test]
    fn pairs_without_coupling_are_independent_springs() {
        let mut state = 3;
        for _ in 0..2_000 {
            let set = random_pairs(&mut state);
            let total = 2.0 * random(&mut state) + 1e-6;
            let count = set.pairs().len();
            let springs = PairSet::new(set.pairs().to_vec(), []);
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
    fn equal_pairs_share_the_load_equally() {
        let pairs = (0..3).map(|ahead| pair(ahead, 0.5, 0.1));
        let (x, forces) = PairSet::new(pairs, vec![[0.5; PITCHES]; 3]).shared(3.0);
        for force in forces {
            assert!((force - 1.0).abs() < 1e-14, "{force}");
        }
        assert!((x - 3.1).abs() < 1e-14, "{x}");
    }

    #[test]
    fn leads_of_touching_pairs_are_their_forces() {
        let mut state = 11;
        for _ in 0..2_000 {
            let set = random_pairs(&mut state);
            let (x, forces) = set.shared(1.0);
            let carries = forces.iter().enumerate().filter(|(_, force)| **force > 0.0);
            let touching = carries.fold(Touching::NONE, |set, (index, _)| set.with(index));
            let leads = set.leads(touching, x);
            for (index, lead) in leads.iter().enumerate() {
                if touching.has(index) {
                    let force = lead * set.pairs()[index].stiffness;
                    assert!((force - forces[index]).abs() < 1e-9);
                } else {
                    assert!(*lead < 1e-9, "{lead}");
                }
            }
        }
    }

    #[test]
    fn a_guess_of_the_touching_pairs_finds_the_forces_that_the_growing_displacement_finds() {
        let (mut state, mut guessed) = (13, 0);
        for round in 0..5_000 {
            let set = random_pairs(&mut state);
            let own = set.own();
            for until in [
                Until::Total(random(&mut state) + 1e-3),
                Until::Displacement(2.0 * random(&mut state)),
            ] {
                let (expected_x, expected) = set.followed(&own, until);
                if let Some((x, forces)) = set.guessed(&own, until) {
                    guessed += 1;
                    assert!((x - expected_x).abs() < 1e-9, "{round}: {x} {expected_x}");
                    for (force, expected) in forces.iter().zip(&expected) {
                        let off = (force - expected).abs();
                        assert!(off < 1e-8, "{round}: {force} {expected}");
                    }
                }
            }
        }
        assert!(guessed > 9_000, "{guessed} of 10000 guesses");
    }
}
