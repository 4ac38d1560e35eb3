//! The chart pane: the selected chart of the station values, and further charts below it if there
//! is room.

pub(crate) mod curves;
pub(crate) mod range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::Title;
use super::plot::{LABEL_COLUMNS, Look as SeriesLook, Plot, TerminalChart, label_margin};
use crate::case::units::System;
pub use crate::model::contact_state::first_contact_of_driver as first_contact;
use crate::model::inputs::Method;
use crate::model::{Outcome, Solution};
use crate::report::absence::without_contact;
use crate::report::chart::{Axis, Chart, Kind, Span};
use crate::report::graphs::{GRAPHS, Graph};
use crate::tui::ascii::symbol;
use crate::tui::jobs::{ChartWork, WorkerChart};
use crate::tui::solver::Answer;
use crate::tui::text;
use crate::tui::theme::Look;

pub use curves::readout;
use curves::{Curve, CurveSource, curves};
pub(crate) use range::last_contact;
use range::{ChartView, Frame, Occasion, Scale, angle_range_of, path, way_of_all};

/// Least height of each chart, in rows; it decides the number of charts.
const ROWS: u16 = 16;
const MOST: u16 = 3;
/// Least width of the labels beside the plots.
const MARGIN: u16 = 8;
/// Columns of the plot on a terminal of 80 columns.
const USUAL_COLUMNS: u16 = 71;
/// Longest time in us; longer times are in ms.
const MOST_MICROS: f64 = 5000.0;
/// The part of the approach that the strike shows after E.
const AFTER_E: f64 = 0.5;

/// The state of the pane, common to all open cases.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ChartPane {
    /// The selected chart, as an index of the table.
    pub graph: usize,
    /// The chart of a worker that replaces it.
    pub worker_chart: Option<WorkerChart>,
    /// Whether the x axis is the time after E.
    pub(crate) by_time: bool,
    /// The visible roll angles.
    pub view: ChartView,
}

/// The number of charts: those of the table, and those of the worker.
const CHARTS: usize = GRAPHS.len() + WorkerChart::ALL.len();

impl ChartPane {
    /// The index of the selected chart among all charts.
    fn place(&self) -> usize {
        let of_worker = |chart| WorkerChart::ALL.iter().position(|own| *own == chart);
        let place = self.worker_chart.and_then(of_worker);
        place.map_or(self.graph, |place| GRAPHS.len() + place)
    }

    /// Selects the chart with an index among all charts.
    fn select(&mut self, at: usize) {
        self.worker_chart = at.checked_sub(GRAPHS.len()).map(|at| WorkerChart::ALL[at]);
        if self.worker_chart.is_none() {
            self.graph = at;
        }
    }

    /// The key of the selected chart, as in `plot --chart`.
    #[must_use]
    pub fn key(&self) -> &'static str {
        self.worker_chart.map_or(GRAPHS[self.graph].key, WorkerChart::key)
    }
}

/// A command of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ChartCommand {
    /// Selects the chart `by` places further, wrapping around.
    Step(isize),
    /// Selects the chart with an index of the table, or after the table a chart of the worker.
    Select(usize),
    /// Zooms in by steps around the cursor, or around D without a cursor; zooms out if negative.
    Zoom(i32),
    /// Shows the whole contact.
    Whole,
    /// Switches between the strike and the whole contact.
    Strike,
    /// Switches the x axis between roll angle and time.
    Time,
}

/// The pane with the results that it shows.
#[derive(Debug, Clone, Copy)]
pub struct Charts<'a> {
    /// The state of the pane.
    pub(crate) pane: &'a ChartPane,
    /// The axes of the case.
    pub(crate) scale: &'a Scale,
    /// The last valid results.
    pub(crate) answer: Option<&'a Answer>,
    /// The results of the baseline.
    pub(crate) baseline: Option<&'a Answer>,
    /// The cursor: the driver's roll angle before E, in rad.
    pub(crate) cursor: Option<f64>,
    /// Whether the results are older than the form.
    pub(crate) is_stale: bool,
    /// The key that shows the notes.
    pub(crate) notes_key: &'static str,
    /// The chart that the worker computes for the case.
    pub work: &'a ChartWork,
    /// The first request after the last undo.
    pub(crate) undone: u64,
    /// The display units.
    pub(crate) units: System,
    /// The marker of the active curve.
    pub(crate) marker: Marker,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

