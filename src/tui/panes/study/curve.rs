//! A quantity over one field: the methods overlaid, the baseline behind them, gaps where there is
//! no contact.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use unicode_width::UnicodeWidthStr;

use super::{NO_CONTACT, REFUSED, Rooms, StudyPane, cursor, range};
use crate::model::Outcome;
use crate::model::inputs::Method;
use crate::report::common_unit;
use crate::study::axis::Axis;
use crate::study::batch::PointOutcome;
use crate::tui::panes::plot::{PlotArea, Span, draw_axes, put_where_free};
use crate::tui::study::{Layer, LayerFound, LayerSource, StudyParameters, StudyResults};

/// The smallest plot.
const LEAST: (u16, u16) = (12, 2);
/// Least distance of labels below the plot, in columns.
const LABEL_ROOM: u16 = 10;

/// A plot with its axes.
struct Plot<'a> {
    pane: &'a StudyPane<'a>,
    shown: &'a StudyResults,
    axis: &'a Axis,
    area: PlotArea,
    factor: f64,
}

pub(super) fn draw(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    axis: &Axis,
    rooms: &Rooms,
    buffer: &mut Buffer,
) {
    let StudyParameters::Grid(grid) = &shown.request.parameters else {
        return;
    };
    let layers: Vec<(&Layer, &LayerFound)> = grid.layers.iter().zip(&shown.layers).collect();
    draw_legend(pane, &layers, rooms.legend, buffer);
    let all = || layers.iter().flat_map(|(_, found)| found.values.iter().flatten().copied());
    let Some(known) = shown.quantity() else {
        return;
    };
    let unit = common_unit(known, all(), pane.units);
    let factor = crate::case::units::factor(unit).unwrap_or(1.0);
    let values = all().fold(Span::NONE, |span, value| span.with(value / factor));
    let upright = Span::default().refit(values);
    let ticks = upright.ticks(rooms.plot.height.saturating_sub(1) / 2);
    let margin = ticks.labelled.iter().map(|(_, label)| label.len()).max().unwrap_or(0) as u16 + 3;
    let cells = Rect {
        x: rooms.plot.x + margin,
        width: rooms.plot.width.saturating_sub(margin + 2),
        height: rooms.plot.height.saturating_sub(2),
        ..rooms.plot
    };
    if cells.width < LEAST.0 || cells.height < LEAST.1 {
        return;
    }
    let plot =
        Plot { pane, shown, axis, area: PlotArea { cells, across: across(axis), upright }, factor };
    plot.frame(&ticks.labelled, buffer);
    // The active method is drawn last, on top.
    for (layer, found) in layers.iter().rev() {
        plot.curve(layer, found, buffer);
    }
    if let Some((_, found)) = layers.first() {
        plot.gaps(found, buffer);
    }
    plot.marks(buffer);
}

/// The range of the axis: numbers, or indices of choices.
fn across(axis: &Axis) -> Span {
    let last = axis.points.len().saturating_sub(1);
    let span = Span::new(x(axis, 0), x(axis, last));
    if span.is_empty() { Span::new(span.from - 0.5, span.to + 0.5) } else { span }
}

/// The position of a point on the axis.
fn x(axis: &Axis, at: usize) -> f64 {
    axis.points.get(at).and_then(|point| point.number).unwrap_or(at as f64)
}

