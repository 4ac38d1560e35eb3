//! The curves of a chart: every method, the baseline, and the comparison value; their values at the
//! cursor, and the visible range of roll angles.

use ratatui::symbols::Marker;

use super::Charts;
use crate::case::units;
use crate::model::compliance::model_of;
use crate::model::contact_state::DIGITS_BETWEEN;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::{Inputs, Interpolated, Solution, Station};
use crate::numeric::decimal::significant;
use crate::report::chart::{Kind, Point, Series, Span};
use crate::report::charts::{curve, pieces};
use crate::report::stations::Column;
use crate::report::stations::{GRAPHS, Graph};
use crate::tui::app::panes::plot::Look;
use crate::tui::solver::Answer;
use crate::tui::text::symbol;

/// Significant digits of the time since E.
const TIME_DIGITS: usize = 4;

/// A value below this fraction of the greatest value of the curve is a rounding error of 0.
const ROUNDING: f64 = 1e-9;

/// The source of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CurveSource {
    /// The active method.
    Active(Method),
    /// Another method.
    Other(Method),
    /// The baseline, by the active method if the baseline has that method.
    Pinned(Method),
    /// The comparison value of the active method's curve.
    Bound(&'static str),
    /// A compliance model.
    Model {
        /// The model.
        model: ToothCompliance,
        /// Whether it is the model of the case.
        is_own: bool,
    },
}

/// A curve in pieces, with gaps between them.
#[derive(Debug, Clone)]
pub struct Curve<'a> {
    /// The source.
    pub source: CurveSource,
    /// The column of the stations.
    pub(crate) column: &'static Column,
    /// The display unit.
    pub(crate) unit: &'static str,
    /// The points from D onwards.
    pub pieces: Vec<Vec<Point>>,
    /// The solve with the stations; `None` for a compliance model.
    solved: Option<(&'a Inputs, &'a Solution)>,
}

impl Curve<'_> {
    /// Whether the curve is one of those that the chart is about.
    pub(crate) fn is_main(&self) -> bool {
        matches!(self.source, CurveSource::Active(_) | CurveSource::Model { .. })
    }

    /// The curve with its name in the legend, and its look.
    pub(crate) fn series(&self, charts: Charts<'_>) -> (Series, Look) {
        let name = match self.source {
            CurveSource::Active(method) => method.name().to_owned(),
            CurveSource::Model { model, is_own: true } => format!("{} (case)", model.name()),
            _ => self.name(charts),
        };
        let theme = charts.0.look.theme;
        let (marker, style) = match self.source {
            CurveSource::Active(_) => (charts.0.settings.marker, theme.active),
            source if is_field(source) => (charts.0.settings.marker, theme.active),
            CurveSource::Other(method) => (sign_of(method), theme.other),
            CurveSource::Model { model, .. } => {
                let is_first = Some(&model) == ToothCompliance::ALL.first();
                (Marker::Custom(if is_first { '×' } else { '∘' }), theme.other)
            }
            CurveSource::Pinned(_) => (Marker::Custom('+'), theme.baseline),
            CurveSource::Bound(_) => (Marker::Custom('╌'), theme.rule),
        };
        let style = if charts.0.tab.shows_last_valid() { style.patch(theme.faint) } else { style };
        (Series { name, pieces: self.pieces.clone(), kind: Kind::Curve }, (marker, style))
    }

    /// The name of the value: the symbol for the active method.
    fn name(&self, charts: Charts<'_>) -> String {
        let active = charts.answer().map(|answer| answer.active);
        match self.source {
            CurveSource::Active(_) => symbol(self.column.symbol, charts.0.look.ascii).into_owned(),
            CurveSource::Bound(bound) => symbol(bound, charts.0.look.ascii).into_owned(),
            CurveSource::Other(method) => method.name().to_owned(),
            CurveSource::Model { model, .. } => model.name().to_owned(),
            CurveSource::Pinned(method) if active == Some(method) => "baseline".to_owned(),
            CurveSource::Pinned(method) => format!("baseline ({})", method.name()),
        }
    }

    /// The least and the greatest value within a range of the angle.
    pub(crate) fn upright_within(&self, window: Span) -> Span {
        let ends = [window.from, window.to].into_iter().filter_map(|x| value_at(&self.pieces, x));
        let points = self.pieces.iter().flatten();
        let inside = points.filter(|(x, _)| (window.from..=window.to).contains(x)).map(|(_, y)| *y);
        Span::of(ends.chain(inside))
    }

    /// The value in SI at the cursor, from the same evaluation as in the teeth pane, not from the
    /// drawn line, with its number of significant digits.
    fn reading(&self, graph: &Graph, cursor: f64) -> Option<(f64, usize)> {
        let column = self.column;
        let Some((inputs, solution)) = self.solved else {
            let value = value_at(&self.pieces, 0.0 - cursor.to_degrees())?;
            return Some((value * units::factor(self.unit).unwrap_or(1.0), column.digits));
        };
        let interpolated = Interpolated::at(inputs, solution, cursor)?;
        let station = &interpolated.station;
        let (value, digits) = match self.source {
            CurveSource::Bound(_) if interpolated.is_between => {
                ((graph.bound?.value)(solution, station)?, DIGITS_BETWEEN)
            }
            CurveSource::Bound(_) => ((graph.bound?.value)(solution, station)?, column.digits),
            _ => {
                let value = column.resolved(column.of(solution, station)?, inputs, solution);
                (value, column.digits_of(&interpolated))
            }
        };
        let most = self.pieces.iter().flatten().map(|(_, y)| y.abs()).fold(0.0, f64::max);
        let is_zero = units::per(value, self.unit).abs() < ROUNDING * most;
        Some((if is_zero { 0.0 } else { value }, digits))
    }
}

