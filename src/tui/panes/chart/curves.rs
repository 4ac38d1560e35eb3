//! The curves of a chart: every method, the baseline, and the comparison value; their drawing in
//! cells, which keeps every peak that is narrower than a column, and their values at the cursor.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::Charts;
use crate::case::units::{self, System};
use crate::model::compliance::model_of;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::interpolate::DIGITS_BETWEEN;
use crate::model::{Inputs, Interpolated, Solution};
use crate::numeric::decimal::significant;
use crate::report::charts::{Point, curve_of, pieces};
use crate::report::graphs::{GRAPHS, Graph};
use crate::report::stations::{Column, Row};
use crate::tui::ascii::symbol;
use crate::tui::panes::plot::{PlotArea, Span};
use crate::tui::solver::Answer;

/// Curves coincide if they differ by at most this fraction of the values.
const ALIKE: f64 = 2e-3;

/// If a column has more points than this, only the first, last, least and greatest are drawn.
const MANY: usize = 8;

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
pub struct Curve {
    /// The source.
    pub source: CurveSource,
    /// The column of the stations.
    pub(crate) column: &'static Column,
    /// The display unit.
    pub(crate) unit: &'static str,
    /// The points from D onwards.
    pub pieces: Vec<Vec<Point>>,
}

impl Curve {
    // Keeps the points that are not hidden and their neighbours, so that the line meets the active
    // curve.
    fn without(self, is_hidden: impl Fn(Point) -> bool) -> Curve {
        let pieces = self.pieces.iter().flat_map(|piece| {
            let hidden: Vec<bool> = piece.iter().map(|point| is_hidden(*point)).collect();
            let around = |at: usize| at.saturating_sub(1)..=(at + 1).min(piece.len() - 1);
            let kept: Vec<usize> =
                (0..piece.len()).filter(|&at| around(at).any(|near| !hidden[near])).collect();
            let runs =
                kept.chunk_by(|one, next| one + 1 == *next && !(hidden[*one] && hidden[*next]));
            runs.map(|run| run.iter().map(|&at| piece[at]).collect()).collect::<Vec<Vec<Point>>>()
        });
        Curve { pieces: pieces.collect(), ..self }
    }

