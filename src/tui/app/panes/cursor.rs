//! The cursor of charts and teeth: its range, its animation, and a typed angle, time or point.

use super::chart::curves::{CurveSource, curves};
use super::chart::{Charts, columns, first_contact, last_contact};
use crate::case::units::{self, Dimension};
use crate::numeric::decimal::{shortest, significant};
use crate::report::stations::GRAPHS;
use crate::tui::app::App;

/// Frames of the animation: four seconds at twelve frames a second.
const PICTURES: f64 = 48.0;
/// The start of the animation in the teeth pane, before D, as a multiple of the angle from D to E.
const APPROACH: f64 = 1.6;

/// The range of the cursor, in rad before E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reach {
    /// The first contact D, or E without corner contact.
    pub(crate) start: f64,
    /// The start of the animation.
    pub(crate) run_from: f64,
    /// The end of the animation.
    pub(crate) run_to: f64,
    /// The leftmost angle.
    pub(crate) most: f64,
    /// The rightmost angle, negative after E.
    pub(crate) least: f64,
    /// The angle per column.
    pub(crate) column: f64,
}

impl Reach {
    /// The angle after a move by `columns` towards E; D if there is no cursor yet.
    pub(crate) fn moved(self, cursor: Option<f64>, columns: isize) -> f64 {
        let moved = cursor.map(|cursor| cursor - columns as f64 * self.column);
        self.held(moved.unwrap_or(self.start))
    }

    /// The angle of the next frame; `None` at the end.
    pub(crate) fn played(self, cursor: f64) -> Option<f64> {
        let next = cursor - (self.run_from - self.run_to) / PICTURES;
        (next > self.run_to && next < cursor).then_some(next)
    }

    fn held(self, angle: f64) -> f64 {
        let angle = angle.clamp(self.least, self.most);
        // Rounding must not keep the cursor from E.
        if angle.abs() < 1e-9 * self.column { 0.0 } else { angle }
    }
}

/// The completion of a typed angle or time.
fn ending(charts: Charts<'_>, typed: &str) -> Option<String> {
    if units::parse(typed, Dimension::Number, "").is_ok() {
        let unit = charts.ruler().1.unit;
        return units::ending(typed, Dimension::of_unit(&unit)?, &unit);
    }
    let dimensions = [Dimension::Angle, Dimension::Time];
    let is_whole = dimensions.iter().any(|&one| units::parse(typed, one, "").is_ok());
    match dimensions.map(|dimension| units::ending(typed, dimension, "")) {
        [Some(ending), None] | [None, Some(ending)] if !is_whole => Some(ending),
        _ => None,
    }
}

/// The range of the cursor in the focused pane, or in the visible pane. In a chart it is the range
/// of the axis. In the teeth pane it extends to one base pitch after E.
pub(crate) fn cursor_range(charts: Charts<'_>) -> Option<Reach> {
    let solution = charts.solution()?;
    let pitch = solution.geometry.base_pitch / solution.geometry.driver.base;
    let start = first_contact(solution).unwrap_or(0.0);
    let end = last_contact(solution).unwrap_or(0.0).min(0.0);
    let ahead = charts.ahead();
    let axis = charts.scale().across.shifted(-ahead);
    let before =
        if axis.is_empty() { start.max(pitch / 10.0) } else { start.max(-axis.from.to_radians()) };
    let columns = f64::from(columns(charts).max(2) - 1);
    if charts.is_in_teeth() {
        let (most, least) = (before.max(2.0 * start), end.min(-pitch));
        return Some(Reach {
            start,
            run_from: APPROACH * start,
            run_to: 0.0,
            most,
            least,
            column: before / columns,
        });
    }
    let window = charts.window().shifted(-ahead);
    let (least, shown) = if axis.is_empty() {
        (end, before)
    } else {
        (end.min(-axis.to.to_radians()), window.length().to_radians())
    };
    // The animation covers the visible part of the contact.
    let visible = (start.min(-window.from.to_radians()), end.max(-window.to.to_radians()));
    let (run_from, run_to) = if visible.0 > visible.1 { visible } else { (start, end) };
    Some(Reach { start, run_from, run_to, most: before, least, column: shown / columns })
}

/// What a typed angle, time or point means, and its completion.
pub(crate) fn meaning(app: &App, typed: &str) -> (Result<String, String>, Option<String>) {
    let charts = app.charts();
    let meant = match parse_cursor(charts, typed) {
        _ if typed.trim().is_empty() => Ok(String::new()),
        angle => angle.map(|angle| format!("= {}", describe(charts, angle))),
    };
    (meant, ending(charts, typed))
}

