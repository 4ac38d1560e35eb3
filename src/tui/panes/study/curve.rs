//! A quantity over one field: the methods overlaid, the baseline behind them, gaps where there is
//! no contact.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;

use super::{NO_CONTACT, REFUSED, StudyPane, cursor, range};
use crate::case::units;
use crate::model::Outcome;
use crate::report::chart::{Axis, Chart, Kind, Labels, Series, Span};
use crate::report::charts::pieces;
use crate::report::common_unit;
use crate::study::axis::Axis as StudyAxis;
use crate::study::batch::PointOutcome;
use crate::tui::panes::chart::curves::sign_of;
use crate::tui::panes::plot::{Look, TerminalChart};
use crate::tui::study::{Layer, LayerFound, LayerSource, StudyParameters, StudyResults};

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
    let is_joined = axis.points.iter().all(|point| point.number.is_some());
    let curve = |(layer, found): (&Layer, &LayerFound)| {
        let points = found.values.iter().enumerate();
        let points = points.map(|(at, value)| (x(axis, at), value.map(|value| value / factor)));
        let pieces = pieces(points, if is_joined { f64::INFINITY } else { 0.0 });
        let is_shown = !pieces.is_empty() || matches!(layer.source, LayerSource::Active(_));
        let series = Series { name: layer.source.name().to_owned(), pieces, kind: Kind::Curve };
        is_shown.then(|| (series, look(pane, layer.source)))
    };
    // The active method is first, on top.
    let (series, looks) = grid.layers.iter().zip(&shown.layers).filter_map(curve).unzip();
    let names = axis.points.iter().enumerate().map(|(at, point)| (x(axis, at), point.text.clone()));
    let labels = if is_joined { Labels::new() } else { names.collect() };
    let chart = Chart {
        across: Axis { labels, ..Axis::new("", axis.unit.clone()) },
        series,
        ..Chart::default()
    };
    let mut words = vec![("● now".to_owned(), theme.focus), ("▴ cursor".to_owned(), theme.focus)];
    let has = |sought| shown.layers.iter().any(|found| found.outcomes.contains(&sought));
    let signs = [
        (PointOutcome::Solved(Outcome::NoCornerContact), NO_CONTACT, "no contact"),
        (PointOutcome::Refused, REFUSED, "refused"),
    ];
    let found = signs.iter().filter(|(outcome, ..)| has(*outcome));
    words.extend(found.map(|(_, sign, name)| (format!("{sign} {name}"), theme.note)));
    let last = x(axis, axis.points.len().saturating_sub(1));
    let across = Span::new(x(axis, 0), last);
    let half = if across.is_empty() { 0.5 } else { 0.0 };
    let across = Span::new(across.from - half, across.to + half);
    let up = Span::of(all().map(|value| value / factor)).axis();
    let drawn = TerminalChart { chart: &chart, looks, words, is_compared: false, theme };
    let plot = drawn.draw(area, (across, up), 0, buffer);
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

/// The position of a point on the axis: its number, or the index of a choice.
fn x(axis: &StudyAxis, at: usize) -> f64 {
    axis.points.get(at).and_then(|point| point.number).unwrap_or(at as f64)
}

/// The marker and the style of a curve.
fn look(pane: &StudyPane<'_>, source: LayerSource) -> Look {
    let theme = pane.look.theme;
    match source {
        LayerSource::Active(_) => (pane.marker, theme.active),
        LayerSource::Baseline => (Marker::Custom('+'), theme.baseline),
        LayerSource::Other(method) => (sign_of(method), theme.other),
    }
}
