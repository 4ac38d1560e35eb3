//! The rows of a sweep as CSV or as JSON lines.

use std::io::{self, Write};

use super::json::{Json, measured, object, reason, write_line};
use super::table::{Cell, Column, Table};
use crate::model::Quantity;
use crate::study::batch::{PointOutcome, Rows};
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
    pub fn write(&self, rows: &Rows, out: &mut dyn Write) -> io::Result<()> {
        let mut points = rows.range().enumerate();
        if self.format == Format::Json {
            return points
                .try_for_each(|(row, index)| write_line(&self.line(rows, row, index), out));
        }
        let cells = points.map(|(row, index)| self.cells(rows, row, index));
        self.table().with(cells).write_csv_rows(out)
    }

    /// The columns: the varied fields in their units, the quantities in SI units, the outcome.
    fn table(&self) -> Table {
        let varied = self
            .grid
            .axes
            .iter()
            .map(|axis| Column { unit: axis.unit.clone().into(), ..Column::text(axis.key(), "") });
        let computed = self.quantities.iter();
        let computed = computed.map(|known| Column::number(known.key, "", known.unit, ("1", 0)));
        Table::new("", varied.chain(computed).chain([Column::text("outcome", "")]).collect())
    }

    fn cells(&self, rows: &Rows, row: usize, index: usize) -> Vec<Cell> {
        let varied = self.grid.places(index).map(|(axis, at)| axis.points[at].text.as_str().into());
        let computed = rows.values(row).map(|value| Cell::number(value, ""));
        varied.chain(computed).chain([rows.outcomes[row].name().into()]).collect()
    }

    fn line(&self, rows: &Rows, row: usize, index: usize) -> Json {
        let varied = self.grid.places(index).map(|(axis, at)| {
            let (point, unit) = (&axis.points[at], axis.unit.as_str());
            let unit = if unit.is_empty() { "1" } else { unit };
            let value = match point.number {
                Some(value) => object([("value", value.into()), ("unit", unit.into())]),
                None => point.text.as_str().into(),
            };
            (axis.key(), value)
        });
        let is_solved = rows.outcomes[row] != PointOutcome::Refused;
        let values = self.quantities.iter().zip(rows.values(row));
        let values =
            values.filter_map(|(known, value)| Some((known.key, measured(known, value?, None))));
        object([
            ("varied", object(varied)),
            ("outcome", rows.outcomes[row].name().into()),
            ("quantities", is_solved.then(|| object(values)).into()),
            ("refusal", rows.refusal(row).map(reason).into()),
        ])
    }
}
