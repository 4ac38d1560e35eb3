//! Numbers of a relief as text.

use crate::model::explanation::tidy;
use crate::model::inputs::ReliefShape;

pub(super) fn shape(shape: ReliefShape) -> &'static str {
    match shape {
        ReliefShape::Linear => "linear",
        ReliefShape::Parabolic => "parabolic",
    }
}

pub(super) fn um(length: f64) -> String {
    format!("{:.1}", length * 1e6)
}

pub(super) fn mm(length: f64) -> String {
    format!("{:.2}", length * 1e3)
}

pub(super) fn percent(part: f64) -> String {
    tidy(100.0 * part, 4)
}
