//! The formula of a quantity and of each step on the way to it, with the case's numbers in it.

use super::context::{Formula, Known, Source, Step, factor};
use super::formula::Tree;
use super::numbers::{tidy, with_unit, written};
use super::table::Explanation;
use crate::case::FIELDS;
use crate::model::Quantity;
use crate::numeric::decimal::significant;
use crate::report::{Shown, shown, value};

/// Significant digits of a step.
const STEP_DIGITS: usize = 5;

/// How closely the two sides of a solved equation meet is told in these steps.
const MET: [f64; 3] = [1e-12, 1e-9, 1e-6];

/// A value and the way to it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Work {
    /// What is found, as formulas call it.
    pub symbol: &'static str,
    /// What it is, in a few words; empty for the quantity itself.
    pub meaning: &'static str,
    /// The right-hand side, or the equation that is solved, or words.
    pub formula: String,
    /// How the formula leads to the value.
    pub how: How,
    /// The right-hand side with numbers: worked out, it gives what is shown. The space between a
    /// number and its unit is one at which no line ends.
    pub numbers: Option<String>,
    /// What is shown.
    pub shown: Option<Shown>,
    /// Significant digits of it.
    pub digits: usize,
    /// How well the root of an equation meets it.
    pub residual: Option<String>,
}

/// How a formula leads to a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum How {
    /// The value is its right-hand side.
    Equals,
    /// The value is the root of an equation.
    Solves,
    /// Words tell.
    Told,
}

/// A symbol that a formula takes from elsewhere.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Leaf {
    /// The symbol.
    pub symbol: &'static str,
    /// Its value as shown.
    pub shown: String,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// The key of the quantity or of the field.
    pub key: &'static str,
    /// Whether it is a quantity, with a page of its own.
    pub is_quantity: bool,
}

/// The work on a quantity, and what its formulas take from elsewhere.
pub(super) fn of(
    quantity: &'static Quantity,
    about: &Explanation,
    known: &Known,
) -> (Vec<Work>, Vec<Leaf>) {
    let target = Target::of(quantity, known);
    let mut work = worked(&target, about.formula, known);
    let mut seen = vec![quantity.symbol_in(known.solution.method)];
    let mut leaves = Vec::new();
    let mut symbols = symbols(about.formula, known);
    let mut next = 0;
    while let Some(symbol) = symbols.get(next).cloned() {
        next += 1;
        let Some(source) = known
            .source(&symbol)
            .filter(|source| !seen.contains(&source.symbol(known)))
        else {
            continue;
        };
        seen.push(source.symbol(known));
        match source {
            Source::Step(step) => {
                work.extend(worked(&Target::step(step, known), step.formula, known));
                symbols.extend(self::symbols(step.formula, known));
            }
            leaf => leaves.push(leaf.leaf(known)),
        }
    }
    (work, leaves)
}

/// What a formula must arrive at.
struct Target {
    symbol: &'static str,
    meaning: &'static str,
    value: Option<f64>,
    unit: &'static str,
    digits: usize,
    shown: Option<Shown>,
}

impl Target {
    fn of(quantity: &'static Quantity, known: &Known) -> Target {
        let value = value(quantity, known.solution);
        let shown = value.map(|value| shown(quantity, value));
        let symbol = quantity.symbol_in(known.solution.method);
        let symbol = if symbol.is_empty() { "value" } else { symbol };
        Target {
            symbol,
            meaning: "",
            value,
            unit: quantity.shown,
            digits: quantity.digits,
            shown,
        }
    }

    fn step(step: &'static Step, known: &Known) -> Target {
        Target::told(step.symbol, step.meaning, known.step_value(step), step.unit)
    }

    fn told(
        symbol: &'static str,
        meaning: &'static str,
        value: Option<f64>,
        unit: &'static str,
    ) -> Target {
        let in_unit = |value: f64| value / factor(unit).unwrap_or(1.0);
        let shown = value.map(|value| Shown {
            number: tidy(in_unit(value), STEP_DIGITS),
            unit: if unit == "1" { "" } else { unit },
        });
        Target {
            symbol,
            meaning,
            value,
            unit,
            digits: STEP_DIGITS,
            shown,
        }
    }

    /// Whether a number is the target's value, as far as its digits tell.
    fn is(&self, found: f64) -> bool {
        let told = |value: f64| significant(value / factor(self.unit).unwrap_or(1.0), self.digits);
        self.value.is_some_and(|value| told(value) == told(found))
    }

