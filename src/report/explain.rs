//! Results that explain themselves: for a quantity of a case the formula, the same with the case's
//! numbers in it, its source, what was mended, where it holds, what it is worth and what it depends
//! on.

mod context;
mod corrections;
mod derivation;
mod effects;
mod formula;
mod json;
mod models;
mod numbers;
mod page;
mod steps;
mod table;
mod uncertainty;
mod valid;

use super::absence::Absence;
use super::verdict::Beside;
use super::{Shown, shown, value};
use crate::case::Case;
use crate::case::units::System;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Solution, auto};

pub use context::{Known, STEP_UNITS};
pub use corrections::{Correction, MENDS};
pub use derivation::{How, Leaf, Work};
pub use effects::Effect;
pub use json::write as write_json;
pub use page::{Kind, Line, lines, render};
pub use valid::Finding;

/// All that there is to say of a quantity in a case.
#[derive(Debug, Clone)]
pub struct Page {
    /// The quantity.
    pub quantity: &'static Quantity,
    /// Its symbol in this method.
    pub symbol: &'static str,
    /// What it is in this method, in a few words.
    pub label: &'static str,
    /// The method of the solve.
    pub method: &'static str,
    /// Whether the method `auto` took it.
    pub is_by_auto: bool,
    /// Its value in SI, where it has one.
    pub value: Option<f64>,
    /// The value as a person reads it.
    pub shown: Option<Shown>,
    /// Why it has no value.
    pub missing: Option<String>,
    /// What it is and what it is good for.
    pub says: &'static str,
    /// What the method itself finds in its place, where it is of the free impact.
    pub beside: Option<String>,
    /// How it is found, the quantity first and then each step on the way.
    pub work: Vec<Work>,
    /// What the formulas take from elsewhere: other quantities, and fields.
    pub leaves: Vec<Leaf>,
    /// Author, year, equation.
    pub source: &'static str,
    /// What was mended in print.
    pub mended: Vec<&'static Correction>,
    /// What is taken for granted.
    pub assumes: &'static str,
    /// Where it holds, and how the case stands there.
    pub valid: Vec<Finding>,
    /// What the figure is worth.
    pub worth: Vec<String>,
    /// The fields that it depends on, and what a small step of each does.
    pub effects: Vec<Effect>,
}

/// Explain a quantity of a solved case. The solution must hold the quantity's stage; `None` for a
/// quantity that no explanation is written for.
#[must_use]
pub fn explain(
    quantity: &'static Quantity,
    case: &Case,
    inputs: &Inputs,
    solution: &Solution,
) -> Option<Page> {
    // What the method `auto` took is explained.
    let taken = if inputs.method == Method::Auto {
        auto::taken(inputs, solution.method)
    } else {
        inputs.clone()
    };
    let known = Known {
        case,
        inputs: &taken,
        given: inputs,
        solution,
    };
    let about = table::of(quantity)?;
    let otherwise = table::method_variants::of(quantity.key, &taken);
    let value = value(quantity, solution);
    let (work, leaves) = derivation::of(quantity, about, &known);
    Some(Page {
        quantity,
        symbol: quantity.symbol_in(solution.method),
        label: quantity.label_in(solution.method).trim_start(),
        method: solution.method.name(),
        is_by_auto: inputs.method == Method::Auto,
        value,
        shown: value.map(|value| shown(quantity, value)),
        missing: value
            .is_none()
            .then(|| format!("No value: {}", Absence::of(quantity, solution))),
        says: otherwise.map_or(about.says, |otherwise| otherwise.says),
        beside: Beside::of(quantity, solution)
            .map(|beside| format!("This is {}.", beside.told(System::Metric))),
        work,
        leaves,
        source: about.source,
        mended: about
            .mended
            .iter()
            .filter_map(|equation| corrections::find(equation))
            .collect(),
        assumes: otherwise
            .map(|otherwise| otherwise.assumes)
            .filter(|assumes| !assumes.is_empty())
            .unwrap_or(about.assumes),
        valid: about.valid.iter().filter_map(|look| look(&known)).collect(),
        worth: uncertainty::of(quantity, &known),
        effects: effects::of(quantity, &known),
    })
}
