//! The load at rest over the face width: one base pitch without deviations, and the passage of the
//! incoming tooth.

use super::balance::{Incoming, PRECISE, Until};
use super::course::Course;
use super::loads::Loads;
use super::{Face, Slice};
use crate::model::Refusal;
use crate::model::budget::STATIONS;
use crate::model::dynamic::first_valley;
use crate::model::static_load::{HARMONICS, Spectrum, StaticLoad, StaticSpectrum};
use crate::model::stations::{Own, Spacing, Station};
use crate::numeric::root::{self, greatest_within};
use crate::numeric::{self, quadrature};
use smallvec::SmallVec;
use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;
use std::rc::Rc;
use std::sync::Arc;

/// Tolerances of greatest values: finer ones are lost among the errors of the slices.
pub(super) const PRECISION: (f64, f64) = (1e-5, 1e-8);

/// Number of places in a base pitch at which the load is solved.
const STEPS: usize = 64;

/// Distance from an end of a part, of the path of contact.
const INSIDE: f64 = 1e-9;

/// A place of contact on the face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FacePlace {
    /// Place along the axis from the middle of the common face, in m.
    pub z: f64,
    /// Path of the pair since E in the plane across the axis at z, in m.
    pub path: f64,
}

/// The greatest line load of a part of the path, in N/m, and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinePeak {
    /// Line load, in N/m.
    pub line_load: f64,
    /// Where it acts.
    pub place: FacePlace,
}

/// The load over the face width.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceLoad {
    /// First contact of the incoming tooth.
    pub first: FacePlace,
    /// Last contact of the incoming tooth.
    pub last: FacePlace,
    /// Least gap of the incoming tooth before E under the load of the other pairs, in m; `None` if it
    /// touches there, or in motion.
    pub least_gap: Option<f64>,
    /// Greatest line load of the incoming tooth.
    pub peak: LinePeak,
    /// The same before E, at the driven tip.
    pub before_start: Option<LinePeak>,
    /// The same after B, at the driver's tip.
    pub after_end: Option<LinePeak>,
    /// Path of the incoming tooth in the middle of the face at each row of `pattern`, in m.
    pub paths: Vec<f64>,
    /// Line load of the incoming tooth at each slice, in N/m, for each of the `paths`.
    pub pattern: Vec<Vec<f64>>,
}

/// One base pitch without deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct FaceCycle {
    /// Mean displacement of the driver ahead, in m.
    pub mean_displacement: f64,
    /// Greatest line load of all pairs, averaged over a base pitch, in N/m.
    pub peak_line_load: f64,
    /// Its mean over the face, in N/m.
    pub mean_line_load: f64,
    /// Swing of the point of attack of the force along the face, in m.
    pub swing: f64,
}

/// The part of the path of a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    BeforeStart,
    AfterEnd,
}

impl Part {
    /// A place just inside the end of the part at the path of contact, in m.
    fn border(self, length: f64) -> Option<f64> {
        match self {
            Part::All => None,
            Part::BeforeStart => Some(-INSIDE * length),
            Part::AfterEnd => Some((1.0 + INSIDE) * length),
        }
    }

    fn has(self, path: f64, length: f64) -> bool {
        match self {
            Part::All => true,
            Part::BeforeStart => path < 0.0,
            Part::AfterEnd => path > length,
        }
    }
}

impl Face {
    /// The path of a pair at a slice, in m.
    pub(super) fn path(&self, loads: &Loads, ahead: i32, slice: usize) -> f64 {
        loads.s + f64::from(ahead) * self.mesh.base_pitch + self.slices[slice].ahead
    }

    /// The greatest line load of the incoming pair in a part of the path.
    fn line_peak(&self, loads: &Loads, part: Part) -> LinePeak {
        let place = FacePlace { z: 0.0, path: 0.0 };
        let mut best = LinePeak { line_load: 0.0, place };
        let mut include = |line_load: f64, place: FacePlace| {
            if line_load > best.line_load {
                best = LinePeak { line_load, place };
            }
        };
        let (length, edges) = (self.mesh.length, self.mesh.edges());
        // A part can have its greatest load just beside its end.
        let step = self.slices.first().map_or(0.0, |slice| slice.step * self.inputs.lead);
        let is_here = |path: f64| part.has(path, length);
        for (number, slice) in self.slices.iter().enumerate() {
            let path = self.path(loads, 0, number);
            if !is_here(path) {
                continue;
            }
            let [one, other] = slice.borders.map(|z| path + (z - slice.z) * self.inputs.lead);
            let has_edge = edges.clone().any(|edge| (edge - one) * (edge - other) < 0.0);
            let load = if !has_edge {
                Some(self.top_of_incoming(loads, number))
            } else if part == Part::All {
                self.load_at(loads, 0, path).map(|(load, _)| load)
            } else {
                None
            };
            if let Some(load) = load {
                include(load, FacePlace { z: slice.z, path });
            }
        }
        // The load has bends and jumps where functions of the mesh have them, between two slices.
        let beside = [INSIDE * length, 0.125 * step, 0.25 * step, 0.5 * step];
        let beside = &beside[..if part == Part::All { 1 } else { beside.len() }];
        let places =
            edges.flat_map(|edge| beside.iter().flat_map(move |way| [edge - way, edge + way]));
        for path in places.filter(|path| is_here(*path)) {
            if let Some((line_load, z)) = self.load_at(loads, 0, path) {
                include(line_load, FacePlace { z, path });
            }
        }
        // The contact under a light load can be between the middles of two slices.
        let between = || {
            let (_, place) = self.touch(loads);
            let (lead, compliance) = self.lead_at(loads, 0, (place.z, place.path))?;
            (lead > 0.0).then(|| LinePeak { line_load: lead / compliance, place })
        };
        let is_between = part == Part::All && best.line_load <= 0.0;
        Some(best).filter(|_| !is_between).or_else(between).unwrap_or(best)
    }

