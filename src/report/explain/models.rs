//! The stiffness models that cover a pair, by the symbol of the force that each gives.

use crate::model::compliance::kuang_yang;
use crate::model::inputs::{ContactCompliance, Inputs, ToothCompliance};

const MODELS: [(&str, ToothCompliance, ContactCompliance); 6] = [
    (
        "F_fit,log",
        ToothCompliance::KuangYang,
        ContactCompliance::Logarithmic,
    ),
    (
        "F_fit,const",
        ToothCompliance::KuangYang,
        ContactCompliance::Constant,
    ),
    (
        "F_fit,weber",
        ToothCompliance::KuangYang,
        ContactCompliance::Weber,
    ),
    (
        "F_beam,log",
        ToothCompliance::Beam,
        ContactCompliance::Logarithmic,
    ),
    (
        "F_beam,const",
        ToothCompliance::Beam,
        ContactCompliance::Constant,
    ),
    (
        "F_beam,weber",
        ToothCompliance::Beam,
        ContactCompliance::Weber,
    ),
];

/// Every model that covers the pair, and the inputs with it.
pub(super) fn models(inputs: &Inputs) -> impl Iterator<Item = (&'static str, Inputs)> {
    let fits = kuang_yang::covers(inputs);
    let covering = MODELS
        .into_iter()
        .filter(move |(_, tooth, _)| fits || *tooth == ToothCompliance::Beam);
    covering.map(|(symbol, tooth, contact)| {
        (
            symbol,
            Inputs {
                tooth_compliance: Some(tooth),
                contact_compliance: contact,
                ..inputs.clone()
            },
        )
    })
}