    /// The least and the greatest value.
    #[must_use]
    pub(crate) fn upright(&self) -> Span {
        self.points().fold(Span::NONE, |span, (_, y)| span.with(y))
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
pub fn curves(charts: &Charts, graph: &Graph) -> Vec<Curve> {
    let Some(answer) = charts.answer else {
        return Vec::new();
    };
    let drawn = Drawn { graph, system: charts.units };
    if let Some(column) = graph.by_model {
        return drawn.models(answer, column);
    }
    let pinned = charts.baseline.and_then(|baseline| drawn.pinned(baseline, answer.active));
    let others = answer.methods.iter().filter(|(method, _)| *method != answer.active).filter_map(
        |(method, found)| {
            drawn.curve(&answer.inputs, found.as_ref().ok()?, CurveSource::Other(*method))
        },
    );
    let own = drawn.active(answer, CurveSource::Active(answer.active));
    pinned.into_iter().chain(others).chain(drawn.bound(answer)).chain(own).collect()
}

/// Whether it is the curve of the elastic field, which couples neighbouring teeth: the other models
/// are compared with this curve.
#[must_use]
pub fn is_field(source: CurveSource) -> bool {
    matches!(source, CurveSource::Model { model, .. } if model.model().has_coupling)
}

/// The curves without the parts that coincide with the active curve.
#[must_use]
pub fn apart(curves: Vec<Curve>) -> Vec<Curve> {
    let Some(own) =
        curves.iter().find(|curve| matches!(curve.source, CurveSource::Active(_))).cloned()
    else {
        return curves;
    };
    let alike = ALIKE * curves.iter().map(Curve::upright).fold(Span::NONE, Span::and).length();
    let coincides = |(x, y): Point| own.at(x).is_some_and(|value| (value - y).abs() <= alike);
    let shown = curves.into_iter().map(|curve| match curve.source {
        CurveSource::Other(_) | CurveSource::Pinned(_) => curve.without(coincides),
        CurveSource::Active(_) | CurveSource::Bound(_) | CurveSource::Model { .. } => curve,
    });
    // The legend names the baseline even if its curve coincides.
    shown
        .filter(|curve| matches!(curve.source, CurveSource::Pinned(_)) || !curve.pieces.is_empty())
        .collect()
}

/// The marker of a curve.
#[must_use]
pub(crate) fn marker(charts: &Charts, source: CurveSource) -> Marker {
    let plain = charts.look.ascii;
    match source {
        source if is_main(source) && plain => Marker::Custom('*'),
        source if is_main(source) => charts.marker,
        CurveSource::Model { model, .. } if Some(&model) == ToothCompliance::ALL.first() => {
            Marker::Custom(if plain { 'x' } else { '×' })
        }
        CurveSource::Other(Method::Paper) => Marker::Custom(if plain { '.' } else { '·' }),
        CurveSource::Other(Method::Static) => Marker::Custom(if plain { 'x' } else { '×' }),
        CurveSource::Model { .. } | CurveSource::Other(_) | CurveSource::Active(_) => {
            Marker::Custom(if plain { 'o' } else { '∘' })
        }
        CurveSource::Pinned(_) => Marker::Custom('+'),
        CurveSource::Bound(_) => Marker::Custom(if plain { '-' } else { '╌' }),
    }
}

/// The style of a curve.
#[must_use]
pub(crate) fn style(charts: &Charts, source: CurveSource) -> Style {
    let theme = charts.look.theme;
    let style = match source {
        source if is_main(source) => theme.active,
        CurveSource::Active(_) | CurveSource::Other(_) | CurveSource::Model { .. } => theme.other,
        CurveSource::Pinned(_) => theme.baseline,
        CurveSource::Bound(_) => theme.rule,
    };
    if charts.is_stale { style.patch(theme.faint) } else { style }
}

/// Draws the visible parts of the curves, the last on top; the curves of the compliance models share
/// the cells that several of them cross.
pub fn draw_curve(
    charts: &Charts,
    curves: &[Curve],
    (across, upright): (Span, Span),
    plot: Rect,
    buffer: &mut Buffer,
) {
    let area = PlotArea { cells: plot, across, upright };
    let shown = curves.iter().map(|curve| {
        let pieces = curve.pieces.iter();
        let pieces: Vec<_> = pieces.map(|piece| visible(piece, across, plot.width)).collect();
        let look = (marker(charts, curve.source), style(charts, curve.source));
        (pieces, look)
    });
    let is_model = |curve: &Curve| matches!(curve.source, CurveSource::Model { .. });
    if curves.iter().all(is_model) {
        area.draw_compared(&shown.collect::<Vec<_>>(), buffer);
    } else {
        shown.for_each(|(pieces, look)| area.draw_pieces(&pieces, look, buffer));
    }
}

/// The angle, the visible curves at it, and every other value of the active method.
#[must_use]
pub fn readout(charts: &Charts, cursor: f64) -> String {
    let mut parts = vec![place_of_cursor(charts, cursor)];
    let graphs = charts.shown();
    let chosen = if graphs.is_empty() { vec![charts.pane.graph] } else { graphs };
    let seen: Vec<String> =
        chosen.iter().filter_map(|&graph| all_values(charts, &GRAPHS[graph], cursor)).collect();
    let rest = (0..GRAPHS.len()).filter(|graph| !chosen.contains(graph));
    let rest: Vec<String> =
        rest.filter_map(|graph| own_value(charts, &GRAPHS[graph], cursor)).collect();
    parts.extend(seen);
    parts.extend((!rest.is_empty()).then(|| rest.join(", ")));
    let (angle, values) = parts.split_at(1);
    if values.is_empty() {
        format!("{}.", angle[0])
    } else {
        format!("{}: {}.", angle[0], values.join("; "))
    }
}

/// The name of the curve of the baseline, with its method if it differs from the active method.
pub(crate) fn base_name(charts: &Charts, method: Method) -> String {
    let is_other = charts.answer.is_some_and(|answer| answer.active != method);
    if is_other { format!("baseline ({})", method.name()) } else { "baseline".to_owned() }
}

#[derive(Clone, Copy)]
struct Drawn<'a> {
    graph: &'a Graph,
    system: System,
}

impl Drawn<'_> {
    fn active(self, answer: &Answer, source: CurveSource) -> Option<Curve> {
        self.curve(&answer.inputs, answer.of(answer.active)?, source)
    }

