//! Cases and their variants side by side, with the differences from the first one, as text,
//! Markdown, CSV and JSON.

use std::io::{self, Write};

use super::{FREE_IMPACT, Report, Selection, common_unit, groups, shown_with, value_as_in};
use crate::case::changes::{between, label, text_of};
use crate::case::fields::index_of;
use crate::case::file::FORMAT;
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::units::system::counted;
use crate::case::{Case, FIELDS, Problem};
use crate::model::inputs::Method;
use crate::model::{Quantity, Solution};
use crate::report::data::{cell, subject, write_line, write_rows};
use crate::report::layout::{WIDTH, count, item, plain_markdown, widest};
use crate::report::{digest, value};
use serde_json::{Map, Value, json};

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

impl Comparison {
    /// Writes the comparison as text, at most 80 columns wide.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, column) in self.columns.iter().enumerate() {
            for line in heading(at, column) {
                writeln!(out, "{line}")?;
            }
        }
        let groups: Vec<Group> = std::iter::once(self.inputs())
            .chain(self.groups())
            .filter(|group| !group.rows.is_empty())
            .collect();
        let layout = Layout::of(&groups, self.columns.len());
        let others: Vec<usize> = (1..self.columns.len()).collect();
        for others in others.chunks(layout.others.max(1)) {
            let is_refused = |at: &&usize| self.columns[**at].found.is_err();
            let inputs_alone = others.iter().filter(is_refused).count() == others.len();
            let shown = groups.iter().take(if inputs_alone { 1 } else { groups.len() });
            for group in shown {
                writeln!(out, "\n{}", layout.title(group, others))?;
                for row in &group.rows {
                    writeln!(out, "{}", layout.line(row, others).trim_end())?;
                }
            }
        }
        Ok(())
    }

    /// Writes the comparison as Markdown.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_markdown(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, column) in self.columns.iter().enumerate() {
            let (name, sentence) = (plain(&named(column)), plain(&described(column)));
            writeln!(out, "- **{}** {name} {sentence}", letter(at))?;
        }
        let all = std::iter::once(self.inputs()).chain(self.groups());
        for group in all.filter(|group| !group.rows.is_empty()) {
            writeln!(out, "\n{}", self.table(&group).join("\n"))?;
        }
        Ok(())
    }

    fn table(&self, group: &Group) -> Vec<String> {
        let others = (1..self.columns.len()).map(letter);
        let others: Vec<String> =
            others.map(|letter| format!(" {letter} | {letter} - A |")).collect();
        let head = format!("| {} | | A |{}", group.title, others.concat());
        let rule = format!("|---|---|--:|{}", "--:|--:|".repeat(others.len()));
        let cells = |row: &Row| {
            let values = row.values.iter().zip(&row.differences).enumerate();
            let cell = |(at, (value, difference)): (usize, (&String, &String))| {
                let value = plain(&with_unit(value, row.unit));
                if at == 0 {
                    format!(" {value} |")
                } else {
                    format!(" {value} | {} |", plain(difference))
                }
            };
            values.map(cell).collect::<String>()
        };
        let line = |row: &Row| {
            let (label, symbol) = (plain(&row.label), plain(&row.symbol));
            format!("| {label} | {symbol} |{}", cells(row))
        };
        let rows = group.rows.iter().map(line);
        [head, rule].into_iter().chain(rows).collect()
    }
}

/// The column's letter, name, method and outcome.
fn heading(at: usize, column: &Column) -> Vec<String> {
    let mut lines = item(&format!("{}  ", letter(at)), &sanitize(&named(column)));
    lines.extend(item("   ", &sanitize(&described(column))));
    lines
}

/// The name of a column with its method.
fn named(column: &Column) -> String {
    let method = column.solution().map(|solution| solution.method.name());
    let method = method.map_or_else(String::new, |method| format!(" ({method})"));
    format!("{}{method}", column.name)
}

