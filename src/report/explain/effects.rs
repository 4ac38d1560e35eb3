//! The sensitivity of a quantity: the fields that it depends on, and its change for a small step of
//! each.

use super::context::{Known, factor};
use super::uncertainty::noise;
use crate::case::FIELDS;
use crate::case::dependencies::{Dependence, fields_of, value_of};
use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::model::compliance::model_of;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Stage};
use crate::numeric::decimal::significant;
use crate::report::{shown, value};

/// The tolerance of the motion at which a small step is distinguishable.
const FINE: f64 = 1e-6;

/// A field and the change of the quantity for a small step of the field.
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

/// The fields behind a quantity, in the order of the form. For method `auto`, the tolerance follows
/// from `model.within`.
pub(super) fn of(quantity: &Quantity, known: &Known) -> Vec<Effect> {
    // Every step would need a motion at every speed, and the greatest of them moves from speed to
    // speed.
    if quantity.stage == Stage::SpeedRun {
        return Vec::new();
    }
    // The change must exceed the error of the motion, and a step must not switch the stiffness
    // model.
    let tolerance = known.context.inputs.tolerance.min(FINE);
    let fixed = Inputs {
        tooth_compliance: Some(model_of(known.context.inputs)),
        tolerance,
        ..known.context.inputs.clone()
    };
    let is_coarse = quantity.stage == Stage::Dynamic && tolerance < known.context.inputs.tolerance;
    let own = value(quantity, known.context.solution);
    let own = if is_coarse { value_of(quantity, &fixed) } else { own };
    let [within, tolerance] = ["model.within", "model.tolerance"].map(index_of);
    let by_auto = |dependence: Dependence| {
        if known.context.given.method == Method::Auto && Some(dependence.field) == tolerance {
            let step = None;
            within.map(|field| Dependence { field, step })
        } else {
            Some(dependence)
        }
    };
    let noise = noise(quantity, &fixed);
    fields_of(quantity, known.case, &fixed, own)
        .into_iter()
        .filter_map(by_auto)
        .map(|dependence| effect(quantity, &dependence, known, own, noise))
        .collect()
}

fn effect(
    quantity: &Quantity,
    dependence: &Dependence,
    known: &Known,
    own: Option<f64>,
    noise: f64,
) -> Effect {
    let (case, field) = (known.case, &FIELDS[dependence.field]);
    let text = case.effective(dependence.field).map(sanitize);
    let text = text.unwrap_or_default();
    let step = dependence.step.as_ref();
    let change = own.zip(step).map(|(own, step)| change(quantity, own, step.value, noise));
    Effect {
        key: field.key,
        symbol: field.symbol,
        text,
        step: step.map(|step| step.text.to_owned()).unwrap_or_default(),
        change: change.unwrap_or_default(),
    }
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
    format!("{sign}{} %", significant(100.0 * change.abs() / own.abs(), 3))
}
