//! What a value depends on and how exact it is: effects of the fields, numerical error, spread of
//! the models, methods side by side.

use super::derivation::{Known, factor};
use crate::case::FIELDS;
use crate::case::dependencies::{Dependence, fields_of, value_of};
use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::model::compliance::model_of;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Stage, Stages};
use crate::numeric::decimal::significant;
use crate::report::{shown, value, value_as_in};
use serde::Serialize;

/// The tolerance of the motion at which a small step is distinguishable.
const FINE: f64 = 1e-6;

/// A field and the change of the quantity for a small step of the field.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Effect {
    /// The field's key.
    pub key: &'static str,
    /// The field's symbol.
    #[serde(skip)]
    pub symbol: &'static str,
    /// The field's text.
    pub text: String,
    /// The step; empty for a choice or a field without a value.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub step: String,
    /// The change of the quantity; empty without a change.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub change: String,
}

/// The fields behind a quantity, in the order of the form. For method `auto`, the tolerance follows
/// from `model.within`.
pub(super) fn effects_of(quantity: &Quantity, known: &Known) -> Vec<Effect> {
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
    let text = case.effective(dependence.field).map(sanitize).unwrap_or_default();
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
        let becomes = || format!("becomes {}", shown(quantity, found));
        return if change == 0.0 { String::new() } else { becomes() };
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

/// The relative change below which a value is unchanged: rounding, or the step error of the motion.
fn noise(quantity: &Quantity, inputs: &Inputs) -> f64 {
    const ROUNDING: f64 = 1e-11;
    const AT_REST: f64 = 1e-10;
    const STEPS: f64 = 10.0;
    const CLOSENESS: f64 = 1e-4;
    const STEADY: f64 = 1e-5;
    match quantity.stage {
        Stage::Dynamic => STEPS * inputs.tolerance,
        Stage::Clearing if inputs.method.shares_load() => CLOSENESS,
        Stage::SteadyMotion | Stage::SpeedRun => STEADY,
        Stage::Mesh | Stage::Static | Stage::Resonance | Stage::StaticSpectrum => AT_REST,
        _ => ROUNDING,
    }
}

/// Sentences on the accuracy of a quantity.
pub(super) fn accuracy_of(quantity: &Quantity, known: &Known) -> Vec<String> {
    let Some(own) = value(quantity, known.context.solution) else {
        return Vec::new();
    };
    let spread = (!quantity.is_flag()).then(|| over_models(quantity, own, known)).flatten();
    [numerical(quantity, known), spread, over_methods(quantity, known)]
        .into_iter()
        .flatten()
        .collect()
}

fn numerical(quantity: &Quantity, known: &Known) -> Option<String> {
    let inputs = known.context.inputs;
    let error = match quantity.stage {
        _ if quantity.is_flag() => return None,
        Stage::Dynamic => format!("at most {} of the peak force", tolerance(known)),
        Stage::Clearing if inputs.method.shares_load() => {
            "with 1/20,000 less relief the tooth touches".to_owned()
        }
        Stage::SteadyMotion => "at most 1e-5 of the greatest amplitude".to_owned(),
        Stage::SpeedRun => "the speeds are 1/120 of their range apart".to_owned(),
        Stage::Static | Stage::StaticSpectrum => "at most 1e-11 of the value".to_owned(),
        _ if inputs.accurate => "at most 1e-13 of the value".to_owned(),
        _ => "below 1e-12 of the value in most cases, at most 1e-9".to_owned(),
    };
    let digits = quantity.digits;
    Some(format!("Numerical error: {error}; {digits} digits shown."))
}

/// The tolerance of the motion and its origin.
fn tolerance(known: &Known) -> String {
    let given = known.context.given;
    let used = known.context.inputs.tolerance;
    if given.method == Method::Auto {
        let (within, tolerance) = (given.within, given.tolerance);
        format!(
            "{used:e} (chosen by auto for model.within = {within}; model.tolerance = \
                {tolerance:e} is not used)"
        )
    } else {
        format!("model.tolerance = {used:e}")
    }
}

/// The values of the quantity by every stiffness model that covers the pair.
fn over_models(quantity: &Quantity, own: f64, known: &Known) -> Option<String> {
    let inputs = known.context.inputs;
    let found = StiffnessModels::covering(inputs)
        .filter_map(|models| value_of(quantity, &models.in_place_of(inputs)));
    let (least, most) =
        found.fold((own, own), |(least, most), value| (least.min(value), most.max(value)));
    let share = |value: f64| format!("{:+.1} %", 100.0 * (value - own) / own.abs());
    (most - least > noise(quantity, inputs) * own.abs()).then(|| {
        format!(
            "Other stiffness models: {} to {} ({} to {}). docs/validation.md compares \
             the stiffness with published figures.",
            shown(quantity, least),
            shown(quantity, most),
            share(least),
            share(most)
        )
    })
}

/// The values by other methods, if they differ.
fn over_methods(quantity: &Quantity, known: &Known) -> Option<String> {
    let inputs = known.context.inputs;
    let by = |method: Method| {
        let inputs = Inputs { method, ..inputs.clone() };
        let solution = model::solve(&inputs, Stages::of(quantity.stage)).ok()?;
        let own = known.context.solution.method;
        Some((method, value_as_in(quantity, &solution, own)?))
    };
    let own = Some(inputs.method).filter(|method| !Method::CLOSED_FORM.contains(method));
    let found: Vec<(Method, f64)> =
        Method::CLOSED_FORM.into_iter().chain(own).filter_map(by).collect();
    let (&(_, first), others) = found.split_first()?;
    let differs =
        |(_, value): &(Method, f64)| (value - first).abs() > noise(quantity, inputs) * first.abs();
    let listed: Vec<String> = found
        .iter()
        .map(|&(method, value)| format!("{} {}", name(quantity, method), shown(quantity, value)))
        .collect();
    others.iter().any(differs).then(|| format!("Methods: {}.", listed.join(", ")))
}

/// The name of the method. A free impact in a method that resolves the impact is the closed form
/// with the deflection of that method.
fn name(quantity: &Quantity, method: Method) -> String {
    let is_beside = method.shares_load() && quantity.is_of_free_impact();
    if is_beside {
        format!("exact with the deflection that {} computes", method.name())
    } else {
        method.name().to_owned()
    }
}
