//! A solve as data in SI units and full precision: a JSON object on one line, or rows of CSV.

use std::io::{self, Write};

use super::json::{json, measured, object};
use super::stations::columns;
use super::table::{Cell, Column, Table};
use super::{Report, value};
use crate::case::file::FORMAT;
use crate::case::sanitize::sanitize;
use crate::model::inputs::Method;
use crate::model::{Quantity, Stage};

pub use super::json::write_line;

/// The subject of a quantity in a method, if it differs from the result of the method.
pub(super) fn subject(quantity: &Quantity, method: Method) -> Option<&'static str> {
    if method.shares_load() && quantity.is_of_free_impact() {
        Some("free-impact")
    } else if is_without_deviations(quantity) {
        Some("without-deviations")
    } else if quantity.symbol_in(method) != quantity.symbol {
        Some("deviations-without-reliefs")
    } else {
        None
    }
}

/// Whether the quantity belongs to a pair in which no tooth deviates.
pub(super) fn is_without_deviations(quantity: &Quantity) -> bool {
    matches!(quantity.stage, Stage::StaticSpectrum | Stage::SteadyMotion | Stage::SpeedRun)
}

/// Writes the report as one line.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    let solution = &report.solution;
    let quantities = report.values().map(|(quantity, value)| {
        (quantity.key, measured(quantity, value, subject(quantity, solution.method)))
    });
    let stations = report.selection.stations.then(|| stations(report).objects());
    let notes = report.notes.iter().map(|note| json!({"code": note.code, "message": note.message}));
    let stages = solution.all_stages();
    let line = json!({
        "case": report.name,
        "title": report.case.title(),
        "format": FORMAT,
        "version": env!("CARGO_PKG_VERSION"),
        "method": solution.method.name(),
        "outcome": solution.outcome.name(),
        "quantities": object(quantities),
        "stations": stations,
        "stages": stages.iter().map(Stage::name).collect::<Vec<_>>(),
        "notes": notes.collect::<Vec<_>>(),
    });
    write_line(&line, out)
}

/// The stations of a solve.
#[must_use]
pub fn stations(report: &Report) -> Table {
    let columns: Vec<_> = columns(report.solution.method).collect();
    let solution = &report.solution;
    let row =
        |row| columns.iter().map(|column| Cell::number(column.of(solution, row), "-")).collect();
    let cells = report.solution.own_stations().iter().map(row);
    let column = |known: &&super::stations::Column| {
        let title = format!("{} {}", known.symbol, known.shown);
        Column::number(known.key, title, known.unit, (known.shown, known.digits)).wide(0, 12)
    };
    Table::new("", columns.iter().map(column).collect()).with(cells)
}

/// Writes the requested quantities of a case, or the stations if they are requested.
///
/// # Errors
/// Errors of the writer.
pub fn write_csv(report: &Report, with_header: bool, out: &mut dyn Write) -> io::Result<()> {
    let mut table = if report.selection.stations { stations(report) } else { quantities(report) };
    table.columns.insert(0, Column::text("case", ""));
    let name = sanitize(&report.name);
    table.rows.iter_mut().for_each(|row| row.insert(0, name.as_str().into()));
    if with_header { table.write_csv(out) } else { table.write_csv_rows(out) }
}

/// One row with method, outcome and the requested quantities.
fn quantities(report: &Report) -> Table {
    let solution = &report.solution;
    let words = ["method", "outcome"].map(|key| Column::text(key, ""));
    let known = report.selection.quantities();
    let computed = known.map(|quantity| Column::si(quantity.key, quantity.unit));
    let names = [solution.method.name(), solution.outcome.name()].map(Cell::from);
    let values = report.selection.quantities();
    let values = values.map(|quantity| Cell::number(value(quantity, solution), ""));
    Table::new("", words.into_iter().chain(computed).collect())
        .with([names.into_iter().chain(values).collect()])
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
        solution.stations[0].force = f64::INFINITY;
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
}
