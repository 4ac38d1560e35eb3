//! Rules between the fields of a case.

use super::circles;
use super::problem::Problem;
use crate::model::Inputs;

/// Limit of the ratio of tooth numbers and of its reciprocal.
const MOST_RATIO: f64 = 50.0;

/// The first rule between fields that these inputs violate.
#[must_use]
pub fn violated_rule(inputs: &Inputs) -> Option<Problem> {
    together(inputs, |_| true).into_iter().next()
}

/// Checks the rules between fields. Skips a rule if one of its fields is invalid.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    /// A study does not check points that differ from a checked point only in these fields.
    #[test]
    fn no_rule_between_fields_reads_load_or_deviations() {
        for (key, value) in [
            ("operation.power", "1 kW"),
            ("operation.torque", "1 N m"),
            ("model.deflection", "900 um"),
            ("deviations.base_pitch", "900 um"),
            ("driver.base_pitch", "900 um"),
            ("driven.base_pitch", "900 um"),
            ("deviations.backlash", "900 um"),
            ("driven.tip_relief", "900 um"),
            ("driver.root_relief", "900 um"),
        ] {
            let misfits = [false, true].map(|edited| {
                let mut case = Case::table_1();
                if edited {
                    case.set(key, value).unwrap();
                }
                [0.02, 0.06].map(|bore_radius| {
                    let mut inputs = case.inputs().unwrap();
                    inputs.driver.bore_radius = bore_radius;
                    violated_rule(&inputs)
                })
            });
            assert_eq!(misfits[0], misfits[1], "{key}");
            assert!(misfits[0][0].is_none() && misfits[0][1].is_some());
        }
    }
}
