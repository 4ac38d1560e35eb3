//! Results of a run: the stored steps, the incoming tooth's contacts, peaks and stations, and the
//! strikes of the back flanks.

use std::cell::Cell;

use super::motion::{Course, Step};
use super::motion::{Motion, State, Window};
use super::{Dynamic, Settings};
use crate::model::Refusal;
use crate::model::budget::{CURVE_WORK, STATIONS, TURNS};
use crate::model::pair_forces::Touching;
use crate::model::stations::Spacing;
use crate::model::stations::Station;
use crate::numeric::polynomial::{extremes, sign_changes};

/// Memory of a growing list, relative to its contents: twice the contents in the new place and once
/// in the old.
const GROWTH: usize = 3;

/// Records of a run.
#[derive(Default)]
pub(super) struct Watch {
    passages: Vec<Passage>,
    /// Whether the current steps belong to the last passage.
    is_passing: bool,
    /// Whether steps are not stored.
    forgets: bool,
    bytes: usize,
    touches: Vec<f64>,
    leaves: Vec<f64>,
    pub(super) most_ahead: f64,
    contact_lost: bool,
    rattle: RattleWatch,
    /// Number of evaluations of series.
    looks: Cell<u64>,
}

/// Rise and fall of the incoming tooth's force in a run.
#[derive(Default)]
struct Swings {
    /// Greatest force, in N.
    peak: f64,
    /// Greatest force before E, in N.
    peak_before_start: f64,
    /// Times of the turning points, in s.
    turns: Vec<f64>,
    /// Times in s and forces in N at the ends of stretches with a monotonic force.
    ends: Vec<(f64, f64)>,
}

impl Watch {
    /// An observer that stores no steps and detects only loss of contact.
    pub(super) fn of_contact_alone() -> Watch {
        Watch { forgets: true, ..Watch::default() }
    }

    /// The following steps belong to this window.
    pub(super) fn enter(&mut self, window: &Window) {
        self.is_passing = !self.forgets && window.incoming().is_some();
        if let Some(incoming) = window.incoming().filter(|_| self.is_passing) {
            self.passages.pop_if(|last| last.records.is_empty());
            self.bytes += GROWTH * size_of::<Passage>() + size_of_val(&*window.pairs);
            self.passages.push(Passage { window: window.clone(), incoming, records: Vec::new() });
        }
    }

    /// Stores a step. `most` is the greatest displacement of the driver in this step.
    pub(super) fn keep(&mut self, course: &Course<'_>, touching: Touching, step: Step, most: f64) {
        let motion = course.motion;
        self.most_ahead = self.most_ahead.max(most);
        let has_begun = motion.place(step.t) >= -motion.mesh.base_pitch * (1.0 + f64::EPSILON);
        self.contact_lost |= has_begun && course.window.working(touching).is_none();
        self.rattle.see(course, &step, has_begun && !self.forgets);
        if let Some(passage) = self.passages.last_mut().filter(|_| self.is_passing) {
            self.bytes += passage.keep(Record { touching, step });
        }
    }

    /// Memory of the stored steps, in bytes, with the capacity of the lists.
    pub(super) fn bytes(&self) -> usize {
        self.bytes
    }

    /// Whether at any time since one base pitch before E no pair touched.
    pub(super) fn contact_lost(&self) -> bool {
        self.contact_lost
    }

    /// The incoming pair gains or loses contact.
    pub(super) fn turn(&mut self, t: f64, touches: bool) {
        self.bytes += GROWTH * size_of::<f64>();
        if touches {
            self.touches.push(t);
        } else {
            self.leaves.push(t);
            self.rattle.leave();
        }
    }

    /// Whether the incoming pair has finally left: after B, without contact, and with a gap greater
    /// than the driver's greatest lead.
    pub(super) fn is_over(&self, motion: &Motion<'_>) -> bool {
        let mut passages = self.passages.iter().rev();
        let last = passages.find_map(|passage| Some((passage, passage.records.last()?)));
        let Some((passage, record)) = last else {
            return false;
        };
        let t = record.step.end();
        let gap = passage.course(motion, record).gap(passage.incoming, t);
        motion.place(t) > motion.mesh.length
            && self.touches.len() == self.leaves.len()
            && gap - record.step.state(1.0)[0] > 2.0 * self.most_ahead
    }