/// The outcome, or the reason for its absence.
fn described(column: &Column) -> String {
    match &column.found {
        Ok(report) => digest::sentence(&report.solution, System::Metric),
        Err(refused) => {
            let problems = refused.iter().map(|refused| refused.problem.to_string());
            format!("Refused: {}.", problems.collect::<Vec<_>>().join("; "))
        }
    }
}

fn with_unit(value: &str, unit: &str) -> String {
    if unit.is_empty() || [NONE, REFUSED].contains(&value) {
        value.to_owned()
    } else {
        format!("{value} {unit}")
    }
}

fn plain(text: &str) -> String {
    plain_markdown(&sanitize(text))
}

/// A to Z, then AA and so on.
fn letter(at: usize) -> String {
    let last = char::from(b'A' + (at % 26) as u8);
    match at / 26 {
        0 => last.to_string(),
        more => letter(more - 1) + &last.to_string(),
    }
}

/// Widths of the columns, and the number of columns beside the reference.
struct Layout {
    symbol: usize,
    /// 0 if labels do not fit.
    label: usize,
    value: usize,
    difference: usize,
    unit: usize,
    others: usize,
}

impl Layout {
    fn of(groups: &[Group], columns: usize) -> Layout {
        let rows = || groups.iter().flat_map(|group| &group.rows);
        let most = |of: &dyn Fn(&Row) -> usize| rows().map(of).max().unwrap_or(0);
        let wide = Layout {
            symbol: 1 + most(&|row| count(&row.symbol)),
            label: 1 + most(&|row| count(&row.label)),
            value: 2 + most(&|row| widest(row.values.iter().map(String::as_str))).max(6),
            difference: 2 + most(&|row| widest(row.differences.iter().map(String::as_str))).max(5),
            unit: 1 + most(&|row| count(row.unit)),
            others: columns.saturating_sub(1),
        };
        let fitting = |label: usize| {
            let before = 2 + wide.symbol + label + wide.value + wide.unit;
            WIDTH.saturating_sub(before) / (wide.value + wide.difference)
        };
        if fitting(wide.label) >= wide.others {
            return wide;
        }
        let (with_labels, without) = (fitting(wide.label), fitting(0).max(1));
        // Labels are shown if there is room, or if they reduce the number of tables.
        let tables = |others: usize| wide.others.div_ceil(others.max(1));
        if with_labels == 0 || tables(without) < tables(with_labels) {
            return Layout {
                symbol: 1 + most(&|row| count(short_name(row))),
                label: 0,
                others: without,
                ..wide
            };
        }
        Layout { others: with_labels, ..wide }
    }

    fn title(&self, group: &Group, others: &[usize]) -> String {
        let names = 2 + self.symbol + self.label + self.unit;
        let of = |&at: &usize| {
            let letter = letter(at);
            let against = format!("{letter} - A");
            format!("{letter:>0$}{against:>1$}", self.value, self.difference)
        };
        let others: String = others.iter().map(of).collect();
        let cells = format!("{:>1$}{others}", "A", self.value);
        // A long title is not cut; the letters move to the right.
        let title = &group.title;
        if count(title) < names + self.value - 1 {
            let room = names.saturating_sub(count(title));
            let blank = " ".repeat(room);
            let cut = count(title).saturating_sub(names);
            format!("{title}{blank}{}", &cells[cut..])
        } else {
            let blank = " ".repeat(names);
            format!("{title}\n{blank}{cells}")
        }
    }

    fn line(&self, row: &Row, others: &[usize]) -> String {
        let (symbol, label) = if self.label > 0 {
            (row.symbol.as_str(), row.label.as_str())
        } else {
            (short_name(row), "")
        };
        let (unit, base) = (row.unit, sanitize(&row.values[0]));
        let (first, second, third, fourth) = (self.symbol, self.label, self.unit, self.value);
        let head = format!("  {symbol:first$}{label:second$}{unit:third$}{base:>fourth$}");
        let cells = others.iter().map(|&at| {
            let (value, difference) = (sanitize(&row.values[at]), &row.differences[at]);
            format!("{value:>0$}{difference:>1$}", self.value, self.difference)
        });
        head + &cells.collect::<String>()
    }
}

