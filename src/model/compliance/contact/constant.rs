//! Contact compliance independent of the half-width.

use std::f64::consts::PI;

use super::{ContactLaw, ContactModel, Law, at_impact, plane_strain_compliance};
use crate::model::compliance::Elasticity;
use crate::model::explanation::Formula::Text;
use crate::model::explanation::Step;
use crate::model::inputs::ContactCompliance;

pub(super) const MODEL: ContactModel = ContactModel {
    name: "constant",
    index: "const",
    help: "Yang & Sun 1985",
    reads_half_width: false,
    reads_root: false,
    steps: &[Step {
        symbol: "q_H",
        meaning: "contact at any force, Yang & Sun 1985",
        unit: "um mm/N",
        formula: Text("2/(π E')"),
        value: at_impact,
    }],
    law: Law::Everywhere(constant),
};

impl ContactCompliance {
    /// 4 (1 − ν²)/(π E), Yang & Sun 1985.
    pub const CONSTANT: ContactCompliance = ContactCompliance::named(MODEL.name);
}

/// Contact compliance without the half-width, q_H = 4 (1 − ν²)/(π E), in m²/N.
///
/// # Source
/// Yang & Sun 1985, "A rotary model for spur gear dynamics". For two materials (1 − ν²)/E is the
/// mean.
fn constant(elasticity: &Elasticity) -> ContactLaw {
    ContactLaw { offset: 2.0 * plane_strain_compliance(elasticity) / PI, slope: 0.0 }
}
