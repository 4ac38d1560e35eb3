//! The impact force over the driver's roll angle, from D to E.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::symbols::Marker;
use ratatui::widgets::{Axis, Chart, Dataset, GraphType, Widget};

use super::{plan, titled};
use crate::model::inputs::Rung;
use crate::model::{Outcome, Quantity, Refusal, Solution, Station};
use crate::report;
use crate::tui::app::App;
use crate::tui::pane::Pane;
use crate::tui::scale::{Scale, bounds, curve};
use crate::tui::solver::Answer;

const LABEL: u16 = 7;
/// Columns of the plot on a terminal of 80.
const USUAL_COLUMNS: u16 = 71;

/// A rung's points: minus the angle before E in deg, and the force in N.
type Curve = (Rung, Vec<(f64, f64)>);

/// Draw the chart with its axes.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let inner = titled(app, Pane::Chart, &title(app), area, buffer);
    if inner.height < 4 || inner.width < 30 {
        return;
    }
    let curves = curves(app);
    if curves.iter().all(|(_, points)| points.is_empty()) {
        let (x, y) = (inner.x + 2, inner.y + inner.height / 2);
        buffer.set_stringn(x, y, nothing(app), usize::from(inner.width - 2), Style::new());
        return;
    }
    let plot = plot(area);
    draw_axes(app.scale, plot, buffer);
    draw_curves(app, &curves, plot, buffer);
    draw_marks(app, &curves, plot, buffer);
    draw_cursor(app, plot, buffer);
}

/// How many columns stand for the axis: those in sight, else those of a usual chart.
#[must_use]
pub fn columns(app: &App) -> u16 {
    let plot = plot(plan(app.size, app.panes).chart);
    if plot.width > 1 { plot.width } else { USUAL_COLUMNS }
}

/// The driver's roll angle before E on a cell of the plot, in rad.
#[must_use]
pub fn angle_at(app: &App, area: Rect, at: Position) -> Option<f64> {
    let plot = plot(area);
    let last = plot.width.checked_sub(1).filter(|&last| last > 0)?;
    let column = at.x.checked_sub(plot.x).filter(|_| plot.contains(at))?;
    Some(app.scale.angle.to_radians() * (1.0 - f64::from(column) / f64::from(last)))
}

/// The force of the active rung at an angle before E, in N, between the stations on either side.
#[must_use]
pub fn force_at(answer: &Answer, angle: f64) -> Option<f64> {
    let stations = &answer.of(answer.active)?.stations;
    let between = |pair: &[Station]| (pair[1].roll_angle_driver..=pair[0].roll_angle_driver).contains(&angle);
    let pair = stations.windows(2).find(|pair| between(pair))?;
    let (before, after) = (pair[0], pair[1]);
    let part = (before.roll_angle_driver - angle) / (before.roll_angle_driver - after.roll_angle_driver);
    let force = before.impact_force + part * (after.impact_force - before.impact_force);
    force.is_finite().then_some(force)
}

// The room of the curves within the area of the pane.
fn plot(area: Rect) -> Rect {
    if area.height < 5 || area.width < 30 {
        return Rect::ZERO;
    }
    Rect { x: area.x + LABEL + 1, y: area.y + 1, width: area.width - LABEL - 2, height: area.height - 3 }
}

// A broken line where the curves leave room for it, and a mark on the axis.
fn draw_cursor(app: &App, plot: Rect, buffer: &mut Buffer) {
    let Some(cursor) = app.cursor else { return };
    let part = 1.0 - cursor.to_degrees() / app.scale.angle;
    if !(0.0..=1.0).contains(&part) {
        return;
    }
    let x = plot.x + (f64::from(plot.width - 1) * part).round() as u16;
    for y in plot.top()..plot.bottom() {
        if buffer.cell((x, y)).is_some_and(|cell| cell.symbol() == " ") {
            buffer.set_string(x, y, "┊", app.look.theme.faint);
        }
    }
    buffer.set_string(x, plot.bottom(), "▴", app.look.theme.focus);
}

fn title(app: &App) -> String {
    let stale = if app.is_stale() { "LAST VALID, " } else { "" };
    let marks: Vec<String> = app.answer.iter().flat_map(forces).collect();
    let marks = if marks.is_empty() { String::new() } else { format!("; {}", marks.join(", ")) };
    format!("{stale}F_S in N over driver angle before E in deg{marks}")
}

// The force at D of each rung, the active one first, with the letter that marks D on the axis.
fn forces(answer: &Answer) -> Vec<String> {
    let Some(quantity) = Quantity::find("impact_force") else { return Vec::new() };
    let mut rungs: Vec<_> = answer.rungs.iter().collect();
    rungs.sort_by_key(|(rung, _)| *rung != answer.active);
    let force = |(rung, result): &(Rung, _)| {
        let result: &Result<Solution, Refusal> = result;
        let value = (quantity.value)(result.as_ref().ok()?)?;
        Some(format!("{} {} {}", mark(answer, *rung), rung.name(), report::shown(quantity, value).number))
    };
    rungs.into_iter().filter_map(force).collect()
}

