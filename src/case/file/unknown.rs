//! Refusals of unknown keys and tables, each with the most likely name.

use crate::case::fields::{FIELDS, Field, GROUPS};
use crate::case::sanitize::quoted;
use crate::case::{Problem, suggest};

/// Common names of the two gears.
const GEARS: [&str; 8] = ["pinion", "wheel", "gear", "gears", "gear1", "gear2", "gear_1", "gear_2"];

/// The refusal of an unknown name at the top of the file.
pub(super) fn unknown_at_top(name: &str) -> Problem {
    if GEARS.contains(&name.to_lowercase().as_str()) {
        let cause = format!("unknown key or table {}", quoted(name));
        return Problem::new(
            name,
            cause,
            "the gears are [driver] and [driven], whatever their sizes",
        );
    }

    let known = GROUPS
        .iter()
        .map(|(table, _)| *table)
        .filter(|table| !table.is_empty())
        .chain(["limits", "spread", "variants", "format", "title", "notes"]);
    let elsewhere = || {
        FIELDS
            .iter()
            .find(|field| field.name() == name)
            .map(|field| format!("put it under [{}]", field.table()))
    };
    let fix = elsewhere().unwrap_or_else(|| suggest::fix(name, known, || "remove it".to_owned()));
    Problem::new(name, format!("unknown key or table {}", quoted(name)), fix)
}

/// The refusal of an unknown name in a table.
pub(super) fn unknown_in_table(table: &str, name: &str) -> Problem {
    let here = FIELDS.iter().filter(|field| field.table() == table).map(Field::name);
    let elsewhere = || {
        FIELDS
            .iter()
            .find(|field| field.name() == name)
            .map(|field| format!("it belongs under [{}]", field.table()))
    };
    let fix = elsewhere().unwrap_or_else(|| {
        suggest::fix(name, here.clone(), || {
            format!("[{table}] has {}", here.clone().collect::<Vec<_>>().join(", "))
        })
    });
    Problem::new(&format!("{table}.{name}"), format!("unknown key {}", quoted(name)), fix)
}
