//! The fields of a case and the quantities of a result, as lists and as JSON Schemas.

use crate::case::fields::{AUTO, Absent, FIELDS, Field, GROUPS, Kind};
use crate::case::file::FORMAT;
use crate::case::spread::Shape;
use crate::case::units::{Dimension, named};
use crate::model::inputs::Method;
use crate::model::{Outcome, QUANTITIES, Quantity, Stage};
use crate::report::stations::COLUMNS;
use crate::report::table::{Cell, Column, Table, WIDTH, item, json, write_line};
use serde_json::{Map, Value};
use std::io::{self, Write};

/// Last line of the list of quantities.
const TO_EXPLAIN: &str =
    "`tipstrike explain KEY [CASE]` shows the formula of a quantity with the numbers of a case.";

/// Writes a list of keys for a reader: key, symbol and the parts of the meaning.
fn write_list(
    rows: impl Iterator<Item = (&'static str, &'static str, [String; 3])>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut columns = ["key", "symbol", "meaning"].map(|key| Column::text(key, key)).to_vec();
    columns[0].gap = 0;
    let rows = rows.map(|(key, symbol, parts)| {
        let parts = parts.into_iter().filter(|part| !part.is_empty());
        [key, symbol, &parts.collect::<Vec<_>>().join("; ")].map(Cell::from).to_vec()
    });
    let lines = Table::new("", columns).with(rows).wrapped(WIDTH);
    lines.iter().try_for_each(|line| writeln!(out, "{line}"))
}