    /// The line load at a slice, and above two smaller neighbours that of the parabola through them: the
    /// greatest one between two slices, except where an end relief begins and the load has a bend.
    fn top(&self, slice: usize, load: impl Fn(usize) -> f64) -> f64 {
        let here = load(slice);
        let is_end = slice == 0 || slice + 1 == self.slices.len();
        if is_end || self.slices[slice].bend.is_some() {
            return here;
        }
        let [before, after] = [slice - 1, slice + 1].map(load);
        let bend = before - 2.0 * here + after;
        let is_top = before.min(after) > 0.0 && before.max(after) <= here && bend < 0.0;
        if is_top { here - (after - before).powi(2) / (8.0 * bend) } else { here }
    }

    /// The same of the incoming pair. Its load has a bend or a jump at an edge of the section, too.
    fn top_of_incoming(&self, loads: &Loads, slice: usize) -> f64 {
        let (here, top) = (loads.at(0, slice), self.top(slice, |at| loads.at(0, at)));
        let has_edge = || {
            let [one, other] = [slice - 1, slice + 1].map(|at| self.path(loads, 0, at));
            self.edges.iter().any(|edge| (edge - one) * (edge - other) < 0.0)
        };
        if top > here && has_edge() { here } else { top }
    }

    /// z of the bottom of the parabola through the least of some values and its neighbours.
    fn bottom(&self, values: &[f64], least: usize) -> f64 {
        let at = |number: usize| (self.slices[number].z, values[number]);
        let ((z, value), inner) = (at(least), 1..self.slices.len() - 1);
        if !inner.contains(&least) {
            return z;
        }
        let [before, after] = [at(least - 1), at(least + 1)];
        let [fall, rise] = [before, after].map(|(beside, other)| (other - value) / (beside - z));
        let bend = (rise - fall) / (after.0 - before.0);
        let slope = fall + bend * (z - before.0);
        if bend > 0.0 { (z - 0.5 * slope / bend).clamp(before.0, after.0) } else { z }
    }

    /// The greatest lead of the incoming tooth over the face, in m, and its place, which can be between
    /// slices.
    fn touch(&self, loads: &Loads) -> (f64, FacePlace) {
        let path = |z: f64| loads.s + z * self.inputs.lead;
        let (_, at) = loads.lead(0);
        let lead = |z| self.lead_at(loads, 0, (z, path(z))).map_or(f64::NEG_INFINITY, |it| it.0);
        let near = self.slices[at.saturating_sub(1)..].iter().take(if at == 0 { 2 } else { 3 });
        let known = near.map(|slice| (slice.z, lead(slice.z)));
        let (z, lead) = greatest_within(&known.collect::<Vec<_>>(), PRECISION, lead);
        (lead, FacePlace { z, path: path(z) })
    }

    /// How far before E the incoming tooth touches, or after B, in the plane where this is farthest, in
    /// m.
    fn deepest(&self, loads: &Loads, part: Part) -> f64 {
        let beyond = |path: f64| match part {
            Part::AfterEnd => path - self.mesh.length,
            _ => -path,
        };
        let path = |at: usize| self.path(loads, 0, at);
        let deeper =
            |one: &usize, other: &usize| beyond(path(*one)).total_cmp(&beyond(path(*other)));
        let touching = (0..self.slices.len()).filter(|&at| loads.lead_at(0, at) > 0.0);
        let Some(at) = touching.max_by(deeper) else {
            return 0.0;
        };
        // The contact ends between this slice and the next one.
        let beside = [at.wrapping_sub(1), at + 1].into_iter().filter(|at| *at < self.slices.len());
        let next = beside.filter(|next| beyond(path(*next)) > beyond(path(at))).max_by(deeper);
        let lead = |path: f64| self.lead_between(loads, 0, path).map(|(lead, ..)| lead);
        let end = next.map(&path).filter(|end| lead(*end).is_some_and(|lead| lead <= 0.0));
        let end = end.filter(|_| lead(path(at)).is_some_and(|lead| lead > 0.0));
        let end = end.map(|end| root::between(end, path(at), |path| lead(path).unwrap_or(0.0)));
        beyond(end.unwrap_or(path(at))).max(0.0)
    }

