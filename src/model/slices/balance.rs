//! The balance of a face width: the line load of every pair at every slice.

use super::{Face, Slice};
use crate::model::Refusal;
use crate::model::budget::PAIRS;
use crate::model::pair_forces::PITCHES;
use crate::numeric::banded::Banded;

/// The line loads of all pairs at a position of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Loads {
    /// Path of the incoming pair since E in the middle of the face, in m.
    pub s: f64,
    /// Base pitches by which the first pair is ahead of the incoming one.
    pub first: i32,
    /// Number of pairs.
    pub pairs: usize,
    /// Deviation of the incoming pair, in m.
    error: f64,
    /// Displacement of the driver ahead x, in m.
    pub displacement: f64,
    /// Line load of each pair at each slice, slice by slice, in N/m.
    pub line_loads: Vec<f64>,
    /// Displacement under the loads minus the gap, in m, above 0 where a pair carries.
    pub leads: Vec<f64>,
    /// Gap plus deflection by the pair itself, of each pair at each slice, in m: smooth along the face.
    free: Vec<f64>,
    /// Force that turns the driver, in N.
    pub force: f64,
    /// Change of the force with the displacement, in N/m.
    pub stiffness: f64,
    /// The least and the greatest displacement at which the same slices touch, in m.
    pub alike: (f64, f64),
}

impl Loads {
    /// The line load of a pair at a slice, in N/m.
    pub fn at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead).map_or(0.0, |pair| self.line_loads[slice * self.pairs + pair])
    }

    /// Line load of all pairs at each slice, in N/m.
    pub fn of_all(&self) -> Vec<f64> {
        self.line_loads.chunks(self.pairs.max(1)).map(|of_slice| of_slice.iter().sum()).collect()
    }

    /// The greatest lead of a pair over the face, in m, with the number of its slice.
    pub fn lead(&self, ahead: i32) -> (f64, usize) {
        let Some(pair) = self.index(ahead) else {
            return (f64::NEG_INFINITY, 0);
        };
        let of_pair = self.leads.iter().skip(pair).step_by(self.pairs).enumerate();
        of_pair.fold(
            (f64::NEG_INFINITY, 0),
            |best, (slice, &lead)| {
                if lead > best.0 { (lead, slice) } else { best }
            },
        )
    }

    /// The lead of a pair at a slice, in m.
    pub(super) fn lead_at(&self, ahead: i32, slice: usize) -> f64 {
        self.index(ahead).map_or(f64::NEG_INFINITY, |pair| self.leads[slice * self.pairs + pair])
    }

    fn index(&self, ahead: i32) -> Option<usize> {
        usize::try_from(ahead - self.first).ok().filter(|pair| *pair < self.pairs)
    }

    /// The pairs as base pitches ahead of the incoming pair.
    pub fn pairs(&self) -> impl Iterator<Item = i32> + use<> {
        (self.first..).take(self.pairs)
    }
}

/// What ends the search for a balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Until {
    /// The force that turns the driver, in N.
    Force(f64),
    /// The displacement of the driver ahead, in m.
    Displacement(f64),
}

/// A pair at a slice.
#[derive(Debug, Clone, Copy)]
struct Contact {
    /// Gap, infinite beyond the computed range.
    gap: f64,
    /// Whether the pair can carry here.
    can_carry: bool,
    /// Compliance of the contact, q_c.
    local: f64,
    /// √q_t of the teeth.
    root: f64,
    /// The part of the load that turns the driver.
    weight: f64,
}

/// All pairs at all slices with the incoming pair at a place, to be balanced.
#[derive(Debug, Clone)]
pub(super) struct Position<'a> {
    face: &'a Face,
    s: f64,
    first: i32,
    pairs: usize,
    /// Deviation of the pair that deviates, in m.
    error: f64,
    contacts: Vec<Contact>,
    /// The lower factor C of κ = C Cᵀ, row by row.
    factors: Vec<f64>,
}

impl Face {
    /// The loads with the incoming pair at `s` in the middle of the face and with the deviation
    /// `error`, in m.
    ///
    /// # Errors
    /// Those of `Position::loads`.
    pub fn loads(&self, s: f64, error: f64, until: Until) -> Result<Loads, Refusal> {
        let mut position = self.position(s)?;
        position.deviate(0, error);
        position.loads(until, None)
    }

