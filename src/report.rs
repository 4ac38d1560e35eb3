//! What a person or a script reads of a solve.

use crate::case::units;
use crate::model::Quantity;

/// A value as a person reads it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// The number, rounded to the quantity's digits.
    pub number: String,
    /// The unit, empty for a number.
    pub unit: &'static str,
}

/// A value in SI, as a person reads it.
#[must_use]
pub fn shown(quantity: &Quantity, value: f64) -> Shown {
    let number = value / units::factor(quantity.shown).unwrap_or(1.0);
    Shown { number: format!("{number:.*}", quantity.digits), unit: if quantity.shown == "1" { "" } else { quantity.shown } }
}
