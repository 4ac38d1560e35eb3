//! The charts of the station values over the driver's roll angle: the chosen chart, and others
//! below it where they have room.

pub mod axes;
pub mod curves;
pub mod legend;
pub mod raster;
pub mod readout;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::widgets::{Clear, Widget};
use unicode_width::UnicodeWidthStr;

use super::{text, title_room, titled};
use crate::model::inputs::Method;
use crate::model::{Outcome, Solution};
use crate::report::absence::without_contact;
use crate::report::graphs::{GRAPHS, Graph};
use crate::tui::app::App;
use crate::tui::ascii::symbol;
use crate::tui::layout::plan;
use crate::tui::pane::Pane;
use crate::tui::scale::{Scale, Span};
use crate::tui::window::{Anew, Occasion};

use axes::{Axes, Ruler};
use curves::{Curve, Whose, curves, way, way_by};
use legend::Legend;

pub use curves::{first_contact, last_contact};
pub use readout::readout;

/// The least rows of each chart, and the greatest number of charts.
const ROWS: u16 = 16;
const MOST: u16 = 3;
/// Columns of the plot on a terminal of 80 columns.
const USUAL_COLUMNS: u16 = 71;
/// The part of the approach that the strike shows after E.
const AFTER_E: f64 = 0.5;

/// The state that the axes depend on.
#[must_use]
pub fn occasion(app: &App) -> Occasion {
    Occasion {
        answered: app
            .answer
            .as_ref()
            .map(|answer| (answer.serial, answer.pending.is_some())),
        pinned: app.baseline.as_ref().map(|baseline| baseline.answer.serial),
        shown: (
            app.graph,
            count(plan(app.size, app.panes).chart),
            app.settings.units,
        ),
        sight: (
            app.chart.frame,
            app.chart.zoom,
            app.chart.middle.map(f64::to_bits),
        ),
        ground: (
            app.answer.as_ref().map(|answer| answer.active),
            app.tab.undone,
        ),
    }
}

/// Draw the charts with their axes.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let panels = panels(app, area);
    let window = app.chart.window(&app.scale);
    let stale = if app.is_stale() { "LAST VALID, " } else { "" };
    let titles: Vec<String> = panels
        .iter()
        .enumerate()
        .map(|(at, (graph, axes))| {
            let room = match at {
                0 => title_room(app, Pane::Chart, area.width).saturating_sub(stale.len()),
                _ => usize::from(area.width.saturating_sub(4)),
            };
            title(app, &GRAPHS[*graph], axes, room)
        })
        .collect();
    let first = format!("{stale}{}", titles.first().map_or("Chart", String::as_str));
    titled(app, Pane::Chart, &first, area, buffer);
    for (at, (graph, axes)) in panels.iter().enumerate() {
        if at > 0 {
            let above = Rect {
                x: area.x,
                y: axes.plot.y.saturating_sub(1),
                width: area.width,
                height: 1,
            };
            text::titled(&titles[at], above, app.look.theme, buffer);
        }
        draw_panel(app, &GRAPHS[*graph], axes, window, area, buffer);
    }
}

/// The columns of the visible chart, or of a usual chart if none is visible.
#[must_use]
pub fn columns(app: &App) -> u16 {
    let columns = panels(app, plan(app.size, app.panes).chart)
        .first()
        .map_or(0, |(_, axes)| axes.plot.width);
    if columns > 1 { columns } else { USUAL_COLUMNS }
}

/// The driver's roll angle before E at a cell of a plot, in rad.
#[must_use]
pub fn angle_at(app: &App, area: Rect, at: Position) -> Option<f64> {
    let panels = panels(app, area);
    let (_, axes) = panels.iter().find(|(_, axes)| axes.plot.contains(at))?;
    Some(0.0 - axes.angle(at.x).to_radians()).filter(|angle| angle.is_finite())
}