impl Charts<'_> {
    /// The results of the active method.
    #[must_use]
    pub fn solution(&self) -> Option<&Solution> {
        self.answer.and_then(|answer| answer.of(answer.active))
    }

    /// The visible roll angles, in deg after E.
    #[must_use]
    pub fn window(&self) -> Span {
        self.view().window(self.scale)
    }

    /// The view of the pane. A chart of the path of contact starts with the whole contact.
    fn view(&self) -> ChartView {
        match self.pane.view.frame {
            Frame::Opening if self.is_by_model() => {
                ChartView { frame: Frame::Whole, ..self.pane.view }
            }
            _ => self.pane.view,
        }
    }

    /// Whether the selected chart has a curve for each compliance model.
    fn is_by_model(&self) -> bool {
        GRAPHS[self.pane.graph].by_model.is_some()
    }

    /// The state after a command, with a message.
    #[must_use]
    pub(crate) fn run(&self, command: ChartCommand) -> (ChartPane, Option<&'static str>) {
        let mut pane = *self.pane;
        let message = match command {
            ChartCommand::Step(by) => {
                let at = (pane.place() + CHARTS).saturating_add_signed(by) % CHARTS;
                pane.select(at);
                None
            }
            ChartCommand::Select(at) => {
                pane.select(at.min(CHARTS - 1));
                None
            }
            ChartCommand::Zoom(steps) => {
                pane.view = self.zoomed(steps);
                let end =
                    if steps > 0 { "closest zoom" } else { "the charts show the whole contact" };
                (pane.view == self.view()).then_some(end)
            }
            ChartCommand::Whole => {
                pane.view = ChartView::whole();
                Some("the charts show the whole contact")
            }
            ChartCommand::Strike => {
                pane.view = self.view().strike_or_whole(self.scale);
                Some(match pane.view.frame {
                    Frame::Strike if self.scale.strike.is_empty() => {
                        "no corner contact: no strike to show"
                    }
                    Frame::Strike => "the charts show the strike",
                    Frame::Opening | Frame::Whole => "the charts show the whole contact",
                })
            }
            ChartCommand::Time => {
                pane.by_time = !pane.by_time;
                Some(if pane.by_time {
                    "x axis: time after E"
                } else {
                    "x axis: driver roll angle before E"
                })
            }
        };
        (pane, message)
    }

    fn zoomed(&self, steps: i32) -> ChartView {
        let start = self.solution().and_then(first_contact);
        let around = 0.0 - self.cursor.or(start).unwrap_or(0.0).to_degrees();
        self.view().zoomed(steps, around, self.scale)
    }

    /// Axes that contain every visible curve, and what they are fitted to. Keeps the present axes
    /// while they fit.
    pub(crate) fn fitted(&self, before: Occasion) -> (Occasion, Scale) {
        let mut scale = *self.scale;
        let mut occasion = Occasion {
            shown: (self.pane.graph, self.count(), self.units),
            ground: (self.answer.map(|answer| answer.active), self.undone),
        };
        let Some(answer) = self.answer.filter(|_| !self.area.is_empty()) else {
            return (before, scale);
        };
        // While an answer is incomplete, the method and the undo of the earlier occasion remain.
        if answer.pending.is_some() || answer.serial < occasion.ground.1 {
            occasion.ground = before.ground;
        }
        let is_new = occasion.ground != before.ground;
        let fitted = |axis: Span, values: Span| {
            if is_new { axis.refit(values) } else { axis.fitted(values) }
        };
        let pinned = self.baseline.map(|baseline| (baseline, baseline.beside(answer.active)));
        let way = pinned.map_or(Span::NONE, |(base, method)| angle_range_of(base, method));
        let way = way.and(way_of_all(answer));
        let way = if self.is_by_model() { way.and(path(answer)) } else { way };
        // The axis does not shrink while the worker still solves a method.
        scale.across = match answer.pending {
            Some(_) => scale.across.grown(way),
            None => fitted(scale.across, way),
        };
        let touches = [Some((answer, answer.active)), pinned].into_iter().flatten();
        let touches = touches.filter_map(|(answer, method)| first_contact(answer.of(method)?));
        let first = touches.fold(0.0, f64::max).to_degrees();
        let strike = Span::new(-first, AFTER_E * first);
        scale.strike =
            if strike.is_empty() { Span::default() } else { fitted(scale.strike, strike) };
        let window = self.view().window(&scale);
        for graph in self.shown() {
            let curves = curves(self, &GRAPHS[graph]);
            let values = curves.iter().map(|curve| curve.upright_within(window));
            let values = values.fold(Span::NONE, Span::and);
            let now = scale.upright[graph];
            let start =
                if is_new || occasion.shown != before.shown { Span::default() } else { now };
            let axis = match GRAPHS[graph].by_model {
                Some(_) => start.fitted_closely(values),
                None => start.fitted(values),
            };
            scale.upright[graph] = if axis.is_empty() { now } else { axis };
        }
        (occasion, scale)
    }

    /// The visible charts: the selected chart, and below it the next charts of the active method.
    #[must_use]
    pub fn shown(&self) -> Vec<usize> {
        let chosen = self.pane.graph;
        let method = self.answer.map(|answer| answer.active);
        let others = (1..GRAPHS.len()).map(|by| (chosen + by) % GRAPHS.len());
        let has_curve = |graph: &usize| {
            let graph = &GRAPHS[*graph];
            graph.by_model.is_none() && method.is_some_and(|method| graph.column(method).is_some())
        };
        std::iter::once(chosen).chain(others.filter(has_curve)).take(self.count()).collect()
    }

    fn count(&self) -> usize {
        if self.area.is_empty() { 0 } else { usize::from((self.area.height / ROWS).clamp(1, MOST)) }
    }

    /// The factor from deg after E to the x axis, and its quantity: the driver's angle before E, or
    /// the time after E.
    pub(crate) fn ruler(&self) -> (f64, Axis) {
        let window = self.window();
        let speed = self.answer.map_or(0.0, |answer| answer.inputs.speed);
        let micros = 1f64.to_radians() / speed * 1e6;
        let longest = micros * window.from.abs().max(window.to.abs());
        match self.pane.by_time {
            false => (-1.0, Axis::new("roll angle before E", "deg")),
            true if longest < MOST_MICROS => (micros, Axis::new("time after E", "us")),
            true => (1e-3 * micros, Axis::new("time after E", "ms")),
        }
    }

    /// The visible charts from top to bottom, each with its plot below its title.
    fn plots(&self) -> Vec<(usize, Rect, Plot)> {
        let (shown, area) = (self.shown(), self.area);
        let height = area.height / u16::try_from(shown.len().max(1)).unwrap_or(1);
        let up = |graph: usize| self.scale.upright[graph];
        let margins = shown
            .iter()
            .map(|&graph| label_margin(&Axis::default(), up(graph), height.saturating_sub(1)));
        let margin = margins.max().unwrap_or(0).max(MARGIN);
        let below = |at: usize| {
            let y = area.y + height * at as u16;
            let height = if at + 1 == shown.len() { area.bottom() - y } else { height };
            Rect { y: y + 1, height: height.saturating_sub(1), ..area }
        };
        let plot = |(at, &graph): (usize, &usize)| {
            (graph, below(at), Plot::new(below(at), margin, (self.window(), up(graph))))
        };
        shown.iter().enumerate().map(plot).collect()
    }

    /// The chart of the curves, with their looks.
    fn chart(&self, graph: &Graph, curves: &[Curve], width: u16) -> (Chart, Vec<SeriesLook>) {
        let own = self.answer.and_then(|answer| graph.column(answer.active));
        let is_free = own.is_none()
            && !curves.is_empty()
            && self.answer.is_some_and(|answer| answer.active.shares_load());
        let label = if is_free {
            format!("Free impact: {}", graph.label.to_lowercase())
        } else {
            graph.label.to_owned()
        };
        let column = own.or_else(|| graph.all_columns().next());
        let up = column.map(|column| {
            let symbol = symbol(column.symbol, self.look.ascii);
            Axis::new(format!("{label} {symbol}"), self.units.unit(column.shown))
        });
        let (factor, across) = self.ruler();
        let window = self.window();
        let ends = Span::NONE.with(factor * window.from).with(factor * window.to);
        let labels = ends.ticks(width / LABEL_COLUMNS).into_iter();
        let labels = labels.map(|(value, label)| (value / factor, label)).collect();
        let series = curves.iter().rev().map(|curve| curve.series(self));
        let looks = curves.iter().rev().map(|curve| curves::look(self, curve.source));
        let chart = Chart {
            across: Axis { labels, ..across },
            up: up.unwrap_or_default(),
            series: series.collect(),
            ..Chart::default()
        };
        (chart, looks.collect())
    }

    // The reason why the active method has no curve.
    fn missing(&self, graph: &Graph, curves: &[Curve]) -> Option<String> {
        let Some(answer) = self.answer else {
            return Some("No results yet.".to_owned());
        };
        let is_main = |curve: &Curve| {
            matches!(curve.source, CurveSource::Active(_) | CurveSource::Model { .. })
        };
        if curves.iter().any(is_main) {
            return None;
        }
        if self.is_stale {
            return Some("The charts are not redrawn while a field is invalid.".to_owned());
        }
        let (label, active) = (graph.label.to_lowercase(), answer.active);
        if graph.by_model.is_some() {
            return Some(match &answer.stiffness {
                Some(Err(refusal)) => format!("No {label}: {refusal}."),
                Some(Ok(_)) => format!("No {label}: no model covers the pair."),
                None => format!("Computing the {label}."),
            });
        }
        if graph.column(active).is_none() {
            let methods: Vec<_> = graph.methods().map(Method::name).collect();
            let (name, methods) = (active.name(), methods.join(" and "));
            return Some(format!("Method {name} does not compute the {label}; {methods} do."));
        }
        Some(match answer.of(active) {
            None => "This method has no valid results.".to_owned(),
            Some(solution) if solution.outcome == Outcome::NoCornerContact => {
                format!("No corner contact: {}; no impact.", without_contact(solution))
            }
            Some(_) => {
                format!("No {label} between D and E; {} shows the reason.", self.notes_key)
            }
        })
    }
}

