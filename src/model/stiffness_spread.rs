//! Spread of the impact force over the stiffness models.

use super::compliance::contact::{self, ContactModel};
use super::compliance::model_of;
use super::compliance::tooth::{self, ToothModel};
use super::deviation::DeviationInputs;
use super::impact::ImpactInputs;
use super::inputs::{ContactCompliance, Inputs, ToothCompliance};
use super::position::PositionInputs;
use super::velocity::VelocityInputs;

/// Inputs of the stages that [`band`] repeats with other models, besides geometry, load and masses,
/// which are the same for all models.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandInputs {
    /// Deviation and deflection.
    pub deviation: DeviationInputs,
    /// First contact.
    pub position: PositionInputs,
    /// Velocities at D.
    pub velocity: VelocityInputs,
    /// The impact.
    pub impact: ImpactInputs,
}

impl BandInputs {
    /// Selects the stage inputs from the inputs of a solve.
    #[must_use]
    pub fn of(inputs: &Inputs) -> BandInputs {
        BandInputs {
            deviation: DeviationInputs::of(inputs),
            position: PositionInputs::of(inputs),
            velocity: VelocityInputs::of(inputs),
            impact: ImpactInputs::of(inputs),
        }
    }
}

/// Least and greatest impact force over the stiffness models that cover the pair, in N.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// By the most compliant models.
    pub low: f64,
    /// By the stiffest models.
    pub high: f64,
}

/// A tooth model with a contact model.
#[derive(Debug, Clone, Copy)]
pub struct StiffnessModels {
    /// Model of the teeth.
    pub tooth: &'static ToothModel,
    /// Model of the contact; `None` if the model of the teeth includes the contact.
    pub contact: Option<&'static ContactModel>,
}

impl PartialEq for StiffnessModels {
    fn eq(&self, other: &StiffnessModels) -> bool {
        let contact = |models: &StiffnessModels| models.contact.map(|contact| contact.name);
        self.tooth.name == other.tooth.name && contact(self) == contact(other)
    }
}

impl StiffnessModels {
    /// The models of a pair: given by the case, otherwise by range and method.
    #[must_use]
    pub fn of(inputs: &Inputs) -> StiffnessModels {
        let tooth = model_of(inputs).model();
        StiffnessModels {
            tooth,
            contact: (!tooth.has_contact).then(|| inputs.contact_compliance.model()),
        }
    }

    /// The models that cover the pair, without the models of the case.
    pub fn others(inputs: &Inputs) -> impl Iterator<Item = StiffnessModels> {
        let own = StiffnessModels::of(inputs);
        StiffnessModels::covering(inputs).filter(move |models| *models != own)
    }

    /// The models of a pair whose case names no tooth compliance.
    #[must_use]
    pub fn by_default(inputs: &Inputs) -> StiffnessModels {
        StiffnessModels::of(&Inputs { tooth_compliance: None, ..inputs.clone() })
    }

    /// Every tooth model with every contact model that it needs.
    pub fn all() -> impl Iterator<Item = StiffnessModels> {
        tooth::MODELS.into_iter().flat_map(|tooth| {
            let own = tooth.has_contact.then_some(None);
            let others = contact::MODELS.map(Some);
            let others = others.into_iter().filter(|_| !tooth.has_contact);
            own.into_iter().chain(others).map(move |contact| StiffnessModels { tooth, contact })
        })
    }

    /// The models whose tooth model covers the pair.
    pub fn covering(inputs: &Inputs) -> impl Iterator<Item = StiffnessModels> {
        let covers = tooth::MODELS.map(|model| (model.covers)(inputs));
        let covering = move |models: &StiffnessModels| {
            let all = tooth::MODELS.iter().zip(covers);
            all.into_iter().any(|(model, covers)| covers && model.name == models.tooth.name)
        };
        StiffnessModels::all().filter(covering)
    }

    /// The inputs with these models.
    #[must_use]
    pub fn in_place_of(&self, inputs: &Inputs) -> Inputs {
        let contact = self
            .contact
            .map_or(inputs.contact_compliance, |contact| ContactCompliance::named(contact.name));
        Inputs {
            tooth_compliance: Some(ToothCompliance::named(self.tooth.name)),
            contact_compliance: contact,
            ..inputs.clone()
        }
    }

    /// The symbol of the impact force by these models.
    #[must_use]
    pub fn symbol(&self) -> String {
        let contact = self.contact.map_or(String::new(), |contact| format!(",{}", contact.index));
        format!("F_{}{contact}", self.tooth.index)
    }

    /// The names of the models.
    #[must_use]
    pub fn names(&self) -> String {
        let contact =
            self.contact.map_or(String::new(), |contact| format!(" and {}", contact.name));
        format!("{}{contact}", self.tooth.name)
    }
}

/// The range of the impact force over every pair of stiffness models that covers the pair, and the
/// models of the case. Each force uses its own deflection unless the case gives the deflection.
/// `force` is the result of the case's models. `solved` computes the others, or `None` if a model
/// has no result.
#[must_use]
pub fn band(inputs: &Inputs, force: f64, solved: impl Fn(&Inputs) -> Option<f64>) -> Band {
    StiffnessModels::others(inputs).filter_map(|models| solved(&models.in_place_of(inputs))).fold(
        Band { low: force, high: force },
        |band, force| Band { low: band.low.min(force), high: band.high.max(force) },
    )
}
