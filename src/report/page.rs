//! Solved cases side by side as one page: HTML with charts, or Markdown.

mod markdown;
mod studies;

use std::fmt::Write;

use askama::Template;

pub use self::studies::Studies;
use self::studies::StudyTable;
use super::charts::SolvedCase;
use super::groups::{FREE_IMPACT, groups};
use super::pictures::{Picture, pictures};
use super::verdict::verdicts;
use super::{Report, common_unit, shown_with, text, value};
use crate::case::changes::label;
use crate::case::file::without_comments;
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::case::{Case, FIELDS};
use crate::model::dynamic::speeds::SpeedCurve;
use crate::model::{Quantity, Solution};

/// A solved case with the text of its file.
#[derive(Debug)]
pub struct Subject {
    /// The solve by the method of the case, then a solve for the charts that this method lacks.
    pub reports: Vec<Report>,
    /// The dynamic factor over speed, if computed.
    pub speeds: Option<SpeedCurve>,
    /// The studies of the case.
    pub studies: Studies,
    /// The text of the case file.
    pub file: String,
}

/// A column of the page.
struct Column {
    name: String,
    title: String,
    method: &'static str,
    notes_of_case: String,
    verdict: Vec<String>,
    limits: Vec<LimitLine>,
    notes: Vec<String>,
    studies: Vec<StudyTable>,
    /// The file without its comments.
    lines: String,
    /// The whole file as a data URL.
    link: String,
    /// The file's name without folders.
    file_name: String,
}

struct LimitLine {
    word: &'static str,
    is_met: bool,
    words: String,
}

struct InputRow {
    label: String,
    symbol: &'static str,
    /// The text of each case and whether it is the default.
    values: Vec<(String, bool)>,
}

struct Table {
    title: String,
    rows: Vec<ResultRow>,
}

struct ResultRow {
    label: &'static str,
    symbol: &'static str,
    values: Vec<String>,
    unit: &'static str,
    source: &'static str,
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
pub struct Page<'a> {
    subjects: &'a [Subject],
    title: String,
    version: &'static str,
    columns: Vec<Column>,
    inputs: Vec<InputRow>,
    tables: Vec<Table>,
}

impl<'a> Page<'a> {
    /// The page of some cases; empty without cases.
    #[must_use]
    pub fn of(subjects: &'a [Subject]) -> Page<'a> {
        let own: Vec<&Report> =
            subjects.iter().filter_map(|subject| subject.reports.first()).collect();
        let columns: Vec<Column> = subjects.iter().filter_map(column).collect();
        Page {
            subjects,
            title: match columns.as_slice() {
                [] => String::new(),
                [only] => only.title.clone(),
                several => format!("{} gear pairs side by side", several.len()),
            },
            version: env!("CARGO_PKG_VERSION"),
            inputs: inputs(&own),
            tables: tables(&own),
            columns,
        }
    }

    /// Renders a self-contained HTML page.
    ///
    /// # Errors
    /// Errors of the template.
    pub fn html(&self) -> Result<String, askama::Error> {
        let on_page = pictures().filter(|picture| picture.is_on_page());
        let (of_one, of_all): (Vec<Picture>, Vec<Picture>) =
            on_page.partition(|picture| picture.is_of_one_case());
        let cases = self.cases();
        let page = Html {
            page: self,
            charts: of_all.iter().filter_map(|picture| picture.draw(&cases)).collect(),
            own: cases
                .iter()
                .map(|case| {
                    let drawn = of_one.iter().filter_map(|picture| picture.draw(&[*case]));
                    drawn.collect()
                })
                .collect(),
        };
        page.render()
    }

    fn cases(&self) -> Vec<SolvedCase<'_>> {
        let columns = self.subjects.iter().zip(&self.columns);
        columns
            .map(|(subject, column)| SolvedCase {
                name: if self.is_single() { "" } else { &column.title },
                reports: &subject.reports,
                speeds: subject.speeds.as_ref(),
            })
            .collect()
    }