    // The model of the case is last, on top of the others, and the elastic field is below it.
    fn models(self, answer: &Answer, column: &'static Column) -> Vec<Curve> {
        let Some(Ok(found)) = &answer.stiffness else {
            return Vec::new();
        };
        let unit = self.system.unit(column.shown);
        let factor = units::factor(unit).unwrap_or(1.0);
        let own = model_of(&answer.inputs);
        let curve = |(at, &model): (usize, &ToothCompliance)| {
            let points = found.mesh_curve(at);
            let points = points.map(|(angle, value)| (angle.to_degrees(), Some(value / factor)));
            Curve {
                source: CurveSource::Model { model, is_own: model == own },
                column,
                unit,
                pieces: pieces(points, f64::INFINITY),
            }
        };
        let mut curves: Vec<Curve> = found.models.iter().enumerate().map(curve).collect();
        curves.retain(|curve| !curve.pieces.is_empty());
        curves.sort_by_key(|curve| (is_own(curve.source), is_field(curve.source)));
        curves
    }

    fn pinned(self, base: &Answer, active: Method) -> Option<Curve> {
        let method = base.beside(active);
        self.curve(&base.inputs, base.of(method)?, CurveSource::Pinned(method))
    }

    fn bound(self, answer: &Answer) -> Option<Curve> {
        let (solution, bound) = (answer.of(answer.active)?, self.graph.bound?);
        let symbol = bound.symbols[usize::from(solution.method.shares_load())];
        self.with(&answer.inputs, solution, CurveSource::Bound(symbol), |row| {
            (bound.value)(solution, row)
        })
    }

    // `None` if the method has no such column or no station.
    fn curve(self, inputs: &Inputs, solution: &Solution, source: CurveSource) -> Option<Curve> {
        let column = self.graph.column(solution.method)?;
        self.with(inputs, solution, source, |row| column.of(row))
    }

    fn with(
        self,
        inputs: &Inputs,
        solution: &Solution,
        source: CurveSource,
        value: impl Fn(Row) -> Option<f64>,
    ) -> Option<Curve> {
        let column = self.graph.column(solution.method)?;
        let unit = self.system.unit(column.shown);
        let pieces = curve_of(inputs, solution, unit, value);
        (!pieces.is_empty()).then_some(Curve { source, column, unit, pieces })
    }
}

fn is_own(source: CurveSource) -> bool {
    matches!(source, CurveSource::Model { is_own: true, .. })
}

/// Whether the others are compared with this curve.
fn is_main(source: CurveSource) -> bool {
    matches!(source, CurveSource::Active(_)) || is_field(source)
}

// The visible points and their neighbours, reduced if a column has many.
fn visible(piece: &[Point], across: Span, columns: u16) -> Vec<Point> {
    let from = piece.partition_point(|point| point.0 < across.from).saturating_sub(1);
    let to = (piece.partition_point(|point| point.0 <= across.to) + 1).min(piece.len());
    let piece = &piece[from.min(to)..to];
    if piece.len() <= MANY * usize::from(columns) {
        return piece.to_vec();
    }
    let column = |point: &Point| (across.part(point.0) * f64::from(columns)).floor();
    piece
        .chunk_by(|one, other| column(one).total_cmp(&column(other)).is_eq())
        .flat_map(outline)
        .collect()
}

