//! Contact compliance logarithmic in the Hertz half-width, Eq. 55 of the paper.

use std::f64::consts::PI;

use super::{ContactLaw, ContactModel, Law, at_impact, plane_strain_compliance};
use crate::model::compliance::Elasticity;
use crate::model::explanation::Formula::Text;
use crate::model::explanation::Step;
use crate::model::inputs::ContactCompliance;

pub(super) const MODEL: ContactModel = ContactModel {
    name: "logarithmic",
    index: "log",
    help: "Eq. 55",
    reads_half_width: true,
    reads_root: false,
    steps: &[Step {
        symbol: "q_H",
        meaning: "contact at the impact force, Eq. 55",
        unit: "um mm/N",
        formula: Text("(1.27 + 0.781 ln(m/a_H))/(π E')"),
        value: at_impact,
    }],
    law: Law::Everywhere(logarithmic),
};

impl ContactCompliance {
    /// Eq. 55, logarithmic in the Hertz half-width.
    pub const LOGARITHMIC: ContactCompliance = ContactCompliance::named(MODEL.name);
}

/// Offset and slope of Eq. 55.
///
/// # Formula
/// ```text
/// qH = 2 (1 − ν²)/(π E) (1.27 + 0.781 ln(m/a))
/// ```
/// For two materials (1 − ν²)/E is the mean.
///
/// # Source
/// Zhou & Chen 2014, Eq. 55 (from Xiao & Tang 1995).
///
/// # Valid for
/// A half-width small against the module. q_H is negative for a above 5.08 m.
fn logarithmic(elasticity: &Elasticity) -> ContactLaw {
    const CONSTANT: f64 = 1.27;
    const FACTOR: f64 = 0.781;
    let give = plane_strain_compliance(elasticity);
    ContactLaw {
        offset: give / PI * (CONSTANT + FACTOR * elasticity.driver.rack.module.ln()),
        slope: give / PI * FACTOR,
    }
}
