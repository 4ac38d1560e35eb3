//! The chart's axes: round steps that stay until the curve leaves them.

use super::solver::Answer;
use crate::model::Station;

/// Ends of an axis, times a power of ten.
const STEPS: [f64; 8] = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];

/// Below this part of the axis the curve is too small, and the axis shrinks. A step is at most 1.5 times
/// the one before, so that a curve that has just left its axis fills two thirds of the next.
const TOO_SMALL: f64 = 0.45;

/// Ends of the two axes; both begin at 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    /// Roll angle of the driver before E, in deg.
    pub angle: f64,
    /// Force, in N.
    pub force: f64,
}

impl Default for Scale {
    fn default() -> Scale {
        Scale { angle: 0.0, force: 0.0 }
    }
}

impl Scale {
    /// The scale on which every curve of the answer has its place, this one when it serves.
    #[must_use]
    pub fn fitted(self, answer: &Answer) -> Scale {
        let solutions = answer.rungs.iter().filter_map(|(_, result)| result.as_ref().ok());
        let points: Vec<_> = solutions.flat_map(|solution| curve(&solution.stations)).collect();
        if points.is_empty() {
            return self;
        }
        let (angle, force) = points.iter().fold((0.0, 0.0), |(x, y): (f64, f64), point| (x.max(-point.0), y.max(point.1)));
        Scale { angle: step(self.angle, angle), force: step(self.force, force) }
    }
}

/// The curve of the impact force: minus the roll angle before E in deg, and the force in N. Only what is finite
/// reaches a chart.
pub fn curve(stations: &[Station]) -> impl Iterator<Item = (f64, f64)> {
    let points = stations.iter().map(|station| (-station.roll_angle_driver.to_degrees(), station.impact_force));
    points.filter(|(x, y)| x.is_finite() && y.is_finite())
}

/// Bounds that a chart can bear: finite, the lesser first, never equal.
#[must_use]
pub fn bounds(from: f64, to: f64) -> [f64; 2] {
    let sound = |value: f64| if value.is_finite() { value.clamp(-1e100, 1e100) } else { 0.0 };
    let (from, to) = (sound(from).min(sound(to)), sound(from).max(sound(to)));
    let pad = if from < to { 0.0 } else { 1f64.max(from.abs()) };
    [from - pad, to + pad]
}

/// The least end of an axis that is not below the value.
#[must_use]
pub fn round_up(value: f64) -> f64 {
    if !value.is_normal() || value < 1e-30 {
        return 1e-30;
    }
    let power = 10f64.powi(value.log10().floor() as i32);
    let step = STEPS.into_iter().find(|step| step * power >= value * (1.0 - 1e-12));
    step.unwrap_or(10.0) * power
}

fn step(now: f64, greatest: f64) -> f64 {
    if greatest > now || greatest < TOO_SMALL * now { round_up(greatest) } else { now }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "a step is one of few numbers, and stays the same one")]
mod tests {
    use super::*;

    #[test]
    fn an_axis_stays_until_the_curve_leaves_it() {
        assert_eq!(step(0.0, 2191.0), 3000.0);
        assert_eq!(step(3000.0, 2999.0), 3000.0);
        assert_eq!(step(3000.0, 1400.0), 3000.0);
        assert_eq!(step(3000.0, 1300.0), 1500.0);
        assert_eq!(step(2000.0, 2001.0), 3000.0);
    }

    #[test]
    fn just_after_a_change_the_axis_stays() {
        for tenths in 1..100_000 {
            let value = f64::from(tenths) / 10.0;
            let axis = round_up(value);
            assert!(axis >= value * (1.0 - 1e-9));
            assert_eq!(step(axis, value), axis, "{value}");
        }
    }

    #[test]
    fn bounds_are_always_bearable() {
        let hostile = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0, -1.0, 5e-324];
        for from in hostile {
            for to in hostile {
                let [low, high] = bounds(from, to);
                assert!(low < high && (high - low).is_finite(), "{from} {to}");
            }
        }
    }
}
