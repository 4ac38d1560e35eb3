//! The one table of explanations: for every quantity what it is, its formula, its source, and where
//! it holds.

mod deviation;
mod friction;
mod geometry;
mod impact;
mod load;
pub(super) mod method_variants;
mod position;

use super::context::Formula;
use super::valid::Look;
use crate::model::Quantity;

/// What there is to know of a quantity, whatever the case.
#[derive(Debug)]
pub(super) struct Explanation {
    /// The quantity's key.
    pub(super) key: &'static str,
    /// What it is and what it is good for.
    pub(super) says: &'static str,
    /// How it is found.
    pub(super) formula: Formula,
    /// Author, year, equation.
    pub(super) source: &'static str,
    /// The equations of [`MENDS`](super::corrections::MENDS) that it rests on.
    pub(super) mended: &'static [&'static str],
    /// What is taken for granted.
    pub(super) assumes: &'static str,
    /// Where it holds, and how a case stands there.
    pub(super) valid: &'static [Look],
}

/// Every explanation.
pub(super) fn explanations() -> impl Iterator<Item = &'static Explanation> {
    [
        geometry::TABLE,
        deviation::TABLE,
        position::TABLE,
        impact::TABLE,
        friction::TABLE,
        load::TABLE,
    ]
    .into_iter()
    .flatten()
}

/// The explanation of a quantity.
pub(super) fn of(quantity: &Quantity) -> Option<&'static Explanation> {
    explanations().find(|explanation| explanation.key == quantity.key)
}