impl Plot<'_> {
    fn frame(&self, ticks: &[(f64, String)], buffer: &mut Buffer) {
        let (cells, rule) = (self.area.cells, self.pane.look.theme.rule);
        let (left, bottom) = draw_axes(cells, rule, buffer);
        for (value, label) in ticks {
            let y = self.area.row(*value);
            buffer.set_string(left, y, "┤", rule);
            buffer.set_string(left - 1 - label.len() as u16, y, label, Style::new());
        }
        let mut free = cells.x.saturating_sub(1);
        for (value, label) in self.labels() {
            let Some(column) = self.area.column(value) else {
                continue;
            };
            let width = label.width() as u16;
            let start = column.saturating_sub(width / 2);
            let start = start.min((cells.right() + 2).saturating_sub(width));
            // The first label may begin right of its centred position.
            let start = start.max(free.min(column));
            if start >= free {
                buffer.set_string(column, bottom, "┴", rule);
                buffer.set_string(start, bottom + 1, &label, Style::new());
                free = start + width + 1;
            }
        }
    }

    /// The labels below the plot: multiples of 1, 2 or 5, or the names of choices.
    fn labels(&self) -> Vec<(f64, String)> {
        if self.axis.points.iter().any(|point| point.number.is_none()) {
            let names = self.axis.points.iter().enumerate();
            return names.map(|(at, point)| (x(self.axis, at), point.text.clone())).collect();
        }
        let ticks = self.area.across.ticks(self.area.cells.width / LABEL_ROOM);
        let plain = |(value, label): (f64, String)| {
            let is_scaled = ticks.power != 0;
            let number = crate::numeric::decimal::significant(value, 6);
            let shortest = number.parse::<f64>().map_or(number, |number| number.to_string());
            (value, if is_scaled { shortest } else { label })
        };
        ticks.labelled.into_iter().map(plain).collect()
    }

    fn curve(&self, layer: &Layer, found: &LayerFound, buffer: &mut Buffer) {
        let is_joined = self.axis.points.iter().all(|point| point.number.is_some());
        let points = found.values.iter().enumerate();
        let points: Vec<Option<(f64, f64)>> =
            points.map(|(at, value)| Some((x(self.axis, at), (*value)? / self.factor))).collect();
        let pieces = points.chunk_by(|one, other| is_joined && one.is_some() && other.is_some());
        let pieces: Vec<Vec<(f64, f64)>> =
            pieces.map(|piece| piece.iter().copied().flatten().collect()).collect();
        let look = look(self.pane, layer.source);
        self.area.draw_pieces(&pieces, look, buffer);
    }

    /// Draws signs on the axis where the active method has no value: no contact, or refused.
    fn gaps(&self, found: &LayerFound, buffer: &mut Buffer) {
        for (at, outcome) in found.outcomes.iter().enumerate() {
            let sign = match outcome {
                PointOutcome::Refused => REFUSED,
                PointOutcome::Solved(Outcome::NoCornerContact) if found.values[at].is_none() => {
                    NO_CONTACT
                }
                PointOutcome::Solved(_) => continue,
            };
            if let Some(column) = self.area.column(x(self.axis, at)) {
                let style = self.pane.look.theme.note;
                buffer.set_string(column, self.area.cells.bottom() - 1, sign, style);
            }
        }
    }

    /// Draws the limit, the present value and the cursor.
    fn marks(&self, buffer: &mut Buffer) {
        let theme = self.pane.look.theme;
        let limit =
            self.limit().filter(|limit| (0.0..=1.0).contains(&self.area.upright.part(*limit)));
        if let Some(limit) = limit {
            for x in self.area.cells.left()..self.area.cells.right() {
                put_where_free((x, self.area.row(limit)), "╌", theme.rule, buffer);
            }
        }
        let present = match range::present(self.axis, self.pane.case) {
            Some(number) => Some(number),
            None => range::nearest(self.axis, self.pane.case).map(|at| x(self.axis, at)),
        };
        if let Some(column) = present.and_then(|present| self.area.column(present)) {
            for y in self.area.cells.top()..self.area.cells.bottom() {
                put_where_free((column, y), "│", theme.faint, buffer);
            }
            if let Some(value) = self.pane.present {
                let y = self.area.row(value / self.factor);
                buffer.set_string(column, y, "●", theme.focus);
            }
        }
        let (at, _) = cursor(self.pane, self.shown);
        if let Some(column) = self.area.column(x(self.axis, at)) {
            for y in self.area.cells.top()..self.area.cells.bottom() {
                put_where_free((column, y), "┊", theme.faint, buffer);
            }
            buffer.set_string(column, self.area.cells.bottom(), "▴", theme.focus);
        }
    }

    fn limit(&self) -> Option<f64> {
        let key = self.shown.quantity()?.key;
        let limit = self.pane.case.limits.iter().find(|limit| limit.quantity == key)?;
        limit.value.is_finite().then(|| limit.value / self.factor)
    }
}

/// The marker and the style of a curve.
fn look(pane: &StudyPane<'_>, source: LayerSource) -> (Marker, Style) {
    let theme = pane.look.theme;
    let plain = pane.look.ascii;
    match source {
        LayerSource::Active(_) if plain => (Marker::Custom('*'), theme.active),
        LayerSource::Active(_) => (pane.marker, theme.active),
        LayerSource::Baseline => (Marker::Custom('+'), theme.baseline),
        LayerSource::Other(method) => {
            let sign = match method {
                Method::Paper => ['.', '·'],
                Method::Static => ['x', '×'],
                Method::Dynamic => ['d', '◦'],
                Method::Exact | Method::Auto => ['o', '∘'],
            };
            (Marker::Custom(sign[usize::from(!plain)]), theme.other)
        }
    }
}

/// The sign of a curve in the legend.
fn sign(pane: &StudyPane<'_>, source: LayerSource) -> String {
    match look(pane, source).0 {
        Marker::Custom(sign) => sign.to_string(),
        _ => "━".to_owned(),
    }
}

fn draw_legend(
    pane: &StudyPane<'_>,
    layers: &[(&Layer, &LayerFound)],
    area: Rect,
    buffer: &mut Buffer,
) {
    let mut x = area.x + 1;
    let mut put = |words: &str, style: Style| {
        let width = words.width() as u16;
        if !area.is_empty() && x + width < area.right() {
            buffer.set_string(x, area.y, words, style);
            x += width + 2;
        }
    };
    for (layer, found) in layers {
        if found.values.iter().all(Option::is_none)
            && !matches!(layer.source, LayerSource::Active(_))
        {
            continue;
        }
        let name = match layer.source {
            LayerSource::Active(method) | LayerSource::Other(method) => method.name(),
            LayerSource::Baseline => "baseline",
        };
        let (_, style) = look(pane, layer.source);
        put(&format!("{} {name}", sign(pane, layer.source)), style);
    }
    put("● now", pane.look.theme.focus);
    put("▴ cursor", pane.look.theme.focus);
    let has =
        |sought: PointOutcome| layers.iter().any(|(_, found)| found.outcomes.contains(&sought));
    if has(PointOutcome::Solved(Outcome::NoCornerContact)) {
        put(&format!("{NO_CONTACT} no contact"), pane.look.theme.note);
    }
    if has(PointOutcome::Refused) {
        put(&format!("{REFUSED} refused"), pane.look.theme.note);
    }
}