/// The value of a curve at a place, interpolated between its points. At a jump, the value after it.
pub(crate) fn value_at(pieces: &[Vec<Point>], x: f64) -> Option<f64> {
    pieces.iter().find_map(|piece| {
        let after = piece.partition_point(|point| point.0 <= x);
        let before = piece.get(after.checked_sub(1)?)?;
        let rounding = 1e-12 * x.abs();
        match piece.get(after) {
            Some(next) => {
                Some(before.1 + (next.1 - before.1) * (x - before.0) / (next.0 - before.0))
            }
            None => (x <= before.0 + rounding).then_some(before.1),
        }
    })
}

impl Charts<'_> {
    /// Whether another method has a curve beside the active one: `paper` only on request.
    pub(super) fn shows_beside(self, method: Method) -> bool {
        method != Method::Paper || self.0.shows_every_method
    }
}

/// Every curve of a chart in drawing order.
pub fn curves<'a>(charts: Charts<'a>, graph: &Graph) -> Vec<Curve<'a>> {
    let Some(answer) = charts.answer() else {
        return Vec::new();
    };
    if let Some(column) = graph.by_model {
        return models(answer, column, charts.0.settings.units.unit(column.shown));
    }
    let of = |answer: &'a Answer, method: Method, source: CurveSource| {
        let (inputs, solution) = (&answer.inputs, answer.of(method)?);
        let column = graph.column(method)?;
        let unit = charts.0.settings.units.unit(column.shown);
        let is_bound = matches!(source, CurveSource::Bound(_));
        let kind = if is_bound { Kind::Bound } else { Kind::Curve };
        let (symbol, pieces) = curve(graph, inputs, solution, (unit, kind))?;
        let source = if is_bound { CurveSource::Bound(symbol) } else { source };
        let solved = Some((inputs, solution));
        (!pieces.is_empty()).then_some(Curve { source, column, unit, pieces, solved })
    };
    let active = answer.active;
    let pinned = charts.pinned().and_then(|baseline| {
        let method = baseline.beside(active);
        of(baseline, method, CurveSource::Pinned(method))
    });
    let others = answer.methods.iter().map(|(method, _)| *method);
    let others = others.filter(|&method| method != active && charts.shows_beside(method));
    let others = others.filter_map(|method| of(answer, method, CurveSource::Other(method)));
    let bound = of(answer, active, CurveSource::Bound(""));
    let own = of(answer, active, CurveSource::Active(active));
    pinned.into_iter().chain(others).chain(bound).chain(own).collect()
}

