//! The points of a study as curves over one field, as a map over two fields, or as a table.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;

use super::{StudyPane, cursor, range, value_words};
use crate::case::FIELDS;
use crate::case::units;
use crate::model::Outcome;
use crate::report::chart::{Axis, Cell as MapCell, Chart, Kind, Labels, Map, Point, Series, Span};
use crate::report::charts::pieces;
use crate::report::table::{Cell, Column, Table};
use crate::report::{common_unit, shown_with};
use crate::study::axis::Axis as StudyAxis;
use crate::study::batch::PointOutcome;
use crate::tui::panes;
use crate::tui::panes::chart::curves::sign_of;
use crate::tui::panes::plot::{Look, NO_CONTACT, REFUSED, TerminalChart};
use crate::tui::panes::study::{GridParameters, StudyParameters, StudyResults};
use crate::tui::text::symbol;

/// Least width of the labels beside a map.
const MAP_MARGIN: u16 = 7;

/// Draws the curves or the map, with the limit, the present value and the cursor.
pub(super) fn draw(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    grid: &GridParameters,
    area: Rect,
    buffer: &mut Buffer,
) {
    let Some((chart, looks)) = chart(pane, shown, grid) else { return };
    let (theme, is_map) = (pane.look.theme, chart.map.is_some());
    let words = (!is_map).then(|| ("▴ cursor".to_owned(), theme.focus)).into_iter().collect();
    let margin = if is_map { MAP_MARGIN } else { 0 };
    let spans = match grid.axes.as_slice() {
        [axis] => (chart.spans().0.and(ends(axis)), chart.spans().1),
        _ => chart.spans(),
    };
    let drawn = TerminalChart { chart: &chart, looks, words, is_compared: false, theme };
    let plot = drawn.draw(area, spans, margin, buffer);
    let (at, row) = cursor(pane, shown);
    match grid.axes.as_slice() {
        _ if plot.cells.is_empty() => (),
        [axis] => {
            let limit =
                pane.case.limits.iter().find(|limit| shown.quantity() == Some(limit.quantity));
            if let Some(limit) = limit.filter(|limit| limit.of.is_none()) {
                let factor = units::factor(&chart.up.unit).unwrap_or(1.0);
                plot.draw_level(limit.value / factor, "╌", theme.rule, buffer);
            }
            if let Some(present) = present(pane, axis) {
                plot.draw_upright(present, "│", theme.faint, buffer);
            }
            plot.draw_cursor(x(axis, at), theme, buffer);
        }
        _ => plot.draw_cursor_at((at as f64, row as f64), theme, buffer),
    }
}

/// The chart of the shown points as a picture.
#[must_use]
pub(crate) fn picture(pane: &StudyPane<'_>) -> Option<Chart> {
    let shown = pane.study.shown.as_ref().filter(|_| pane.study.obstacle.is_none())?;
    let StudyParameters::Grid(grid) = &shown.request.parameters else { return None };
    let (known, (mut chart, _)) = (shown.quantity()?, chart(pane, shown, grid)?);
    let (label, is_map) = (known.label.trim(), chart.map.is_some());
    let second = if is_map { format!(" and {}", chart.up.name) } else { String::new() };
    chart.title = format!("{label} over {}{second}", chart.across.name);
    if !is_map {
        chart.up.name = format!("{label} {}", known.symbol);
        chart.series.retain(|series| series.kind == Kind::Curve && !series.pieces.is_empty());
    }
    (is_map || !chart.series.is_empty()).then_some(chart)
}

/// The curves or the map of the points, with their looks.
pub(super) fn chart(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    grid: &GridParameters,
) -> Option<(Chart, Vec<Look>)> {
    match grid.axes.as_slice() {
        [axis] => curves(pane, shown, grid, axis),
        [up, across] => map(pane, shown, (across, up)),
        _ => None,
    }
}

