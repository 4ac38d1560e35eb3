//! The focusable rows of the form: the fields, then the limits and distributions of the case.

use std::borrow::Cow;

use crate::case::fields::{AUTO, Absent, Field, in_unit, index_of};
use crate::case::spread::{Shape, parts};
use crate::case::units::{self, System};
use crate::case::{Acting, Case, FIELDS, Limit, Spread, relevance};
use crate::model::Inputs;
use crate::tui::form_aids::{Measure, step_limit, step_spread};

/// The content of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Row<'c> {
    /// A field, by its index in the table.
    Field(usize),
    /// A limit of the case.
    Limit(&'c Limit),
    /// A distribution of a field.
    Spread(&'c Spread),
}

impl Row<'_> {
    /// The limited quantity, or the field of the distribution.
    pub(crate) fn entry(self) -> Option<&'static str> {
        match self {
            Row::Field(_) => None,
            Row::Limit(limit) => Some(limit.quantity.key),
            Row::Spread(spread) => Some(spread.field),
        }
    }
}

/// The number of rows.
pub fn count(case: &Case) -> usize {
    FIELDS.len() + case.limits.len() + case.spread.len()
}

/// The content of a row; for an index beyond the last row, the last field.
pub(crate) fn row(case: &Case, at: usize) -> Row<'_> {
    let mut entries = case.limits.iter().map(Row::Limit).chain(case.spread.iter().map(Row::Spread));
    let entry = at.checked_sub(FIELDS.len()).and_then(|at| entries.nth(at));
    entry.unwrap_or(Row::Field(at.min(FIELDS.len() - 1)))
}

/// The row of a key, such as `pair.module`, `limits.impact_force` or `spread."pair.module"`.
pub(crate) fn of_key(case: &Case, key: &str) -> Option<usize> {
    let spread = key.strip_prefix("spread.").map(|field| field.trim_matches('"'));
    index_of(key).or_else(|| of_entry(case, key.strip_prefix("limits.").or(spread)?))
}

/// The row of the limit of a quantity, or of the distribution of a field.
pub(crate) fn of_entry(case: &Case, key: &str) -> Option<usize> {
    (FIELDS.len()..count(case)).find(|&at| row(case, at).entry() == Some(key))
}

/// The text of a row.
pub fn text(case: &Case, at: usize) -> Option<&str> {
    match row(case, at) {
        Row::Field(field) => case.text(field),
        Row::Limit(Limit { text, .. }) | Row::Spread(Spread { text, .. }) => {
            Some(text.as_str()).filter(|text| !text.is_empty())
        }
    }
}

/// Whether a row differs from the same row of another case.
pub(crate) fn differs(case: &Case, other: &Case, at: usize) -> bool {
    text(case, at) != text_beside(other, case, at)
}

/// The text that another case has in a row of a case.
pub(crate) fn text_beside<'a>(other: &'a Case, case: &Case, at: usize) -> Option<&'a str> {
    let same = match row(case, at).entry() {
        None => Some(at),
        Some(key) => of_entry(other, key),
    };
    text(other, same?)
}

/// Writes a text into a row, valid or not.
pub(crate) fn write(case: &mut Case, at: usize, text: &str) {
    match row(case, at) {
        Row::Field(field) => case.write(field, text),
        Row::Limit(&Limit { quantity, .. }) => case.write_limit(quantity, text),
        Row::Spread(&Spread { field, .. }) => case.write_spread(field, text),
    }
}

/// The number in the text of a row, with its dimension and unit.
fn measure<'t>(
    case: &Case,
    at: usize,
    text: &'t str,
    system: System,
) -> Option<(&'t str, Measure)> {
    let measure = match row(case, at) {
        Row::Field(field) => Measure::of_field(&FIELDS[field], system)?,
        Row::Limit(limit) => Measure::of_quantity(limit.quantity, system)?,
        Row::Spread(spread) => {
            let (shape, width) = parts(text);
            let measure = Measure::of_field(&FIELDS[index_of(spread.field)?], system)?;
            return Some((width, measure)).filter(|_| shape != Shape::Grade.name());
        }
    };
    Some((text, measure))
}

/// The unit in the text of a row, as written; of a distribution without one, the unit of its field.
pub(crate) fn written_unit(case: &Case, at: usize) -> Option<String> {
    let known = text(case, at).unwrap_or_default();
    let (number, measure) = measure(case, at, known, System::Metric)?;
    match (units::written_unit(number, measure.dimension), row(case, at)) {
        (None, Row::Spread(spread)) => written_unit(case, index_of(spread.field)?),
        (unit, _) => unit.map(str::to_owned),
    }
}

/// The system of the unit of a field as written, otherwise of the module.
pub(crate) fn written_system(case: &Case, key: &str) -> Option<System> {
    let of = |key| System::of_unit(&written_unit(case, index_of(key)?)?);
    of(key).or_else(|| of("pair.module"))
}

