//! The force over roll angle, from D to E, and the places of stations on a curve.

use super::Refusal;
use super::budget::{CURVE_WORK, IMPACT_WORK};
use super::compliance::{ContactPlace, Teeth};
use super::geometry::Geometry;
use super::impact::impact;
use super::inputs::Inputs;
use super::masses::Masses;
use super::mesh::Mesh;
use super::position::{Position, gap_without, tip_at, velocity};
use crate::numeric::{distinct, steps};

/// Greatest loss of precision of the closed-form gap, as a factor. Beyond it the quadrature
/// computes the gap.
const LOSS: f64 = 1e4;

/// A force below this part of the sum of all forces is rounding and counts as 0.
const ROUNDING: f64 = 1e-12;

/// A station of the incoming tooth: in `paper` and `exact` between D and E, where the impact is
/// computed as if D were at this place; with load sharing between its first and its last contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Driver's angle before E, in rad; below 0 after E.
    pub roll_angle_driver: f64,
    /// Driven gear's angle before E, in rad; below 0 after E.
    pub roll_angle_driven: f64,
    /// Force of the impact, or of the incoming tooth, in N.
    pub force: f64,
    /// Approach velocity without load, −dS/dt, in m/s; below 0 when tip and flank separate.
    pub normal_velocity: f64,
    /// Sliding velocity, in m/s.
    pub sliding_velocity: f64,
    /// Gap S without deviation and load, in m; with load sharing it includes the reliefs.
    pub gap: f64,
    /// Pair compliance q_s at the force, or with load sharing at the force along the line of action,
    /// in m²/N. `None` at E without load sharing, where the force is 0.
    pub pair_compliance: Option<f64>,
    /// What only some methods compute.
    pub own: Own,
}

/// What a station has by its method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Own {
    /// The impact as if it occurred here, in `paper` and `exact`.
    Impact {
        /// O₁J, in m.
        radius_driver: f64,
        /// Normal kinetic energy E_k of the whole width, in J.
        energy: f64,
    },
    /// The load shared with the other pairs, in `static` and `dynamic`.
    Shared {
        /// Part of the sum of all forces.
        part: f64,
        /// Displacement of the driver ahead along the line of action, in m.
        displacement: f64,
        /// Greatest line load over the reduced radius of curvature of its flanks, in N/m²; only in
        /// slices, if a slice carries load between E and B.
        load_over_curvature: Option<f64>,
        /// Time since E, in s, and at a computed station the rate of the displacement, in m/s; only
        /// in `dynamic`.
        motion: Option<(f64, Option<f64>)>,
    },
}

impl Station {
    /// O₁J, in m; only without load sharing.
    #[must_use]
    pub fn radius_driver(&self) -> Option<f64> {
        if let Own::Impact { radius_driver, .. } = self.own { Some(radius_driver) } else { None }
    }

    /// Normal kinetic energy E_k of the whole width, in J; only without load sharing.
    #[must_use]
    pub fn impact_energy(&self) -> Option<f64> {
        if let Own::Impact { energy, .. } = self.own { Some(energy) } else { None }
    }

    /// Part of the sum of all forces; only with load sharing.
    #[must_use]
    pub fn load_share(&self) -> Option<f64> {
        if let Own::Shared { part, .. } = self.own { Some(part) } else { None }
    }

    /// Displacement of the driver ahead along the line of action, in m; only with load sharing.
    #[must_use]
    pub fn transmission_error(&self) -> Option<f64> {
        if let Own::Shared { displacement, .. } = self.own { Some(displacement) } else { None }
    }

    /// Greatest line load over the reduced radius of curvature, in N/m²; only in slices.
    #[must_use]
    pub fn load_over_curvature(&self) -> Option<f64> {
        match self.own {
            Own::Shared { load_over_curvature, .. } => load_over_curvature,
            Own::Impact { .. } => None,
        }
    }

    /// Time since E, in s; only in the method `dynamic`.
    #[must_use]
    pub fn time(&self) -> Option<f64> {
        self.motion().map(|(time, _)| time)
    }

    /// Rate of the displacement, in m/s; only in the method `dynamic`.
    #[must_use]
    pub fn rate(&self) -> Option<f64> {
        self.motion()?.1
    }

    fn motion(&self) -> Option<(f64, Option<f64>)> {
        if let Own::Shared { motion, .. } = self.own { motion } else { None }
    }

