//! Cases and their variants side by side, with the differences from the first one, as text,
//! Markdown, CSV and JSON.

use std::io::{self, Write};

use super::table::{Cell, Column, Table, text, widths};
use super::table::{Json, json, measured, object, reason, write_line};
use super::table::{WIDTH, flow, item, plain_markdown};
use super::{Report, Selection, digest, grouped, shown_with, unit_of_gears, value, value_as_in};
use crate::case::changes::{between, label, text_of};
use crate::case::fields::index_of;
use crate::case::file::FORMAT;
use crate::case::sanitize::sanitize;
use crate::case::units::{
    Dimension, System, counted, named, per, symbol as symbol_of, written_unit,
};
use crate::case::{Case, FIELDS, Problem};
use crate::model::explanation::tidy;
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
    /// The method that `auto` chooses for the case alone, if the comparison uses another one.
    pub alone: Option<Method>,
}

/// Cases to compare; the differences refer to the first one.
#[derive(Debug)]
pub struct Comparison {
    /// The cases.
    pub cases: Vec<ComparedCase>,
    /// The requested quantities; empty for all.
    pub selection: Selection,
}

impl ComparedCase {
    pub(super) fn solution(&self) -> Option<&Solution> {
        Some(&self.found.as_ref().ok()?.solution)
    }

    fn method(&self) -> Option<&'static str> {
        Some(self.solution()?.method.name())
    }

    pub(super) fn outcome(&self) -> &'static str {
        self.solution().map_or(REFUSED, |solution| solution.outcome.name())
    }

    /// The value of a quantity as the method of the case defines it.
    fn value(&self, quantity: &Quantity) -> Option<f64> {
        value(quantity, self.solution()?)
    }

    /// The name with its method, and why `solve` uses another one.
    fn named(&self) -> String {
        let method = self.method().map(|method| match self.alone {
            Some(alone) => {
                let alone = alone.name();
                format!(" ({method} for equal columns; alone auto takes {alone}, as in solve)")
            }
            None => format!(" ({method})"),
        });
        sanitize(&(self.name.clone() + &method.unwrap_or_default()))
    }

    /// The verdict, or the reason for its absence.
    pub(super) fn described(&self, units: System) -> String {
        sanitize(&match &self.found {
            Ok(report) => digest::sentence(&report.solution, units, false),
            Err(problems) => {
                let problems: Vec<String> = problems.iter().map(ToString::to_string).collect();
                format!("Refused: {}.", problems.join("; "))
            }
        })
    }
}

/// Columns before those of the cases: name and SI unit for scripts; symbol, label and unit for
/// readers. The differences from the first case follow the values.
const NAMES: usize = 5;
/// The column of labels.
const LABEL: usize = 3;
/// Least width of this column in text beside several cases, and beside one with long values.
const SHORT: usize = 18;
const SHORTEST: usize = 12;
/// Greatest width of values and differences in text; those with several words are wrapped.
const LONGEST: usize = 12;

impl Comparison {
    fn columns(&self) -> Vec<Column> {
        let names = ["quantity", "unit", "", "", ""].map(|key| Column::text(key, ""));
        let values = self.cases.iter().zip(0..).map(|(case, at)| {
            Column::text(sanitize(&case.name), letter(at)).to_the_right().wide(2, 6)
        });
        let differences = self.cases.iter().zip(0..).skip(1).map(|(case, at)| {
            let key = format!("{} - reference", sanitize(&case.name));
            Column::text(key, letter(at) + " - A").to_the_right().wide(2, 5)
        });
        let mut columns: Vec<Column> = names.into_iter().chain(values).chain(differences).collect();
        columns[2].gap = 2;
        columns
    }

    /// The inputs that differ, and the results in the order of the first method, in groups unless
    /// the user names some.
    pub(super) fn tables(&self, units: System) -> Vec<Table> {
        let columns = self.columns();
        let table = |title: &str| Table::new(title, columns.clone());
        let mut found = vec![table("Inputs that differ").with(self.inputs(units))];
        if let Some(method) = self.cases.iter().find_map(|case| Some(case.solution()?.method)) {
            let row = |quantity| self.row(quantity, method, units);
            if self.selection.is_whole() {
                found.extend(grouped(method, &columns, row));
            } else {
                found.push(table("Results").with(self.selection.quantities().filter_map(row)));
            }
        }
        found.retain(|table| !table.rows.is_empty());
        found
    }