/// Draws the title of the pane and the charts.
pub(crate) fn draw(charts: &Charts, title: &Title, buffer: &mut Buffer) {
    let stale = if charts.is_stale { "LAST VALID, " } else { "" };
    if let Some(chart) = charts.pane.worker_chart {
        let running = if charts.work.is_running { "computing: " } else { "" };
        let drawn = charts.work.drawn(chart);
        let words = drawn.map_or_else(|| chart.words()[0].to_owned(), Chart::quantities);
        let state = if stale.is_empty() { running } else { stale };
        let inner = title.draw(&format!("{state}{words}"), charts.area, buffer);
        match drawn {
            Some(drawn) => draw_worker_chart(charts, chart, drawn, inner, buffer),
            None => text::draw_words(&charts.work.missing(chart), inner, buffer),
        }
        return;
    }
    if charts.answer.is_none() {
        title.draw("Chart", charts.area, buffer);
    }
    for (at, (graph, area, plot)) in charts.plots().into_iter().enumerate() {
        let graph = &GRAPHS[graph];
        let curves = curves(charts, graph);
        let (chart, looks) = charts.chart(graph, &curves, plot.cells.width);
        if at == 0 && charts.answer.is_some() {
            title.draw(&format!("{stale}{}", chart.quantities()), charts.area, buffer);
        } else if at > 0 {
            let above = Rect { y: area.y - 1, height: 1, ..area };
            text::titled(&chart.quantities(), above, charts.look.theme, buffer);
        }
        draw_panel(charts, (graph, &curves), (&chart, looks), (area, plot), buffer);
    }
}