/// The rest of the name of a distribution whose first letters are typed.
pub(crate) fn rest_of_shape(case: &Case, at: usize, typed: &str) -> Option<&'static str> {
    let is_begun = matches!(row(case, at), Row::Spread(_)) && !typed.is_empty();
    let rest = |shape: Shape| shape.name().strip_prefix(typed).filter(|rest| !rest.is_empty());
    Shape::ALL.into_iter().filter(|_| is_begun).find_map(rest)
}

/// The completion of a text typed into a row: the name of a distribution, or the unit of a bare
/// number.
pub(crate) fn ending(case: &Case, at: usize, typed: &str, bare: &str) -> Option<String> {
    if let Some(rest) = rest_of_shape(case, at, typed) {
        return Some(rest.to_owned());
    }
    let (number, measure) = measure(case, at, typed, System::Metric)?;
    units::ending(number, measure.dimension, bare)
}

/// The displayed unit of a row; empty without one.
pub(crate) fn displayed_unit(case: &Case, at: usize, system: System) -> &'static str {
    measure(case, at, "", system).map_or("", |(_, measure)| measure.unit)
}

/// Whether an invalid text of a row is merely unfinished: further typing may complete it.
pub(crate) fn is_unfinished(case: &Case, at: usize, typed: &str) -> bool {
    let takes_auto = field(case, at).is_some_and(Field::takes_auto);
    takes_auto && AUTO.starts_with(typed.trim())
        || rest_of_shape(case, at, typed).is_some()
        || measure(case, at, typed, System::Metric)
            .is_some_and(|(number, measure)| measure.is_unfinished(number))
}

/// The text of a row after a step.
pub(crate) fn stepped(case: &Case, at: usize, by: isize) -> Option<String> {
    match row(case, at) {
        Row::Field(field) => case.stepped(field, by),
        Row::Limit(limit) => step_limit(&limit.text, limit.quantity.key, by),
        Row::Spread(spread) => step_spread(spread, by),
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
        Row::Limit(_) | Row::Spread(_) => None,
    }
}

/// The symbol, empty without one, and the label of a row.
pub(crate) fn names_of(case: &Case, at: usize) -> (&'static str, Cow<'static, str>) {
    let plain = |symbol, label: &'static str| (symbol, Cow::Borrowed(label));
    match row(case, at) {
        Row::Field(field) => plain(case.symbol(field), FIELDS[field].label),
        Row::Limit(Limit { quantity, .. }) => plain(quantity.symbol, quantity.label.trim_start()),
        Row::Spread(spread) => index_of(spread.field).map_or(plain("", spread.field), |field| {
            (FIELDS[field].symbol, FIELDS[field].full_label().into())
        }),
    }
}

/// The label of a row, with the gear if both gears have the field.
pub(crate) fn full_label(case: &Case, at: usize) -> String {
    let (_, label) = names_of(case, at);
    match row(case, at) {
        Row::Field(field) => FIELDS[field].full_label(),
        Row::Limit(_) => format!("limit of {label}"),
        Row::Spread(_) => format!("spread of {label}"),
    }
}

/// The title of the group of a row outside the fields.
pub(crate) fn title_of_entries(case: &Case, at: usize) -> Option<&'static str> {
    match row(case, at) {
        Row::Field(_) => None,
        Row::Limit(_) => Some("Limits"),
        Row::Spread(_) => Some("Spread, for the tolerance"),
    }
}

/// The first rows of the groups.
pub(crate) fn groups(case: &Case) -> Vec<usize> {
    let begins = |at: usize| match row(case, at) {
        Row::Field(field) => field == 0 || FIELDS[field].table() != FIELDS[field - 1].table(),
        Row::Limit(_) | Row::Spread(_) => {
            title_of_entries(case, at) != title_of_entries(case, at - 1)
        }
    };
    (0..count(case)).filter(|&at| begins(at)).collect()
}

/// Whether a row is a field that a case with these inputs does not use.
pub(crate) fn is_idle(case: &Case, at: usize, inputs: &Inputs) -> bool {
    matches!(row(case, at), Row::Field(field) if matches!(relevance(field, inputs), Acting::No(_)))
}

/// Whether a row is a required field whose value is missing.
pub(crate) fn lacks(case: &Case, at: usize) -> bool {
    at < FIELDS.len() && case.lacks(at)
}

/// The text of an empty field: the derived value or the default in the unit of a bare number, or that
/// a value is required.
pub(crate) fn unwritten(case: &Case, inputs: &Inputs, field: usize, bare: &str) -> String {
    let known = &FIELDS[field];
    let is_derived = known.partner().is_none() || case.is_replaced(field);
    if is_derived && let Some(value) = case.derived(field, inputs) {
        return format!("({})", in_unit(value, bare));
    }
    match (known.absent, known.partner()) {
        (Absent::Default(""), _) => String::new(),
        (_, Some(other)) if case.text(other).is_some() => format!("(by {})", FIELDS[other].label),
        (Absent::Default(text), _) => format!("({})", known.text_in(text, bare)),
        (Absent::Without(text), _) => format!("({text})"),
        (Absent::Either, Some(other)) if other < field => format!("(or {})", FIELDS[other].label),
        (Absent::Refused | Absent::Either, _) => "(required)".to_owned(),
    }
}
