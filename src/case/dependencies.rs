//! Which stages read a field, and which fields a quantity depends on.

mod table;
#[cfg(test)]
mod tests;

use super::FIELDS;
use super::fields::Kind;
use crate::model::compliance::model_of;
use crate::model::{Inputs, Quantity, Stage, Stages};
use table::{ROWS, Row};

/// The fields, by their place in [`FIELDS`], that a quantity depends on in a case with these
/// inputs; in the order of the form.
///
/// What the case leaves aside is not among them: a deflection that is given needs no stiffness, and
/// the fit of Kuang and Yang no bore. A field that is left out and would act if it were given is
/// among them, such as the centre distance.
///
/// # Valid for
/// Every digit, but for pairs on the brink of the close calls of
/// [`Geometry::is_close_call`](crate::model::Geometry): there another field may turn double-double
/// arithmetic on or off, and so move the last one.
#[must_use]
pub fn fields_of(quantity: &Quantity, inputs: &Inputs) -> Vec<usize> {
    let read = values_behind(quantity.key, inputs);
    let reads = |key: &str| read.iter().any(|row| row.reads_field(key));
    (0..FIELDS.len())
        .filter(|&field| reads(FIELDS[field].key))
        .collect()
}

/// The stages that read a field in a case with these inputs: those whose inputs differ once the
/// field holds another value.
#[must_use]
pub fn stages_of(field: usize, inputs: &Inputs) -> Stages {
    let others = with_other_values(field, inputs);
    let reads = |stage: &Stage| {
        let own = stage.inputs(inputs);
        others.iter().any(|other| stage.inputs(other) != own)
    };
    let stages = inputs.method.stages().iter().filter(reads);
    stages.fold(Stages::NONE, Stages::with)
}

/// Whether any stage reads a field in a case with these inputs.
#[must_use]
pub fn is_read(field: usize, inputs: &Inputs) -> bool {
    stages_of(field, inputs) != Stages::NONE
}

/// The inputs with other values in a field, so that one of them at least differs from the present.
fn with_other_values(field: usize, inputs: &Inputs) -> Vec<Inputs> {
    /// Shares of the range, both unlike a value that a person types.
    const SHARES: [f64; 2] = [0.381_966, 0.618_034];
    // Every stage that reads the model of the teeth reads what decides its range as well.
    let held = Inputs {
        tooth_compliance: Some(model_of(inputs)),
        ..inputs.clone()
    };
    let with = move |put: &dyn Fn(&mut Inputs)| {
        let mut other = held.clone();
        put(&mut other);
        other
    };
    match FIELDS[field].kind {
        Kind::Text => Vec::new(),
        Kind::Number(_, range, put) => SHARES
            .map(|share| with(&|other| put(other, range.from + share * (range.to - range.from))))
            .into(),
        Kind::Count(from, to, put) => [from, to]
            .map(|count| with(&|other| put(other, count)))
            .into(),
        Kind::Choice(names, put) => (0..names.len())
            .map(|at| with(&|other| put(other, at)))
            .collect(),
    }
}

/// The rows that count in a case with these inputs.
fn active(inputs: &Inputs) -> impl Iterator<Item = &'static Row> {
    ROWS.iter().filter(move |row| row.when.is_true(inputs))
}

/// The rows of a value and of every value that it reads, in turn.
fn values_behind(value: &str, inputs: &Inputs) -> Vec<&'static Row> {
    let mut found: Vec<&Row> = active(inputs).filter(|row| row.value == value).collect();
    let mut next = 0;
    while let Some(&row) = found.get(next) {
        let fresh: Vec<&Row> = active(inputs)
            .filter(|other| {
                row.reads.contains(&other.value)
                    && found.iter().all(|known| known.value != other.value)
            })
            .collect();
        found.extend(fresh);
        next += 1;
    }
    found
}