// D marks the active rung's first contact on the axis, its first letter that of another.
fn mark(answer: &Answer, rung: Rung) -> &'static str {
    if rung == answer.active { "D" } else { rung.name().get(..1).unwrap_or("d") }
}

fn nothing(app: &App) -> &'static str {
    let outcome = app.answer.as_ref().and_then(|answer| answer.of(answer.active)).map(|solution| solution.outcome);
    match outcome {
        Some(Outcome::NoCornerContact) => "No corner contact: the tooth comes in on time, without an impact.",
        Some(Outcome::CornerContact) | None => "No force between D and E: the notes say why.",
    }
}

// The active rung's curve last, so that it lies on top.
fn curves(app: &App) -> Vec<Curve> {
    let Some(answer) = &app.answer else { return Vec::new() };
    let mut curves: Vec<_> = answer
        .rungs
        .iter()
        .filter_map(|(rung, result)| Some((*rung, curve(&result.as_ref().ok()?.stations).collect())))
        .collect();
    curves.sort_by_key(|(rung, _)| *rung == answer.active);
    curves
}

// The pinned curve of its active rung, as far as it is on the axis.
fn baseline_curve(app: &App) -> Vec<(f64, f64)> {
    let solution = app.baseline.as_ref().and_then(|baseline| baseline.answer.of(baseline.answer.active));
    solution.map(|solution| curve(&solution.stations).collect()).unwrap_or_default()
}

fn draw_axes(scale: Scale, plot: Rect, buffer: &mut Buffer) {
    let axis = plot.bottom();
    let ticks = if plot.width >= 60 { 4 } else { 2 };
    buffer.set_string(plot.x - 1, axis, "└", Style::new());
    buffer.set_string(plot.x, axis, "─".repeat(plot.width.into()), Style::new());
    for y in plot.top()..axis {
        buffer.set_string(plot.x - 1, y, "│", Style::new());
    }
    for tick in 0..=ticks {
        let part = f64::from(tick) / f64::from(ticks);
        let x = plot.x + (f64::from(plot.width - 1) * part).round() as u16;
        let angle = scale.angle * (1.0 - part);
        let label = if tick == ticks { "E".to_owned() } else { number(angle) };
        let width = label.len() as u16;
        if tick > 0 {
            buffer.set_string(x, axis, "┴", Style::new());
        }
        buffer.set_string(x.saturating_sub(width / 2).max(plot.x), axis + 1, label, Style::new());
    }
    let steps = if plot.height > 8 { 4 } else { 2 };
    for step in 0..=steps {
        let part = f64::from(step) / f64::from(steps);
        let y = axis - 1 - (f64::from(plot.height - 1) * part).round() as u16;
        let label = format!("{:>1$}", number(scale.force * part), usize::from(LABEL) - 1);
        buffer.set_string(plot.x - LABEL - 1, y, label, Style::new());
        buffer.set_string(plot.x - 1, y, "┤", Style::new());
    }
}

fn draw_curves(app: &App, curves: &[Curve], plot: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let last = curves.len().saturating_sub(1);
    let pinned = baseline_curve(app);
    let behind = Dataset::default().data(&pinned).graph_type(GraphType::Line).style(theme.baseline).marker(Marker::Dot);
    let sets = curves.iter().enumerate().map(|(index, (_, points))| {
        let (style, marker) = if index == last { (theme.active, own_marker(app)) } else { (theme.other, Marker::Dot) };
        Dataset::default().data(points).graph_type(GraphType::Line).style(faded(app, style)).marker(marker)
    });
    Chart::new(std::iter::once(behind).chain(sets).collect())
        .x_axis(Axis::default().bounds(bounds(-app.scale.angle, 0.0)))
        .y_axis(Axis::default().bounds(bounds(0.0, app.scale.force)))
        .legend_position(None)
        .render(plot, buffer);
}

fn draw_marks(app: &App, curves: &[Curve], plot: Rect, buffer: &mut Buffer) {
    let Some(answer) = &app.answer else { return };
    for (rung, points) in curves {
        let Some((x, _)) = points.first() else { continue };
        let part = (1.0 + x / app.scale.angle).clamp(0.0, 1.0);
        let style = if *rung == answer.active { app.look.theme.active } else { app.look.theme.other };
        let column = plot.x + (f64::from(plot.width - 1) * part).round() as u16;
        buffer.set_string(column, plot.bottom(), mark(answer, *rung), style);
    }
}

fn own_marker(app: &App) -> Marker {
    if app.look.ascii { Marker::Custom('*') } else { app.settings.marker }
}

fn faded(app: &App, style: Style) -> Style {
    if app.is_stale() { style.patch(app.look.theme.faint) } else { style }
}

// Six characters at most.
fn number(value: f64) -> String {
    let plain = value == 0.0 || (1e-3..1e6).contains(&value.abs());
    if !plain {
        return format!("{value:.0e}");
    }
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.chars().take(6).collect()
}
