//! Whether a field has an effect in a case, and the reason if it has none.

use std::borrow::Cow;

use super::dependencies::is_read;
use super::fields::FIELDS;
use super::fields::reasons::Reason;
use super::{Case, Problem, check};
use crate::model::Inputs;
use crate::model::inputs::Method;

/// Whether a field has an effect on the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acting {
    /// A quantity or a station depends on the field.
    Yes,
    /// The field is printed beside the results or in a note, and no quantity depends on it.
    Beside(&'static str),
    /// The case does not use the field.
    No(&'static str),
}

/// The reason for an unused field without its own reason.
const NO_REASON: &str = "no result of this case depends on it";

impl Case {
    /// The inputs that can be read, enough for the relevance of fields, and all problems of the
    /// case, in the order of the fields.
    #[must_use]
    pub fn read(&self) -> (Inputs, Vec<Problem>) {
        check::read(self, &[])
    }
}

/// Whether the field has an effect in a case with these inputs.
#[must_use]
pub fn relevance(field: usize, inputs: &Inputs) -> Acting {
    if acts(field, inputs) {
        return Acting::Yes;
    }
    let reason = |reason: &Reason| match *reason {
        Reason::Beside(why) => Some(Acting::Beside(why)),
        Reason::Idle(when, why) if when(inputs) => Some(Acting::No(why)),
        _ => None,
    };
    let mut reasons = FIELDS[field].reasons.iter();
    reasons.find_map(reason).unwrap_or(Acting::No(NO_REASON))
}

/// The reason why results depend less on a field than expected, in a case with these inputs.
#[must_use]
pub fn partial_relevance(field: usize, inputs: &Inputs) -> Option<&'static str> {
    let reason = |reason: &Reason| match *reason {
        Reason::Partly(when, why) if when(inputs) => Some(why),
        _ => None,
    };
    let why = FIELDS[field].reasons.iter().find_map(reason)?;
    acts(field, inputs).then_some(why)
}

/// The inputs with a speed. Without a speed every power gives the same infinite torque.
fn with_speed(inputs: &Inputs) -> Cow<'_, Inputs> {
    if inputs.speed > 0.0 {
        return Cow::Borrowed(inputs);
    }
    Cow::Owned(Inputs { speed: 1.0, ..inputs.clone() })
}

/// Whether any stage reads the field. For the method `auto`, any stage of the methods to choose
/// from.
fn acts(field: usize, inputs: &Inputs) -> bool {
    let inputs = &*with_speed(inputs);
    let by = |method| {
        let inputs = Inputs { method, ..inputs.clone() };
        is_read(field, &inputs)
    };
    let by_stages = || match inputs.method {
        Method::Auto => [Method::Exact, Method::Static, Method::Dynamic].into_iter().any(by),
        _ => is_read(field, inputs),
    };
    match FIELDS[field].read_when {
        Some(when) => when(inputs),
        None => by_stages(),
    }
}
