//! The values of the symbols of a formula in one case: quantities, steps, forces of other stiffness
//! models, and fields.

use std::sync::LazyLock;

use super::substitution::{Term, with_unit};
use crate::case::fields::Kind;
use crate::case::{Case, FIELDS, units};
use crate::model::compliance::{contact_of, model_of};
use crate::model::explanation::{Context, Formula, Step, tidy};
use crate::model::impact::StiffnessModels;
use crate::model::quantities::{spread_force, steps};
use crate::model::{QUANTITIES, Quantity};
use crate::report::value;

/// Units of steps that no field or quantity has, with their factors to SI.
pub const STEP_UNITS: [(&str, f64); 5] =
    [("mm4", 1e-12), ("N/(um mm)", 1e9), ("N/m", 1.0), ("Hz", 1.0), ("N s/m", 1.0)];

/// Digits of a field value that is derived from other fields.
const DERIVED_DIGITS: usize = 6;

/// A solved case for the explanation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Known<'a> {
    /// The case as the user wrote it.
    pub(super) case: &'a Case,
    /// Inputs and results.
    pub(super) context: Context<'a>,
}

/// The source of the value of a symbol.
#[derive(Debug, Clone, Copy)]
pub(super) enum Source {
    /// A quantity, which has a page of its own.
    Quantity(&'static Quantity),
    /// A step that formulas share.
    Step(&'static Step),
    /// The impact force by another stiffness model.
    Force(&'static Force),
    /// A field of the case, by index.
    Field(usize),
}

/// The impact force by another stiffness model.
#[derive(Debug)]
pub(super) struct Force {
    pub(super) symbol: String,
    pub(super) meaning: String,
    models: StiffnessModels,
}

static FORCES: LazyLock<Vec<Force>> = LazyLock::new(|| {
    let force = |models: StiffnessModels| Force {
        symbol: models.symbol(),
        meaning: format!("by {}", models.names()),
        models,
    };
    StiffnessModels::all().map(force).collect()
});

impl Known<'_> {
    /// The source of the value of a symbol.
    pub(super) fn source(&self, symbol: &str) -> Option<Source> {
        let method = self.context.solution.method;
        let quantity = QUANTITIES
            .iter()
            .find(|quantity| quantity.symbol_in(method) == symbol && !quantity.is_flag())
            .map(Source::Quantity);
        let step = || self.step(symbol).map(Source::Step);
        let force = || FORCES.iter().find(|force| force.symbol == symbol).map(Source::Force);
        let field = || FIELDS.iter().position(|field| field.symbol == symbol).map(Source::Field);
        quantity.or_else(step).or_else(force).or_else(field)
    }

    /// A step whose value no field of the case gives; the torque can be either.
    fn step(&self, symbol: &str) -> Option<&'static Step> {
        let inputs = self.context.inputs;
        let contact = contact_of(inputs).map_or(&[][..], |contact| contact.model().steps);
        let models = model_of(inputs).model().steps.iter().chain(contact);
        let is_given = |step: &Step| matches!(step.formula.resolved(inputs), Formula::Given(_));
        steps().chain(models).find(|step| step.symbol == symbol && !is_given(step))
    }

    /// The value of a source in SI.
    pub(super) fn value(&self, source: Source) -> Option<f64> {
        let found = match source {
            Source::Quantity(quantity) => value(quantity, self.context.solution),
            Source::Step(step) => (step.value)(&self.context),
            Source::Force(force) => {
                let inputs = self.context.inputs;
                let covers = (force.models.tooth.covers)(inputs);
                covers.then(|| spread_force(inputs, &force.models)).flatten()
            }
            Source::Field(field) => self.field_value(field),
        };
        found.filter(|value| value.is_finite()).map(|value| value + 0.0)
    }

    /// The value of a symbol as text of a formula.
    pub(super) fn term(&self, symbol: &str) -> Option<Term> {
        let source = self.source(symbol)?;
        let value = self.value(source)?;
        let in_unit = |unit| Term::Value(value / factor(unit).unwrap_or(1.0), unit);
        Some(match source {
            Source::Quantity(quantity) => in_unit(quantity.shown),
            Source::Step(step) => in_unit(step.unit),
            Source::Force(_) => in_unit("N"),
            Source::Field(field) => Term::Written(self.field_text(field, value)),
        })
    }

    /// The value of a field, given or derived.
    fn field_value(&self, field: usize) -> Option<f64> {
        let given = self.case.value(field);
        given.or_else(|| self.case.derived(field, self.context.given))
    }

    /// The value of a field as the user wrote it; in the usual unit of the field if that text would
    /// be ambiguous in a formula.
    fn field_text(&self, field: usize, value: f64) -> String {
        let usual = match FIELDS[field].kind {
            Kind::Number(_, range, _) => range.unit,
            _ => "",
        };
        let written = self.case.effective(field).and_then(plainly_written);
        let is_written = self.case.effective(field).is_some();
        written.unwrap_or_else(|| {
            if is_written {
                units::text(value, usual)
            } else {
                with_unit(&tidy(value / factor(usual).unwrap_or(1.0), DERIVED_DIGITS), usual)
            }
        })
    }
}

/// The factor of a unit to SI; `None` for an unknown unit.
pub(super) fn factor(unit: &str) -> Option<f64> {
    let of_step = || STEP_UNITS.iter().find(|(name, _)| *name == unit).map(|&(_, factor)| factor);
    units::factor(unit).or_else(of_step)
}

/// A number with a unit of letters and slashes, separated by one space.
fn plainly_written(text: &str) -> Option<String> {
    let (number, unit) = text.trim().split_once(' ').unwrap_or((text.trim(), ""));
    let is_number = number.bytes().all(|byte| byte.is_ascii_digit() || b".-".contains(&byte))
        && number.parse::<f64>().is_ok();
    let is_unit = unit.bytes().all(|byte| byte.is_ascii_alphanumeric() || b" /".contains(&byte))
        && units::factor(unit).is_some();
    (is_number && is_unit).then(|| with_unit(number, unit))
}