// The first, the least, the greatest and the last point, in order.
fn outline(points: &[Point]) -> Vec<Point> {
    let by_height = |one: &usize, other: &usize| points[*one].1.total_cmp(&points[*other].1);
    let extremes = [(0..points.len()).min_by(by_height), (0..points.len()).max_by(by_height)];
    let mut kept: Vec<usize> =
        extremes.into_iter().flatten().chain([0, points.len() - 1]).collect();
    kept.sort_unstable();
    kept.dedup();
    kept.into_iter().map(|index| points[index]).collect()
}

fn place_of_cursor(charts: &Charts, cursor: f64) -> String {
    let (side, degrees) =
        (if cursor < 0.0 { "after" } else { "before" }, cursor.abs().to_degrees());
    if degrees > 0.0 {
        format!("{degrees:.4} deg of the driver {side} E{}", time_of_cursor(charts, cursor))
    } else {
        "At E".to_owned()
    }
}

fn time_of_cursor(charts: &Charts, cursor: f64) -> String {
    let speed = charts.answer.map_or(0.0, |answer| answer.inputs.speed);
    let micros = 1e6 * cursor.abs() / speed;
    if charts.pane.by_time && micros.is_finite() {
        format!(", {} us", significant(micros, TIME_DIGITS))
    } else {
        String::new()
    }
}

// The values of every curve of a chart, the active method first, in the unit of the greatest value.
fn all_values(charts: &Charts, graph: &Graph, cursor: f64) -> Option<String> {
    let curves = curves(charts, graph);
    let readings: Vec<Reading> =
        curves.iter().rev().filter_map(|curve| Reading::of(charts, graph, curve, cursor)).collect();
    in_words(charts, &readings)
}

// The value of the active method only.
fn own_value(charts: &Charts, graph: &Graph, cursor: f64) -> Option<String> {
    let curves = curves(charts, graph);
    let own = curves.iter().find(|curve| matches!(curve.source, CurveSource::Active(_)))?;
    in_words(charts, &[Reading::of(charts, graph, own, cursor)?])
}

// The value of a curve in SI, with its number of significant digits.
struct Reading {
    name: String,
    column: &'static Column,
    value: f64,
    digits: usize,
}

fn in_words(charts: &Charts, readings: &[Reading]) -> Option<String> {
    let units = readings.iter().map(|reading| {
        let shown = reading.column.shown;
        units::system::unit_for(reading.value.abs(), shown, reading.digits, charts.units)
    });
    let factor = |unit: &&str| units::factor(unit).unwrap_or(1.0);
    let unit = units.max_by(|one, other| factor(one).total_cmp(&factor(other)))?;
    let words = readings.iter().map(|reading| {
        let number = units::system::counted(reading.value, unit, reading.digits);
        let value = format!("{number} {}", units::system::named(unit));
        format!("{} {}", reading.name, value.trim_end())
    });
    Some(words.collect::<Vec<_>>().join(", "))
}

// The value from the same evaluation as in the teeth pane, not from the drawn line, with its number
// of significant digits.
fn value_at(charts: &Charts, graph: &Graph, curve: &Curve, cursor: f64) -> Option<(f64, usize)> {
    if let CurveSource::Model { .. } = curve.source {
        let factor = units::factor(curve.unit).unwrap_or(1.0);
        let value = curve.at(0.0 - cursor.to_degrees())?;
        return Some((value * factor, curve.column.digits));
    }
    let is_pinned = matches!(curve.source, CurveSource::Pinned(_));
    let answer = if is_pinned { charts.baseline? } else { charts.answer? };
    let method = if let CurveSource::Other(method) | CurveSource::Pinned(method) = curve.source {
        method
    } else {
        answer.active
    };
    let solution = answer.of(method)?;
    let interpolated = Interpolated::at(&answer.inputs, solution, cursor)?;
    if let CurveSource::Bound(_) = curve.source {
        let digits = if matches!(interpolated, Interpolated::Between(_)) {
            DIGITS_BETWEEN
        } else {
            curve.column.digits
        };
        Some(((graph.bound?.value)(solution, Row::from(&interpolated))?, digits))
    } else {
        let value = curve.column.of(Row::from(&interpolated))?;
        Some((
            curve.column.resolved(value, &answer.inputs, solution),
            curve.column.digits_of(&interpolated),
        ))
    }
}