    /// The linear interpolation towards another station with the same load sharing.
    pub(super) fn towards(&self, other: &Station, part: f64) -> Station {
        let mix = |one: f64, other: f64| one + part * (other - one);
        let both = |of: fn(&Station) -> Option<f64>| Some(mix(of(self)?, of(other)?));
        let own = match both(Station::load_share).zip(both(Station::transmission_error)) {
            Some((part, displacement)) => {
                let motion = both(Station::time).map(|time| (time, both(Station::rate)));
                let load_over_curvature = both(Station::load_over_curvature);
                Own::Shared { part, displacement, load_over_curvature, motion }
            }
            None => self.own,
        };
        Station {
            roll_angle_driver: mix(self.roll_angle_driver, other.roll_angle_driver),
            roll_angle_driven: mix(self.roll_angle_driven, other.roll_angle_driven),
            force: mix(self.force, other.force),
            normal_velocity: mix(self.normal_velocity, other.normal_velocity),
            sliding_velocity: mix(self.sliding_velocity, other.sliding_velocity),
            gap: mix(self.gap, other.gap),
            pair_compliance: both(|station| station.pair_compliance),
            own,
        }
    }

    /// Stations from `first` to E, which is at 0, and from E to `last`. Without contact before E,
    /// only from `first` to `last`.
    pub(super) fn through_start(
        first: f64,
        last: f64,
        mut stations: impl FnMut(f64, f64) -> (Vec<Station>, Option<Refusal>),
    ) -> (Vec<Station>, Option<Refusal>) {
        if first >= 0.0 {
            return stations(first, last);
        }
        let ((mut all, before), (after_start, after)) = (stations(first, 0.0), stations(0.0, last));
        all.extend(after_start.into_iter().skip(1));
        (all, before.or(after))
    }

    /// The station with the incoming pair at `s` after E.
    pub(super) fn at(
        mesh: &Mesh,
        s: f64,
        force: f64,
        total: f64,
        displacement: f64,
        motion: Option<(f64, Option<f64>)>,
    ) -> Station {
        let (own, slope) = mesh.incoming(s);
        let least = ROUNDING * total.max(mesh.force);
        let force = if force > least { force } else { 0.0 };
        Station {
            roll_angle_driver: 0.0 - s / mesh.base_radii.0,
            roll_angle_driven: 0.0 - s / mesh.base_radii.1,
            force,
            normal_velocity: 0.0 - slope * mesh.speed,
            sliding_velocity: own.sliding,
            gap: own.gap,
            pair_compliance: Some(mesh.width / own.stiffness),
            own: Own::Shared {
                part: if total > 0.0 { force / total } else { 0.0 },
                displacement,
                load_over_curvature: None,
                motion,
            },
        }
    }
}

/// The impact at stations over the driven gear's angle, from D (first) to E (last, force 0). Omits
/// stations without a force and returns the first refusal with the other stations.
///
/// # Source
/// Zhou & Chen 2014, Eqs. 58-60. Eq. 60 is corrected to the law of cosines: as printed, O₁J is
/// inside the base circle.
pub fn stations(
    inputs: &Inputs,
    geometry: &Geometry,
    masses: &Masses,
    position: &Position,
    peak: f64,
) -> (Vec<Station>, Option<Refusal>) {
    let teeth = match Teeth::of(&inputs.elasticity(), geometry) {
        Ok(teeth) => teeth,
        Err(refusal) => return (Vec::new(), Some(refusal)),
    };
    let at = |angle: f64| {
        let station = station(inputs, &teeth, masses, angle);
        (station.as_ref().map_or(f64::NAN, |station| station.force), station)
    };
    let ends = [position.approach_angle_driven, 0.0];
    let (all, rough) = Spacing::of(inputs).stations(&ends, peak, CURVE_WORK / IMPACT_WORK, at);
    let refused = all.iter().find_map(|station| station.as_ref().err().copied());
    (all.into_iter().filter_map(Result::ok).collect(), refused.or(rough))
}

