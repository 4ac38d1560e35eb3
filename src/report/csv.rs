//! Solves as CSV in SI units and full precision: one row per case, or one row per station.

use super::stations::{columns, rows as stations};
use super::{Report, value};
use crate::case::sanitize::sanitize;
use csv::{ErrorKind, Writer};
use std::io::{self, Write};

/// Writes the requested quantities of a case, or the stations if they are requested.
///
/// # Errors
/// Errors of the writer.
pub fn write(report: &Report, with_header: bool, out: &mut dyn Write) -> io::Result<()> {
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
        return stations(solution)
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
