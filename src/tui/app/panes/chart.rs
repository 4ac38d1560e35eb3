//! The chart pane: the selected chart of the station values, and further charts below it if there
//! is room.

pub(crate) mod curves;

use std::borrow::Cow;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::plot::{LABEL_COLUMNS, Look as SeriesLook, Plot, TerminalChart, Words};
use crate::case::units::{self, System};
pub use crate::model::contact_state::first_touch_of_driver as first_contact;
use crate::model::inputs::Method;
use crate::model::{Inputs, Outcome, Quantity, Solution};
use crate::numeric::decimal::significant;
use crate::report::chart::{Axis, Chart, Kind, Series, Span};
use crate::report::charts;
use crate::report::charts::{PATTERN, Pattern, pattern_chart};
use crate::report::shown_in;
use crate::report::stations::{GRAPHS, Graph};
use crate::report::verdict::without_contact;
use crate::tui::app::App;
use crate::tui::app::actions::Slot;
use crate::tui::layout::Pane;
use crate::tui::solver::Answer;
use crate::tui::text;
use crate::tui::text::symbol;

pub(crate) use curves::last_contact;
pub use curves::readout;
use curves::{ChartView, Scale};
use curves::{Curve, curves, value_at};

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
/// Significant digits of a value of a chart with its own axes.
const DIGITS: usize = 4;

/// A chart with its own axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OwnChart {
    /// Compliance of a tooth of the driver (0) or of the driven gear (1) over its flank.
    ToothCompliance(usize),
    /// Harmonics of the transmission error.
    Spectrum,
    /// Dynamic factor over speed.
    Speed,
    /// Line load over roll angle and face width, with the contact lines; not computed by the worker.
    Pattern,
}

impl OwnChart {
    /// Every chart, in their order after the charts of the stations.
    pub const ALL: [OwnChart; 5] = [
        OwnChart::ToothCompliance(0),
        OwnChart::ToothCompliance(1),
        OwnChart::Spectrum,
        OwnChart::Speed,
        OwnChart::Pattern,
    ];

    /// The key, as in `plot --chart`.
    pub fn key(self) -> &'static str {
        match self {
            OwnChart::ToothCompliance(gear) => charts::TOOTH_KEYS[gear],
            OwnChart::Spectrum => charts::SPECTRUM,
            OwnChart::Speed => charts::SPEED,
            OwnChart::Pattern => PATTERN,
        }
    }

    /// The name and the description in lists, and the description in the status line.
    pub fn words(self) -> [&'static str; 3] {
        const TOOTH: &str = "The deflection of the loaded tooth per unit load; surface includes the \
            contact. C is the pitch circle.";
        match self {
            OwnChart::ToothCompliance(0) => [
                "Driver tooth compliance",
                "Show the compliance of a tooth of the driver over its flank, by every model.",
                TOOTH,
            ],
            OwnChart::ToothCompliance(_) => [
                "Driven tooth compliance",
                "Show the compliance of a tooth of the driven gear over its flank, by every model.",
                TOOTH,
            ],
            OwnChart::Spectrum => [
                "Spectrum",
                "Show the harmonics of the transmission error at rest and in motion.",
                "The amplitude of each harmonic of the mesh frequency, at rest and in motion.",
            ],
            OwnChart::Speed => [
                "Dynamic factor over speed",
                "Show the dynamic factor over speed, up and down, with the resonances.",
                "The peak force of a tooth over that at rest. N is the mesh frequency over the \
                    natural frequency; N = 1, 1/2 and 1/3 mark the resonances. a: next peak.",
            ],
            OwnChart::Pattern => [
                "Contact pattern",
                "Show the line load over roll angle and face width of a pair with slices, and its \
                    contact lines.",
                "The line load of the incoming tooth. h and l turn the gears, Up and Down move the \
                    cursor along the contact line.",
            ],
        }
    }
}

/// A request for a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartRequest {
    /// The chart.
    pub chart: OwnChart,
    /// The pair.
    pub inputs: Inputs,
}

