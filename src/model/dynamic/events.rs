//! Contacts made and lost within a step.

use super::motion::Touching;
use super::step::{Along, Course, Step, TERMS};
use crate::numeric::bernstein::first_fall;
use crate::numeric::polynomial::Polynomial;

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
    gaps: &[Along],
    (turned, standing_off): (Touching, Option<usize>),
) -> Option<Event> {
    let may_turn = gaps
        .iter()
        .enumerate()
        .filter(|&(pair, _)| Some(pair) != standing_off);
    let events = may_turn.filter_map(|(pair, gap)| {
        let touches = course.touches(pair);
        if is_clear(touches, range, gap) {
            return None;
        }
        let sign = if touches { 1.0 } else { -1.0 };
        let kept: Polynomial<TERMS> = step.ahead.plus(-1.0, gap).scaled(sign);
        let begins_at_0 = turned.has(pair) && (kept.0[0] < 0.0 || is_rounding(&kept));
        let part = if begins_at_0 {
            first_fall(&kept.over_argument())
        } else {
            first_fall(&kept)
        }?;
        Some(Event { pair, part })
    });
    events.min_by(|one, other| one.part.total_cmp(&other.part))
}

/// Whether the value at 0 is none against how the polynomial varies.
fn is_rounding(kept: &Polynomial<TERMS>) -> bool {
    const ROUNDING: f64 = 1e-9;
    kept.0[0].abs()
        <= ROUNDING
            * kept.0[1..]
                .iter()
                .map(|coefficient| coefficient.abs())
                .sum::<f64>()
}

/// Whether a pair keeps what it is wherever in its range the displacement lies.
fn is_clear(touches: bool, (least, most): (f64, f64), gap: &Along) -> bool {
    let varying = gap.0[1..]
        .iter()
        .map(|coefficient| coefficient.abs())
        .sum::<f64>();
    if touches {
        least > gap.0[0] + varying
    } else {
        most < gap.0[0] - varying
    }
}