/// The mesh stiffness by every compliance model: that of the case is last, on top of the others, and
/// that of the finite elements is below it.
fn models<'a>(answer: &Answer, column: &'static Column, unit: &'static str) -> Vec<Curve<'a>> {
    let Some(Ok(found)) = &answer.stiffness else {
        return Vec::new();
    };
    let (factor, own) = (units::factor(unit).unwrap_or(1.0), model_of(&answer.inputs));
    let of_model = |(at, &model): (usize, &ToothCompliance)| {
        let points = found.mesh_curve(at);
        let points = points.map(|(angle, value)| (angle.to_degrees(), Some(value / factor)));
        let pieces = pieces(points, f64::INFINITY);
        let source = CurveSource::Model { model, is_own: model == own };
        Curve { source, column, unit, pieces, solved: None }
    };
    let mut curves: Vec<Curve> = found.models.iter().enumerate().map(of_model).collect();
    curves.retain(|curve| !curve.pieces.is_empty());
    let is_own = |source| matches!(source, CurveSource::Model { is_own: true, .. });
    curves.sort_by_key(|curve| (is_own(curve.source), is_field(curve.source)));
    curves
}

/// Whether it is the curve of the finite elements, which couple neighbouring teeth: the other models
/// are compared with this curve.
pub fn is_field(source: CurveSource) -> bool {
    matches!(source, CurveSource::Model { model, .. } if model.model().has_coupling)
}

/// The sign of a method beside the active one.
pub(crate) fn sign_of(method: Method) -> Marker {
    Marker::Custom(match method {
        Method::Paper => '·',
        Method::Static => '×',
        Method::Dynamic => '◦',
        Method::Exact | Method::Auto => '∘',
    })
}

/// The angle, the visible curves at it, and every other value of the active method.
pub fn readout(charts: Charts<'_>, cursor: f64) -> String {
    let graphs = charts.shown();
    let chosen = if graphs.is_empty() { vec![charts.0.chart.graph()] } else { graphs };
    let values = |graph: usize, is_seen: bool| {
        let (graph, all) = (&GRAPHS[graph], curves(charts, &GRAPHS[graph]));
        let all = all.iter().rev();
        let all = all.filter(|curve| is_seen || matches!(curve.source, CurveSource::Active(_)));
        let readings = all.filter_map(|curve| Some((curve, curve.reading(graph, cursor)?)));
        in_words(charts, &readings.collect::<Vec<_>>())
    };
    let mut parts: Vec<String> = chosen.iter().filter_map(|&graph| values(graph, true)).collect();
    let rest = (0..GRAPHS.len()).filter(|graph| !chosen.contains(graph));
    let rest: Vec<String> = rest.filter_map(|graph| values(graph, false)).collect();
    parts.extend((!rest.is_empty()).then(|| rest.join(", ")));
    let place = place_of_cursor(charts, cursor);
    if parts.is_empty() { format!("{place}.") } else { format!("{place}: {}.", parts.join("; ")) }
}

fn place_of_cursor(charts: Charts<'_>, cursor: f64) -> String {
    if cursor == 0.0 {
        return format!("At {}", charts.entry());
    }
    let side = if cursor < 0.0 { "after" } else { "before" };
    let speed = charts.answer().map_or(0.0, |answer| answer.inputs.speed);
    let micros = 1e6 * cursor.abs() / speed;
    let time = if charts.0.chart.by_time && micros.is_finite() {
        format!(", {} us", significant(micros, TIME_DIGITS))
    } else {
        String::new()
    };
    let angle = cursor.abs().to_degrees();
    format!("{angle:.4} deg of the driver {side} {}{time}", charts.entry())
}

