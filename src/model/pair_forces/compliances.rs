//! Displacements of pairs by their forces.

use std::array::from_fn;

use crate::model::field::PITCHES;
use crate::numeric::banded::Banded;

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
    #[must_use]
    pub fn at(&self, one: usize, other: usize) -> f64 {
        let (behind, ahead) = (one.min(other), one.max(other));
        match ahead - behind {
            0 => self.own[one],
            distance if distance <= PITCHES => self.couplings[ahead][distance - 1],
            _ => 0.0,
        }
    }

    /// The factors of the matrix of the touching pairs. `None` if it is not positive definite.
    #[must_use]
    pub fn among(&self, touching: &[usize]) -> Option<Banded<ROW>> {
        let entry = |at: usize, distance: usize| {
            let other = at.checked_sub(distance).map(|other| touching[other]);
            other.map_or(0.0, |other| self.at(touching[at], other))
        };
        let rows = (0..touching.len()).map(|at| from_fn(|distance| entry(at, distance)));
        Banded::factored(rows)
    }

    /// Displacement of a pair by unit forces on the other pairs.
    pub(super) fn pushed<const M: usize>(
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