    /// The results for the incoming tooth.
    pub(super) fn finish(
        &self,
        motion: &Motion<'_>,
        settings: &Settings,
    ) -> Result<Dynamic, Refusal> {
        let mesh = motion.mesh;
        if self.touches.len() != self.leaves.len() {
            return Err(Refusal::BeyondReach);
        }
        let (first, last) = (self.touches.first().copied(), self.leaves.last().copied());
        let early = first.filter(|&first| first < 0.0);
        let after_end = |t: f64| {
            Some((motion.place(t) - mesh.length) / mesh.base_radii.0).filter(|&angle| angle > 0.0)
        };
        let swings = self.swings(motion);
        let valley = || first_valley(swings.ends.iter().map(|(_, force)| *force), swings.peak);
        let (stations, rough) = first.zip(last).map_or((Vec::new(), None), |contact| {
            self.stations(motion, &swings, contact, settings.spacing)
        });
        Ok(Dynamic {
            first_contact_angle: early.map(|first| -motion.place(first) / mesh.base_radii.1),
            last_contact_angle: last.and_then(after_end),
            peak_approach_force: swings.peak_before_start,
            peak_force: swings.peak,
            impact_duration: early.and_then(|first| valley().map(|at| swings.ends[at].0 - first)),
            least_gap: early.is_none().then(|| -self.lead(motion)).filter(|gap| gap.is_finite()),
            contact_lost: self.contact_lost,
            rattle: motion.has_backlash().then(|| self.rattle.found()),
            friction_work: (mesh.friction() > 0.0).then(|| self.friction_work(motion)),
            approach: early.map_or_else(Vec::new, |first| {
                self.approach(motion, (&swings.turns, settings.approach_samples), first)
            }),
            stations,
            rough,
            evaluations: self.looks.get(),
            work: 0,
        })
    }

    /// The incoming pair's places and forces at even times and at the turning points of the force,
    /// from the first contact to E.
    fn approach(
        &self,
        motion: &Motion<'_>,
        (turns, samples): (&[f64], usize),
        first: f64,
    ) -> Vec<(f64, f64)> {
        if samples == 0 {
            return Vec::new();
        }
        let even = (0..=samples).map(|at| first * (1.0 - at as f64 / samples as f64));
        let turns = turns.iter().copied().filter(|&turn| turn < 0.0).take(TURNS);
        even.chain(turns)
            .filter_map(|t| Some((motion.place(t), self.moment(motion, t)?.2)))
            .collect()
    }

    /// Every stored step with its passage, in order.
    fn records(&self) -> impl Iterator<Item = (&Passage, &Record)> + Clone {
        self.passages
            .iter()
            .flat_map(|passage| passage.records.iter().map(move |record| (passage, record)))
    }

