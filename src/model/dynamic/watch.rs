//! What is read off a run: the incoming tooth's contacts, peaks and stations.

use std::cell::Cell;

use super::motion::{Motion, Touching, Window};
use super::step::{Course, Step};
use super::swing::{self, Swing};
use super::{Dynamic, Effort};
use crate::model::Refusal;
use crate::model::spacing::Spacing;
use crate::model::stations::MeshStation;

/// A step of the run while the incoming pair may touch.
struct Record {
    window: usize,
    touching: Touching,
    step: Step,
}

/// Records of a run.
#[derive(Default)]
pub(super) struct Watch {
    windows: Vec<Window>,
    records: Vec<Record>,
    touches: Vec<f64>,
    leaves: Vec<f64>,
    most_ahead: f64,
    contact_lost: bool,
    /// Places at which the series were looked at.
    looks: Cell<u64>,
}

impl Watch {
    /// From now on the steps belong to this window.
    pub(super) fn enter(&mut self, window: &Window) {
        self.windows.push(window.clone());
    }

    /// Keep a step, in which the driver is never more than `most` ahead.
    pub(super) fn keep(&mut self, motion: &Motion<'_>, touching: Touching, step: Step, most: f64) {
        self.most_ahead = self.most_ahead.max(most);
        let has_begun = motion.place(step.t) >= -motion.mesh.base_pitch * (1.0 + f64::EPSILON);
        self.contact_lost |= has_begun && touching.is_none();
        let window = self.windows.len() - 1;
        if self.windows[window].incoming().is_some() {
            self.records.push(Record {
                window,
                touching,
                step,
            });
        }
    }

    /// Whether no pair at all touched at some moment since one base pitch before E.
    pub(super) fn contact_lost(&self) -> bool {
        self.contact_lost
    }

    /// The incoming pair touches or leaves.
    pub(super) fn turn(&mut self, t: f64, touches: bool) {
        if touches {
            self.touches.push(t);
        } else {
            self.leaves.push(t);
        }
    }

    /// Whether the incoming pair has left for good: past B, apart, and further apart than the
    /// driver ever was ahead.
    pub(super) fn is_over(&self, motion: &Motion<'_>) -> bool {
        let Some(record) = self.records.last() else {
            return false;
        };
        let t = record.step.end();
        let Some(incoming) = self.windows[record.window].incoming() else {
            return false;
        };
        let apart = self.course(motion, record).gap(incoming, t) - record.step.state(1.0)[0];
        motion.place(t) > motion.mesh.length
            && self.touches.len() == self.leaves.len()
            && apart > 2.0 * self.most_ahead
    }

    /// What the incoming tooth carried.
    pub(super) fn finish(
        &self,
        motion: &Motion<'_>,
        spacing: Spacing,
        effort: Effort,
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
        let peak_force = swing::peak(&swings);
        let before = swings.partition_point(Swing::is_before_start);
        Ok(Dynamic {
            first_contact_angle: early.map(|first| -motion.place(first) / mesh.base_radii.1),
            last_contact_angle: last.and_then(after_end),
            peak_approach_force: swing::peak(&swings[..before]),
            peak_force,
            impact_duration: early
                .and_then(|first| swing::end_of_first_impact(&swings).map(|end| end - first)),
            least_gap: early
                .is_none()
                .then(|| -self.lead(motion))
                .filter(|gap| gap.is_finite()),
            contact_lost: self.contact_lost,
            friction_work: (mesh.friction() > 0.0).then(|| self.friction_work(motion)),
            stations: first.zip(last).map_or_else(Vec::new, |(first, last)| {
                self.stations(motion, &swings, (first, last), spacing)
            }),
            effort: Effort {
                evaluations: effort.evaluations + self.looks.get(),
                ..effort
            },
        })
    }

