//! Contacts made and lost within a step.

use super::lead::Lead;
use super::step::{Course, Step};
use crate::model::pair_forces::Touching;

/// A pair that touches or leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    /// The pair's place in the window.
    pub(super) pair: usize,
    /// After what part of the step.
    pub(super) part: f64,
}

/// The first event of a step, where there is one: what a pair keeps, pressed where it touches,
/// apart where it does not, is a polynomial over the step, so that no event hides. Those that have
/// `turned` where the step begins stand at 0 there, within rounding: several of them may turn as
/// one. A pair that stands off has no events.
pub(super) fn first(
    course: &Course<'_>,
    (step, range): (&Step, (f64, f64)),
    leads: &[Lead],
    (turned, standing_off): (Touching, Option<usize>),
) -> Option<Event> {
    let may_turn = leads
        .iter()
        .enumerate()
        .filter(|&(pair, _)| Some(pair) != standing_off);
    let events = may_turn.filter_map(|(pair, lead)| {
        let touches = course.touches(pair);
        if lead.is_clear(touches, range) {
            return None;
        }
        let sign = if touches { 1.0 } else { -1.0 };
        let part = lead.first_fall(&step.ahead, sign, turned.has(pair))?;
        Some(Event { pair, part })
    });
    events.min_by(|one, other| one.part.total_cmp(&other.part))
}