/// Parses an angle or a time after E or the name of a point; returns the driver's angle before E, in
/// rad.
///
/// # Errors
/// Returns an error if the text is not valid, or if the angle is out of range.
pub(crate) fn parse_cursor(charts: Charts<'_>, typed: &str) -> Result<f64, String> {
    const UNSOLVED: &str = "no valid results for a cursor";
    let solution = charts.solution().ok_or(UNSOLVED)?;
    let reach = cursor_range(charts).ok_or(UNSOLVED)?;
    let geometry = &solution.geometry;
    let angle = match typed.trim().to_lowercase().as_str() {
        "d" => first_contact(solution).ok_or("no corner contact, so no D")?,
        "e" => 0.0,
        "b" => (geometry.start - geometry.end) / geometry.driver.base,
        "l" => {
            last_contact(solution).ok_or("only static and dynamic compute the last contact L")?
        }
        // Its range is that of another plane.
        "peak" if charts.shown_pattern().is_some() => return greatest_load(charts).map(|it| it.0),
        "peak" => peak(charts).ok_or("the chart has no curve, so no peak")?,
        _ => measured(charts, typed)?,
    };
    let slack = 1e-9 * reach.column;
    if (reach.least - slack..=reach.most + slack).contains(&angle) {
        return Ok(reach.held(angle));
    }
    let [angle, most, least] = [angle, reach.most, reach.least].map(|end| describe(charts, end));
    Err(format!("{angle} is out of range: from {most} to {least}"))
}

/// An angle as text, with its time from E.
fn describe(charts: Charts<'_>, angle: f64) -> String {
    let short = |number: f64, digits| {
        let rounded = significant(number, digits);
        rounded.parse().map_or(rounded, shortest)
    };
    let side = if angle < 0.0 { "after" } else { "before" };
    let micros = Some(1e6 * angle.abs() / speed(charts)).filter(|micros| micros.is_finite());
    let time = micros.map(|micros| format!(" ({} us)", short(micros, 4))).unwrap_or_default();
    format!("{} deg{time} {side} E", short(angle.abs().to_degrees(), 5))
}

fn speed(charts: Charts<'_>) -> f64 {
    charts.answer().map_or(0.0, |answer| answer.inputs.speed)
}

/// The driver's angle before E, in rad, and the place along the face, in m, of the greatest line load
/// in the visible part of the contact pattern, or of the tooth.
///
/// # Errors
/// Returns an error if no contact pattern is visible.
pub(crate) fn greatest_load(charts: Charts<'_>) -> Result<(f64, f64), String> {
    let pattern = charts.shown_pattern().ok_or("no contact pattern")?;
    let (angle, z) = pattern.greatest(charts.window().scaled(1f64.to_radians()));
    Ok((0.0 - angle, z))
}

// The angle at which the curve of the active method in the selected chart is farthest from 0.
fn peak(charts: Charts<'_>) -> Option<f64> {
    let curves = curves(charts, &GRAPHS[charts.0.chart.graph()]);
    let own = curves.iter().find(|curve| matches!(curve.source, CurveSource::Active(_)))?;
    let highest =
        own.pieces.iter().flatten().max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
    Some(0.0 - highest.0.to_radians())
}

// Angles and times count after E, as on the axes.
fn measured(charts: Charts<'_>, typed: &str) -> Result<f64, String> {
    let whole = [typed, &ending(charts, typed).unwrap_or_default()].concat();
    let angle = units::parse(&whole, Dimension::Angle, "deg").map(|angle| 0.0 - angle);
    let time =
        || units::parse(&whole, Dimension::Time, "us").map(|time| 0.0 - time * speed(charts));
    angle.or_else(|_| time()).map_err(|_| match units::parse(typed.trim(), Dimension::Number, "") {
        Err(misread) if typed.contains(',') => misread.fix,
        _ => format!("{} is not an angle, time or point", typed.trim()),
    })
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the ends of the range are exact")]
mod tests {
    use super::*;

    const REACH: Reach = Reach {
        start: 0.024,
        run_from: 0.024,
        run_to: 0.0,
        most: 0.03,
        least: 0.0,
        column: 0.0003,
    };

    #[test]
    fn the_first_key_moves_the_cursor_to_d() {
        assert!(REACH.moved(None, 1) == 0.024 && REACH.moved(None, -10) == 0.024);
    }

    #[test]
    fn a_column_there_and_back_is_the_same_place() {
        let there = REACH.moved(Some(0.012), 7);
        assert!((there - (0.012 - 7.0 * 0.0003)).abs() < 1e-15);
        assert!((REACH.moved(Some(there), -7) - 0.012).abs() < 1e-15);
    }

    #[test]
    fn the_cursor_stays_on_the_axis_and_meets_e_itself() {
        assert!(REACH.moved(Some(0.029), -10) == 0.03);
        assert!(REACH.moved(Some(0.0002), 1) == 0.0);
        let after = Reach { least: -0.3, ..REACH };
        let cursor = (0..80).fold(0.024, |cursor, _| after.moved(Some(cursor), 1));
        assert!(cursor == 0.0, "{cursor}");
        assert!(after.moved(Some(0.0), 1) < 0.0);
    }

    #[test]
    fn the_approach_is_over_after_its_pictures() {
        let mut cursor = Some(REACH.run_from);
        let mut pictures = 0;
        while let Some(now) = cursor {
            cursor = REACH.played(now);
            pictures += 1;
            assert!(pictures < 100);
        }
        assert!((47..=49).contains(&pictures), "{pictures}");
        assert_eq!(Reach { start: 0.0, run_from: 0.0, ..REACH }.played(0.0), None);
    }
}
