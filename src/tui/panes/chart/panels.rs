//! The visible charts on the screen: positions, titles, drawing, and the legend on cells without
//! curves.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Clear, Widget};
use unicode_width::UnicodeWidthStr;

use super::axes::{self, Axes, Ruler};
use super::curves::{self, Curve, CurveSource, base_name, curves};
use super::{Charts, worker_chart};
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::{Outcome, Solution};
use crate::report::absence::without_contact;
use crate::report::graphs::{GRAPHS, Graph};
use crate::tui::ascii::symbol;
use crate::tui::text;

/// Columns of the plot on a terminal of 80 columns.
const USUAL_COLUMNS: u16 = 71;

/// The blocks of text of a legend.
#[derive(Debug, Clone, Default)]
pub(crate) struct Legend {
    blocks: Vec<Block>,
}

/// A block with its position.
#[derive(Debug, Clone)]
pub(crate) struct Placed {
    /// The cells of the block.
    pub(crate) area: Rect,
    rows: Vec<Line<'static>>,
}

impl Legend {
    /// The message, if any, and the name of each curve, the active method first.
    #[must_use]
    pub(crate) fn of(charts: &Charts, curves: &[Curve], message: Option<&str>) -> Legend {
        let words = |text: &str| text.split(' ').map(|word| Line::raw(word.to_owned())).collect();
        let message = message.map(|text| Block { pieces: words(text), gap: 1 });
        let names = Block {
            pieces: curves.iter().rev().map(|curve| name(charts, curve)).collect(),
            gap: 2,
        };
        Legend { blocks: message.into_iter().chain([names]).collect() }
    }

    /// Places every block on blank cells of the plot. Returns `None` if a block does not fit.
    #[must_use]
    pub(crate) fn inside(&self, plot: Rect, buffer: &Buffer) -> Option<Vec<Placed>> {
        let mut placed: Vec<Placed> = Vec::new();
        for block in &self.blocks {
            let is_free = |area: Rect| {
                let is_blank = |at| buffer.cell(at).is_some_and(|cell| cell.symbol() == " ");
                placed.iter().all(|other| !other.area.intersects(area))
                    && area.positions().all(is_blank)
            };
            let found = block.free_place(plot, is_free)?;
            placed.push(found);
        }
        Some(placed)
    }

    /// Places the blocks below each other from the top of an area, as many rows as it has.
    #[must_use]
    pub(crate) fn above(&self, area: Rect) -> Vec<Placed> {
        let rows = self.blocks.iter().flat_map(|block| {
            let rows = block.rows(area.width).into_iter();
            rows.map(|row| block.line(row))
        });
        let row = |(row, y)| Placed { area: Rect { y, height: 1, ..area }, rows: vec![row] };
        rows.zip(area.top()..area.bottom()).map(row).collect()
    }

    /// The number of rows that the blocks need below each other.
    #[must_use]
    pub(crate) fn height(&self, width: u16) -> u16 {
        let rows = self.blocks.iter().map(|block| block.rows(width).len());
        u16::try_from(rows.sum::<usize>()).unwrap_or(u16::MAX)
    }
}

impl Placed {
    /// Draws the rows of the block.
    pub(crate) fn draw(&self, buffer: &mut Buffer) {
        for (line, row) in self.rows.iter().zip(self.area.rows()) {
            line.render(row, buffer);
        }
    }
}

/// The title of the first chart, at most `room` columns wide.
pub(crate) fn first_title(charts: &Charts, room: usize) -> String {
    if let Some(chart) = charts.pane.worker_chart {
        return worker_chart::title(charts, chart, room);
    }
    let panels = panels(charts);
    let Some((graph, axes)) = panels.first().filter(|_| charts.answer.is_some()) else {
        return "Chart".to_owned();
    };
    let stale = if charts.is_stale { "LAST VALID, " } else { "" };
    let room = room.saturating_sub(stale.len());
    format!("{stale}{}", title(charts, &GRAPHS[*graph], axes, room))
}