    /// Every stored step with its stiffness and load, and the index of the incoming pair in the
    /// window.
    pub(super) fn steps<'a>(
        &'a self,
        motion: &'a Motion<'a>,
    ) -> impl Iterator<Item = (Course<'a>, usize, &'a Step)> {
        self.records().map(|(passage, record)| {
            (passage.course(motion, record), passage.incoming, &record.step)
        })
    }

    /// Greatest difference of the driver's lead and the gap of the incoming tooth before E, in m,
    /// for a tooth without contact.
    fn lead(&self, motion: &Motion<'_>) -> f64 {
        let apart = self
            .steps(motion)
            .filter(|(course, incoming, step)| step.t < 0.0 && !course.touches(*incoming));
        apart.fold(f64::NEG_INFINITY, |lead, (course, incoming, step)| {
            course.lead_along(incoming, step).most(&step.ahead, lead)
        })
    }

    fn swings(&self, motion: &Motion<'_>) -> Swings {
        let mut swings = Swings::default();
        for (course, incoming, step) in self.steps(motion) {
            if !course.touches(incoming) {
                continue;
            }
            let force = course.force_along(incoming, step);
            let turns = sign_changes(&force.derivative());
            let time = |part: f64| step.t + part * step.length;
            swings.turns.extend(turns.iter().map(|&part| time(part)));
            let ends: Vec<f64> =
                std::iter::once(0.0).chain(turns).chain(std::iter::once(1.0)).collect();
            swings.peak = ends.iter().map(|&part| force.at(part)).fold(swings.peak, f64::max);
            // A step ends at E within rounding.
            if step.t + 0.5 * step.length < 0.0 {
                swings.peak_before_start = swings.peak;
            }
            swings.ends.extend(ends[1..].iter().map(|&part| (time(part), force.at(part))));
        }
        swings
    }

    /// ∫ μ F |ΔVτ| dt of the incoming tooth, in J.
    fn friction_work(&self, motion: &Motion<'_>) -> f64 {
        let carried = self.steps(motion).filter(|(course, incoming, _)| course.touches(*incoming));
        let rubbed = carried
            .map(|(course, incoming, step)| step.length * course.rubbing_along(incoming, step));
        motion.mesh.friction() * rubbed.sum::<f64>()
    }

    /// Stations from the first contact to E and from E to the last contact. If their number is
    /// given, adds a station at every turning point of the force, so that the stations include
    /// every peak.
    fn stations(
        &self,
        motion: &Motion<'_>,
        swings: &Swings,
        (first, last): (f64, f64),
        spacing: Spacing,
    ) -> (Vec<Station>, Option<Refusal>) {
        let (peak, turns) = (swings.peak, &*swings.turns);
        let is_given = matches!(spacing, Spacing::Even(_));
        let (stations, rough) = Station::through_start(first, last, |from, to| {
            let ends = if is_given { vec![from, to] } else { self.ends(motion, turns, (from, to)) };
            let (times, rough) = spacing.stations(&ends, peak, CURVE_WORK, |t| {
                self.looks.set(self.looks.get() + 1);
                // Without a given number, the heights decide.
                let moment = (!is_given).then(|| self.moment(motion, t)).flatten();
                (moment.map_or(f64::NAN, |(.., force)| force), t)
            });
            let (times, thinned) = at_most(STATIONS, times);
            let mut stations = Vec::with_capacity(times.len());
            stations.extend(times.into_iter().filter_map(|t| self.station(motion, t)));
            (stations, rough.or(thinned))
        });
        if is_given {
            let most = turns.len().min(TURNS);
            let is_cut = most < turns.len();
            let cut = is_cut.then_some(Refusal::CurveTooRough { limit: TURNS });
            let stations = self.with_turns(motion, &turns[..most], stations);
            return (stations, rough.or(cut));
        }
        (stations, rough)
    }

    /// Times between which the force is smooth, has no turning point, and has no hidden
    /// oscillation.
    fn ends(&self, motion: &Motion<'_>, turns: &[f64], (from, to): (f64, f64)) -> Vec<f64> {
        let bends = self
            .records()
            .zip(self.records().skip(1))
            .filter(|((passage, record), (next, other))| {
                !std::ptr::eq(*passage, *next) || record.touching != other.touching
            })
            .map(|(_, (_, other))| other.step.t);
        let mut knots: Vec<f64> =
            turns.iter().copied().chain(bends).filter(|&knot| from < knot && knot < to).collect();
        knots.extend([from, to]);
        knots.sort_by(f64::total_cmp);
        let between = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            let parts = ((to - from) / motion.half_swing()).ceil().max(1.0) as usize;
            (0..parts).map(move |part| from + (to - from) * part as f64 / parts as f64)
        };
        knots.windows(2).flat_map(between).chain([to]).collect()
    }

    /// The stations and the turning points of the force. Omits turning points very close to a
    /// station.
    fn with_turns(
        &self,
        motion: &Motion<'_>,
        turns: &[f64],
        stations: Vec<Station>,
    ) -> Vec<Station> {
        const BESIDE: f64 = 0.02;
        let mut all = Vec::with_capacity(stations.len());
        let mut rest = stations.into_iter().peekable();
        for &turn in turns {
            let is_before = |station: &Station| station.time().is_some_and(|time| time < turn);
            while let Some(station) = rest.next_if(is_before) {
                all.push(station);
            }
            let time = |station: Option<&Station>| station.and_then(Station::time);
            let ends = time(all.last()).zip(time(rest.peek()));
            let is_apart =
                |(from, to): (f64, f64)| (turn - from).min(to - turn) > BESIDE * (to - from);
            if ends.is_some_and(is_apart) {
                self.looks.set(self.looks.get() + 1);
                all.extend(self.station(motion, turn));
            }
        }
        all.extend(rest);
        all.shrink_to_fit();
        all
    }

    fn station(&self, motion: &Motion<'_>, t: f64) -> Option<Station> {
        let (course, state, force) = self.moment(motion, t)?;
        let (s, total) = (motion.place(t), course.total(t, state[0]));
        Some(Station::at(motion.mesh, s, force, total, state[0], Some((t, Some(state[1])))))
    }

    /// The motion at a time from the stored steps, and the force of the incoming tooth, in N.
    fn moment<'a>(&'a self, motion: &'a Motion<'a>, t: f64) -> Option<(Course<'a>, State, f64)> {
        let begins = |record: &Record| record.step.t <= t;
        let has_begun = |passage: &Passage| passage.records.first().is_some_and(begins);
        let next = self.passages.partition_point(has_begun);
        let passage = self.passages.get(next.saturating_sub(1))?;
        let next = passage.records.partition_point(begins);
        let record = passage.records.get(next.saturating_sub(1))?;
        let (course, incoming) = (passage.course(motion, record), passage.incoming);
        let state = record.step.state((t - record.step.t) / record.step.length);
        let touches = course.touches(incoming);
        let force = if touches { course.force(incoming, t, state[0]).max(0.0) } else { 0.0 };
        Some((course, state, force))
    }
}

