//! The balance of a face width: the line load of every pair at every slice.

mod equations;

use std::rc::Rc;

use self::equations::System;
use super::carried::Carried;
use super::loads::{Loads, Pairs};
use super::{Face, Slice};
use crate::model::Refusal;
use crate::model::budget::PAIRS;
use crate::model::pair_forces::PITCHES;
use smallvec::SmallVec;

/// Usual precision of a balance: that of a lead over the displacement. A slice has a small part of the
/// load, so that force and displacement are more precise. Searches compare loads at places beside
/// each other.
pub(super) const PRECISE: f64 = 1e-10;

/// What ends the search for a balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Until {
    /// The force that turns the driver, in N.
    Force(f64),
    /// The displacement of the driver ahead, in m.
    Displacement(f64),
}

/// What differs at the incoming pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Incoming {
    /// It is like the others.
    Alike,
    /// It has this deviation, in m.
    Deviates(f64),
    /// It has the deviation, and touches only after E.
    AfterStart(f64),
    /// It has the deviation, and touches only before B.
    BeforeEnd(f64),
}

impl Incoming {
    /// Changes a pair without deviation.
    pub(super) fn change(self, position: &mut Position<'_>, ahead: i32) {
        let (Incoming::Deviates(error) | Incoming::AfterStart(error) | Incoming::BeforeEnd(error)) =
            self
        else {
            return;
        };
        let Some(pair) = position.pairs.index(ahead) else {
            return;
        };
        let path = position.s + f64::from(ahead) * position.face.mesh.base_pitch;
        position.error = error;
        let length = position.face.mesh.length;
        for (slice, at) in position.pairs.of(pair) {
            let (slice, contact) = (&position.face.slices[slice], &mut position.contacts[at]);
            (contact.gap, contact.mean) = (contact.gap - error, contact.mean - error);
            let path = path + slice.ahead;
            contact.can_carry &= match self {
                Incoming::AfterStart(_) => path > 0.0,
                Incoming::BeforeEnd(_) => path < length,
                _ => true,
            };
        }
    }
}

/// A part of a slice between edges of the section and the place where an end relief begins.
#[derive(Debug, Clone, Copy)]
struct Side {
    /// Its part of the slice, and its middle, from −1 to 1 along the slice.
    part: f64,
    middle: f64,
    /// Mean of the gap less that of the slice, its rise and its bend, in m.
    mean: f64,
    rise: f64,
    bend: f64,
    /// Compliance of the contact in the slice over that here.
    ratio: f64,
}

type Sides = SmallVec<[Side; 3]>;

/// Means of the sections between two places that are so far apart, by their integrals.
fn means(one: &[f64; 6], other: &[f64; 6], way: f64) -> [f64; 5] {
    std::array::from_fn(|at| (other[at + 1] - one[at + 1]) / way)
}

/// c of the parabola ḡ + a t + c (t² − 1/3) with the values at its ends t = −1 and 1.
fn bend(ends: [f64; 2], mean: f64) -> f64 {
    1.5 * (f64::midpoint(ends[0], ends[1]) - mean)
}

/// A pair at a slice.
#[derive(Debug, Clone, Copy)]
struct Contact {
    /// The number of the pair.
    pair: usize,
    /// Width of the slice.
    width: f64,
    /// Gap, infinite beyond the computed pairs.
    gap: f64,
    /// Its mean over the slice, and its rise and its bend from one border to the other.
    mean: f64,
    rise: f64,
    bend: f64,
    /// The number of its sides, if it has more than one.
    sides: Option<usize>,
    /// Whether the pair can carry here.
    can_carry: bool,
    /// Compliance of the contact, q_c.
    local: f64,
    /// Means over the slice of the compliances of the driver's and the driven tooth in the middle of the
    /// face.
    teeth: [f64; 2],
    /// √(1 + ε) √q_t of the teeth.
    root: f64,
    /// The part of the load that turns the driver.
    weight: f64,
}

impl Contact {
    /// A pair beyond the computed pairs.
    const NONE: Contact = Contact {
        pair: 0,
        width: 0.0,
        gap: f64::INFINITY,
        mean: f64::INFINITY,
        rise: 0.0,
        bend: 0.0,
        sides: None,
        can_carry: false,
        local: 1.0,
        teeth: [0.0; 2],
        root: 0.0,
        weight: 1.0,
    };

