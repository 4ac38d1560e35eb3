//! The tooth pairs at one position of the mesh and their forces.

mod complementarity;
mod compliances;
#[cfg(test)]
mod tests;
mod touching;

use smallvec::SmallVec;

pub use super::field::PITCHES;
use complementarity::Until;
pub use compliances::Compliances;
pub use touching::Touching;

/// A value of each pair, without heap for as many pairs as usual.
pub type OfPairs<T> = SmallVec<[T; 4]>;

/// The contact place of a pair in the mesh.
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
    #[must_use]
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
    #[must_use]
    pub fn new(
        pairs: impl IntoIterator<Item = Pair>,
        couplings: impl IntoIterator<Item = [f64; PITCHES]>,
    ) -> PairSet {
        PairSet { pairs: pairs.into_iter().collect(), couplings: couplings.into_iter().collect() }
    }

    /// The pairs, the rearmost first.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// The pairs without their gaps.
    #[must_use]
    pub fn of_no_gap(mut self) -> PairSet {
        for pair in &mut self.pairs {
            pair.gap = 0.0;
        }
        self
    }

    /// The pairs with wider gaps. `more` gives the addition in m for the base pitches that a pair
    /// is ahead.
    #[must_use]
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
    #[must_use]
    pub fn balance(&self, force: f64) -> Balance {
        let incoming = self.pairs.iter().position(|pair| pair.ahead == 0);
        if self.couplings.is_empty() {
            let displacement = self.of_springs(force);
            let force = |pair: &Pair| pair.alone(displacement);
            let lead = |incoming: usize| displacement - self.pairs[incoming].gap;
            return Balance {
                displacement,
                force: incoming.map_or(0.0, |incoming| force(&self.pairs[incoming])),
                total: self.pairs.iter().map(force).sum(),
                lead: Some(incoming.map_or(f64::NEG_INFINITY, lead)).filter(|lead| *lead <= 0.0),
                carrying: self.carrying(|index| displacement > self.pairs[index].gap),
            };
        }
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
            carrying: self.carrying(|index| forces[index] > 0.0),
        }
    }

    fn carrying(&self, carries: impl Fn(usize) -> bool) -> Carrying {
        let pairs = (0..self.pairs.len()).filter(|&index| carries(index));
        Carrying {
            first: self.pairs.first().map_or(0, |pair| pair.ahead),
            touching: pairs.fold(Touching::NONE, Touching::with),
        }
    }

    /// Displacement of the driver ahead, in m, and the force of each pair, in N, in the balance.
    #[must_use]
    pub fn shared(&self, force: f64) -> (f64, OfPairs<f64>) {
        if self.couplings.is_empty() {
            let displacement = self.of_springs(force);
            return (displacement, self.forces(displacement));
        }
        self.solved(Until::Total(force))
    }

    /// The force of each pair at a displacement of the driver ahead, in N.
    #[must_use]
    pub fn forces(&self, displacement: f64) -> OfPairs<f64> {
        if self.couplings.is_empty() {
            return self.pairs.iter().map(|pair| pair.alone(displacement)).collect();
        }
        self.solved(Until::Displacement(displacement)).1
    }

    /// How far the displacement under the other pairs' forces exceeds a pair's gap, in m. Above 0
    /// the pair carries.
    #[must_use]
    pub fn lead(mut self, ahead: i32, force: f64) -> f64 {
        let Some(index) = self.pairs.iter().position(|pair| pair.ahead == ahead) else {
            return f64::NEG_INFINITY;
        };
        // An infinite gap removes the pair from the contact but keeps the pitches of the others.
        let gap = std::mem::replace(&mut self.pairs[index].gap, f64::INFINITY);
        if self.couplings.is_empty() {
            return self.of_springs(force) - gap;
        }
        let (displacement, forces) = self.shared(force);
        displacement - gap - self.pushed(index, &forces)
    }

    /// The overlap x − gap − Σ Q_kj F_j of each pair, in m, if exactly these pairs touch. A
    /// positive value means that a touching pair has a force, or that another pair would overlap.
    #[must_use]
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
    #[must_use]
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
    #[must_use]
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
