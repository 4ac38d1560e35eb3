//! Cases and their variants side by side, with the differences from the first one, as text,
//! Markdown, CSV and JSON.

use std::io::{self, Write};

use super::json::{Json, json, measured, object, reason, write_line};
use super::layout::{WIDTH, item, plain_markdown};
use super::table::{Cell, Column, Table, text, widths};
use super::{Report, Selection, common_unit, digest, groups, shown_with, value, value_as_in};
use crate::case::changes::{between, label, text_of};
use crate::case::fields::index_of;
use crate::case::file::FORMAT;
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::units::system::{counted, named};
use crate::case::{Case, FIELDS, Problem};
use crate::model::inputs::Method;
use crate::model::{Quantity, Solution};
use crate::report::data::subject;

/// Text of an absent value.
const NONE: &str = "–";
/// A value of a refused case.
const REFUSED: &str = "refused";

/// A case, or one of its variants.
#[derive(Debug)]
pub struct ComparedCase {
    /// The file and the variant, such as `gear.toml:relieved`.
    pub name: String,
    /// The file as the user named it.
    pub file: String,
    /// The variant.
    pub variant: Option<String>,
    /// The case with the overrides of the variant.
    pub case: Case,
    /// The results, or the problems that prevent them.
    pub found: Result<Report, Vec<Problem>>,
}

/// Cases to compare; the differences refer to the first one.
#[derive(Debug)]
pub struct Comparison {
    /// The cases.
    pub cases: Vec<ComparedCase>,
    /// The requested quantities; empty for all.
    pub selection: Selection,
}

/// An input or a quantity of every case.
pub(super) struct Row {
    pub(super) symbol: String,
    pub(super) label: String,
    pub(super) unit: &'static str,
    pub(super) values: Vec<String>,
    /// The difference of each case from the first; empty for the first one.
    pub(super) differences: Vec<String>,
}

impl Row {
    /// The value of each case, and its difference behind it.
    fn into_cells(self, with_unit: bool) -> impl Iterator<Item = Cell> {
        let unit = if with_unit { self.unit } else { "" };
        let pairs = self.values.into_iter().zip(self.differences).enumerate();
        pairs.flat_map(move |(at, (value, difference))| {
            let is_bare = unit.is_empty() || [NONE, REFUSED].contains(&value.as_str());
            let value = if is_bare { value } else { format!("{value} {unit}") };
            [value].into_iter().chain((at > 0).then_some(difference)).map(Cell::from)
        })
    }
}

/// Rows with a title.
type Group = (String, Vec<Row>);

impl ComparedCase {
    fn solution(&self) -> Option<&Solution> {
        Some(&self.found.as_ref().ok()?.solution)
    }

    fn method(&self) -> Option<&'static str> {
        Some(self.solution()?.method.name())
    }

    fn outcome(&self) -> &'static str {
        self.solution().map_or(REFUSED, |solution| solution.outcome.name())
    }

    /// The value of a quantity as the method of the case defines it.
    fn value(&self, quantity: &Quantity) -> Option<f64> {
        value(quantity, self.solution()?)
    }

    /// The name with its method.
    fn named(&self) -> String {
        let method = self.method().map(|method| format!(" ({method})"));
        sanitize(&(self.name.clone() + &method.unwrap_or_default()))
    }

    /// The outcome, or the reason for its absence.
    fn described(&self) -> String {
        sanitize(&match &self.found {
            Ok(report) => digest::sentence(&report.solution, System::Metric),
            Err(problems) => {
                let problems: Vec<String> = problems.iter().map(ToString::to_string).collect();
                format!("Refused: {}.", problems.join("; "))
            }
        })
    }
}

