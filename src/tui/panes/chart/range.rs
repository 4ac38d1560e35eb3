//! The axes of the charts, the range of roll angles of the incoming tooth, and the visible range.

use crate::model::{Solution, Station};
use crate::report::chart::Span;
use crate::tui::solver::Answer;

/// The closest zoom, as a fraction of the whole contact.
const CLOSEST: f64 = 1e-3;
/// Distance from the edge, as a fraction of the visible range, of a cursor after it has left the
/// range. Without this distance the charts would scroll with every step of the cursor.
const MARGIN: f64 = 0.25;

/// The roll angles of the charts, in deg after E, negative before E.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scale {
    /// The whole contact.
    pub across: Span,
    /// From D to a little after E; empty without corner contact.
    pub(crate) strike: Span,
}

/// The visible range of roll angles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ChartView {
    /// The strike if the contact continues after it, otherwise the whole contact.
    #[default]
    Opening,
    /// From D to the end of the contact.
    Whole,
    /// From D to a little after E.
    Strike,
    /// A part, in deg after E.
    Part(Span),
}

impl ChartView {
    /// The visible roll angles, in deg after E.
    #[must_use]
    pub(crate) fn window(self, scale: &Scale) -> Span {
        let Scale { across, strike } = *scale;
        match self {
            ChartView::Part(part) if !part.is_empty() => part.within(across.and(strike)),
            ChartView::Strike if !strike.is_empty() => strike,
            ChartView::Opening if !strike.is_empty() && strike.to < across.to => strike,
            // Also a part of a chart that had no values.
            _ => across,
        }
    }

    /// The view zoomed in by `steps` of √2 around an angle, or out if `steps` is negative, at most
    /// to the whole contact.
    #[must_use]
    pub(crate) fn zoomed(self, steps: i32, around: f64, scale: &Scale) -> ChartView {
        let all = scale.across.and(scale.strike);
        let length = self.window(scale).length() * 2f64.powf(-0.5 * f64::from(steps));
        let length = length.max(CLOSEST * all.length());
        if steps < 0 && length >= scale.across.length() * (1.0 - 1e-9) {
            return ChartView::Whole;
        }
        ChartView::around(around, length, scale)
    }

    fn around(middle: f64, length: f64, scale: &Scale) -> ChartView {
        let part = Span::new(middle - 0.5 * length, middle + 0.5 * length);
        ChartView::Part(part.within(scale.across.and(scale.strike)))
    }

    /// Switches between the strike and the whole contact.
    pub(crate) fn strike_or_whole(self, scale: &Scale) -> ChartView {
        let is_strike = self.window(scale) == scale.strike;
        if is_strike { ChartView::Whole } else { ChartView::Strike }
    }

    /// The view, scrolled if necessary to make an angle visible.
    pub(crate) fn following(self, angle: f64, scale: &Scale) -> ChartView {
        let window = self.window(scale);
        if window.is_empty() || (window.from..=window.to).contains(&angle) {
            return self;
        }
        let inward = (0.5 - MARGIN) * window.length();
        let middle = if angle > window.to { angle + inward } else { angle - inward };
        ChartView::around(middle, window.length(), scale)
    }
}

/// The driver's angle before E at the last contact, in rad, negative after E. Only `static` and
/// `dynamic` have a last contact.
pub(crate) fn last_contact(solution: &Solution) -> Option<f64> {
    let last = solution.own_stations().last().filter(|station| station.load_share().is_some());
    last.map(|station| station.roll_angle_driver)
}

/// The range of the path of contact with its mesh stiffness, in deg after E.
pub(super) fn path(answer: &Answer) -> Span {
    let Some(Ok(found)) = &answer.stiffness else {
        return Span::NONE;
    };
    Span::of(found.points.iter().map(|point| (point.way / found.base_radius).to_degrees()))
}

/// The range of the stations of a method, in deg after E.
pub(super) fn way(solution: &Solution) -> Span {
    let rows = solution.own_stations();
    let ends = [rows.first(), rows.last()].into_iter().flatten();
    Span::of(ends.map(Station::angle_after_e))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the ends are copied from the axis")]
mod tests {
    use super::*;

    const SCALE: Scale =
        Scale { across: Span { from: -5.0, to: 25.0 }, strike: Span { from: -1.5, to: 0.5 } };

    #[test]
    fn it_opens_on_the_strike_if_the_contact_continues_after_it() {
        let view = ChartView::default();
        assert_eq!(view.window(&SCALE), SCALE.strike);
        let closed_form = Scale { across: Span::new(-1.5, 0.0), ..SCALE };
        assert_eq!(view.window(&closed_form), closed_form.across);
        let no_strike = Scale { strike: Span::default(), ..SCALE };
        assert_eq!(view.window(&no_strike), SCALE.across);
        assert_eq!(view.strike_or_whole(&SCALE).window(&SCALE), SCALE.across);
    }

    #[test]
    fn zooming_out_ends_at_the_whole_contact() {
        let view = ChartView::Whole;
        assert_eq!(view.window(&SCALE), SCALE.across);
        let close = (0..4).fold(view, |view, _| view.zoomed(1, -1.0, &SCALE));
        let window = close.window(&SCALE);
        assert!((window.from + 4.75).abs() + (window.to - 2.75).abs() < 1e-9, "{window:?}");
        assert_eq!((0..4).fold(close, |view, _| view.zoomed(-1, -1.0, &SCALE)), view);
        assert_eq!(view.strike_or_whole(&SCALE).window(&SCALE), SCALE.strike);
        assert_eq!(view.strike_or_whole(&SCALE).strike_or_whole(&SCALE), view);
        assert_eq!(
            (0..9).fold(view.strike_or_whole(&SCALE), |view, _| view.zoomed(-1, 0.0, &SCALE)),
            view
        );
    }

    #[test]
    fn the_closest_zoom_still_shows_a_range() {
        let view = (0..99).fold(ChartView::Whole, |view, _| view.zoomed(1, 25.0, &SCALE));
        let window = view.window(&SCALE);
        assert!(window.length() > 0.02 && window.to == 25.0, "{window:?}");
    }

    #[test]
    fn the_view_follows_the_cursor_and_stays_on_the_axis() {
        let strike = ChartView::default();
        assert_eq!(strike.following(-1.0, &SCALE), strike);
        let moved = strike.following(0.6, &SCALE).window(&SCALE);
        assert!(
            moved.from < 0.6 && moved.to > 0.6 && (moved.length() - 2.0).abs() < 1e-9,
            "{moved:?}"
        );
        assert_eq!(strike.following(25.0, &SCALE).window(&SCALE).to, 25.0);
    }
}
