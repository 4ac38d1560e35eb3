//! The sensitivity of a quantity: the fields that it depends on, and its change by a small step of
//! each.

use super::context::{Known, factor};
use super::uncertainty::{noise, value_of};
use crate::case::FIELDS;
use crate::case::dependencies::fields_of;
use crate::case::fields::{Absent, Kind, index_of};
use crate::case::sanitize::sanitize;
use crate::case::units::Dimension;
use crate::model::compliance::model_of;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Stage};
use crate::numeric::decimal::significant;
use crate::report::{shown, value};

/// The tolerance of the motion at which a small step is distinguishable.
const FINE: f64 = 1e-6;

/// A field and the change by a small step of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Effect {
    /// The field's key.
    pub key: &'static str,
    /// The field's symbol.
    pub symbol: &'static str,
    /// The field's text.
    pub text: String,
    /// The step; empty for a choice or a field without a value.
    pub step: String,
    /// The change of the quantity; empty without a change.
    pub change: String,
}

/// The fields behind a quantity, in the order of the form.
pub(super) fn of(quantity: &Quantity, known: &Known) -> Vec<Effect> {
    // A step must not switch the stiffness model and must exceed the steps of the motion.
    let tolerance = known.context.inputs.tolerance.min(FINE);
    let held = Inputs {
        tooth_compliance: Some(model_of(known.context.inputs)),
        tolerance,
        ..known.context.inputs.clone()
    };
    let is_coarse = quantity.stage == Stage::Dynamic && tolerance < known.context.inputs.tolerance;
    let own = value(quantity, known.context.solution);
    let own = if is_coarse {
        value_of(quantity, &held)
    } else {
        own
    };
    fields(quantity, known)
        .into_iter()
        .filter_map(|field| effect(quantity, field, known, &held, own))
        .collect()
}

/// The fields behind a quantity; method `auto` derives the tolerance from `model.within`.
fn fields(quantity: &Quantity, known: &Known) -> Vec<usize> {
    let [given, taken] = ["model.within", "model.tolerance"].map(index_of);
    let by_auto = |field: usize| {
        if known.context.given.method == Method::Auto && Some(field) == taken {
            given
        } else {
            Some(field)
        }
    };
    fields_of(quantity, known.context.inputs)
        .into_iter()
        .filter_map(by_auto)
        .collect()
}

fn effect(
    quantity: &Quantity,
    field: usize,
    known: &Known,
    held: &Inputs,
    own: Option<f64>,
) -> Option<Effect> {
    let known_field = &FIELDS[field];
    let text = known
        .case
        .effective(field)
        .map(sanitize)
        .unwrap_or_default();
    if text.is_empty() && matches!(known_field.absent, Absent::Either(_)) {
        return None;
    }
    let stepped = known
        .case
        .value(field)
        .and_then(|now| stepped(field, now, held));
    let (step, inputs) = stepped.unzip();
    let change = own.zip(inputs).map(|(own, inputs)| {
        change(
            quantity,
            own,
            value_of(quantity, &inputs),
            noise(quantity, held),
        )
    });
    let (step, change) = (step.unwrap_or_default(), change.unwrap_or_default());
    Some(Effect {
        key: known_field.key,
        symbol: known_field.symbol,
        text,
        step,
        change,
    })
}

/// A step that is small for the field, in words, and the inputs after it.
fn stepped(field: usize, now: f64, held: &Inputs) -> Option<(String, Inputs)> {
    let mut inputs = held.clone();
    let step = match FIELDS[field].kind {
        Kind::Count(_, _, put) => {
            put(&mut inputs, now as u32 + 1);
            "+1".to_owned()
        }
        Kind::Number(dimension, range, put) => {
            let (step, to) = match (dimension, range.unit) {
                (_, "um") => ("+1 um", now + 1e-6),
                (Dimension::Number, _) => ("+0.01", now + 0.01),
                (Dimension::Length, _) if now == 0.0 => ("+0.1 mm", 0.1e-3),
                _ => ("+1 %", 1.01 * now),
            };
            put(&mut inputs, to);
            step.to_owned()
        }
        Kind::Text | Kind::Choice(..) => return None,
    };
    Some((step, inputs))
}

/// A change of the value, relative or in the unit of the quantity.
fn change(quantity: &Quantity, own: f64, found: Option<f64>, noise: f64) -> String {
    let Some(found) = found else {
        return "no value".to_owned();
    };
    let change = found - own;
    if quantity.is_flag() {
        return if change == 0.0 {
            String::new()
        } else {
            format!("becomes {}", shown(quantity, found))
        };
    }
    if change.abs() <= noise * own.abs() {
        return String::new();
    }
    let sign = if change > 0.0 { "+" } else { "-" };
    if own == 0.0 {
        let in_unit = change.abs() / factor(quantity.shown).unwrap_or(1.0);
        return format!("{sign}{} {}", significant(in_unit, 3), quantity.shown);
    }
    format!(
        "{sign}{} %",
        significant(100.0 * change.abs() / own.abs(), 3)
    )
}