    /// The force of a pair in a part of the path, in N. Of the slice with the border of the part, the
    /// share of its load there counts.
    fn force(&self, loads: &Loads, ahead: i32, part: Part) -> f64 {
        let Some(border) = part.border(self.mesh.length) else {
            return self.pair_force(loads, ahead);
        };
        let middle = loads.s + f64::from(ahead) * self.mesh.base_pitch;
        let is_here = |z: &f64| part.has(middle + z * self.inputs.lead, self.mesh.length);
        let share = |[one, other]: [f64; 2]| {
            let (inside, outside) = match [one, other].each_ref().map(is_here) {
                [true, false] => (one, other),
                [false, true] => (other, one),
                [is_all, _] => return f64::from(u8::from(is_all)),
            };
            let z = (border - middle) / self.inputs.lead;
            let [load, rest] =
                [inside, outside].map(|end| self.load_between(loads, ahead, [z, end]));
            if load > 0.0 { load / (load + rest) } else { 0.0 }
        };
        let force = |(number, slice): (usize, &Slice)| match loads.mean_at(ahead, number) {
            load if load > 0.0 => load * slice.width * share(slice.borders),
            _ => 0.0,
        };
        self.slices.iter().enumerate().map(force).sum()
    }

    /// ∫ of the line load of a pair between two places on the face, in N.
    fn load_between(&self, loads: &Loads, ahead: i32, [from, to]: [f64; 2]) -> f64 {
        const PARTS: usize = 8;
        let middle = loads.s + f64::from(ahead) * self.mesh.base_pitch;
        let at = |z: f64| {
            let found = self.lead_at(loads, ahead, (z, middle + z * self.inputs.lead));
            found.map_or((0.0, 0.0), |(lead, compliance)| (lead, lead.max(0.0) / compliance))
        };
        let samples: SmallVec<[_; PARTS + 1]> = numeric::steps(from, to, PARTS).map(at).collect();
        let between = |ends: &[(f64, f64)]| {
            let ((lead, load), (other, last)) = (ends[0], ends[1]);
            // The lead is linear where the contact ends.
            let (low, high) = (lead.min(other), lead.max(other));
            let part = if low >= 0.0 { 1.0 } else { high.max(0.0) / (high - low) };
            0.5 * (load + last) * part
        };
        samples.windows(2).map(between).sum::<f64>() * (to - from).abs() / PARTS as f64
    }

    /// ∫ of a value over the face.
    fn over_face(&self, values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
        let parts = values.iter().zip(&self.slices);
        parts.map(|(value, slice)| value * of(slice.z) * slice.width).sum()
    }

