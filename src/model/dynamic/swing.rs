//! How the incoming tooth's force rises and falls over the steps of a run.

use super::motion::{Forces, State};
use crate::numeric::ode::Point;
use crate::numeric::root::{self, Known};

/// A part of a step in which the incoming tooth carries, on which its force turns once at most.
pub(super) struct Stretch<'a> {
    forces: Forces<'a>,
    incoming: usize,
    step: &'a Point<3>,
    /// Force and its rate at both ends, over the time since the start of the step.
    from: Known,
    to: Known,
}

impl<'a> Stretch<'a> {
    /// The stretches of a step: the whole, or where ends and cubic tell that it may turn twice, many.
    pub(super) fn of(
        forces: Forces<'a>,
        incoming: usize,
        (from, length, to): (&'a Point<3>, f64, &State),
    ) -> impl Iterator<Item = Stretch<'a>> {
        const CUTS: u32 = 8;
        let known = |after: f64, state: &State| {
            let (value, slope) = forces.force(incoming, from.t + after, state);
            Known { at: after, value, slope }
        };
        let ends = (known(0.0, &from.y), known(length, to));
        let cuts = if may_turn_twice(&ends.0, &ends.1) { CUTS } else { 1 };
        let inner = (1..cuts).map(|cut| {
            let after = length * f64::from(cut) / f64::from(cuts);
            known(after, &forces.after(from, after))
        });
        let all: Vec<Known> = std::iter::once(ends.0).chain(inner).chain([ends.1]).collect();
        let stretch = move |at: usize| Stretch { forces, incoming, step: from, from: all[at], to: all[at + 1] };
        (0..cuts as usize).map(stretch)
    }

    /// Whether it lies before E, where a step ends within rounding.
    pub(super) fn is_before_start(&self) -> bool {
        self.begin() + self.end() < 0.0
    }

    fn begin(&self) -> f64 {
        self.step.t + self.from.at
    }

    fn end(&self) -> f64 {
        self.step.t + self.to.at
    }

    fn ends(&self) -> f64 {
        self.from.value.max(self.to.value)
    }

    /// No force on a stretch that rises first and falls then is greater, in N: the tangents at its ends meet above an arch, and
    /// as much again is room to spare.
    fn bound(&self) -> f64 {
        let (from, to) = (&self.from, &self.to);
        let length = to.at - from.at;
        let crossing = (to.value - from.value - to.slope * length) / (from.slope - to.slope);
        let height = from.value + from.slope * crossing.clamp(0.0, length) - self.ends();
        self.ends() + 2.0 * height.max(0.0)
    }

    /// Time and force where it turns.
    fn turning_point(&self) -> (f64, f64) {
        let at = |after: f64| self.forces.force(self.incoming, self.step.t + after, &self.forces.after(self.step, after));
        let after = root::between(self.from.at, self.to.at, |after| at(after).1);
        (self.step.t + after, at(after).0)
    }
}

/// Whether a force that grows, or falls, at both ends may do otherwise between them: by the cubic, with room to spare.
fn may_turn_twice(from: &Known, to: &Known) -> bool {
    const INSIDE: [f64; 3] = [0.25, 0.5, 0.75];
    let direction = from.slope.signum();
    let least = from.slope.abs().min(to.slope.abs());
    from.slope * to.slope > 0.0 && INSIDE.iter().any(|&part| direction * root::cubic_slope(from, to, part) < 0.5 * least)
}

/// The greatest force of some stretches, in N; only those that may hold it are looked at more closely.
pub(super) fn peak(stretches: &[Stretch<'_>]) -> f64 {
    let mut tops: Vec<(f64, &Stretch<'_>)> = stretches
        .iter()
        .filter(|stretch| stretch.from.slope > 0.0 && stretch.to.slope < 0.0)
        .map(|stretch| (stretch.bound(), stretch))
        .collect();
    tops.sort_by(|one, other| other.0.total_cmp(&one.0));
    let ends = stretches.iter().map(Stretch::ends).fold(0.0, f64::max);
    tops.iter().fold(ends, |peak, (bound, stretch)| if *bound > peak { peak.max(stretch.turning_point().1) } else { peak })
}

/// When the force is least for the first time after its first peak, or the contact is lost.
pub(super) fn end_of_first_impact(stretches: &[Stretch<'_>]) -> Option<f64> {
    let (mut falls, mut last) = (false, None);
    for stretch in stretches {
        let follows = last.is_none_or(|end| stretch.begin() <= end);
        if falls && (!follows || stretch.from.slope > 0.0) {
            return last;
        }
        if falls && stretch.to.slope > 0.0 {
            return Some(stretch.turning_point().0);
        }
        falls |= stretch.to.slope < 0.0;
        last = Some(stretch.end());
    }
    last.filter(|_| falls)
}

/// When the force neither grows nor falls, in s.
pub(super) fn turns(stretches: &[Stretch<'_>]) -> impl Iterator<Item = f64> {
    let turning = stretches.iter().filter(|stretch| (stretch.from.slope > 0.0) != (stretch.to.slope > 0.0));
    turning.map(|stretch| stretch.turning_point().0)
}
