//! A chart with its own axes, as `plot` draws it: bars of harmonics, curves over speed or radius.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use unicode_width::UnicodeWidthStr;

use super::Charts;
use crate::report::svg::{Chart, Kind, Series};
use crate::tui::jobs::WorkerChart;
use crate::tui::panes::plot::{PlotArea, Span, draw_axes, put_where_free};
use crate::tui::text;

/// The smallest plot.
const LEAST: (u16, u16) = (12, 2);
/// Least distance of labels below the plot, in columns.
const LABEL_ROOM: u16 = 12;
/// Width of the bars of a whole number; 1 is the distance of two numbers.
const BARS: f64 = 0.7;

/// The title: the chart and its axes.
pub(super) fn title(charts: &Charts, chart: WorkerChart, room: usize) -> String {
    let state = match (charts.is_stale, charts.work.is_running) {
        (true, _) => "LAST VALID, ",
        (false, true) => "computing: ",
        (false, false) => "",
    };
    let Some(drawn) = charts.work.drawn(chart) else {
        return text::cut(&format!("{state}{}", chart.label()), room);
    };
    let (up, across) = (&drawn.up.label, &drawn.across.label);
    let whole = format!("{state}{}: {up} over {across}", drawn.title);
    let short = chart.short_titles().iter();
    let short: Vec<String> = short.map(|title| format!("{state}{title}")).collect();
    let titles: Vec<&String> = std::iter::once(&whole).chain(&short).collect();
    let fitting = titles.iter().find(|title| title.width() <= room);
    let shortest = titles.last().copied().unwrap_or(&whole);
    fitting.map_or_else(|| text::cut(shortest, room), |title| (*title).clone())
}

/// Draws the chart below its title.
pub(super) fn draw(charts: &Charts, chart: WorkerChart, buffer: &mut Buffer) {
    let area = charts.area;
    if area.height < 2 {
        return;
    }
    let inner = Rect { y: area.y + 1, height: area.height - 1, ..area };
    let Some(drawn) = charts.work.drawn(chart) else {
        let words = charts.work.missing(chart);
        let room = usize::from(inner.width.saturating_sub(3));
        let lines = text::wrap(&words, room);
        for (line, y) in lines.iter().zip(inner.top()..inner.bottom()) {
            buffer.set_stringn(inner.x + 2, y, line, room, Style::new());
        }
        return;
    };
    let is_compared = matches!(chart, WorkerChart::ToothCompliance(_));
    if let Some(plot) = Plot::of(charts, &drawn, inner) {
        plot.draw(is_compared, buffer);
    }
}

/// The names of the curves with their signs, each with its column and its row.
type Legend = Vec<(String, (u16, u16))>;

/// A chart with its axes on the screen.
struct Plot<'a> {
    charts: &'a Charts<'a>,
    chart: &'a Chart,
    legend: Legend,
    area: PlotArea,
    labels: Vec<(f64, String)>,
}