    fn work(self, how: How, formula: String, numbers: Option<String>) -> Work {
        let Target {
            symbol,
            meaning,
            shown,
            digits,
            ..
        } = self;
        Work {
            symbol,
            meaning,
            formula,
            how,
            numbers,
            shown,
            digits,
            residual: None,
        }
    }
}

/// The formula of a target, with numbers where it is explicit; with both its sides where it is an
/// equation.
fn worked(target: &Target, formula: Formula, known: &Known) -> Vec<Work> {
    let target = Target {
        shown: target.shown.clone(),
        ..*target
    };
    match formula.resolved(known) {
        Formula::Given(key) => {
            let text = FIELDS
                .iter()
                .position(|field| field.key == key)
                .and_then(|field| known.case.effective(field));
            vec![target.work(
                How::Told,
                format!("given by the case, {key} = {}", text.unwrap_or_default()),
                None,
            )]
        }
        Formula::Words(words) | Formula::Found { words, .. } => {
            vec![target.work(How::Told, words.to_owned(), None)]
        }
        Formula::Solved {
            equation,
            left,
            right,
            unit,
        } => {
            let mut root = target.work(How::Solves, equation.to_owned(), None);
            root.residual = met(left, right, known);
            vec![
                root,
                side("left side", left, unit, known),
                side("right side", right, unit, known),
            ]
        }
        other => {
            let text = other.explicit(known).unwrap_or_default();
            let numbers = Tree::read(&text).and_then(|tree| {
                let term = |symbol: &str| known.term(symbol);
                target.value.and_then(|_| {
                    written(&tree, target.digits.min(STEP_DIGITS), &term, &|found| {
                        target.is(found)
                    })
                })
            });
            vec![target.work(How::Equals, text, numbers)]
        }
    }
}

/// One side of an equation.
fn side(name: &'static str, text: &'static str, unit: &'static str, known: &Known) -> Work {
    let value = Tree::read(text).and_then(|tree| known.evaluated(&tree));
    let target = Target::told(name, "", value, unit);
    worked(&target, Formula::Text(text), known).remove(0)
}

/// How closely the two sides of an equation meet.
fn met(left: &str, right: &str, known: &Known) -> Option<String> {
    let [left, right] = [left, right].map(|side| known.evaluated(&Tree::read(side)?));
    let apart = (left? - right?).abs() / right?.abs();
    let step = MET.into_iter().find(|&met| apart <= met);
    let within = step.map_or_else(|| significant(apart, 2), |met| format!("{met:e}"));
    Some(format!("both sides meet within {within} of either"))
}

/// The symbols of a formula, in the order of reading.
fn symbols(formula: Formula, known: &Known) -> Vec<String> {
    let texts = match formula.resolved(known) {
        Formula::Solved { left, right, .. } => vec![left.to_owned(), right.to_owned()],
        Formula::Found { with, .. } => {
            return with.iter().map(|&symbol| symbol.to_owned()).collect();
        }
        other => other.explicit(known).into_iter().collect(),
    };
    let trees = texts.iter().filter_map(|text| Tree::read(text));
    trees
        .flat_map(|tree| {
            tree.symbols()
                .into_iter()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        })
        .collect()
}

impl Source {
    fn symbol(self, known: &Known) -> &'static str {
        match self {
            Source::Quantity(quantity) => quantity.symbol_in(known.solution.method),
            Source::Step(step) => step.symbol,
            Source::Field(field) => FIELDS[field].symbol,
        }
    }

    fn leaf(self, known: &Known) -> Leaf {
        let symbol = self.symbol(known);
        let term = || {
            known
                .term(symbol)
                .map_or_else(|| "no value".to_owned(), |term| term.text(STEP_DIGITS))
        };
        match self {
            Source::Quantity(quantity) => {
                let shown = value(quantity, known.solution).map(|value| shown(quantity, value));
                let shown = shown.map_or_else(
                    || "no value".to_owned(),
                    |shown| with_unit(&shown.number, shown.unit),
                );
                Leaf {
                    symbol,
                    shown,
                    meaning: quantity.label_in(known.solution.method).trim_start(),
                    key: quantity.key,
                    is_quantity: true,
                }
            }
            Source::Step(step) => Leaf {
                symbol,
                shown: term(),
                meaning: step.meaning,
                key: "",
                is_quantity: false,
            },
            Source::Field(field) => Leaf {
                symbol,
                shown: term(),
                meaning: FIELDS[field].label,
                key: FIELDS[field].key,
                is_quantity: false,
            },
        }
    }
}