/// Draws the charts with their axes, below the title of the first chart.
pub(crate) fn draw(charts: &Charts, buffer: &mut Buffer) {
    let area = charts.area;
    if let Some(chart) = charts.pane.worker_chart {
        return worker_chart::draw(charts, chart, buffer);
    }
    for (at, (graph, axes)) in panels(charts).iter().enumerate() {
        let graph = &GRAPHS[*graph];
        if at > 0 {
            let above =
                Rect { x: area.x, y: axes.plot.y.saturating_sub(1), width: area.width, height: 1 };
            let room = usize::from(area.width.saturating_sub(4));
            let title = title(charts, graph, axes, room);
            text::titled(&title, above, charts.look.theme, buffer);
        }
        draw_panel(charts, graph, axes, buffer);
    }
}

/// The width of the visible chart in columns, or of a default chart if none is visible.
#[must_use]
pub(crate) fn columns(charts: &Charts) -> u16 {
    let columns = panels(charts).first().map_or(0, |(_, axes)| axes.plot.width);
    if columns > 1 { columns } else { USUAL_COLUMNS }
}

/// The driver's roll angle before E at a cell of a plot, in rad.
pub(crate) fn angle_at(charts: &Charts, at: Position) -> Option<f64> {
    if charts.pane.worker_chart.is_some() {
        return None;
    }
    let panels = panels(charts);
    let (_, axes) = panels.iter().find(|(_, axes)| axes.plot.contains(at))?;
    Some(0.0 - axes.angle(at.x).to_radians()).filter(|angle| angle.is_finite())
}

/// The visible charts from top to bottom, each with its axes below its title.
fn panels(charts: &Charts) -> Vec<(usize, Axes)> {
    let (shown, area) = (charts.shown(), charts.area);
    let Some(answer) = charts.answer else {
        return shown.into_iter().map(|graph| (graph, Axes::default())).collect();
    };
    let height = area.height / u16::try_from(shown.len().max(1)).unwrap_or(1);
    let window = charts.window();
    let ruler = Ruler::of(charts.pane.by_time, answer.inputs.speed, window);
    let uprights = shown.iter().map(|graph| charts.scale.upright[*graph]);
    let margin = axes::margin(uprights, height.saturating_sub(3));
    let below = |at: usize| {
        let y = area.y + height * at as u16;
        let height = if at + 1 == shown.len() { area.bottom() - y } else { height };
        Rect { y: y + 1, height: height.saturating_sub(1), ..area }
    };
    let axes = |(at, graph): (usize, &usize)| {
        (*graph, Axes::new(below(at), margin, (window, charts.scale.upright[*graph]), ruler))
    };
    shown.iter().enumerate().map(axes).collect()
}