    fn course<'a>(&'a self, motion: &'a Motion<'a>, record: &Record) -> Course<'a> {
        Course::new(motion, &self.windows[record.window], record.touching)
    }

    /// Show every kept step, with what acts in it.
    #[cfg(test)]
    pub(super) fn each_step(&self, motion: &Motion<'_>, mut show: impl FnMut(&Course<'_>, &Step)) {
        for record in &self.records {
            show(&self.course(motion, record), &record.step);
        }
    }

    /// The steps in which the incoming tooth carries, with what acts in them and its place in the
    /// window.
    fn carried<'a>(
        &'a self,
        motion: &'a Motion<'a>,
    ) -> impl Iterator<Item = (Course<'a>, usize, &'a Step)> {
        self.records.iter().filter_map(move |record| {
            let incoming = self.windows[record.window]
                .incoming()
                .filter(|&pair| record.touching.has(pair))?;
            Some((self.course(motion, record), incoming, &record.step))
        })
    }

    /// The most by which the driver is further ahead before E than the gap of an incoming tooth
    /// that does not touch is wide, in m.
    fn lead(&self, motion: &Motion<'_>) -> f64 {
        let before = self.records.iter().filter(|record| record.step.t < 0.0);
        before.fold(f64::NEG_INFINITY, |lead, record| {
            let Some(incoming) = self.windows[record.window].incoming() else {
                return lead;
            };
            let [_, gap] = self
                .course(motion, record)
                .spring_along(incoming, &record.step);
            record.step.most_beyond(&gap, lead)
        })
    }

    fn swings(&self, motion: &Motion<'_>) -> Vec<Swing> {
        self.carried(motion)
            .map(|(course, incoming, step)| Swing::of(step, &course.force_along(incoming, step)))
            .collect()
    }

    /// ∫ μ F |ΔVτ| dt of the incoming tooth, in J.
    fn friction_work(&self, motion: &Motion<'_>) -> f64 {
        let rubbed = self
            .carried(motion)
            .map(|(course, incoming, step)| step.length * course.rubbing_along(incoming, step));
        motion.mesh.friction() * rubbed.sum::<f64>()
    }

    /// Stations from the first contact to E and from there to the last; where their number is
    /// given, one wherever the force turns as well, so that none of its peaks falls between two of
    /// them.
    fn stations(
        &self,
        motion: &Motion<'_>,
        swings: &[Swing],
        (first, last): (f64, f64),
        spacing: Spacing,
    ) -> Vec<MeshStation> {
        let peak = swing::peak(swings);
        let turns: Vec<f64> = swings.iter().flat_map(Swing::turns).collect();
        let is_given = spacing.count().is_some();
        let found = |from: f64, to: f64| {
            let ends = if is_given {
                vec![from, to]
            } else {
                self.ends(motion, &turns, (from, to))
            };
            spacing.stations(&ends, peak, |t| {
                let station = self.station(motion, t);
                (station.map_or(f64::NAN, |station| station.force), station)
            })
        };
        let stations = MeshStation::through_start(first, last, |from, to| {
            found(from, to).into_iter().flatten().collect()
        });
        if is_given {
            self.with_turns(motion, &turns, stations)
        } else {
            stations
        }
    }

    /// The times between which the force is smooth, turns nowhere, and no swing has room to hide
    /// in.
    fn ends(&self, motion: &Motion<'_>, turns: &[f64], (from, to): (f64, f64)) -> Vec<f64> {
        let is_other = |pair: &&[Record]| {
            (pair[0].window, pair[0].touching) != (pair[1].window, pair[1].touching)
        };
        let bends = self
            .records
            .windows(2)
            .filter(is_other)
            .map(|pair| pair[1].step.t);
        let mut knots: Vec<f64> = turns
            .iter()
            .copied()
            .chain(bends)
            .filter(|&knot| from < knot && knot < to)
            .collect();
        knots.extend([from, to]);
        knots.sort_by(f64::total_cmp);
        let between = |pair: &[f64]| {
            let (from, to) = (pair[0], pair[1]);
            let parts = ((to - from) / motion.half_swing()).ceil().max(1.0) as usize;
            (0..parts).map(move |part| from + (to - from) * part as f64 / parts as f64)
        };
        knots.windows(2).flat_map(between).chain([to]).collect()
    }

    /// The stations and those where the force neither grows nor falls, but for what stands beside
    /// one of them anyhow.
    fn with_turns(
        &self,
        motion: &Motion<'_>,
        turns: &[f64],
        mut stations: Vec<MeshStation>,
    ) -> Vec<MeshStation> {
        const BESIDE: f64 = 0.02;
        for &turn in turns {
            let time = |at: usize| stations.get(at).and_then(|station| station.time);
            let after =
                stations.partition_point(|station| station.time.is_some_and(|time| time < turn));
            let ends = after.checked_sub(1).and_then(time).zip(time(after));
            let is_apart =
                |(from, to): (f64, f64)| (turn - from).min(to - turn) > BESIDE * (to - from);
            if ends.is_some_and(is_apart) {
                stations.splice(after..after, self.station(motion, turn));
            }
        }
        stations
    }

    fn station(&self, motion: &Motion<'_>, t: f64) -> Option<MeshStation> {
        self.looks.set(self.looks.get() + 1);
        let next = self.records.partition_point(|record| record.step.t <= t);
        let record = self.records.get(next.saturating_sub(1))?;
        let course = self.course(motion, record);
        let state = record.step.state((t - record.step.t) / record.step.length);
        let incoming = self.windows[record.window].incoming()?;
        let force = if record.touching.has(incoming) {
            course.force(incoming, t, state[0]).max(0.0)
        } else {
            0.0
        };
        let station = MeshStation::at(
            motion.mesh,
            motion.place(t),
            force,
            course.total(t, state[0]),
            state[0],
            Some(t),
        );
        Some(MeshStation {
            rate: Some(state[1]),
            ..station
        })
    }
}
