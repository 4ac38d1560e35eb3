//! The roll angles at which the cursor may stand, and which of them is meant by what is typed.

use super::chart::axes::Ruler;
use super::chart::curves::{Whose, curves};
use super::chart::{self, first_contact, last_contact};
use crate::case::units::{self, Dimension};
use crate::model::Solution;
use crate::report::graphs::GRAPHS;
use crate::tui::app::App;
use crate::tui::layout::plan;
use crate::tui::pane::Pane;

/// How an angle is typed.
pub const HOW: &str = "An angle before E (1.2 deg, 20 mrad), a time after E (-80 us, 0.1 ms), or a place: D, E, B, L, peak.";

/// Pictures of a run: four seconds at twelve a second.
const PICTURES: f64 = 48.0;
/// In the teeth a run begins before D, where the tip is still to come: at this many times the angle
/// from D to E.
const APPROACH: f64 = 1.6;

/// Where the cursor may stand, in rad before E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// The first contact D, or E where no tooth strikes.
    pub start: f64,
    /// Where a run begins.
    pub run_from: f64,
    /// Where it ends: at E, or at the last contact where the method goes on to it.
    pub run_to: f64,
    /// The leftmost angle.
    pub most: f64,
    /// The rightmost angle, negative after E.
    pub least: f64,
    /// What a column stands for.
    pub column: f64,
}

impl Reach {
    /// The angle so many columns towards E from this one, or from D where there is none yet.
    #[must_use]
    pub fn moved(self, cursor: Option<f64>, columns: i16) -> f64 {
        let Some(cursor) = cursor else {
            return self.held(self.start);
        };
        self.held(cursor - f64::from(columns) * self.column)
    }

    /// The next picture of the run, none when its end is reached.
    #[must_use]
    pub fn played(self, cursor: f64) -> Option<f64> {
        let next = cursor - (self.run_from - self.run_to) / PICTURES;
        (next > self.run_to && next < cursor).then_some(next)
    }

    fn held(self, angle: f64) -> f64 {
        let angle = angle.clamp(self.least, self.most);
        // E itself can be reached by whole columns, whatever they add up to.
        if angle.abs() < 1e-9 * self.column {
            0.0
        } else {
            angle
        }
    }
}

/// The driver's angle before E that is meant, in rad.
///
/// # Errors
/// In words, where none is or the cursor cannot stand there.
pub fn parse_cursor(app: &App, typed: &str) -> Result<f64, String> {
    let solution = solution(app).ok_or("no valid results for the cursor")?;
    let reach = cursor_range(app).ok_or("no valid results for the cursor")?;
    let angle = match place(app, solution, typed.trim()) {
        Some(place) => place?,
        None => measured(app, typed)?,
    };
    let slack = 1e-9 * reach.column;
    if (reach.least - slack..=reach.most + slack).contains(&angle) {
        return Ok(reach.held(angle));
    }
    let ends = [reach.most, reach.least].map(|end| told(app, end));
    Err(format!(
        "{} is out of sight: the cursor goes from {} to {}",
        told(app, angle),
        ends[0],
        ends[1]
    ))
}

/// What completes an angle or a time that is typed.
#[must_use]
pub fn ending(app: &App, typed: &str) -> Option<String> {
    let ruler = ruler(app);
    let dimensions = [Dimension::Angle, Dimension::Time];
    if units::parse(typed, Dimension::Number, "").is_ok() {
        return units::ending(typed, Dimension::of_unit(ruler.unit)?, ruler.unit);
    }
    let mut endings = dimensions
        .into_iter()
        .filter_map(|dimension| units::ending(typed, dimension, ""));
    let is_whole = dimensions
        .into_iter()
        .any(|dimension| units::parse(typed, dimension, "").is_ok());
    endings
        .next()
        .filter(|_| endings.next().is_none() && !is_whole)
}

/// An angle as the cursor tells it, with the time from there to E or back.
#[must_use]
pub fn told(app: &App, angle: f64) -> String {
    let speed = app
        .answer
        .as_ref()
        .map_or(0.0, |answer| answer.inputs.speed);
    let side = if angle < 0.0 { "after" } else { "before" };
    let micros = 1e6 * angle.abs() / speed;
    let time = if micros.is_finite() {
        format!(" ({micros:.1} us)")
    } else {
        String::new()
    };
    format!("{:.4} deg{time} {side} E", angle.abs().to_degrees())
}