    /// A quantity by the definition of a method; CSV has the values by the methods of the cases.
    fn row(&self, quantity: &'static Quantity, method: Method, units: System) -> Option<Vec<Cell>> {
        if !self.is_listed(quantity) {
            return None;
        }
        let known = |of| {
            let value = move |case: &ComparedCase| value_as_in(of, case.solution()?, method);
            let finite = |value: &f64| value.is_finite();
            self.cases.iter().map(move |case| value(case).filter(finite))
        };
        let unit = unit_of_gears(quantity, |of| known(of).flatten(), units);
        let known: Vec<Option<f64>> = known(quantity).collect();
        let last = *known.iter().flatten().last()?;
        let shown = |value| shown_with(quantity, value, unit);
        let [symbol, label] = [quantity.symbol_in(method), quantity.label_in(method)];
        let names = [quantity.key, quantity.unit, symbol, label, shown(last).unit].map(Cell::from);
        let values = self.cases.iter().zip(&known).map(|(case, now)| {
            let absent = if case.found.is_ok() { NONE } else { REFUSED };
            match (*now, case.value(quantity)) {
                (Some(now), Some(own)) => Cell::Shown(own, shown(now).number),
                _ => Cell::None(absent.into()),
            }
        });
        let differences = (1..self.cases.len()).map(|at| {
            let text = known[0].zip(known[at]);
            let text = text.map(|(base, now)| difference(quantity, now, base, unit));
            let text = text.unwrap_or_default();
            let own = self.cases[at].value(quantity).zip(self.base(quantity, at));
            match own {
                Some((now, base)) => Cell::Shown(now - base, text),
                None => Cell::None(text.into()),
            }
        });
        Some(names.into_iter().chain(values).chain(differences).collect())
    }

    /// The inputs that differ between the cases, including limits and distributions.
    fn inputs(&self, units: System) -> Vec<Vec<Cell>> {
        let Some(first) = self.cases.first() else { return Vec::new() };
        let mut keys: Vec<String> = FIELDS.iter().map(|field| field.key.to_owned()).collect();
        for change in self.cases.iter().flat_map(|other| between(&first.case, &other.case)) {
            let is_other = ["limits.", "spread."].iter().any(|start| change.key.starts_with(start));
            if is_other && !keys.contains(&change.key) {
                keys.push(change.key);
            }
        }
        keys.retain(|key| !["title", "notes"].contains(&key.as_str()));
        keys.iter().filter_map(|key| self.input(key, units)).collect()
    }

    /// A given value keeps its unit.
    fn input(&self, key: &str, units: System) -> Option<Vec<Cell>> {
        let default = |field: usize, case: &Case| {
            let of = &FIELDS[field];
            Some(of.text_in(case.effective(field)?, units.unit(of.usual_unit())))
        };
        let text = |ComparedCase { case, .. }: &ComparedCase| {
            let text = match index_of(key) {
                Some(field) => case.text(field).map(str::to_owned).or(default(field, case)),
                None => text_of(case, key),
            };
            text.map_or_else(|| NONE.to_owned(), |text| sanitize(&text))
        };
        let texts: Vec<String> = self.cases.iter().map(text).collect();
        if texts.iter().all(|text| *text == texts[0]) {
            return None;
        }
        let field = index_of(key);
        let known: Vec<Option<f64>> =
            self.cases.iter().map(|case| case.case.value(field?)).collect();
        let usual = field.map_or("", |field| FIELDS[field].usual_unit());
        let dimension = Dimension::of_unit(usual);
        let unit = dimension.and_then(|own| symbol_of(written_unit(&texts[0], own)?));
        let unit = unit.unwrap_or(usual);
        let names =
            [key, dimension.map_or("", Dimension::si_unit), subject_of(key).0, &label(key), ""];
        let difference = |&now: &Option<f64>| match known[0].zip(now) {
            Some((base, now)) if !is_unchanged(now, base) => {
                let number = tidy(per(now - base, unit), 4);
                let sign = if now > base { "+" } else { "" };
                Cell::Shown(now - base, format!("{sign}{number} {}", named(unit)).trim_end().into())
            }
            Some(_) => Cell::Shown(0.0, String::new()),
            None => Cell::Text(String::new()),
        };
        let differences = known[1..].iter().map(difference);
        let values = known.iter().zip(texts.iter()).map(|(known, text)| match *known {
            Some(known) => Cell::Shown(known, text.clone()),
            None => Cell::Text(text.clone()),
        });
        Some(names.map(Cell::from).into_iter().chain(values).chain(differences).collect())
    }