/// The methods over each other, the active one on top and the baseline behind them, the present
/// value, and signs where the active method has no value.
fn curves(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    grid: &GridParameters,
    axis: &StudyAxis,
) -> Option<(Chart, Vec<Look>)> {
    let (theme, known) = (pane.look.theme, shown.quantity()?);
    let all = shown.layers.iter().flat_map(|found| found.values.iter().flatten().copied());
    let unit = common_unit(known, all, pane.units);
    let factor = units::factor(unit).unwrap_or(1.0);
    let is_joined = axis.points.iter().all(|point| point.number.is_some());
    let longest = if is_joined { f64::INFINITY } else { 0.0 };
    let mut series: Vec<(Series, Look)> = Vec::new();
    for (at, (layer, found)) in grid.layers.iter().zip(&shown.layers).enumerate() {
        let points = found.values.iter().enumerate();
        let points = points.map(|(at, value)| (x(axis, at), value.map(|value| value / factor)));
        let pieces = pieces(points, longest);
        let look = match (at, layer.is_baseline) {
            (0, _) => (pane.marker, theme.active),
            (_, true) => (Marker::Custom('+'), theme.baseline),
            (_, false) => (sign_of(layer.inputs.method), theme.other),
        };
        if at == 0 || !pieces.is_empty() {
            series
                .push((Series { name: layer.name().to_owned(), pieces, kind: Kind::Curve }, look));
        }
    }
    let mut mark = |name: &str, points: Vec<Point>, look: (char, _)| {
        let pieces = points.into_iter().map(|point| vec![point]).collect();
        let series_of = Series { name: name.to_owned(), pieces, kind: Kind::Marks(None) };
        series.push((series_of, (Marker::Custom(look.0), look.1)));
    };
    let now = present(pane, axis).zip(pane.present).map(|(x, value)| (x, value / factor));
    let now = now.filter(|now| ends(axis).covers(Span::new(now.0, now.0)));
    mark("now", now.into_iter().collect(), ('●', theme.focus));
    let own = shown.layers.first()?;
    for (sought, sign, name) in [
        (PointOutcome::Solved(Outcome::NoCornerContact), NO_CONTACT, "no contact"),
        (PointOutcome::Refused, REFUSED, "refused"),
    ] {
        let points = own.outcomes.iter().zip(&own.values).enumerate();
        let points = points.filter(|(_, (outcome, value))| **outcome == sought && value.is_none());
        // Below every value: at the axis.
        let points: Vec<Point> = points.map(|(at, _)| (x(axis, at), f64::NEG_INFINITY)).collect();
        if !points.is_empty() {
            mark(name, points, (sign, theme.note));
        }
    }
    let names = axis.points.iter().enumerate().map(|(at, point)| (x(axis, at), point.text.clone()));
    let labels = if is_joined { Labels::new() } else { names.collect() };
    let (series, looks) = series.into_iter().unzip();
    let across = Axis { labels, ..field_axis(axis) };
    Some((Chart { across, up: up_axis(shown, unit), series, ..Chart::default() }, looks))
}

/// The cells of a map, by the indices of its points.
fn map(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    (across, up): (&StudyAxis, &StudyAxis),
) -> Option<(Chart, Vec<Look>)> {
    let (theme, known, found) = (pane.look.theme, shown.quantity()?, shown.layers.first()?);
    let all = || found.values.iter().flatten().copied();
    let unit = common_unit(known, all(), pane.units);
    let worded = |value| (value, shown_with(known, value, unit).to_string());
    let cell = |(outcome, value): (&PointOutcome, &Option<f64>)| match (outcome, value) {
        (PointOutcome::Refused, _) => MapCell::Refused,
        (_, Some(value)) => MapCell::Value(*value),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) => MapCell::NoContact,
        (PointOutcome::Solved(_), None) => MapCell::Blank,
    };
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == known);
    let limit = limit.and_then(|limit| limit.bound(|_| None)).filter(|value| value.is_finite());
    let values = Span::of(all());
    let numbers = |axis: &StudyAxis| (0..axis.points.len()).map(|at| at as f64).collect();
    let labelled = |axis: &StudyAxis| {
        let last = axis.points.len().saturating_sub(1);
        let mut points = vec![0, last / 2, last];
        points.dedup();
        let labels = points.into_iter().map(|at| (at as f64, axis.points[at].text.clone()));
        Axis { labels: labels.collect(), ..field_axis(axis) }
    };
    let now = range::nearest(across, pane.case).zip(range::nearest(up, pane.case));
    let now = now.map(|(x, y)| vec![(x as f64, y as f64)]).into_iter().collect();
    let chart = Chart {
        across: labelled(across),
        up: labelled(up),
        series: vec![Series { name: "now".to_owned(), pieces: now, kind: Kind::Marks(None) }],
        map: Some(Map {
            value: up_axis(shown, unit),
            places: [numbers(across), numbers(up)],
            cells: found.outcomes.iter().zip(&found.values).map(cell).collect(),
            ends: (values.from <= values.to).then(|| [values.from, values.to].map(worded)),
            limit: limit.map(|limit| (limit, format!("limit {}", worded(limit).1))),
        }),
        ..Chart::default()
    };
    Some((chart, vec![(Marker::Custom('●'), theme.focus)]))
}

