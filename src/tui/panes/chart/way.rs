//! The range of roll angles of the incoming tooth.

use crate::model::Solution;
use crate::model::inputs::Method;
use crate::report::stations::{Row, rows};
use crate::tui::panes::plot::Span;
use crate::tui::solver::Answer;

/// The driver's angle before E at the last contact, in rad, negative after E. Only `static` and
/// `dynamic` have a last contact.
pub(crate) fn last_contact(solution: &Solution) -> Option<f64> {
    match rows(solution).last() {
        Some(Row::Load(station)) => Some(station.roll_angle_driver),
        _ => None,
    }
}

/// The range from the first to the last station of all methods, in deg after E.
pub(super) fn way(answer: &Answer) -> Span {
    answer
        .methods
        .iter()
        .filter_map(|(_, found)| found.as_ref().ok())
        .map(way_of)
        .fold(Span::NONE, Span::and)
}

/// The range of the path of contact with its mesh stiffness, in deg after E.
pub(crate) fn path(answer: &Answer) -> Span {
    let Some(Ok(found)) = &answer.stiffness else {
        return Span::NONE;
    };
    let ways = found.points.iter().map(|point| point.way / found.base_radius);
    ways.fold(Span::NONE, |span, angle| span.with(angle.to_degrees()))
}

/// The range of the stations of one method, in deg after E.
pub(crate) fn angle_range_of(answer: &Answer, method: Method) -> Span {
    answer.of(method).map_or(Span::NONE, way_of)
}

fn way_of(solution: &Solution) -> Span {
    let rows = rows(solution);
    [rows.first(), rows.last()]
        .into_iter()
        .flatten()
        .map(|row| row.angle_after_e())
        .fold(Span::NONE, Span::with)
}
