//! Places of stations on a curve: evenly spaced, or as dense as the curve needs.

mod refine;

use super::Refusal;
use super::inputs::Inputs;
use refine::Look;

/// Spacing of stations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// This many equal intervals.
    Even(usize),
    /// Greatest distance of the curve from the straight lines between stations, relative to the
    /// peak.
    AsNeeded(f64),
}

impl Spacing {
    /// Number of initial intervals if the case gives no number.
    pub const LOOKS: usize = 8;

    /// The spacing of the case.
    #[must_use]
    pub fn of(inputs: &Inputs) -> Spacing {
        inputs.stations.map_or(Spacing::AsNeeded(inputs.station_tolerance), Spacing::Even)
    }

    /// The values of `at` at the stations from the first to the last of `ends`, including both.
    /// `at` also gives the height of the curve. The curve should have at most one turning point
    /// between two of the ends. Samples the inner ends as well, at most `most` places in total.
    /// Inner ends become stations only if the curve needs them.
    pub fn stations<T>(
        self,
        ends: &[f64],
        peak: f64,
        most: usize,
        at: impl FnMut(f64) -> (f64, T),
    ) -> (Vec<T>, Resolution) {
        let mut found = Vec::with_capacity(self.count().map_or(0, |count| count + 1));
        let resolution = self.walk(ends, peak, most, at, |value| found.push(value));
        (found, resolution)
    }

    /// The number of intervals if it is given.
    #[must_use]
    pub fn count(self) -> Option<usize> {
        match self {
            Spacing::Even(count) => Some(count.max(1)),
            Spacing::AsNeeded(_) => None,
        }
    }

    /// Passes each station to `keep`, in order.
    #[must_use]
    pub fn walk<T>(
        self,
        ends: &[f64],
        peak: f64,
        most: usize,
        mut at: impl FnMut(f64) -> (f64, T),
        keep: impl FnMut(T),
    ) -> Resolution {
        let (Some(&from), Some(&to)) = (ends.first(), ends.last()) else {
            return Resolution::Full;
        };
        match self {
            Spacing::AsNeeded(part) => {
                let look = Look::along(ends, part * peak, most, at);
                let resolution = look.resolution();
                look.needed().for_each(keep);
                resolution
            }
            Spacing::Even(count) => {
                let count = count.max(1);
                let place = |step| {
                    if step == count { to } else { from + (to - from) * step as f64 / count as f64 }
                };
                (0..=count).map(|step| at(place(step)).1).for_each(keep);
                Resolution::Full
            }
        }
    }
}

/// Whether the stations are as dense as the curve needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resolution {
    /// The stations are dense enough.
    Full,
    /// The curve was computed in this many places, the limit of the [budget](super::budget), and
    /// needs more.
    Limited(usize),
}

impl Resolution {
    /// The resolution of two parts of a curve together.
    #[must_use]
    pub fn and(self, other: Resolution) -> Resolution {
        if self == Resolution::Full { other } else { self }
    }

