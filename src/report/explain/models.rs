//! The stiffness models that cover a pair, by the symbol of the force that each gives.

use std::sync::LazyLock;

use crate::model::compliance::{contact, tooth};
use crate::model::inputs::Inputs;
use crate::model::stiffness_spread::{covering, with};

static SYMBOLS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let of = |tooth: &tooth::ToothModel| {
        contact::MODELS.map(|contact| format!("F_{},{}", tooth.index, contact.index))
    };
    tooth::MODELS.into_iter().flat_map(of).collect()
});

/// Every model that covers the pair, and the inputs with it.
pub(super) fn models(inputs: &Inputs) -> impl Iterator<Item = (&'static str, Inputs)> {
    covering(inputs).map(move |(tooth, contact)| {
        let name = format!("F_{},{}", tooth.index, contact.index);
        let symbol = SYMBOLS.iter().find(|symbol| **symbol == name);
        (
            symbol.map_or("", String::as_str),
            with(inputs, tooth, contact),
        )
    })
}
