//! Notes on the range of the stiffness models.

use super::{Note, four};
use crate::model::compliance::model_of;
use crate::model::compliance::tooth::preferences;
use crate::model::inputs::Method;
use crate::model::{Inputs, Solution};

/// The pair's range determined the model.
pub(super) fn chosen_by_range(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let used = solution.compliance?.model.model();
    let [first, ..] = preferences(inputs);
    let message = || {
        let why = (first.why_outside)(inputs);
        format!("the tooth compliance is `{}`: {why}", used.name)
    };
    let is_second_choice = inputs.tooth_compliance.is_none() && used.name != first.name;
    is_second_choice.then(|| Note::new(used.chosen, message()))
}

/// The model is used outside its range.
pub(super) fn outside_range(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let used = solution.compliance?.model.model();
    let (code, message) = (used.outside)(inputs, &solution.geometry)?;
    Some(Note::new(code, message))
}

/// The contact is not small against the tooth.
pub(super) fn hertz_width(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    const SMALL: f64 = 0.1;
    let half_width = solution.impact?.hertz_half_width();
    let limit = SMALL * inputs.module;
    let message = || {
        format!(
            "the Hertz half-width is {} mm and should be below {} mm, a tenth of the module",
            four(half_width * 1e3),
            four(limit * 1e3)
        )
    };
    (half_width > limit).then(|| Note::new("hertz-width-not-small", message()))
}

/// The model has independent springs although the method supports coupling.
pub(super) fn without_coupling(inputs: &Inputs, solution: &Solution) -> Option<Note> {
    let is_coupled = match solution.method {
        Method::Static | Method::Dynamic => true,
        Method::Exact => inputs.deflection.is_none(),
        Method::Paper | Method::Auto => false,
    };
    let model = model_of(inputs).model();
    let message = || {
        format!(
            "`{}` does not couple neighbouring teeth. Without coupling, the first contact is {} \
                earlier and the peak force changes by {} (elastic field with and without \
                coupling, cases/)",
            model.name, UNCOUPLED.0, UNCOUPLED.1
        )
    };
    (is_coupled && !model.has_coupling).then(|| Note::new("no-coupling", message()))
}

/// Changes of first contact and peak force in `dynamic` without coupling, with finite elements over
/// `cases/`.
const UNCOUPLED: (&str, &str) = ("2 to 13 %", "-12 to +14 %");