    /// The reason for missing stations.
    #[must_use]
    pub fn refusal(self) -> Option<Refusal> {
        match self {
            Resolution::Full => None,
            Resolution::Limited(limit) => Some(Refusal::CurveTooRough { limit }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Curve = fn(f64) -> f64;

    const MOST: usize = 40_000;

    fn places(spacing: Spacing, ends: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
        spacing.stations(ends, 1.0, MOST, |place| (f(place), place)).0
    }

    /// The greatest distance of the curve from the straight lines between the places.
    fn worst(places: &[f64], f: impl Fn(f64) -> f64) -> f64 {
        let off = |ends: &[f64], part: f64| {
            let line = f(ends[0]) * (1.0 - part) + f(ends[1]) * part;
            (line - f(ends[0] * (1.0 - part) + ends[1] * part)).abs()
        };
        let parts = (0..=64).map(|step| f64::from(step) / 64.0);
        places
            .windows(2)
            .flat_map(|ends| parts.clone().map(move |part| off(ends, part)))
            .fold(0.0, f64::max)
    }

    #[test]
    fn even_places_include_both_ends() {
        assert_eq!(places(Spacing::Even(4), &[0.0, 1.2, 2.0], |_| 0.0), [0.0, 0.5, 1.0, 1.5, 2.0]);
    }

    #[test]
    fn a_straight_curve_needs_only_its_ends() {
        assert_eq!(places(Spacing::AsNeeded(1e-3), &[2.0, 0.0], |x| 3.0 * x), [2.0, 0.0]);
    }

    #[test]
    fn the_number_of_stations_is_near_the_least_possible() {
        let curves: [(&str, Curve); 6] = [
            ("an arch", |x| x * (2.0 - x)),
            ("a swing", |x| (3.0 * x).sin()),
            ("a bend just after the beginning", |x| {
                if x < 0.04 { 10.0 * x } else { 0.4 + 0.1 * (x - 0.04) }
            }),
            ("a bend", |x| (x - 1.23).abs()),
            ("a steep beginning", |x: f64| (0.5 * x).powf(0.75)),
            ("a decaying oscillation", |x| (40.0 * x).sin() * (-3.0 * x).exp()),
        ];
        for (name, curve) in curves {
            for tolerance in [1e-1, 1e-2, 1e-3, 1e-4] {
                let found = places(Spacing::AsNeeded(tolerance), &[0.0, 2.0], curve);
                let off = worst(&found, curve);
                assert!(off <= tolerance, "{name}: {off:e} for {tolerance:e}");
                let fewest = fewest(curve, tolerance);
                assert!(
                    2 * (found.len() - 1) <= 3 * fewest + 3,
                    "{name}, {tolerance:e}: {} for {fewest}",
                    found.len() - 1
                );
            }
        }
    }

    /// The least number of intervals with a known curve: each interval is as long as possible.
    fn fewest(curve: Curve, tolerance: f64) -> usize {
        const LOOKS: usize = 4000;
        let at = |look: usize| 2.0 * look as f64 / LOOKS as f64;
        let (mut from, mut count) = (0, 0);
        while from < LOOKS {
            let serves = |&to: &usize| worst(&[at(from), at(to)], curve) <= tolerance;
            from = (from + 1..=LOOKS)
                .take_while(|to| serves(to) || *to == from + 1)
                .last()
                .unwrap_or(LOOKS);
            count += 1;
        }
        count
    }

    #[test]
    fn the_highest_place_is_a_station() {
        let found = places(Spacing::AsNeeded(0.1), &[0.0, 0.3, 2.0], |x| 1.0 - (x - 0.3).powi(2));
        assert!(found.contains(&0.3), "{found:?}");
    }

    #[test]
    fn an_infinitely_curved_function_stays_within_its_budget() {
        let rough = |x: f64| (1e9 * x).sin();
        for ends in [vec![0.0, 2.0], (0..=100_000).map(|end| 2e-5 * f64::from(end)).collect()] {
            let mut looks = 0;
            let at = |place: f64| {
                looks += 1;
                (rough(place), place)
            };
            let (found, resolution) = Spacing::AsNeeded(1e-9).stations(&ends, 1.0, MOST, at);
            assert_eq!(resolution, Resolution::Limited(MOST));
            assert!(looks <= MOST, "{looks} for {} ends", ends.len());
            assert_eq!((found[0], found[found.len() - 1]), (0.0, 2.0));
        }
        let curve = |x: f64| (x.sin(), x);
        assert_eq!(
            Spacing::AsNeeded(1e-3).stations(&[0.0, 2.0], 1.0, MOST, curve).1,
            Resolution::Full
        );
    }

    #[test]
    fn a_curve_of_nan_keeps_all_its_places() {
        let found = places(Spacing::AsNeeded(1e-3), &[0.0, 2.0], |_| f64::NAN);
        assert_eq!(found.len(), Spacing::LOOKS + 1, "{found:?}");
    }
}