    /// The columns of a further case: its value and its difference.
    fn pair(&self, at: usize) -> [usize; 2] {
        [NAMES + at, NAMES + self.cases.len() + at - 1]
    }

    /// The value of a case in a row of a table, with its difference in brackets.
    pub(super) fn value(&self, row: &[Cell], at: usize) -> String {
        let value = row[NAMES + at].text();
        match (at > 0).then(|| row[self.pair(at)[1]].text()) {
            Some(difference) if !difference.is_empty() => format!("{value} ({difference})"),
            _ => value.to_owned(),
        }
    }

    /// Writes the comparison as text, at most 80 columns wide unless one case needs more.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, case) in self.cases.iter().enumerate() {
            let name = item(&format!("{}  ", letter(at)), &case.named());
            for line in name.into_iter().chain(item("   ", &case.described(System::Metric))) {
                writeln!(out, "{line}")?;
            }
        }
        let tables = self.tables(System::Metric);
        if tables.is_empty() {
            return Ok(());
        }
        let others: Vec<usize> = (1..self.cases.len()).collect();
        let wrap = |label| tables.iter().map(|table| wrapped(table, label)).collect::<Vec<_>>();
        let widths = widths(&wrap(usize::MAX));
        let room = |columns: &[usize]| -> usize {
            columns.iter().map(|&at| widths[at] + tables[0].columns[at].gap).sum()
        };
        // As many cases as leave room for short labels; long labels are wrapped.
        let free = WIDTH.saturating_sub(room(&[2, 4, NAMES]) + tables[0].columns[LABEL].gap);
        let widest = others.iter().map(|&at| room(&self.pair(at))).max().unwrap_or(1);
        let in_a_line = (free.saturating_sub(SHORT) / widest).clamp(1, others.len().max(1));
        let width = free.saturating_sub(in_a_line * widest).max(SHORTEST);
        let tables = wrap(width);
        for others in others.chunks(in_a_line) {
            let further = others.iter().flat_map(|&at| self.pair(at));
            let columns: Vec<usize> = [2, LABEL, 4, NAMES].into_iter().chain(further).collect();
            let shown: Vec<Table> = tables.iter().map(|table| table.of(&columns)).collect();
            for lines in text(&shown) {
                writeln!(out, "\n{}", lines.join("\n"))?;
            }
        }
        Ok(())
    }

    /// Writes the comparison as Markdown.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_markdown(&self, out: &mut dyn Write) -> io::Result<()> {
        for (at, case) in self.cases.iter().enumerate() {
            let [name, sentence] =
                [case.named(), case.described(System::Metric)].map(|text| plain_markdown(&text));
            writeln!(out, "- **{}** {name} {sentence}", letter(at))?;
        }
        let others = (1..self.cases.len()).flat_map(|at| self.pair(at));
        let columns: Vec<usize> = [3, 2, NAMES].into_iter().chain(others).chain([4]).collect();
        for table in self.tables(System::Metric) {
            let mut shown = table.of(&columns);
            shown.columns[0].title = table.title.into();
            writeln!(out, "\n{}", shown.markdown())?;
        }
        Ok(())
    }

    /// Writes one row per input that differs and per quantity: its name and unit, the value of each
    /// case, and the differences from the first one.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let words = |name: &str, of: fn(&ComparedCase) -> &'static str| {
            let cells = self.cases.iter().map(of);
            let blank = self.cases.iter().skip(1).map(|_| "");
            [name, "", "", "", ""].into_iter().chain(cells).chain(blank).map(Cell::from).collect()
        };
        let mut rows: Vec<Vec<Cell>> = vec![
            words("method", |case| case.method().unwrap_or_default()),
            words("outcome", ComparedCase::outcome),
        ];
        rows.extend(self.inputs(System::Metric));
        let tables = self.tables(System::Metric);
        let results = tables.iter().flat_map(|table| &table.rows);
        rows.extend(self.quantities().filter_map(|quantity| {
            results.clone().find(|row| row[0] == Cell::from(quantity.key)).cloned()
        }));
        let columns = [0, 1].into_iter().chain(NAMES..NAMES + 2 * self.cases.len() - 1);
        let columns: Vec<usize> = columns.collect();
        Table::new("", self.columns()).with(rows).of(&columns).write_csv(out)
    }

    /// Whether a quantity is named, or in the list of every quantity of a case.
    fn is_listed(&self, quantity: &Quantity) -> bool {
        let mut solutions = self.cases.iter().filter_map(ComparedCase::solution);
        !self.selection.is_whole() || solutions.any(|solution| quantity.is_listed(solution))
    }

    /// The quantities with a value in some case.
    fn quantities(&self) -> impl Iterator<Item = &'static Quantity> {
        let has_value = |quantity: &&'static Quantity| {
            self.is_listed(quantity) && self.cases.iter().any(|case| case.value(quantity).is_some())
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
        let ComparedCase { name, file, variant, case, found, .. } = &self.cases[at];
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

