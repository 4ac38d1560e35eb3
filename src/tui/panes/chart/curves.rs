//! The curves of a chart: every method, the baseline, and the comparison value; and their values at
//! the cursor.

use ratatui::symbols::Marker;

use super::Charts;
use crate::case::units::{self, System};
use crate::model::compliance::model_of;
use crate::model::contact_state::DIGITS_BETWEEN;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::{Inputs, Interpolated, Solution};
use crate::numeric::decimal::significant;
use crate::report::chart::{Kind, Point, Series, Span};
use crate::report::charts::{curve, pieces};
use crate::report::graphs::{GRAPHS, Graph};
use crate::report::stations::Column;
use crate::tui::ascii::symbol;
use crate::tui::panes::plot::Look;
use crate::tui::solver::Answer;

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
    /// The curve with its name in the legend.
    pub(crate) fn series(&self, charts: &Charts) -> Series {
        let name = match self.source {
            CurveSource::Active(method) => method.name().to_owned(),
            CurveSource::Model { model, is_own: true } => format!("{} (case)", model.name()),
            _ => self.name(charts),
        };
        Series { name, pieces: self.pieces.clone(), kind: Kind::Curve }
    }

    /// The name of the value: the symbol for the active method.
    fn name(&self, charts: &Charts) -> String {
        let name = |text: &'static str| symbol(text, charts.look.ascii).into_owned();
        match self.source {
            CurveSource::Active(_) => name(self.column.symbol),
            CurveSource::Other(method) => method.name().to_owned(),
            CurveSource::Pinned(method)
                if charts.answer.is_some_and(|answer| answer.active != method) =>
            {
                format!("baseline ({})", method.name())
            }
            CurveSource::Pinned(_) => "baseline".to_owned(),
            CurveSource::Bound(bound) => name(bound),
            CurveSource::Model { model, .. } => model.name().to_owned(),
        }
    }

    /// The least and the greatest value within a range of the angle.
    pub(crate) fn upright_within(&self, window: Span) -> Span {
        let ends = [window.from, window.to].into_iter().filter_map(|x| self.at(x));
        let inside =
            self.points().filter(|(x, _)| (window.from..=window.to).contains(x)).map(|(_, y)| y);
        ends.chain(inside).fold(Span::NONE, Span::with)
    }

    /// The value at an angle, interpolated between stations. At a jump, the value after it.
    #[must_use]
    pub(crate) fn at(&self, x: f64) -> Option<f64> {
        self.pieces.iter().find_map(|piece| {
            let after = piece.partition_point(|point| point.0 <= x);
            let (before, last) = (piece.get(after.checked_sub(1)?)?, piece.len() - 1);
            let rounding = 1e-12 * x.abs();
            match piece.get(after) {
                Some(next) => {
                    Some(before.1 + (next.1 - before.1) * (x - before.0) / (next.0 - before.0))
                }
                None => (x <= piece[last].0 + rounding).then_some(before.1),
            }
        })
    }

    fn points(&self) -> impl Iterator<Item = Point> {
        self.pieces.iter().flatten().copied()
    }
}

/// Every curve of a chart in drawing order.
#[must_use]
pub fn curves<'a>(charts: &Charts<'a>, graph: &Graph) -> Vec<Curve<'a>> {
    let Some(answer) = charts.answer else {
        return Vec::new();
    };
    let system = charts.units;
    if let Some(column) = graph.by_model {
        return models(answer, column, system);
    }
    let of = |answer: &'a Answer, method: Method, source: CurveSource| {
        let (inputs, solution) = (&answer.inputs, answer.of(method)?);
        let column = graph.column(method)?;
        let unit = system.unit(column.shown);
        let is_bound = matches!(source, CurveSource::Bound(_));
        let kind = if is_bound { Kind::Bound } else { Kind::Curve };
        let (symbol, pieces) = curve(graph, inputs, solution, (unit, kind))?;
        let source = if is_bound { CurveSource::Bound(symbol) } else { source };
        let solved = Some((inputs, solution));
        (!pieces.is_empty()).then_some(Curve { source, column, unit, pieces, solved })
    };
    let active = answer.active;
    let pinned = charts.baseline.and_then(|baseline| {
        let method = baseline.beside(active);
        of(baseline, method, CurveSource::Pinned(method))
    });
    let others = answer.methods.iter().map(|(method, _)| *method);
    let others = others.filter(|method| *method != active);
    let others = others.filter_map(|method| of(answer, method, CurveSource::Other(method)));
    let bound = of(answer, active, CurveSource::Bound(""));
    let own = of(answer, active, CurveSource::Active(active));
    pinned.into_iter().chain(others).chain(bound).chain(own).collect()
}

/// The mesh stiffness by every compliance model: that of the case is last, on top of the others, and
/// the elastic field is below it.
fn models<'a>(answer: &Answer, column: &'static Column, system: System) -> Vec<Curve<'a>> {
    let Some(Ok(found)) = &answer.stiffness else {
        return Vec::new();
    };
    let unit = system.unit(column.shown);
    let factor = units::factor(unit).unwrap_or(1.0);
    let own = model_of(&answer.inputs);
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

