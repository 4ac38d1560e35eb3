//! How far the impact force depends on the choice of stiffness model.

use super::compliance::kuang_yang;
use super::inputs::{ContactCompliance, Inputs, ToothCompliance};

/// Least and greatest impact force over the stiffness models that cover the pair, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// By the most compliant model.
    pub low: f64,
    /// By the stiffest model.
    pub high: f64,
}

/// The band of the impact force over every tooth and contact compliance that covers the pair, and
/// the case's own, with the deflection of each where the case does not give one: `force` by the
/// case's own, the others by `solved`, which has none where a model gives no answer.
#[must_use]
pub fn band(inputs: &Inputs, force: f64, solved: impl Fn(&Inputs) -> Option<f64>) -> Band {
    let teeth = ToothCompliance::ALL
        .into_iter()
        .filter(|&model| model == ToothCompliance::Beam || kuang_yang::covers(inputs));
    teeth
        .flat_map(|tooth| ContactCompliance::ALL.map(|contact| (tooth, contact)))
        .map(|(tooth, contact)| Inputs {
            tooth_compliance: Some(tooth),
            contact_compliance: contact,
            ..inputs.clone()
        })
        .filter_map(|chosen| solved(&chosen))
        .fold(
            Band {
                low: force,
                high: force,
            },
            |band, force| Band {
                low: band.low.min(force),
                high: band.high.max(force),
            },
        )
}