/// Values in SI with their numbers of significant digits, in the unit of the greatest value.
fn in_words(charts: Charts<'_>, readings: &[(&Curve, (f64, usize))]) -> Option<String> {
    let units = readings.iter().map(|(curve, (value, digits))| {
        units::unit_for(value.abs(), curve.column.shown, *digits, charts.0.settings.units)
    });
    let factor = |unit: &&str| units::factor(unit).unwrap_or(1.0);
    let unit = units.max_by(|one, other| factor(one).total_cmp(&factor(other)))?;
    let words = readings.iter().map(|(curve, (value, digits))| {
        let number = units::counted(*value, unit, *digits);
        let value = format!("{number} {}", units::named(unit));
        format!("{} {}", curve.name(charts), value.trim_end())
    });
    Some(words.collect::<Vec<_>>().join(", "))
}

/// The closest zoom, as a fraction of the whole contact.
const CLOSEST: f64 = 1e-3;
/// Distance from the edge, as a fraction of the visible range, of a cursor after it has left the
/// range. Without this distance the charts would scroll with every step of the cursor.
const MARGIN: f64 = 0.25;

/// The roll angles of the charts, in deg after E, negative before E.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scale {
    /// The whole contact.
    pub across: Span,
    /// From D to a little after E; empty without corner contact.
    pub(crate) strike: Span,
}

/// The visible range of roll angles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum ChartView {
    /// The strike if the contact continues after it, otherwise the whole contact.
    #[default]
    Opening,
    /// From D to the end of the contact.
    Whole,
    /// From D to a little after E.
    Strike,
    /// A part, in deg after E.
    Part(Span),
}

impl ChartView {
    /// The visible roll angles, in deg after E.
    pub(crate) fn window(self, scale: &Scale) -> Span {
        let Scale { across, strike } = *scale;
        match self {
            ChartView::Part(part) if !part.is_empty() => part.within(across.and(strike)),
            ChartView::Strike if !strike.is_empty() => strike,
            ChartView::Opening if !strike.is_empty() && strike.to < across.to => strike,
            // Also a part of a chart that had no values.
            _ => across,
        }
    }

    /// The view zoomed in by `steps` of √2 around an angle, or out if `steps` is negative, at most
    /// to the whole contact.
    pub(crate) fn zoomed(self, steps: i32, around: f64, scale: &Scale) -> ChartView {
        let all = scale.across.and(scale.strike);
        let length = self.window(scale).length() * 2f64.powf(-0.5 * f64::from(steps));
        let length = length.max(CLOSEST * all.length());
        if steps < 0 && length >= scale.across.length() * (1.0 - 1e-9) {
            return ChartView::Whole;
        }
        ChartView::around(around, length, scale)
    }

    fn around(middle: f64, length: f64, scale: &Scale) -> ChartView {
        let part = Span::new(middle - 0.5 * length, middle + 0.5 * length);
        ChartView::Part(part.within(scale.across.and(scale.strike)))
    }

    /// Switches between the strike and the whole contact.
    pub(crate) fn strike_or_whole(self, scale: &Scale) -> ChartView {
        let is_strike = self.window(scale) == scale.strike;
        if is_strike { ChartView::Whole } else { ChartView::Strike }
    }

    /// The view, scrolled if necessary to make an angle visible.
    pub(crate) fn following(self, angle: f64, scale: &Scale) -> ChartView {
        let window = self.window(scale);
        let rounding = 1e-9 * window.length();
        if window.is_empty() || (window.from - rounding..=window.to + rounding).contains(&angle) {
            return self;
        }
        let inward = (0.5 - MARGIN) * window.length();
        let middle = if angle > window.to { angle + inward } else { angle - inward };
        ChartView::around(middle, window.length(), scale)
    }
}

/// The driver's angle before E at the last contact, in rad, negative after E. Only `static` and
/// `dynamic` have a last contact.
pub(crate) fn last_contact(solution: &Solution) -> Option<f64> {
    let last = solution.own_stations().last().filter(|station| station.load_share().is_some());
    last.map(|station| station.roll_angle_driver)
}