    /// All pairs without deviations, with the incoming pair at `s` in the middle of the face.
    ///
    /// # Errors
    /// [`Refusal::IndefiniteCompliance`] if neighbouring pairs displace each other too much.
    pub(super) fn position(&self, s: f64) -> Result<Position<'_>, Refusal> {
        let mesh = &self.mesh;
        let (from, to) = mesh.ends();
        let first = ((from - s - self.reach) / mesh.base_pitch).ceil() as i32;
        let last = ((to - s + self.reach) / mesh.base_pitch).floor() as i32;
        let pairs = (last - first + 1).max(0) as usize;
        let mut contacts = Vec::with_capacity(self.slices.len() * pairs);
        for slice in &self.slices {
            for ahead in (first..).take(pairs) {
                let place = s + f64::from(ahead) * mesh.base_pitch + slice.ahead;
                contacts.push(self.contact(slice, place));
            }
        }
        let factors = self.factors(s, first, pairs)?;
        Ok(Position { face: self, s, first, pairs, error: 0.0, contacts, factors })
    }

    /// A pair without deviation at a place of its path in a slice.
    fn contact(&self, slice: &Slice, place: f64) -> Contact {
        /// Least part of the compliance of a pair that is in its contact.
        const LEAST: f64 = 1e-3;
        let mesh = &self.mesh;
        let (zone, kept) = mesh.zone_at(place);
        let [stiffness, gap, lever, sliding] = mesh.values(zone, kept);
        let [driver, driven] = self.teeth[zone].at(kept);
        let compliance = self.inputs.width / stiffness;
        let contact = (compliance - driver - driven).max(LEAST * compliance);
        let teeth = (compliance - contact) * (driver * slice.ends[0] + driven * slice.ends[1])
            / (driver + driven);
        let can_carry = kept.to_bits() == place.to_bits();
        let friction = mesh.friction() * self.inputs.oblique;
        Contact {
            gap: if can_carry { gap + slice.gap } else { f64::INFINITY },
            can_carry,
            local: contact,
            root: teeth.max(0.0).sqrt(),
            weight: 1.0 - friction * sliding.signum() * lever,
        }
    }

    /// The lead of a pair at a place of its path between two slices, the compliance by which its own
    /// load reduces it, and z. `None` if the place is not on the face, or in all slices at once.
    pub(super) fn lead_between(
        &self,
        loads: &Loads,
        ahead: i32,
        path: f64,
    ) -> Option<(f64, f64, f64)> {
        let pair = loads.index(ahead)?;
        let z = (path - loads.s - f64::from(ahead) * self.mesh.base_pitch) / self.inputs.lead;
        let after = self.slices.partition_point(|slice| slice.z < z);
        let before = after.checked_sub(1).filter(|_| after < self.slices.len())?;
        let [one, other] = [before, after].map(|slice| loads.free[slice * loads.pairs + pair]);
        let part = (z - self.slices[before].z) / self.slices[before].step;
        let error = if ahead == 0 { loads.error } else { 0.0 };
        let contact = self.contact(&Slice::at(&self.inputs, z), path);
        let lead = one + part * (other - one) - (contact.gap - error);
        Some((lead, contact.local + self.own(&contact), z))
    }

    /// The line load of a pair at a place of its path between two slices, and z.
    pub(super) fn load_at(&self, loads: &Loads, ahead: i32, path: f64) -> Option<(f64, f64)> {
        let (lead, compliance, z) = self.lead_between(loads, ahead, path)?;
        (lead > 0.0).then_some((lead / compliance, z))
    }

    /// The greatest lead of the incoming tooth before E over the face, in m; infinitely negative if no
    /// slice is before E.
    pub(super) fn lead_before_start(&self, loads: &Loads) -> f64 {
        /// Of the path of contact.
        const INSIDE: f64 = 1e-9;
        let before = |number: &usize| loads.s + self.slices[*number].ahead <= 0.0;
        let at_slices = (0..self.slices.len()).filter(before);
        let leads = at_slices
            .filter_map(|number| Some(loads.leads[number * loads.pairs + loads.index(0)?]));
        let border = self.lead_between(loads, 0, -INSIDE * self.mesh.length);
        leads.chain(border.map(|(lead, ..)| lead)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The part of the compliance of a pair by which its own load deflects the slice alone: without
    /// coupling that of the teeth, too.
    fn own(&self, contact: &Contact) -> f64 {
        if self.inputs.coupling_length > 0.0 { 0.0 } else { contact.root * contact.root }
    }

    /// The lower factor C of κ = C Cᵀ, row by row.
    fn factors(&self, s: f64, first: i32, pairs: usize) -> Result<Vec<f64>, Refusal> {
        let mesh = &self.mesh;
        let mut kappa = vec![0.0; pairs * pairs];
        for rear in 0..pairs {
            kappa[rear * pairs + rear] = 1.0;
            for apart in 1..=PITCHES.min(pairs - 1 - rear) {
                let way = apart as f64 * mesh.base_pitch;
                // Both pairs are as near the middle of the path as on the face.
                let place = s + (f64::from(first) + rear as f64) * mesh.base_pitch;
                let to_middle = 0.5 * (mesh.length - way) - place;
                let place = place + to_middle.clamp(-self.reach, self.reach);
                kappa[(rear + apart) * pairs + rear] = self.neighbour(place, apart);
            }
        }
        for row in 0..pairs {
            for column in 0..=row {
                let before =
                    (0..column).map(|at| kappa[row * pairs + at] * kappa[column * pairs + at]);
                let rest = kappa[row * pairs + column] - before.sum::<f64>();
                kappa[row * pairs + column] = if column < row {
                    rest / kappa[column * pairs + column]
                } else if rest > 0.0 {
                    rest.sqrt()
                } else {
                    return Err(Refusal::IndefiniteCompliance);
                };
            }
        }
        Ok(kappa)
    }

    /// κ of a pair at a place and of the pair `apart` pitches ahead.
    fn neighbour(&self, place: f64, apart: usize) -> f64 {
        let mesh = &self.mesh;
        let ((from, to), way) = (mesh.ends(), apart as f64 * mesh.base_pitch);
        if !mesh.is_coupled() || place < from || place + way > to {
            return 0.0;
        }
        let teeth = |place: f64| {
            let (zone, kept) = mesh.zone_at(place);
            self.teeth[zone].at::<2>(kept).iter().sum::<f64>()
        };
        let mean = (teeth(place) * teeth(place + way)).sqrt();
        mesh.coupling(apart, place) * self.inputs.width / mean
    }
}

impl Position<'_> {
    /// Whether a pair is within the computed range.
    pub(super) fn has(&self, ahead: i32) -> bool {
        usize::try_from(ahead - self.first).is_ok_and(|index| index < self.pairs)
    }

    /// Advances the flanks of a pair by a deviation, in m.
    pub(super) fn deviate(&mut self, ahead: i32, error: f64) {
        self.of_pair(ahead, |_, contact| contact.gap -= error);
        self.error = error;
    }

    /// Lets a pair touch only after E.
    pub(super) fn keep_after_start(&mut self, ahead: i32) {
        let (face, s) = (self.face, self.s + f64::from(ahead) * self.face.mesh.base_pitch);
        self.of_pair(ahead, |slice, contact| {
            contact.can_carry &= s + face.slices[slice].ahead > 0.0;
        });
    }

    fn of_pair(&mut self, ahead: i32, mut change: impl FnMut(usize, &mut Contact)) {
        if self.has(ahead) {
            let index = (ahead - self.first) as usize;
            let of_pair = self.contacts.iter_mut().skip(index).step_by(self.pairs);
            of_pair.enumerate().for_each(|(slice, contact)| change(slice, contact));
        }
    }

    /// The loads of all pairs. The search for the touching slices begins with those of `near`.
    ///
    /// # Formula
    /// ```text
    /// x − gap_k = q_c p_k + √q_tk Σ_j κ_kj u_j  where p_k > 0,   at most that elsewhere
    /// u_j − L² u_j'' = √q_tj p_j,   u_j' = 0 at the ends of the face,   ∫ Σ w_k p_k dz = F0
    /// ```
    /// κ_kj is the displacement of pair k by a load on pair j over the geometric mean of those of
    /// the loaded pairs. The known touching slices give linear equations, symmetric and positive
    /// definite in the coordinates Cᵀ u with C Cᵀ = κ; the slices are corrected until no load and no
    /// overlap contradicts them.
    ///
    /// # Source
    /// The decay along the tooth over L by own finite elements in three dimensions. Active sets:
    /// Hintermüller, Ito & Kunisch 2003, "The primal-dual active set strategy as a semismooth Newton
    /// method".
    ///
    /// # Errors
    /// [`Refusal::BeyondReach`] if a pair beyond the computed gaps may touch.
    pub(super) fn loads(&self, until: Until, near: Option<&Loads>) -> Result<Loads, Refusal> {
        // The length of a matrix row is known to the compiler.
        let loads = match self.pairs {
            ..3 => self.balanced::<3>(until, near),
            3 => self.balanced::<4>(until, near),
            4 => self.balanced::<5>(until, near),
            5 => self.balanced::<6>(until, near),
            6..8 => self.balanced::<8>(until, near),
            8..16 => self.balanced::<16>(until, near),
            _ => self.balanced::<{ PAIRS + 1 }>(until, near),
        };
        let loads = loads.ok_or(Refusal::IndefiniteCompliance)?;
        let lead = loads.displacement - self.face.least_gap + self.error.max(0.0);
        self.face.mesh.check_reach(lead)?;
        Ok(loads)
    }

    /// The displacement at which independent slices balance a force. Begins with all slices, so that
    /// the displacement falls to that of the touching ones.
    fn of_springs(&self, force: f64) -> f64 {
        let springs = self.contacts.iter().enumerate().filter(|(_, contact)| contact.can_carry);
        let mut displacement = f64::INFINITY;
        loop {
            let touching = springs.clone().filter(|(_, contact)| contact.gap < displacement);
            let (stiffness, preload) =
                touching.fold((0.0, force), |(stiffness, preload), (at, contact)| {
                    let width = self.face.slices[at / self.pairs].width;
                    let compliance = contact.local + contact.root * contact.root;
                    let spring = contact.weight * width / compliance;
                    (stiffness + spring, preload + spring * contact.gap)
                });
            let next = preload / stiffness;
            if stiffness <= 0.0 || next >= displacement {
                return displacement;
            }
            displacement = next;
        }
    }

    /// The slices to begin with, and the displacement.
    fn first_guess(&self, until: Until, near: Option<&Loads>) -> (Vec<bool>, f64) {
        let touching = |is_near: &dyn Fn(usize) -> bool| -> Vec<bool> {
            (0..self.contacts.len()).map(|at| self.contacts[at].can_carry && is_near(at)).collect()
        };
        if let Some(near) = near {
            let carried = touching(&|at| {
                near.at(
                    self.first.saturating_add_unsigned((at % self.pairs) as u32),
                    at / self.pairs,
                ) > 0.0
            });
            match until {
                Until::Displacement(displacement) => return (carried, displacement),
                Until::Force(_) if carried.contains(&true) => return (carried, near.displacement),
                Until::Force(_) => {}
            }
        }
        let displacement = match until {
            Until::Force(force) => self.of_springs(force),
            Until::Displacement(displacement) => displacement,
        };
        (touching(&|at| self.contacts[at].gap < displacement), displacement)
    }

    /// The loads at the end of the search; `None` if the compliances are not positive definite.
    fn balanced<const ROW: usize>(&self, until: Until, near: Option<&Loads>) -> Option<Loads> {
        const CORRECTIONS: usize = 40;
        const ONE_BY_ONE: usize = 400;
        let (touching, mut displacement) = self.first_guess(until, near);
        let count = self.contacts.len();
        let mut system = System::<ROW> {
            at: self,
            touching,
            rows: vec![[0.0; ROW]; count],
            sides: vec![[0.0; 2]; count],
        };
        let (mut leads, mut sums) = (vec![[1.0, 0.0]; count], [0.0; 2]);
        let lead = |lines: &[f64; 2], displacement: f64| lines[0] * displacement - lines[1];
        let rounds = if displacement.is_finite() { CORRECTIONS + ONE_BY_ONE } else { 0 };
        for round in 0..rounds {
            system.solve()?;
            sums = system.sums();
            if let Until::Force(force) = until {
                displacement = (force + sums[1]) / sums[0];
            }
            leads = system.leads();
            let touching = &mut system.touching;
            let carries =
                |at: usize| self.contacts[at].can_carry && lead(&leads[at], displacement) > 0.0;
            let mut wrong = (0..count).filter(|&at| carries(at) != touching[at]);
            if round < CORRECTIONS {
                let wrong: Vec<usize> = wrong.collect();
                if wrong.is_empty() {
                    break;
                }
                for at in wrong {
                    touching[at] = !touching[at];
                }
                let is_apart = matches!(until, Until::Force(_)) && !touching.contains(&true);
                let all = (0..count).filter(|&at| is_apart && self.contacts[at].can_carry);
                let lead = |at: usize| lead(&leads[at], displacement);
                let nearest = all.max_by(|&one, &other| lead(one).total_cmp(&lead(other)));
                if let Some(at) = nearest {
                    touching[at] = true;
                }
            } else if let Some(at) = wrong.next() {
                touching[at] = !touching[at];
            } else {
                break;
            }
        }
        let mut alike = (f64::NEG_INFINITY, f64::INFINITY);
        for (lines, _) in leads.iter().zip(&self.contacts).filter(|(_, of)| of.can_carry) {
            let turn = lines[1] / lines[0];
            if turn < displacement {
                alike.0 = turn.max(alike.0);
            } else {
                alike.1 = turn.min(alike.1);
            }
        }
        let leads: Vec<f64> = leads.iter().map(|lines| lead(lines, displacement)).collect();
        let loaded = leads.iter().zip(&self.contacts);
        let line_loads: Vec<f64> = loaded
            .map(|(lead, of)| if of.can_carry { lead.max(0.0) / of.local } else { 0.0 })
            .collect();
        let free = leads.iter().zip(&line_loads).zip(&self.contacts);
        let free = free.map(|((lead, load), of)| lead + of.gap + self.face.own(of) * load);
        Some(Loads {
            s: self.s,
            first: self.first,
            error: self.error,
            pairs: self.pairs,
            displacement,
            free: free.collect(),
            line_loads,
            leads,
            force: sums[0] * displacement - sums[1],
            stiffness: sums[0],
            alike,
        })
    }
}

