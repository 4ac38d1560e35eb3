//! What of the roll angle is in sight: the state of the chart.

use super::scale::{Scale, Span};

/// Each step of the zoom is √2; the last one shows a thousandth of what is there without it.
const LAST_STEP_IN: i32 = 20;
/// A cursor that leaves what is in sight comes back this far from the edge, so that it does not
/// drag the picture along.
const MARGIN: f64 = 0.25;

/// What of the roll angle is in sight.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ChartView {
    /// What is in sight without zoom.
    pub frame: Frame,
    /// Steps of √2, in above 0 and out below.
    pub zoom: i32,
    /// What stands in the middle, in deg after E; else the middle of the frame.
    pub middle: Option<f64>,
}

/// What is in sight without zoom.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frame {
    /// From D to the end of the contact.
    #[default]
    Whole,
    /// From D to a little after E.
    Strike,
}

impl ChartView {
    /// The roll angles in sight, in deg after E.
    #[must_use]
    pub fn window(&self, scale: &Scale) -> Span {
        let frame = self.frame(scale);
        let all = scale.across.and(frame);
        let half =
            0.5 * (frame.length() * 2f64.powf(-0.5 * f64::from(self.zoom))).min(all.length());
        let middle = self
            .middle
            .unwrap_or_else(|| f64::midpoint(frame.from, frame.to));
        if self.zoom == 0 && self.middle.is_none() {
            frame
        } else {
            Span::new(middle - half, middle + half).within(all)
        }
    }

    /// The view some steps closer around an angle, or farther below 0; as far as the whole.
    #[must_use]
    pub fn zoomed(self, steps: i32, around: f64, scale: &Scale) -> ChartView {
        let zoom = (self.zoom + steps).min(LAST_STEP_IN);
        let view = ChartView {
            zoom,
            middle: Some(around),
            ..self
        };
        let shows_all = view.window(scale).length() >= scale.across.length() * (1.0 - 1e-9);
        if steps < 0 && shows_all {
            ChartView::default()
        } else {
            view
        }
    }

    /// The strike, or the whole where that is in sight already.
    #[must_use]
    pub fn strike_or_whole(self) -> ChartView {
        let frame = if self.frame == Frame::Strike {
            Frame::Whole
        } else {
            Frame::Strike
        };
        ChartView {
            frame,
            ..ChartView::default()
        }
    }

    /// The view moved, where it must be, until an angle is in sight.
    #[must_use]
    pub fn following(self, angle: f64, scale: &Scale) -> ChartView {
        let window = self.window(scale);
        if window.is_empty() || (window.from..=window.to).contains(&angle) {
            return self;
        }
        let inward = (0.5 - MARGIN) * window.length();
        ChartView {
            middle: Some(if angle > window.to {
                angle + inward
            } else {
                angle - inward
            }),
            ..self
        }
    }

    fn frame(&self, scale: &Scale) -> Span {
        match self.frame {
            Frame::Strike if !scale.strike.is_empty() => scale.strike,
            _ => scale.across,
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "ends are those of the axis")]
mod tests {
    use super::*;

    const SCALE: Scale = Scale {
        across: Span {
            from: -5.0,
            to: 25.0,
        },
        strike: Span {
            from: -1.5,
            to: 0.5,
        },
        upright: [Span { from: 0.0, to: 1.0 }; 9],
    };

    #[test]
    fn it_opens_on_the_whole_and_comes_back_to_it() {
        let view = ChartView::default();
        assert_eq!(view.window(&SCALE), SCALE.across);
        let close = (0..4).fold(view, |view, _| view.zoomed(1, -1.0, &SCALE));
        assert_eq!(close.window(&SCALE), Span::new(-4.75, 2.75));
        assert_eq!(
            (0..4).fold(close, |view, _| view.zoomed(-1, -1.0, &SCALE)),
            view
        );
        assert_eq!(view.strike_or_whole().window(&SCALE), SCALE.strike);
        assert_eq!(view.strike_or_whole().strike_or_whole(), view);
        assert_eq!(
            (0..9).fold(view.strike_or_whole(), |view, _| view
                .zoomed(-1, 0.0, &SCALE)),
            view
        );
    }

    #[test]
    fn however_close_something_is_in_sight() {
        let view = (0..99).fold(ChartView::default(), |view, _| view.zoomed(1, 25.0, &SCALE));
        let window = view.window(&SCALE);
        assert!(window.length() > 0.02 && window.to == 25.0, "{window:?}");
    }

    #[test]
    fn it_follows_the_cursor_and_stays_on_the_axis() {
        let strike = ChartView::default().strike_or_whole();
        assert_eq!(strike.following(-1.0, &SCALE), strike);
        let moved = strike.following(0.6, &SCALE).window(&SCALE);
        assert!(
            moved.from < 0.6 && moved.to > 0.6 && (moved.length() - 2.0).abs() < 1e-9,
            "{moved:?}"
        );
        assert_eq!(strike.following(25.0, &SCALE).window(&SCALE).to, 25.0);
    }
}
