//! The computed motion of a pair over its face width.

use crate::model::dynamic::State;

/// A moment of a motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Moment {
    /// Path of the incoming pair since E in the middle of the face, in m.
    pub s: f64,
    /// Displacement, in m, and its rate, in m/s.
    pub state: State,
    /// Whether any pair touches.
    pub touches: bool,
}

/// The computed motion of a passage.
pub(super) struct Course {
    pub(super) moments: Vec<Moment>,
    pub(super) speed: f64,
}

impl Course {
    /// The places of the computed moments between two places, in m.
    pub(super) fn places(&self, from: f64, to: f64) -> impl Iterator<Item = f64> {
        self.moments.iter().map(|moment| moment.s).filter(move |s| *s > from && *s < to)
    }

    /// Displacement and rate at a place, by cubics with the computed values and rates.
    ///
    /// # Source
    /// Hermite interpolation: Hairer, Nørsett & Wanner 1993, eq. II.6.7.
    pub(super) fn at(&self, s: f64) -> State {
        let after = self.moments.partition_point(|moment| moment.s < s);
        let after = after.clamp(1, self.moments.len() - 1);
        let [one, other] = [self.moments[after - 1], self.moments[after]];
        let way = other.s - one.s;
        let part = ((s - one.s) / way).clamp(0.0, 1.0);
        let time = way / self.speed;
        let rise = other.state[0] - one.state[0];
        let [begin, end] = [one, other].map(|moment| moment.state[1] * time - rise);
        let bend = part * (1.0 - part);
        let displacement = one.state[0] + part * rise + bend * ((1.0 - part) * begin - part * end);
        let slope =
            rise + (1.0 - part) * (1.0 - 3.0 * part) * begin - part * (2.0 - 3.0 * part) * end;
        State::new(displacement, slope / time)
    }

    /// Whether at any time from `from` to `to` no pair is in contact.
    pub(super) fn loses_contact(&self, from: f64, to: f64) -> bool {
        let mut between = self.moments.iter().filter(|moment| moment.s >= from && moment.s <= to);
        between.any(|moment| !moment.touches)
    }
}
