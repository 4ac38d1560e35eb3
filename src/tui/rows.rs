//! The focusable rows of the form: the fields, then the limits of the case.

use crate::case::fields::{AUTO, Absent, Field, index_of};
use crate::case::units::{self, System};
use crate::case::{Case, FIELDS, Limit};
use crate::model::{Inputs, Quantity};
use crate::tui::form_aids::{Measure, step_limit};

/// The content of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Row<'c> {
    /// A field, by its index in the table.
    Field(usize),
    /// A limit of the case.
    Limit(&'c Limit),
}

/// The number of rows.
pub fn count(case: &Case) -> usize {
    FIELDS.len() + case.limits.len()
}

/// The content of a row; for an index beyond the last row, the last field.
pub(crate) fn row(case: &Case, at: usize) -> Row<'_> {
    let limit = at.checked_sub(FIELDS.len()).and_then(|at| case.limits.get(at));
    limit.map_or(Row::Field(at.min(FIELDS.len() - 1)), Row::Limit)
}

/// The row of a key, such as `pair.module` or `limits.impact_force`.
pub(crate) fn of_key(case: &Case, key: &str) -> Option<usize> {
    index_of(key).or_else(|| of_limit(case, key.strip_prefix("limits.")?))
}

/// The row of the limit of a quantity.
pub(crate) fn of_limit(case: &Case, quantity: &str) -> Option<usize> {
    case.limits.iter().position(|limit| limit.quantity == quantity).map(|at| FIELDS.len() + at)
}

/// The text of a row.
pub fn text(case: &Case, at: usize) -> Option<&str> {
    match row(case, at) {
        Row::Field(field) => case.text(field),
        Row::Limit(limit) => Some(limit.text.as_str()).filter(|text| !text.is_empty()),
    }
}

/// Whether a row differs from the same row of another case.
pub(crate) fn differs(case: &Case, other: &Case, at: usize) -> bool {
    match row(case, at) {
        Row::Field(field) => case.text(field) != other.text(field),
        Row::Limit(limit) => !other.limits.contains(limit),
    }
}

/// Writes a text into a row, valid or not.
pub(crate) fn write(case: &mut Case, at: usize, text: &str) {
    match row(case, at) {
        Row::Field(field) => case.write(field, text),
        Row::Limit(&Limit { quantity, .. }) => case.write_limit(quantity, text),
    }
}

/// The dimension and unit of the number in a row.
fn measure(case: &Case, at: usize, system: System) -> Option<Measure> {
    match row(case, at) {
        Row::Field(field) => Measure::of_field(&FIELDS[field], system),
        Row::Limit(limit) => Measure::of_quantity(Quantity::find(limit.quantity)?, system),
    }
}

/// The unit in the text of a row, as written.
pub(crate) fn written_unit(case: &Case, at: usize) -> Option<String> {
    let measure = measure(case, at, System::Metric)?;
    units::written_unit(text(case, at)?, measure.dimension).map(str::to_owned)
}

/// The completion of a text typed into a row: the unit in which its value was written, otherwise
/// the displayed unit.
pub(crate) fn ending(
    case: &Case,
    at: usize,
    typed: &str,
    written: Option<&str>,
    system: System,
) -> Option<String> {
    let measure = measure(case, at, system)?;
    units::ending(typed, measure.dimension, written.unwrap_or(measure.unit))
}

/// Whether an invalid text of a row is merely unfinished: further typing may complete it.
pub(crate) fn is_unfinished(case: &Case, at: usize, typed: &str) -> bool {
    let takes_auto = field(case, at).is_some_and(Field::takes_auto);
    takes_auto && AUTO.starts_with(typed.trim())
        || measure(case, at, System::Metric).is_some_and(|measure| measure.is_unfinished(typed))
}

/// The text of a row after a step.
pub(crate) fn stepped(case: &Case, at: usize, by: isize) -> Option<String> {
    match row(case, at) {
        Row::Field(field) => case.stepped(field, by),
        Row::Limit(limit) => step_limit(&limit.text, limit.quantity, by),
    }
}

/// The choices of a row; empty if the row is not a choice.
pub fn names(case: &Case, at: usize) -> &'static [&'static str] {
    field(case, at).map(Field::choices).unwrap_or_default()
}

/// The field of a row, if it is a field.
pub fn field(case: &Case, at: usize) -> Option<&'static Field> {
    match row(case, at) {
        Row::Field(field) => Some(&FIELDS[field]),
        Row::Limit(_) => None,
    }
}

/// The symbol, empty without one, and the label of a row.
pub(crate) fn names_of(case: &Case, at: usize) -> [&'static str; 2] {
    match row(case, at) {
        Row::Field(field) => [FIELDS[field].symbol, FIELDS[field].label],
        Row::Limit(limit) => Quantity::find(limit.quantity)
            .map_or(["", limit.quantity], |quantity| {
                [quantity.symbol, quantity.label.trim_start()]
            }),
    }
}

/// The label of a row, with the gear if both gears have the field.
pub(crate) fn full_label(case: &Case, at: usize) -> String {
    let [_, label] = names_of(case, at);
    field(case, at).map_or_else(|| format!("limit of {label}"), Field::full_label)
}

/// The first rows of the groups.
pub(crate) fn groups(case: &Case) -> Vec<usize> {
    let begins = |at: usize| match row(case, at) {
        Row::Field(field) => field == 0 || FIELDS[field].table() != FIELDS[field - 1].table(),
        Row::Limit(_) => at == FIELDS.len(),
    };
    (0..count(case)).filter(|&at| begins(at)).collect()
}

/// Whether a row is a required field whose value is missing.
pub(crate) fn lacks(case: &Case, at: usize) -> bool {
    at < FIELDS.len() && case.lacks(at)
}

/// The text of an empty field: the derived value, the default, or that a value is required.
pub(crate) fn unwritten(case: &Case, inputs: &Inputs, field: usize) -> String {
    let known = &FIELDS[field];
    let is_derived = known.partner().is_none() || case.is_replaced(field);
    if is_derived && let Some(value) = case.derived(field, inputs) {
        return format!("({})", known.in_usual_unit(value));
    }
    match (known.absent, known.partner()) {
        (Absent::Default(""), _) => String::new(),
        (_, Some(other)) if case.text(other).is_some() => format!("(by {})", FIELDS[other].label),
        (Absent::Default(text) | Absent::Without(text), _) => format!("({text})"),
        (Absent::Either, Some(other)) if other < field => format!("(or {})", FIELDS[other].label),
        (Absent::Refused | Absent::Either, _) => "(required)".to_owned(),
    }
}