/// The width of the visible chart in columns, or of a default chart if none is visible.
#[must_use]
pub(crate) fn columns(charts: &Charts) -> u16 {
    let columns = charts.plots().first().map_or(0, |(_, _, plot)| plot.cells.width);
    if columns > 1 { columns } else { USUAL_COLUMNS }
}

/// The driver's roll angle before E at a cell of a plot, in rad.
pub(crate) fn angle_at(charts: &Charts, at: Position) -> Option<f64> {
    let plots = charts.plots();
    let (.., plot) = plots.iter().find(|(.., plot)| plot.cells.contains(at))?;
    let angle = 0.0 - plot.value(at.x).to_radians();
    (charts.pane.worker_chart.is_none() && angle.is_finite()).then_some(angle)
}

fn draw_panel(
    charts: &Charts,
    (graph, curves): (&Graph, &[Curve]),
    (chart, looks): (&Chart, Vec<SeriesLook>),
    (area, plot): (Rect, Plot),
    buffer: &mut Buffer,
) {
    let theme = charts.look.theme;
    let missing = charts.missing(graph, curves);
    let width = usize::from(area.width).saturating_sub(2);
    let rows = missing.as_ref().map_or(0, |words| text::wrap(words, width).len() as u16);
    if let Some(words) = &missing {
        text::draw_words(words, area, buffer);
    }
    if curves.is_empty() || charts.window().is_empty() {
        return;
    }
    let area = Rect { y: area.y + rows, height: area.height.saturating_sub(rows), ..area };
    if Plot::new(area, MARGIN, (plot.across, plot.up)).cells.is_empty() {
        if missing.is_none() {
            text::draw_words("The pane is too small for a chart.", area, buffer);
        }
        return;
    }
    let is_compared = graph.by_model.is_some();
    let words = vec![("time ->".to_owned(), Style::new())];
    let drawn = TerminalChart { chart, looks, words, is_compared, theme };
    let margin = plot.cells.x - area.x;
    let plot = drawn.draw(area, (plot.across, plot.up), margin, buffer);
    if plot.cells.is_empty() {
        return;
    }
    for (x, name, style) in marks(charts) {
        plot.draw_mark(x, name, style, buffer);
    }
    if let Some(cursor) = charts.cursor {
        plot.draw_cursor(0.0 - cursor.to_degrees(), theme, buffer);
    }
}

