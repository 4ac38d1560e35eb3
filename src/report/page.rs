//! Solved cases side by side as one page: HTML with charts, or Markdown.

use std::fmt::Write;

use super::charts::NamedCase;
use super::compare::{ComparedCase, Comparison, Row};
use super::pictures::{Picture, pictures};
use super::solve::Subject;
use super::table::{Cell, Column, Table};
use super::verdict::verdicts;
use super::{Report, common_unit, groups, shown_with, text, value};
use crate::case::changes::label;
use crate::case::fields::index_of;
use crate::case::file::without_comments;
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::case::{Case, FIELDS};
use crate::model::Quantity;
use crate::study::statistics::{Estimate, PERCENTILES};
use crate::study::tolerance::{Samples, Tolerance};
use askama::Template;

/// A case of the page.
struct PageCase {
    name: String,
    title: String,
    method: &'static str,
    notes_of_case: String,
    verdict: Vec<String>,
    /// Whether each limit is met, with its word and its sentence.
    limits: Vec<(bool, &'static str, String)>,
    notes: Vec<String>,
    studies: Vec<Table>,
    /// The file without its comments.
    lines: String,
    /// More backticks than the file contains.
    fence: String,
    /// The whole file as a data URL.
    link: String,
    /// The file's name without folders.
    file_name: String,
}

#[derive(Template)]
#[template(path = "report.html", config = "assets/askama.toml")]
struct Html<'a> {
    page: &'a Page<'a>,
    charts: Vec<String>,
    /// The pictures of each single case.
    own: Vec<String>,
}

/// The content of a page, without its pictures.
#[derive(Template)]
#[template(path = "report.md", config = "assets/askama.toml")]
pub struct Page<'a> {
    subjects: &'a [Subject],
    title: String,
    version: &'static str,
    cases: Vec<PageCase>,
    inputs: Table,
    results: Vec<Table>,
}

impl<'a> Page<'a> {
    /// The page of some cases; empty without cases.
    #[must_use]
    pub fn of(subjects: &'a [Subject]) -> Page<'a> {
        let reports: Vec<&Report> =
            subjects.iter().filter_map(|subject| subject.solved.own()).collect();
        let cases: Vec<PageCase> = subjects.iter().filter_map(PageCase::of).collect();
        let title = match cases.as_slice() {
            [] => String::new(),
            [only] => only.title.clone(),
            several => format!("{} gear pairs side by side", several.len()),
        };
        let (inputs, results) = (inputs(&reports, &cases), results(&reports, &cases));
        Page { subjects, title, version: env!("CARGO_PKG_VERSION"), cases, inputs, results }
    }

    /// Renders a self-contained HTML page.
    ///
    /// # Errors
    /// Errors of the template.
    pub fn html(&self) -> Result<String, askama::Error> {
        let on_page = pictures().filter(|picture| picture.is_on_page());
        let (of_one, of_all): (Vec<Picture>, Vec<Picture>) =
            on_page.partition(|picture| picture.is_of_one_case());
        let cases = self.subjects.iter().zip(&self.cases).map(|(subject, case)| {
            (if self.is_single() { "" } else { case.title.as_str() }, &subject.solved)
        });
        let cases: Vec<NamedCase> = cases.collect();
        let drawn = |pictures: &[Picture], cases: &[NamedCase]| {
            pictures.iter().filter_map(|picture| picture.draw(cases).ok()).collect::<Vec<String>>()
        };
        let own = cases.iter().map(|&case| drawn(&of_one, &[case]).concat()).collect();
        Html { page: self, charts: drawn(&of_all, &cases), own }.render()
    }

    /// Renders Markdown, without charts.
    ///
    /// # Errors
    /// Errors of the template.
    pub fn markdown(&self) -> Result<String, askama::Error> {
        self.render()
    }

    /// The results without headings.
    fn all_results(&self) -> Table {
        let rows = self.results.iter().flat_map(|table| table.rows.iter().cloned());
        let columns = self.results.first().map(|table| table.columns.clone());
        Table::new("", columns.unwrap_or_default()).with(rows)
    }

    fn is_single(&self) -> bool {
        self.cases.len() == 1
    }

    fn has_limits(&self) -> bool {
        self.cases.iter().any(|case| !case.limits.is_empty())
    }

    fn has_studies(&self) -> bool {
        self.cases.iter().any(|case| !case.studies.is_empty())
    }

    fn has_notes(&self) -> bool {
        self.cases.iter().any(|case| !case.notes.is_empty())
    }
}

impl PageCase {
    fn of(subject: &Subject) -> Option<PageCase> {
        let report = subject.solved.own()?;
        let limits = verdicts(&report.case, &report.solution);
        let limits = limits.iter().map(|verdict| {
            (verdict.standing.holds(), verdict.standing.word(), verdict.to_string())
        });
        let lines = without_comments(&subject.file);
        let longest = lines.split(|c| c != '`').map(str::len).max().unwrap_or(0);
        Some(PageCase {
            name: sanitize(&report.name),
            title: report.named().heading(),
            method: report.solution.method.name(),
            notes_of_case: one_line(report.text("notes")),
            verdict: text::verdict(report),
            limits: limits.collect(),
            notes: report.notes.iter().map(|note| sanitize(&note.message)).collect(),
            studies: tables(subject, &report.case),
            lines,
            fence: "`".repeat(longest.max(2) + 1),
            link: address(&subject.file),
            file_name: sanitize(report.name.rsplit('/').next().unwrap_or_default()),
        })
    }
}

/// A text as a data URL that a browser can save.
fn address(text: &str) -> String {
    let mut address = "data:text/plain;charset=utf-8,".to_owned();
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte) {
            address.push(char::from(byte));
        } else {
            let _ = write!(address, "%{byte:02X}");
        }
    }
    address
}