    /// Renders Markdown, without charts.
    #[must_use]
    pub fn markdown(&self) -> String {
        markdown::render(self)
    }

    fn is_single(&self) -> bool {
        self.columns.len() == 1
    }

    fn has_limits(&self) -> bool {
        self.columns.iter().any(|column| !column.limits.is_empty())
    }

    fn has_studies(&self) -> bool {
        self.columns.iter().any(|column| !column.studies.is_empty())
    }

    fn has_notes(&self) -> bool {
        self.columns.iter().any(|column| !column.notes.is_empty())
    }
}

fn column(subject: &Subject) -> Option<Column> {
    let report = subject.reports.first()?;
    let limits = verdicts(&report.case, &report.solution);
    let title =
        if report.title().is_empty() { report.name.clone() } else { report.title().to_owned() };
    let file_name = report.name.rsplit('/').next().unwrap_or_default();
    Some(Column {
        name: sanitize(&report.name),
        title: sanitize(&title),
        method: report.solution.method.name(),
        notes_of_case: one_line(report.text("notes")),
        verdict: text::verdict(report),
        limits: limits
            .iter()
            .map(|verdict| LimitLine {
                word: verdict.standing.word(),
                is_met: verdict.standing.holds(),
                words: verdict.to_string(),
            })
            .collect(),
        notes: report.notes.iter().map(|note| sanitize(&note.message)).collect(),
        studies: subject.studies.tables(&report.case),
        lines: without_comments(&subject.file),
        link: address(&subject.file),
        file_name: sanitize(file_name),
    })
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

/// The fields that differ from their defaults in at least one case.
fn inputs(reports: &[&Report]) -> Vec<InputRow> {
    let defaults = Case::empty();
    let rows = FIELDS.iter().enumerate().filter_map(|(at, field)| {
        let is_default = |case: &Case| match (case.value(at), defaults.value(at)) {
            (Some(own), Some(usual)) => own.total_cmp(&usual).is_eq(),
            _ => case.is_replaced(at) || case.effective(at) == defaults.effective(at),
        };
        let is_words = matches!(field.key, "title" | "notes");
        if is_words || reports.iter().all(|report| is_default(&report.case)) {
            return None;
        }
        let values = reports.iter().map(|report| {
            let text = report.case.effective(at).unwrap_or("–");
            (sanitize(text), is_default(&report.case))
        });
        Some(InputRow { label: label(field.key), symbol: field.symbol, values: values.collect() })
    });
    rows.collect()
}

/// The results in groups, in the order of the method of the first case.
fn tables(reports: &[&Report]) -> Vec<Table> {
    let Some(first) = reports.first() else {
        return Vec::new();
    };
    let method = first.solution.method;
    let solutions: Vec<&Solution> = reports.iter().map(|report| &report.solution).collect();
    let tables = groups(method).into_iter().map(|group| Table {
        title: if group.is_beside(method) {
            format!("{FREE_IMPACT}: {}", group.title)
        } else {
            group.title.to_owned()
        },
        rows: group.quantities().filter_map(|quantity| row(quantity, &solutions)).collect(),
    });
    tables.filter(|table| !table.rows.is_empty()).collect()
}

fn row(quantity: &'static Quantity, solutions: &[&Solution]) -> Option<ResultRow> {
    let values: Vec<Option<f64>> =
        solutions.iter().map(|solution| value(quantity, solution)).collect();
    let given = values.iter().copied().flatten();
    given.clone().next()?;
    let unit = common_unit(quantity, given, System::Metric);
    let method = solutions.first()?.method;
    let mut shown_unit = "";
    let texts = values.iter().map(|value| match value {
        Some(value) => {
            let shown = shown_with(quantity, *value, unit);
            shown_unit = shown.unit;
            shown.number
        }
        None => "–".to_owned(),
    });
    let values = texts.collect();
    Some(ResultRow {
        label: quantity.label_in(method),
        symbol: quantity.symbol_in(method),
        values,
        unit: shown_unit,
        source: quantity.equation,
    })
}
