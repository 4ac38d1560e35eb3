//! A solve as data in SI units and full precision: a JSON object on one line, or rows of CSV.

use std::io::{self, Write};

use super::stations::{self, columns, rows as station_rows};
use super::{Report, value};
use crate::case::file::FORMAT;
use crate::case::sanitize::{is_hidden, sanitize};
use crate::model::inputs::Method;
use crate::model::{Quantity, Stage};
use csv::{ErrorKind, Writer};
use serde::{Serialize, Serializer};
use serde_json::ser::Formatter;

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    format: u32,
    version: &'static str,
    method: &'static str,
    outcome: &'static str,
    quantities: Quantities<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stations: Option<Vec<Cells<'a>>>,
    stages: Vec<&'static str>,
    notes: Vec<Remark<'a>>,
}

/// A value and its unit.
#[derive(Serialize)]
pub(super) struct ValueWithUnit {
    value: Value,
    unit: &'static str,
    /// The subject of the value, if it differs from the result of the method.
    #[serde(skip_serializing_if = "Option::is_none")]
    of: Option<&'static str>,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Value {
    Number(f64),
    Flag(bool),
}

impl ValueWithUnit {
    /// A value of a quantity in SI.
    pub(super) fn new(quantity: &Quantity, value: f64) -> ValueWithUnit {
        ValueWithUnit { value: Value::of(quantity, value), unit: quantity.unit, of: None }
    }
}

impl Value {
    fn of(quantity: &Quantity, value: f64) -> Value {
        if quantity.is_flag() { Value::Flag(value != 0.0) } else { Value::Number(value) }
    }
}

#[derive(Serialize)]
struct Remark<'a> {
    code: &'a str,
    message: &'a str,
}

struct Quantities<'a>(&'a Report);

impl Serialize for Quantities<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let method = self.0.solution.method;
        let measured = |quantity: &Quantity, value| ValueWithUnit {
            of: subject(quantity, method),
            ..ValueWithUnit::new(quantity, value)
        };
        serializer.collect_map(
            self.0.values().map(|(quantity, value)| (quantity.key, measured(quantity, value))),
        )
    }
}

/// The subject of a quantity in a method, if it differs from the result of the method.
pub(super) fn subject(quantity: &Quantity, method: Method) -> Option<&'static str> {
    if method.shares_load() && quantity.is_of_free_impact() {
        Some("free-impact")
    } else if quantity.symbol_in(method) != quantity.symbol {
        Some("deviations-without-reliefs")
    } else {
        None
    }
}

struct Cells<'a>(stations::Row<'a>);

impl Serialize for Cells<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(
            stations::COLUMNS.iter().filter_map(|column| Some((column.key, column.of(self.0)?))),
        )
    }
}

/// Writes the report as one line.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    let solution = &report.solution;
    let line = Line {
        case: &report.name,
        title: report.title(),
        format: FORMAT,
        version: env!("CARGO_PKG_VERSION"),
        method: solution.method.name(),
        outcome: solution.outcome.name(),
        quantities: Quantities(report),
        stations: report
            .selection
            .stations
            .then(|| stations::rows(solution).into_iter().map(Cells).collect()),
        stages: solution.all_stages().iter().map(Stage::name).collect(),
        notes: report
            .notes
            .iter()
            .map(|note| Remark { code: note.code, message: &note.message })
            .collect(),
    };
    write_line(&line, out)
}

/// Writes a value as one line of JSON that is safe to print on a terminal.
///
/// # Errors
/// Errors of the writer.
pub fn write_line(value: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    value.serialize(&mut serde_json::Serializer::with_formatter(&mut *out, Safe))?;
    out.write_all(b"\n")
}

/// Compact JSON that also escapes the characters that a terminal interprets or hides.
struct Safe;

impl Formatter for Safe {
    fn write_string_fragment<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        fragment: &str,
    ) -> io::Result<()> {
        let mut written = 0;
        for (at, hidden) in fragment.match_indices(is_hidden) {
            writer.write_all(&fragment.as_bytes()[written..at])?;
            hidden.encode_utf16().try_for_each(|unit| write!(writer, "\\u{unit:04x}"))?;
            written = at + hidden.len();
        }
        writer.write_all(&fragment.as_bytes()[written..])
    }
}

