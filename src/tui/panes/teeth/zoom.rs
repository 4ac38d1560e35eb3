//! The view of the teeth pane: centre, zoom, and exaggeration of the gap.

use crate::model::contact_state::{Phase, first_contact_point};
use crate::model::gear_pose::on_line_of_action;
use crate::model::{ContactState, Geometry, Inputs, Solution};

/// The least height of the picture around the strike without zoom, in modules and in distances from
/// D to E.
const STRIKE: (f64, f64) = (3.4, 4.0);
/// The height of the picture around the pitch point, relative to the distance from it to the
/// farther end of the path of contact.
const PATH: f64 = 2.4;
/// The last zoom step in. Each step is √2, and the last step shows some micrometres of a typical
/// gear.
const LAST_STEP_IN: i32 = 20;
/// The last zoom step out, enough for two gears of 1000 teeth.
const LAST_STEP_OUT: i32 = -24;
/// The exaggerated deviation as a fraction of the picture's height, and its greatest value in
/// modules.
const SHARE: f64 = 0.1;
const MOST_DEVIATION: f64 = 0.2;
/// The greatest exaggerated opening, in modules.
const MOST_OPENING: f64 = 0.3;
/// The greatest exaggeration.
const MOST_FACTOR: f64 = 1000.0;

/// The view of the teeth pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TeethView {
    /// The point in the middle of the pane.
    pub centre: Centre,
    /// Zoom steps of √2: in above 0, out below.
    pub zoom: i32,
    /// Whether the gap is exaggerated.
    pub exaggeration: Exaggeration,
}

/// The centre of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Centre {
    /// D, or E without corner contact.
    #[default]
    Strike,
    /// The pitch point.
    PitchPoint,
    /// The whole pair.
    Pair,
}

/// The exaggeration of the gap.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Exaggeration {
    /// By a factor that makes the gap visible.
    #[default]
    Fitted,
    /// True to scale.
    True,
}

impl Centre {
    const ALL: [Centre; 3] = [Centre::Strike, Centre::PitchPoint, Centre::Pair];

    /// The centre `by` places further, wrapping around.
    #[must_use]
    pub(crate) fn beside(self, by: isize) -> Centre {
        let count = Centre::ALL.len();
        Centre::ALL[(self as usize + count).saturating_add_signed(by) % count]
    }

    #[must_use]
    pub(crate) fn name(self) -> &'static str {
        match self {
            Centre::Strike => "the strike",
            Centre::PitchPoint => "the pitch point",
            Centre::Pair => "the pair",
        }
    }
}

impl TeethView {
    /// The view zoomed in by `steps`, or out if negative, at most to the whole pair.
    #[must_use]
    pub fn zoomed(self, steps: i32, inputs: &Inputs, solution: &Solution) -> TeethView {
        let unzoomed = TeethView { zoom: 0, ..self }.extent(inputs, solution);
        let beyond = 2.0 * (whole(&solution.geometry).1 / unzoomed).log2().ceil();
        let last_out = if beyond > 0.0 { -beyond as i32 } else { 0 };
        let zoom =
            self.zoom.saturating_add(steps).max(last_out.max(LAST_STEP_OUT)).min(LAST_STEP_IN);
        TeethView { zoom, ..self }
    }

    /// The view around another centre, without zoom.
    pub(crate) fn centred_beside(self, by: isize) -> TeethView {
        TeethView { centre: self.centre.beside(by), zoom: 0, ..self }
    }

    /// The view with the exaggeration of the gap switched on or off.
    #[must_use]
    pub fn exaggerated_or_not(self) -> TeethView {
        let exaggeration = match self.exaggeration {
            Exaggeration::Fitted => Exaggeration::True,
            Exaggeration::True => Exaggeration::Fitted,
        };
        TeethView { exaggeration, ..self }
    }

    /// The length of the shorter side of the picture, in m.
    #[must_use]
    pub fn extent(&self, inputs: &Inputs, solution: &Solution) -> f64 {
        let geometry = &solution.geometry;
        let contact = first_contact_point(solution);
        let way = |from: f64| {
            let from = on_line_of_action(geometry, from);
            contact.map_or(0.0, |contact| (contact - from).norm())
        };
        let pitch_point = geometry.start + geometry.approach_length;
        let unzoomed = match self.centre {
            Centre::Strike => (STRIKE.0 * inputs.module).max(STRIKE.1 * way(geometry.start)),
            Centre::PitchPoint => {
                PATH * way(pitch_point)
                    .max(geometry.end - pitch_point)
                    .max(geometry.approach_length)
                    .max(inputs.module)
            }
            Centre::Pair => whole(geometry).1,
        };
        let steps = self.zoom.clamp(LAST_STEP_OUT, LAST_STEP_IN);
        unzoomed * 2f64.powf(-0.5 * f64::from(steps))
    }

    /// The exaggeration of the opening, 1 if the opening is visible true to scale.
    ///
    /// The factor is a round number that makes the deviation at most 10 % of the picture's height.
    /// The factor decreases far from the flank, so that the struck tooth does not move, and is 1
    /// after B.
    #[must_use]
    pub(crate) fn factor(self, inputs: &Inputs, solution: &Solution, moment: &ContactState) -> f64 {
        if self.exaggeration == Exaggeration::True || moment.phase == Phase::RunOut {
            return 1.0;
        }
        let room = (SHARE * self.extent(inputs, solution)).min(MOST_DEVIATION * inputs.module);
        let fitted = round_down(room / solution.deviation.total.abs()).min(MOST_FACTOR);
        fitted.min(MOST_OPENING * inputs.module / moment.opening).max(1.0)
    }
}

/// The height and width of the whole pair with a margin, in m.
#[must_use]
pub(crate) fn whole(geometry: &Geometry) -> (f64, f64) {
    const MARGIN: f64 = 1.04;
    let (driver, driven) = (geometry.driver.tip, geometry.driven.tip);
    (MARGIN * 2.0 * driver.max(driven), MARGIN * (geometry.centre_distance + driver + driven))
}

/// The greatest of 1, 2, 5 times a power of ten that is not above the value; at least 1.
pub(crate) fn round_down(value: f64) -> f64 {
    if !(value.is_finite() && value > 0.0) {
        return 1.0;
    }
    let power = 10f64.powf(value.log10().floor());
    let steps = [10.0, 5.0, 2.0, 1.0].map(|step| step * power);
    steps.into_iter().find(|step| *step <= value * (1.0 + 1e-12)).unwrap_or(power)
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "a step is an exact constant")]
mod tests {
    use super::*;

    #[test]
    fn factors_and_bars_are_round() {
        for (value, round) in [
            (1.0, 1.0),
            (1.99, 1.0),
            (2.0, 2.0),
            (49.0, 20.0),
            (50.0, 50.0),
            (999.0, 500.0),
            (1000.0, 1000.0),
        ] {
            assert_eq!(round_down(value), round);
        }
        assert!((round_down(0.0034) / 0.002 - 1.0).abs() < 1e-12);
        for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(round_down(value), 1.0);
        }
    }
}
