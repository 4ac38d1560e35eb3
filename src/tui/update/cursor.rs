//! The cursor in the driver's roll angle that chart and teeth share: where it may go, and how it runs by itself.

use super::Effect;
use crate::model::Solution;
use crate::tui::app::App;
use crate::tui::pane::Pane;
use crate::tui::view::chart::{self, first_contact, last_contact};

/// Pictures of a run: four seconds at twelve a second.
const PICTURES: f64 = 48.0;
/// In the teeth a run begins before D, where the tip is still to come: at this many times the angle from D to E.
const APPROACH: f64 = 1.6;

/// Where the cursor may stand, in rad before E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reach {
    /// The first contact D, or E where no tooth strikes.
    pub(super) start: f64,
    /// Where a run begins.
    pub(super) run_from: f64,
    /// Where it ends: at E, or at the last contact where the rung goes on to it.
    pub(super) run_to: f64,
    /// The leftmost angle.
    pub(super) most: f64,
    /// The rightmost angle, negative after E.
    pub(super) least: f64,
    /// What a column stands for.
    pub(super) column: f64,
}

impl Reach {
    /// The angle so many columns towards E from this one, or from D where there is none yet.
    pub(super) fn moved(self, cursor: Option<f64>, columns: i16) -> f64 {
        let Some(cursor) = cursor else { return self.held(self.start) };
        self.held(cursor - f64::from(columns) * self.column)
    }

    /// The next picture of the run, none when its end is reached.
    pub(super) fn played(self, cursor: f64) -> Option<f64> {
        let next = cursor - (self.run_from - self.run_to) / PICTURES;
        (next > self.run_to && next < cursor).then_some(next)
    }

    fn held(self, angle: f64) -> f64 {
        let angle = angle.clamp(self.least, self.most);
        // E itself can be reached by whole columns, whatever they add up to.
        if angle.abs() < 1e-9 * self.column { 0.0 } else { angle }
    }
}

/// Move by columns towards E.
pub(super) fn step(app: &mut App, columns: i16) -> Vec<Effect> {
    match reach(app) {
        Some(reach) => app.cursor = Some(reach.moved(app.cursor, columns)),
        None => app.complain("no valid results to point at"),
    }
    stop(app)
}

/// To the first contact.
pub(super) fn to_start(app: &mut App) -> Vec<Effect> {
    match solution(app).and_then(first_contact) {
        Some(angle) => app.cursor = Some(angle),
        None => app.complain("no corner contact: there is no D"),
    }
    stop(app)
}

/// To E.
pub(super) fn to_end(app: &mut App) -> Vec<Effect> {
    app.cursor = Some(0.0);
    stop(app)
}

/// Start or stop the run; from its end it starts again.
pub(super) fn play(app: &mut App) -> Vec<Effect> {
    if app.is_playing {
        return stop(app);
    }
    let Some(reach) = reach(app).filter(|reach| reach.run_from > reach.run_to) else {
        app.complain("no corner contact: nothing to play");
        return Vec::new();
    };
    if app.cursor.is_none_or(|cursor| cursor <= reach.run_to || cursor > reach.run_from) {
        app.cursor = Some(reach.run_from);
    }
    app.is_playing = true;
    vec![Effect::Play(true)]
}

/// The next picture.
pub(super) fn tick(app: &mut App) -> Vec<Effect> {
    if !app.is_playing {
        return vec![Effect::Play(false)];
    }
    let reach = reach(app);
    let next = reach.zip(app.cursor).and_then(|(reach, cursor)| reach.played(cursor));
    app.cursor = Some(next.unwrap_or(reach.map_or(0.0, |reach| reach.run_to)));
    if next.is_none() { stop(app) } else { Vec::new() }
}

/// Stop what plays.
pub(super) fn stop(app: &mut App) -> Vec<Effect> {
    if std::mem::take(&mut app.is_playing) { vec![Effect::Play(false)] } else { Vec::new() }
}

// The chart ends where its axis does; the teeth go on until the next pair is where this one was, and come from further.
fn reach(app: &App) -> Option<Reach> {
    let solution = solution(app)?;
    let pitch = solution.geometry.base_pitch / solution.geometry.driver.base;
    let start = first_contact(solution).unwrap_or(0.0);
    let end = last_contact(solution).unwrap_or(0.0).min(0.0);
    let axis = app.scale.across;
    let before = if axis.is_empty() { start.max(pitch / 10.0) } else { start.max(-axis.from.to_radians()) };
    let columns = f64::from(chart::columns(app).max(2) - 1);
    if app.panes.focus == Pane::Teeth {
        let (most, least) = (before.max(2.0 * start), end.min(-pitch));
        return Some(Reach { start, run_from: APPROACH * start, run_to: 0.0, most, least, column: before / columns });
    }
    let window = app.chart.window(&app.scale);
    let (least, shown) =
        if axis.is_empty() { (end, before) } else { (end.min(-axis.to.to_radians()), window.length().to_radians()) };
    Some(Reach { start, run_from: start, run_to: end, most: before, least, column: shown / columns })
}

fn solution(app: &App) -> Option<&Solution> {
    app.answer.as_ref().and_then(|answer| answer.of(answer.active))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the ends of the way are met exactly")]
mod tests {
    use super::*;

    const REACH: Reach = Reach { start: 0.024, run_from: 0.024, run_to: 0.0, most: 0.03, least: 0.0, column: 0.0003 };

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