fn draw_panel(charts: &Charts, graph: &Graph, axes: &Axes, buffer: &mut Buffer) {
    let area = charts.area;
    let curves = curves::apart(curves(charts, graph));
    let missing = missing(charts, graph, &curves);
    if axes.plot.is_empty() || curves.is_empty() || charts.window().is_empty() {
        let y = if axes.plot.is_empty() { area.y + 1 } else { axes.plot.y + axes.plot.height / 2 };
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
    let legend = Legend::of(charts, &curves, missing.as_deref());
    draw_curves(charts, axes, &curves, buffer);
    let inside = legend.inside(axes.plot, buffer);
    let (axes, placed) = if let Some(placed) = inside {
        (axes.clone(), placed)
    } else {
        let (above, lower) = axes.split(legend.height(axes.plot.width));
        Clear.render(axes.area, buffer);
        draw_curves(charts, &lower, &curves, buffer);
        (lower, legend.above(above))
    };
    for block in &placed {
        block.draw(buffer);
    }
    let is_legend = |at| placed.iter().any(|block| block.area.contains(at));
    axes.draw_cursor(charts, is_legend, buffer);
    axes.draw_time_direction(buffer);
}

// Draws everything below the legend.
fn draw_curves(charts: &Charts, axes: &Axes, curves: &[Curve], buffer: &mut Buffer) {
    axes.draw(buffer);
    let spans = (axes.across, axes.upright);
    curves::draw_curve(charts, curves, spans, axes.plot, buffer);
    axes.draw_zero(charts, buffer);
    axes.draw_marks(charts, buffer);
}

/// The longest title that fits: the name, the symbol with its unit, and the x axis with its unit.
/// If there is less room, the title shortens the x axis, then omits the x axis, then the name.
fn title(charts: &Charts, graph: &Graph, axes: &Axes, room: usize) -> String {
    let answer = charts.answer;
    let own = answer.and_then(|answer| graph.column(answer.active));
    let is_free_impact = own.is_none()
        && answer.is_some_and(|answer| answer.active.shares_load())
        && !curves(charts, graph).is_empty();
    let column = own.or_else(|| graph.all_columns().next());
    let value = column.map_or_else(String::new, |column| {
        let shown = charts.units.unit(column.shown);
        format!("{}{}", symbol(column.symbol, charts.look.ascii), unit(shown, axes.beside.power))
    });
    let (names, unnamed) = if is_free_impact {
        let label = graph.label.to_lowercase();
        let names = vec![
            format!("Free impact, closed form: {label} {value}"),
            format!("Free impact: {label} {value}"),
        ];
        (names, format!("Free impact: {value}"))
    } else {
        (vec![format!("{} {value}", graph.label)], value)
    };
    let ruler = axes.ruler;
    let below = unit(ruler.unit, axes.below.power);
    let mut titles = Vec::new();
    for names in [&names[..], std::slice::from_ref(&unnamed)] {
        for label in ruler.labels {
            titles.extend(names.iter().map(|name| format!("{name} over {label}{below}")));
        }
        titles.extend(names.last().map(|name| format!("{name}, x axis{below}")));
        titles.extend(names.last().cloned());
    }
    let fitting = titles.into_iter().find(|title| title.width() <= room);
    fitting.unwrap_or(unnamed)
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
fn missing(charts: &Charts, graph: &Graph, curves: &[Curve]) -> Option<String> {
    let Some(answer) = charts.answer else {
        return Some("No results yet.".to_owned());
    };
    let is_main =
        |curve: &Curve| matches!(curve.source, CurveSource::Active(_) | CurveSource::Model { .. });
    if curves.iter().any(is_main) {
        return None;
    }
    if charts.is_stale {
        return Some("The charts are not redrawn while a field is invalid.".to_owned());
    }
    let label = graph.label.to_lowercase();
    if graph.by_model.is_some() {
        return Some(match &answer.stiffness {
            Some(Err(refusal)) => format!("No {label}: {refusal}."),
            Some(Ok(_)) => format!("No {label}: no model covers the pair."),
            None => format!("Computing the {label}."),
        });
    }
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
        |solution| nothing(solution, &label, charts.notes_key),
    ))
}

fn nothing(solution: &Solution, label: &str, notes_key: fn() -> String) -> String {
    match solution.outcome {
        Outcome::NoCornerContact => {
            format!("No corner contact: {}; no impact.", without_contact(solution))
        }
        Outcome::CornerContact => {
            format!("No {label} between D and E; {} shows the reason.", notes_key())
        }
    }
}

/// A block of text: unbroken pieces with a number of blank cells between them.
#[derive(Debug, Clone)]
struct Block {
    pieces: Vec<Line<'static>>,
    gap: usize,
}

impl Block {
    /// The pieces in rows of at most `width` cells, with a blank cell at both ends.
    fn rows(&self, width: u16) -> Vec<Range<usize>> {
        let mut rows: Vec<Range<usize>> = Vec::new();
        for at in 0..self.pieces.len() {
            let has_room = |row: &&mut Range<usize>| self.width(&(row.start..at + 1)) <= width;
            match rows.last_mut().filter(has_room) {
                Some(row) => row.end = at + 1,
                None => rows.push(at..at + 1),
            }
        }
        rows
    }