/// Writes the requested quantities of a case, or the stations if they are requested.
///
/// # Errors
/// Errors of the writer.
pub fn write_csv(report: &Report, with_header: bool, out: &mut dyn Write) -> io::Result<()> {
    let header = with_header.then(|| header(report));
    write_rows(header.into_iter().chain(rows(report)), out)
}

/// Writes rows of cells.
///
/// # Errors
/// Errors of the writer.
pub(super) fn write_rows(
    rows: impl IntoIterator<Item = Vec<String>>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut writer = Writer::from_writer(out);
    rows.into_iter().try_for_each(|row| writer.write_record(row)).map_err(io_error)?;
    writer.flush()
}

/// Keeps the kind of the error, so that the caller recognises a closed pipe.
fn io_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

fn header(report: &Report) -> Vec<String> {
    let with_unit = |key: &str, unit: &str| format!("{key} [{unit}]");
    if report.selection.stations {
        let columns =
            columns(report.solution.method).map(|column| with_unit(column.key, column.unit));
        return std::iter::once("case".to_owned()).chain(columns).collect();
    }
    let columns =
        report.selection.quantities().map(|quantity| with_unit(quantity.key, quantity.unit));
    ["case", "method", "outcome"].map(str::to_owned).into_iter().chain(columns).collect()
}

fn rows(report: &Report) -> Vec<Vec<String>> {
    let name = sanitize(&report.name);
    let solution = &report.solution;
    if report.selection.stations {
        let cells = |row| columns(solution.method).map(move |column| cell(column.of(row)));
        return station_rows(solution)
            .into_iter()
            .map(|row| std::iter::once(name.clone()).chain(cells(row)).collect())
            .collect();
    }
    let head = [name, solution.method.name().to_owned(), solution.outcome.name().to_owned()];
    let cells = report.selection.quantities().map(|quantity| cell(value(quantity, solution)));
    vec![head.into_iter().chain(cells).collect()]
}

/// The shortest text that parses to the same number; empty for an absent value.
pub(super) fn cell(value: Option<f64>) -> String {
    value.map(|value| format!("{value:?}")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::model::{Stages, solve};
    use crate::report::Selection;

    #[test]
    fn json_omits_a_value_that_is_no_number_and_adds_a_note() {
        let case = Case::table_1();
        let inputs = case.inputs().unwrap();
        let mut solution = solve(&inputs, Stages::ALL).unwrap();
        solution.mesh_force = f64::NAN;
        solution.stations[0].impact_force = f64::INFINITY;
        let selection = Selection { stations: true, ..Selection::default() };
        let mut out = Vec::new();
        write_json(&Report::of("case".to_owned(), case, inputs, solution, selection), &mut out)
            .unwrap();
        let line: serde_json::Value = serde_json::from_slice(&out).unwrap();
        assert_eq!(line["quantities"].get("mesh_force"), None);
        assert_eq!(line["quantities"].get("dynamic_factor"), None);
        assert_eq!(line["stations"][0].get("impact_force"), None);
        let is_of_mesh_force = |note: &serde_json::Value| {
            note["code"] == "not-finite" && note["message"].to_string().contains("mesh_force")
        };
        assert!(line["notes"].as_array().unwrap().iter().any(is_of_mesh_force));
        assert!(!String::from_utf8(out).unwrap().contains("null"));
    }

    #[test]
    fn control_characters_are_escaped_and_parse_to_the_same_text() {
        let text = "a\u{1b}[2J\u{7f}\u{9b}\u{202e}\u{e0041}\"\\\n é";
        let mut out = Vec::new();
        write_line(&text, &mut out).unwrap();
        let line = String::from_utf8(out).unwrap();
        assert_eq!(line, "\"a\\u001b[2J\\u007f\\u009b\\u202e\\udb40\\udc41\\\"\\\\\\n é\"\n");
        assert_eq!(serde_json::from_str::<String>(&line).unwrap(), text);
    }
}
