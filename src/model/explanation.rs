//! The types that describe quantities, steps and compliance models on the pages of `explain`.

use super::{Inputs, Solution};

/// A solved case, the argument of formulas and checks.
#[derive(Debug, Clone, Copy)]
pub struct Context<'a> {
    /// The inputs with the settings that the method `auto` chose.
    pub inputs: &'a Inputs,
    /// The inputs as the case gives them.
    pub given: &'a Inputs,
    /// The results.
    pub solution: &'a Solution,
}

/// A condition on the inputs.
pub type When = fn(&Inputs) -> bool;

/// How a value is computed.
#[derive(Debug, Clone, Copy)]
pub enum Formula {
    /// An explicit right-hand side.
    Text(&'static str),
    /// An explicit right-hand side that subtracts close numbers: a page shows its terms with more
    /// digits.
    Difference(&'static str),
    /// An explicit right-hand side whose number of terms depends on the case.
    Made(fn(&Context) -> String),
    /// The first formula whose condition is true.
    Cases(&'static [(When, Formula)]),
    /// The case gives the value in the field of this key.
    Given(&'static str),
    /// The root of an equation.
    Solved(&'static Equation),
    /// A description in words.
    Words(&'static str),
    /// A description in words and the symbols that the page explains after it.
    Found(&'static str, &'static [&'static str]),
}

/// An equation that a solver solves.
#[derive(Debug, Clone, Copy)]
pub struct Equation {
    /// The equation as text.
    pub text: &'static str,
    /// The left side.
    pub left: Formula,
    /// The right side.
    pub right: Formula,
    /// The unit in which a page shows both sides.
    pub unit: &'static str,
    /// Both sides at the root, in SI.
    pub sides: fn(&Context) -> Option<[f64; 2]>,
}

/// An intermediate value between the fields and a quantity.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// The symbol in formulas.
    pub symbol: &'static str,
    /// A short description.
    pub meaning: &'static str,
    /// The unit in which a page shows the value.
    pub unit: &'static str,
    /// How the value is computed.
    pub formula: Formula,
    /// The value in SI. `None` if the case has no such value.
    pub value: fn(&Context) -> Option<f64>,
}

/// A row of a table of steps.
pub(super) const fn step(
    symbol: &'static str,
    meaning: &'static str,
    unit: &'static str,
    formula: Formula,
    value: fn(&Context) -> Option<f64>,
) -> Step {
    Step { symbol, meaning, unit, formula, value }
}

/// A range of validity and the values of a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The range.
    pub range: String,
    /// The values of the case as text.
    pub here: String,
    /// Whether the case is inside.
    pub inside: bool,
}

/// Compares a case with a range of validity. `None` if the case has no value to compare.
pub type Check = fn(&Context) -> Option<Finding>;

impl Finding {
    /// A finding, as the result of a [`Check`].
    pub fn new(range: impl Into<String>, here: impl Into<String>, inside: bool) -> Option<Finding> {
        Some(Finding { range: range.into(), here: here.into(), inside })
    }
}

impl Formula {
    /// The formula that this case uses.
    pub fn resolved(self, inputs: &Inputs) -> Formula {
        match self {
            Formula::Cases(cases) => cases
                .iter()
                .find(|(when, _)| when(inputs))
                .map_or(Formula::Words(""), |(_, formula)| formula.resolved(inputs)),
            other => other,
        }
    }

    /// The right-hand side if the formula is explicit.
    pub fn explicit(self, context: &Context) -> Option<String> {
        let text = match self.resolved(context.inputs) {
            Formula::Text(text) | Formula::Difference(text) => text.to_owned(),
            Formula::Made(make) => make(context),
            _ => return None,
        };
        Some(in_section(&text, context.inputs))
    }
}

/// A formula in the symbols of the pair: the transverse section of a spur pair is the normal section.
pub fn in_section(formula: &str, inputs: &Inputs) -> String {
    if inputs.helix_angle > 0.0 {
        return formula.to_owned();
    }
    formula.replace("α_t", "α").replace("m_t", "m").replace("z_n", "z")
}

/// A number with `digits` significant digits. Removes trailing zeros if the shorter number is
/// exact.
pub fn tidy(value: f64, digits: usize) -> String {
    const EXACT: f64 = 4.0 * f64::EPSILON;
    let full = crate::numeric::decimal::significant(value, digits);
    if !full.contains('.') || full.contains('e') {
        return full;
    }
    let short = full.trim_end_matches('0').trim_end_matches('.');
    let exact =
        short.parse::<f64>().is_ok_and(|found| (found - value).abs() <= EXACT * value.abs());
    if exact { short.to_owned() } else { full }
}

/// A length in mm with five digits.
pub(super) fn mm(length: f64) -> String {
    format!("{} mm", tidy(length * 1e3, 5))
}

/// A time or a length in millionths of its unit, with four digits.
pub(super) fn micro(value: f64, unit: &str) -> String {
    format!("{} {unit}", tidy(value * 1e6, 4))
}

/// A number with four digits.
pub(super) fn four(value: f64) -> String {
    tidy(value, 4)
}