/// The axis of the values.
fn up_axis(shown: &StudyResults, unit: &str) -> Axis {
    let symbol = shown.quantity().map_or("", |known| known.symbol_in(shown.method()));
    Axis::new(symbol, unit)
}

/// The axis of a field without labels.
fn field_axis(axis: &StudyAxis) -> Axis {
    Axis::new(FIELDS[axis.field].full_label(), axis.unit.clone())
}

/// The position of the present case on an axis.
fn present(pane: &StudyPane<'_>, axis: &StudyAxis) -> Option<f64> {
    let nearest = || range::nearest(axis, pane.case).map(|at| x(axis, at));
    range::present(axis, pane.case).or_else(nearest)
}

/// The position of a point on the axis: its number, or the index of a choice.
fn x(axis: &StudyAxis, at: usize) -> f64 {
    axis.points.get(at).and_then(|point| point.number).unwrap_or(at as f64)
}

fn ends(axis: &StudyAxis) -> Span {
    Span::NONE.with(x(axis, 0)).with(x(axis, axis.points.len().saturating_sub(1)))
}

/// Draws the points as a table: the varied fields, then each curve.
pub(super) fn draw_table(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    grid: &GridParameters,
    area: Rect,
    buffer: &mut Buffer,
) {
    let layers = || grid.layers.iter().zip(&shown.layers);
    let curves = layers().filter_map(|(layer, found)| {
        let known = layer.quantity()?;
        let unit = common_unit(known, found.values.iter().flatten().copied(), pane.units);
        let name = format!("{} {}", layer.name(), known.symbol_in(layer.inputs.method));
        Some(Axis::new(name, unit))
    });
    let column = |name: Axis| {
        let title = symbol(&name.in_unit(), pane.look.ascii).into_owned();
        Column::text("", title).to_the_right().wide(2, 0)
    };
    let columns = grid.axes.iter().map(field_axis).chain(curves).map(column).collect();
    let (width, (x, y)) =
        (grid.axes.last().map_or(1, |axis| axis.points.len()), cursor(pane, shown));
    let row = |at: usize| {
        let places = [at / width, at % width];
        let axes = grid.axes.iter().zip(&places[2 - grid.axes.len()..]);
        let fields = axes.map(|(axis, at)| axis.points[*at].text.clone());
        let values = layers().map(|(layer, found)| {
            value_words(layer, found, at, pane.units, false).unwrap_or_default()
        });
        fields.chain(values).map(Cell::from).collect()
    };
    let count: usize = grid.axes.iter().map(|axis| axis.points.len()).product();
    let (marked, rows) = (y * width + x, usize::from(area.height.saturating_sub(1)));
    let top = marked.saturating_sub(rows / 2).min(count.saturating_sub(rows));
    let table = Table::new("", columns).with((top..count.min(top + rows)).map(row));
    panes::draw_table(&table.lines(), Some(marked - top), pane.look.theme, area, buffer);
}