/// The symbol of a row, or its label if it has none.
fn short_name(row: &Row) -> &str {
    if row.symbol.is_empty() { &row.label } else { &row.symbol }
}

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

/// A difference below this fraction of the reference is rounding.
const NO_DIFFERENCE: f64 = 5e-6;
/// A value above this multiple of its reference has no difference in percent.
const MOST_TIMES: f64 = 10.0;
/// Text of a value equal to its reference.
pub const UNCHANGED: &str = "unchanged";

/// Whether two values differ only by rounding.
#[must_use]
pub fn is_unchanged(now: f64, base: f64) -> bool {
    now.to_bits() == base.to_bits() || ((now - base) / base).abs() < NO_DIFFERENCE
}

/// The difference in percent of the reference. `None` if the quantity can be negative, or if the
/// reference is close to 0 compared with the value.
#[must_use]
pub fn percent(quantity: &Quantity, now: f64, base: f64) -> Option<f64> {
    let part = (now - base) / base;
    let has_meaning = !quantity.is_signed && !quantity.is_flag() && base > 0.0 && now >= 0.0;
    (has_meaning && part.is_finite() && now <= MOST_TIMES * base).then_some(100.0 * part)
}

/// A percentage with its sign, at most nine characters wide.
#[must_use]
pub fn in_percent(percent: f64) -> String {
    match percent.abs() {
        size if size >= 100.0 => format!("{percent:+.0} %"),
        size if size >= 1.0 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.3} %"),
    }
}

/// The difference of two values: in percent, otherwise with its sign in the unit of the values.
#[must_use]
pub fn difference(quantity: &Quantity, now: f64, base: f64, unit: &'static str) -> String {
    if is_unchanged(now, base) {
        return UNCHANGED.to_owned();
    }
    if quantity.is_flag() {
        return "changed".to_owned();
    }
    if let Some(percent) = percent(quantity, now, base) {
        return in_percent(percent);
    }
    let number = counted((now - base).abs(), unit, 3);
    let sign = if now < base { '-' } else { '+' };
    let named = crate::case::units::system::named(unit);
    format!("{sign}{number} {named}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_go_on_behind_z() {
        let letters = [0, 25, 26, 27, 52].map(letter);
        assert_eq!(letters, ["A", "Z", "AA", "AB", "BA"]);
    }

    fn worded(key: &str, now: f64, base: f64) -> String {
        let quantity = Quantity::find(key).expect("a quantity");
        difference(quantity, now, base, quantity.shown)
    }

    #[test]
    fn a_difference_is_in_percent_and_fits_its_column() {
        for (now, base, expected) in [
            (110.0, 100.0, "+10.0 %"),
            (99.99, 100.0, "-0.010 %"),
            (0.0, 100.0, "-100 %"),
            (1.0, 1.0, UNCHANGED),
            (0.0, 0.0, UNCHANGED),
        ] {
            assert_eq!(worded("impact_force", now, base), expected, "{now} {base}");
            assert!(expected.len() <= UNCHANGED.len());
        }
    }

    #[test]
    fn a_value_that_may_be_negative_or_starts_near_zero_has_no_percentage() {
        assert_eq!(worded("total_deviation", -2e-6, 1e-6), "-3.00 um");
        assert_eq!(worded("total_deviation", 16e-6, 15e-6), "+1.00 um");
        assert_eq!(worded("impact_force", 500.0, 0.0), "+500 N");
        assert_eq!(worded("impact_force", 500.0, 4.0), "+496 N");
        assert_eq!(worded("dynamic_contact_lost", 1.0, 0.0), "changed");
    }
}