/// The table with further rows for labels longer than a width, and for long values and differences.
fn wrapped(table: &Table, label: usize) -> Table {
    let lines = |(at, cell): (usize, &Cell)| match at {
        LABEL => flow(cell.text().split_whitespace(), label),
        NAMES.. => {
            let words = cell.text().split_whitespace();
            let widest = words.clone().map(|word| word.chars().count()).max();
            flow(words, LONGEST.max(widest.unwrap_or(0)))
        }
        _ => vec![cell.text().to_owned()],
    };
    let rows = table.rows.iter().flat_map(|row| {
        let cells: Vec<Vec<String>> = row.iter().enumerate().map(lines).collect();
        let count = cells.iter().map(Vec::len).max().unwrap_or(0);
        let line = |at| {
            let texts = cells.iter().map(move |lines| lines.get(at).cloned().unwrap_or_default());
            texts.map(Cell::Text).collect()
        };
        (0..count).map(line).collect::<Vec<_>>()
    });
    Table { rows: rows.collect(), ..table.clone() }
}

/// The symbol and the label of the field of an input, or of the subject of a limit or a distribution.
fn subject_of(key: &str) -> (&'static str, &str) {
    let quantity = key.strip_prefix("limits.").and_then(Quantity::find);
    let field = key.strip_prefix("spread.").map_or(key, |field| field.trim_matches('"'));
    let field = index_of(field).map(|field| (FIELDS[field].symbol, FIELDS[field].label));
    let quantity = quantity.map(|quantity| (quantity.symbol, quantity.label.trim_start()));
    quantity.or(field).unwrap_or(("", key))
}

/// The symbol and the label of an input. An input without a symbol has its label instead.
pub(crate) fn names(key: &str) -> [String; 2] {
    let (symbol, label) = subject_of(key);
    let symbol = match key.split_once('.') {
        Some(("limits", _)) => format!("{symbol} limit"),
        Some(("spread", _)) => format!("{symbol} spread"),
        _ if symbol.is_empty() => return [label.to_owned(), String::new()],
        _ => symbol.to_owned(),
    };
    [symbol, label.to_owned()]
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
pub fn is_unchanged(now: f64, base: f64) -> bool {
    now.to_bits() == base.to_bits() || ((now - base) / base).abs() < NO_DIFFERENCE
}

/// The difference in percent of the reference. `None` if the quantity can be negative, or if the
/// reference is close to 0 compared with the value.
pub fn percent(quantity: &Quantity, now: f64, base: f64) -> Option<f64> {
    let part = (now - base) / base;
    let has_meaning = !quantity.is_signed && !quantity.is_flag() && base > 0.0 && now >= 0.0;
    (has_meaning && part.is_finite() && now <= MOST_TIMES * base).then_some(100.0 * part)
}

/// A percentage with its sign, at most nine characters wide.
pub fn in_percent(percent: f64) -> String {
    match percent.abs() {
        size if size >= 100.0 => format!("{percent:+.0} %"),
        size if size >= 1.0 => format!("{percent:+.1} %"),
        _ => format!("{percent:+.3} %"),
    }
}

/// The difference of two values: in percent, otherwise with its sign in the unit of the values.
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