/// The marks of the contact: E; D; the last contact L; B, the end of the path of contact; D of the
/// other methods.
fn marks(charts: &Charts) -> Vec<(f64, &'static str, Style)> {
    let (Some(answer), theme) = (charts.answer, charts.look.theme) else {
        return Vec::new();
    };
    let own = answer.of(answer.active).map(|solution| {
        let geometry = &solution.geometry;
        let end = (geometry.start - geometry.end) / geometry.driver.base;
        [
            (Some(0.0), "E", theme.active),
            (first_contact(solution), "D", theme.active),
            (last_contact(solution), "L", theme.active),
            (Some(end), "B", theme.active),
        ]
    });
    let others = answer.methods.iter().filter(|(method, _)| *method != answer.active);
    let others = others.filter_map(|(_, found)| found.as_ref().ok());
    let others = others.map(|solution| (first_contact(solution), "d", theme.other));
    let all = own.into_iter().flatten().chain(others);
    all.filter_map(|(angle, name, style)| Some((0.0 - angle?.to_degrees(), name, style))).collect()
}

fn draw_worker_chart(
    charts: &Charts,
    of: WorkerChart,
    chart: &Chart,
    area: Rect,
    buffer: &mut Buffer,
) {
    const SIGNS: [char; 4] = ['*', '+', '×', '∘'];
    let theme = charts.look.theme;
    let look = |(at, kind): (usize, Kind)| {
        let style = if at == 0 { theme.active } else { theme.other };
        match kind {
            Kind::Marks(_) => (Marker::Custom('×'), theme.note),
            Kind::Bars => (Marker::Custom(if at == 0 { '█' } else { '▒' }), style),
            Kind::Curve | Kind::Bound if at == 0 => (charts.marker, style),
            Kind::Curve | Kind::Bound => (Marker::Custom(SIGNS[at % SIGNS.len()]), style),
        }
    };
    let looks = chart.series.iter().map(|series| series.kind).enumerate().map(look).collect();
    let is_compared = matches!(of, WorkerChart::ToothCompliance(_));
    let drawn = TerminalChart { chart, looks, words: Vec::new(), is_compared, theme };
    drawn.draw(area, chart.spans(), 0, buffer);
}
