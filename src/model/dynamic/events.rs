//! Contacts made and lost within a step.

use super::motion::{Forces, State};
use crate::numeric::ode::Point;
use crate::numeric::root;

/// A pair that touches or leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    /// The pair's place in the window.
    pub(super) pair: usize,
    /// How long after the start of the step, in s.
    pub(super) after: f64,
}

/// The first event of a step that leads from `from` to `to`, where there is one.
pub(super) fn first(forces: &Forces<'_>, from: &Point<3>, length: f64, to: &State) -> Option<Event> {
    let events = (0..forces.pairs()).filter_map(|pair| {
        let after = Crossing { forces, from, length, pair }.find(to)?;
        Some(Event { pair, after })
    });
    events.min_by(|one, other| one.after.total_cmp(&other.after))
}

/// How a pair keeps what it is: pressed where it touches, apart where it does not.
struct Crossing<'a> {
    forces: &'a Forces<'a>,
    from: &'a Point<3>,
    length: f64,
    pair: usize,
}

impl Crossing<'_> {
    /// When the pair ceases to be what it is.
    fn find(&self, to: &State) -> Option<f64> {
        let (start, start_rate) = self.kept(self.from.t, &self.from.y);
        let (end, end_rate) = self.kept(self.from.t + self.length, to);
        if end < 0.0 {
            return Some(self.turn_from(start, start_rate, end_rate));
        }
        let dips = start_rate < 0.0 && end_rate > 0.0;
        if !dips || self.least_of_cubic(start, start_rate, end, end_rate) > 0.25 * start.max(end) {
            return None;
        }
        let lowest = root::between(0.0, self.length, |after| self.at(after).1);
        (self.at(lowest).0 < 0.0).then(|| self.turn(0.0, lowest))
    }

    /// The turn of a pair that ends the step as the other kind. One that has just become what it is stands at 0, within
    /// rounding, and may first go up.
    fn turn_from(&self, start: f64, start_rate: f64, end_rate: f64) -> f64 {
        if start > 0.0 {
            return self.turn(0.0, self.length);
        }
        if start_rate <= 0.0 || end_rate >= 0.0 {
            return 0.0;
        }
        let highest = root::between(0.0, self.length, |after| self.at(after).1);
        if self.at(highest).0 > 0.0 { self.turn(highest, self.length) } else { 0.0 }
    }

    fn turn(&self, from: f64, to: f64) -> f64 {
        root::between(from, to, |after| self.at(after).0)
    }

    /// What is kept after a part of the step, and its rate.
    fn at(&self, after: f64) -> (f64, f64) {
        self.kept(self.from.t + after, &self.forces.after(self.from, after))
    }

    /// Above 0 while the pair stays what it is, and its rate.
    fn kept(&self, t: f64, y: &State) -> (f64, f64) {
        let (pressed, rate) = self.forces.pressed(self.pair, t, y);
        if self.forces.touches(self.pair) { (pressed, rate) } else { (-pressed, -rate) }
    }

    /// The least of Hermite's cubic through both ends, near enough to tell whether a closer look is worth it.
    fn least_of_cubic(&self, start: f64, start_rate: f64, end: f64, end_rate: f64) -> f64 {
        const LOOKS: u32 = 16;
        let (rise, fall) = (start_rate * self.length, end_rate * self.length);
        let cubic = |t: f64| {
            let rest = 1.0 - t;
            rest * rest * ((1.0 + 2.0 * t) * start + t * rise) + t * t * ((1.0 + 2.0 * rest) * end - rest * fall)
        };
        (1..LOOKS).map(|look| cubic(f64::from(look) / f64::from(LOOKS))).fold(f64::INFINITY, f64::min)
    }
}
