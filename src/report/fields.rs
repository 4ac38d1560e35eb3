//! The lists of the fields of a case and of the quantities of a result, for readers and scripts.

use super::json::{json, write_line};
use super::table::{Cell, Column, Table};
use crate::case::fields::Absent;
use crate::case::{FIELDS, Field};
use crate::model::{QUANTITIES, Quantity};
use std::io::{self, Write};

/// Greatest width of a line of a list.
const WIDTH: usize = 100;

/// Last line of the list of quantities.
const TO_EXPLAIN: &str =
    "`tipstrike explain KEY [CASE]` shows the formula of a quantity with the numbers of a case.";

/// Every field, for a reader.
fn field_table() -> Table {
    let columns = ["key", "symbol", "unit", "range", "default", "meaning"];
    let rows = FIELDS.iter().map(|field| {
        let (range, meaning) = (range_text(field), meaning(field));
        [field.key, field.symbol, unit(field), &range, default(field), &meaning]
            .map(Cell::from)
            .to_vec()
    });
    Table::new("", columns.map(|key| Column::text(key, key)).to_vec()).with(rows)
}

/// Every quantity; the stage is for scripts alone.
fn quantity_table() -> Table {
    let columns = ["key", "symbol", "label", "unit", "equation", "stage"];
    let rows =
        QUANTITIES.iter().map(|Quantity { key, symbol, label, unit, equation, stage, .. }| {
            [key, symbol, label.trim_start(), unit, equation, stage.name()].map(Cell::from).to_vec()
        });
    Table::new("", columns.map(|key| Column::text(key, key)).to_vec()).with(rows)
}

/// Writes every field as a table, or as JSON with one object per line.
///
/// # Errors
/// Errors of the writer.
pub fn write_fields(is_json: bool, out: &mut dyn Write) -> io::Result<()> {
    if !is_json {
        return write_list(field_table(), out);
    }
    FIELDS.iter().try_for_each(|field| {
        let (from, to) = range(field).unzip();
        let choices = Some(field.choices()).filter(|choices| !choices.is_empty());
        let default = if let Absent::Default(text) = field.absent { Some(text) } else { None };
        let line = json!({
            "key": field.key,
            "symbol": field.symbol,
            "label": field.label,
            "unit": unit(field),
            "from": from,
            "to": to,
            "choices": choices,
            "required": field.absent == Absent::Refused,
            "default": default,
            "help": field.help,
        });
        write_line(&line, out)
    })
}

/// Writes every quantity as a table, or as JSON with one object per line.
///
/// # Errors
/// Errors of the writer.
pub fn write_quantities(is_json: bool, out: &mut dyn Write) -> io::Result<()> {
    if is_json {
        return quantity_table().objects().iter().try_for_each(|line| write_line(line, out));
    }
    let mut table = quantity_table().of(&[0, 1, 3, 4, 2]);
    table.columns[4].title = "meaning".into();
    write_list(table, out)?;
    writeln!(out, "\n{TO_EXPLAIN}")
}

fn write_list(mut table: Table, out: &mut dyn Write) -> io::Result<()> {
    table.columns[0].gap = 0;
    table.wrapped(WIDTH).iter().try_for_each(|line| writeln!(out, "{line}"))
}

fn unit(field: &Field) -> &'static str {
    field.range().map_or("", |range| range.unit)
}

fn range(field: &Field) -> Option<(f64, f64)> {
    field.range().map(|range| (range.from, range.to))
}

fn range_text(field: &Field) -> String {
    range(field).map(|(from, to)| format!("{}..{}", end(from), end(to))).unwrap_or_default()
}

fn meaning(field: &Field) -> String {
    match field.choices() {
        [] => field.label.to_owned(),
        names => format!("{}: {}", field.label, names.join(", ")),
    }
}

fn end(value: f64) -> String {
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

fn default(field: &Field) -> &'static str {
    match field.absent {
        Absent::Refused => "required",
        Absent::Default(text) | Absent::Without(text) => text,
        Absent::Either => "or its alternative",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::layout::count;

    #[test]
    fn every_field_is_listed_within_the_width() {
        let mut out = Vec::new();
        write_fields(false, &mut out).unwrap();
        let table = String::from_utf8(out).unwrap();
        assert!(
            FIELDS.iter().all(|field| {
                table.lines().any(|line| line.split(' ').next() == Some(field.key))
            })
        );
        assert_eq!(table.lines().find(|line| count(line) > WIDTH), None);
    }
}
