//! Cases and their variants side by side, with the differences from the first one.

mod data;
mod text;

use super::difference::difference;
use super::groups::{FREE_IMPACT, groups};
use super::{Report, Selection, common_unit, shown_with, value_as_in};
use crate::case::changes::{between, label, text_of};
use crate::case::fields::index_of;
use crate::case::units::System;
use crate::case::{Case, FIELDS, Problem};
use crate::model::inputs::Method;
use crate::model::{Quantity, Solution};

/// Text of an absent value.
const NONE: &str = "–";
/// A value of a refused column.
const REFUSED: &str = "refused";

/// A case, or one of its variants.
#[derive(Debug)]
pub struct Column {
    /// The file and the variant, such as `gear.toml:relieved`.
    pub name: String,
    /// The file as the user named it.
    pub file: String,
    /// The variant.
    pub variant: Option<String>,
    /// The case with the overrides of the variant.
    pub case: Case,
    /// The results, or the problems that prevent them.
    pub found: Result<Report, Vec<Refused>>,
}

/// A problem because of which a column has no results.
#[derive(Debug)]
pub struct Refused {
    /// The problem.
    pub problem: Problem,
    /// The problem at its place in the file or on the command line, as one line.
    pub line: String,
}

/// Columns to compare; the differences refer to the first one.
#[derive(Debug)]
pub struct Comparison {
    /// The columns.
    pub columns: Vec<Column>,
    /// The requested quantities; empty for all.
    pub selection: Selection,
}

struct Group {
    title: String,
    rows: Vec<Row>,
}

pub(super) struct Row {
    pub(super) symbol: String,
    pub(super) label: String,
    pub(super) unit: &'static str,
    /// The value of each column.
    pub(super) values: Vec<String>,
    /// The difference of each column from the first; empty for the first one.
    pub(super) differences: Vec<String>,
}

impl Comparison {
    /// Whether no column has results.
    #[must_use]
    pub fn is_all_refused(&self) -> bool {
        self.columns.iter().all(|column| column.found.is_err())
    }

    /// The refused columns as error lines.
    pub fn refusals(&self) -> impl Iterator<Item = String> {
        let refused = self.columns.iter().filter_map(|column| column.found.as_ref().err());
        refused.flatten().map(|refused| refused.line.clone())
    }

    /// The inputs that differ and the quantities, in one table.
    pub(super) fn brief(&self) -> Vec<Row> {
        let results = self.groups().into_iter().flat_map(|group| group.rows);
        self.inputs().rows.into_iter().chain(results).collect()
    }

    /// The method of the first results, which defines the quantities.
    fn method(&self) -> Option<Method> {
        let mut found = self.columns.iter().filter_map(Column::solution);
        found.next().map(|solution| solution.method)
    }

    fn values(&self, quantity: &Quantity) -> Vec<Option<f64>> {
        let method = self.method();
        let of = |column: &Column| value_as_in(quantity, column.solution()?, method?);
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        self.columns.iter().map(of).map(finite).collect()
    }

    /// The quantities in the order of the first method, in groups unless the user names some.
    fn groups(&self) -> Vec<Group> {
        let Some(method) = self.method() else {
            return Vec::new();
        };
        let group = |title: String, quantities: Vec<&'static Quantity>| {
            let rows = quantities.into_iter();
            let rows = rows.filter_map(|quantity| self.row(quantity, method)).collect();
            Group { title, rows }
        };
        if !self.selection.is_whole() {
            return vec![group("Results".to_owned(), self.selection.only.clone())];
        }
        let all = groups(method).into_iter().map(|known| {
            let title = if known.is_beside(method) {
                format!("{FREE_IMPACT}: {}", known.title)
            } else {
                known.title.to_owned()
            };
            group(title, known.quantities().collect())
        });
        all.filter(|group| !group.rows.is_empty()).collect()
    }

    fn row(&self, quantity: &'static Quantity, method: Method) -> Option<Row> {
        let values = self.values(quantity);
        let given = values.iter().copied().flatten();
        given.clone().next()?;
        let unit = common_unit(quantity, given.clone(), System::Metric);
        let shown = |(column, value): (&Column, &Option<f64>)| match (value, &column.found) {
            (Some(value), _) => shown_with(quantity, *value, unit).number,
            (None, Ok(_)) => NONE.to_owned(),
            (None, Err(_)) => REFUSED.to_owned(),
        };
        let base = values.first().copied().flatten();
        let against = |(at, value): (usize, &Option<f64>)| match (base, *value) {
            (Some(base), Some(value)) if at > 0 => difference(quantity, value, base, unit),
            _ => String::new(),
        };
        Some(Row {
            symbol: quantity.symbol_in(method).to_owned(),
            label: quantity.label_in(method).to_owned(),
            unit: given.last().map_or("", |value| shown_with(quantity, value, unit).unit),
            values: self.columns.iter().zip(&values).map(shown).collect(),
            differences: values.iter().enumerate().map(against).collect(),
        })
    }

    /// The inputs that differ between the columns, including limits and distributions.
    fn inputs(&self) -> Group {
        let fields = FIELDS.iter().map(|field| field.key.to_owned());
        let first = self.columns.first().into_iter();
        let changes = first.flat_map(|first| self.columns.iter().map(move |other| (first, other)));
        let others = changes
            .flat_map(|(first, other)| between(&first.case, &other.case))
            .map(|change| change.key)
            .filter(|key| key.starts_with("limits.") || key.starts_with("spread."));
        let mut keys: Vec<String> = Vec::new();
        for key in fields.chain(others) {
            if !keys.contains(&key) && !["title", "notes"].contains(&key.as_str()) {
                keys.push(key);
            }
        }
        Group {
            title: "Inputs that differ".to_owned(),
            rows: keys.iter().filter_map(|key| self.input(key)).collect(),
        }
    }

    fn input(&self, key: &str) -> Option<Row> {
        let field = index_of(key);
        let text = |column: &Column| {
            let text = match field {
                Some(field) => column.case.effective(field).map(str::to_owned),
                None => text_of(&column.case, key),
            };
            text.unwrap_or_else(|| NONE.to_owned())
        };
        let values: Vec<String> = self.columns.iter().map(text).collect();
        let differs = values.iter().any(|value| *value != values[0]);
        differs.then(|| Row {
            symbol: symbol(key),
            label: label(key),
            unit: "",
            differences: vec![String::new(); values.len()],
            values,
        })
    }
}

/// The symbol of an input: a field, a limit of a quantity, or the spread of a field.
fn symbol(key: &str) -> String {
    let of_field = |key: &str| index_of(key).map(|field| FIELDS[field].symbol);
    let of_limit = || Quantity::find(key.strip_prefix("limits.")?);
    let of_spread = || of_field(key.strip_prefix("spread.")?.trim_matches('"'));
    let limit = of_limit().map(|quantity| format!("{} limit", quantity.symbol));
    let spread = of_spread().map(|symbol| format!("{symbol} spread"));
    let field = of_field(key).map(str::to_owned);
    field.or(limit).or(spread).unwrap_or_default()
}

impl Column {
    fn solution(&self) -> Option<&Solution> {
        Some(&self.found.as_ref().ok()?.solution)
    }
}
