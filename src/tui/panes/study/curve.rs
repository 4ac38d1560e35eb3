//! A quantity over one field: the methods overlaid, the baseline behind them, gaps where there is
//! no contact.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;

use super::{NO_CONTACT, REFUSED, StudyPane, cursor, range};
use crate::case::FIELDS;
use crate::case::units;
use crate::model::Outcome;
use crate::report::chart::{Axis, Chart, Kind, Labels, Series, Span};
use crate::report::charts::pieces;
use crate::report::common_unit;
use crate::study::axis::Axis as StudyAxis;
use crate::study::batch::PointOutcome;
use crate::tui::panes::chart::curves::sign_of;
use crate::tui::panes::plot::TerminalChart;
use crate::tui::study::{Layer, LayerFound, StudyParameters, StudyResults};

pub(super) fn draw(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    axis: &StudyAxis,
    area: Rect,
    buffer: &mut Buffer,
) {
    let (StudyParameters::Grid(grid), Some(known)) = (&shown.request.parameters, shown.quantity())
    else {
        return;
    };
    let theme = pane.look.theme;
    let all = || shown.layers.iter().flat_map(|found| found.values.iter().flatten().copied());
    let factor = units::factor(common_unit(known, all(), pane.units)).unwrap_or(1.0);
    // The active method is first, on top.
    let curve = |(at, (layer, found)): (usize, (&Layer, &LayerFound))| {
        let series = series(layer.name().to_owned(), axis, &found.values, factor);
        let look = match (at, layer.is_baseline) {
            (0, _) => (pane.marker, theme.active),
            (_, true) => (Marker::Custom('+'), theme.baseline),
            (_, false) => (sign_of(layer.inputs.method), theme.other),
        };
        (at == 0 || !series.pieces.is_empty()).then_some((series, look))
    };
    let layers = grid.layers.iter().zip(&shown.layers).enumerate();
    let (series, looks) = layers.filter_map(curve).unzip();
    let chart = Chart { across: across(axis, ""), series, ..Chart::default() };
    let mut words = vec![("● now".to_owned(), theme.focus), ("▴ cursor".to_owned(), theme.focus)];
    let has = |sought| shown.layers.iter().any(|found| found.outcomes.contains(&sought));
    let signs = [
        (PointOutcome::Solved(Outcome::NoCornerContact), NO_CONTACT, "no contact"),
        (PointOutcome::Refused, REFUSED, "refused"),
    ];
    let found = signs.iter().filter(|(outcome, ..)| has(*outcome));
    words.extend(found.map(|(_, sign, name)| (format!("{sign} {name}"), theme.note)));
    let last = x(axis, axis.points.len().saturating_sub(1));
    let span = Span::new(x(axis, 0), last);
    let half = if span.is_empty() { 0.5 } else { 0.0 };
    let span = Span::new(span.from - half, span.to + half);
    let up = Span::of(all().map(|value| value / factor)).axis();
    let drawn = TerminalChart { chart: &chart, looks, words, is_compared: false, theme };
    let plot = drawn.draw(area, (span, up), 0, buffer);
    if plot.cells.is_empty() {
        return;
    }
    // Signs where the active method has no value: no contact, or refused.
    let own = shown.layers.first().map(|found| found.outcomes.iter().zip(&found.values));
    for (at, (outcome, value)) in own.into_iter().flatten().enumerate() {
        let sign = signs.iter().find(|(known, ..)| known == outcome && value.is_none());
        if let (Some((_, sign, _)), Some(column)) = (sign, plot.column(x(axis, at))) {
            buffer.set_string(column, plot.cells.bottom() - 1, sign, theme.note);
        }
    }
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == known.key);
    if let Some(limit) = limit.filter(|limit| limit.of.is_none()) {
        plot.draw_level(limit.value / factor, "╌", theme.rule, buffer);
    }
    let nearest = || range::nearest(axis, pane.case).map(|at| x(axis, at));
    if let Some(present) = range::present(axis, pane.case).or_else(nearest) {
        plot.draw_upright(present, "│", theme.faint, buffer);
        if let Some(value) = pane.present {
            plot.draw_point((present, value / factor), "●", theme.focus, buffer);
        }
    }
    plot.draw_cursor(x(axis, cursor(pane, shown).0), theme, buffer);
}

/// Greatest number of curves of a picture of a map.
const MOST_CURVES: usize = 8;

/// The picture of the shown curves; of a map, curves over the first field for values of the second.
#[must_use]
pub(crate) fn picture(pane: &StudyPane<'_>) -> Option<Chart> {
    let shown = pane.study.shown.as_ref().filter(|_| pane.study.obstacle.is_none())?;
    let StudyParameters::Grid(grid) = &shown.request.parameters else { return None };
    let (known, axis) = (shown.quantity()?, grid.axes.last()?);
    let layers = grid.layers.iter().zip(&shown.layers);
    let named: Vec<(String, &[Option<f64>])> = match grid.axes.as_slice() {
        [up, _] => {
            let rows = shown.layers.first()?.values.chunks(axis.points.len()).enumerate();
            let step = up.points.len().div_ceil(MOST_CURVES);
            rows.step_by(step).map(|(at, row)| (up.with_unit(at), row)).collect()
        }
        _ => layers.map(|(of, found)| (of.name().to_owned(), &found.values[..])).collect(),
    };
    let values = named.iter().flat_map(|(_, values)| values.iter().flatten().copied());
    let unit = common_unit(known, values, pane.units);
    let factor = units::factor(unit).unwrap_or(1.0);
    let curves = named.into_iter().map(|(name, values)| series(name, axis, values, factor));
    let series: Vec<Series> = curves.filter(|series| !series.pieces.is_empty()).collect();
    let (field, label) = (FIELDS[axis.field].full_label(), known.label.trim());
    (!series.is_empty()).then(|| Chart {
        title: format!("{label} over {field}"),
        across: across(axis, &field),
        up: Axis::new(format!("{label} {}", known.symbol), units::named(unit)),
        series,
        ..Chart::default()
    })
}

fn series(name: String, axis: &StudyAxis, values: &[Option<f64>], factor: f64) -> Series {
    let points = values.iter().enumerate();
    let points = points.map(|(at, value)| (x(axis, at), value.map(|value| value / factor)));
    let pieces = pieces(points, if is_joined(axis) { f64::INFINITY } else { 0.0 });
    Series { name, pieces, kind: Kind::Curve }
}

/// The horizontal axis of a chart; choices have their names.
fn across(axis: &StudyAxis, name: &str) -> Axis {
    let names = axis.points.iter().enumerate().map(|(at, point)| (x(axis, at), point.text.clone()));
    let labels = if is_joined(axis) { Labels::new() } else { names.collect() };
    Axis { labels, ..Axis::new(name, axis.unit.clone()) }
}

/// Whether the points are numbers, which a line joins.
fn is_joined(axis: &StudyAxis) -> bool {
    axis.points.iter().all(|point| point.number.is_some())
}

/// The position of a point on the axis: its number, or the index of a choice.
fn x(axis: &StudyAxis, at: usize) -> f64 {
    axis.points.get(at).and_then(|point| point.number).unwrap_or(at as f64)
}