    /// What carries with a mean lead, and its rise by the displacement of the teeth over the slice.
    fn carried(&self, sides: &[Sides], mean: f64, rise: f64) -> Carried {
        let Some(sides) = self.sides.and_then(|number| sides.get(number)) else {
            return Carried::of(mean, 0.5 * (rise - self.rise), -self.bend);
        };
        sides.iter().fold(Carried::NONE, |sum, side| {
            let aside = 0.5 * rise * side.middle - side.mean;
            let half_rise = 0.5 * (rise * side.part - side.rise);
            let of = Carried::of(mean + aside, half_rise, -side.bend);
            let share = side.part * side.ratio;
            Carried {
                part: sum.part + share * of.part,
                rest: sum.rest + share * (of.part * aside + of.rest),
                change: sum.change + share * of.change,
            }
        })
    }
}

/// All pairs at all slices with the incoming pair at a place, to be balanced.
#[derive(Debug, Clone)]
pub(super) struct Position<'a> {
    face: &'a Face,
    s: f64,
    pairs: Rc<Pairs>,
    /// Deviation of the pair that deviates, in m.
    error: f64,
    /// The pairs slice by slice.
    contacts: Vec<Contact>,
    /// The sides of the slices with more than one.
    sides: Vec<Sides>,
    /// κ, row by row.
    kappa: Vec<f64>,
}

impl Face {
    /// The loads with the incoming pair at `s` in the middle of the face and with the deviation
    /// `error`, in m.
    ///
    /// # Errors
    /// Those of `Position::loads`.
    pub fn loads(&self, s: f64, error: f64, until: Until) -> Result<Loads, Refusal> {
        let mut position = self.position(s);
        Incoming::Deviates(error).change(&mut position, 0);
        position.loads(until, &[], PRECISE)
    }

