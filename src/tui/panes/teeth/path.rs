//! Splits curves into straight pieces, as many as the visible dots need.

use nalgebra::Point2;

use super::window::Window;

/// The greatest distance between a chord and its curve, in dots.
const STRAY: f64 = 0.4;
/// The greatest ratio of the length of an arc of at most a quarter turn to the length of its two
/// half chords.
const LONGER: f64 = 1.1;
/// The greatest number of halvings of a curve.
const MOST_HALVINGS: u32 = 32;

/// A straight visible piece of a curve, with the parameters at its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stretch {
    /// Parameter and point at the beginning.
    pub(crate) from: (f64, Point2<f64>),
    /// Parameter and point at the end.
    pub(crate) to: (f64, Point2<f64>),
}

/// Follows a curve over its parameter from 0 to 1 through the window, in pieces that are straight
/// within a dot.
///
/// The curve must turn by less than a quarter turn in one direction. Hidden parts are skipped, so
/// that the cost depends on the dots and not on the zoom.
pub(crate) fn follow(
    curve: impl Fn(f64) -> Point2<f64>,
    window: &Window,
    mut found: impl FnMut(Stretch),
) {
    let ends = ((0.0, curve(0.0)), (1.0, curve(1.0)));
    halve(&curve, window, ends.0, ends.1, MOST_HALVINGS, &mut found);
}

fn halve(
    curve: &impl Fn(f64) -> Point2<f64>,
    window: &Window,
    from: (f64, Point2<f64>),
    to: (f64, Point2<f64>),
    halvings: u32,
    found: &mut impl FnMut(Stretch),
) {
    let at = f64::midpoint(from.0, to.0);
    let middle = (at, curve(at));
    let reach = LONGER * ((middle.1 - from.1).norm() + (to.1 - middle.1).norm());
    // A curve with NaN is never visible.
    let in_sight = window.distance(middle.1) <= reach;
    if !in_sight {
        return;
    }
    if halvings == 0 || stray(from.1, middle.1, to.1) <= STRAY * window.dot {
        for (from, to) in [(from, middle), (middle, to)] {
            found_in_sight(window, from, to, found);
        }
        return;
    }
    halve(curve, window, from, middle, halvings - 1, found);
    halve(curve, window, middle, to, halvings - 1, found);
}

/// The distance between the middle and the chord.
fn stray(from: Point2<f64>, middle: Point2<f64>, to: Point2<f64>) -> f64 {
    let (chord, way) = (to - from, middle - from);
    let length = chord.norm();
    if length > 0.0 { chord.perp(&way).abs() / length } else { way.norm() }
}

fn found_in_sight(
    window: &Window,
    from: (f64, Point2<f64>),
    to: (f64, Point2<f64>),
    found: &mut impl FnMut(Stretch),
) {
    let Some((first, last)) = window.clip(from.1, to.1) else {
        return;
    };
    let at = |part: f64| (from.0 + part * (to.0 - from.0), from.1 + (to.1 - from.1) * part);
    found(Stretch { from: at(first), to: at(last) });
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector2;
    use ratatui::layout::Size;

    /// A window of a size in m around a point, on 100 columns and 25 rows of Braille.
    fn window(centre: Point2<f64>, width: f64) -> Window {
        let dot = width / 199.0;
        let half = Vector2::new(99.5, 49.5) * dot;
        Window { centre, half, dot, size: Size::new(100, 25), dots: (2, 4) }
    }

    fn quarter(radius: f64) -> impl Fn(f64) -> Point2<f64> {
        move |part| {
            let angle = part * std::f64::consts::FRAC_PI_2;
            Point2::new(radius * angle.cos(), radius * angle.sin())
        }
    }

    #[test]
    fn stretches_keep_to_the_curve_and_the_window_at_every_zoom() {
        let centre = quarter(1.0)(0.3);
        for zoom in 0..20 {
            let window = window(centre, 4.0 * 0.5f64.powi(zoom));
            let (mut count, mut length) = (0, 0.0);
            follow(quarter(1.0), &window, |stretch| {
                count += 1;
                length += (stretch.to.1 - stretch.from.1).norm();
                let off =
                    (1.0 - nalgebra::center(&stretch.from.1, &stretch.to.1).coords.norm()).abs();
                assert!(off <= window.dot, "{off} off at zoom {zoom}");
                assert!(
                    window.distance(stretch.from.1) < 1e-6 * window.dot
                        && window.distance(stretch.to.1) < 1e-6 * window.dot
                );
            });
            assert!((1..=128).contains(&count), "{count} stretches at zoom {zoom}");
            let across = length / window.dot;
            assert!(zoom < 4 || (99.0..250.0).contains(&across), "{across} dots at zoom {zoom}");
        }
    }

    #[test]
    fn hidden_and_invalid_curves_cost_nothing() {
        let window = window(Point2::new(5.0, 5.0), 1.0);
        follow(quarter(1.0), &window, |stretch| panic!("{stretch:?}"));
        follow(|_| Point2::new(f64::NAN, 5.0), &window, |stretch| panic!("{stretch:?}"));
        follow(|part| Point2::new(5.0, part / 0.0), &window, |stretch| panic!("{stretch:?}"));
    }
}
