//! The formula of a quantity and of each step before it, with the numbers of a case.

use super::context::{Known, Source, factor};
use super::substitution::{substituted, symbols, with_unit};
use crate::case::FIELDS;
use crate::model::Quantity;
use crate::model::explanation::{Equation, Formula, tidy};
use crate::numeric::decimal::significant;
use crate::report::{Shown, shown};

/// Significant digits of a step.
const STEP_DIGITS: usize = 5;

/// Additional digits of a term compared with the result.
const MORE_DIGITS: usize = 1;

/// Digits of the terms of a formula that subtracts close numbers.
const DIFFERENCE_DIGITS: usize = 10;

/// Bounds for the agreement of both sides of an equation.
const BOUNDS: [f64; 3] = [1e-12, 1e-9, 1e-6];

/// A value and how it is computed.
#[derive(Debug, Clone, PartialEq)]
pub struct Work {
    /// The symbol in formulas.
    pub symbol: &'static str,
    /// The meaning of a step; empty for the quantity itself.
    pub meaning: &'static str,
    /// The right-hand side, the equation, or a description.
    pub formula: String,
    /// How the formula gives the value.
    pub how: How,
    /// The right-hand side with numbers. No line ends between a number and its unit.
    pub numbers: Option<String>,
    /// The value as text.
    pub shown: Option<Shown>,
    /// Its significant digits.
    pub digits: usize,
    /// The value in SI.
    pub value: Option<f64>,
    /// The agreement of both sides of an equation at its root.
    pub residual: Option<String>,
}

/// How a formula gives a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// The value is the right-hand side.
    Equals,
    /// The value is the root of an equation.
    Solves,
    /// A description replaces the formula.
    Described,
}

/// A symbol of a formula whose value comes from another page or from the form.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaf {
    /// The symbol.
    pub symbol: &'static str,
    /// Its value as text.
    pub shown: String,
    /// Its value in SI.
    pub value: Option<f64>,
    /// Its meaning.
    pub meaning: &'static str,
    /// The key of the quantity or of the field.
    pub key: &'static str,
    /// Whether it is a quantity, with a page of its own.
    pub is_quantity: bool,
}

/// The derivation of a quantity, and the symbols that its formulas read from elsewhere.
pub(super) fn of(quantity: &'static Quantity, known: &Known) -> (Vec<Work>, Vec<Leaf>) {
    let mut work = derived(&Target::of(quantity, known), quantity.formula, known);
    let mut seen = vec![quantity.symbol_in(known.context.solution.method)];
    let mut leaves = Vec::new();
    let mut open = symbols_of(quantity.formula, known);
    let mut next = 0;
    while let Some(symbol) = open.get(next).cloned() {
        next += 1;
        let Some(source) =
            known.source(&symbol).filter(|source| !seen.contains(&source.symbol(known)))
        else {
            continue;
        };
        seen.push(source.symbol(known));
        let value = known.value(source);
        match source {
            Source::Step(step) => {
                let target = Target::step(step.symbol, step.meaning, value, step.unit);
                work.extend(derived(&target, step.formula, known));
                open.extend(symbols_of(step.formula, known));
            }
            Source::Force(force) => {
                let target = Target::step(&force.symbol, &force.meaning, value, "N");
                let formula = Formula::Words("a separate solution with these models");
                work.extend(derived(&target, formula, known));
            }
            Source::Quantity(_) | Source::Field(_) => leaves.extend(source.leaf(known)),
        }
    }
    (work, leaves)
}

struct Target {
    symbol: &'static str,
    meaning: &'static str,
    value: Option<f64>,
    digits: usize,
    shown: Option<Shown>,
}

impl Target {
    fn of(quantity: &'static Quantity, known: &Known) -> Target {
        let value = known.value(Source::Quantity(quantity));
        Target {
            symbol: quantity.symbol_in(known.context.solution.method),
            meaning: "",
            value,
            digits: quantity.digits,
            shown: value.map(|value| shown(quantity, value)),
        }
    }

    fn step(
        symbol: &'static str,
        meaning: &'static str,
        value: Option<f64>,
        unit: &'static str,
    ) -> Target {
        let shown = value.map(|value| Shown {
            number: tidy(value / factor(unit).unwrap_or(1.0), STEP_DIGITS),
            unit: if unit == "1" { "" } else { unit },
        });
        Target { symbol, meaning, value, digits: STEP_DIGITS, shown }
    }