/// Axes that contain every visible curve. Keeps the present axes while they serve.
#[must_use]
pub fn fitted(app: &App, anew: Anew) -> Scale {
    let mut scale = app.scale;
    let area = plan(app.size, app.panes).chart;
    let Some(answer) = app.answer.as_ref().filter(|_| !area.is_empty()) else {
        return scale;
    };
    // The axis never shrinks while a method is still being solved.
    let pinned = app
        .baseline
        .as_ref()
        .map(|baseline| (&baseline.answer, baseline.answer.beside(answer.active)));
    let way = pinned
        .map_or(Span::NONE, |(base, method)| way_by(base, method))
        .and(way(answer));
    scale.across = match (answer.pending, anew.all) {
        (Some(_), _) => scale.across.grown(way),
        (None, true) => scale.across.anew(way),
        (None, false) => scale.across.fitted(way),
    };
    let touches = [Some((answer, answer.active)), pinned];
    let touches = touches
        .into_iter()
        .flatten()
        .filter_map(|(answer, method)| first_contact(answer.of(method)?));
    let first = touches.fold(0.0, f64::max).to_degrees();
    let strike = Span::new(-first, AFTER_E * first);
    scale.strike = match (strike.is_empty(), anew.all) {
        (true, _) => Span::default(),
        (false, true) => scale.strike.anew(strike),
        (false, false) => scale.strike.fitted(strike),
    };
    let window = app.chart.window(&scale);
    for graph in shown(app, area) {
        let curves = curves(app, &GRAPHS[graph]);
        let values = curves
            .iter()
            .map(|curve| curve.upright_within(window))
            .fold(Span::NONE, Span::and);
        let now = scale.upright[graph];
        scale.upright[graph] = if anew.upright || anew.all {
            now.anew(values)
        } else {
            now.fitted(values)
        };
    }
    scale
}

/// The visible charts: the chosen chart, and below it the next charts of the active method.
#[must_use]
pub fn shown(app: &App, area: Rect) -> Vec<usize> {
    let chosen = app.graph;
    let method = app.answer.as_ref().map(|answer| answer.active);
    let others = (1..GRAPHS.len()).map(|by| (chosen + by) % GRAPHS.len());
    let has_curve =
        |graph: &usize| method.is_some_and(|method| GRAPHS[*graph].column(method).is_some());
    std::iter::once(chosen)
        .chain(others.filter(has_curve))
        .take(count(area))
        .collect()
}

fn count(area: Rect) -> usize {
    if area.is_empty() {
        0
    } else {
        usize::from((area.height / ROWS).clamp(1, MOST))
    }
}

/// The visible charts from top to bottom, each with its axes below its title.
fn panels(app: &App, area: Rect) -> Vec<(usize, Axes)> {
    let shown = shown(app, area);
    let Some(answer) = &app.answer else {
        return shown
            .into_iter()
            .map(|graph| (graph, Axes::default()))
            .collect();
    };
    let height = area.height / u16::try_from(shown.len().max(1)).unwrap_or(1);
    let window = app.chart.window(&app.scale);
    let ruler = Ruler::of(app.by_time, answer.inputs.speed, window);
    let uprights = shown.iter().map(|graph| app.scale.upright[*graph]);
    let margin = axes::margin(uprights, height.saturating_sub(3));
    let below = |at: usize| {
        let y = area.y + height * at as u16;
        let height = if at + 1 == shown.len() {
            area.bottom() - y
        } else {
            height
        };
        Rect {
            y: y + 1,
            height: height.saturating_sub(1),
            ..area
        }
    };
    let axes = |(at, graph): (usize, &usize)| {
        (
            *graph,
            Axes::new(
                below(at),
                margin,
                (window, app.scale.upright[*graph]),
                ruler,
            ),
        )
    };
    shown.iter().enumerate().map(axes).collect()
}