impl<'a> Plot<'a> {
    /// `None` if there is no room.
    fn of(charts: &'a Charts<'a>, chart: &'a Chart, inner: Rect) -> Option<Plot<'a>> {
        let legend = legend(charts, chart, inner);
        let rows = legend.last().map_or(0, |(_, (_, y))| y + 1 - inner.y);
        let upright = Span::default().refit(ordinates(chart));
        let ticks = upright.ticks(inner.height.saturating_sub(2) / 2);
        let labels: Vec<(f64, String)> = ticks.labelled;
        let widest = labels.iter().map(|(_, label)| label.width()).max();
        let margin = widest.unwrap_or(0) as u16 + 3;
        let cells = Rect {
            x: inner.x + margin,
            y: inner.y + rows,
            width: inner.width.saturating_sub(margin + 2),
            height: inner.height.saturating_sub(rows + 2),
        };
        let has_room = cells.width >= LEAST.0 && cells.height >= LEAST.1;
        has_room.then(|| Plot {
            charts,
            chart,
            legend,
            area: PlotArea { cells, across: across(chart), upright },
            labels,
        })
    }

    /// Draws the chart; compared curves share the cells that several of them cross, otherwise the
    /// first curve is on top.
    fn draw(&self, is_compared: bool, buffer: &mut Buffer) {
        self.frame(buffer);
        for (at, series) in self.chart.series.iter().enumerate().rev() {
            if let Kind::Bars(slot, slots) = series.kind {
                self.bars(at, series, (slot, slots), buffer);
            }
        }
        self.curves(is_compared, buffer);
        for (at, series) in self.chart.series.iter().enumerate() {
            if matches!(series.kind, Kind::Marks(_)) {
                self.points(at, series, buffer);
            }
        }
        self.marks(buffer);
        self.legend(buffer);
    }

    fn frame(&self, buffer: &mut Buffer) {
        let (cells, rule) = (self.area.cells, self.charts.look.theme.rule);
        let (left, bottom) = draw_axes(cells, rule, buffer);
        for (value, label) in &self.labels {
            let y = self.area.row(*value);
            buffer.set_string(left, y, "┤", rule);
            let start = left.saturating_sub(1 + label.width() as u16);
            buffer.set_string(start, y, label, Style::new());
        }
        let ticks = self.area.across.ticks(cells.width / LABEL_ROOM);
        let is_whole = |value: f64| (value - value.round()).abs() < 1e-9;
        let has_bars = self.chart.series.iter().any(is_bars);
        for (value, label) in ticks.labelled {
            let Some(column) = self.area.column(value).filter(|_| !has_bars || is_whole(value))
            else {
                continue;
            };
            let label = if ticks.power == 0 { label } else { format!("{value}") };
            let start = column.saturating_sub(label.width() as u16 / 2);
            if start + label.width() as u16 <= cells.right() + 2 {
                buffer.set_string(column, bottom, "┴", rule);
                buffer.set_string(start, bottom + 1, &label, Style::new());
            }
        }
    }

    fn bars(&self, at: usize, series: &Series, (slot, slots): (usize, usize), buffer: &mut Buffer) {
        let (sign, style) = (self.sign(at), self.style(at));
        let width = BARS / slots as f64;
        for (x, y) in series.pieces.iter().flatten() {
            let from = x - BARS / 2.0 + width * slot as f64;
            let (Some(from), Some(to)) = (self.area.column(from), self.area.column(from + width))
            else {
                continue;
            };
            let bottom = self.area.row(0.0).min(self.area.cells.bottom() - 1);
            // The lowest row is the row of 0: a bar that rounds to 0 has no height.
            let top = Some(self.area.row(*y)).filter(|&top| top < bottom);
            for column in from..to.max(from + 1) {
                for row in top.into_iter().flat_map(|top| top..=bottom) {
                    buffer.set_string(column, row, &sign, style);
                }
            }
        }
    }

    fn curves(&self, is_compared: bool, buffer: &mut Buffer) {
        let series = self.chart.series.iter().enumerate().rev();
        let curves = series.filter(|(_, series)| matches!(series.kind, Kind::Curve | Kind::Bound));
        let curves = curves.map(|(at, series)| {
            let marker = match at {
                0 if !self.charts.look.ascii => self.charts.marker,
                _ => Marker::Custom(self.sign(at).chars().next().unwrap_or('+')),
            };
            (series.pieces.clone(), (marker, self.style(at)))
        });
        let curves: Vec<_> = curves.collect();
        if is_compared {
            self.area.draw_compared(&curves, buffer);
        } else {
            for (pieces, look) in &curves {
                self.area.draw_pieces(pieces, *look, buffer);
            }
        }
    }

    fn points(&self, at: usize, series: &Series, buffer: &mut Buffer) {
        for (x, y) in series.pieces.iter().flatten() {
            if let Some(column) = self.area.column(*x) {
                buffer.set_string(column, self.area.row(*y), self.sign(at), self.style(at));
            }
        }
    }

    /// Draws the marks of the axis: a vertical line with the name at its top.
    fn marks(&self, buffer: &mut Buffer) {
        let theme = self.charts.look.theme;
        let mut free = self.area.cells.x;
        for (x, name) in &self.chart.marks {
            let Some(column) = self.area.column(*x) else {
                continue;
            };
            for y in self.area.cells.top()..self.area.cells.bottom() {
                put_where_free((column, y), "┊", theme.faint, buffer);
            }
            let width = name.width() as u16;
            let start = column.saturating_sub(width / 2).max(free);
            if start + width <= self.area.cells.right() + 2 {
                buffer.set_string(start, self.area.cells.y, name, theme.focus);
                free = start + width + 1;
            }
        }
    }

    fn legend(&self, buffer: &mut Buffer) {
        for (at, (words, (x, y))) in self.legend.iter().enumerate() {
            buffer.set_string(*x, *y, words, self.style(at));
        }
    }

    fn style(&self, at: usize) -> Style {
        let theme = self.charts.look.theme;
        match self.chart.series.get(at).map(|series| series.kind) {
            Some(Kind::Marks(_)) => theme.note,
            _ if at == 0 => theme.active,
            _ => theme.other,
        }
    }

    fn sign(&self, at: usize) -> String {
        sign(self.chart, at, self.charts.look.ascii).to_owned()
    }
}

/// The places of the names, in as many rows as they need.
fn legend(charts: &Charts, chart: &Chart, inner: Rect) -> Legend {
    let mut at = (inner.x + 1, inner.y);
    let places = chart.series.iter().enumerate().map(|(index, series)| {
        let sign = match series.kind {
            Kind::Curve | Kind::Bound if index == 0 && !charts.look.ascii => "━",
            _ => sign(chart, index, charts.look.ascii),
        };
        let name = series.name.split(',').next().unwrap_or_default();
        let missing = if series.pieces.is_empty() { " (no value)" } else { "" };
        let room = usize::from(inner.width.saturating_sub(2));
        let words = text::cut(&format!("{sign} {name}{missing}"), room);
        let width = words.width() as u16;
        if at.0 > inner.x + 1 && at.0 + width >= inner.right() {
            at = (inner.x + 1, at.1 + 1);
        }
        let place = at;
        at.0 += width + 2;
        (words, place)
    });
    places.collect()
}

/// The sign of a series in the plot and in the legend.
fn sign(chart: &Chart, at: usize, is_ascii: bool) -> &'static str {
    let signs = match (chart.series.get(at).map(|series| series.kind), at) {
        (Some(Kind::Bars(..)), 0) => ["█", "#"],
        (Some(Kind::Bars(..)), _) => ["▒", "="],
        (Some(Kind::Marks(_)), _) | (_, 2) => ["×", "x"],
        (_, 0) => ["*", "*"],
        (_, 3) => ["∘", "o"],
        _ => ["+", "+"],
    };
    signs[usize::from(is_ascii)]
}

fn is_bars(series: &Series) -> bool {
    matches!(series.kind, Kind::Bars(..))
}

/// The range of the horizontal axis: the points and, for bars, half a number at each end.
fn across(chart: &Chart) -> Span {
    let half = if chart.series.iter().any(is_bars) { 0.5 } else { 0.0 };
    let marks = chart.marks.iter().map(|(x, _)| *x);
    let points = chart.series.iter().flat_map(|series| series.pieces.iter().flatten());
    let all = points.map(|(x, _)| *x).chain(marks);
    let span = all.fold(Span::NONE, Span::with);
    Span::new(span.from - half, span.to + half)
}

/// The range of the values, with 0 for bars.
fn ordinates(chart: &Chart) -> Span {
    let points = chart.series.iter().flat_map(|series| series.pieces.iter().flatten());
    let start = if chart.series.iter().any(is_bars) { Span::NONE.with(0.0) } else { Span::NONE };
    points.fold(start, |span, (_, y)| span.with(*y))
}
