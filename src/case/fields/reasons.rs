//! Reasons why a field has no effect in a case, or less effect than expected.

use crate::model::Inputs;
use crate::model::compliance::{contact_of, model_of};
use crate::model::inputs::Method;

use Reason::{Idle, Partly};

/// A condition on the inputs.
pub type When = fn(&Inputs) -> bool;

/// The reason why a field has no effect in a case, or less effect than expected.
#[derive(Debug, Clone, Copy)]
pub enum Reason {
    /// No stage reads the field.
    Idle(When, &'static str),
    /// No stage reads the field. Reports show it beside the results.
    Beside(&'static str),
    /// A stage reads the field, but the results depend less on it than expected.
    Partly(When, &'static str),
}

pub(super) const AT_RUN_OUT: &str = "this relief acts at run-out; this method computes only \
    run-in, where the driven tip meets the driver's root";
pub(super) const TIP_OF_DRIVER: &str = "the driver's tip ends contact at B; at run-in this field \
    affects only the number of loaded pairs";
pub(super) const IN_TIME: &str = "only the method dynamic follows the motion in time";
pub(super) const CURVE: &str = "changes only how closely the curve is sampled";

pub(super) const ROOT: [Reason; 1] = [Partly(
    |inputs| !root_is_read(inputs),
    "the tooth compliance ignores the root; only the stiffness spread changes, because the spread \
        includes the other models",
)];

/// Reasons for relief lengths and shapes.
pub(super) const WHOLE_RELIEF: [Reason; 1] = [Idle(
    by_impact,
    "this method applies the full relief at the first contact and ignores length and shape",
)];

pub(super) const LOAD: [Reason; 1] = [Partly(
    |inputs| inputs.method != Method::Auto && inputs.given_deflection().is_some(),
    "with the deflection given, the load changes F_0, not the impact",
)];

pub(super) const MASS: [Reason; 1] = [Partly(|inputs| inputs.method == Method::Static, NO_MASS)];

/// The tooth compliances that depend on the root include the body of the gear.
pub(super) const BORE: [Reason; 1] = [Partly(
    |inputs| inputs.method == Method::Static && !model_of(inputs).model().reads_root,
    NO_MASS,
)];

const NO_MASS: &str = "the static load does not depend on mass; only the free impact changes";

pub(super) fn always(_: &Inputs) -> bool {
    true
}

pub(super) fn by_impact(inputs: &Inputs) -> bool {
    !inputs.method.shares_load()
}

/// Whether the index of a gear is that of the driver.
pub(super) fn is_driver(index: &str) -> bool {
    index == "1"
}

/// Whether this face width is at least that of both gears, in method `static`.
pub(super) fn is_wider(inputs: &Inputs, width: f64) -> bool {
    let widest = inputs.driver.face_width.max(inputs.driven.face_width);
    inputs.method == Method::Static && width >= widest
}

/// Whether a compliance of the case depends on the root of the teeth.
fn root_is_read(inputs: &Inputs) -> bool {
    model_of(inputs).model().reads_root
        || contact_of(inputs).is_some_and(|contact| contact.model().reads_root)
}

#[cfg(test)]
mod tests {
    use crate::case::Case;
    use crate::model::inputs::{ContactCompliance, Inputs, ToothCompliance};
    use crate::model::{self, Stage, Stages};

    /// The notes beside dedendum and bore name the models that read them.
    #[test]
    fn a_stiffness_model_says_whether_it_reads_the_root() {
        let results = |tooth, contact, edit: fn(&mut Inputs)| {
            let mut inputs = Case::table_1().inputs().unwrap();
            (inputs.tooth_compliance, inputs.contact_compliance) = (Some(tooth), contact);
            edit(&mut inputs);
            let solution = model::solve(&inputs, Stages::of(Stage::Impact)).unwrap();
            let results = [solution.compliance.unwrap().driver, solution.impact.unwrap().force];
            results.map(f64::to_bits)
        };
        for tooth in ToothCompliance::ALL {
            for contact in ContactCompliance::ALL {
                let before = results(tooth, contact, |_| ());
                let reads = tooth.model().reads_root;
                let [bored, _] = results(tooth, contact, |inputs| inputs.driver.bore_radius = 9e-3);
                assert_eq!(bored != before[0], reads, "{}", tooth.name());
                let [_, deeper] = results(tooth, contact, |inputs| inputs.driver.dedendum = 1.3);
                let reads = reads || contact.model().reads_root;
                assert!(reads || deeper == before[1], "{} with {}", tooth.name(), contact.name());
            }
        }
    }
}
