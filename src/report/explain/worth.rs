//! What a figure is worth: the numerical error, the spread of the stiffness models, the rungs side by side.

use super::known::Known;
use super::models::models;
use crate::model::inputs::Rung;
use crate::model::{self, Inputs, Quantity, Stages};
use crate::report::{shown, value};

/// A change of less is rounding.
pub(super) const ROUNDING: f64 = 1e-11;

/// What there is to say of a quantity's worth.
pub(super) fn of(quantity: &Quantity, known: &Known) -> Vec<String> {
    let parts: [fn(&Quantity, &Known) -> Option<String>; 3] = [numerical, over_models, over_rungs];
    parts.into_iter().filter_map(|part| part(quantity, known)).collect()
}

/// The promise of the arithmetic.
fn numerical(quantity: &Quantity, known: &Known) -> Option<String> {
    value(quantity, known.solution)?;
    let promise = if known.inputs.accurate { "1e-13" } else { "1e-12" };
    Some(format!("Arithmetic: good to {promise} of the value; {} digits are shown.", quantity.digits))
}

/// The quantity's value under other inputs, where it has one.
pub(super) fn value_of(quantity: &Quantity, inputs: &Inputs) -> Option<f64> {
    value(quantity, &model::solve(inputs, Stages::of(quantity.stage)).ok()?)
}

/// The quantity under every stiffness model that covers the pair.
fn over_models(quantity: &Quantity, known: &Known) -> Option<String> {
    let own = value(quantity, known.solution)?;
    let found = models(known.inputs).filter_map(|(_, inputs)| value_of(quantity, &inputs));
    let (least, most) = found.fold((own, own), |(least, most), value| (least.min(value), most.max(value)));
    let share = |value: f64| format!("{:+.1} %", 100.0 * (value - own) / own.abs());
    (most - least > ROUNDING * own.abs()).then(|| {
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

/// The rungs side by side, where they differ.
fn over_rungs(quantity: &Quantity, known: &Known) -> Option<String> {
    let by = |rung: Rung| Some((rung, value_of(quantity, &Inputs { rung, ..known.inputs.clone() })?));
    let found: Vec<(Rung, f64)> = [Rung::Paper, Rung::Exact].into_iter().filter_map(by).collect();
    let [(_, first), (_, second)] = found[..] else { return None };
    let told: Vec<String> = found.iter().map(|&(rung, value)| format!("{} {}", rung.name(), shown(quantity, value))).collect();
    ((first - second).abs() > ROUNDING * first.abs()).then(|| format!("Rungs: {}.", told.join(", ")))
}