/// The linear equations of a balance, in the coordinates y = Cᵀ u.
struct System<'a, const ROW: usize> {
    at: &'a Position<'a>,
    touching: Vec<bool>,
    /// Rows of the lower half of the matrix: the diagonal, then the entries before it.
    rows: Vec<[f64; ROW]>,
    /// The right sides, and then the solutions, of the displacement and of the gaps.
    sides: Vec<[f64; 2]>,
}

impl<const ROW: usize> System<'_, ROW> {
    /// L²/step: what a difference of u between a slice and the next takes from one to the other.
    fn exchange(&self, number: usize) -> f64 {
        let (length, step) =
            (self.at.face.inputs.coupling_length, self.at.face.slices[number].step);
        if step > 0.0 { length * length / step } else { 0.0 }
    }

    /// Solves the equations of the touching slices; `None` if the compliances are not positive definite.
    fn solve(&mut self) -> Option<()> {
        let (pairs, mut before) = (self.at.pairs, 0.0);
        for (number, slice) in self.at.face.slices.iter().enumerate() {
            let after = self.exchange(number);
            let of_slice = number * pairs..(number + 1) * pairs;
            let contacts = &self.at.contacts[of_slice.clone()];
            let touching = &self.touching[of_slice.clone()];
            for row in 0..pairs {
                let at = number * pairs + row;
                let entries = &mut self.rows[at];
                *entries = [0.0; ROW];
                entries[0] = slice.width + before + after;
                if number > 0 {
                    entries[pairs] = -before;
                }
                self.sides[at] = [0.0; 2];
            }
            for pair in (0..pairs).filter(|pair| touching[*pair]) {
                let Contact { gap, local, root, .. } = contacts[pair];
                let factors = &self.at.factors[pair * pairs..=pair * pairs + pair];
                let push = slice.width * root / local;
                for (row, factor) in
                    factors.iter().enumerate().filter(|(_, factor)| **factor != 0.0)
                {
                    let at = number * pairs + row;
                    self.sides[at][0] += push * factor;
                    self.sides[at][1] += push * factor * gap;
                    for (column, other) in factors[..=row].iter().enumerate() {
                        self.rows[at][row - column] += push * root * factor * other;
                    }
                }
            }
            before = after;
        }
        Banded::factored(self.rows.iter().copied())?.solve(&mut self.sides);
        Some(())
    }

    /// √q_t (C y)_k of the displacement and of the gaps.
    fn pushed(&self, at: usize) -> [f64; 2] {
        let (pairs, slice, pair) = (self.at.pairs, at / self.at.pairs, at % self.at.pairs);
        let factors = &self.at.factors[pair * pairs..=pair * pairs + pair];
        let sides = &self.sides[slice * pairs..];
        let sum = factors.iter().zip(sides).fold([0.0; 2], |[one, other], (factor, side)| {
            [one + factor * side[0], other + factor * side[1]]
        });
        sum.map(|sum| self.at.contacts[at].root * sum)
    }

    /// Change of the force that turns the driver with the displacement, and the force that the gaps
    /// take.
    fn sums(&self) -> [f64; 2] {
        let touching = (0..self.at.contacts.len()).filter(|&at| self.touching[at]);
        touching.fold([0.0; 2], |[slope, offset], at| {
            let ([moved, kept], contact) = (self.pushed(at), &self.at.contacts[at]);
            let width = self.at.face.slices[at / self.at.pairs].width;
            let spring = contact.weight * width / contact.local;
            [slope + spring * (1.0 - moved), offset + spring * (contact.gap - kept)]
        })
    }

    /// Displacement under the loads minus the gap, of every pair at every slice: its change with the
    /// displacement, and what is taken from that.
    fn leads(&self) -> Vec<[f64; 2]> {
        let lead = |at: usize| {
            let [moved, kept] = self.pushed(at);
            [1.0 - moved, self.at.contacts[at].gap - kept]
        };
        (0..self.at.contacts.len()).map(lead).collect()
    }
}