/// The impact as if it occurred at the driven gear's angle `angle` before E, in rad.
///
/// # Errors
/// The [`Refusal`] of the stage that cannot compute the force.
pub fn station(
    inputs: &Inputs,
    teeth: &Teeth,
    masses: &Masses,
    angle: f64,
) -> Result<Station, Refusal> {
    let geometry = teeth.geometry();
    let tip = tip_at(geometry, angle);
    let velocity = velocity(inputs.driven_speed(), &tip);
    let struck = if angle > 0.0 {
        let place = ContactPlace::at_tip(inputs.driven.tip_radius, geometry, &tip);
        Some(impact(inputs, teeth, masses, &tip, &teeth.at(&place)?, &velocity)?)
    } else {
        None
    };
    Ok(Station {
        roll_angle_driver: angle * geometry.ratio,
        roll_angle_driven: angle,
        normal_velocity: velocity.normal,
        sliding_velocity: velocity.sliding,
        force: struck.map_or(0.0, |impact| impact.force),
        gap: gap_without(LOSS, geometry, &tip),
        pair_compliance: struck.map(|impact| impact.pair_compliance),
        own: Own::Impact {
            radius_driver: tip.radius_driver,
            energy: struck.map_or(0.0, |impact| impact.energy),
        },
    })
}

/// Spacing of stations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// This many equal intervals.
    Even(usize),
    /// At least [`Spacing::LEAST`] intervals, and more where the curve is farther from the straight lines
    /// between stations than this part of the peak.
    AsNeeded(f64),
}

impl Spacing {
    /// Least number of intervals if the case gives no number. Other curves of the stations can bend
    /// where the force does not.
    pub const LEAST: usize = 64;

    /// The spacing of the case.
    pub fn of(inputs: &Inputs) -> Spacing {
        inputs.stations.map_or(Spacing::AsNeeded(inputs.station_tolerance), Spacing::Even)
    }

