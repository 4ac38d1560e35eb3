//! How far a field reaches: which values of a solve read it, themselves or through others, and so
//! which stages an edit of it puts out of date.

mod table;
#[cfg(test)]
mod tests;

use super::FIELDS;
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

/// The stages whose results an edit of the field puts out of date; none for a field that only words
/// or notes read.
///
/// Ask with the inputs after the edit, and take the union with those before it where the edit adds
/// or takes away a field.
#[must_use]
pub fn stages_of(field: usize, inputs: &Inputs) -> Stages {
    let key = FIELDS[field].key;
    let mut reached: Vec<&Row> = active(inputs).filter(|row| row.reads_field(key)).collect();
    let mut next = 0;
    while let Some(&row) = reached.get(next) {
        let reads = |other: &&Row| {
            other.reads.contains(&row.value)
                && reached.iter().all(|known| !std::ptr::eq(*known, *other))
        };
        let fresh: Vec<&Row> = active(inputs).filter(reads).collect();
        reached.extend(fresh);
        next += 1;
    }
    reached
        .iter()
        .filter_map(|row| row.stage)
        .fold(Stages::NONE, Stages::with)
}

/// The first stage that an edit of the field puts out of date.
#[must_use]
pub fn first_stage(field: usize, inputs: &Inputs) -> Option<Stage> {
    stages_of(field, inputs).iter().next()
}

/// Whether any stage reads the field, itself or through others: whether [`stages_of`] names one, at
/// a fraction of its cost.
#[must_use]
pub fn is_read(field: usize, inputs: &Inputs) -> bool {
    let key = FIELDS[field].key;
    let mut reached: Vec<&Row> = active(inputs).filter(|row| row.reads_field(key)).collect();
    let mut next = 0;
    while let Some(&row) = reached.get(next) {
        if row.stage.is_some() {
            return true;
        }
        let reads = |other: &&Row| {
            other.reads.contains(&row.value)
                && reached.iter().all(|known| !std::ptr::eq(*known, *other))
        };
        let fresh: Vec<&Row> = active(inputs).filter(reads).collect();
        reached.extend(fresh);
        next += 1;
    }
    false
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
