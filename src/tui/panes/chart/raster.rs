//! Draws curves into cells and keeps every peak that is narrower than a column.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::Charts;
use super::curves::{Curve, CurveSource, is_field};
use crate::model::inputs::{Method, ToothCompliance};
use crate::report::charts::Point;
use crate::tui::panes::plot::{PlotArea, Span};

/// If a column has more points than this, only the first, last, least and greatest are drawn.
const MANY: usize = 8;

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

/// Whether the others are compared with this curve.
fn is_main(source: CurveSource) -> bool {
    matches!(source, CurveSource::Active(_)) || is_field(source)
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
pub fn draw(
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

#[cfg(test)]
mod tests {
    use super::*;

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
