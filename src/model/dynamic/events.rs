//! Gains and losses of contact within a step.

use super::step::{Course, Step};
use crate::model::pair_forces::Touching;

/// A gain or loss of contact of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Event {
    /// The pair's index in the window.
    pub(super) pair: usize,
    /// The part of the step before the event.
    pub(super) part: f64,
}

/// The first event of a step. The lead of a pair is a polynomial over the step, so that no event is
/// missed. Pairs in `turned` begin the step with a lead of 0 within rounding; several of them can
/// change together. The pair `standing_off` has no events.
pub(super) fn first(
    course: &Course<'_>,
    (step, range): (&Step, (f64, f64)),
    (turned, standing_off): (Touching, Option<usize>),
) -> Option<Event> {
    let may_turn = (0..course.pairs()).filter(|&pair| Some(pair) != standing_off);
    let events = may_turn.filter_map(|pair| {
        if course.is_clear(pair, step, range) {
            return None;
        }
        let (lead, touches) = (course.lead_along(pair, step), course.touches(pair));
        if lead.is_clear(touches, range) {
            return None;
        }
        let sign = if touches { 1.0 } else { -1.0 };
        let part = lead.first_fall(&step.ahead, sign, turned.has(pair))?;
        Some(Event { pair, part })
    });
    events.min_by(|one, other| one.part.total_cmp(&other.part))
}
