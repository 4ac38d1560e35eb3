//! The rows of a sweep as CSV or as JSON lines.

use std::io::{self, Write};

use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

use super::data::{ValueWithUnit, cell, write_line, write_rows};
use crate::case::Problem;
use crate::model::Quantity;
use crate::study::batch::{PointOutcome, Refused, Rows};
use crate::study::sweep::Grid;

/// The format of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TableFormat {
    /// A header and one row per point.
    Csv,
    /// One object per line and point.
    Json,
}

impl TableFormat {
    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            TableFormat::Csv => "csv",
            TableFormat::Json => "json",
        }
    }

    /// The format with a name.
    #[must_use]
    pub fn named(name: &str) -> TableFormat {
        if name == TableFormat::Json.name() { TableFormat::Json } else { TableFormat::Csv }
    }
}

/// Writer of a sweep to a file or a stream.
#[derive(Clone, Copy)]
pub struct SweepTable<'a> {
    /// The points.
    pub grid: &'a Grid,
    /// The columns after those of the varied fields.
    pub quantities: &'a [&'static Quantity],
    /// The format.
    pub format: TableFormat,
}

impl SweepTable<'_> {
    /// Writes the part before the first row.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn begin(&self, out: &mut dyn Write) -> io::Result<()> {
        if self.format == TableFormat::Json {
            return Ok(());
        }
        let varied = self.grid.axes.iter().map(|axis| match axis.unit.as_str() {
            "" => axis.key().to_owned(),
            unit => format!("{} [{unit}]", axis.key()),
        });
        let computed =
            self.quantities.iter().map(|quantity| format!("{} [{}]", quantity.key, quantity.unit));
        let header = varied.chain(computed).chain(["outcome".to_owned()]);
        write_rows([header.collect()], out)
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, rows: &Rows, out: &mut dyn Write) -> io::Result<()> {
        match self.format {
            TableFormat::Csv => self.write_csv(rows, out),
            TableFormat::Json => self.write_json(rows, out),
        }
    }

    fn write_csv(&self, rows: &Rows, out: &mut dyn Write) -> io::Result<()> {
        let lines = rows.range().enumerate().map(|(row, index)| {
            let varied = self.grid.places(index);
            varied
                .map(|(axis, at)| axis.points[at].text.clone())
                .chain(rows.values(row).map(cell))
                .chain([rows.outcomes[row].name().to_owned()])
                .collect()
        });
        write_rows(lines, out)
    }

    fn write_json(&self, rows: &Rows, out: &mut dyn Write) -> io::Result<()> {
        for (row, index) in rows.range().enumerate() {
            let line = Line {
                varied: Varied(self.grid, index),
                outcome: rows.outcomes[row].name(),
                quantities: Computed(self.quantities, rows, row),
                refusal: rows.refusal(row).map(Reason::of),
            };
            write_line(&line, out)?;
        }
        Ok(())
    }

    /// Refused points in one sentence.
    #[must_use]
    pub fn refused(&self, refused: &Refused, of: usize) -> String {
        let Refused { count, first, problem } = refused;
        let which = if *count == 1 { "" } else { "the first " };
        format!("{count} of {of} points refused, {which}at {}: {problem}", self.grid.point(*first))
    }
}

#[derive(Serialize)]
struct Line<'a> {
    varied: Varied<'a>,
    outcome: &'static str,
    #[serde(skip_serializing_if = "Computed::is_refused")]
    quantities: Computed<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<Reason<'a>>,
}

#[derive(Serialize)]
pub(super) struct Reason<'a> {
    field: &'a str,
    cause: &'a str,
    fix: &'a str,
}

impl Reason<'_> {
    pub(super) fn of(problem: &Problem) -> Reason<'_> {
        Reason { field: &problem.field, cause: &problem.cause, fix: &problem.fix }
    }
}

struct Varied<'a>(&'a Grid, usize);

#[derive(Serialize)]
struct Given<'a> {
    value: f64,
    unit: &'a str,
}

impl Serialize for Varied<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Varied(grid, index) = *self;
        let mut map = serializer.serialize_map(Some(grid.axes.len()))?;
        for (axis, at) in grid.places(index) {
            let point = &axis.points[at];
            let unit = if axis.unit.is_empty() { "1" } else { axis.unit.as_str() };
            match point.number {
                Some(value) => map.serialize_entry(axis.key(), &Given { value, unit })?,
                None => map.serialize_entry(axis.key(), &point.text)?,
            }
        }
        map.end()
    }
}

struct Computed<'a>(&'a [&'static Quantity], &'a Rows, usize);

impl Computed<'_> {
    fn is_refused(&self) -> bool {
        self.1.outcomes[self.2] == PointOutcome::Refused
    }
}

impl Serialize for Computed<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Computed(quantities, rows, row) = *self;
        let values = quantities.iter().zip(rows.values(row));
        serializer.collect_map(values.filter_map(|(quantity, value)| {
            Some((quantity.key, ValueWithUnit::new(quantity, value?)))
        }))
    }
}