/// The chart, or the reason why there is none.
pub(crate) type ChartValues = Result<Chart, String>;

/// The chart of a case: the last request and its values.
#[derive(Debug, Clone, Default)]
pub struct ChartWork {
    /// The last request, unless its work was stopped.
    pub request: Option<ChartRequest>,
    /// The values; those of an earlier request until the first values of the last one arrive.
    pub found: Option<(OwnChart, ChartValues)>,
    /// The number of its work.
    pub(crate) work: u64,
}

impl ChartWork {
    /// The computed part of the chart.
    pub fn drawn(&self, chart: OwnChart) -> Option<&Chart> {
        self.values(chart)?.as_ref().ok()
    }

    /// The reason why there is no chart.
    fn missing(&self, chart: OwnChart, is_running: bool) -> String {
        match self.values(chart) {
            Some(Err(reason)) => format!("No chart: {reason}."),
            _ if is_running => "Computing.".to_owned(),
            _ => "The form is not valid: no chart.".to_owned(),
        }
    }

    fn values(&self, chart: OwnChart) -> Option<&ChartValues> {
        let (_, found) = self.found.as_ref().filter(|(own, _)| *own == chart)?;
        Some(found)
    }
}

/// The state of the pane, common to all open cases.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ChartPane {
    /// The selected chart: an index of the table of charts, or after it of the worker's charts.
    pub selected: usize,
    /// Whether the x axis is the time after E.
    pub(crate) by_time: bool,
    /// The visible roll angles.
    pub view: ChartView,
    /// The cursor of a chart with its own axes, on its x axis.
    pub(crate) place: Option<f64>,
    /// The place of the cursor along the face from its middle, in m: that of the teeth.
    pub z: f64,
}

/// The number of charts: those of the table, and those of the worker.
pub(crate) const CHARTS: usize = GRAPHS.len() + OwnChart::ALL.len();

impl ChartPane {
    /// The selected chart of the table; the first one beside a chart of the worker.
    pub fn graph(&self) -> usize {
        if self.selected < GRAPHS.len() { self.selected } else { 0 }
    }

    /// The selected chart with its own axes, if any.
    pub fn own_axes(&self) -> Option<OwnChart> {
        OwnChart::ALL.get(self.selected.checked_sub(GRAPHS.len())?).copied()
    }

    /// Whether the contact pattern is selected.
    pub(crate) fn is_pattern(&self) -> bool {
        self.own_axes() == Some(OwnChart::Pattern)
    }

    /// The key of the selected chart, as in `plot --chart`.
    pub fn key(self) -> &'static str {
        self.own_axes().map_or(GRAPHS[self.graph()].key, OwnChart::key)
    }
}

/// The chart pane of the workbench.
#[derive(Debug, Clone, Copy)]
pub struct Charts<'a>(pub(crate) &'a App);

