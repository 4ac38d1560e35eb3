//! How far the impact force depends on the choice of stiffness model.

use super::compliance::contact::{self, ContactModel};
use super::compliance::tooth::{self, ToothModel};
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
    covering(inputs)
        .map(|(tooth, contact)| with(inputs, tooth, contact))
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

/// Every tooth model that covers the pair, with every contact model.
pub fn covering(
    inputs: &Inputs,
) -> impl Iterator<Item = (&'static ToothModel, &'static ContactModel)> + use<'_> {
    let teeth = tooth::MODELS
        .into_iter()
        .filter(|model| (model.covers)(inputs));
    teeth.flat_map(|tooth| contact::MODELS.map(|contact| (tooth, contact)))
}

/// The inputs with these models.
#[must_use]
pub fn with(inputs: &Inputs, tooth: &ToothModel, contact: &ContactModel) -> Inputs {
    Inputs {
        tooth_compliance: Some(ToothCompliance::named(tooth.name)),
        contact_compliance: ContactCompliance::named(contact.name),
        ..inputs.clone()
    }
}

/// The symbol of the impact force by these models.
#[must_use]
pub fn symbol(tooth: &ToothModel, contact: &ContactModel) -> String {
    format!("F_{},{}", tooth.index, contact.index)
}