/// Columns of labels and symbols, then one of numbers for each header.
fn columns(name: &'static str, headers: impl IntoIterator<Item = String>) -> Vec<Column> {
    let numbers = headers.into_iter().map(|header| Column::text("", header).to_the_right());
    let names = [Column::text("label", name), Column::text("symbol", "")];
    names.into_iter().chain(numbers).collect()
}

fn titles(cases: &[PageCase]) -> impl Iterator<Item = String> {
    cases.iter().map(|case| case.title.clone())
}

/// The fields that differ from their defaults in at least one case.
fn inputs(reports: &[&Report], cases: &[PageCase]) -> Table {
    let defaults = Case::empty();
    let rows = FIELDS.iter().enumerate().filter_map(|(at, field)| {
        let is_default = |case: &Case| match (case.value(at), defaults.value(at)) {
            (Some(own), Some(usual)) => own.total_cmp(&usual).is_eq(),
            _ => case.is_replaced(at) || case.effective(at) == defaults.effective(at),
        };
        let is_words = matches!(field.key, "title" | "notes");
        let differs = !reports.iter().all(|report| is_default(&report.case));
        let values = reports.iter().map(|report| {
            let text = sanitize(report.case.effective(at).unwrap_or("–"));
            if is_default(&report.case) { Cell::Default(text) } else { Cell::Text(text) }
        });
        let names = [label(field.key), field.symbol.to_owned()].map(Cell::from);
        (!is_words && differs).then(|| names.into_iter().chain(values).collect())
    });
    Table::new("", columns("input", titles(cases))).with(rows)
}

/// The results in groups, in the order of the method of the first case.
fn results(reports: &[&Report], cases: &[PageCase]) -> Vec<Table> {
    let Some(first) = reports.first() else { return Vec::new() };
    let method = first.solution.method;
    let row = |quantity: &'static Quantity| {
        let values = reports.iter().map(|report| value(quantity, &report.solution));
        let given = values.clone().flatten();
        let unit = common_unit(quantity, given.clone(), System::Metric);
        let shown_unit = shown_with(quantity, given.last()?, unit).unit;
        let shown = |value: Option<f64>| {
            value.map_or(Cell::None("–"), |value| shown_with(quantity, value, unit).number.into())
        };
        let names = [quantity.label_in(method).trim(), quantity.symbol_in(method)].map(Cell::from);
        let source = [shown_unit, quantity.equation].map(Cell::from);
        Some(names.into_iter().chain(values.map(shown)).chain(source).collect())
    };
    let mut columns = columns("quantity", titles(cases));
    columns.extend(["unit", "source"].map(|key| Column::text(key, key)));
    let table = |group: &super::Group| {
        Table::new(group.heading(method), columns.clone()).with(group.quantities().filter_map(row))
    };
    let tables = groups(method).into_iter().map(table);
    tables.filter(|table| !table.rows.is_empty()).collect()
}