impl<'a> Charts<'a> {
    /// The last valid results.
    pub(crate) fn answer(self) -> Option<&'a Answer> {
        self.0.tab.answer.as_ref()
    }

    /// The results of the active method.
    pub fn solution(self) -> Option<&'a Solution> {
        self.0.tab.solution()
    }

    /// The results of the baseline.
    fn pinned(self) -> Option<&'a Answer> {
        self.0.baseline.as_ref().map(|baseline| &baseline.answer)
    }

    /// The area of the pane with its title; empty if the pane is hidden.
    fn area(self) -> Rect {
        self.0.area(Pane::Chart)
    }

    /// Whether the cursor moves in the teeth pane: in the focused pane, or in the visible one.
    pub(crate) fn is_in_teeth(self) -> bool {
        let plan = self.0.layout.plan();
        let is_alone = !plan.shows(Pane::Chart) && plan.shows(Pane::Teeth);
        self.0.layout.focus == Pane::Teeth || is_alone
    }

    /// The visible roll angles, in deg after E.
    pub fn window(self) -> Span {
        self.view().window(&self.scale())
    }

    /// The view of the pane. A chart of the path or of the plane of contact starts with the whole
    /// contact, as does that of a case without contact before E: only its baseline has a strike.
    pub(crate) fn view(self) -> ChartView {
        let first = self.solution().and_then(first_contact).unwrap_or_default();
        let is_whole = self.is_by_model() || self.0.chart.is_pattern() || first <= 0.0;
        match self.0.chart.view {
            ChartView::Opening if is_whole => ChartView::Whole,
            view => view,
        }
    }

    /// The view, scrolled if necessary to show the cursor.
    pub(crate) fn following(self, cursor: f64) -> ChartView {
        let view = self.view().following(self.ahead() - cursor.to_degrees(), &self.scale());
        if view == self.view() { self.0.chart.view } else { view }
    }

    /// Whether the selected chart has a curve for each compliance model.
    fn is_by_model(self) -> bool {
        GRAPHS[self.0.chart.graph()].by_model.is_some()
    }

    /// The view zoomed by steps around the cursor, or around D without a cursor.
    pub(crate) fn zoomed(self, steps: i32) -> ChartView {
        let start = self.solution().and_then(first_contact);
        let around = 0.0 - self.0.cursor.or(start).unwrap_or(0.0).to_degrees();
        self.view().zoomed(steps, around, &self.scale())
    }

    /// The line load of the active method over the face width.
    pub(crate) fn pattern(self) -> Option<Pattern<'a>> {
        Pattern::of(&self.answer()?.inputs, self.solution()?)
    }

    /// Whether the contact pattern is selected and the case has none.
    pub(crate) fn lacks_pattern(self) -> bool {
        self.0.chart.is_pattern() && self.pattern().is_none()
    }

    /// The line load while the contact pattern is selected.
    pub(super) fn shown_pattern(self) -> Option<Pattern<'a>> {
        self.pattern().filter(|_| self.0.chart.is_pattern())
    }

    /// The roll angle by which the plane of the cursor is ahead in the contact pattern, in deg.
    pub(crate) fn ahead(self) -> f64 {
        let ahead = self.shown_pattern().map(|pattern| pattern.ahead(self.0.chart.z));
        ahead.unwrap_or_default().to_degrees()
    }

    /// The chart with its own axes, as far as it is computed.
    fn own_chart(self) -> Option<Cow<'a, Chart>> {
        match self.0.chart.own_axes()? {
            OwnChart::Pattern => {
                let pattern = self.pattern()?;
                let angle = self.0.cursor.map_or(pattern.at_peak(), |cursor| 0.0 - cursor);
                let chart = pattern.chart(angle, self.window(), self.0.settings.units);
                Some(Cow::Owned(Chart { across: self.across(), ..chart }))
            }
            chart => {
                let drawn = self.0.tab.chart_work.drawn(chart)?;
                Some(match self.0.settings.units {
                    System::Metric => Cow::Borrowed(drawn),
                    System::Inch => Cow::Owned(drawn.clone().in_units(System::Inch)),
                })
            }
        }
    }

    /// The x axis in the visible range.
    fn across(self) -> Axis {
        let width = self.area().width.saturating_sub(MARGIN + 5);
        let ((factor, across), window) = (self.ruler(), self.window());
        let ends = Span::NONE.with(factor * window.from).with(factor * window.to);
        let labels = ends.ticks(width / LABEL_COLUMNS).into_iter();
        let labels = labels.map(|(value, label)| (value / factor, label)).collect();
        Axis { labels, ..across }
    }

    /// The point or mark `by` places from the cursor of that chart; the first without a cursor.
    pub(crate) fn moved(self, by: isize) -> Option<f64> {
        let chart = self.own_chart()?;
        let points = chart.series.iter().flat_map(|series| series.pieces.iter().flatten());
        let points = points.map(|point| point.0).chain(chart.marks.iter().map(|mark| mark.0));
        let mut points: Vec<f64> = points.collect();
        points.sort_by(f64::total_cmp);
        points.dedup();
        let last = points.len().max(1) - 1;
        let now = self.0.chart.place.map(|place| points.partition_point(|point| *point < place));
        let first = if by == isize::MAX { last } else { 0 };
        let at = now.map_or(first, |now| now.saturating_add_signed(by)).min(last);
        points.get(at).copied()
    }

    /// The next peak to the right of the cursor of that chart, else the first: the greatest value of
    /// each curve, and the marked peaks.
    pub(crate) fn next_peak(self) -> Option<f64> {
        let chart = self.own_chart()?;
        let is_peak = |series: &&Series| {
            !matches!(series.kind, Kind::Marks(_)) || series.name.contains(": peak")
        };
        let greatest = |series: &Series| {
            let points = series.pieces.iter().flatten();
            points.max_by(|one, other| one.1.total_cmp(&other.1)).map(|point| point.0)
        };
        let peaks = chart.series.iter().filter(is_peak).filter_map(greatest);
        let mut peaks: Vec<f64> = peaks.collect();
        peaks.sort_by(f64::total_cmp);
        let next = peaks.iter().find(|peak| self.0.chart.place.is_none_or(|place| **peak > place));
        next.or(peaks.first()).copied()
    }

    /// The values of that chart at its cursor, or its description without a cursor.
    pub(crate) fn own_readout(self) -> String {
        if let Some((pattern, cursor)) = self.shown_pattern().zip(self.0.cursor) {
            return self.pattern_readout(&pattern, cursor);
        }
        let Some((chart, place)) = self.own_chart().zip(self.0.chart.place) else {
            let chart = self.0.chart.own_axes().filter(|_| !self.lacks_pattern());
            return chart.map_or("", |chart| chart.words()[2]).to_owned();
        };
        let value = |value: f64, unit: &str| {
            let unit = unit.split(';').next().unwrap_or_default();
            format!("{} {unit}", significant(value, DIGITS)).trim_end().to_owned()
        };
        let series = chart.series.iter().filter(|series| !matches!(series.kind, Kind::Marks(_)));
        let values = series.filter_map(|series| {
            let name = series.name.split([',', ':']).next().unwrap_or_default();
            let y = value_at(&series.pieces, place)?;
            Some(format!("{name} {}", value(y, &chart.up.unit)))
        });
        let values: Vec<String> = values.collect();
        let mark = chart.marks.iter().find(|mark| mark.0.total_cmp(&place).is_eq());
        let is_here = |series: &&Series| {
            let mut points = series.pieces.iter().flatten();
            matches!(series.kind, Kind::Marks(_))
                && points.any(|point| point.0.total_cmp(&place).is_eq())
        };
        let mut peaks = chart.series.iter().filter(is_here);
        let peak = peaks.find_map(|series| series.name.split_once(": peak"));
        let name = mark.map(|(_, name)| *name).or(peak.map(|(name, _)| name));
        let mark = name.map_or_else(String::new, |name| format!(" ({name})"));
        let mut points = chart.series.iter().flat_map(|series| series.pieces.iter().flatten());
        let is_point = values.is_empty() || points.any(|point| point.0.total_cmp(&place).is_eq());
        let between = if is_point { "" } else { ", between computed points" };
        let values = if values.is_empty() { vec![self.beside_curves(&chart)] } else { values };
        let across = value(place, &chart.across.unit);
        format!("{} {across}{mark}{between}: {}.", chart.across.name, values.join(", "))
    }

    /// The values at a place without a curve: at the present speed, the dynamic factor of the results.
    fn beside_curves(self, chart: &Chart) -> String {
        let factor = Quantity::find("tooth_force_factor");
        let present = self.0.chart.own_axes() == Some(OwnChart::Speed)
            && chart
                .marks
                .iter()
                .any(|(x, name)| *name == "present" && Some(*x) == self.0.chart.place);
        let found = factor.filter(|_| present).zip(self.solution());
        let found =
            found.and_then(|(factor, solution)| Some((factor, factor.finite_value(solution)?)));
        match found {
            Some((factor, value)) => {
                let name = symbol(factor.symbol, self.0.look.ascii);
                format!(
                    "{name} {}, outside the curves",
                    shown_in(factor, value, self.0.settings.units)
                )
            }
            None => "no value, outside the curves".to_owned(),
        }
    }

    /// The line load at the cursor, and the values of the tooth at its roll angle.
    fn pattern_readout(self, pattern: &Pattern<'_>, cursor: f64) -> String {
        let (z, angle) = (self.0.chart.z, pattern.ahead(self.0.chart.z) - cursor);
        let side = if angle < 0.0 { "before" } else { "after" };
        let [z, load] = [
            ("static_peak_line_load_position", z),
            ("static_peak_line_load", pattern.line_load(angle, z)),
        ]
        .map(|(key, value)| {
            let known = Quantity::find(key);
            known.map_or_else(String::new, |known| {
                shown_in(known, value, self.0.settings.units).to_string()
            })
        });
        let angle = significant(angle.abs().to_degrees(), DIGITS);
        let place = format!("In the plane at z {z} {angle} deg {side} its E");
        format!("{place}: line load {load}. {}", readout(self, cursor))
    }

    /// The roll angles of every visible curve, with round ends.
    pub fn scale(self) -> Scale {
        let Some(answer) = self.answer() else { return Scale::default() };
        if let Some(pattern) = self.shown_pattern() {
            let across = pattern.span().scaled(1f64.to_degrees());
            let strike = Span::new(across.from, -AFTER_E * across.from);
            let strike = if strike.is_empty() { Span::default() } else { strike };
            return Scale { across, strike };
        }
        let pinned = self.pinned().and_then(|base| base.of(base.beside(answer.active)));
        let solved = answer.methods.iter().filter_map(|(_, found)| found.as_ref().ok());
        let ways = solved.chain(pinned).map(curves::way).fold(Span::NONE, Span::and);
        let ways = if self.is_by_model() { ways.and(curves::path(answer)) } else { ways };
        let touches = self.solution().into_iter().chain(pinned).filter_map(first_contact);
        let first = touches.fold(0.0, f64::max).to_degrees();
        let strike = Span::new(-first, AFTER_E * first);
        let strike = if strike.is_empty() { Span::default() } else { strike.axis() };
        Scale { across: ways.axis(), strike }
    }

    /// The visible charts: the selected chart, and below it the next charts of the active method.
    pub fn shown(self) -> Vec<usize> {
        let chosen = self.0.chart.graph();
        let others = (1..GRAPHS.len()).map(|by| (chosen + by) % GRAPHS.len());
        let has_curve = |graph: &usize| {
            let (graph, answer) = (&GRAPHS[*graph], self.answer());
            graph.by_model.is_none()
                && answer.is_some_and(|answer| graph.column(answer.active).is_some())
        };
        std::iter::once(chosen).chain(others.filter(has_curve)).take(self.count()).collect()
    }

    fn count(self) -> usize {
        let height = self.area().height;
        if height == 0 { 0 } else { usize::from((height / ROWS).clamp(1, MOST)) }
    }

    /// The factor from deg after E to the x axis, and its quantity: the driver's angle or the time after
    /// E.
    pub(crate) fn ruler(self) -> (f64, Axis) {
        let window = self.window();
        let speed = self.answer().map_or(0.0, |answer| answer.inputs.speed);
        let micros = 1f64.to_radians() / speed * 1e6;
        let longest = micros * window.from.abs().max(window.to.abs());
        match self.0.chart.by_time {
            false => (1.0, Axis::new(format!("roll angle after {}", self.entry()), "deg")),
            true if longest < MOST_MICROS => (micros, Axis::new("time after E", "us")),
            true => (1e-3 * micros, Axis::new("time after E", "ms")),
        }
    }

    /// The point from which roll angles count: each plane across the axis of a helical pair has its
    /// own E.
    pub(crate) fn entry(self) -> &'static str {
        let is_helical = self.answer().is_some_and(|answer| answer.inputs.helix_angle > 0.0);
        if is_helical { "E in mid-face" } else { "E" }
    }

    /// The values of a chart within the visible roll angles, with round ends.
    pub fn upright(self, graph: usize) -> Span {
        let (graph, window) = (&GRAPHS[graph], self.window());
        let values = curves(self, graph).into_iter().map(|curve| curve.upright_within(window));
        let values = values.fold(Span::NONE, Span::and);
        match graph.key {
            _ if graph.by_model.is_some() => values.close_axis(),
            // A helical tooth carries load at its D in one plane; a part of the axis would hide how much.
            "force" => values.with(0.0).axis(),
            _ => values.axis(),
        }
    }

    /// The chart of a graph: its curves with their looks.
    fn of_graph(self, at: usize) -> Shown<'a> {
        let (graph, curves) = (&GRAPHS[at], curves(self, &GRAPHS[at]));
        let own = self.answer().and_then(|answer| graph.column(answer.active));
        let shares_load = self.answer().is_some_and(|answer| answer.active.shares_load());
        let label = if own.is_none() && shares_load && !curves.is_empty() {
            format!("Free impact: {}", graph.label.to_lowercase())
        } else {
            graph.label.to_owned()
        };
        let up = own.or_else(|| graph.all_columns().next()).map(|column| {
            let symbol = symbol(column.symbol, self.0.look.ascii);
            Axis::new(format!("{label} {symbol}"), self.0.settings.units.unit(column.shown))
        });
        let (series, looks) = curves.iter().rev().map(|curve| curve.series(self)).unzip();
        let chart =
            Chart { across: self.across(), up: up.unwrap_or_default(), series, ..Chart::default() };
        let is_drawn = !curves.is_empty() && !self.window().is_empty();
        Shown {
            title: if self.answer().is_some() { chart.quantities() } else { "Chart".to_owned() },
            missing: self.missing(graph, &curves),
            spans: (self.window(), self.upright(at)),
            chart: is_drawn.then_some(Cow::Owned(chart)),
            looks,
            words: vec![("time ->, negative before E".to_owned(), Style::new())],
            margin: MARGIN,
            is_compared: graph.by_model.is_some(),
            marks: marks(self),
            cursor: self.0.cursor.map(|cursor| (0.0 - cursor.to_degrees(), None)),
        }
    }

    /// The chart with its own axes, or why it is missing.
    fn of_own(self, of: OwnChart) -> Shown<'a> {
        const SIGNS: [char; 4] = ['*', '+', '×', '∘'];
        let (theme, chart, is_pattern) =
            (self.0.look.theme, self.own_chart(), of == OwnChart::Pattern);
        // The contact lines lean as the teeth do.
        let lean = match self.shown_pattern().map_or(0.0, |pattern| pattern.ahead(1.0)) {
            0.0 => '|',
            ahead if ahead > 0.0 => '/',
            _ => '\\',
        };
        let look = |(at, series): (usize, &Series)| {
            let style = if at == 0 { theme.active } else { theme.other };
            match series.kind {
                Kind::Curve if is_pattern => (Marker::Custom([lean, '×'][at]), theme.focus),
                Kind::Marks(_) if is_pattern => (Marker::Custom('◆'), theme.focus),
                Kind::Marks(_) => (Marker::Custom('×'), theme.note),
                Kind::Bars => (Marker::Custom(if at == 0 { '█' } else { '▒' }), style),
                Kind::Curve | Kind::Bound if at == 0 => (self.0.settings.marker, style),
                Kind::Curve | Kind::Bound => (Marker::Custom(SIGNS[at % SIGNS.len()]), style),
            }
        };
        let looks =
            chart.iter().flat_map(|chart| chart.series.iter().enumerate().map(look)).collect();
        let is_running = self.0.runs(Slot::Chart, self.0.tab.chart_work.work);
        let running = is_running && !self.0.tab.shows_last_valid() && !is_pattern;
        // The legend of a map has the unit of its values; the title fits beside the hidden panes.
        let title = |chart: &Chart| match &chart.map {
            Some(map) => format!("{}, roll angle after E, {}", map.value.name, chart.up.in_unit()),
            None => chart.quantities(),
        };
        let words = chart.as_deref().map_or_else(|| of.words()[0].to_owned(), title);
        let missing = || match self.answer() {
            Some(answer) if is_pattern => {
                let solution: Vec<_> = self.solution().into_iter().collect();
                let reason = pattern_chart(&answer.inputs, &solution, self.0.settings.units).err();
                let words = reason.map(|reason| format!("No chart: {reason}. j: next chart."));
                words.unwrap_or_default()
            }
            _ => self.0.tab.chart_work.missing(of, is_running),
        };
        let up = chart.as_ref().map_or("", |chart| &chart.up.unit);
        let height = units::per(self.0.chart.z, up);
        let in_pattern = |cursor: f64| (self.ahead() - cursor.to_degrees(), Some(height));
        Shown {
            title: format!("{}{words}", if running { "computing: " } else { "" }),
            missing: chart.is_none().then(missing),
            spans: chart.as_ref().map_or_else(Default::default, |chart| chart.spans()),
            looks,
            words: Vec::new(),
            margin: 0,
            is_compared: matches!(of, OwnChart::ToothCompliance(_)),
            marks: Vec::new(),
            cursor: if is_pattern {
                self.0.cursor.map(in_pattern)
            } else {
                self.0.chart.place.map(|place| (place, None))
            },
            chart,
        }
    }

    // The reason why the active method has no curve.
    fn missing(self, graph: &Graph, curves: &[Curve]) -> Option<String> {
        let Some(answer) = self.answer() else {
            return Some("No results yet.".to_owned());
        };
        if curves.iter().any(Curve::is_main) {
            return None;
        }
        let (label, active) = (graph.label.to_lowercase(), answer.active);
        Some(match (answer.of(active), &answer.stiffness) {
            _ if self.0.tab.shows_last_valid() => {
                "The charts are not redrawn while a field is invalid.".to_owned()
            }
            (_, Some(Err(refusal))) if graph.by_model.is_some() => {
                format!("No {label}: {refusal}.")
            }
            (_, Some(Ok(_))) if graph.by_model.is_some() => {
                format!("No {label}: no model covers the pair.")
            }
            _ if graph.by_model.is_some() => format!("Computing the {label}."),
            _ if graph.column(active).is_none() => {
                let methods: Vec<_> = graph.methods().map(Method::name).collect();
                let (name, methods) = (active.name(), methods.join(" and "));
                format!("Method {name} does not compute the {label}; {methods} do.")
            }
            (None, _) => "This method has no valid results.".to_owned(),
            (Some(solution), _) if solution.outcome == Outcome::NoCornerContact => {
                format!("No corner contact: {}; no impact.", without_contact(solution))
            }
            _ => format!("No {label} between D and E; {}n shows the reason.", self.0.leave()),
        })
    }
}

