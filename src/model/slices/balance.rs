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
    /// Change of the force with the displacement, in N/m.
    pub stiffness: f64,
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
    pub fn lead_at(&self, ahead: i32, slice: usize) -> f64 {
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

impl Face {
    /// The loads with the incoming pair at `s` in the middle of the face and with the deviation
    /// `error`, in m. A pair in `without` does not touch.
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
    pub fn loads(
        &self,
        s: f64,
        error: f64,
        until: Until,
        without: Option<i32>,
    ) -> Result<Loads, Refusal> {
        let mesh = &self.mesh;
        let (from, to) = mesh.ends();
        let first = ((from - s - self.reach) / mesh.base_pitch).ceil() as i32;
        let last = ((to - s + self.reach) / mesh.base_pitch).floor() as i32;
        let pairs = (last - first + 1).max(0) as usize;
        let contacts = self.contacts((s, error), first, pairs, without);
        let factors = self.factors(s, first, pairs)?;
        let system = (self, &contacts[..], &factors[..], pairs);
        // The length of a matrix row is known to the compiler.
        let loads = match pairs {
            ..3 => balanced::<3>(system, until),
            3 => balanced::<4>(system, until),
            4 => balanced::<5>(system, until),
            5 => balanced::<6>(system, until),
            6..8 => balanced::<8>(system, until),
            8..16 => balanced::<16>(system, until),
            _ => balanced::<{ PAIRS + 1 }>(system, until),
        };
        let loads = loads.ok_or(Refusal::IndefiniteCompliance)?;
        let lead = loads.displacement - self.least_gap + error.max(0.0);
        mesh.check_reach(lead)?;
        Ok(Loads { s, first, error, ..loads })
    }

    fn contacts(
        &self,
        (s, error): (f64, f64),
        first: i32,
        pairs: usize,
        without: Option<i32>,
    ) -> Vec<Contact> {
        let mut contacts = Vec::with_capacity(self.slices.len() * pairs);
        for slice in &self.slices {
            for ahead in (first..).take(pairs) {
                let error = if ahead == 0 { error } else { 0.0 };
                let place = s + f64::from(ahead) * self.mesh.base_pitch + slice.ahead;
                let contact = self.contact(slice, place, error);
                let can_carry = contact.can_carry && without != Some(ahead);
                contacts.push(Contact { can_carry, ..contact });
            }
        }
        contacts
    }

    /// A pair with a deviation at a place of its path in a slice.
    fn contact(&self, slice: &Slice, place: f64, error: f64) -> Contact {
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
            gap: if can_carry { gap + slice.gap - error } else { f64::INFINITY },
            can_carry,
            local: contact,
            root: teeth.max(0.0).sqrt(),
            weight: 1.0 - friction * sliding.signum() * lever,
        }
    }

    /// The line load of a pair at a place of its path between two slices, and z. `None` if the place is
    /// not on the face, or in all slices at once.
    pub(super) fn load_at(&self, loads: &Loads, ahead: i32, path: f64) -> Option<(f64, f64)> {
        let pair = loads.index(ahead)?;
        let z = (path - loads.s - f64::from(ahead) * self.mesh.base_pitch) / self.inputs.lead;
        let after = self.slices.partition_point(|slice| slice.z < z);
        let before = after.checked_sub(1).filter(|_| after < self.slices.len())?;
        let [one, other] = [before, after].map(|slice| loads.free[slice * loads.pairs + pair]);
        let part = (z - self.slices[before].z) / self.slices[before].step;
        let error = if ahead == 0 { loads.error } else { 0.0 };
        let contact = self.contact(&Slice::at(&self.inputs, z), path, error);
        let lead = one + part * (other - one) - contact.gap;
        let line_load = lead / (contact.local + self.own(&contact));
        (line_load > 0.0).then_some((line_load, z))
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

/// The linear equations of a balance, in the coordinates y = Cᵀ u.
struct System<'a, const ROW: usize> {
    face: &'a Face,
    contacts: &'a [Contact],
    factors: &'a [f64],
    pairs: usize,
    touching: Vec<bool>,
    /// Rows of the lower half of the matrix: the diagonal, then the entries before it.
    rows: Vec<[f64; ROW]>,
    /// The right sides, and then the solutions, of the displacement and of the gaps.
    sides: Vec<[f64; 2]>,
}

/// The loads of a face with contacts, factors and number of pairs.
fn balanced<const ROW: usize>(
    (face, contacts, factors, pairs): (&Face, &[Contact], &[f64], usize),
    until: Until,
) -> Option<Loads> {
    let mut system = System::<ROW> {
        face,
        contacts,
        factors,
        pairs,
        touching: vec![false; contacts.len()],
        rows: vec![[0.0; ROW]; contacts.len()],
        sides: vec![[0.0; 2]; contacts.len()],
    };
    system.balanced(until)
}

impl<const ROW: usize> System<'_, ROW> {
    /// The loads at the end of the search; `None` if the compliances are not positive definite.
    fn balanced(&mut self, until: Until) -> Option<Loads> {
        const CORRECTIONS: usize = 40;
        const ONE_BY_ONE: usize = 400;
        let mut displacement = match until {
            Until::Force(force) => self.of_springs(force),
            Until::Displacement(displacement) => displacement,
        };
        for (touching, contact) in self.touching.iter_mut().zip(self.contacts) {
            *touching = contact.can_carry && contact.gap < displacement;
        }
        let (mut leads, mut stiffness) = (vec![f64::INFINITY; self.contacts.len()], 0.0);
        let rounds = if displacement.is_finite() { CORRECTIONS + ONE_BY_ONE } else { 0 };
        for round in 0..rounds {
            self.solve()?;
            let sums = self.sums();
            stiffness = sums[0];
            if let Until::Force(force) = until {
                displacement = (force + sums[1]) / sums[0];
            }
            leads = self.leads(displacement);
            let carries =
                leads.iter().zip(self.contacts).map(|(lead, of)| of.can_carry && *lead > 0.0);
            let pairs = carries.zip(&self.touching).enumerate();
            let mut wrong = pairs.filter(|(_, (carries, touching))| carries != *touching);
            if round < CORRECTIONS {
                let wrong: Vec<usize> = wrong.map(|(at, _)| at).collect();
                if wrong.is_empty() {
                    break;
                }
                for at in wrong {
                    self.touching[at] = !self.touching[at];
                }
                if !self.touching.contains(&true) {
                    let all = (0..leads.len()).filter(|&at| self.contacts[at].can_carry);
                    let nearest = all.max_by(|&one, &other| leads[one].total_cmp(&leads[other]));
                    if let Some(at) = nearest {
                        self.touching[at] = true;
                    }
                }
            } else if let Some((at, _)) = wrong.next() {
                self.touching[at] = !self.touching[at];
            } else {
                break;
            }
        }
        let loaded = leads.iter().zip(self.contacts);
        let line_loads: Vec<f64> = loaded
            .map(|(lead, of)| if of.can_carry { lead.max(0.0) / of.local } else { 0.0 })
            .collect();
        let free = leads.iter().zip(&line_loads).zip(self.contacts);
        let free = free.map(|((lead, load), of)| lead + of.gap + self.face.own(of) * load);
        Some(Loads {
            s: 0.0,
            first: 0,
            error: 0.0,
            pairs: self.pairs,
            displacement,
            free: free.collect(),
            line_loads,
            leads,
            stiffness,
        })
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

    /// L²/step: what a difference of u between a slice and the next takes from one to the other.
    fn exchange(&self, number: usize) -> f64 {
        let (length, step) = (self.face.inputs.coupling_length, self.face.slices[number].step);
        if step > 0.0 { length * length / step } else { 0.0 }
    }

    /// Solves the equations of the touching slices; `None` if the compliances are not positive definite.
    fn solve(&mut self) -> Option<()> {
        let (pairs, mut before) = (self.pairs, 0.0);
        for (number, slice) in self.face.slices.iter().enumerate() {
            let after = self.exchange(number);
            let of_slice = number * pairs..(number + 1) * pairs;
            let contacts = &self.contacts[of_slice.clone()];
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
                let factors = &self.factors[pair * pairs..=pair * pairs + pair];
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
        let (pairs, slice, pair) = (self.pairs, at / self.pairs, at % self.pairs);
        let factors = &self.factors[pair * pairs..=pair * pairs + pair];
        let sides = &self.sides[slice * pairs..];
        let sum = factors.iter().zip(sides).fold([0.0; 2], |[one, other], (factor, side)| {
            [one + factor * side[0], other + factor * side[1]]
        });
        sum.map(|sum| self.contacts[at].root * sum)
    }

    /// Change of the force that turns the driver with the displacement, and the force that the gaps
    /// take.
    fn sums(&self) -> [f64; 2] {
        let touching = (0..self.contacts.len()).filter(|&at| self.touching[at]);
        touching.fold([0.0; 2], |[slope, offset], at| {
            let ([moved, kept], contact) = (self.pushed(at), &self.contacts[at]);
            let width = self.face.slices[at / self.pairs].width;
            let spring = contact.weight * width / contact.local;
            [slope + spring * (1.0 - moved), offset + spring * (contact.gap - kept)]
        })
    }

    /// Displacement under the loads minus the gap, of every pair at every slice.
    fn leads(&self, displacement: f64) -> Vec<f64> {
        let lead = |at: usize| {
            let [moved, kept] = self.pushed(at);
            displacement * (1.0 - moved) - (self.contacts[at].gap - kept)
        };
        (0..self.contacts.len()).map(lead).collect()
    }
}