    /// One base pitch without deviations, and the harmonics of its transmission error.
    ///
    /// # Formula
    /// ```text
    /// K_Hβ = max w(z)/w_m,   w(z) = mean of Σ_k p_k(z) over a base pitch,   w_m = mean of w(z)
    /// ```
    ///
    /// # Source
    /// K_Hβ of ISO 6336-1:2019, 7.2, by the line load of all pairs.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    pub fn cycle(&self) -> Result<(FaceCycle, StaticSpectrum), Refusal> {
        let passage = Passage::new(self, None, Incoming::Alike);
        let (places, shares): (Vec<f64>, Vec<f64>) = self.shares(&passage)?.into_iter().unzip();
        let period = passage.samples(&places)?;
        let all: Vec<_> = period.iter().zip(&shares).filter(|(_, share)| **share > 0.0).collect();
        let mean =
            |of: &dyn Fn(&Loads) -> f64| all.iter().map(|(loads, share)| of(loads) * *share).sum();
        let slices = 0..self.slices.len();
        let line_loads: Vec<f64> =
            slices.clone().map(|slice| mean(&|loads| loads.of_all_at(slice))).collect();
        let extreme = |of: &dyn Fn(&Loads) -> f64| passage.greatest(&period, of).1;
        let middle = |loads: &Loads| {
            let line_loads = loads.of_all();
            self.over_face(&line_loads, |z| z) / self.over_face(&line_loads, |_| 1.0)
        };
        let cycle = FaceCycle {
            mean_displacement: mean(&|loads| loads.displacement),
            // The contact under a light load can be between the middles of two slices.
            peak_line_load: slices
                .map(|slice| {
                    let top = self.top(slice, |at| line_loads[at]);
                    let is_empty = top <= 0.0;
                    if is_empty { mean(&|loads| loads.mean_of_all_at(slice)) } else { top }
                })
                .fold(0.0, f64::max),
            mean_line_load: mean(&|loads| self.over_face(&loads.of_all(), |_| 1.0))
                / self.inputs.width,
            swing: extreme(&middle) + extreme(&|loads| -middle(loads)),
        };
        let spectrum = Spectrum {
            amplitudes: harmonics(&period, &shares, self.mesh.base_pitch),
            peak_to_peak: extreme(&|loads| loads.displacement)
                + extreme(&|loads| -loads.displacement),
        };
        let tooth_force = extreme(&|loads| self.tooth_force(loads));
        Ok((cycle, StaticSpectrum { spectrum, tooth_force }))
    }

    /// Places of a base pitch in their order, each with its part of a mean. The displacement has bends
    /// where pairs pass into another zone, gain or lose contact, which the overlap spreads: with a small one
    /// they divide the base pitch, and each piece has the nodes of the Gauss-Legendre rule.
    fn shares(&self, passage: &Passage<'_>) -> Result<Vec<(f64, f64)>, Refusal> {
        /// Overlap ratio from which even places are enough.
        const ENOUGH: f64 = 0.25;
        /// Looks between two borders for a change of contact, and rules in a base pitch.
        const LOOKS: usize = 4;
        const RULES: f64 = 8.0;
        let (pitch, length) = (self.mesh.base_pitch, self.mesh.length);
        if 2.0 * self.reach >= ENOUGH * pitch {
            let share = |step: usize| if step < STEPS { 1.0 / STEPS as f64 } else { 0.0 };
            let places = numeric::steps(0.0, pitch, STEPS).enumerate();
            return Ok(places.map(|(step, s)| (s, share(step))).collect());
        }
        let distinct = |cuts: Vec<f64>| numeric::distinct(cuts, 1e-12 * pitch);
        let borders = self.mesh.borders(-self.reach, pitch + self.reach).into_iter();
        let borders = borders.flat_map(|border| [border - self.reach, border + self.reach]);
        let inside = borders.filter(|border| *border > 0.0 && *border < pitch);
        let borders = distinct(inside.chain([0.0, pitch]).collect());
        let mut cuts = borders.clone();
        for ends in borders.windows(2) {
            let looks = numeric::steps(ends[0], ends[1], LOOKS).map(|s| passage.loads(s));
            let looks = looks.collect::<Result<Vec<_>, _>>()?;
            for near in looks.windows(2) {
                let pairs = near[0].pairs.all();
                let ends = pairs.flat_map(|ahead| [(ahead, 0), (ahead, self.slices.len() - 1)]);
                for (ahead, slice) in ends {
                    let lead = |loads: &Loads| loads.lead_at(ahead, slice).clamp(-length, length);
                    if (lead(&near[0]) > 0.0) != (lead(&near[1]) > 0.0) {
                        let lead = |s: f64| passage.loads(s).map_or(f64::NAN, |loads| lead(&loads));
                        cuts.push(root::between(near[0].s, near[1].s, lead));
                    }
                }
            }
        }
        let mut places = Vec::new();
        for ends in distinct(cuts).windows(2) {
            let rules = ((ends[1] - ends[0]) / pitch * RULES).ceil();
            let way = (ends[1] - ends[0]) / rules;
            places.push((ends[0], 0.0));
            for rule in 0..rules as u32 {
                let from = ends[0] + f64::from(rule) * way;
                let nodes = quadrature::nodes();
                places
                    .extend(nodes.map(|(node, weight)| (from + node * way, weight * way / pitch)));
            }
        }
        places.push((pitch, 0.0));
        places.sort_by(|one, other| one.0.total_cmp(&other.0));
        Ok(places)
    }

    /// The greatest lead of the incoming tooth in a part of the path over the face, in m; infinitely
    /// negative if no slice is there.
    fn lead_in(&self, loads: &Loads, part: Part) -> f64 {
        /// Parts of the step between two slices, and how many of them have the greatest lead, at the
        /// end of the part or just beside it.
        const PARTS: (f64, u32) = (8.0, 16);
        let length = self.mesh.length;
        let is_here = |number: &usize| {
            let path = loads.s + self.slices[*number].ahead;
            part.has(path, length) || part == Part::BeforeStart && path == 0.0
        };
        let leads = (0..self.slices.len()).filter(is_here).map(|number| loads.lead_at(0, number));
        let step = self.slices.first().map_or(0.0, |slice| slice.step * self.inputs.lead.abs());
        let away = if part == Part::BeforeStart { -step } else { step };
        let near = (0..=PARTS.1).filter_map(|at| {
            let path = part.border(length)? + f64::from(at) / PARTS.0 * away;
            self.lead_between(loads, 0, path).map(|(lead, ..)| lead)
        });
        leads.chain(near).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Step between the samples of a way of the incoming tooth, in m. On a way over many base pitches the
    /// slices pass the same states one after the other.
    fn step(&self, way: f64) -> f64 {
        const MOST: f64 = 256.0;
        (self.mesh.base_pitch / (STEPS / 2) as f64).max(way / MOST)
    }

    /// The greatest lead of the incoming tooth before E over the face, or after B, in m, at rest or in a
    /// motion: the displacement under the loads on the rest of its path and of the other pairs less its
    /// gap. Above 0 the tip touches there.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    pub(super) fn greatest_lead(
        &self,
        course: Option<&Course>,
        at_exit: bool,
    ) -> Result<f64, Refusal> {
        let mesh = &self.mesh;
        let (from, to, part, incoming) = if at_exit {
            let from = mesh.length - self.reach;
            (from, mesh.ends().1 + self.reach, Part::AfterEnd, Incoming::BeforeEnd(mesh.error))
        } else {
            let from = mesh.ends().0 - self.reach;
            (from, self.reach, Part::BeforeStart, Incoming::AfterStart(mesh.error))
        };
        let count = ((to - from) / self.step(to - from)).ceil() as usize;
        let places = (0..=count).map(|number| from + (to - from) * number as f64 / count as f64);
        let passage = Passage::new(self, course, incoming);
        let samples = passage.samples(&places.collect::<Vec<_>>())?;
        let lead = |loads: &Loads| self.lead_in(loads, part).max(-mesh.length);
        Ok(passage.greatest(&samples, &lead).1)
    }

    /// The greatest lead of the incoming tooth at rest before E, or after B, in m.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    pub fn lead_at_rest(&self, at_exit: bool) -> Result<f64, Refusal> {
        self.greatest_lead(None, at_exit)
    }

    /// The force of a pair in a balance, in N.
    pub fn pair_force(&self, loads: &Loads, ahead: i32) -> f64 {
        let of_pair = loads.pairs.index(ahead).into_iter().flat_map(|pair| loads.pairs.of(pair));
        let force = |(slice, at): (usize, usize)| loads.mean_loads[at] * self.slices[slice].width;
        of_pair.map(force).fold(0.0, |sum, force| sum + force)
    }

    /// The greatest force of a tooth, in N.
    pub(super) fn tooth_force(&self, loads: &Loads) -> f64 {
        loads.pairs.all().map(|ahead| self.pair_force(loads, ahead)).fold(0.0, f64::max)
    }

    /// The station of the incoming tooth. Gap, compliance and velocities are those at the z with the least
    /// gap.
    fn station(&self, loads: &Loads, motion: Option<(f64, Option<f64>)>) -> Station {
        let mesh = &self.mesh;
        let (from, to) = mesh.ends();
        let at = |slice: &Slice| mesh.incoming((loads.s + slice.ahead).clamp(from, to));
        let gaps: Vec<f64> = self.slices.iter().map(|slice| at(slice).0.gap + slice.gap).collect();
        let least = gaps.iter().enumerate().min_by(|one, other| one.1.total_cmp(other.1));
        let nearest = Slice::at(&self.inputs, self.bottom(&gaps, least.map_or(0, |(at, _)| at)));
        let (place, slope) = at(&nearest);
        let force = self.pair_force(loads, 0);
        let total: f64 = self.over_face(&loads.of_all(), |_| 1.0);
        Station {
            roll_angle_driver: 0.0 - loads.s / mesh.base_radii.0,
            roll_angle_driven: 0.0 - loads.s / mesh.base_radii.1,
            force,
            normal_velocity: 0.0 - slope * mesh.speed,
            sliding_velocity: place.sliding,
            gap: place.gap + nearest.gap,
            pair_compliance: Some(mesh.width / place.stiffness),
            own: Own::Shared {
                part: if total > 0.0 { force / total } else { 0.0 },
                displacement: loads.displacement,
                load_over_curvature: self.load_over_curvature(loads),
                motion,
            },
        }
    }

    /// The greatest line load of the incoming tooth over the reduced radius of curvature of its flanks,
    /// from E to B, in N/m². `None` without load there.
    fn load_over_curvature(&self, loads: &Loads) -> Option<f64> {
        let ((start, tangent_length), length) = (self.line, self.mesh.length);
        let on_flanks = |path: &f64| (0.0..=length).contains(path);
        let over_curvature = |path: f64, load: f64| {
            let along = start + path;
            load * tangent_length / (along * (tangent_length - along))
        };
        let at_slices = (0..self.slices.len()).filter_map(|number| {
            let path = Some(self.path(loads, 0, number)).filter(on_flanks)?;
            Some(over_curvature(path, self.top_of_incoming(loads, number)))
        });
        let ends = [0.0, length].into_iter();
        let at_ends =
            ends.filter_map(|path| Some(over_curvature(path, self.load_at(loads, 0, path)?.0)));
        let found = at_slices.chain(at_ends);
        found.filter(|found| *found > 0.0 && found.is_finite()).reduce(f64::max)
    }

    /// Power of friction on the incoming tooth, in W.
    pub(super) fn friction_power(&self, loads: &Loads) -> f64 {
        let mesh = &self.mesh;
        let of_slice = |number: usize| {
            let sliding = mesh.incoming(self.path(loads, 0, number)).0.sliding;
            loads.mean_at(0, number) * self.slices[number].width * sliding.abs()
        };
        let sum: f64 = (0..self.slices.len()).map(of_slice).sum();
        mesh.friction() * self.inputs.oblique * sum
    }

    /// The load of the incoming tooth at rest from its first to its last contact.
    ///
    /// # Errors
    /// Those of [`Face::loads`].
    pub fn static_load(
        &self,
        spacing: Spacing,
    ) -> Result<(StaticLoad, Option<Arc<FaceLoad>>), Refusal> {
        let passage = Passage::new(self, None, Incoming::Deviates(self.mesh.error));
        let Some(passed) = passage.run(spacing)? else {
            return Ok((StaticLoad::default(), None));
        };
        let least_gap = match passed.load.first_contact_angle {
            Some(_) => None,
            None => Some(-self.lead_at_rest(false)?),
        };
        Ok((passed.load, Some(Arc::new(FaceLoad { least_gap, ..passed.face }))))
    }
}