/// The range of the path of contact with its mesh stiffness, in deg after E.
pub(super) fn path(answer: &Answer) -> Span {
    let Some(Ok(found)) = &answer.stiffness else {
        return Span::NONE;
    };
    Span::of(found.points.iter().map(|point| (point.way / found.base_radius).to_degrees()))
}

/// The range of the stations of a method, in deg after E.
pub(super) fn way(solution: &Solution) -> Span {
    let rows = solution.own_stations();
    let ends = [rows.first(), rows.last()].into_iter().flatten();
    Span::of(ends.map(Station::angle_after_e))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the ends are copied from the axis")]
mod tests {
    use super::*;

    const SCALE: Scale =
        Scale { across: Span { from: -5.0, to: 25.0 }, strike: Span { from: -1.5, to: 0.5 } };

    #[test]
    fn it_opens_on_the_strike_if_the_contact_continues_after_it() {
        let view = ChartView::default();
        assert_eq!(view.window(&SCALE), SCALE.strike);
        let closed_form = Scale { across: Span::new(-1.5, 0.0), ..SCALE };
        assert_eq!(view.window(&closed_form), closed_form.across);
        let no_strike = Scale { strike: Span::default(), ..SCALE };
        assert_eq!(view.window(&no_strike), SCALE.across);
        assert_eq!(view.strike_or_whole(&SCALE).window(&SCALE), SCALE.across);
    }

    #[test]
    fn zooming_out_ends_at_the_whole_contact() {
        let view = ChartView::Whole;
        assert_eq!(view.window(&SCALE), SCALE.across);
        let close = (0..4).fold(view, |view, _| view.zoomed(1, -1.0, &SCALE));
        let window = close.window(&SCALE);
        assert!((window.from + 4.75).abs() + (window.to - 2.75).abs() < 1e-9, "{window:?}");
        assert_eq!((0..4).fold(close, |view, _| view.zoomed(-1, -1.0, &SCALE)), view);
        assert_eq!(view.strike_or_whole(&SCALE).window(&SCALE), SCALE.strike);
        assert_eq!(view.strike_or_whole(&SCALE).strike_or_whole(&SCALE), view);
        assert_eq!(
            (0..9).fold(view.strike_or_whole(&SCALE), |view, _| view.zoomed(-1, 0.0, &SCALE)),
            view
        );
    }

    #[test]
    fn the_closest_zoom_still_shows_a_range() {
        let view = (0..99).fold(ChartView::Whole, |view, _| view.zoomed(1, 25.0, &SCALE));
        let window = view.window(&SCALE);
        assert!(window.length() > 0.02 && window.to == 25.0, "{window:?}");
    }

    #[test]
    fn the_view_follows_the_cursor_and_stays_on_the_axis() {
        let strike = ChartView::default();
        assert_eq!(strike.following(-1.0, &SCALE), strike);
        let moved = strike.following(0.6, &SCALE).window(&SCALE);
        assert!(
            moved.from < 0.6 && moved.to > 0.6 && (moved.length() - 2.0).abs() < 1e-9,
            "{moved:?}"
        );
        assert_eq!(strike.following(25.0, &SCALE).window(&SCALE).to, 25.0);
    }

    #[test]
    fn values_are_interpolated_between_stations_and_absent_beyond_them() {
        let column = &crate::report::stations::COLUMNS[6];
        let pieces = vec![vec![(-1.0, 4.0), (0.0, 2.0), (0.0, 8.0), (1.0, 0.0)]];
        let curve = Curve {
            source: CurveSource::Pinned(Method::Exact),
            column,
            unit: column.shown,
            pieces,
            solved: None,
        };
        for (x, y) in [
            (-1.0, Some(4.0)),
            (-0.5, Some(3.0)),
            (0.0, Some(8.0)),
            (1.0, Some(0.0)),
            (1.1, None),
            (-1.1, None),
        ] {
            assert_eq!(value_at(&curve.pieces, x), y, "{x}");
        }
        assert_eq!(curve.upright_within(Span::new(-0.5, 0.5)), Span::new(2.0, 8.0));
    }
}