    /// All pairs without deviations, with the incoming pair at `s` in the middle of the face.
    pub(super) fn position(&self, s: f64) -> Position<'_> {
        let mesh = &self.mesh;
        let (from, to) = mesh.ends();
        let first = ((from - s - self.reach) / mesh.base_pitch).ceil() as i32;
        let last = ((to - s + self.reach) / mesh.base_pitch).floor() as i32;
        let path = |ahead: i32| s + f64::from(ahead) * mesh.base_pitch;
        let slices = |ahead: i32| {
            let place = |slice: &Slice| path(ahead) + slice.ahead;
            let is_before = |slice: &Slice| match self.inputs.lead {
                lead if lead < 0.0 => place(slice) > to,
                _ => place(slice) < from,
            };
            let is_beyond = |slice: &Slice| !(from..=to).contains(&place(slice));
            let begin = self.slices.partition_point(is_before);
            begin..begin + self.slices[begin..].partition_point(|slice| !is_beyond(slice))
        };
        // Two pairs in the same slot are a base pitch apart from each other's pairs.
        let most = ((to - from) / mesh.base_pitch) as usize + 2;
        let slices: Vec<_> = (first..=last).map(slices).collect();
        let pairs = Pairs { first, slots: slices.len().min(most), slices };
        let (mut contacts, mut sides) =
            (vec![Contact::NONE; self.slices.len() * pairs.slots], Vec::new());
        for (pair, ahead) in (first..=last).enumerate() {
            let mut before = None;
            for (slice, at) in pairs.of(pair) {
                let of = self.contact(&self.slices[slice], path(ahead), before, &mut sides);
                (contacts[at], before) = (Contact { pair, ..of.0 }, Some(of.1));
            }
        }
        for slot in 0..pairs.slots {
            self.deflect(&mut contacts, (slot, pairs.slots));
        }
        let kappa = self.kappa(s, first, pairs.slices.len());
        Position { face: self, s, pairs: Rc::new(pairs), error: 0.0, contacts, sides, kappa }
    }

    /// A pair without deviation in a slice, with the middle of the face at a place of its path, and the
    /// sections at the border to the next slice, which are those `before` it. Its sides are added to the
    /// `sides`. The means over the slice keep the ends of the path and of reliefs from exciting as they
    /// pass a slice.
    fn contact(
        &self,
        slice: &Slice,
        path: f64,
        before: Option<[f64; 6]>,
        sides: &mut Vec<Sides>,
    ) -> (Contact, [f64; 6]) {
        /// Of a base pitch: below it, a difference of integrals has too few digits.
        const NARROW: f64 = 1e-6;
        let (mesh, place) = (&self.mesh, path + slice.ahead);
        let (from, to) = mesh.ends();
        let borders = slice.borders.map(|z| (path + z * self.inputs.lead).clamp(from, to));
        let one: [f64; 6] = before.unwrap_or_else(|| self.sections.at(borders[0]));
        let other: [f64; 6] = self.sections.at(borders[1]);
        let way = borders[1] - borders[0];
        let is_narrow = way.abs() < NARROW * mesh.base_pitch;
        let here = is_narrow.then(|| self.section(place));
        let means = here.unwrap_or_else(|| means(&one, &other, way));
        let (mean, local) = (means[0], means[1]);
        let (ends, gaps) = ([one, other], slice.border_gaps);
        let found = self.sides(slice, borders, ends, (here, means));
        let contact = Contact {
            pair: 0,
            width: slice.width,
            gap: self.sections.one(0, place) + slice.gap,
            mean: mean + slice.mean_gap,
            rise: other[0] - one[0] + gaps[1] - gaps[0],
            bend: bend([one[0] + gaps[0], other[0] + gaps[1]], mean + slice.mean_gap),
            sides: found.as_ref().map(|_| sides.len()),
            can_carry: true,
            local,
            teeth: [means[2], means[3]],
            root: 0.0,
            weight: 1.0 - mesh.friction() * self.inputs.oblique * means[4],
        };
        sides.extend(found);
        (contact, other)
    }

    /// The compliance of the teeth of the pairs in a slot in each slice, where it changes along the path and
    /// towards the ends of the face at once.
    fn deflect(&self, contacts: &mut [Contact], (slot, slots): (usize, usize)) {
        let known = |contacts: &[Contact], at: usize| {
            let contact = contacts.get(at * slots + slot)?;
            contact.can_carry.then_some((contact.teeth, contact.width))
        };
        let mut before = None;
        for (at, slice) in self.slices.iter().enumerate() {
            let own = known(contacts, at);
            if let Some((teeth, width)) = own {
                // Without a slice beside it, from the middle of the own one.
                let beside = [before, known(contacts, at + 1)];
                let [first, last] = beside.map(|beside| beside.unwrap_or((teeth, -width)));
                let way = width + 0.5 * (first.1 + last.1);
                let part = if way > 0.0 { width / way } else { 0.0 };
                let changes = [0, 1].map(|gear| (last.0[gear] - first.0[gear]) * part);
                contacts[at * slots + slot].root = self.root(slice.teeth(teeth, changes));
            }
            before = own;
        }
    }

    /// The parts of a slice between two borders with their sections, the edges between them, and the
    /// place where an end relief begins. `None` without any; `here` is the section if it is the same in
    /// the whole slice.
    fn sides(
        &self,
        slice: &Slice,
        [from, to]: [f64; 2],
        [one, other]: [[f64; 6]; 2],
        (here, [mean, local, ..]): (Option<[f64; 5]>, [f64; 5]),
    ) -> Option<Sides> {
        /// Of a base pitch: a narrower side has too few digits.
        const NARROWEST: f64 = 1e-9;
        let (way, least) = (to - from, NARROWEST * self.mesh.base_pitch);
        let (low, high) = (from.min(to) + least, from.max(to) - least);
        let edges = self.edges.iter().filter(|edge| low < **edge && **edge < high);
        if slice.bend.is_none() && edges.clone().next().is_none() {
            return None;
        }
        let mut inside: SmallVec<[f64; 4]> = edges.map(|edge| (edge - from) / way).collect();
        let is_apart = |bend: &f64| inside.iter().all(|edge| ((edge - bend) * way).abs() > least);
        inside.extend(slice.bend.filter(is_apart));
        inside.sort_by(f64::total_cmp);
        let mut cuts: SmallVec<[(f64, [f64; 6]); 4]> = SmallVec::new();
        cuts.push((0.0, one));
        cuts.extend(inside.into_iter().map(|part| (part, self.sections.at(from + part * way))));
        cuts.push((1.0, other));
        let ([first, last], gap) = (slice.borders, |z: f64| self.inputs.gap(z));
        let side = |ends: &[(f64, [f64; 6])]| {
            let ((start, one), (end, other)) = (ends[0], ends[1]);
            let of_side = here.unwrap_or_else(|| means(&one, &other, (end - start) * way));
            let ends = [start, end].map(|part| first + part * (last - first));
            let (gaps, mean_gap) = (ends.map(gap), super::mean(slice.z, ends, gap));
            Side {
                part: end - start,
                middle: start + end - 1.0,
                mean: of_side[0] - mean + mean_gap - slice.mean_gap,
                rise: other[0] - one[0] + gaps[1] - gaps[0],
                bend: self::bend([one[0] + gaps[0], other[0] + gaps[1]], of_side[0] + mean_gap),
                ratio: local / of_side[1],
            }
        };
        Some(cuts.windows(2).map(side).collect())
    }

    /// Gap, compliances of contact, driver and driven gear, and arm of the friction at a place of the path.
    fn section(&self, place: f64) -> [f64; 5] {
        std::array::from_fn(|at| self.sections.slope(at + 1, place))
    }

    /// The lead of a pair at a place of its path between two slices, the compliance by which its own
    /// load reduces it, and z. `None` if the place is not on the face, beyond the computed range, or in all
    /// slices at once.
    pub(super) fn lead_between(
        &self,
        loads: &Loads,
        ahead: i32,
        path: f64,
    ) -> Option<(f64, f64, f64)> {
        let z = (path - loads.s - f64::from(ahead) * self.mesh.base_pitch) / self.inputs.lead;
        let (lead, compliance) = self.lead_at(loads, ahead, (z, path))?;
        Some((lead, compliance, z))
    }

    /// The lead of a pair at any z, where it is at `path`, in m, with the compliance there.
    pub(super) fn lead_at(
        &self,
        loads: &Loads,
        ahead: i32,
        (z, path): (f64, f64),
    ) -> Option<(f64, f64)> {
        let pair = loads.pairs.index(ahead)?;
        let after = self.slices.partition_point(|slice| slice.z < z);
        // An end of the face counts as on it, whatever the rounding; without a lead z is no number.
        let (from, to) = self.mesh.ends();
        if !(z.abs() <= 0.5 * self.inputs.width * (1.0 + 1e-9) && (from..=to).contains(&path)) {
            return None;
        }
        let before = after.clamp(1, self.slices.len() - 1) - 1;
        let ahead_of = loads.displacement + if ahead == 0 { loads.error } else { 0.0 };
        let [one, other] = [before, before + 1].map(|slice| loads.teeth_at(pair, slice));
        let step = self.slices[before].step;
        let part = (z - self.slices[before].z) / step;
        let rest = 1.0 - part;
        // The cubic with both values and both changes of slope.
        let cubic = |part: f64, [value, bend]: [f64; 2]| {
            part * (value - bend * step * step * (1.0 - part * part) / 6.0)
        };
        let teeth = cubic(rest, one) + cubic(part, other);
        let (local, root) = self.compliances(z, path);
        let lead = ahead_of - self.sections.one(0, path) - self.inputs.gap(z) - root * teeth;
        Some((lead, local + self.own(root)))
    }

    /// q_c and √(1 + ε) √q_t at a place of the face and of the path.
    fn compliances(&self, z: f64, path: f64) -> (f64, f64) {
        let means = self.section(path);
        (means[1], self.root(Slice::at(&self.inputs, z).teeth([means[2], means[3]], [0.0; 2])))
    }

    /// The line load of a pair at a place of its path between two slices, and z.
    pub(super) fn load_at(&self, loads: &Loads, ahead: i32, path: f64) -> Option<(f64, f64)> {
        let (lead, compliance, z) = self.lead_between(loads, ahead, path)?;
        (lead > 0.0).then_some((lead / compliance, z))
    }

    /// Number of slices that a pair passes on a path; 0 if it passes all at once.
    fn slices_in(&self, path: f64) -> f64 {
        let most = (self.slices.len() - 1) as f64;
        let whole = self.inputs.lead * self.inputs.width;
        if path.abs() < whole.abs() { path / whole * most } else { 0.0 }
    }

    /// √(1 + ε) √q_t of the compliance of the teeth.
    fn root(&self, teeth: f64) -> f64 {
        (teeth * (1.0 + self.excess)).sqrt()
    }

    /// The part of the compliance of a pair by which its own load deflects the slice alone: without
    /// coupling that of the teeth, too.
    fn own(&self, root: f64) -> f64 {
        if self.inputs.coupling_length > 0.0 { 0.0 } else { root * root }
    }

    /// κ, row by row.
    fn kappa(&self, s: f64, first: i32, pairs: usize) -> Vec<f64> {
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
                let neighbour = self.neighbour(place, apart);
                let front = rear + apart;
                kappa[front * pairs + rear] = neighbour;
                kappa[rear * pairs + front] = neighbour;
            }
        }
        kappa
    }

    /// κ of a pair at a place and of the pair `apart` pitches ahead.
    fn neighbour(&self, place: f64, apart: usize) -> f64 {
        let mesh = &self.mesh;
        let ((from, to), way) = (mesh.ends(), apart as f64 * mesh.base_pitch);
        if !mesh.is_coupled() || place < from || place + way > to {
            return 0.0;
        }
        let teeth = |place: f64| {
            // The sections of the driver and of the driven tooth.
            self.sections.slope(3, place) + self.sections.slope(4, place)
        };
        let mean = (teeth(place) * teeth(place + way)).sqrt();
        mesh.coupling(apart, place) * self.inputs.width / mean
    }
}

