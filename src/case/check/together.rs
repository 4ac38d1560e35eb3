//! Rules between the fields of a case.

use super::problem::Problem;
use crate::model::Inputs;
use crate::model::inputs::Gear;

/// The greatest ratio of tooth numbers, either way.
const MOST_RATIO: f64 = 50.0;

/// The first rule between fields that these inputs break.
#[must_use]
pub fn misfit_between(inputs: &Inputs) -> Option<Problem> {
    together(inputs, |_| true).into_iter().next()
}

/// What one field alone cannot show. A rule is left out while a field that it reads is itself not
/// sound.
pub(super) fn together(inputs: &Inputs, sound: impl Fn(&[&str]) -> bool) -> Vec<Problem> {
    let mut found = Vec::new();
    if sound(&[
        "pair.module",
        "driver.teeth",
        "driver.profile_shift",
        "driver.bore_radius",
    ]) {
        found.extend(bore_through_root(
            "driver.bore_radius",
            &inputs.driver,
            inputs.module,
        ));
    }
    if sound(&[
        "pair.module",
        "driven.teeth",
        "driven.profile_shift",
        "driven.bore_radius",
    ]) {
        found.extend(bore_through_root(
            "driven.bore_radius",
            &inputs.driven,
            inputs.module,
        ));
    }
    if sound(&["driver.teeth", "driven.teeth"]) {
        found.extend(ratio_beyond(inputs));
    }
    found
}

fn bore_through_root(field: &str, gear: &Gear, module: f64) -> Option<Problem> {
    let root = module * (f64::from(gear.teeth) / 2.0 - gear.dedendum + gear.profile_shift);
    (gear.bore_radius >= root).then(|| {
        let (bore, root) = (rounded(gear.bore_radius), rounded(root));
        let cause = format!(
            "the bore radius {bore} mm is not below the root circle's {root} mm = m (z/2 - hf* + x)"
        );
        Problem::new(
            field,
            cause,
            format!("write a radius (not a diameter) below {root} mm"),
        )
    })
}

/// A length in mm as a message shows it.
fn rounded(metres: f64) -> f64 {
    (metres * 1e7).round() / 1e4
}

fn ratio_beyond(inputs: &Inputs) -> Option<Problem> {
    let ratio = inputs.ratio();
    let inside = (1.0 / MOST_RATIO..=MOST_RATIO).contains(&ratio);
    (!inside).then(|| {
        let cause = format!(
            "the ratio of tooth numbers {}/{} is {ratio:.4}",
            inputs.driven.teeth, inputs.driver.teeth
        );
        Problem::new(
            "driven.teeth",
            cause,
            format!("keep it within 1/{MOST_RATIO} to {MOST_RATIO}"),
        )
    })
}