/// Whether it is the curve of the elastic field, which couples neighbouring teeth: the other models
/// are compared with this curve.
#[must_use]
pub fn is_field(source: CurveSource) -> bool {
    matches!(source, CurveSource::Model { model, .. } if model.model().has_coupling)
}

/// The marker and the style of a curve.
#[must_use]
pub(crate) fn look(charts: &Charts, source: CurveSource) -> Look {
    let theme = charts.look.theme;
    let (marker, style) = match source {
        CurveSource::Active(_) => (charts.marker, theme.active),
        source if is_field(source) => (charts.marker, theme.active),
        CurveSource::Other(method) => (sign_of(method), theme.other),
        CurveSource::Model { model, .. } => {
            let is_first = Some(&model) == ToothCompliance::ALL.first();
            (Marker::Custom(if is_first { '×' } else { '∘' }), theme.other)
        }
        CurveSource::Pinned(_) => (Marker::Custom('+'), theme.baseline),
        CurveSource::Bound(_) => (Marker::Custom('╌'), theme.rule),
    };
    (marker, if charts.is_stale { style.patch(theme.faint) } else { style })
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
#[must_use]
pub fn readout(charts: &Charts, cursor: f64) -> String {
    let graphs = charts.shown();
    let chosen = if graphs.is_empty() { vec![charts.pane.graph] } else { graphs };
    let values = |graph: usize, is_seen: bool| {
        let (graph, all) = (&GRAPHS[graph], curves(charts, &GRAPHS[graph]));
        let all = all.iter().rev();
        let all = all.filter(|curve| is_seen || matches!(curve.source, CurveSource::Active(_)));
        let readings = all.filter_map(|curve| Some((curve, reading(graph, curve, cursor)?)));
        in_words(charts, &readings.collect::<Vec<_>>())
    };
    let mut parts: Vec<String> = chosen.iter().filter_map(|&graph| values(graph, true)).collect();
    let rest = (0..GRAPHS.len()).filter(|graph| !chosen.contains(graph));
    let rest: Vec<String> = rest.filter_map(|graph| values(graph, false)).collect();
    parts.extend((!rest.is_empty()).then(|| rest.join(", ")));
    let place = place_of_cursor(charts, cursor);
    if parts.is_empty() { format!("{place}.") } else { format!("{place}: {}.", parts.join("; ")) }
}

fn place_of_cursor(charts: &Charts, cursor: f64) -> String {
    let (side, degrees) =
        (if cursor < 0.0 { "after" } else { "before" }, cursor.abs().to_degrees());
    if degrees == 0.0 {
        return "At E".to_owned();
    }
    let speed = charts.answer.map_or(0.0, |answer| answer.inputs.speed);
    let micros = 1e6 * cursor.abs() / speed;
    let time = if charts.pane.by_time && micros.is_finite() {
        format!(", {} us", significant(micros, TIME_DIGITS))
    } else {
        String::new()
    };
    format!("{degrees:.4} deg of the driver {side} E{time}")
}

/// Values in SI with their numbers of significant digits, in the unit of the greatest value.
fn in_words(charts: &Charts, readings: &[(&Curve, (f64, usize))]) -> Option<String> {
    let units = readings.iter().map(|(curve, (value, digits))| {
        units::system::unit_for(value.abs(), curve.column.shown, *digits, charts.units)
    });
    let factor = |unit: &&str| units::factor(unit).unwrap_or(1.0);
    let unit = units.max_by(|one, other| factor(one).total_cmp(&factor(other)))?;
    let words = readings.iter().map(|(curve, (value, digits))| {
        let number = units::system::counted(*value, unit, *digits);
        let value = format!("{number} {}", units::system::named(unit));
        format!("{} {}", curve.name(charts), value.trim_end())
    });
    Some(words.collect::<Vec<_>>().join(", "))
}

/// The value in SI from the same evaluation as in the teeth pane, not from the drawn line, with its
/// number of significant digits.
fn reading(graph: &Graph, curve: &Curve, cursor: f64) -> Option<(f64, usize)> {
    let (column, factor) = (curve.column, units::factor(curve.unit).unwrap_or(1.0));
    let (value, digits) = match curve.solved {
        None => (curve.at(0.0 - cursor.to_degrees())? * factor, column.digits),
        Some((inputs, solution)) => {
            let interpolated = Interpolated::at(inputs, solution, cursor)?;
            let station = &interpolated.station;
            if let CurveSource::Bound(_) = curve.source {
                let is_between = interpolated.is_between;
                let digits = if is_between { DIGITS_BETWEEN } else { column.digits };
                ((graph.bound?.value)(solution, station)?, digits)
            } else {
                let value = column.resolved(column.of(solution, station)?, inputs, solution);
                (value, column.digits_of(&interpolated))
            }
        }
    };
    let most = curve.points().map(|(_, y)| y.abs()).fold(0.0, f64::max);
    let is_zero = (value / factor).abs() < ROUNDING * most;
    Some((if is_zero { 0.0 } else { value }, digits))
}

#[cfg(test)]
mod tests {
    use super::*;

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
            assert_eq!(curve.at(x), y, "{x}");
        }
        assert_eq!(curve.upright_within(Span::new(-0.5, 0.5)), Span::new(2.0, 8.0));
    }
}