    /// The values of `at` at the stations from the first to the last of `ends`, including both.
    /// `at` also gives the height of the curve. The curve should have at most one turning point
    /// between two of the ends. Samples the inner ends as well, at most `most` places in total.
    /// Inner ends become stations only if they are needed.
    pub fn stations<T>(
        self,
        ends: &[f64],
        peak: f64,
        most: usize,
        mut at: impl FnMut(f64) -> (f64, T),
    ) -> (Vec<T>, Option<Refusal>) {
        let (Some(&from), Some(&to)) = (ends.first(), ends.last()) else {
            return (Vec::new(), None);
        };
        match self {
            Spacing::AsNeeded(part) => {
                let allowed = part * peak;
                let even = steps(from, to, Spacing::LEAST / PLACES);
                let mut pieces = distinct(even.chain(ends.iter().copied()).collect(), 0.0);
                if to < from {
                    pieces.reverse();
                }
                let (samples, rough) = Sampler::along(&pieces, allowed, most, at);
                let longest = (to - from).abs() / Spacing::LEAST as f64;
                let needed = filled(&samples, &needed(&samples, LEFT_OUT * allowed), longest);
                let values = samples.into_iter().enumerate();
                let values = values.filter(|(at, _)| needed.binary_search(at).is_ok());
                (values.map(|(_, sample)| sample.value).collect(), rough)
            }
            Spacing::Even(count) => {
                let count = count.max(1);
                let place = |step| {
                    if step == count { to } else { from + (to - from) * step as f64 / count as f64 }
                };
                ((0..=count).map(|step| at(place(step)).1).collect(), None)
            }
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

/// A sampled place of a curve.
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

/// The sampling of a curve until the estimated error between samples is within the tolerance.
struct Sampler<T, F> {
    at: F,
    samples: Vec<Sample<T>>,
    allowed: f64,
    /// Places left after the initial pieces.
    rest: usize,
    /// Whether the limit of places leaves the curve less dense than it should be.
    is_cut: bool,
}

impl<T, F: FnMut(f64) -> (f64, T)> Sampler<T, F> {
    /// Samples the curve between the ends, at most `most` places. Returns the samples in order and
    /// whether they are dense enough everywhere.
    fn along(ends: &[f64], allowed: f64, most: usize, at: F) -> (Vec<Sample<T>>, Option<Refusal>) {
        let last = ends[ends.len() - 1];
        let fewer = fewer(ends, most / PLACES - 1);
        let is_cut = fewer.is_some();
        let ends = fewer.as_deref().unwrap_or(ends);
        let rest = most.saturating_sub(1 + PLACES * (ends.len() - 1));
        let mut sampler = Sampler { at, samples: Vec::new(), allowed, rest, is_cut };
        let mut height = sampler.sample(ends[0]);
        for pair in ends.windows(2) {
            height = sampler.piece((pair[0], height), pair[1]);
        }
        let Sampler { mut samples, is_cut, .. } = sampler;
        let is_forward = ends[0] <= last;
        samples.sort_unstable_by(|one, other| {
            let (one, other) = if is_forward { (one, other) } else { (other, one) };
            one.place.total_cmp(&other.place)
        });
        (samples, is_cut.then_some(Refusal::CurveTooRough { limit: most }))
    }

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
        let heights = [height, inner[0], inner[1], inner[2], last];
        self.closer(Part { from, to, heights }, MOST_HALVINGS);
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
            self.is_cut = true;
            return;
        }
        self.rest -= PLACES;
        let Part { from, to, heights: [first, before, middle, after, last] } = part;
        let place = |eighths: f64| from + (to - from) * eighths / 8.0;
        let [one, three, five, seven] =
            [1.0, 3.0, 5.0, 7.0].map(|eighths| self.sample(place(eighths)));
        let half = place(4.0);
        let heights = [first, one, before, three, middle];
        self.closer(Part { from, to: half, heights }, halvings - 1);
        let heights = [middle, five, after, seven, last];
        self.closer(Part { from: half, to, heights }, halvings - 1);
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

/// The indices of both ends, the highest sample, and the fewest samples between them that represent
/// all others, in order. All samples if a height is not finite.
fn needed<T>(samples: &[Sample<T>], allowed: f64) -> Vec<usize> {
    let last = samples.len() - 1;
    if !samples.iter().all(|sample| sample.height.is_finite()) {
        return (0..=last).collect();
    }
    let height = |at: &usize| samples[*at].height;
    let highest =
        (0..=last).max_by(|one, other| height(one).total_cmp(&height(other))).unwrap_or(last);
    let (mut kept, mut at) = (vec![0], 0);
    while at < last {
        at = furthest(samples, at, if at < highest { highest } else { last }, allowed);
        kept.push(at);
    }
    kept
}

/// The needed samples, with others between them so that no interval is longer than the longest one.
fn filled<T>(samples: &[Sample<T>], needed: &[usize], longest: f64) -> Vec<usize> {
    const ROUNDING: f64 = 1e-9;
    let mut kept = vec![0];
    for at in 1..samples.len() {
        let from = samples[kept[kept.len() - 1]].place;
        let is_far = |next: &Sample<T>| (next.place - from).abs() > longest * (1.0 + ROUNDING);
        if needed.binary_search(&at).is_ok() || samples.get(at + 1).is_some_and(is_far) {
            kept.push(at);
        }
    }
    kept
}

/// The farthest sample, up to `most`, for which a straight line represents all samples between.
fn furthest<T>(samples: &[Sample<T>], from: usize, most: usize, allowed: f64) -> usize {
    let start = &samples[from];
    let (mut steepest, mut flattest, mut furthest) = (f64::INFINITY, f64::NEG_INFINITY, from + 1);
    for (at, sample) in samples.iter().enumerate().take(most + 1).skip(from + 1) {
        let way = (sample.place - start.place).abs();
        let slope = |aside: f64| (sample.height - start.height + aside) / way;
        if (flattest..=steepest).contains(&slope(0.0)) {
            furthest = at;
        }
        steepest = steepest.min(slope(allowed));
        flattest = flattest.max(slope(-allowed));
        if flattest > steepest {
            break;
        }
    }
    furthest
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
    fn a_straight_curve_has_the_least_number_of_even_intervals() {
        let found = places(Spacing::AsNeeded(1e-3), &[2.0, 0.0], |x| 3.0 * x);
        assert_eq!(found, places(Spacing::Even(Spacing::LEAST), &[2.0, 0.0], |x| 3.0 * x));
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
                    2 * (found.len() - 1) <= 3 * fewest + 2 * Spacing::LEAST,
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
            let (found, limited) = Spacing::AsNeeded(1e-9).stations(&ends, 1.0, MOST, at);
            assert_eq!(limited, Some(Refusal::CurveTooRough { limit: MOST }));
            assert!(looks <= MOST, "{looks} for {} ends", ends.len());
            assert_eq!((found[0], found[found.len() - 1]), (0.0, 2.0));
        }
        let curve = |x: f64| (x.sin(), x);
        assert_eq!(Spacing::AsNeeded(1e-3).stations(&[0.0, 2.0], 1.0, MOST, curve).1, None);
    }

    #[test]
    fn a_curve_of_nan_keeps_all_its_places() {
        let found = places(Spacing::AsNeeded(1e-3), &[0.0, 2.0], |_| f64::NAN);
        assert_eq!(found.len(), Spacing::LEAST + 1, "{found:?}");
    }
}
