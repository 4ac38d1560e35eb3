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
use crate::report::json::{subject, write_line};
use crate::report::value;

impl Comparison {
    /// Writes one row per quantity: its name and unit, the value of each column, and the
    /// differences from the first one.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let names = self.columns.iter().map(|column| sanitize(&column.name));
        let differences = names.clone().skip(1).map(|name| format!("{name} - reference"));
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
        write_rows(rows.into_iter().chain(self.quantities().map(|known| self.csv_row(known))), out)
    }

    fn csv_row(&self, quantity: &Quantity) -> Vec<String> {
        let values: Vec<_> = (0..self.columns.len()).map(|at| self.own(quantity, at)).collect();
        let cells = values.iter().map(|value| cell(*value));
        let difference = |at: usize| {
            let base = self.base(quantity, at);
            cell(values[at].zip(base).map(|(now, base)| now - base))
        };
        [quantity.key, quantity.unit]
            .map(str::to_owned)
            .into_iter()
            .chain(cells)
            .chain((1..values.len()).map(difference))
            .collect()
    }

    /// The quantities with a value in some column.
    fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let quantities = self.selection.quantities();
        let columns = 0..self.columns.len();
        quantities
            .filter(move |quantity| columns.clone().any(|at| self.own(quantity, at).is_some()))
    }

    /// The value of a quantity as the method of the column defines it.
    fn own(&self, quantity: &Quantity, at: usize) -> Option<f64> {
        value(quantity, self.columns[at].solution()?)
    }

    /// The value of the first column, if a difference of the column from it has a meaning: flags
    /// have none, and values of different definitions have none.
    fn base(&self, quantity: &Quantity, at: usize) -> Option<f64> {
        let symbol = |at: usize| {
            let solution = self.columns[at].solution()?;
            Some(quantity.symbol_in(solution.method))
        };
        let is_alike = at > 0 && !quantity.is_flag() && symbol(at) == symbol(0);
        self.own(quantity, 0).filter(|_| is_alike)
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
        let changes = self.columns.first().map(|first| between(&first.case, &column.case));
        let is_input = |key: &str| !key.starts_with("variants.");
        let texts = changes.into_iter().flatten().filter(|change| is_input(&change.key));
        let texts = texts.map(|change| (change.key, json!(change.to.unwrap_or_default())));
        Value::Object(texts.collect())
    }

    fn json_quantities(&self, at: usize) -> Value {
        let mut object = Map::new();
        for quantity in self.quantities() {
            let Some((now, solution)) = self.own(quantity, at).zip(self.columns[at].solution())
            else {
                continue;
            };
            let mut member = if quantity.is_flag() {
                json!({"value": now != 0.0, "unit": quantity.unit})
            } else {
                json!({"value": now, "unit": quantity.unit})
            };
            if let Some(of) = subject(quantity, solution.method) {
                member["of"] = json!(of);
            }
            if let Some(base) = self.base(quantity, at) {
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
    column.solution().map_or("", |solution| solution.method.name())
}

fn outcome(column: &Column) -> &'static str {
    column.solution().map_or(REFUSED, |solution| solution.outcome.name())
}
