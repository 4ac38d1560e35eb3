//! What is read off a run: the incoming tooth's contacts, peaks and stations.

use std::cell::Cell;

use super::motion::{Forces, Motion, State, Touching, Window};
use super::swing::{self, Stretch};
use super::{Dynamic, Effort};
use crate::model::Refusal;
use crate::model::spacing::Spacing;
use crate::model::stations::MeshStation;
use crate::numeric::ode::Point;

/// A step of the run while the incoming pair may touch.
struct Record {
    window: usize,
    touching: Touching,
    from: Point<3>,
    length: f64,
    to: State,
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
    evaluations: Cell<u64>,
}

impl Watch {
    /// From now on the steps belong to this window.
    pub(super) fn enter(&mut self, window: &Window) {
        self.windows.push(window.clone());
    }

    /// Keep a step that leads from `from` to `to`.
    pub(super) fn keep(&mut self, motion: &Motion<'_>, touching: Touching, from: Point<3>, length: f64, to: State) {
        self.most_ahead = self.most_ahead.max(to[0]);
        let has_begun = motion.place(from.t) >= -motion.mesh.base_pitch * (1.0 + f64::EPSILON);
        self.contact_lost |= has_begun && touching.is_none() && length > 0.0;
        let window = self.windows.len() - 1;
        if self.windows[window].incoming().is_some() {
            self.records.push(Record { window, touching, from, length, to });
        }
    }

    /// The incoming pair touches or leaves.
    pub(super) fn turn(&mut self, t: f64, touches: bool) {
        if touches { self.touches.push(t) } else { self.leaves.push(t) }
    }

    /// Whether the incoming pair has left for good: past B, apart, and further apart than the driver ever was ahead.
    pub(super) fn is_over(&self, motion: &Motion<'_>) -> bool {
        let Some(record) = self.records.last() else { return false };
        let t = record.from.t + record.length;
        let Some(incoming) = self.windows[record.window].incoming() else { return false };
        let forces = self.forces(motion, record);
        let apart = record.to[0] - forces.pressed(incoming, t, &record.to).0;
        motion.place(t) > motion.mesh.length && self.touches.len() == self.leaves.len() && apart > 2.0 * self.most_ahead
    }

    /// What the incoming tooth carried.
    pub(super) fn finish(&self, motion: &Motion<'_>, spacing: Spacing, effort: Effort) -> Result<Dynamic, Refusal> {
        let mesh = motion.mesh;
        if self.touches.len() != self.leaves.len() {
            return Err(Refusal::BeyondReach);
        }
        let (first, last) = (self.touches.first().copied(), self.leaves.last().copied());
        let before_start = |t: f64| (t < 0.0).then(|| -motion.place(t) / mesh.base_radii.1);
        let after_end = |t: f64| Some((motion.place(t) - mesh.length) / mesh.base_radii.0).filter(|&angle| angle > 0.0);
        let work = self.records.last().map_or(0.0, |record| record.to[2]);
        let stretches = self.stretches(motion);
        let peak_force = swing::peak(&stretches);
        let before = stretches.partition_point(Stretch::is_before_start);
        Ok(Dynamic {
            first_contact_angle: first.and_then(before_start),
            last_contact_angle: last.and_then(after_end),
            peak_approach_force: swing::peak(&stretches[..before]),
            peak_force,
            impact_duration: first.and_then(|first| swing::end_of_first_impact(&stretches).map(|end| end - first)),
            contact_lost: self.contact_lost,
            friction_work: (mesh.friction() > 0.0).then_some(work),
            stations: first
                .zip(last)
                .map_or_else(Vec::new, |(first, last)| self.stations(motion, first, last, peak_force, spacing)),
            effort: Effort { evaluations: effort.evaluations + self.evaluations.get(), ..effort },
        })
    }

    fn forces<'a>(&'a self, motion: &'a Motion<'a>, record: &Record) -> Forces<'a> {
        Forces::new(motion, &self.windows[record.window], record.touching, &self.evaluations)
    }

    /// Show every kept step, with what acts in it.
    #[cfg(test)]
    pub(super) fn each_step(&self, motion: &Motion<'_>, mut show: impl FnMut(&Forces<'_>, &Point<3>, f64, &State)) {
        for record in &self.records {
            show(&self.forces(motion, record), &record.from, record.length, &record.to);
        }
    }

    /// The steps in which the incoming tooth carries, cut where its force may turn more than once.
    fn stretches<'a>(&'a self, motion: &'a Motion<'a>) -> Vec<Stretch<'a>> {
        let carried = self.records.iter().filter_map(|record| {
            let incoming = self.windows[record.window].incoming().filter(|&pair| record.touching.has(pair))?;
            Some((self.forces(motion, record), incoming, record))
        });
        let cut = |(forces, incoming, record): (Forces<'a>, usize, &'a Record)| {
            Stretch::of(forces, incoming, (&record.from, record.length, &record.to))
        };
        carried.flat_map(cut).collect()
    }

    /// Stations from the first contact to E and from there to the last, and one wherever the force turns, so that none of
    /// its peaks falls between two of them.
    fn stations(&self, motion: &Motion<'_>, first: f64, last: f64, peak: f64, spacing: Spacing) -> Vec<MeshStation> {
        let found = |from: f64, to: f64| {
            spacing.stations(from, to, peak, |t| {
                let station = self.station(motion, t);
                (station.map_or(f64::NAN, |station| station.force), station)
            })
        };
        let stations = MeshStation::through_start(first, last, |from, to| found(from, to).into_iter().flatten().collect());
        self.with_turns(motion, stations)
    }

    /// The stations and those where the force neither grows nor falls, but for what stands beside one of them anyhow.
    fn with_turns(&self, motion: &Motion<'_>, mut stations: Vec<MeshStation>) -> Vec<MeshStation> {
        const BESIDE: f64 = 0.02;
        let stretches = self.stretches(motion);
        for turn in swing::turns(&stretches) {
            let time = |at: usize| stations.get(at).and_then(|station| station.time);
            let after = stations.partition_point(|station| station.time.is_some_and(|time| time < turn));
            let ends = after.checked_sub(1).and_then(time).zip(time(after));
            let is_apart = |(from, to): (f64, f64)| (turn - from).min(to - turn) > BESIDE * (to - from);
            if ends.is_some_and(is_apart) {
                stations.splice(after..after, self.station(motion, turn));
            }
        }
        stations
    }

    fn station(&self, motion: &Motion<'_>, t: f64) -> Option<MeshStation> {
        let next = self.records.partition_point(|record| record.from.t <= t);
        let record = self.records.get(next.saturating_sub(1))?;
        let forces = self.forces(motion, record);
        let state = forces.after(&record.from, t - record.from.t);
        let incoming = self.windows[record.window].incoming()?;
        let force = if record.touching.has(incoming) { forces.force(incoming, t, &state).0.max(0.0) } else { 0.0 };
        let station = MeshStation::at(motion.mesh, motion.place(t), force, forces.total(t, &state), state[0], Some(t));
        Some(MeshStation { rate: Some(state[1]), ..station })
    }
}
