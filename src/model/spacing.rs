//! Where stations stand on a curve: evenly, or as closely as the curve needs.

use super::inputs::Inputs;

/// How stations are placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// This many equal intervals.
    Even(usize),
    /// So that the curve lies off the straight lines between them by no more than this part of its peak.
    AsNeeded(f64),
}

/// Intervals to begin with, halved where the curve is not straight enough; a curve of fewer could hide a bend.
const AT_FIRST: usize = 8;
/// No interval is halved more often.
const MOST_HALVINGS: u32 = 12;

impl Spacing {
    /// As the case asks for it.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Spacing {
        inputs.stations.map_or(Spacing::AsNeeded(inputs.station_tolerance), Spacing::Even)
    }

    /// What `at` gives at the stations from one end to the other, both ends among them. `at` gives the height of the curve
    /// as well; one that is no number is not looked at more closely.
    pub fn stations<T>(self, from: f64, to: f64, peak: f64, at: impl FnMut(f64) -> (f64, T)) -> Vec<T> {
        let mut found = Vec::with_capacity(self.first_count() + 1);
        self.walk(from, to, peak, at, |value| found.push(value));
        found
    }

    /// Intervals to begin with.
    #[must_use]
    pub fn first_count(self) -> usize {
        match self {
            Spacing::Even(count) => count.max(1),
            Spacing::AsNeeded(_) => AT_FIRST,
        }
    }

    /// The same, each given to `keep` in its turn.
    pub fn walk<T>(self, from: f64, to: f64, peak: f64, mut at: impl FnMut(f64) -> (f64, T), mut keep: impl FnMut(T)) {
        let (count, allowed) = match self {
            Spacing::Even(_) => (self.first_count(), f64::INFINITY),
            Spacing::AsNeeded(part) => (self.first_count(), part * peak),
        };
        let mut last: Option<Point> = None;
        for step in 0..=count {
            let place = if step == count { to } else { from + (to - from) * step as f64 / count as f64 };
            let (height, value) = at(place);
            let next = Point { place, height };
            if let Some(last) = last.filter(|_| allowed.is_finite()) {
                fill(last, next, allowed, MOST_HALVINGS, &mut at, &mut keep);
            }
            keep(value);
            last = Some(next);
        }
    }
}

#[derive(Clone, Copy)]
struct Point {
    place: f64,
    height: f64,
}

/// What stands between two places, where the curve lies too far off the straight line in the middle.
fn fill<T>(from: Point, to: Point, allowed: f64, halvings: u32, at: &mut impl FnMut(f64) -> (f64, T), keep: &mut impl FnMut(T)) {
    let place = f64::midpoint(from.place, to.place);
    let (height, value) = at(place);
    let bend = (height - f64::midpoint(from.height, to.height)).abs();
    // A bend that is no number is none.
    let is_bent = bend > allowed;
    if halvings == 0 || !is_bent {
        return;
    }
    let middle = Point { place, height };
    fill(from, middle, allowed, halvings - 1, at, keep);
    keep(value);
    fill(middle, to, allowed, halvings - 1, at, keep);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn places(spacing: Spacing, f: impl Fn(f64) -> f64) -> Vec<f64> {
        spacing.stations(0.0, 2.0, 1.0, |place| (f(place), place))
    }

    #[test]
    fn even_places_have_both_ends() {
        assert_eq!(places(Spacing::Even(4), |_| 0.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
    }

    #[test]
    fn a_straight_curve_takes_few_and_a_bent_one_as_many_as_it_needs() {
        assert_eq!(places(Spacing::AsNeeded(1e-3), |x| 3.0 * x).len(), AT_FIRST + 1);
        let bent = |x: f64| (3.0 * x).sin();
        let (coarse, fine) = (places(Spacing::AsNeeded(1e-3), bent), places(Spacing::AsNeeded(1e-5), bent));
        assert!(coarse.len() > AT_FIRST + 1 && fine.len() > 5 * coarse.len() && fine.len() < 20 * coarse.len());
        for ends in coarse.windows(2) {
            for step in 0..=10 {
                let part = f64::from(step) / 10.0;
                let line = bent(ends[0]) * (1.0 - part) + bent(ends[1]) * part;
                let x = ends[0] * (1.0 - part) + ends[1] * part;
                assert!((line - bent(x)).abs() < 1.2e-3, "{x}");
            }
        }
    }

    #[test]
    fn a_height_that_is_no_number_is_let_be() {
        assert_eq!(places(Spacing::AsNeeded(1e-3), |_| f64::NAN).len(), AT_FIRST + 1);
    }
}
