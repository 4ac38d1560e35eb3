//! The view of the teeth pane: centre, zoom and exaggeration of the gap.

use nalgebra::{Point2, Vector2};
use ratatui::layout::Size;

use crate::model::contact_state::{Phase, first_contact_point};
use crate::model::outline::on_line_of_action;
use crate::model::{ContactState, Geometry, Inputs, Solution};
use crate::report::teeth::{Window, round_down};

/// The height of a cell over its width.
pub(super) const CELL_HEIGHT: f64 = 2.0;
/// Bounds of the width of a cell, in m. Outside them, differences of coordinates are lost or
/// overflow.
const CELL: (f64, f64) = (1e-12, 1e6);
/// The size of the whole pair over the size of the gears.
const MARGIN: f64 = 1.04;

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
    /// Whether the gap is drawn true to scale rather than exaggerated.
    pub has_true_gap: bool,
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

impl Centre {
    const ALL: [Centre; 3] = [Centre::Strike, Centre::PitchPoint, Centre::Pair];

    /// The centre `by` places further, wrapping around.
    pub(super) fn beside(self, by: isize) -> Centre {
        let count = Centre::ALL.len();
        Centre::ALL[(self as usize + count).saturating_add_signed(by) % count]
    }

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
        let beyond = 2.0 * (whole(&solution.geometry).x / unzoomed).log2().ceil();
        let last_out = (-beyond.max(0.0) as i32).max(LAST_STEP_OUT);
        TeethView { zoom: self.zoom.saturating_add(steps).max(last_out).min(LAST_STEP_IN), ..self }
    }

    /// The length of the shorter side of the picture, in m.
    #[must_use]
    pub fn extent(&self, inputs: &Inputs, solution: &Solution) -> f64 {
        let geometry = &solution.geometry;
        let way_from = |length: f64| {
            let from = on_line_of_action(geometry, length);
            first_contact_point(solution).map_or(0.0, |contact| (contact - from).norm())
        };
        let pitch_point = geometry.start + geometry.approach_length;
        let unzoomed = match self.centre {
            Centre::Strike => (STRIKE.0 * inputs.module).max(STRIKE.1 * way_from(geometry.start)),
            Centre::PitchPoint => {
                PATH * way_from(pitch_point)
                    .max(geometry.end - pitch_point)
                    .max(geometry.approach_length)
                    .max(inputs.module)
            }
            Centre::Pair => whole(geometry).x,
        };
        let steps = self.zoom.clamp(LAST_STEP_OUT, LAST_STEP_IN);
        unzoomed * 2f64.powf(-0.5 * f64::from(steps))
    }

    /// The visible part of the plane on a screen with a size and with so many dots per cell. The
    /// scale is the same in both directions, and as little as possible outside the pair is visible.
    pub(super) fn window(
        self,
        inputs: &Inputs,
        solution: &Solution,
        size: Size,
        dots: (u16, u16),
    ) -> Window {
        let geometry = &solution.geometry;
        // The canvas is measured between the middles of its outermost dots.
        let span = |cells: u16, dots: u16| (f64::from(cells) - 1.0 / f64::from(dots)).max(0.5);
        let (wide, high) = (span(size.width, dots.0), CELL_HEIGHT * span(size.height, dots.1));
        let whole = whole(geometry);
        let fitting = (whole.x / wide).max(whole.y / high);
        let extent = self.extent(inputs, solution);
        let cell = match self.centre {
            Centre::Pair => fitting * extent / whole.x,
            Centre::Strike | Centre::PitchPoint => extent / wide.min(high),
        };
        let cell = cell.min(fitting).max(CELL.0).min(CELL.1);
        let half = Vector2::new(wide, high) * (0.5 * cell);
        let pair = 0.5 * (geometry.centre_distance + geometry.driven.tip - geometry.driver.tip);
        let middle = Point2::new(pair, 0.0);
        let start = on_line_of_action(geometry, geometry.start);
        let at = match self.centre {
            Centre::Strike => first_contact_point(solution).unwrap_or(start),
            Centre::PitchPoint => {
                on_line_of_action(geometry, geometry.start + geometry.approach_length)
            }
            Centre::Pair => middle,
        };
        let room = (0.5 * whole - half).sup(&Vector2::zeros());
        let centre = middle + (at - middle).inf(&room).sup(&-room);
        Window { centre, half, dot: cell / f64::from(dots.0) }
    }

    /// The exaggeration of the opening, 1 if the opening is visible true to scale.
    ///
    /// The factor is a round number that makes the deviation at most 10 % of the picture's height.
    /// The factor decreases far from the flank, so that the struck tooth does not move, and is 1
    /// after B.
    pub(super) fn factor(self, inputs: &Inputs, solution: &Solution, moment: &ContactState) -> f64 {
        if self.has_true_gap || moment.phase == Phase::RunOut {
            return 1.0;
        }
        let room = (SHARE * self.extent(inputs, solution)).min(MOST_DEVIATION * inputs.module);
        let fitted = round_down(room / solution.deviation.total.abs()).min(MOST_FACTOR);
        fitted.min(MOST_OPENING * inputs.module / moment.opening).max(1.0)
    }
}

/// The width and height of the whole pair with a margin, in m.
fn whole(geometry: &Geometry) -> Vector2<f64> {
    let (driver, driven) = (geometry.driver.tip, geometry.driven.tip);
    MARGIN * Vector2::new(geometry.centre_distance + driver + driven, 2.0 * driver.max(driven))
}
