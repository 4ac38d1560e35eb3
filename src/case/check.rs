//! Converts texts to the inputs of the model: each field alone, then rules between fields.

mod circles;
mod problem;
mod together;
mod value;

use super::fields::{Absent, FIELDS, Field, index_of};
use super::{Case, Limit};
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity};
pub use problem::{Problem, unknown_key, unknown_quantity};
use together::together;
pub use together::violated_rule;
pub use value::{field_range, field_value};

/// The inputs of the model, or all problems of the case.
pub(super) fn inputs(case: &Case) -> Result<Inputs, Vec<Problem>> {
    let (inputs, problems) = read(case, &[]);
    if problems.is_empty() { Ok(inputs) } else { Err(problems) }
}

/// The inputs that can be read, and all problems of the case. Skips the fields in `wrong`.
pub(super) fn read(case: &Case, wrong: &[usize]) -> (Inputs, Vec<Problem>) {
    let mut inputs = Inputs::default();
    let mut problems: Vec<Problem> = Vec::new();
    for field in (0..FIELDS.len()).filter(|field| !wrong.contains(field)) {
        problems.extend(put(case, field, &mut inputs).err());
        let partner = FIELDS[field].partner();
        if partner.is_some_and(|other| !wrong.contains(&other)) {
            problems.extend(misfit(case, field));
        }
    }
    let sound = |keys: &[&str]| {
        let named = |key: &&str| {
            wrong.iter().any(|&field| FIELDS[field].key == *key)
                || problems.iter().any(|p| p.field == *key)
        };
        !keys.iter().any(named)
    };
    let together = together(&inputs, sound);
    problems.extend(together);
    problems.sort_by_key(|problem| index_of(&problem.field));
    problems.extend(limits(case));
    // Other methods do not use the needs: a limit does not change their results.
    if inputs.method == Method::Auto {
        let limited = case.limits.iter();
        let limited = limited.filter_map(|limit| Quantity::find(limit.quantity));
        inputs = inputs.needing(limited.map(|quantity| quantity.stage));
    }
    (inputs, problems)
}

/// Problems of the limits with a text. Valid limits are not read again.
fn limits(case: &Case) -> impl Iterator<Item = Problem> {
    let unread =
        case.limits.iter().filter(|limit| !limit.text.is_empty() && limit.value.is_infinite());
    unread.filter_map(|limit| Limit::new(limit.quantity, &limit.text).err())
}

/// Reads one field, or its default, into the inputs.
///
/// # Errors
/// The [`Problem`] of the field.
pub fn put(case: &Case, field: usize, inputs: &mut Inputs) -> Result<(), Problem> {
    let known = &FIELDS[field];
    match (case.text(field), known.absent) {
        (None, _) if case.is_replaced(field) => Ok(()),
        (Some(text), _) | (None, Absent::Default(text)) => put_text(known, field, text, inputs),
        (None, Absent::Refused) => Err(Problem::new(
            known.key,
            "a required value is missing",
            format!("write {}", addition(known)),
        )),
        (None, Absent::Without(_) | Absent::Either) => Ok(()),
    }
}

/// The field as a line of a file, with an example value.
pub(super) fn assignment(field: &Field) -> String {
    let example = field.example();
    let value = if field.is_bare() { example.to_owned() } else { format!("\"{example}\"") };
    format!("{} = {value}", field.name())
}

/// The assignment with its table.
fn addition(field: &Field) -> String {
    match field.table() {
        "" => assignment(field),
        table => format!("{} under [{table}]", assignment(field)),
    }
}

/// The problem of a field and its alternative. It is reported at the first field if a required
/// value is missing, and at the second field if both are given.
fn misfit(case: &Case, field: usize) -> Option<Problem> {
    let other = FIELDS[field].partner()?;
    let (known, named) = (&FIELDS[field], &FIELDS[other]);
    match (case.text(field), case.text(other)) {
        (None, None) if field < other && known.absent == Absent::Either => {
            let cause = format!("neither {} nor {} is given", known.key, named.key);
            Some(Problem::new(known.key, cause, format!("write {}", addition(known))))
        }
        (Some(_), Some(_)) => given_twice(case, field),
        _ => None,
    }
}

/// Two fields that exclude each other are both given. Reported at the second field.
pub(super) fn given_twice(case: &Case, field: usize) -> Option<Problem> {
    let other = FIELDS[field].partner().filter(|&other| field > other)?;
    let (known, named) = (&FIELDS[field], &FIELDS[other]);
    case.text(field).and(case.text(other)).map(|_| {
        let cause = format!("{} and {} are both given", named.key, known.key);
        Problem::new(known.key, cause, "remove one of them")
    })
}

fn put_text(known: &Field, field: usize, text: &str, inputs: &mut Inputs) -> Result<(), Problem> {
    known.put(field_value(field, text)?, inputs);
    Ok(())
}