fn draw_panel(
    app: &App,
    graph: &Graph,
    axes: &Axes,
    window: Span,
    area: Rect,
    buffer: &mut Buffer,
) {
    let curves = curves::apart(curves(app, graph));
    let missing = missing(app, graph, &curves);
    if axes.plot.is_empty() || curves.is_empty() || window.is_empty() {
        let y = if axes.plot.is_empty() {
            area.y + 1
        } else {
            axes.plot.y + axes.plot.height / 2
        };
        let message = missing.unwrap_or_else(|| "The pane is too small for a chart.".to_owned());
        if y < area.bottom() {
            buffer.set_stringn(
                area.x + 2,
                y,
                text::cut(&message, usize::from(area.width.saturating_sub(3))),
                area.width.into(),
                Style::new(),
            );
        }
        return;
    }
    let legend = Legend::of(app, &curves, missing.as_deref());
    draw_curves(app, axes, &curves, buffer);
    let inside = legend.inside(axes.plot, buffer);
    let (axes, placed) = if let Some(placed) = inside {
        (axes.clone(), placed)
    } else {
        let (above, lower) = axes.split(legend.height(axes.plot.width));
        Clear.render(axes.area, buffer);
        draw_curves(app, &lower, &curves, buffer);
        (lower, legend.above(above))
    };
    for block in &placed {
        block.draw(buffer);
    }
    let is_legend = |at| placed.iter().any(|block| block.area.contains(at));
    axes.draw_cursor(app, is_legend, buffer);
    axes.draw_time_direction(buffer);
}

// Everything below the legend.
fn draw_curves(app: &App, axes: &Axes, curves: &[Curve], buffer: &mut Buffer) {
    axes.draw(buffer);
    for curve in curves {
        raster::draw(app, curve, (axes.across, axes.upright), axes.plot, buffer);
    }
    axes.draw_zero(app, buffer);
    axes.draw_marks(app, buffer);
}

/// The longest title with a unit for both axes that has room, else the shortest.
fn title(app: &App, graph: &Graph, axes: &Axes, room: usize) -> String {
    let answer = app.answer.as_ref();
    let own = answer.and_then(|answer| graph.column(answer.active));
    let is_free_impact = own.is_none()
        && answer.is_some_and(|answer| answer.active.shares_load())
        && !curves(app, graph).is_empty();
    let column = own.or_else(|| graph.all_columns().next());
    let value = column.map_or_else(String::new, |column| {
        let shown = app.settings.units.unit(column.shown);
        format!(
            "{}{}",
            symbol(column.symbol, app.look.ascii),
            unit(shown, axes.beside.power)
        )
    });
    let names: Vec<String> = if is_free_impact {
        let label = graph.label.to_lowercase();
        vec![
            format!("Free impact, closed form: {label}"),
            format!("Free impact: {label}"),
        ]
    } else {
        vec![graph.label.to_owned()]
    };
    let ruler = axes.ruler;
    let below = unit(ruler.unit, axes.below.power);
    let titles = ruler.labels.iter().flat_map(|label| {
        names
            .iter()
            .map(|name| format!("{name} {value} over {label}{below}"))
            .collect::<Vec<_>>()
    });
    let titles: Vec<String> = titles.collect();
    let fitting = titles.iter().find(|title| title.width() <= room);
    fitting.or(titles.last()).cloned().unwrap_or_default()
}

fn unit(unit: &str, power: i32) -> String {
    match (unit, power) {
        ("1" | "", 0) => String::new(),
        ("1" | "", power) => format!(" in 1e{power}"),
        (unit, 0) => format!(" in {unit}"),
        (unit, power) => format!(" in 1e{power} {unit}"),
    }
}

// The reason why the active method has no curve.
fn missing(app: &App, graph: &Graph, curves: &[Curve]) -> Option<String> {
    let Some(answer) = &app.answer else {
        return Some("This method has no valid results.".to_owned());
    };
    if curves
        .iter()
        .any(|curve| matches!(curve.whose, Whose::Active(_)))
    {
        return None;
    }
    if app.is_stale() {
        return Some("The charts are not redrawn while a field is invalid.".to_owned());
    }
    let label = graph.label.to_lowercase();
    let active = answer.active;
    if graph.column(active).is_none() {
        let methods: Vec<_> = graph.methods().map(Method::name).collect();
        return Some(format!(
            "Method {} does not compute the {label}; {} do.",
            active.name(),
            methods.join(" and ")
        ));
    }
    Some(answer.of(active).map_or_else(
        || "This method has no valid results.".to_owned(),
        |solution| nothing(solution, &label),
    ))
}

fn nothing(solution: &Solution, label: &str) -> String {
    match solution.outcome {
        Outcome::NoCornerContact => format!(
            "No corner contact: {}; no impact.",
            without_contact(solution)
        ),
        Outcome::CornerContact => format!("No {label} between D and E; press n for the reason."),
    }
}
