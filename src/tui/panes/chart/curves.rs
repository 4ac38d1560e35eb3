//! The curves of a chart: every method, the baseline, and the comparison value.

use super::Charts;
use crate::case::units::{self, System};
use crate::model::compliance::model_of;
use crate::model::inputs::{Method, ToothCompliance};
use crate::model::{Inputs, Solution};
use crate::report::charts::{Point, curve_of, pieces};
use crate::report::graphs::Graph;
use crate::report::stations::{Column, Row};
use crate::tui::panes::plot::Span;
use crate::tui::solver::Answer;

/// Curves coincide if they differ by at most this fraction of the values.
const ALIKE: f64 = 2e-3;

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

/// Whether it is the curve of the elastic field, which couples neighbouring teeth: the other models
/// are compared with this curve.
#[must_use]
pub fn is_field(source: CurveSource) -> bool {
    matches!(source, CurveSource::Model { model, .. } if model.model().has_coupling)
}

fn is_own(source: CurveSource) -> bool {
    matches!(source, CurveSource::Model { is_own: true, .. })
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
}