impl Position<'_> {
    /// Number of pairs at all slices.
    pub(super) fn size(&self) -> usize {
        self.contacts.len()
    }

    /// The loads of all pairs, to a part of the displacement. The search for the touching slices begins with
    /// those of the loads `near`, or on the line through two of them.
    ///
    /// # Formula
    /// ```text
    /// x − gap_k = q_c p_k + √q_tk Σ_j κ_kj u_j  where p_k > 0,   at most that elsewhere
    /// u_j − L² u_j'' = √q_tj p_j,   u_j' = 0 at the ends of the face,   ∫ Σ w_k p_k dz = F0
    /// ```
    /// κ_kj is the displacement of pair k by a load on pair j over the geometric mean of those of
    /// the loaded pairs. The known touching slices give linear equations in the pairs with any of them,
    /// symmetric and positive definite in the coordinates Cᵀ u with C Cᵀ = κ; the slices are corrected
    /// until no load and no overlap contradicts them.
    ///
    /// # Source
    /// The decay along the tooth over L by own finite elements in three dimensions. Active sets:
    /// Hintermüller, Ito & Kunisch 2003, "The primal-dual active set strategy as a semismooth Newton
    /// method".
    ///
    /// # Errors
    /// [`Refusal::BeyondReach`] if a pair beyond the computed gaps may touch,
    /// [`Refusal::IndefiniteCompliance`] if neighbouring pairs displace each other too much.
    pub(super) fn loads(
        &self,
        until: Until,
        near: &[Rc<Loads>],
        precision: f64,
    ) -> Result<Loads, Refusal> {
        const CORRECTIONS: usize = 40;
        const ONE_BY_ONE: usize = 400;
        /// Of the displacement: in a slice with a smaller lead of its borders, contact begins suddenly.
        const SUDDEN: f64 = 0.01;
        let (mut carried, mut displacement) = self.first_guess(until, near);
        let count = self.contacts.len();
        let (mut lines, mut sums) = (vec![[1.0, 0.0]; count], [0.0; 2]);
        let mut means = vec![f64::NEG_INFINITY; count];
        let rounds = if displacement.is_finite() { CORRECTIONS + ONE_BY_ONE } else { 0 };
        for round in 0..rounds {
            lines = self.lines(&carried).ok_or(Refusal::IndefiniteCompliance)?;
            sums = self.sums(&carried, &lines);
            if let Until::Force(force) = until {
                displacement = (force + sums[1]) / sums[0];
            }
            for (mean, lines) in means.iter_mut().zip(&lines) {
                *mean = lines[0] * displacement - lines[1];
            }
            let (allowed, mut is_right) = (precision * displacement.abs(), true);
            for (at, of) in self.contacts.iter().enumerate().filter(|(_, of)| of.can_carry) {
                let (mean, old) = (means[at], carried[at]);
                let new = of.carried(&self.sides, mean, self.rise(&means, at));
                if (new.mean(mean) - old.mean(mean)).abs() > allowed {
                    (carried[at], is_right) = (new, false);
                    if round >= CORRECTIONS {
                        break;
                    }
                }
            }
            if is_right {
                break;
            }
            let is_apart = |carried: &[Carried]| !carried.iter().any(|of| of.touches());
            if round < CORRECTIONS && matches!(until, Until::Force(_)) && is_apart(&carried) {
                let all = (0..count).filter(|&at| self.contacts[at].can_carry);
                let nearest = all.max_by(|&one, &other| means[one].total_cmp(&means[other]));
                if let Some(at) = nearest {
                    carried[at] = Carried::ALL;
                }
            }
        }
        let (mut bend, mut smooth) = (0.0, f64::INFINITY);
        for (at, of) in self.contacts.iter().enumerate().filter(|(_, of)| of.can_carry) {
            let half = 0.5 * (self.rise(&means, at) - of.rise).abs();
            bend += of.weight * of.width * lines[at][0].powi(3) * carried[at].change / of.local;
            if half < SUDDEN * displacement.abs() {
                smooth = f64::min(smooth, (means[at].abs() - half).abs() / lines[at][0].abs());
            }
        }
        let (mut leads, mut line_loads) = (means.clone(), vec![0.0; count]);
        let (mut mean_loads, mut teeth) = (line_loads.clone(), vec![[0.0; 2]; count]);
        for (at, of) in self.contacts.iter().enumerate().filter(|(at, _)| carried[*at].touches()) {
            // The last digits of a part that just touches may be below 0.
            mean_loads[at] = carried[at].mean(means[at]).max(0.0) / of.local;
        }
        let known = self.contacts.iter().enumerate().filter(|(_, of)| of.gap < f64::INFINITY);
        for (at, of) in known {
            let (own, slice) = (self.face.own(of.root), &self.face.slices[at / self.pairs.slots]);
            // The middle of a slice alone deflects under its own load, not under the mean.
            let moved = displacement - of.mean - means[at] - own * mean_loads[at];
            let bend = self.face.stiffening * (moved - self.source(at, &mean_loads));
            let middle = moved - bend * slice.spread;
            if of.root > 0.0 {
                teeth[at] = [middle / of.root, bend / of.root];
            }
            let is_inner = (self.pairs.slots..count - self.pairs.slots).contains(&at);
            // An end of the face is not in the middle of its slice.
            let (local, root) = if is_inner {
                (of.local, of.root)
            } else {
                let ahead = f64::from(self.pairs.first) + of.pair as f64;
                let path = self.s + ahead * self.face.mesh.base_pitch + slice.ahead;
                self.face.compliances(slice.z, path)
            };
            let (own, lead) = (self.face.own(root), displacement - of.gap - root * teeth[at][0]);
            leads[at] = if lead > 0.0 { lead * local / (local + own) } else { lead };
            if of.can_carry {
                line_loads[at] = leads[at].max(0.0) / local;
            }
        }
        let added = self.variation(displacement, &carried, &lines, (&means, &mean_loads));
        // Without contact there is nothing to correct.
        if matches!(until, Until::Force(_)) && sums[0] > 0.0 {
            displacement -= added / sums[0];
        }
        let most = displacement - self.face.least_gap + self.error.max(0.0);
        self.face.mesh.check_reach(most)?;
        Ok(Loads {
            s: self.s,
            pairs: Rc::clone(&self.pairs),
            displacement,
            error: self.error,
            line_loads,
            mean_loads,
            leads,
            teeth,
            force: sums[0] * displacement - sums[1] + added,
            stiffness: sums[0],
            bend,
            smooth,
        })
    }

    /// The force that the loads add because compliances, displacements and loads vary within the slices.
    ///
    /// # Formula
    /// ```text
    /// mean(r u) = r ū + r₁ u₁/3 − r₁² ū/(6 r),   mean(λ/q) = λ̄/q + (λ̄ q₁/q − λ₁) q₁/(3 q²)
    /// ```
    /// with linear changes of 2 r₁, 2 u₁, 2 λ₁ and 2 q₁ over the slice, r² = mean(r²), and f = r p as r u. To
    /// first order the displacement of the driver turns such a change into force as the loads of the slice.
    fn variation(
        &self,
        displacement: f64,
        carried: &[Carried],
        lines: &[[f64; 2]],
        (means, mean_loads): (&[f64], &[f64]),
    ) -> f64 {
        let mut force = 0.0;
        for (at, of) in self.contacts.iter().enumerate().filter(|(at, _)| carried[*at].touches()) {
            let ends = self.beside(at);
            let beside = ends.map(|end| &self.contacts[end]);
            if beside.into_iter().chain([of]).any(|of| of.root <= 0.0) {
                continue;
            }
            let is_end = ends[1] - ends[0] == self.pairs.slots;
            let half = |[one, other]: [f64; 2]| (other - one) / if is_end { 3.0 } else { 4.0 };
            let of_end = |values: &[f64]| half(ends.map(|end| values[end]));
            let moved = |at: usize| {
                (displacement - self.contacts[at].mean - means[at]) / self.contacts[at].root
            };
            let root = half(beside.map(|end| end.root));
            let mean =
                |change: f64, mean: f64| root * (change / 3.0 - root * mean / (6.0 * of.root));
            // Change of load and of u with the displacement of the driver.
            let (lead, local) = (lines[at][0], of.local);
            let [load, push] = [carried[at].part * lead / local, (1.0 - lead) / of.root];
            let by_teeth = load * mean(half(ends.map(moved)), moved(at))
                + push * mean(of_end(mean_loads), mean_loads[at]);
            // At an edge of the section the compliance of the contact may jump.
            let is_even = of.sides.is_none() && beside.iter().all(|end| end.sides.is_none());
            let part = if is_even { half(beside.map(|end| end.local)) / local } else { 0.0 };
            let by_contact = load * part * (means[at] * part - of_end(means)) / 3.0;
            force += of.weight * of.width * (by_contact - by_teeth);
        }
        force
    }

    /// The indices of a pair at the slices before and after, or at this slice if there is none.
    fn beside(&self, at: usize) -> [usize; 2] {
        let after = at + self.pairs.slots;
        let after = if after < self.contacts.len() { after } else { at };
        [at.checked_sub(self.pairs.slots).unwrap_or(at), after]
    }

    /// The displacement of the teeth of a pair at a slice by the mean loads there if they were even.
    fn source(&self, at: usize, mean_loads: &[f64]) -> f64 {
        let (first, pairs) = (at - at % self.pairs.slots, self.pairs.slices.len());
        let here = self.contacts[first..][..self.pairs.slots].iter().zip(&mean_loads[first..]);
        let kappa = &self.kappa[self.contacts[at].pair * pairs..];
        let parts = here.map(|(of, load)| kappa[of.pair] * of.root * load);
        self.contacts[at].root * parts.sum::<f64>() / (1.0 + self.face.excess)
    }

    /// The rise of a lead over its slice by the displacement of the teeth, which is linear between the
    /// middles of two slices, by the means of all leads.
    fn rise(&self, means: &[f64], at: usize) -> f64 {
        let teeth = |at: usize| self.contacts[at].mean + means[at];
        let [before, after] = self.beside(at);
        let rise = teeth(after) - teeth(before);
        if rise.is_finite() { 0.5 * rise } else { 0.0 }
    }

    /// The displacement at which independent slices balance a force. Begins with all slices, so that
    /// the displacement falls to that of the touching ones.
    fn of_springs(&self, force: f64) -> f64 {
        let springs = self.contacts.iter().filter(|contact| contact.can_carry);
        let mut displacement = f64::INFINITY;
        loop {
            let touching = springs.clone().filter(|contact| contact.mean < displacement);
            let (stiffness, preload) =
                touching.fold((0.0, force), |(stiffness, preload), contact| {
                    let compliance = contact.local + contact.root * contact.root;
                    let spring = contact.weight * contact.width / compliance;
                    (stiffness + spring, preload + spring * contact.mean)
                });
            let next = preload / stiffness;
            if stiffness <= 0.0 || next >= displacement {
                return displacement;
            }
            displacement = next;
        }
    }

    /// What carries to begin with, and the displacement.
    fn first_guess(&self, until: Until, near: &[Rc<Loads>]) -> (Vec<Carried>, f64) {
        if let [first, rest @ ..] = near {
            let (mut teeth, mut displacement) = (self.moved(first), first.displacement);
            if let [second, ..] = rest {
                let part = (self.s - first.s) / (second.s - first.s);
                displacement += part * (second.displacement - displacement);
                for (teeth, other) in teeth.iter_mut().zip(self.moved(second)) {
                    *teeth += part * (other - *teeth);
                }
            }
            if let Until::Displacement(known) = until {
                displacement = known;
            }
            let mean = |(of, teeth): (&Contact, f64)| {
                let lead = displacement - of.mean - of.root * teeth;
                let own = self.face.own(of.root);
                if lead > 0.0 { lead * of.local / (of.local + own) } else { lead }
            };
            let means: Vec<f64> = self.contacts.iter().zip(teeth).map(mean).collect();
            let guess = |(at, of): (usize, &Contact)| {
                let rise = self.rise(&means, at);
                if of.can_carry { of.carried(&self.sides, means[at], rise) } else { Carried::NONE }
            };
            let carried: Vec<Carried> = self.contacts.iter().enumerate().map(guess).collect();
            if matches!(until, Until::Displacement(_)) || carried.iter().any(|of| of.touches()) {
                return (carried, displacement);
            }
        }
        let displacement = match until {
            Until::Force(force) => self.of_springs(force),
            Until::Displacement(displacement) => displacement,
        };
        let touches = |of: &Contact| of.can_carry && of.mean < displacement;
        let guess = |of: &Contact| if touches(of) { Carried::ALL } else { Carried::NONE };
        (self.contacts.iter().map(guess).collect(), displacement)
    }

    /// The displacements of the teeth near by, which keep their places on the path and have no bends at
    /// its ends.
    fn moved(&self, near: &Loads) -> Vec<f64> {
        let moved = self.face.slices_in(self.s - near.s);
        let (whole, part) = (moved.floor() as isize, moved - moved.floor());
        let last = self.face.slices.len() - 1;
        let mut teeth = vec![0.0; self.contacts.len()];
        for (pair, ahead) in self.pairs.all().enumerate() {
            let Some(known) = near.pairs.index(ahead) else { continue };
            let of = |slice: usize| {
                let slice = slice.min(last);
                let [middle, bend] = near.teeth_at(known, slice);
                middle + bend * self.face.slices[slice].spread
            };
            for (slice, at) in self.pairs.of(pair) {
                let before = slice.saturating_add_signed(whole);
                teeth[at] = of(before) + part * (of(before + 1) - of(before));
            }
        }
        teeth
    }

    /// Mean displacement under the loads minus the mean gap, of every pair over every slice, if what is
    /// `carried` carries: its change with the displacement, and what is taken from that. `None` if
    /// the compliances are not positive definite.
    fn lines(&self, carried: &[Carried]) -> Option<Vec<[f64; 2]>> {
        let has_load = |pair: &usize| self.pairs.of(*pair).any(|(_, at)| carried[at].touches());
        let active: Vec<usize> = (0..self.pairs.slices.len()).filter(has_load).collect();
        if active.is_empty() {
            return Some(self.contacts.iter().map(|contact| [1.0, contact.mean]).collect());
        }
        let system = System::new(self, &active, carried)?;
        // The size of a block is known to the compiler.
        match system.slots {
            1 => system.lines::<1, 2>(),
            2 => system.lines::<2, 3>(),
            3 => system.lines::<3, 4>(),
            4 => system.lines::<4, 5>(),
            5 => system.lines::<5, 6>(),
            6 => system.lines::<6, 7>(),
            7..=8 => system.lines::<8, 9>(),
            9..=16 => system.lines::<16, 17>(),
            _ => system.lines::<PAIRS, { PAIRS + 1 }>(),
        }
    }

    /// Change of the force that turns the driver with the displacement, and the force that the gaps
    /// take.
    fn sums(&self, carried: &[Carried], lines: &[[f64; 2]]) -> [f64; 2] {
        let touching = self.contacts.iter().zip(lines).zip(carried).filter(|(_, of)| of.touches());
        touching.fold([0.0; 2], |[slope, offset], ((contact, lines), of)| {
            let spring = contact.weight * contact.width / contact.local;
            let parts = [of.part * lines[0], of.part * lines[1] - of.rest];
            [slope + spring * parts[0], offset + spring * parts[1]]
        })
    }
}
