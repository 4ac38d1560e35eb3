//! Contacts made and lost within a step.

use super::motion::{Forces, State};
use crate::numeric::ode::Point;
use crate::numeric::root::{self, Known};

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
        let start = known(0.0, self.kept(self.from.t, &self.from.y));
        let end = known(self.length, self.kept(self.from.t + self.length, to));
        if end.value < 0.0 {
            return Some(self.turn_from(start, end));
        }
        let dips = start.slope < 0.0 && end.slope > 0.0;
        if !dips || Crossing::least_of_cubic(&start, &end) > 0.25 * start.value.max(end.value) {
            return None;
        }
        let lowest = self.level();
        (lowest.value < 0.0).then(|| self.turn(start, lowest))
    }

    /// The turn of a pair that ends the step as the other kind. One that has just become what it is stands at 0, within
    /// rounding, and may first go up.
    fn turn_from(&self, start: Known, end: Known) -> f64 {
        if start.value > 0.0 {
            return self.turn(start, end);
        }
        if start.slope <= 0.0 || end.slope >= 0.0 {
            return 0.0;
        }
        let highest = self.level();
        if highest.value > 0.0 { self.turn(highest, end) } else { 0.0 }
    }

    fn turn(&self, from: Known, to: Known) -> f64 {
        root::between_known(from, to, |after| self.at(after))
    }

    /// Where what is kept neither grows nor falls.
    fn level(&self) -> Known {
        let after = root::between(0.0, self.length, |after| self.at(after).1);
        known(after, self.at(after))
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
    fn least_of_cubic(start: &Known, end: &Known) -> f64 {
        const LOOKS: u32 = 16;
        let looks = (1..LOOKS).map(|look| root::cubic(start, end, f64::from(look) / f64::from(LOOKS)));
        looks.fold(f64::INFINITY, f64::min)
    }
}

fn known(at: f64, (value, slope): (f64, f64)) -> Known {
    Known { at, value, slope }
}