    fn width(&self, row: &Range<usize>) -> u16 {
        let pieces: usize = self.pieces[row.clone()].iter().map(Line::width).sum();
        (pieces + self.gap * (row.len() - 1) + 2) as u16
    }

    fn line(&self, row: Range<usize>) -> Line<'static> {
        let mut line = Line::raw(" ");
        for (at, piece) in self.pieces[row].iter().enumerate() {
            if at > 0 {
                line.push_span(" ".repeat(self.gap));
            }
            line.extend(piece.spans.iter().cloned());
        }
        line.push_span(" ");
        line
    }

    /// The narrowest rows for each number of rows, the fewest rows first.
    fn layouts(&self, plot: Rect) -> Vec<(Size, Vec<Range<usize>>)> {
        let mut layouts: Vec<(Size, Vec<Range<usize>>)> = Vec::new();
        for width in (1..=plot.width).rev() {
            let rows = self.rows(width);
            let size = Size {
                width: rows.iter().map(|row| self.width(row)).max().unwrap_or(0),
                height: rows.len() as u16,
            };
            if size.width > width || size.height > plot.height {
                break;
            }
            let same = layouts.last_mut().filter(|(last, _)| last.height == size.height);
            match same {
                Some(last) => *last = (size, rows),
                None => layouts.push((size, rows)),
            }
        }
        layouts
    }

    /// The first free place: on the right, the left or in the middle of the outer rows, then of the
    /// other rows, then anywhere.
    fn free_place(&self, plot: Rect, is_free: impl Fn(Rect) -> bool) -> Option<Placed> {
        let layouts = self.layouts(plot);
        let room = |size: Size| (plot.width - size.width, plot.height - size.height);
        let tidy = layouts.iter().flat_map(|(size, rows)| {
            let (right, low) = room(*size);
            let outer = [0, 1.min(low), low, low.saturating_sub(1)];
            outer.into_iter().chain(0..=low).flat_map(move |down| {
                [right, 0, right / 2].map(|across| (*size, rows, (across, down)))
            })
        });
        let anywhere = layouts.iter().flat_map(|(size, rows)| {
            let (right, low) = room(*size);
            (0..=low).flat_map(move |down| {
                (0..=right).rev().map(move |across| (*size, rows, (across, down)))
            })
        });
        tidy.chain(anywhere)
            .map(|(size, rows, (across, down))| {
                let at = Position::new(plot.x + across, plot.y + down);
                (Rect::from((at, size)), rows)
            })
            .find(|(area, _)| is_free(*area))
            .map(|(area, rows)| Placed {
                area,
                rows: rows.iter().map(|row| self.line(row.clone())).collect(),
            })
    }
}

fn model_name(model: ToothCompliance, is_own: bool) -> String {
    let case = if is_own { " (case)" } else { "" };
    format!("{}{case}", model.name())
}

fn name(charts: &Charts, curve: &Curve) -> Line<'static> {
    let name = match curve.source {
        CurveSource::Active(method) | CurveSource::Other(method) => method.name().to_owned(),
        CurveSource::Pinned(method) => base_name(charts, method),
        CurveSource::Model { model, is_own } => model_name(model, is_own),
        CurveSource::Bound(name) => symbol(name, charts.look.ascii).into_owned(),
    };
    let sample = match curves::marker(charts, curve.source) {
        Marker::Custom(letter) => letter.to_string(),
        Marker::Dot => "•".to_owned(),
        Marker::HalfBlock => "▀".to_owned(),
        _ => "⠒".to_owned(),
    };
    Line::from(vec![
        Span::styled(sample, curves::style(charts, curve.source)),
        Span::raw(format!(" {name}")),
    ])
}
