//! The rows of a study as CSV or as JSON lines, and the chart of a sweep.

use std::io::{self, Write};

use super::chart::{self, Axis, Chart, Series};
use super::charts::pieces;
use super::common_unit;
use super::json::{Json, json, measured, object, reason, write_line};
use super::table::{Cell, Column, Table};
use crate::case::changes::label;
use crate::case::fields::index_of;
use crate::case::units::{self, System};
use crate::model::Quantity;
use crate::study::batch::{Points, Row};
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
            _ => self.table(0, &[]).write_csv_header(out),
        }
    }

    /// Writes rows.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(self, first: usize, rows: &[Row], out: &mut dyn Write) -> io::Result<()> {
        let Study { request, kind, quantities, .. } = self.0;
        match (kind, request.format) {
            (Kind::Sweep(grid), Format::Json) => (first..)
                .zip(rows)
                .try_for_each(|(index, row)| write_line(&line(grid, quantities, index, row), out)),
            _ => self.table(first, rows).write_csv_rows(out),
        }
    }

    fn table(self, first: usize, rows: &[Row]) -> Table {
        table(self.0.points(), &self.0.quantities, first, rows)
    }
}

/// The rows of a study from an index on: the columns of the points, the quantities in SI units, the
/// outcome.
#[must_use]
pub fn table(points: &dyn Points, quantities: &[&Quantity], first: usize, rows: &[Row]) -> Table {
    let columns = points.columns().into_iter();
    let columns =
        columns.map(|(key, unit)| Column { unit: unit.to_owned().into(), ..Column::text(key, "") });
    let computed = quantities.iter().map(|known| Column::si(known.key, known.unit));
    let columns = columns.chain(computed).chain([Column::text("outcome", "")]).collect();
    let cells = (first..).zip(rows).map(|(index, row)| {
        let point = points.cells(index).into_iter().map(Cell::Text);
        let computed = row.values.iter().map(|&value| Cell::number(value, ""));
        point.chain(computed).chain([row.outcome.name().into()]).collect()
    });
    Table::new("", columns).with(cells)
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

/// The chart of a sweep from its CSV: the quantities, or the selected ones, with the unit of the first,
/// over the varied field with the most values, with a curve for each combination of the other fields.
///
/// # Errors
/// The reason if the text is no sweep or has no values.
pub fn drawn(text: &str, only: &[&Quantity]) -> Result<Chart, String> {
    let invalid = |error: csv::Error| format!("this is no CSV of `tipstrike sweep`: {error}");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let head = reader.headers().map_err(invalid)?.clone();
    let rows = reader.records().collect::<Result<Vec<csv::StringRecord>, _>>().map_err(invalid)?;
    let named = |at: usize| head[at].strip_suffix(']').and_then(|name| name.split_once(" ["));
    let names: Vec<(&str, &str)> =
        (0..head.len()).map(|at| named(at).unwrap_or((&head[at], ""))).collect();
    let columns = || names.iter().copied().enumerate();
    let fields: Vec<usize> =
        columns().filter(|(_, (key, _))| index_of(key).is_some()).map(|(at, _)| at).collect();
    let known = columns().filter_map(|(at, (key, _))| Some((at, Quantity::find(key)?)));
    let is_wanted = |quantity: &Quantity| only.iter().any(|wanted| wanted.key == quantity.key);
    let mut known: Vec<(usize, &Quantity)> =
        known.filter(|(_, quantity)| only.is_empty() || is_wanted(quantity)).collect();
    let none = "this is no CSV of `tipstrike sweep` with a varied field and the quantity";
    let &(_, first) = known.first().ok_or(none)?;
    known.retain(|(_, quantity)| quantity.unit == first.unit);
    let distinct = |columns: &[usize]| {
        let mut found: Vec<Vec<&str>> = Vec::new();
        for row in &rows {
            let cells = columns.iter().map(|&at| &row[at]).collect();
            if !found.contains(&cells) {
                found.push(cells);
            }
        }
        found
    };
    // The first of equal numbers of values.
    let across = fields.iter().rev().max_by_key(|&&at| distinct(&[at]).len()).copied();
    let across = across.ok_or(none)?;
    let places = distinct(&[across]);
    let is_number = places.iter().all(|place| place[0].parse::<f64>().is_ok());
    let place = |text: &str| match text.parse() {
        Ok(number) if is_number => number,
        _ => places.iter().position(|place| place[0] == text).unwrap_or_default() as f64,
    };
    let others: Vec<usize> = fields.into_iter().filter(|&at| at != across).collect();
    let number = |row: &csv::StringRecord, at: usize| row[at].parse::<f64>().ok();
    let values = rows.iter().flat_map(|row| known.iter().filter_map(|&(at, _)| number(row, at)));
    let unit = common_unit(first, values, System::Metric);
    let factor = units::factor(unit).unwrap_or(1.0);
    let mut series = Vec::new();
    for &(at, quantity) in &known {
        for combination in distinct(&others) {
            let is_of = |row: &&csv::StringRecord| {
                others.iter().zip(&combination).all(|(&at, &text)| &row[at] == text)
            };
            let points = rows
                .iter()
                .filter(is_of)
                .map(|row| (place(&row[across]), number(row, at).map(|value| value / factor)));
            let fixed = others.iter().zip(&combination).map(|(&at, text)| {
                format!("{} {text} {}", label(names[at].0), names[at].1).trim_end().to_owned()
            });
            let own = (known.len() > 1 || others.is_empty())
                .then(|| format!("{} {}", quantity.label.trim_start(), quantity.symbol));
            let name = own.into_iter().chain(fixed).collect::<Vec<_>>().join(", ");
            let pieces = pieces(points, f64::INFINITY);
            series.push(Series { name, pieces, kind: chart::Kind::Curve });
        }
    }
    series.retain(|series| !series.pieces.is_empty());
    if series.is_empty() {
        return Err(format!("the sweep has no values of {}", first.key));
    }
    let (key, across_unit) = names[across];
    let labels = places.iter().enumerate().map(|(at, place)| (at as f64, place[0].to_owned()));
    let labels = labels.filter(|_| !is_number).collect();
    let dimension = units::Dimension::of_unit(unit).map_or("", units::Dimension::name);
    let common = dimension.trim_start_matches("an ").trim_start_matches("a ");
    let (name, up) = match known.len() {
        1 => (first.label.trim_start(), format!("{} {}", first.label.trim_start(), first.symbol)),
        _ => (common, common.to_owned()),
    };
    Ok(Chart {
        title: format!("{name} over {}", label(key)),
        across: Axis { labels, ..Axis::new(label(key), across_unit) },
        up: Axis::new(up, units::named(unit)),
        series,
        ..Chart::default()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_has_a_curve_for_each_combination_with_gaps_without_values() {
        let text = "operation.speed [rpm],driven.teeth,impact_force [N],outcome\n\
            500,20,1500.0,corner-contact\n500,30,,no-corner-contact\n\
            1000,20,2500.0,corner-contact\n1000,30,1000.0,corner-contact\n\
            1500,20,3500.0,corner-contact\n1500,30,1100.0,corner-contact\n";
        let found = drawn(text, &[]).unwrap();
        assert_eq!((found.across.unit.as_str(), found.up.unit.as_str()), ("rpm", "N"));
        let names: Vec<&str> = found.series.iter().map(|series| series.name.as_str()).collect();
        assert_eq!(names, ["driven number of teeth 20", "driven number of teeth 30"]);
        assert_eq!(found.series[0].pieces[0].len(), 3);
        assert_eq!(found.series[1].pieces, [vec![(1000.0, 1000.0), (1500.0, 1100.0)]]);
        let choices = "model.method,impact_force [N],outcome\nexact,2.0,x\npaper,1.0,x\n";
        assert_eq!(drawn(choices, &[]).unwrap().across.labels[1], (1.0, "paper".to_owned()));
        assert!(drawn("a,b\n1,2\n", &[]).is_err() && drawn("", &[]).is_err());
    }
}
