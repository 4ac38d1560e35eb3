//! Comparison of several methods: the governing method, and the others in one line.

use super::absence::listed;
use super::digest::first_touch;
use super::{shown_in, value};
use crate::case::units::System;
use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity, Solution};

/// A note if other methods find another outcome: which methods, and why the governing method
/// counts; from the full text to the shortest.
#[must_use]
pub fn differing(governing: &Solution, others: &[&Solution]) -> Option<[String; 3]> {
    let differs = |other: &&&Solution| other.outcome != governing.outcome;
    let names: Vec<&str> = others.iter().filter(differs).map(|other| other.method.name()).collect();
    let find = if names.len() == 1 { "finds" } else { "find" };
    let found = match governing.outcome {
        Outcome::CornerContact => "no corner contact",
        Outcome::NoCornerContact => "corner contact",
    };
    let (own, names) = (governing.method.name(), (!names.is_empty()).then(|| listed(&names))?);
    let chosen = if governing.choice.is_some() { "auto chose it" } else { "the case selects it" };
    let why = match governing.method {
        Method::Dynamic => ", and it includes inertia",
        Method::Static => ", and it shares the load among all pairs",
        Method::Paper | Method::Exact | Method::Auto => "",
    };
    Some([
        format!("{names} {find} {found}; {own} governs: {chosen}{why}"),
        format!("{names} {find} {found}; {own} governs"),
        format!("{own} governs; {names} {}", find.replace("find", "differ")),
    ])
}

/// The results of the closed forms beside a method that resolves the impact, or of the other closed
/// form, in one line.
#[must_use]
pub fn closed_forms(
    governing: &Solution,
    others: &[&Solution],
    is_deflection_given: bool,
    system: System,
) -> Option<String> {
    let is_free = governing.method.shares_load();
    let found: Vec<String> = others
        .iter()
        .filter(|other| !other.method.shares_load())
        .filter_map(|other| closed_form(other, system))
        .collect();
    let what = match (is_free, found.len()) {
        (_, 0) => return None,
        (true, _) => "Free impact",
        (false, 1) => "Other method",
        (false, _) => "Other methods",
    };
    let given = if is_free && is_deflection_given { " with the given deflection" } else { "" };
    Some(format!("{what}{given}: {}", found.join("; ")))
}

fn closed_form(solution: &Solution, system: System) -> Option<String> {
    let shown = |key| {
        let quantity = Quantity::find(key)?;
        Some(shown_in(quantity, value(quantity, solution)?, system))
    };
    let method = solution.method.name();
    Some(match solution.outcome {
        Outcome::NoCornerContact => {
            format!("{method} no corner contact, Δ = {}", shown("total_deviation")?)
        }
        Outcome::CornerContact => {
            let (quantity, angle) = first_touch(solution)?;
            let angle = shown_in(quantity, angle, system);
            format!("{method} {} at {} = {angle}", shown("impact_force")?, quantity.symbol)
        }
    })
}