/// The tables of the studies of a case.
fn tables(subject: &Subject, case: &Case) -> Vec<Table> {
    let variants = subject.variants.iter().map(of_variants);
    let tolerance = subject.tolerance.iter();
    let tolerance = tolerance.map(|(study, samples)| of_tolerance(case, study, samples));
    variants.chain(tolerance).collect()
}

fn of_variants(comparison: &Comparison) -> Table {
    let names = comparison.cases.iter().map(|case| sanitize(&case.name));
    let mut columns = columns("", names);
    columns.push(Column::text("unit", ""));
    let row = |Row { symbol, label, unit, values, differences }: Row| {
        let values = values.into_iter().zip(differences);
        let values = values.map(|(value, difference)| match difference.as_str() {
            "" => value,
            difference => format!("{value} ({difference})"),
        });
        let cells = [label, symbol].into_iter().chain(values).chain([unit.to_owned()]);
        cells.map(Cell::from).collect()
    };
    let rows = comparison.groups().into_iter().flat_map(|(_, rows)| rows).map(row);
    let notes = comparison.cases.iter().flat_map(|ComparedCase { name, found, .. }| {
        let problems = found.as_ref().err().into_iter().flatten();
        problems.map(move |problem| sanitize(&format!("{name}: {problem}")))
    });
    Table {
        notes: notes.collect(),
        ..Table::new("Variants, with the differences from the case", columns).with(rows)
    }
}

fn of_tolerance(case: &Case, study: &Tolerance, samples: &Samples) -> Table {
    let summary = study.summary(samples);
    let percentiles = PERCENTILES.iter().map(|percent| format!("P{percent}"));
    let figures = ["mean", "standard deviation"].map(str::to_owned);
    let mut columns = columns("quantity", percentiles.chain(figures));
    columns.push(Column::text("unit", "unit"));
    let rows = summary.quantities.iter().filter_map(|of| {
        let (quantity, found) = (of.quantity, of.figures.as_ref()?);
        let ends = [found.range.0, found.range.1].into_iter();
        let unit = common_unit(quantity, ends, System::Metric);
        let shown = |value: f64| shown_with(quantity, value, unit);
        let values = found.percentiles.iter().map(|one| one.value);
        let values = values.chain([found.mean.value, found.deviation]);
        let names = [quantity.label, quantity.symbol].map(Cell::from).into_iter();
        let cells = names.chain(values.map(|value| shown(value).number.into()));
        Some(cells.chain([shown(found.mean.value).unit.into()]).collect())
    });
    let spread = case.spread.iter().map(|spread| {
        let value = index_of(spread.field).and_then(|field| case.effective(field));
        let value = value.unwrap_or_default();
        sanitize(&format!("{} {value}, {}", spread.field, spread.in_words()))
    });
    let spread: Vec<String> = spread.collect();
    let contact = summary.contact.map(|found| chance("corner contact", &found));
    let limits = summary.limits.iter().filter_map(|limit| {
        let name = format!("{} > {}", limit.quantity.key, sanitize(&limit.limit.text));
        Some(chance(&name, limit.probability.as_ref()?))
    });
    let samples = study.design.samples;
    let refused = Some(samples - summary.solved).filter(|&refused| refused > 0);
    let refused = refused.map_or_else(String::new, |refused| format!(", {refused} refused"));
    let spread = format!("Spread: {}.", spread.join("; "));
    let title = format!("Tolerance, {samples} samples{refused}, seed {}", study.design.seed);
    Table {
        notes: [spread].into_iter().chain(contact).chain(limits).collect(),
        ..Table::new(title, columns).with(rows)
    }
}

fn chance(what: &str, Estimate { value, from, to }: &Estimate) -> String {
    let percent = |part: &f64| format!("{:.1}", 100.0 * part);
    let (value, from, to) = (percent(value), percent(from), percent(to));
    format!("Probability of {what}: {value} % (95 % interval {from} to {to} %).")
}