/// Writes every field as a table, or as JSON with one object per line.
///
/// # Errors
/// Errors of the writer.
pub fn write_fields(is_json: bool, out: &mut dyn Write) -> io::Result<()> {
    if !is_json {
        let row = |field: &Field| {
            let range = field.range().map(|range| {
                let text = format!("{}..{} {}", end(range.from), end(range.to), range.unit);
                text.trim_end().to_owned()
            });
            let parts = [meaning(field), range.unwrap_or_default(), absence(field)];
            (field.key, field.symbol, parts)
        };
        return write_list(FIELDS.iter().map(row), out);
    }
    FIELDS.iter().try_for_each(|field| {
        let (from, to) = field.range().map(|range| (range.from, range.to)).unzip();
        let choices = Some(field.choices()).filter(|choices| !choices.is_empty());
        let default = if let Absent::Default(text) = field.absent { Some(text) } else { None };
        let line = json!({
            "key": field.key,
            "symbol": field.symbol,
            "label": field.label,
            "unit": field.range().map_or("", |range| range.unit),
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
        return QUANTITIES.iter().try_for_each(|quantity| {
            let Quantity { key, symbol, label, unit, equation, stage, .. } = quantity;
            let (label, stage) = (label.trim_start(), stage.name());
            let line = json!({"key": key, "symbol": symbol, "label": label, "unit": unit, "equation": equation, "stage": stage});
            write_line(&line, out)
        });
    }
    let rows = QUANTITIES.iter().map(|Quantity { key, symbol, label, unit, equation, .. }| {
        (*key, *symbol, [label.trim_start(), named(unit), equation].map(str::to_owned))
    });
    write_list(rows, out)?;
    writeln!(out)?;
    item("", TO_EXPLAIN).iter().try_for_each(|line| writeln!(out, "{line}"))
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

/// What applies without a value.
fn absence(field: &Field) -> String {
    match field.absent {
        Absent::Refused => "required".to_owned(),
        Absent::Either => "this or its alternative is required".to_owned(),
        Absent::Default("") => String::new(),
        Absent::Default(text) => format!("default {text}"),
        Absent::Without(text) => format!("left out: {text}"),
    }
}

const DRAFT: &str = "https://json-schema.org/draft/2020-12/schema";

/// A number followed by a unit.
const MEASURE: &str = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*[^\s0-9].*$";

/// Writes the schema of a case file.
///
/// # Errors
/// Errors of the writer.
pub fn write_case(out: &mut dyn Write) -> io::Result<()> {
    let mut tables = Map::new();
    tables.insert("format".to_owned(), json!({"const": FORMAT}));
    for (table, title) in GROUPS {
        let fields = FIELDS.iter().filter(|field| field.table() == table);
        let members = fields.map(|field| (field.name().to_owned(), of_field(field)));
        if table.is_empty() {
            tables.extend(members);
        } else {
            let members: Map<String, Value> = members.collect();
            tables.insert(table.to_owned(), object(title, members));
        }
    }
    let limits = Quantity::all().map(|known| (known.key.to_owned(), of_limit(known)));
    let help = "Greatest allowed value of any quantity of the results.";
    tables.insert("limits".to_owned(), object(help, limits.collect()));
    let spread = FIELDS.iter().filter_map(|field| Some((field.key.to_owned(), of_spread(field)?)));
    let help = "Distribution of a field around its value.";
    tables.insert("spread".to_owned(), object(help, spread.collect()));
    tables.insert("variants".to_owned(), of_variants(&tables));
    let help = "Texts for the page of a report, such as project, author, date and drawing.";
    let any = json!({"type": ["string", "number"]});
    let about = json!({"description": help, "type": "object", "additionalProperties": any});
    tables.insert("about".to_owned(), about);
    let mut schema = object("A case of tipstrike: a gear pair in operation.", tables);
    schema["$schema"] = DRAFT.into();
    schema["required"] = json!(["format"]);
    print(schema, out)
}

/// Writes the schema of a line of `solve --format json`.
///
/// # Errors
/// Errors of the writer.
pub fn write_results(out: &mut dyn Write) -> io::Result<()> {
    let quantities = Quantity::all().map(|known| (known.key.to_owned(), of_quantity(known)));
    let help = "Values in SI units; a quantity without a value is absent.";
    let columns = COLUMNS.iter().map(|column| {
        let about = format!("in {}", column.unit);
        (column.key.to_owned(), json!({"type": "number", "description": about}))
    });
    let stages: Vec<&str> = Stage::ALL.into_iter().map(Stage::name).collect();
    let outcomes = [Outcome::CornerContact, Outcome::NoCornerContact].map(Outcome::name);
    let methods = Method::ALL.map(Method::name);
    let note = json!({
        "type": "object",
        "properties": {"code": {"type": "string"}, "message": {"type": "string"}},
        "required": ["code", "message"],
    });
    let schema = json!({
        "$schema": DRAFT,
        "description": "What `tipstrike solve --format json` prints for a case.",
        "type": "object",
        "properties": {
            "case": {"type": "string"},
            "title": {"type": "string"},
            "format": {"const": FORMAT},
            "version": {"type": "string"},
            "method": {"enum": methods},
            "plane": {"const": "transverse"},
            "outcome": {"enum": outcomes},
            "exit_outcome": {"enum": outcomes},
            "quantities": object(help, quantities.collect()),
            "stations": {"type": "array", "items": object("One station.", columns.collect())},
            "stages": {"type": "array", "items": {"enum": stages}},
            "notes": {"type": "array", "items": note},
        },
        "required": ["case", "format", "version", "method", "outcome", "quantities", "stages", "notes"],
    });
    print(schema, out)
}

fn print(mut schema: Value, out: &mut dyn Write) -> io::Result<()> {
    schema.sort_all_objects();
    serde_json::to_writer_pretty(&mut *out, &schema)?;
    writeln!(out)
}

/// An object with these members and no others.
fn object(description: &str, members: Map<String, Value>) -> Value {
    let mut schema = json!({
        "description": description,
        "type": "object",
        "additionalProperties": false,
    });
    schema["properties"] = Value::Object(members);
    schema
}

fn of_field(field: &Field) -> Value {
    let mut schema = match field.kind {
        Kind::Text => json!({"type": "string"}),
        Kind::List(_) => json!({"type": "array", "items": {"type": "number"}}),
        Kind::Choice(..) if field.is_flag() => json!({"type": "boolean"}),
        Kind::Choice(names, _) => json!({"enum": names}),
        Kind::Count(from, to, _) => {
            let number = json!({"type": "integer", "minimum": from, "maximum": to});
            if field.takes_auto() { json!({"anyOf": [number, {"const": AUTO}]}) } else { number }
        }
        Kind::Number(Dimension::Number, range, _) => {
            json!({"type": "number", "minimum": range.from, "maximum": range.to})
        }
        Kind::Number(..) => {
            json!({"type": "string", "pattern": MEASURE, "examples": [field.example()]})
        }
    };
    let range = field.range_text();
    let about = if range.is_empty() || matches!(field.kind, Kind::Choice(..)) {
        format!("{}. {}", field.label, field.help)
    } else {
        format!("{}, {range}. {}", field.label, field.help)
    };
    schema["description"] = about.into();
    if let Absent::Default(text) = field.absent
        && !text.is_empty()
    {
        schema["default"] = if field.is_bare() {
            serde_json::from_str(text).unwrap_or_else(|_| text.into())
        } else {
            text.into()
        };
    }
    schema
}

fn of_limit(quantity: &Quantity) -> Value {
    let value = if quantity.unit == "1" {
        json!({"type": "number"})
    } else {
        // Zero needs no unit.
        json!({"anyOf": [{"type": "string", "pattern": MEASURE}, {"enum": [0, "0"]}]})
    };
    let relative = json!({"type": "string", "pattern": r"^\s*[0-9.eE+-]+ x [a-z0-9_]+\s*$"});
    let description = format!("{} {}", quantity.label, quantity.symbol);
    json!({"description": description, "anyOf": [value, relative]})
}

fn of_quantity(quantity: &Quantity) -> Value {
    let kind = if quantity.is_flag() { "boolean" } else { "number" };
    json!({
        "description": format!("{} {}", quantity.label, quantity.symbol),
        "type": "object",
        "properties": {
            "value": {"type": kind},
            "unit": {"const": quantity.unit},
            "of": {"type": "string"},
            "method": {"type": "string"},
        },
        "required": ["value", "unit"],
        "additionalProperties": false,
    })
}

/// The variants: tables of a case without required keys, or dotted keys. An empty text removes a
/// key.
fn of_variants(tables: &Map<String, Value>) -> Value {
    let or_empty = |value: &Value| json!({"anyOf": [value, {"const": ""}]});
    let mut members = Map::new();
    for (name, of_table) in tables.iter().filter(|(name, _)| *name != "format") {
        let Some(keys) = of_table["properties"].as_object() else {
            members.insert(name.clone(), of_table.clone());
            continue;
        };
        let mut table = Map::new();
        for (key, value) in keys {
            table.insert(key.clone(), or_empty(value));
            members.insert(format!("{name}.{key}"), or_empty(value));
        }
        members.insert(name.clone(), object(name, table));
    }
    let mut variant = object("Values that replace those of the case.", members);
    variant["minProperties"] = 1.into();
    json!({
        "description": "Named overrides of the case.",
        "type": "object",
        // ASCII is limited to letters, digits, _ and -. Validators in Python do not know \p{L}.
        "propertyNames": {"pattern": r"^[^\x00-,./:-@\[-^`{-\x7f]{1,40}$"},
        "additionalProperties": variant,
    })
}

/// The distributions that a field accepts.
fn of_spread(field: &Field) -> Option<Value> {
    let Kind::Number(dimension, ..) = field.kind else {
        return None;
    };
    let width = if dimension == Dimension::Number {
        json!({"type": "number", "exclusiveMinimum": 0})
    } else {
        json!({"type": "string", "pattern": MEASURE})
    };
    let shapes = Shape::ALL.into_iter().filter_map(|shape| {
        let width = match shape {
            Shape::Grade if field.name() != "base_pitch" => return None,
            Shape::Grade => json!({"type": "integer", "minimum": 1, "maximum": 11}),
            _ => width.clone(),
        };
        Some((shape.name().to_owned(), width))
    });
    let mut schema = object(field.label, shapes.collect());
    schema["minProperties"] = 1.into();
    schema["maxProperties"] = 1.into();
    Some(schema)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::table::count;

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
