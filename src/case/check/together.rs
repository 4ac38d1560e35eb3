//! Rules between the fields of a case.

use super::circles;
use super::problem::Problem;
use crate::model::Inputs;

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
    for circles in &circles::OF_GEARS {
        found.extend(circles.misfits(inputs, &sound));
    }
    if sound(&["driver.teeth", "driven.teeth"]) {
        found.extend(ratio_beyond(inputs));
    }
    found
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
