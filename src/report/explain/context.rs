//! What the symbols of a formula stand for in one case: quantities, steps on the way to them, and
//! fields.

use super::formula::Tree;
use super::numbers::{Term, with_unit};
use super::steps::steps;
use crate::case::fields::Kind;
use crate::case::{Case, FIELDS, units};
use crate::model::{Inputs, QUANTITIES, Quantity, Solution};
use crate::report::value;

/// Units in which a step is told and no field or quantity is, and what one of each is in SI.
pub const STEP_UNITS: [(&str, f64); 5] = [
    ("kg m2", 1.0),
    ("N/(um mm)", 1e9),
    ("N/m", 1.0),
    ("Hz", 1.0),
    ("N s/m", 1.0),
];

/// A solved case.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    /// As the user wrote it.
    pub case: &'a Case,
    /// What the model read of it, with what the method `auto` took.
    pub inputs: &'a Inputs,
    /// The same as the case gives it.
    pub given: &'a Inputs,
    /// What the model found.
    pub solution: &'a Solution,
}

/// Where the value of a symbol comes from.
#[derive(Debug, Clone, Copy)]
pub(super) enum Source {
    /// A quantity, which has a page of its own.
    Quantity(&'static Quantity),
    /// A step that formulas share.
    Step(&'static Step),
    /// A field of the case, by its place.
    Field(usize),
}

/// A value on the way to a quantity.
#[derive(Debug)]
pub(super) struct Step {
    pub(super) symbol: &'static str,
    /// What it is, in a few words.
    pub(super) meaning: &'static str,
    /// The unit in which a person reads it.
    pub(super) unit: &'static str,
    /// Its right-hand side, where the case has one.
    pub(super) formula: Formula,
    /// Its value in SI as the model has it; without, the right-hand side tells.
    pub(super) value: Option<fn(&Known) -> Option<f64>>,
}

/// How a value is found.
#[derive(Debug, Clone, Copy)]
pub(super) enum Formula {
    /// By an explicit right-hand side.
    Text(&'static str),
    /// As the case decides.
    By(fn(&Known) -> Formula),
    /// By an explicit right-hand side that has as many terms as the case has.
    Made(fn(&Known) -> String),
    /// Given by the field of that key.
    Given(&'static str),
    /// The root of an equation between two sides, told in that unit.
    Solved {
        equation: &'static str,
        left: &'static str,
        right: &'static str,
        unit: &'static str,
    },
    /// In a way that these words tell.
    Words(&'static str),
    /// In a way that these words tell, with symbols to be explained.
    Found {
        words: &'static str,
        with: &'static [&'static str],
    },
}

impl Formula {
    /// What it comes down to in this case.
    pub(super) fn resolved(self, known: &Known) -> Formula {
        match self {
            Formula::By(choose) => choose(known).resolved(known),
            other => other,
        }
    }

    /// The right-hand side, where it is explicit.
    pub(super) fn explicit(self, known: &Known) -> Option<String> {
        match self.resolved(known) {
            Formula::Text(text) => Some(text.to_owned()),
            Formula::Made(make) => Some(make(known)),
            _ => None,
        }
    }
}

impl Known<'_> {
    /// What a symbol stands for.
    pub(super) fn source(&self, symbol: &str) -> Option<Source> {
        let quantity = QUANTITIES
            .iter()
            .find(|quantity| {
                quantity.symbol_in(self.solution.method) == symbol && !quantity.is_flag()
            })
            .map(Source::Quantity);
        let step = || {
            steps()
                .find(|step| step.symbol == symbol && self.has(step))
                .map(Source::Step)
        };
        let field = || {
            FIELDS
                .iter()
                .position(|field| field.symbol == symbol)
                .map(Source::Field)
        };
        quantity.or_else(step).or_else(field)
    }

    /// Whether the step is one in this case: the torque is not where it is given.
    fn has(&self, step: &Step) -> bool {
        !matches!(step.formula.resolved(self), Formula::Given(_))
    }

    /// The value of a symbol and how it is shown.
    pub(super) fn term(&self, symbol: &str) -> Option<Term> {
        match self.source(symbol)? {
            Source::Quantity(quantity) => {
                Some(rounded(value(quantity, self.solution)?, quantity.shown))
            }
            Source::Step(step) => Some(rounded(self.step_value(step)?, step.unit)),
            Source::Field(field) => self.field_term(field),
        }
    }

    /// A step's value in SI, where it is a number.
    pub(super) fn step_value(&self, step: &Step) -> Option<f64> {
        let by_formula =
            || self.evaluated(&Tree::read(&step.formula.resolved(self).explicit(self)?)?);
        step.value
            .map_or_else(by_formula, |value| value(self))
            .filter(|value| value.is_finite())
            .map(|value| value + 0.0)
    }

    /// The value of a formula with all digits of its terms.
    pub(super) fn evaluated(&self, tree: &Tree) -> Option<f64> {
        tree.value(&|symbol| Some(self.term(symbol)?.value()))
    }

    /// A field's value as the user wrote it, or in the field's usual unit where that could be
    /// misread in a formula.
    fn field_term(&self, field: usize) -> Option<Term> {
        let value = self.case.value(field)?;
        let usual = if let Kind::Number(_, range, _) = FIELDS[field].kind {
            range.unit
        } else {
            ""
        };
        let written = self.case.effective(field).and_then(plainly_written);
        Some(Term::Written(
            written.unwrap_or_else(|| units::text(value, usual)),
            value,
        ))
    }
}

fn rounded(value: f64, unit: &'static str) -> Term {
    Term::Rounded {
        value,
        unit,
        factor: factor(unit).unwrap_or(1.0),
    }
}

/// What one of a unit is in SI; `None` for an unknown one.
pub(super) fn factor(unit: &str) -> Option<f64> {
    let of_step = || {
        STEP_UNITS
            .iter()
            .find(|(name, _)| *name == unit)
            .map(|&(_, factor)| factor)
    };
    units::factor(unit).or_else(of_step)
}

/// A number and a unit in letters and strokes, with one space between them.
fn plainly_written(text: &str) -> Option<String> {
    let (number, unit) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
    let is_number = number
        .bytes()
        .all(|byte| byte.is_ascii_digit() || b".-".contains(&byte))
        && number.parse::<f64>().is_ok();
    let is_unit = unit
        .bytes()
        .all(|byte| byte.is_ascii_alphanumeric() || b" /".contains(&byte))
        && units::factor(unit).is_some();
    (is_number && is_unit).then(|| with_unit(number, unit))
}
