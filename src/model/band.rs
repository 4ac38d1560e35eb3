//! How far the impact force depends on the choice of stiffness model.

use super::compliance::kuang_yang;
use super::inputs::{ContactCompliance, Inputs, ToothCompliance};
use super::stage::{Stage, Stages};

/// Least and greatest impact force over the stiffness models that cover the pair, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// By the most compliant model.
    pub low: f64,
    /// By the stiffest model.
    pub high: f64,
}

/// The band of the impact force over every tooth and contact compliance that covers the pair, and the case's own, with
/// the deflection of each where the case does not give one.
#[must_use]
pub fn band(inputs: &Inputs, force: f64) -> Band {
    let teeth = ToothCompliance::ALL.into_iter().filter(|&model| model == ToothCompliance::Beam || kuang_yang::covers(inputs));
    teeth
        .flat_map(|tooth| ContactCompliance::ALL.map(|contact| (tooth, contact)))
        .filter_map(|(tooth, contact)| force_by(inputs, tooth, contact))
        .fold(Band { low: force, high: force }, |band, force| Band { low: band.low.min(force), high: band.high.max(force) })
}

/// The impact force by one choice of models, where it has an answer.
fn force_by(inputs: &Inputs, tooth: ToothCompliance, contact: ContactCompliance) -> Option<f64> {
    let chosen = Inputs { tooth_compliance: Some(tooth), contact_compliance: contact, ..inputs.clone() };
    Some(super::solve(&chosen, Stages::of(Stage::Impact)).ok()?.impact?.force)
}
