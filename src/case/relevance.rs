//! Whether a field makes a difference in a case, and why it does not.

use std::borrow::Cow;

use super::dependencies::is_read;
use super::fields::FIELDS;
use super::fields::reasons::Reason;
use super::{Case, Problem, check};
use crate::model::Inputs;
use crate::model::inputs::Method;

/// Whether what stands in a field makes a difference to the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Acting {
    /// Some quantity or station depends on it.
    Yes,
    /// It is printed beside the results or in a note, and no quantity depends on it.
    Beside(&'static str),
    /// The case does without it.
    No(&'static str),
}

/// Why a field is idle that gives no reason of its own.
const NO_REASON: &str = "nothing that this case computes depends on it";

impl Case {
    /// The inputs as far as the case can be read, which is enough for the relevance of its fields,
    /// and everything that is wrong with the case, in the order of the fields.
    #[must_use]
    pub fn read(&self) -> (Inputs, Vec<Problem>) {
        check::read(self, &[])
    }
}

/// Whether the field makes a difference in a case with these inputs.
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

/// Why less depends on a field than expected, in a case with these inputs.
#[must_use]
pub fn partial_relevance(field: usize, inputs: &Inputs) -> Option<&'static str> {
    let reason = |reason: &Reason| match *reason {
        Reason::Partly(when, why) if when(inputs) => Some(why),
        _ => None,
    };
    let why = FIELDS[field].reasons.iter().find_map(reason)?;
    acts(field, inputs).then_some(why)
}

/// The inputs with a speed: while the form lacks one, every power gives the same infinite torque.
fn with_speed(inputs: &Inputs) -> Cow<'_, Inputs> {
    if inputs.speed > 0.0 {
        return Cow::Borrowed(inputs);
    }
    Cow::Owned(Inputs {
        speed: 1.0,
        ..inputs.clone()
    })
}

/// Whether any stage reads the field; of the method `auto`, any stage of the methods that it
/// chooses from.
fn acts(field: usize, inputs: &Inputs) -> bool {
    let inputs = &*with_speed(inputs);
    let by = |method| {
        let inputs = Inputs {
            method,
            ..inputs.clone()
        };
        is_read(field, &inputs)
    };
    let by_stages = || match inputs.method {
        Method::Auto => [Method::Exact, Method::Static, Method::Dynamic]
            .into_iter()
            .any(by),
        _ => is_read(field, inputs),
    };
    match FIELDS[field].read_when {
        Some(when) => when(inputs),
        None => by_stages(),
    }
}