/// At most `most` of the times, evenly selected, with the first and the last time.
fn at_most(most: usize, times: Vec<f64>) -> (Vec<f64>, Option<Refusal>) {
    if times.len() <= most {
        return (times, None);
    }
    let last = times.len() - 1;
    let chosen = (0..most).map(|at| times[at * last / (most - 1)]);
    (chosen.collect(), Some(Refusal::CurveTooRough { limit: most }))
}

/// The place of the first valley after the first peak of a force, or of the loss of contact. A fall or
/// a rise of less than a hundredth of the greatest force is no valley.
pub(in crate::model) fn first_valley(
    forces: impl Iterator<Item = f64>,
    greatest: f64,
) -> Option<usize> {
    let [ripple, rounding] = [0.01, 1e-9].map(|part| part * greatest);
    let (mut peak, mut valley) = (0.0, None);
    for (at, force) in forces.enumerate() {
        match valley {
            None if force >= peak => peak = force,
            None if force < peak - ripple => valley = Some((at, force)),
            Some((_, least)) if force < least - rounding => valley = Some((at, force)),
            Some((_, least)) if force > least + ripple => break,
            _ => {}
        }
    }
    valley.map(|(at, _)| at)
}

/// Strikes and force of the back flanks.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rattle {
    /// Number of times that back flanks touch after none touched.
    pub strikes: u32,
    /// Greatest force of a pair of back flanks, in N.
    pub force: f64,
}

/// Observes the back flanks during a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct RattleWatch {
    found: Rattle,
    touches: bool,
    /// The results when the incoming pair last lost contact.
    at_leave: Option<Rattle>,
}

impl RattleWatch {
    /// An observer for a run that begins with or without touching back flanks.
    pub(super) fn from(touches: bool) -> RattleWatch {
        RattleWatch { touches, ..RattleWatch::default() }
    }

    /// Observes a step. `counts` is false for steps of the warm-up.
    pub(super) fn see(&mut self, course: &Course<'_>, step: &Step, counts: bool) {
        let touches = course.back_pairs().next().is_some();
        if counts {
            self.found.strikes += u32::from(touches && !self.touches);
            let forces = course
                .back_pairs()
                .map(|pair| extremes(&course.force_along(pair, step)).fold(0.0, f64::max));
            self.found.force = forces.fold(self.found.force, f64::max);
        }
        self.touches = touches;
    }

    /// The incoming pair loses contact. Later steps count only if the pair touches again.
    pub(super) fn leave(&mut self) {
        self.at_leave = Some(self.found);
    }

    pub(super) fn found(&self) -> Rattle {
        self.at_leave.unwrap_or(self.found)
    }
}

/// A step of the run.
struct Record {
    touching: Touching,
    step: Step,
}

/// The steps of a window in which the incoming pair may touch.
struct Passage {
    window: Window,
    /// The incoming pair's index in the window.
    incoming: usize,
    records: Vec<Record>,
}

impl Passage {
    /// Stores a step. The list grows by a quarter, so that the old and the new list together use
    /// less than 2.25 times the budget. Returns the growth in bytes.
    fn keep(&mut self, record: Record) -> usize {
        const LEAST: usize = 16;
        let room = self.records.capacity();
        if self.records.len() == room {
            self.records.reserve_exact((room / 4).max(LEAST));
        }
        self.records.push(record);
        (self.records.capacity() - room) * size_of::<Record>()
    }

    fn course<'a>(&'a self, motion: &'a Motion<'a>, record: &Record) -> Course<'a> {
        Course::new(motion, &self.window, record.touching)
    }
}