impl Reading {
    fn of(charts: &Charts, graph: &Graph, curve: &Curve, cursor: f64) -> Option<Reading> {
        let name = |text: &'static str| symbol(text, charts.look.ascii).into_owned();
        let (value, digits) = value_at(charts, graph, curve, cursor)?;
        let in_unit = value / units::factor(curve.unit).unwrap_or(1.0);
        let most = curve.pieces.iter().flatten().map(|(_, y)| y.abs()).fold(0.0, f64::max);
        let is_zero = in_unit.abs() < ROUNDING * most;
        Some(Reading {
            name: match curve.source {
                CurveSource::Active(_) => name(curve.column.symbol),
                CurveSource::Other(method) => method.name().to_owned(),
                CurveSource::Pinned(method) => base_name(charts, method),
                CurveSource::Bound(bound) => name(bound),
                CurveSource::Model { model, .. } => model.name().to_owned(),
            },
            column: curve.column,
            value: if is_zero { 0.0 } else { value },
            digits,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_coincide_with_the_active_curve_are_not_drawn() {
        let column = &crate::report::stations::COLUMNS[6];
        let curve = |source, points: &[f64]| {
            let points = points.iter().enumerate().map(|(at, y)| (at as f64, *y)).collect();
            Curve { source, column, unit: column.shown, pieces: vec![points] }
        };
        let own = curve(CurveSource::Active(Method::Exact), &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let same = curve(CurveSource::Other(Method::Static), &[0.0, 1.0, 2.0, 3.0, 4.0]);
        let other =
            curve(CurveSource::Other(Method::Paper), &[9.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]);
        let shown = apart(vec![same, other, own]);
        assert_eq!(shown.len(), 2);
        assert_eq!(
            shown[0].pieces,
            [vec![(0.0, 9.0), (1.0, 1.0)], vec![(5.0, 5.0), (6.0, 6.0), (7.0, 7.0)]]
        );
        assert_eq!(shown[1].pieces[0].len(), 6);
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
        assert_eq!(curve.upright(), Span::new(0.0, 8.0));
    }

    #[test]
    fn a_peak_narrower_than_a_column_is_kept() {
        let points: Vec<Point> =
            (0..10_000).map(|at| (f64::from(at), if at == 4321 { 7.0 } else { 1.0 })).collect();
        let kept = visible(&points, Span::new(0.0, 9999.0), 50);
        assert!(kept.len() <= 4 * 51 && kept.contains(&(4321.0, 7.0)), "{}", kept.len());
        assert!(kept.is_sorted_by(|one, other| one.0 < other.0));
        assert_eq!((kept.first(), kept.last()), (points.first(), points.last()));
    }

    #[test]
    fn hidden_points_are_omitted_except_the_neighbours() {
        let points: Vec<Point> = (0..100).map(|at| (f64::from(at), 0.0)).collect();
        let kept = visible(&points, Span::new(10.5, 20.5), 50);
        assert_eq!((kept.first(), kept.last()), (Some(&(10.0, 0.0)), Some(&(21.0, 0.0))));
        assert_eq!(visible(&points[..5], Span::new(10.5, 20.5), 50), [points[4]]);
        assert_eq!(visible(&[], Span::new(0.0, 1.0), 50), []);
    }
}
