//! The rows of a sweep as CSV or as JSON lines.

use std::io::{self, Write};

use super::json::{Json, json, measured, object, reason, write_line};
use super::table::{Cell, Column, Table};
use crate::model::Quantity;
use crate::study::batch::Row;
use crate::study::shard::Format;
use crate::study::sweep::Grid;

/// Writer of a sweep to a file or a stream.
#[derive(Clone, Copy)]
pub struct SweepTable<'a> {
    /// The points.
    pub grid: &'a Grid,
    /// The columns after those of the varied fields.
    pub quantities: &'a [&'static Quantity],
    /// The format: JSON lines, otherwise CSV.
    pub format: Format,
}

impl SweepTable<'_> {
    /// Writes the part before the first row.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn begin(&self, out: &mut dyn Write) -> io::Result<()> {
        match self.format {
            Format::Json => Ok(()),
            _ => self.table().write_csv_header(out),
        }
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, first: usize, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
        let mut rows = (first..).zip(rows);
        if self.format == Format::Json {
            return rows.try_for_each(|(index, row)| write_line(&self.line(index, row), out));
        }
        let cells = rows.map(|(index, row)| {
            let varied = self.grid.places(index);
            let varied = varied.map(|(axis, at)| axis.points[at].text.as_str().into());
            let computed = row.values.iter().map(|&value| Cell::number(value, ""));
            varied.chain(computed).chain([row.outcome.name().into()]).collect()
        });
        self.table().with(cells).write_csv_rows(out)
    }

    /// The columns: the varied fields in their units, the quantities in SI units, the outcome.
    fn table(&self) -> Table {
        let varied = self.grid.axes.iter();
        let varied = varied
            .map(|axis| Column { unit: axis.unit.clone().into(), ..Column::text(axis.key(), "") });
        let computed = self.quantities.iter();
        let computed = computed.map(|known| Column::si(known.key, known.unit));
        Table::new("", varied.chain(computed).chain([Column::text("outcome", "")]).collect())
    }

    fn line(&self, index: usize, row: &Row) -> Json {
        let varied = self.grid.places(index).map(|(axis, at)| {
            let (point, unit) = (&axis.points[at], axis.unit.as_str());
            let unit = if unit.is_empty() { "1" } else { unit };
            let value = match point.number {
                Some(value) => json!({"value": value, "unit": unit}),
                None => json!(point.text),
            };
            (axis.key(), value)
        });
        let values = self.quantities.iter().zip(&row.values);
        let values =
            values.filter_map(|(known, value)| Some((known.key, measured(known, (*value)?, None))));
        json!({
            "varied": object(varied),
            "outcome": row.outcome.name(),
            "quantities": row.refusal.is_none().then(|| object(values)),
            "refusal": row.refusal.as_deref().map(reason),
        })
    }
}