// A place by its name; none where what is typed is no name.
fn place(app: &App, solution: &Solution, name: &str) -> Option<Result<f64, String>> {
    let geometry = &solution.geometry;
    let found = |angle: Option<f64>, why: &str| angle.ok_or_else(|| why.to_owned());
    Some(match name.to_lowercase().as_str() {
        "d" => found(
            first_contact(solution),
            "no corner contact, no first contact D",
        ),
        "e" => Ok(0.0),
        "b" => Ok((geometry.start - geometry.end) / geometry.driver.base),
        "l" => found(
            last_contact(solution),
            "the last contact L is known to static and dynamic alone",
        ),
        "peak" => found(peak(app), "there is no curve in the chart, and so no peak"),
        _ => return None,
    })
}

// Where the active method's curve in the chosen chart is farthest from 0.
fn peak(app: &App) -> Option<f64> {
    let curves = curves(app, &GRAPHS[app.graph]);
    let own = curves
        .iter()
        .find(|curve| matches!(curve.whose, Whose::Active(_)))?;
    let highest = own
        .pieces
        .iter()
        .flatten()
        .max_by(|one, other| one.1.abs().total_cmp(&other.1.abs()))?;
    Some(0.0 - highest.0.to_radians())
}

// Angles count before E, times after it, as the axes have them.
fn measured(app: &App, typed: &str) -> Result<f64, String> {
    let whole = [typed, &ending(app, typed).unwrap_or_default()].concat();
    let angle = units::parse(&whole, Dimension::Angle, "deg");
    let speed = app
        .answer
        .as_ref()
        .map_or(0.0, |answer| answer.inputs.speed);
    let time = || units::parse(&whole, Dimension::Time, "us").map(|time| 0.0 - time * speed);
    angle.or_else(|_| time()).map_err(
        |_| match units::parse(typed.trim(), Dimension::Number, "") {
            Err(misread) if typed.contains(',') => misread.mend,
            _ => format!("{} is no angle, time or place", typed.trim()),
        },
    )
}

fn ruler(app: &App) -> Ruler {
    let speed = app
        .answer
        .as_ref()
        .map_or(0.0, |answer| answer.inputs.speed);
    Ruler::of(app.by_time, speed, app.chart.window(&app.scale))
}

// The chart ends where its axis does; the teeth go on until the next pair is where this one was,
// and come from further.
/// Where the cursor may stand in the focused pane, or in the one that is in sight.
#[must_use]
pub fn cursor_range(app: &App) -> Option<Reach> {
    let solution = solution(app)?;
    let pitch = solution.geometry.base_pitch / solution.geometry.driver.base;
    let start = first_contact(solution).unwrap_or(0.0);
    let end = last_contact(solution).unwrap_or(0.0).min(0.0);
    let axis = app.scale.across;
    let before = if axis.is_empty() {
        start.max(pitch / 10.0)
    } else {
        start.max(-axis.from.to_radians())
    };
    let columns = f64::from(chart::columns(app).max(2) - 1);
    let plan = plan(app.size, app.panes);
    if app.panes.focus == Pane::Teeth || plan.chart.is_empty() && !plan.teeth.is_empty() {
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
    let window = app.chart.window(&app.scale);
    let (least, shown) = if axis.is_empty() {
        (end, before)
    } else {
        (end.min(-axis.to.to_radians()), window.length().to_radians())
    };
    Some(Reach {
        start,
        run_from: start,
        run_to: end,
        most: before,
        least,
        column: shown / columns,
    })
}

/// The active method's results.
#[must_use]
pub fn solution(app: &App) -> Option<&Solution> {
    app.answer
        .as_ref()
        .and_then(|answer| answer.of(answer.active))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the ends of the way are met exactly")]
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
    fn the_first_key_brings_the_cursor_to_d() {
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
        let after = Reach {
            least: -0.3,
            ..REACH
        };
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
        assert_eq!(
            Reach {
                start: 0.0,
                run_from: 0.0,
                ..REACH
            }
            .played(0.0),
            None
        );
    }
}