/// The harmonics of the displacement at places of a base pitch with their parts of it, in m.
fn harmonics(period: &[Rc<Loads>], shares: &[f64], pitch: f64) -> [f64; HARMONICS] {
    std::array::from_fn(|order| {
        let parts = period.iter().zip(shares).map(|(loads, share)| {
            let (sine, cosine) = (TAU * (order + 1) as f64 * loads.s / pitch).sin_cos();
            [loads.displacement * share * cosine, loads.displacement * share * sine]
        });
        let [cosine, sine] = parts.fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
        2.0 * cosine.hypot(sine)
    })
}

/// The passage of the incoming tooth, at rest or in motion.
pub(super) struct Passage<'a> {
    face: &'a Face,
    /// The motion; `None` at rest.
    course: Option<&'a Course>,
    incoming: Incoming,
    /// The balances of the samples in their order, and the one computed last.
    samples: RefCell<Vec<Rc<Loads>>>,
    last: RefCell<Option<Rc<Loads>>>,
}

/// The load of the incoming tooth in a passage.
pub(super) struct Passed {
    /// Its forces and angles; without the change at the pitch point.
    pub load: StaticLoad,
    /// The same over the face; without the least gap.
    pub face: FaceLoad,
    /// The loads at places from the first to the last contact.
    pub samples: Vec<Rc<Loads>>,
}