    fn work(&self, how: How, formula: String) -> Work {
        Work {
            symbol: self.symbol,
            meaning: self.meaning,
            formula,
            how,
            numbers: None,
            shown: self.shown.clone(),
            digits: self.digits,
            value: self.value,
            residual: None,
        }
    }
}

/// The formula of a target: with numbers if it is explicit, with both sides if it is an equation.
fn derived(target: &Target, formula: Formula, known: &Known) -> Vec<Work> {
    match formula.resolved(known.context.inputs) {
        Formula::Given(key) => {
            let text = FIELDS
                .iter()
                .position(|field| field.key == key)
                .and_then(|field| known.case.effective(field));
            let text = format!("the case gives {key} = {}", text.unwrap_or_default());
            vec![target.work(How::Described, text)]
        }
        Formula::Words(words) | Formula::Found(words, _) => {
            vec![target.work(How::Described, words.to_owned())]
        }
        Formula::Solved(equation) => solved(target, equation, known),
        other => {
            let text = other.explicit(&known.context).unwrap_or_default();
            let digits = match other {
                _ if symbols(&text) == [text.as_str()] => target.digits,
                Formula::Difference(_) => DIFFERENCE_DIGITS,
                _ => target.digits + MORE_DIGITS,
            };
            let term = |symbol: &str| known.term(symbol);
            let numbers = target.value.and_then(|_| substituted(&text, digits, &term));
            vec![Work { numbers, ..target.work(How::Equals, text) }]
        }
    }
}

/// The root of an equation, its agreement, and both sides.
fn solved(target: &Target, equation: &'static Equation, known: &Known) -> Vec<Work> {
    let sides = target.value.and_then(|_| (equation.sides)(&known.context));
    let mut work = vec![Work {
        residual: sides.map(agreement),
        ..target.work(How::Solves, equation.text.to_owned())
    }];
    let side = |name, at: usize| Target::step(name, "", sides.map(|s| s[at]), equation.unit);
    work.extend(derived(&side("left side", 0), equation.left, known));
    work.extend(derived(&side("right side", 1), equation.right, known));
    work
}

/// How closely the two sides of an equation agree.
fn agreement([left, right]: [f64; 2]) -> String {
    let apart = (left - right).abs() / right.abs();
    let bound = BOUNDS.into_iter().find(|&bound| apart <= bound);
    let within = bound.map_or_else(|| significant(apart, 2), |bound| format!("{bound:e}"));
    format!("both sides agree within {within} of either")
}

/// The symbols of a formula, in reading order.
fn symbols_of(formula: Formula, known: &Known) -> Vec<String> {
    match formula.resolved(known.context.inputs) {
        Formula::Solved(equation) => [equation.left, equation.right]
            .into_iter()
            .flat_map(|side| symbols_of(side, known))
            .collect(),
        Formula::Found(_, with) => with.iter().map(|&symbol| symbol.to_owned()).collect(),
        other => other.explicit(&known.context).map(|text| symbols(&text)).unwrap_or_default(),
    }
}

impl Source {
    fn symbol(self, known: &Known) -> &'static str {
        match self {
            Source::Quantity(quantity) => quantity.symbol_in(known.context.solution.method),
            Source::Step(step) => step.symbol,
            Source::Force(force) => &force.symbol,
            Source::Field(field) => FIELDS[field].symbol,
        }
    }

    /// The leaf of a quantity or of a field; steps and forces have a derivation instead.
    fn leaf(self, known: &Known) -> Option<Leaf> {
        let (symbol, value) = (self.symbol(known), known.value(self));
        let (text, meaning, key) = match self {
            Source::Quantity(quantity) => {
                let text = value.map(|value| shown(quantity, value));
                let text = text.map(|shown| with_unit(&shown.number, shown.unit));
                let label = quantity.label_in(known.context.solution.method);
                (text, label.trim_start(), quantity.key)
            }
            Source::Field(field) => {
                let text = known.term(symbol).map(|term| term.text(STEP_DIGITS));
                (text, FIELDS[field].label, FIELDS[field].key)
            }
            Source::Step(_) | Source::Force(_) => return None,
        };
        Some(Leaf {
            symbol,
            shown: text.unwrap_or_else(|| "no value".to_owned()),
            value,
            meaning,
            key,
            is_quantity: matches!(self, Source::Quantity(_)),
        })
    }
}
