//! The equations of the touching slices.

use super::{Contact, Position};
use crate::model::pair_forces::PITCHES;
use crate::model::slices::carried::Carried;
use crate::numeric::banded::{Banded, Rows};
use smallvec::smallvec;

/// The equations of the touching slices in the coordinates y = Cᵀ u, one for each active pair. A
/// coordinate is solved for from the first to the last slice at which a load acts on it, and decays
/// beyond. Each slice has a block of slots, which coordinates far apart along the face share.
pub(super) struct System<'a> {
    at: &'a Position<'a>,
    carried: &'a [Carried],
    factors: Vec<f64>,
    /// The first and the last slice of each coordinate.
    spans: Vec<(usize, usize)>,
    /// Least number of slots with which no two coordinates share one at a slice.
    pub(super) slots: usize,
}

impl<'a> System<'a> {
    /// `None` if κ is not positive definite.
    pub(super) fn new(
        at: &'a Position<'a>,
        active: &[usize],
        carried: &'a [Carried],
    ) -> Option<System<'a>> {
        let (count, factors) = (active.len(), factors(at, active)?);
        let mut spans = vec![(usize::MAX, 0); count];
        for &pair in active {
            let touches = |of: &(usize, usize)| carried[of.1].touches();
            let first = at.pairs.of(pair).find(touches)?.0;
            let last = at.pairs.of(pair).rev().find(touches)?.0;
            let of_factor = spans.iter_mut().zip(&factors[pair * count..]);
            for (span, _) in of_factor.filter(|(_, factor)| **factor != 0.0) {
                *span = (span.0.min(first), span.1.max(last));
            }
        }
        let reach = |(one, span): (usize, &(usize, usize))| {
            let meets = |other: &&(usize, usize)| other.0 <= span.1 && span.0 <= other.1;
            spans[one..].iter().rposition(|other| meets(&other)).map_or(1, |last| last + 1)
        };
        let slots = spans.iter().enumerate().map(reach).max().unwrap_or(1);
        Some(System { at, carried, factors, spans, slots })
    }

    /// ε/(1 + ε).
    fn taken(&self) -> f64 {
        self.at.face.excess / (1.0 + self.at.face.excess)
    }

    /// f of `Face::new` at a slice: what v takes from it, and f without v, by the displacement of the
    /// driver and by the gaps.
    ///
    /// # Formula
    /// ```text
    /// p_k = (lead_k − c_k·u)/q_ck,   f = Σ p_k c_k,   u = v − τ f,   τ = ε/(1 + ε),   c_k = root_k C_k
    /// ```
    /// Each pair adds a aᵀ/q to the first, with a = c + τ F c by F of the pairs before and
    /// q = q_c − τ c·a.
    fn loads<const SLOTS: usize>(
        &self,
        number: usize,
        in_slots: &[[f64; SLOTS]],
    ) -> ([[f64; SLOTS]; SLOTS], [[f64; 2]; SLOTS]) {
        let (mut loads, mut without) = ([[0.0; SLOTS]; SLOTS], [[0.0; 2]; SLOTS]);
        let slots = self.at.pairs.slots;
        let here = self.at.contacts.iter().zip(self.carried).skip(number * slots).take(slots);
        for (of, &Carried { part, rest, .. }) in here.filter(|(_, carried)| carried.touches()) {
            let (mut all, mut lead) =
                (in_slots[of.pair].map(|factor| factor * of.root), [1.0, of.mean - rest / part]);
            let (own, mut compliance) = (all, of.local / part);
            for slot in 0..SLOTS {
                let taken = self.taken() * own[slot];
                for (all, known) in all.iter_mut().zip(&loads[slot]) {
                    *all += taken * known;
                }
                for (lead, known) in lead.iter_mut().zip(&without[slot]) {
                    *lead += taken * known;
                }
            }
            for (all, own) in all.iter().zip(own) {
                compliance -= self.taken() * own * all;
            }
            for slot in 0..SLOTS {
                let push = all[slot] / compliance;
                for (known, all) in loads[slot].iter_mut().zip(&all) {
                    *known += push * all;
                }
                for (known, lead) in without[slot].iter_mut().zip(lead) {
                    *known += push * lead;
                }
            }
        }
        (loads, without)
    }

    /// See [`Position::lines`]. `ROW` is `SLOTS` + 1.
    pub(super) fn lines<const SLOTS: usize, const ROW: usize>(&self) -> Option<Vec<[f64; 2]>> {
        let (slices, count) = (&self.at.face.slices, self.spans.len());
        let in_slots = |factors: &[f64]| {
            let mut slots = [0.0; SLOTS];
            let known = factors.iter().enumerate().filter(|(_, factor)| **factor != 0.0);
            known.for_each(|(coordinate, factor)| slots[coordinate % SLOTS] = *factor);
            slots
        };
        let in_slots: Vec<_> = self.factors.chunks(count).map(in_slots).collect();
        let mut empty = [0.0; ROW];
        empty[0] = 1.0;
        let mut rows: Rows<f64, ROW> = smallvec![empty; slices.len() * SLOTS];
        let mut sides = vec![[0.0; 2]; slices.len() * SLOTS];
        for (coordinate, &(first, last)) in self.spans.iter().enumerate() {
            for (number, slice) in slices.iter().enumerate().take(last + 1).skip(first) {
                let row = &mut rows[number * SLOTS + coordinate % SLOTS];
                let [before, after] = slice.exchange;
                row[0] = slice.width + before + after;
                if number == first {
                    row[0] -= before * slice.tail[0];
                } else {
                    row[SLOTS] = -before;
                }
                if number == last {
                    row[0] -= after * slice.tail[1];
                }
            }
        }
        let blocks = rows.as_chunks_mut().0.iter_mut().zip(sides.as_chunks_mut().0);
        for ((number, slice), (block, sides)) in slices.iter().enumerate().zip(blocks) {
            let (block, sides): (&mut [[f64; ROW]; SLOTS], &mut [[f64; 2]; SLOTS]) = (block, sides);
            let (loads, without) = self.loads(number, &in_slots);
            for slot in 0..SLOTS {
                sides[slot] = without[slot].map(|load| slice.width * load);
                for other in 0..=slot {
                    block[slot][slot - other] += slice.width * loads[slot][other];
                }
            }
        }
        Banded::<ROW>::of(rows)?.solve(&mut sides);
        let line = |contact: &Contact| [1.0, contact.mean];
        let mut lines: Vec<[f64; 2]> = self.at.contacts.iter().map(line).collect();
        let mut all = vec![[0.0; 2]; slices.len()];
        for (coordinate, &(first, last)) in self.spans.iter().enumerate() {
            let factor = |pair: usize| self.factors[pair * count + coordinate];
            let moved = (0..self.at.pairs.slices.len()).filter(|&pair| factor(pair) != 0.0);
            let ranges = moved.clone().map(|pair| &self.at.pairs.slices[pair]);
            let ends = ranges.filter(|range| !range.is_empty());
            let beside = (last + 2).min(slices.len());
            let (from, to) = ends.fold((first, beside), |(from, to), range| {
                (from.min(range.start), to.max(range.end))
            });
            for number in first..=last {
                all[number] = sides[number * SLOTS + coordinate % SLOTS];
            }
            for number in (from.max(1)..=first).rev() {
                let decay = slices[number].tail[0];
                all[number - 1] = all[number].map(|value| decay * value);
            }
            for number in last + 1..to {
                let decay = slices[number - 1].tail[1];
                all[number] = all[number - 1].map(|value| decay * value);
            }
            // From v to u, f by the equation of v.
            let mut before = all[first.saturating_sub(1)];
            for number in first..=last {
                let (slice, here) = (&slices[number], all[number]);
                let after = all[(number + 1).min(slices.len() - 1)];
                let [one, other] = slice.exchange.map(|exchange| exchange / slice.width);
                all[number] = std::array::from_fn(|column| {
                    let here = here[column];
                    let load =
                        here + one * (here - before[column]) + other * (here - after[column]);
                    here - self.taken() * load
                });
                before = here;
            }
            for pair in moved {
                for (slice, at) in self.at.pairs.of(pair) {
                    let push = self.at.contacts[at].root * factor(pair);
                    lines[at] =
                        std::array::from_fn(|column| lines[at][column] - push * all[slice][column]);
                }
            }
        }
        Some(lines)
    }
}

/// Row by row the factor C of κ = C Cᵀ of the active pairs, and the rows that the other pairs have
/// with it. `None` if κ is not positive definite.
fn factors(at: &Position<'_>, active: &[usize]) -> Option<Vec<f64>> {
    let (pairs, count) = (at.pairs.slices.len(), active.len());
    let mut factors = vec![0.0; pairs * count];
    for (column, &own) in active.iter().enumerate() {
        let rest = |factors: &[f64], pair: usize| {
            let known = factors[pair * count..].iter().zip(&factors[own * count..]);
            let known = known.take(column).skip(column.saturating_sub(PITCHES));
            let known = known.map(|(one, other)| one * other);
            at.kappa[pair * pairs + own] - known.sum::<f64>()
        };
        let square = rest(&factors, own);
        if square <= 0.0 || square.is_nan() {
            return None;
        }
        for pair in (0..pairs).filter(|pair| !active[..column].contains(pair)) {
            factors[pair * count + column] = rest(&factors, pair) / square.sqrt();
        }
    }
    Some(factors)
}
