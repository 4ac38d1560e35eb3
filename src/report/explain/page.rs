//! The explanation of a quantity in a case.

use super::context::Known;
use super::corrections::{self, Correction};
use super::derivation::{self, Leaf, Work};
use super::effects::{self, Effect};
use super::uncertainty;
use crate::case::Case;
use crate::case::units::System;
use crate::model::explanation::{Context, Finding};
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Solution, auto};
use crate::report::absence::Absence;
use crate::report::verdict::Beside;
use crate::report::{Shown, shown, value};

/// An explained quantity.
#[derive(Debug, Clone)]
pub struct Page {
    /// The quantity.
    pub quantity: &'static Quantity,
    /// Its symbol in the method of the solution.
    pub symbol: &'static str,
    /// Its label in the method of the solution.
    pub label: &'static str,
    /// The method of the solution.
    pub method: &'static str,
    /// Whether method `auto` chose this method.
    pub is_by_auto: bool,
    /// The value in SI, if any.
    pub value: Option<f64>,
    /// The value as text.
    pub shown: Option<Shown>,
    /// Why the value is absent.
    pub missing: Option<String>,
    /// The meaning and the use of the quantity.
    pub meaning: &'static str,
    /// For a quantity of the free impact, its counterpart in the method.
    pub beside: Option<String>,
    /// The formula of the quantity, then the formula of each step.
    pub derivation: Vec<Work>,
    /// The other quantities and the fields in the formulas.
    pub leaves: Vec<Leaf>,
    /// Author, year, equation.
    pub source: &'static str,
    /// Corrected misprints.
    pub corrections: Vec<&'static Correction>,
    /// The assumptions of the formula.
    pub assumptions: &'static str,
    /// The ranges of validity with the values of the case.
    pub validity: Vec<Finding>,
    /// Sentences on the accuracy.
    pub accuracy: Vec<String>,
    /// The fields that the quantity depends on, with its change for a small step of each.
    pub effects: Vec<Effect>,
}

/// Explains a quantity of a solved case. The solution must include the stage of the quantity.
#[must_use]
pub fn explain(
    quantity: &'static Quantity,
    case: &Case,
    inputs: &Inputs,
    solution: &Solution,
) -> Page {
    let solution = solution.having(quantity.stage);
    let is_by_auto = inputs.method == Method::Auto;
    let used = if is_by_auto { auto::taken(inputs, solution.method) } else { inputs.clone() };
    let context = Context { inputs: &used, given: inputs, solution };
    let known = Known { case, context };
    let value = value(quantity, solution);
    let (derivation, leaves) = derivation::of(quantity, &known);
    Page {
        quantity,
        symbol: quantity.symbol_in(solution.method),
        label: quantity.label_in(solution.method).trim_start(),
        method: solution.method.name(),
        is_by_auto,
        value,
        shown: value.map(|value| shown(quantity, value)),
        missing: value.is_none().then(|| format!("No value: {}", Absence::of(quantity, solution))),
        meaning: quantity.meaning_in(&used),
        beside: Beside::of(quantity, solution)
            .map(|beside| format!("This is {}.", beside.sentence(System::Metric))),
        derivation,
        leaves,
        source: quantity.source,
        corrections: quantity
            .corrections
            .iter()
            .filter_map(|equation| corrections::find(equation))
            .collect(),
        assumptions: quantity.assumptions_in(&used),
        validity: quantity.checks.iter().filter_map(|check| check(&known.context)).collect(),
        accuracy: uncertainty::of(quantity, &known),
        effects: effects::of(quantity, &known),
    }
}