/// A visible chart with all that is drawn in its area.
struct Shown<'a> {
    title: String,
    /// Why the active method has no curve.
    missing: Option<String>,
    chart: Option<Cow<'a, Chart>>,
    spans: (Span, Span),
    looks: Vec<SeriesLook>,
    /// Further words of the legend.
    words: Vec<Words>,
    /// Least width of the labels beside the plot.
    margin: u16,
    is_compared: bool,
    /// Names on the x axis.
    marks: Vec<(f64, &'static str, Style)>,
    /// The cursor, on a map with its height.
    cursor: Option<(f64, Option<f64>)>,
}

impl Shown<'_> {
    /// Draws the reason and the chart below it.
    fn draw(self, charts: Charts<'_>, area: Rect, buffer: &mut Buffer) -> Plot {
        let theme = charts.0.look.theme;
        let missing = self.missing.unwrap_or_default();
        let lines = text::wrap(&missing, usize::from(area.width).saturating_sub(2)).len();
        text::draw_words(&missing, area, buffer);
        let rows = if missing.is_empty() { 0 } else { (lines as u16).min(area.height) };
        let area = Rect { y: area.y + rows, height: area.height - rows, ..area };
        let Some(chart) = &self.chart else { return Plot::new(Rect::ZERO, 0, self.spans) };
        let Shown { looks, words, is_compared, .. } = self;
        let drawn = TerminalChart { chart, looks, words, is_compared, theme };
        let plot = drawn.draw(area, self.spans, self.margin, buffer);
        if plot.cells.is_empty() {
            return plot;
        }
        for (x, name, style) in self.marks {
            plot.draw_mark(x, name, style, buffer);
        }
        match self.cursor {
            Some((x, Some(y))) => plot.draw_cursor_at((x, y), theme, buffer),
            Some((x, None)) => plot.draw_cursor(x, theme, buffer),
            None => (),
        }
        plot
    }
}

