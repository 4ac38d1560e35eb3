//! The explanation of a result: formula, the formula with the numbers of the case, source,
//! corrections to the paper, validity, accuracy and sensitivity.
//!
//! The sentences and formulas of a quantity are in its row of
//! [`QUANTITIES`](crate::model::QUANTITIES).

mod derivation;
mod effects;
mod text;

use std::io::{self, Write};

use crate::case::Case;
use crate::case::units::System;
use crate::model::explanation::{Context, Finding};
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Solution, auto};
use crate::report::absence::Absence;
use crate::report::json::{json, write_line};
use crate::report::verdict::Beside;
use crate::report::{Shown, shown, value};
use derivation::Known;
pub use derivation::{How, Leaf, STEP_UNITS, Token, Work, tokens};
pub use effects::Effect;
use serde::Serialize;
pub use text::{Kind, Line, lines, render};

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
    pub meaning: String,
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
    let (derivation, leaves) = derivation::derivation_of(quantity, &known);
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
        corrections: quantity.corrections.iter().filter_map(correction_of).collect(),
        assumptions: quantity.assumptions_in(&used),
        validity: quantity.checks.iter().filter_map(|check| check(&known.context)).collect(),
        accuracy: effects::accuracy_of(quantity, &known),
        effects: effects::effects_of(quantity, &known),
    }
}

/// Writes the page as one line; `name` is the name of the case.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(page: &Page, name: &str, out: &mut dyn Write) -> io::Result<()> {
    let quantity = page.quantity;
    let validity = page.validity.iter().map(
        |Finding { range, here, inside }| json!({"range": range, "here": here, "inside": inside}),
    );
    let line = json!({
        "case": name,
        "method": page.method,
        "key": quantity.key,
        "symbol": page.symbol,
        "label": page.label,
        "equation": quantity.equation,
        "unit": quantity.unit,
        "value": page.value,
        "shown": page.shown,
        "missing": page.missing,
        "meaning": page.meaning,
        "beside": page.beside,
        "derivation": page.derivation,
        "with": page.leaves,
        "source": page.source,
        "corrections": page.corrections,
        "assumptions": page.assumptions,
        "validity": validity.collect::<Vec<_>>(),
        "accuracy": page.accuracy,
        "sensitivity": page.effects,
    });
    write_line(&line, out)
}

/// A misprint and its correction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Correction {
    /// The equation, or another place in the paper.
    pub equation: &'static str,
    /// The error.
    pub error: &'static str,
    /// The form that the program uses.
    pub used: &'static str,
}

const fn row(equation: &'static str, error: &'static str, used: &'static str) -> Correction {
    Correction { equation, error, used }
}

/// Every misprint that affects a quantity.
pub static CORRECTIONS: &[Correction] = &[
    row(
        "Eq. 1",
        "scales the modification e_m by 1/√2 with the random pitch errors, as if a \
        ground relief were random",
        "method paper keeps this; the other methods count e_m in full",
    ),
    row(
        "Eqs. 7-20",
        "differences of arctangents, linear in Δ, place D next to E, where the tip \
        has closed almost nothing of Δ",
        "method paper keeps them; the other methods solve S(u) = Δ",
    ),
    row(
        "Eq. 14",
        "arctan(r_b1/(N1E - Δf)) jumps by π if Δf > N1E",
        "the difference of Eq. 15 as \
        one atan2; Eqs. 17-19 likewise",
    ),
    row(
        "Eqs. 16, 20",
        "compute N1E from a rounded contact ratio, 0.6 um off for Table 1",
        "N1E = a sin α_w - √(r_a2² - r_b2²)",
    ),
    row("Eq. 22", "has the label ΔV_Dr", "ΔV_Dτ"),
    row(
        "Eqs. 27, 42, 60",
        "print the law of cosines as a root times a root: the approach \
        velocity at E would be 1.32 m/s for Table 1 instead of 0",
        "the law of cosines",
    ),
    row(
        "Eq. 31",
        "adds an impulse along V_D2 and divides by kg/m instead of kg",
        "as printed, with m_red in kg",
    ),
    row(
        "Eq. 32",
        "omits Hertz's prefactor 4.53398, and m_red is per width",
        "as printed with m_red in kg; also with the prefactor, and by the spring of \
        the model, which method exact uses",
    ),
    row(
        "Eq. 33, Eq. 50",
        "define two reduced masses, with r_b2 and with r_b2'",
        "Eq. 33 for T_S,32, Eq. 50 for F_S",
    ),
    row(
        "Eq. 34",
        "uses Δθ for another angle at O1 in its triangle",
        "method paper keeps this; \
        method exact uses the driven tip at u - ω_2 T_S,32, at most at E",
    ),
    row("Eq. 36", "uses the arc for the chord", "the chord"),
    row(
        "Eqs. 44, 45",
        "do not define V_D'n and V_Dn",
        "the changes of ΔV_n and ΔV_τ between D \
        and D'",
    ),
    row(
        "Eq. 46",
        "J/(b r_b²) is a mass per width",
        "J/r_b² in kg; energies are of the whole \
        width",
    ),
    row("Eq. 47", "divides by 2 g", "J = π ρ b/2 (r_b⁴ - r_h⁴)"),
    row("Eq. 53", "δ_s = F_S/(b q_s) is inverted", "δ_s = F_S q_s/b, which agrees with Eq. 57"),
    row("Eq. 54", "names the teeth 1-2", "the pair in contact at D, 3-4"),
    row(
        "Eq. 55",
        "does not define a",
        "Hertz's half-width under F_S, solved together with F_S; \
        1/E' = Σ (1 - ν²)/E",
    ),
    row(
        "Eq. 56",
        "is a cubic in z and diverges outside its range",
        "outside z 12..100 and |x| <= 0.6, kuang-yang is refused; with a given model.deflection, \
            methods paper and exact omit only force, energy and duration. Outside this range the \
            default is another tooth compliance",
    ),
    row(
        "Eq. 64",
        "is 0/0 without contact, and no Coulomb coefficient limits it",
        "no value \
        without contact; the μ of the case and stick_limit beside it",
    ),
    row(
        "Table 1",
        "prints no face width, and calls a radius of 20 mm d0",
        "the face width of the case; 20 mm as the bore radius",
    ),
    row(
        "section 6",
        "no consistent reading of Table 1 gives F_0 = 1260.8 N and f = 0.1811",
        "F_0 = T1/r_b1, 1524.3 N there; f by Eq. 64",
    ),
];

/// The correction of an equation.
fn correction_of(equation: &&str) -> Option<&'static Correction> {
    CORRECTIONS.iter().find(|correction| correction.equation == *equation)
}
