//! Displacement and forces of coupled pairs: a linear complementarity problem.

use smallvec::smallvec;

use super::{OfPairs, PairSet, Touching, at};

/// End condition of the search upwards from the first touch.
#[derive(Debug, Clone, Copy)]
pub(super) enum Until {
    /// The sum of the forces that turn the driver, in N.
    Total(f64),
    /// The displacement, in m.
    Displacement(f64),
}

/// For a fixed set of touching pairs: force (or, for a pair without contact, lead in m) = slope x −
/// offset.
pub(super) struct Lines {
    pub(super) touching: OfPairs<usize>,
    /// Slope and offset of each touching pair's force.
    pub(super) forces: OfPairs<[f64; 2]>,
}

impl PairSet {
    /// Displacement and forces at the end condition.
    pub(super) fn solved(&self, until: Until) -> (f64, OfPairs<f64>) {
        let own = self.own();
        self.guessed(&own, until).unwrap_or_else(|| self.followed(&own, until))
    }

    /// Guesses the touching pairs from independent springs and corrects the guess until no force
    /// and no overlap contradicts it. `None` if this takes more corrections than usual. The
    /// compliances are positive definite, so that no other set of pairs meets the conditions.
    pub(super) fn guessed(&self, own: &[f64], until: Until) -> Option<(f64, OfPairs<f64>)> {
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
    pub(super) fn followed(&self, own: &[f64], until: Until) -> (f64, OfPairs<f64>) {
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
    pub(super) fn lines(&self, own: &[f64], touching: Touching) -> Option<Lines> {
        let touching: OfPairs<usize> = touching.pairs().collect();
        let factored = self.compliances(own).among(&touching)?;
        let mut forces: OfPairs<[f64; 2]> =
            touching.iter().map(|&index| [1.0, self.pairs[index].gap]).collect();
        factored.solve(&mut forces);
        Some(Lines { touching, forces })
    }

    /// The overlap x − gap − Σ Q_kj F_j of a pair without contact, as slope and offset over x.
    pub(super) fn apart(&self, own: &[f64], lines: &Lines, index: usize) -> [f64; 2] {
        let [slope, offset] = self.compliances(own).pushed(index, &lines.touching, &lines.forces);
        [1.0 - slope, self.pairs[index].gap - offset]
    }
}