/// Draws the charts below their titles. Returns their plots.
pub(crate) fn draw(charts: Charts<'_>, buffer: &mut Buffer) -> Vec<Plot> {
    let all: Vec<Shown> = match charts.0.chart.own_axes() {
        Some(of) => vec![charts.of_own(of)],
        None => charts.shown().into_iter().map(|graph| charts.of_graph(graph)).collect(),
    };
    let areas = Layout::vertical(vec![Constraint::Fill(1); all.len()]).split(charts.area());
    let stale = if charts.0.tab.shows_last_valid() { "LAST VALID, " } else { "" };
    let draw = |(at, (shown, area)): (usize, (Shown, &Rect))| {
        let inner = if at == 0 {
            let title = format!("{stale}{}", shown.title);
            charts.0.draw_title(Pane::Chart, &title, buffer).intersection(*area)
        } else {
            let theme = charts.0.look.theme;
            let title = text::titled(None, &shown.title, theme.title, area.width, theme);
            text::framed(&title, *area, buffer)
        };
        shown.draw(charts, inner, buffer)
    };
    all.into_iter().zip(areas.iter()).enumerate().map(draw).collect()
}

/// The plots of the visible charts.
fn plots(charts: Charts<'_>) -> Vec<Plot> {
    if charts.area().is_empty() {
        return Vec::new();
    }
    draw(charts, &mut Buffer::empty(charts.area()))
}