impl<'a> Passage<'a> {
    pub(super) fn new(face: &'a Face, course: Option<&'a Course>, incoming: Incoming) -> Self {
        let (samples, last) = (RefCell::default(), RefCell::default());
        Passage { face, course, incoming, samples, last }
    }

    /// The loads with the incoming pair at `s`. The slices of the nearest known places are likely to
    /// touch again.
    fn loads(&self, s: f64) -> Result<Rc<Loads>, Refusal> {
        /// Of a base pitch.
        const SAME: f64 = 1e-12;
        let (samples, mut last) = (self.samples.borrow(), self.last.borrow_mut());
        let first = samples.partition_point(|known| known.s < s).saturating_sub(2);
        let known = samples[first..].iter().take(4).chain(last.as_ref());
        let mut near: Vec<Rc<Loads>> = known.map(Rc::clone).collect();
        let distance = |known: &Rc<Loads>| (known.s - s).abs();
        near.sort_by(|one, other| distance(one).total_cmp(&distance(other)));
        near.dedup_by(|one, other| one.s.to_bits() == other.s.to_bits());
        let same = SAME * self.face.mesh.base_pitch;
        if let Some(known) = near.first().filter(|near| distance(near) <= same) {
            return Ok(Rc::clone(known));
        }
        let mut position = self.face.position(s);
        self.incoming.change(&mut position, 0);
        let until = match self.course {
            Some(course) => Until::Displacement(course.at(s)[0]),
            None => Until::Force(self.face.mesh.force),
        };
        let loads = Rc::new(position.loads(until, &near, PRECISE)?);
        if !loads.displacement.is_finite() {
            return Err(Refusal::BeyondReach);
        }
        *last = Some(Rc::clone(&loads));
        Ok(loads)
    }

    fn samples(&self, places: &[f64]) -> Result<Vec<Rc<Loads>>, Refusal> {
        for &s in places {
            let loads = self.loads(s)?;
            self.samples.borrow_mut().push(loads);
        }
        Ok(self.samples.borrow().clone())
    }

    /// The greatest value, with its place, by samples and a search between them.
    fn greatest(&self, samples: &[Rc<Loads>], of: &dyn Fn(&Loads) -> f64) -> (f64, f64) {
        let known: Vec<_> = samples.iter().map(|loads| (loads.s, of(loads))).collect();
        let at = |s: f64| self.loads(s).map_or(f64::NEG_INFINITY, |loads| of(&loads));
        greatest_within(&known, PRECISION, at)
    }

