//! A comparison as CSV and as JSON, in SI units.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::{Column, Comparison, REFUSED, Refused};
use crate::case::changes::between;
use crate::case::file::FORMAT;
use crate::case::sanitize::sanitize;
use crate::model::Quantity;
use crate::report::csv::{cell, write_rows};
use crate::report::difference::percent;
use crate::report::json::write_line;

impl Comparison {
    /// Writes one row per quantity: its name and unit, the value of each column, and the
    /// differences from the first one.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let names = self.columns.iter().map(|column| sanitize(&column.name));
        let differences = names
            .clone()
            .skip(1)
            .map(|name| format!("{name} - reference"));
        let head = ["quantity", "unit"].map(str::to_owned).into_iter();
        let words = |name: &str, of: &dyn Fn(&Column) -> &'static str| {
            let head = [name.to_owned(), String::new()].into_iter();
            let blank = self.columns.iter().skip(1).map(|_| String::new());
            let cells = self.columns.iter().map(|column| of(column).to_owned());
            head.chain(cells).chain(blank).collect()
        };
        let rows = [
            head.chain(names).chain(differences).collect(),
            words("method", &method),
            words("outcome", &outcome),
        ];
        write_rows(
            rows.into_iter()
                .chain(self.quantities().map(|known| self.csv_row(known))),
            out,
        )
    }

    fn csv_row(&self, quantity: &Quantity) -> Vec<String> {
        let values = self.values(quantity);
        let base = values.first().copied().flatten();
        // Flags have no difference.
        let base = base.filter(|_| !quantity.is_flag());
        let difference = |value: &Option<f64>| cell(value.zip(base).map(|(now, base)| now - base));
        let cells = values.iter().map(|value| cell(*value));
        [quantity.key, quantity.unit]
            .map(str::to_owned)
            .into_iter()
            .chain(cells)
            .chain(values.iter().skip(1).map(difference))
            .collect()
    }

    /// The quantities with a value in some column.
    fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let quantities = self.selection.quantities();
        let has_value = |quantity: &&Quantity| self.values(quantity).iter().any(Option::is_some);
        quantities.filter(move |quantity| has_value(quantity))
    }

    /// Writes one object in SI units without absent values.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let columns = (0..self.columns.len()).map(|at| self.json_column(at));
        let all = json!({
            "format": FORMAT,
            "version": env!("CARGO_PKG_VERSION"),
            "columns": columns.collect::<Vec<_>>(),
        });
        write_line(&all, out)
    }

    fn json_column(&self, at: usize) -> Value {
        let column = &self.columns[at];
        let mut object = json!({
            "name": column.name,
            "case": column.file,
            "outcome": outcome(column),
            "inputs": self.json_inputs(column),
        });
        if let Some(variant) = &column.variant {
            object["variant"] = json!(variant);
        }
        match &column.found {
            Ok(_) => {
                object["method"] = json!(method(column));
                object["quantities"] = self.json_quantities(at);
            }
            Err(refused) => {
                let Some(Refused { problem, .. }) = refused.first() else {
                    return object;
                };
                object["refusal"] =
                    json!({"field": problem.field, "cause": problem.cause, "fix": problem.fix});
            }
        }
        object
    }

    /// The inputs that differ from those of the first column, as written.
    fn json_inputs(&self, column: &Column) -> Value {
        let changes = self
            .columns
            .first()
            .map(|first| between(&first.case, &column.case));
        let is_input = |key: &str| !key.starts_with("variants.");
        let texts = changes
            .into_iter()
            .flatten()
            .filter(|change| is_input(&change.key));
        let texts = texts.map(|change| (change.key, json!(change.to.unwrap_or_default())));
        Value::Object(texts.collect())
    }

    fn json_quantities(&self, at: usize) -> Value {
        let mut object = Map::new();
        for quantity in self.quantities() {
            let values = self.values(quantity);
            let Some(now) = values[at] else { continue };
            let mut member = if quantity.is_flag() {
                json!({"value": now != 0.0, "unit": quantity.unit})
            } else {
                json!({"value": now, "unit": quantity.unit})
            };
            let base = values[0].filter(|_| at > 0 && !quantity.is_flag());
            if let Some(base) = base {
                member["difference"] = json!(now - base + 0.0);
                if let Some(percent) = percent(quantity, now, base) {
                    member["percent"] = json!(percent + 0.0);
                }
            }
            object.insert(quantity.key.to_owned(), member);
        }
        Value::Object(object)
    }
}

fn method(column: &Column) -> &'static str {
    column
        .solution()
        .map_or("", |solution| solution.method.name())
}

fn outcome(column: &Column) -> &'static str {
    column
        .solution()
        .map_or(REFUSED, |solution| solution.outcome.name())
}