/// The width of the visible chart in columns, or of a default chart if none is visible.
pub(crate) fn columns(charts: Charts<'_>) -> u16 {
    let columns = plots(charts).first().map_or(0, |plot| plot.cells.width);
    if columns > 1 { columns } else { USUAL_COLUMNS }
}

/// The driver's roll angle before E at a cell of a plot, in rad, with the place along the face, in m.
pub(crate) fn cursor_at(charts: Charts<'_>, at: Position) -> Option<(f64, f64)> {
    let plot = plots(charts).into_iter().find(|plot| plot.cells.contains(at))?;
    let angle = plot.value(at.x).to_radians();
    let pattern = charts.shown_pattern();
    let (ahead, z) = pattern.as_ref().map_or((0.0, charts.0.chart.z), |pattern| {
        let unit = units::factor(charts.0.settings.units.unit("mm")).unwrap_or(1.0);
        let z = pattern.beside(unit * plot.height(at.y), 0);
        (pattern.ahead(z), z)
    });
    let is_angle = charts.0.chart.own_axes().is_none() || pattern.is_some();
    (is_angle && angle.is_finite()).then_some((ahead - angle, z))
}

/// The marks of the contact: E; D; the last contact L; B, the end of the path of contact; D of the
/// other methods.
fn marks(charts: Charts<'_>) -> Vec<(f64, &'static str, Style)> {
    let (Some(answer), theme) = (charts.answer(), charts.0.look.theme) else {
        return Vec::new();
    };
    let own = charts.solution().map(|solution| {
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
    let others = others.filter(|(method, _)| charts.shows_beside(*method));
    let others = others.filter_map(|(_, found)| found.as_ref().ok());
    let others = others.map(|solution| (first_contact(solution), "d", theme.other));
    let all = own.into_iter().flatten().chain(others);
    all.filter_map(|(angle, name, style)| Some((0.0 - angle?.to_degrees(), name, style))).collect()
}
