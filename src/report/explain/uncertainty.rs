//! What a figure is worth: the numerical error, the spread of the stiffness models, the methods
//! side by side.

use super::context::Known;
use super::models::models;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Stage, Stages};
use crate::report::{shown, value, value_as_in};

/// A change of a smaller part of the value is no change of it: rounding, or the steps of the
/// motion.
pub(super) fn noise(quantity: &Quantity, inputs: &Inputs) -> f64 {
    const ROUNDING: f64 = 1e-11;
    const AT_REST: f64 = 1e-10;
    const STEPS: f64 = 10.0;
    const CLOSENESS: f64 = 1e-4;
    match quantity.stage {
        Stage::Dynamic => STEPS * inputs.tolerance,
        Stage::Clearing if inputs.method.shares_load() => CLOSENESS,
        Stage::Mesh | Stage::Static => AT_REST,
        _ => ROUNDING,
    }
}

/// What there is to say of a quantity's worth.
pub(super) fn of(quantity: &Quantity, known: &Known) -> Vec<String> {
    let parts: [fn(&Quantity, &Known) -> Option<String>; 3] =
        [numerical, over_models, over_methods];
    let has_value = value(quantity, known.solution).is_some();
    parts
        .into_iter()
        .filter(|_| has_value)
        .filter_map(|part| part(quantity, known))
        .collect()
}

/// The promise of the arithmetic.
fn numerical(quantity: &Quantity, known: &Known) -> Option<String> {
    value(quantity, known.solution)?;
    let digits = format!("{} digits are shown", quantity.digits);
    Some(match quantity.stage {
        _ if quantity.is_flag() => return None,
        Stage::Dynamic => format!(
            "Arithmetic: the peak force is good to {}; {digits}.",
            tolerance(known)
        ),
        Stage::Clearing if known.inputs.method.shares_load() => {
            format!("Arithmetic: with 1/20,000 less the tooth touches; {digits}.")
        }
        Stage::Static => format!("Arithmetic: good to 1e-11 of the value; {digits}."),
        _ if known.inputs.accurate => format!("Arithmetic: good to 1e-13 of the value; {digits}."),
        _ => format!("Arithmetic: good to 1e-12 of the value; {digits}."),
    })
}

/// The tolerance of the motion, and whose it is.
fn tolerance(known: &Known) -> String {
    let Inputs {
        method,
        tolerance,
        within,
        ..
    } = known.given;
    let taken = known.inputs.tolerance;
    match method {
        Method::Auto => {
            format!(
                "{taken:e}, as auto takes it for model.within = {within}; model.tolerance = {tolerance:e} is not used"
            )
        }
        _ => format!("model.tolerance = {taken:e}"),
    }
}

/// The quantity's value under other inputs, where it has one.
pub(super) fn value_of(quantity: &Quantity, inputs: &Inputs) -> Option<f64> {
    value(
        quantity,
        &model::solve(inputs, Stages::of(quantity.stage)).ok()?,
    )
}

/// The quantity under every stiffness model that covers the pair.
fn over_models(quantity: &Quantity, known: &Known) -> Option<String> {
    let own = value(quantity, known.solution).filter(|_| !quantity.is_flag())?;
    let found = models(known.inputs).filter_map(|(_, inputs)| value_of(quantity, &inputs));
    let (least, most) = found.fold((own, own), |(least, most), value| {
        (least.min(value), most.max(value))
    });
    let share = |value: f64| format!("{:+.1} %", 100.0 * (value - own) / own.abs());
    (most - least > noise(quantity, known.inputs) * own.abs()).then(|| {
        format!(
            "Stiffness: the models in range give {} to {} ({} to {}). A tooth's stiffness is honestly known to 20 %, which is 10 % \
             on the impact force.",
            shown(quantity, least),
            shown(quantity, most),
            share(least),
            share(most)
        )
    })
}

/// The methods side by side, where they differ.
fn over_methods(quantity: &Quantity, known: &Known) -> Option<String> {
    let by = |method: Method| {
        let solution = model::solve(
            &Inputs {
                method,
                ..known.inputs.clone()
            },
            Stages::of(quantity.stage),
        )
        .ok()?;
        Some((
            method,
            value_as_in(quantity, &solution, known.solution.method)?,
        ))
    };
    let own = Some(known.inputs.method).filter(|method| !Method::CLOSED_FORM.contains(method));
    let found: Vec<(Method, f64)> = Method::CLOSED_FORM
        .into_iter()
        .chain(own)
        .filter_map(by)
        .collect();
    let (&(_, first), others) = found.split_first()?;
    let apart = |(_, value): &(Method, f64)| {
        (value - first).abs() > noise(quantity, known.inputs) * first.abs()
    };
    let told: Vec<String> = found
        .iter()
        .map(|&(method, value)| format!("{} {}", name(quantity, method), shown(quantity, value)))
        .collect();
    others
        .iter()
        .any(apart)
        .then(|| format!("Methods: {}.", told.join(", ")))
}

/// The method; of the free impact, where the method resolves the impact itself, what the closed
/// form takes from it.
fn name(quantity: &Quantity, method: Method) -> String {
    let is_beside = method.shares_load() && quantity.is_of_free_impact();
    if is_beside {
        format!("exact with the deflection that {} computes", method.name())
    } else {
        method.name().to_owned()
    }
}
