//! Compliance from the table of the case.

use super::{Kind, ToothModel};
use crate::model::explanation::Formula::Words;
use crate::model::explanation::{Step, step};
use crate::model::inputs::ToothCompliance;

/// The entry of the list.
pub const MODEL: ToothModel = ToothModel {
    name: "given",
    index: "given",
    range: "a case with the table [compliance]",
    covers: |inputs| inputs.given_compliance.is_some(),
    why_outside: |_| "the case has no table [compliance]".to_owned(),
    check: |_| None,
    outside: |_, _| None,
    chosen: "tooth-compliance-given",
    reads_root: false,
    has_contact: true,
    has_coupling: true,
    steps: STEPS,
    tooth: |_, _| Ok(Kind::Given),
};

impl ToothCompliance {
    /// The table of the case.
    pub const FROM_TABLE: ToothCompliance = ToothCompliance::named(MODEL.name);
}

const STEPS: &[Step] = &[
    step("q_1", "driver at D, contact left out", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driver)
    }),
    step("q_2", "driven gear at D, contact left out", "um mm/N", Words(FORMULA), |k| {
        Some(k.solution.compliance?.driven)
    }),
    step("q_H", "contact of both flanks", "um mm/N", Words(FORMULA), |k| {
        Some(k.inputs.given_compliance?.contact.at(-1.0))
    }),
];

const FORMULA: &str =
    "from the table [compliance] of the case: q (1 + c1 t + c2 t² + ..), t = 2 s/g_a - 1";