    /// Places between two places, at which the load is smooth enough to be sampled; `part` of them.
    fn places(&self, from: f64, to: f64, part: usize) -> Vec<f64> {
        /// Bounds time and memory of a slow motion: pairs at slices in all samples.
        const MOST: usize = 400_000;
        /// Of the steps of a motion, which are many more than an oscillation needs to be seen.
        const EVERY: usize = 2;
        let step = self.face.step(to - from) * part as f64;
        // Stations are at the same halvings of the ways to E and from E.
        let even = |from: f64, to: f64| {
            let halvings = ((to - from) / step).log2().round().max(1.0);
            let count = halvings.exp2();
            (0..count as u32).map(move |step| from + (to - from) * f64::from(step) / count)
        };
        let middle = 0f64.clamp(from, to);
        let mut places: Vec<f64> = even(from, middle).chain(even(middle, to)).collect();
        places.push(to);
        places.dedup();
        if let Some(course) = self.course {
            let moments: Vec<f64> = course.places(from, to).collect();
            let every = (EVERY * part).max(moments.len() * 4 * self.face.slices.len() / MOST);
            if moments.len() / every > places.len() {
                places = moments.into_iter().step_by(every).collect();
                places.insert(0, from);
                places.push(to);
            }
        }
        places
    }

    /// The first and the last place with contact, in m. `None` without contact.
    fn ends(&self) -> Result<Option<(f64, f64)>, Refusal> {
        /// Of the places.
        const LOOKS: usize = 2;
        let (face, length) = (self.face, self.face.mesh.length);
        let (from, to) = face.mesh.ends();
        let looks = self.places(from - face.reach, to + face.reach, LOOKS);
        let carries = |at: usize| -> Result<Option<usize>, Refusal> {
            let (lead, _) = face.touch(&*self.loads(looks[at])?);
            Ok(Some(at).filter(|_| lead > 0.0))
        };
        let mut places = 0..looks.len();
        let found = places.find_map(|at| carries(at).transpose()).transpose()?;
        let Some(first) = found else {
            return Ok(None);
        };
        let last = places.rev().find_map(|at| carries(at).transpose()).transpose()?;
        let last = last.unwrap_or(first);
        if first == 0 || last + 1 == looks.len() {
            return Err(Refusal::BeyondReach);
        }
        // A lead among the errors of the balance counts as none.
        let lead = |s: f64| {
            self.loads(s).map_or(f64::NAN, |loads| {
                let lead = face.touch(&loads).0.clamp(-length, length);
                if lead.abs() > PRECISE * loads.displacement { lead } else { 0.0 }
            })
        };
        let root =
            |apart: usize, carrying: usize| root::between(looks[apart], looks[carrying], lead);
        Ok(Some((root(first - 1, first), root(last + 1, last))))
    }

    /// The load from the first to the last contact. `None` without contact.
    pub(super) fn run(&self, spacing: Spacing) -> Result<Option<Passed>, Refusal> {
        let (face, mesh) = (self.face, &self.face.mesh);
        let Some((first, last)) = self.ends()? else {
            return Ok(None);
        };
        let mut places = self.places(first, last, 1);
        // A strike at the exit of a spur pair can be shorter than a step.
        let before = places.len() - 1;
        if places[before - 1] <= mesh.length && mesh.length < last {
            places.insert(before, f64::midpoint(mesh.length, last));
        }
        let samples = self.samples(&places)?;
        let [first_place, last_place] =
            [0, samples.len() - 1].map(|end| face.touch(&samples[end]).1);
        let extreme = |of: &dyn Fn(&Loads) -> f64| self.greatest(&samples, of).1;
        let line_peak = |part: Part| {
            let best = Cell::new(None);
            extreme(&|loads| {
                let peak = face.line_peak(loads, part);
                let is_best =
                    best.get().is_none_or(|best: LinePeak| peak.line_load > best.line_load);
                best.set(if is_best { Some(peak) } else { best.get() });
                peak.line_load
            });
            best.get().filter(|peak| peak.line_load > 0.0)
        };
        let peak_force = extreme(&|loads| face.pair_force(loads, 0));
        let failed = Cell::new(None);
        let (stations, rough) = Station::through_start(first, last, |from, to| {
            spacing.stations(&[from, to], peak_force, STATIONS, |s| {
                let motion = self.course.map(|course| (s / course.speed, Some(course.at(s)[1])));
                let loads = self.loads(s).unwrap_or_else(|refusal| {
                    failed.set(Some(refusal));
                    Rc::clone(&samples[0])
                });
                let station = face.station(&loads, motion);
                (station.force, station)
            })
        });
        if let Some(refusal) = failed.into_inner() {
            return Err(refusal);
        }
        let ahead = |place: &FacePlace| -place.path / mesh.base_radii.1;
        let behind = |place: &FacePlace| (place.path - mesh.length) / mesh.base_radii.0;
        let [all, before_start, after_end] =
            [Part::All, Part::BeforeStart, Part::AfterEnd].map(line_peak);
        let peaks = [all, before_start, after_end].into_iter().flatten();
        let peak = peaks.max_by(|one, other| one.line_load.total_cmp(&other.line_load));
        let strike = |part: Part, peak: Option<LinePeak>, radius: f64| {
            let deepest = |loads: &Loads| face.deepest(loads, part);
            peak.map(|_| self.greatest_in_part(&samples, peak, &deepest).1 / radius)
        };
        let first_strike = || strike(Part::BeforeStart, before_start, mesh.base_radii.1);
        let last_strike = || strike(Part::AfterEnd, after_end, mesh.base_radii.0);
        let is_apart = |angle: &f64| *angle > 0.0;
        let at_slices =
            |loads: &Rc<Loads>| (0..face.slices.len()).map(|at| loads.at(0, at)).collect();
        let (approach_force, force_at_start) =
            self.tip_forces(&samples, (Part::BeforeStart, before_start), 0.0)?;
        let (recess_force, force_at_end) =
            self.tip_forces(&samples, (Part::AfterEnd, after_end), mesh.length)?;
        let load = StaticLoad {
            first_contact_angle: Some(ahead(&first_place)).filter(is_apart).or_else(first_strike),
            last_contact_angle: Some(behind(&last_place)).filter(is_apart).or_else(last_strike),
            force_at_start,
            force_at_end,
            approach_force,
            recess_force,
            peak_force,
            transmission_error: extreme(&|loads| loads.displacement)
                + extreme(&|loads| -loads.displacement),
            pitch_jump: None,
            stations,
            rough,
        };
        Ok(Some(Passed {
            load,
            face: FaceLoad {
                first: first_place,
                last: last_place,
                least_gap: None,
                peak: peak.ok_or(Refusal::BeyondReach)?,
                before_start,
                after_end,
                pattern: samples.iter().map(at_slices).collect(),
                paths: places,
            },
            samples,
        }))
    }

