//! The lists of the fields of a case and of the quantities of a result, for readers and scripts.

use super::data::write_line;
use super::layout::{count, flow, widest};
use crate::case::fields::{Absent, Kind};
use crate::case::{FIELDS, Field};
use crate::model::QUANTITIES;
use serde::Serialize;
use std::io::{self, Write};

/// Greatest width of a line of a list.
const WIDTH: usize = 100;

/// Last line of the list of quantities.
const TO_EXPLAIN: &str =
    "`tipstrike explain KEY [CASE]` shows the formula of a quantity with the numbers of a case.";

const FIELD_HEAD: [&str; 6] = ["key", "symbol", "unit", "range", "default", "meaning"];
const QUANTITY_HEAD: [&str; 5] = ["key", "symbol", "unit", "equation", "meaning"];

/// Writes every field as a table.
///
/// # Errors
/// Errors of the writer.
pub fn write_fields(out: &mut dyn Write) -> io::Result<()> {
    let rows = FIELDS.iter().map(|field| {
        [field.key, field.symbol, unit(field), &range_text(field), default(field), &meaning(field)]
            .map(str::to_owned)
    });
    write_table(FIELD_HEAD, rows.collect(), out)
}

/// Writes every quantity as a table.
///
/// # Errors
/// Errors of the writer.
pub fn write_quantities(out: &mut dyn Write) -> io::Result<()> {
    let rows = QUANTITIES.iter().map(|quantity| {
        [
            quantity.key,
            quantity.symbol,
            quantity.unit,
            quantity.equation,
            quantity.label.trim_start(),
        ]
        .map(str::to_owned)
    });
    write_table(QUANTITY_HEAD, rows.collect(), out)?;
    writeln!(out, "\n{TO_EXPLAIN}")
}

/// Writes every field as JSON, one object per line.
///
/// # Errors
/// Errors of the writer.
pub fn write_fields_json(out: &mut dyn Write) -> io::Result<()> {
    FIELDS.iter().try_for_each(|field| write_line(&FieldLine::new(field), out))
}

/// Writes every quantity as JSON, one object per line.
///
/// # Errors
/// Errors of the writer.
pub fn write_quantities_json(out: &mut dyn Write) -> io::Result<()> {
    QUANTITIES.iter().try_for_each(|quantity| {
        let line = QuantityLine {
            key: quantity.key,
            symbol: quantity.symbol,
            label: quantity.label.trim_start(),
            unit: quantity.unit,
            equation: quantity.equation,
            stage: quantity.stage.name(),
        };
        write_line(&line, out)
    })
}

#[derive(Serialize)]
struct FieldLine {
    key: &'static str,
    symbol: &'static str,
    label: &'static str,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<f64>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    choices: &'static [&'static str],
    required: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    default: Option<&'static str>,
    help: &'static str,
}

impl FieldLine {
    fn new(field: &Field) -> FieldLine {
        let (from, to) = range(field).unzip();
        FieldLine {
            key: field.key,
            symbol: field.symbol,
            label: field.label,
            unit: unit(field),
            from,
            to,
            choices: choices(field),
            required: field.absent == Absent::Refused,
            default: if let Absent::Default(text) = field.absent { Some(text) } else { None },
            help: field.help,
        }
    }
}

#[derive(Serialize)]
struct QuantityLine {
    key: &'static str,
    symbol: &'static str,
    label: &'static str,
    unit: &'static str,
    equation: &'static str,
    stage: &'static str,
}

fn unit(field: &Field) -> &'static str {
    if let Kind::Number(_, range, _) = field.kind { range.unit } else { "" }
}

fn range(field: &Field) -> Option<(f64, f64)> {
    match field.kind {
        Kind::Number(_, range, _) => Some((range.from, range.to)),
        Kind::Count(from, to, _) => Some((f64::from(from), f64::from(to))),
        Kind::Text | Kind::Choice(..) => None,
    }
}

fn choices(field: &Field) -> &'static [&'static str] {
    if let Kind::Choice(names, _) = field.kind { names } else { &[] }
}

fn range_text(field: &Field) -> String {
    range(field).map(|(from, to)| format!("{}..{}", end(from), end(to))).unwrap_or_default()
}

fn meaning(field: &Field) -> String {
    match choices(field) {
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

/// A table whose last column wraps over several lines.
fn write_table<const N: usize>(
    head: [&str; N],
    rows: Vec<[String; N]>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let rows: Vec<[String; N]> = std::iter::once(head.map(str::to_owned)).chain(rows).collect();
    let widths: [usize; N] =
        std::array::from_fn(|column| widest(rows.iter().map(|row| row[column].as_str())));
    for row in &rows {
        let Some((last, cells)) = row.split_last() else {
            continue;
        };
        let mut lead = cells
            .iter()
            .zip(widths)
            .map(|(cell, width)| format!("{cell:width$} "))
            .collect::<Vec<_>>()
            .concat();
        let indent = count(&lead);
        for line in flow(last.split(' '), WIDTH.saturating_sub(indent).max(20)) {
            writeln!(out, "{}", (lead + &line).trim_end())?;
            lead = " ".repeat(indent);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_is_listed_within_the_width() {
        let mut out = Vec::new();
        write_fields(&mut out).unwrap();
        let table = String::from_utf8(out).unwrap();
        assert!(
            FIELDS.iter().all(|field| {
                table.lines().any(|line| line.split(' ').next() == Some(field.key))
            })
        );
        assert_eq!(table.lines().find(|line| count(line) > WIDTH), None);
    }
}