impl Comparison {
    /// The inputs that differ, and the quantities in the order of the first method, in groups unless
    /// the user names some.
    pub(super) fn groups(&self) -> Vec<Group> {
        let mut found = vec![("Inputs that differ".to_owned(), self.inputs())];
        if let Some(method) = self.cases.iter().find_map(|case| Some(case.solution()?.method)) {
            let rows = |quantities: &mut dyn Iterator<Item = &'static Quantity>| {
                quantities.filter_map(|quantity| self.row(quantity, method)).collect()
            };
            if self.selection.is_whole() {
                let all = groups(method).into_iter();
                found.extend(
                    all.map(|group| (group.heading(method), rows(&mut group.quantities()))),
                );
            } else {
                found.push(("Results".to_owned(), rows(&mut self.selection.quantities())));
            }
        }
        found.retain(|(_, rows)| !rows.is_empty());
        found
    }

    fn row(&self, quantity: &'static Quantity, method: Method) -> Option<Row> {
        let of = |case: &ComparedCase| value_as_in(quantity, case.solution()?, method);
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        let values: Vec<Option<f64>> = self.cases.iter().map(of).map(finite).collect();
        let last = *values.iter().flatten().last()?;
        let unit = common_unit(quantity, values.iter().copied().flatten(), System::Metric);
        let shown = |(case, value): (&ComparedCase, &Option<f64>)| match (value, &case.found) {
            (Some(value), _) => shown_with(quantity, *value, unit).number,
            (None, Ok(_)) => NONE.to_owned(),
            (None, Err(_)) => REFUSED.to_owned(),
        };
        let against = |(at, value): (usize, &Option<f64>)| match (values[0], *value) {
            (Some(base), Some(value)) if at > 0 => difference(quantity, value, base, unit),
            _ => String::new(),
        };
        Some(Row {
            symbol: quantity.symbol_in(method).to_owned(),
            label: quantity.label_in(method).to_owned(),
            unit: shown_with(quantity, last, unit).unit,
            values: self.cases.iter().zip(&values).map(shown).collect(),
            differences: values.iter().enumerate().map(against).collect(),
        })
    }

    /// The inputs that differ between the cases, including limits and distributions.
    fn inputs(&self) -> Vec<Row> {
        let Some(first) = self.cases.first() else { return Vec::new() };
        let mut keys: Vec<String> = FIELDS.iter().map(|field| field.key.to_owned()).collect();
        for change in self.cases.iter().flat_map(|other| between(&first.case, &other.case)) {
            let is_other = ["limits.", "spread."].iter().any(|start| change.key.starts_with(start));
            if is_other && !keys.contains(&change.key) {
                keys.push(change.key);
            }
        }
        keys.retain(|key| !["title", "notes"].contains(&key.as_str()));
        keys.iter().filter_map(|key| self.input(key)).collect()
    }

    fn input(&self, key: &str) -> Option<Row> {
        let text = |case: &ComparedCase| {
            let text = match index_of(key) {
                Some(field) => case.case.effective(field).map(str::to_owned),
                None => text_of(&case.case, key),
            };
            text.map_or_else(|| NONE.to_owned(), |text| sanitize(&text))
        };
        let values: Vec<String> = self.cases.iter().map(text).collect();
        values.iter().any(|value| *value != values[0]).then(|| Row {
            symbol: symbol(key),
            label: label(key),
            unit: "",
            differences: vec![String::new(); values.len()],
            values,
        })
    }

    /// The headers of the cases, and of their differences.
    fn letters(&self) -> impl Iterator<Item = String> {
        let others = (1..self.cases.len()).map(letter);
        let others = others.flat_map(|letter| [letter.clone(), letter + " - A"]);
        std::iter::once(letter(0)).chain(others)
    }

    /// Writes the comparison as text, at most 80 columns wide unless one difference needs more.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, case) in self.cases.iter().enumerate() {
            let name = item(&format!("{}  ", letter(at)), &case.named());
            for line in name.into_iter().chain(item("   ", &case.described())) {
                writeln!(out, "{line}")?;
            }
        }
        let (tables, in_a_line) = self.text_tables();
        let start =
            tables.first().map_or(0, |table| table.columns.len() + 1 - 2 * self.cases.len());
        let others: Vec<usize> = (1..self.cases.len()).collect();
        for others in others.chunks(in_a_line) {
            let is_refused = others.iter().all(|&at| self.cases[at].found.is_err());
            let shown = if is_refused { &tables[..tables.len().min(1)] } else { &tables[..] };
            let columns = others.iter().flat_map(|at| [start + 2 * at - 1, start + 2 * at]);
            let columns: Vec<usize> = (0..=start).chain(columns).collect();
            let shown: Vec<Table> = shown.iter().map(|table| table.of(&columns)).collect();
            for lines in text(&shown) {
                writeln!(out, "\n{}", lines.join("\n"))?;
            }
        }
        Ok(())
    }

    /// A table for each group, and the number of further cases that fit a line. The tables have
    /// labels if that fits, or if it takes no more lines.
    fn text_tables(&self) -> (Vec<Table>, usize) {
        const NAMES: usize = 3;
        let names = ["symbol", "label", "unit"].map(|key| Column::text(key, ""));
        let letters = self.letters().map(|letter| {
            let least = if letter.contains('-') { 5 } else { 6 };
            Column::text("", letter).to_the_right().wide(2, least)
        });
        let mut columns: Vec<Column> = names.into_iter().chain(letters).collect();
        (columns[0].gap, columns[NAMES].gap) = (2, 3);
        let row = |row: Row| {
            let names = [row.symbol.as_str(), &row.label, row.unit].map(Cell::from);
            names.into_iter().chain(row.into_cells(false)).collect()
        };
        let table = |(title, rows): Group| {
            Table::new(title, columns.clone()).with(rows.into_iter().map(row))
        };
        let mut tables: Vec<Table> = self.groups().into_iter().map(table).collect();
        let mut widths = widths(&tables);
        if widths.is_empty() {
            return (tables, 1);
        }
        // Every value is as wide as the widest, and every difference.
        let is_difference = |at: usize| at > NAMES && at % 2 == 1;
        let widest = |of_differences: bool| {
            let columns = (NAMES..widths.len()).filter(|&at| is_difference(at) == of_differences);
            columns.map(|at| widths[at]).max().unwrap_or(0)
        };
        let (value, difference) = (widest(false), widest(true));
        for (at, width) in widths.iter_mut().enumerate().skip(NAMES) {
            *width = if is_difference(at) { difference } else { value };
        }
        let others = self.cases.len() - 1;
        let fitting = |label: usize| {
            let before = widths[0] + label + widths[2] + value + 6;
            WIDTH.saturating_sub(before) / (value + difference + 4)
        };
        let (with_labels, without) = (fitting(widths[1] + 1), fitting(0).max(1));
        let is_as_short =
            with_labels > 0 && others.div_ceil(with_labels) <= others.div_ceil(without);
        let has_labels = with_labels >= others || is_as_short;
        for table in &mut tables {
            for (column, &width) in table.columns.iter_mut().zip(&widths) {
                column.least = width;
            }
            if has_labels {
                continue;
            }
            for row in &mut table.rows {
                let label = row.remove(1);
                if row[0] == Cell::from("") {
                    row[0] = label;
                }
            }
            table.columns.remove(1);
            table.columns[0].least = 0;
        }
        if !has_labels {
            let least = super::table::widths(&tables)[0];
            for table in &mut tables {
                table.columns[0].least = least;
            }
        }
        (tables, if has_labels { with_labels.max(1) } else { without })
    }

    /// Writes the comparison as Markdown.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_markdown(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, case) in self.cases.iter().enumerate() {
            let [name, sentence] =
                [case.named(), case.described()].map(|text| plain_markdown(&text));
            writeln!(out, "- **{}** {name} {sentence}", letter(at))?;
        }
        for (title, rows) in self.groups() {
            let letters = self.letters().map(|letter| Column::text("", letter).to_the_right());
            let names = [Column::text("", title), Column::text("", "")];
            let row = |row: Row| {
                let names = [row.label.as_str(), &row.symbol].map(Cell::from);
                names.into_iter().chain(row.into_cells(true)).collect()
            };
            let columns = names.into_iter().chain(letters).collect();
            let table = Table::new("", columns).with(rows.into_iter().map(row));
            writeln!(out, "\n{}", table.markdown())?;
        }
        Ok(())
    }

    /// Writes one row per quantity: its name and unit, the value of each case, and the differences
    /// from the first one.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let names = self.cases.iter().map(|case| sanitize(&case.name));
        let differences = names.clone().skip(1).map(|name| format!("{name} - reference"));
        let head = ["quantity", "unit"].map(str::to_owned).into_iter();
        let columns = head.chain(names).chain(differences).map(|key| Column::text(key, ""));
        let words = |name: &str, of: fn(&ComparedCase) -> &'static str| {
            let cells = self.cases.iter().map(of);
            let blank = self.cases.iter().skip(1).map(|_| "");
            [name, ""].into_iter().chain(cells).chain(blank).map(Cell::from).collect()
        };
        let rows = [
            words("method", |case| case.method().unwrap_or_default()),
            words("outcome", ComparedCase::outcome),
        ];
        let values = self.quantities().map(|quantity| {
            let values = self.cases.iter().map(|case| case.value(quantity));
            let differences = (1..self.cases.len())
                .map(|at| Some(self.cases[at].value(quantity)? - self.base(quantity, at)?));
            let names = [quantity.key, quantity.unit].map(Cell::from).into_iter();
            names.chain(values.chain(differences).map(|value| Cell::number(value, ""))).collect()
        });
        Table::new("", columns.collect()).with(rows.into_iter().chain(values)).write_csv(out)
    }

    /// The quantities with a value in some case.
    fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let has_value = |quantity: &&'static Quantity| {
            self.cases.iter().any(|case| case.value(quantity).is_some())
        };
        self.selection.quantities().filter(has_value)
    }

    /// The value of the first case, if a difference from it has a meaning: flags have none, and
    /// values of different definitions have none.
    fn base(&self, quantity: &Quantity, at: usize) -> Option<f64> {
        let symbol = |at: usize| Some(quantity.symbol_in(self.cases[at].solution()?.method));
        let is_alike = at > 0 && !quantity.is_flag() && symbol(at) == symbol(0);
        self.cases[0].value(quantity).filter(|_| is_alike)
    }

    /// Writes one object in SI units without absent values, its members in the order of their names.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut all = json!({
            "format": FORMAT,
            "version": env!("CARGO_PKG_VERSION"),
            "columns": (0..self.cases.len()).map(|at| self.json_case(at)).collect::<Vec<_>>(),
        });
        all.sort_all_objects();
        write_line(&all, out)
    }

    fn json_case(&self, at: usize) -> Json {
        let ComparedCase { name, file, variant, case, found } = &self.cases[at];
        // The inputs that differ from those of the first case, as written.
        let inputs = between(&self.cases[0].case, case).into_iter();
        let inputs = inputs.filter(|change| !change.key.starts_with("variants."));
        let inputs = inputs.map(|change| (change.key, change.to.unwrap_or_default().into()));
        let quantities = found.as_ref().ok().map(|report| {
            let method = report.solution.method;
            let members = self.quantities().filter_map(|quantity| {
                let now = self.cases[at].value(quantity)?;
                let mut member = measured(quantity, now, subject(quantity, method));
                if let Some(base) = self.base(quantity, at) {
                    member["difference"] = json!(now - base + 0.0);
                    member["percent"] =
                        json!(percent(quantity, now, base).map(|percent| percent + 0.0));
                }
                Some((quantity.key, member))
            });
            object(members)
        });
        let refused = found.as_ref().err().and_then(|problems| problems.first());
        json!({
            "name": name,
            "case": file,
            "variant": variant,
            "method": self.cases[at].method(),
            "outcome": self.cases[at].outcome(),
            "inputs": object(inputs),
            "quantities": quantities,
            "refusal": refused.map(reason),
        })
    }
}

/// The symbol of an input: a field, a limit of a quantity, or the spread of a field.
fn symbol(key: &str) -> String {
    let of_field = |key: &str| index_of(key).map(|field| FIELDS[field].symbol);
    if let Some(quantity) = key.strip_prefix("limits.").and_then(Quantity::find) {
        format!("{} limit", quantity.symbol)
    } else if let Some(field) = key.strip_prefix("spread.") {
        let symbol = of_field(field.trim_matches('"'));
        symbol.map(|symbol| format!("{symbol} spread")).unwrap_or_default()
    } else {
        of_field(key).unwrap_or_default().to_owned()
    }
}

/// A to Z, then AA and so on.
fn letter(at: usize) -> String {
    let last = char::from(b'A' + (at % 26) as u8);
    match at / 26 {
        0 => last.to_string(),
        more => letter(more - 1) + &last.to_string(),
    }
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
    format!("{sign}{number} {}", named(unit)).trim_end().to_owned()
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