    /// The greatest value in a part of the path and its place, with the greatest line load there.
    /// Reliefs can let the tooth touch after E at its end and before E farther inside; alike at B. A strike
    /// shorter than the steps between the samples is beside its greatest line load.
    fn greatest_in_part(
        &self,
        samples: &[Rc<Loads>],
        peak: Option<LinePeak>,
        of: &dyn Fn(&Loads) -> f64,
    ) -> (f64, f64) {
        /// Of a base pitch, down to the shortest strike.
        const HALVINGS: u32 = 20;
        let found = self.greatest(samples, of);
        let Some(LinePeak { place, .. }) = peak.filter(|_| found.1 <= 0.0) else {
            return found;
        };
        let there = place.path - place.z * self.face.inputs.lead;
        let pitch = self.face.mesh.base_pitch;
        let ways = (0..HALVINGS).map(|halvings| pitch / f64::from(1_u32 << halvings));
        let before = ways.clone().map(|way| there - way);
        let beside = before.chain([there]).chain(ways.rev().map(|way| there + way));
        let beside: Vec<_> = beside.filter_map(|s| self.loads(s).ok()).collect();
        self.greatest(&beside, of)
    }

    /// The greatest force in a part of the path that ends at `end`, and the greatest while slices pass
    /// this end, in N.
    fn tip_forces(
        &self,
        samples: &[Rc<Loads>],
        (part, peak): (Part, Option<LinePeak>),
        end: f64,
    ) -> Result<(f64, f64), Refusal> {
        let face = self.face;
        let of = |loads: &Loads| face.force(loads, 0, part);
        let (place, greatest) = self.greatest_in_part(samples, peak, &of);
        let (from, to) = (end - face.reach, end + face.reach);
        if greatest <= 0.0 || (from <= place && place <= to) {
            return Ok((greatest, greatest));
        }
        let aside = INSIDE * face.mesh.length;
        let inner = samples.iter().filter(|loads| from < loads.s && loads.s < to).map(Rc::clone);
        let mut passing = vec![self.loads(from - aside)?];
        passing.extend(inner.chain([self.loads(to + aside)?]));
        Ok((greatest, self.greatest(&passing, &of).1))
    }

    /// The time from the first contact to the first valley of the force, in s, with its greatest value in
    /// N. `None` at rest.
    pub(super) fn first_minimum(&self, samples: &[Rc<Loads>], greatest: f64) -> Option<f64> {
        let (course, length) = (self.course?, self.face.mesh.length);
        let ends = [&samples[0], &samples[samples.len() - 1]].map(|loads| loads.s);
        // A bounce can be shorter than the distance of the samples, and a valley be a bend at E or B.
        let inner = course.places(ends[0], ends[1]).chain([0.0, length]);
        let mut places: Vec<f64> =
            inner.filter(|s| ends[0] < *s && *s < ends[1]).chain(ends).collect();
        places.sort_by(f64::total_cmp);
        let of = |loads: &Loads| self.face.pair_force(loads, 0);
        let forces = places.iter().map_while(|s| self.loads(*s).ok()).map(|loads| of(&loads));
        let least = first_valley(forces, greatest)?;
        let near = &places[least - 1..=(least + 1).min(places.len() - 1)];
        let negative = |s: f64| self.loads(s).map_or(f64::NEG_INFINITY, |loads| -of(&loads));
        let near: Vec<_> = near.iter().map(|s| (*s, negative(*s))).collect();
        // The place of a valley needs a much more precise value than its force.
        let (s, _) = root::greatest(&near, negative);
        Some((s - ends[0]) / course.speed)
    }
}

#[cfg(test)]
mod tests;
