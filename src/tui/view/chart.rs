//! The charts: what the stations tell over the driver's roll angle, the chosen one and as many
//! others as have room.

pub mod axes;
pub mod curves;
pub mod legend;
pub mod raster;
pub mod readout;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;

use super::{text, titled};
use crate::model::inputs::Method;
use crate::model::{Outcome, Solution};
use crate::report::absence::without_contact;
use crate::report::graphs::{GRAPHS, Graph};
use crate::tui::app::App;
use crate::tui::ascii::symbol;
use crate::tui::layout::plan;
use crate::tui::pane::Pane;
use crate::tui::scale::{Anew, Occasion, Scale, Span};
use crate::tui::window::Frame;

use axes::{Axes, Ruler};
use curves::{Curve, Whose, curves, way, way_by};

pub use curves::{first_contact, last_contact};
pub use readout::readout;

/// Rows that another chart below the chosen one asks for, and the most charts.
const ROWS: u16 = 16;
const MOST: u16 = 3;
/// A title above so many columns has room for all of its words.
const WIDE: u16 = 80;
/// Columns of the plot on a terminal of 80.
const USUAL_COLUMNS: u16 = 71;
/// After E the strike goes on for this part of the way from D to E.
const AFTER_E: f64 = 0.5;

/// What the axes are to fit now.
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
            app.chart.frame == Frame::Strike,
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
    let titles: Vec<String> = panels
        .iter()
        .map(|(graph, axes)| title(app, &GRAPHS[*graph], axes))
        .collect();
    let stale = if app.shows_last_valid() {
        "LAST VALID, "
    } else {
        ""
    };
    let first = format!(
        "{stale}{}",
        titles
            .first()
            .filter(|_| app.answer.is_some())
            .map_or("Chart", String::as_str)
    );
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

/// How many columns stand for the roll angles in sight: those of the chart, else those of a usual
/// one.
#[must_use]
pub fn columns(app: &App) -> u16 {
    let columns = panels(app, plan(app.size, app.panes).chart)
        .first()
        .map_or(0, |(_, axes)| axes.plot.width);
    if columns > 1 { columns } else { USUAL_COLUMNS }
}

/// The driver's roll angle before E on a cell of a plot, in rad.
#[must_use]
pub fn angle_at(app: &App, area: Rect, at: Position) -> Option<f64> {
    let panels = panels(app, area);
    let (_, axes) = panels.iter().find(|(_, axes)| axes.plot.contains(at))?;
    Some(0.0 - axes.angle(at.x).to_radians()).filter(|angle| angle.is_finite())
}

/// The axes on which every curve in sight has its place, the present ones where they serve.
#[must_use]
pub fn fitted(app: &App, anew: Anew) -> Scale {
    let mut scale = app.scale;
    let area = plan(app.size, app.panes).chart;
    let Some(answer) = app.answer.as_ref().filter(|_| !area.is_empty()) else {
        return scale;
    };
    // While a method is to come, its axis waits for it.
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
    if first > 0.0 {
        let strike = Span::new(-first, AFTER_E * first);
        scale.strike = if anew.all {
            scale.strike.anew(strike)
        } else {
            scale.strike.fitted(strike)
        };
    }
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

/// The charts in sight: the chosen one, and below it the next ones that the active method has.
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

/// The charts in sight, from top to bottom, each with its axes below its title.
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
    let lacks = lack(app, graph, &curves);
    if axes.plot.is_empty() || curves.is_empty() || window.is_empty() {
        let y = if axes.plot.is_empty() {
            area.y + 1
        } else {
            axes.plot.y + axes.plot.height / 2
        };
        let said = lacks.unwrap_or_else(|| "There is no room for a chart.".to_owned());
        if y < area.bottom() {
            buffer.set_stringn(
                area.x + 2,
                y,
                text::cut(&said, usize::from(area.width.saturating_sub(3))),
                area.width.into(),
                Style::new(),
            );
        }
        return;
    }
    axes.draw(buffer);
    for curve in &curves {
        raster::draw(app, curve, (axes.across, axes.upright), axes.plot, buffer);
    }
    axes.draw_marks(app, buffer);
    legend::draw(app, &curves, lacks, axes.plot, buffer);
    axes.draw_zero(app, buffer);
    axes.draw_cursor(app, buffer);
}

// In words, with the symbol and the units.
fn title(app: &App, graph: &Graph, axes: &Axes) -> String {
    let method = app.answer.as_ref().map(|answer| answer.active);
    let column = method
        .and_then(|method| graph.column(method))
        .or_else(|| graph.all_columns().next());
    let name = column.map_or_else(String::new, |column| {
        let shown = app.settings.units.unit(column.shown);
        format!(
            " {}{}",
            symbol(column.symbol, app.look.ascii),
            unit(shown, axes.beside.power)
        )
    });
    let ruler = axes.ruler;
    // Where E stands is marked on the axis as well.
    let side = if axes.plot.width < WIDE {
        String::new()
    } else {
        format!(" {}", ruler.side)
    };
    format!(
        "{}{name} over {}{side}{}",
        graph.label,
        ruler.label,
        unit(ruler.unit, axes.below.power)
    )
}

fn unit(unit: &str, power: i32) -> String {
    match (unit, power) {
        ("1" | "", 0) => String::new(),
        ("1" | "", power) => format!(" in 1e{power}"),
        (unit, 0) => format!(" in {unit}"),
        (unit, power) => format!(" in 1e{power} {unit}"),
    }
}

// Why the active method has no curve, where it has none.
fn lack(app: &App, graph: &Graph, curves: &[Curve]) -> Option<String> {
    let Some(answer) = &app.answer else {
        return Some("No results yet.".to_owned());
    };
    if curves
        .iter()
        .any(|curve| matches!(curve.whose, Whose::Active(_)))
    {
        return None;
    }
    if app.is_stale() {
        return Some("Nothing is drawn anew while a field is wrong.".to_owned());
    }
    let label = graph.label.to_lowercase();
    let active = answer.active;
    if graph.column(active).is_none() {
        let methods: Vec<_> = graph.methods().map(Method::name).collect();
        return Some(format!(
            "The method {} has no {label}: {} do.",
            active.name(),
            methods.join(" and ")
        ));
    }
    Some(answer.of(active).map_or_else(
        || "No valid results of this method.".to_owned(),
        |solution| nothing(solution, &label),
    ))
}

fn nothing(solution: &Solution, label: &str) -> String {
    match solution.outcome {
        Outcome::NoCornerContact => format!(
            "No corner contact: {}, without an impact.",
            without_contact(solution)
        ),
        Outcome::CornerContact => format!("No {label} between D and E: the notes say why."),
    }
}
