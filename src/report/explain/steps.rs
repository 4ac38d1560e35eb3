//! The one table of steps: values on the way from the fields to the quantities, each with its
//! formula.

pub(super) mod contact;
mod friction;
mod impact;
mod load;
mod pair;

use super::context::Step;

/// Every step, in the order the data flows.
pub(super) fn steps() -> impl Iterator<Item = &'static Step> {
    [
        pair::STEPS,
        contact::STEPS,
        impact::STEPS,
        friction::STEPS,
        load::STEPS,
    ]
    .into_iter()
    .flatten()
}

/// A step whose value the model has.
macro_rules! step {
    ($symbol:literal, $meaning:literal, $unit:literal, $formula:expr, $value:expr) => {
        Step {
            symbol: $symbol,
            meaning: $meaning,
            unit: $unit,
            formula: $formula,
            value: Some($value),
        }
    };
}

/// A step that its formula alone tells.
macro_rules! told {
    ($symbol:literal, $meaning:literal, $unit:literal, $formula:expr) => {
        Step {
            symbol: $symbol,
            meaning: $meaning,
            unit: $unit,
            formula: $formula,
            value: None,
        }
    };
}

use {step, told};
