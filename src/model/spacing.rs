//! Places of stations on a curve: evenly spaced, or as dense as the curve needs.

use super::Refusal;
use super::inputs::Inputs;

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Resolution {
    /// The stations are dense enough.
    #[default]
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

/// Division of the tolerance: for errors between the samples, and for the omission of samples.
const BETWEEN: f64 = 0.2;
const LEFT_OUT: f64 = 1.0 - BETWEEN;
/// Limit of the halvings of a piece.
const MOST_HALVINGS: u32 = 16;
/// Number of intervals of a piece before halving.
const PLACES: usize = 4;

/// The samples of a curve, in order.
struct Look<T> {
    samples: Vec<Sample<T>>,
    allowed: f64,
    resolution: Resolution,
}

struct Sample<T> {
    place: f64,
    height: f64,
    value: T,
}

/// A part of the curve: both ends and five equally spaced heights.
#[derive(Clone, Copy)]
struct Part {
    from: f64,
    to: f64,
    heights: [f64; 5],
}

impl<T> Look<T> {
    /// Samples the curve between the ends until the estimated error between samples is within the
    /// tolerance, at most `most` places.
    fn along(ends: &[f64], allowed: f64, most: usize, at: impl FnMut(f64) -> (f64, T)) -> Look<T> {
        // Begins with two halves, because a symmetric part could hide its bends.
        let halves = [ends[0], f64::midpoint(ends[0], ends[ends.len() - 1]), ends[ends.len() - 1]];
        let ends = if ends.len() == 2 { &halves } else { ends };
        let limited = Resolution::Limited(most);
        let fewer = fewer(ends, most / PLACES - 1);
        let ends = fewer.as_deref().unwrap_or(ends);
        let mut looking = Sampler {
            at,
            samples: Vec::new(),
            allowed,
            rest: most.saturating_sub(1 + PLACES * (ends.len() - 1)),
            resolution: if fewer.is_some() { limited } else { Resolution::Full },
            limited,
        };
        let mut height = looking.sample(ends[0]);
        for pair in ends.windows(2) {
            height = looking.piece((pair[0], height), pair[1]);
        }
        let resolution = looking.resolution;
        let mut samples = looking.samples;
        let is_forward = ends[0] <= ends[ends.len() - 1];
        samples.sort_unstable_by(|one, other| {
            let (one, other) = if is_forward { (one, other) } else { (other, one) };
            one.place.total_cmp(&other.place)
        });
        Look { samples, allowed: LEFT_OUT * allowed, resolution }
    }

    /// Whether the samples are dense enough everywhere.
    fn resolution(&self) -> Resolution {
        self.resolution
    }

    /// Both ends, the highest sample, and the fewest samples between them. Keeps all samples if a
    /// height is not finite.
    fn needed(self) -> impl Iterator<Item = T> {
        let keeps = if self.samples.iter().all(|sample| sample.height.is_finite()) {
            self.kept()
        } else {
            Vec::new()
        };
        let all = keeps.is_empty();
        let values = self.samples.into_iter().enumerate();
        values
            .filter(move |(at, _)| all || keeps.binary_search(at).is_ok())
            .map(|(_, sample)| sample.value)
    }

    /// The indices of the needed samples, in order.
    fn kept(&self) -> Vec<usize> {
        let last = self.samples.len() - 1;
        let height = |at: &usize| self.samples[*at].height;
        let highest =
            (0..=last).max_by(|one, other| height(one).total_cmp(&height(other))).unwrap_or(last);
        let (mut kept, mut at) = (vec![0], 0);
        while at < last {
            at = self.furthest(at, if at < highest { highest } else { last });
            kept.push(at);
        }
        kept
    }

    /// The farthest sample, up to `most`, for which a straight line represents all samples between.
    fn furthest(&self, from: usize, most: usize) -> usize {
        let start = &self.samples[from];
        let (mut steepest, mut flattest, mut furthest) =
            (f64::INFINITY, f64::NEG_INFINITY, from + 1);
        for at in from + 1..=most {
            let sample = &self.samples[at];
            let way = (sample.place - start.place).abs();
            let slope = |aside: f64| (sample.height - start.height + aside) / way;
            if (flattest..=steepest).contains(&slope(0.0)) {
                furthest = at;
            }
            steepest = steepest.min(slope(self.allowed));
            flattest = flattest.max(slope(-self.allowed));
            if flattest > steepest {
                break;
            }
        }
        furthest
    }
}

/// Every n-th of the ends and the last one, if the ends have more than `most` pieces.
fn fewer(ends: &[f64], most: usize) -> Option<Vec<f64>> {
    let pieces = ends.len() - 1;
    (pieces > most).then(|| {
        let inner = ends[..pieces].iter().step_by(pieces.div_ceil(most));
        inner.chain(ends.last()).copied().collect()
    })
}

/// The state of the sampling.
struct Sampler<T, F> {
    at: F,
    samples: Vec<Sample<T>>,
    allowed: f64,
    /// Places left after the initial pieces.
    rest: usize,
    resolution: Resolution,
    limited: Resolution,
}

impl<T, F: FnMut(f64) -> (f64, T)> Sampler<T, F> {
    /// Samples a place and returns its height.
    fn sample(&mut self, place: f64) -> f64 {
        let (height, value) = (self.at)(place);
        self.samples.push(Sample { place, height, value });
        height
    }

    /// Samples a piece from a place with a known height. Returns the height at `to`.
    fn piece(&mut self, (from, height): (f64, f64), to: f64) -> f64 {
        let inner = [0.25, 0.5, 0.75].map(|part| self.sample(from + (to - from) * part));
        let last = self.sample(to);
        self.closer(
            Part { from, to, heights: [height, inner[0], inner[1], inner[2], last] },
            MOST_HALVINGS,
        );
        last
    }

    /// Samples both halves of a part whose error is too large.
    fn closer(&mut self, part: Part, halvings: u32) {
        // Does not refine parts that are not finite.
        let is_bent = part.unknown() > BETWEEN * self.allowed;
        if halvings == 0 || !is_bent {
            return;
        }
        if self.rest < PLACES {
            self.resolution = self.limited;
            return;
        }
        self.rest -= PLACES;
        let Part { from, to, heights: [first, before, middle, after, last] } = part;
        let place = |eighths: f64| from + (to - from) * eighths / 8.0;
        let [one, three, five, seven] =
            [1.0, 3.0, 5.0, 7.0].map(|eighths| self.sample(place(eighths)));
        self.closer(
            Part { from, to: place(4.0), heights: [first, one, before, three, middle] },
            halvings - 1,
        );
        self.closer(
            Part { from: place(4.0), to, heights: [middle, five, after, seven, last] },
            halvings - 1,
        );
    }
}

impl Part {
    /// Estimated greatest distance of the curve from the lines between its five heights: an eighth
    /// of the second difference if it is constant, up to half of it if it varies because of a bend.
    fn unknown(&self) -> f64 {
        let bends = [1, 2, 3]
            .map(|at| self.heights[at - 1] - 2.0 * self.heights[at] + self.heights[at + 1]);
        let most = bends.iter().map(|bend| bend.abs()).fold(0.0, f64::max);
        let spread = bends.iter().fold(f64::NEG_INFINITY, |most, &bend| most.max(bend))
            - bends.iter().fold(f64::INFINITY, |least, &bend| least.min(bend));
        0.125 * most + 0.375 * spread.min(most)
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
