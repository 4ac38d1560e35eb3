//! The rows of a study as CSV or as JSON lines.

use std::io::{self, Write};

use super::json::{Json, json, measured, object, reason, write_line};
use super::table::{Cell, Column, Table};
use crate::model::Quantity;
use crate::study::batch::Row;
use crate::study::shard::{Format, Kind, Study};
use crate::study::sweep::Grid;

/// Writes the rows of a study as they arrive: JSON lines of a sweep, otherwise CSV.
#[derive(Clone, Copy)]
pub struct RowWriter<'a>(pub &'a Study);

impl RowWriter<'_> {
    /// Writes the part before the first row.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn begin(self, out: &mut dyn Write) -> io::Result<()> {
        match self.0.request.format {
            Format::Json => Ok(()),
            _ => self.table().write_csv_header(out),
        }
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(self, first: usize, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
        let (Study { request, kind, quantities, .. }, mut rows) = (self.0, (first..).zip(rows));
        if let (Kind::Sweep(grid), Format::Json) = (kind, request.format) {
            return rows
                .try_for_each(|(index, row)| write_line(&line(grid, quantities, index, row), out));
        }
        let points = self.0.points();
        let cells = rows.map(|(index, row)| {
            let point = points.cells(index).into_iter().map(Cell::Text);
            let computed = row.values.iter().map(|&value| Cell::number(value, ""));
            point.chain(computed).chain([row.outcome.name().into()]).collect()
        });
        self.table().with(cells).write_csv_rows(out)
    }

    /// The columns: those of the points, the quantities in SI units, the outcome.
    fn table(self) -> Table {
        let points = self.0.points().columns().into_iter();
        let points = points
            .map(|(key, unit)| Column { unit: unit.to_owned().into(), ..Column::text(key, "") });
        let computed = self.0.quantities.iter();
        let computed = computed.map(|known| Column::si(known.key, known.unit));
        Table::new("", points.chain(computed).chain([Column::text("outcome", "")]).collect())
    }
}

/// A row of a sweep as a JSON object.
fn line(grid: &Grid, quantities: &[&Quantity], index: usize, row: &Row) -> Json {
    let varied = grid.places(index).map(|(axis, at)| {
        let (point, unit) = (&axis.points[at], axis.unit.as_str());
        let unit = if unit.is_empty() { "1" } else { unit };
        let value = match point.number {
            Some(value) => json!({"value": value, "unit": unit}),
            None => json!(point.text),
        };
        (axis.key(), value)
    });
    let values = quantities.iter().zip(&row.values);
    let values =
        values.filter_map(|(known, value)| Some((known.key, measured(known, (*value)?, None))));
    json!({
        "varied": object(varied),
        "outcome": row.outcome.name(),
        "quantities": row.refusal.is_none().then(|| object(values)),
        "refusal": row.refusal.as_deref().map(reason),
    })
}
