//! Solved cases side by side as one page: HTML with charts, or Markdown.

use std::fmt::Write;
use std::sync::atomic::{AtomicBool, Ordering};

use super::charts::SolvedCase;
use super::pictures::{Picture, pictures};
use super::verdict::verdicts;
use super::{FREE_IMPACT, Report, common_unit, groups, shown_with, text, value};
use crate::case::changes::label;
use crate::case::file::without_comments;
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::case::{Case, FIELDS, Problem};
use crate::model::dynamic::speeds::SpeedCurve;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Solution};
use crate::report::Selection;
use crate::report::compare::{Column as ComparedCase, Comparison, Refused, Row};
use crate::report::layout::plain_markdown as plain;
use crate::study::batch::{Control, Stopped};
use crate::study::condition::{distinct, headline};
use crate::study::statistics::{Estimate, PERCENTILES};
use crate::study::tolerance::{Samples, Size, Tolerance};
use askama::Template;

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
        render(self)
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

fn render(page: &Page<'_>) -> String {
    let sections = [
        heading(page),
        verdict_list(page),
        limits(page),
        input_table(page),
        results(page),
        studies(page),
        notes(page),
        files(page),
    ];
    let sections: Vec<String> = sections
        .into_iter()
        .filter(|lines| !lines.is_empty())
        .map(|lines| lines.join("\n"))
        .collect();
    sections.join("\n\n") + "\n"
}

fn heading(page: &Page<'_>) -> Vec<String> {
    vec![
        format!("# {}", plain(&page.title)),
        String::new(),
        format!("Corner contact of spur gear pairs, computed by tipstrike {}.", page.version),
    ]
}

fn verdict_list(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Verdict".to_owned()];
    for column in &page.columns {
        if !page.is_single() {
            lines.extend([String::new(), format!("### {}", plain(&column.title))]);
        }
        for sentence in &column.verdict {
            lines.extend([String::new(), plain(sentence)]);
        }
        let notes = match column.notes_of_case.as_str() {
            "" => String::new(),
            notes => format!(". {}", plain(notes)),
        };
        let (name, method) = (plain(&column.name), column.method);
        lines.extend([String::new(), format!("{name}, method {method}{notes}")]);
    }
    lines
}

fn limits(page: &Page<'_>) -> Vec<String> {
    list(page, "## Limits", |column| {
        let lines = column.limits.iter();
        lines.map(|limit| format!("{}: {}", limit.word, limit.words)).collect()
    })
}

fn notes(page: &Page<'_>) -> Vec<String> {
    list(page, "## Notes", |column| column.notes.clone())
}

/// The lines of every case under a heading; empty without lines.
fn list(page: &Page<'_>, title: &str, of: impl Fn(&Column) -> Vec<String>) -> Vec<String> {
    let mut lines = Vec::new();
    for column in &page.columns {
        for line in of(column) {
            let whose = if page.is_single() {
                String::new()
            } else {
                format!("{}: ", plain(&column.title))
            };
            lines.push(format!("- {whose}{}", plain(&line)));
        }
    }
    if !lines.is_empty() {
        lines.splice(0..0, [title.to_owned(), String::new()]);
    }
    lines
}

fn input_table(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Inputs that differ from their defaults".to_owned(), String::new()];
    lines.extend(header(page, &["input", ""], &[]));
    for row in &page.inputs {
        let values = row.values.iter().map(|(text, _)| text.as_str());
        let cells = [row.label.as_str(), row.symbol].into_iter().chain(values);
        lines.push(table_row(cells));
    }
    lines
}

fn results(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Results".to_owned(), String::new()];
    lines.extend(header(page, &["quantity", ""], &["unit", "source"]));
    for row in page.tables.iter().flat_map(|table| &table.rows) {
        let values = row.values.iter().map(String::as_str);
        let cells = [row.label.trim(), row.symbol].into_iter().chain(values);
        lines.push(table_row(cells.chain([row.unit, row.source])));
    }
    lines
}

fn studies(page: &Page<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for column in &page.columns {
        for study in &column.studies {
            let whose = if page.is_single() {
                String::new()
            } else {
                format!(" of {}", plain(&column.title))
            };
            let numbers = study.names.len().saturating_sub(3);
            lines.extend([String::new(), format!("### {}{whose}", plain(&study.title))]);
            lines.push(String::new());
            lines.push(table_row(study.names.iter().map(String::as_str)));
            lines.push(format!("|---|---|{}---|", "---:|".repeat(numbers)));
            let rows = study.rows.iter();
            lines.extend(rows.map(|row| table_row(row.iter().map(String::as_str))));
            let sentences = study.sentences.iter();
            lines.extend(sentences.flat_map(|one| [String::new(), plain(one)]));
        }
    }
    if !lines.is_empty() {
        lines.insert(0, "## Studies".to_owned());
    }
    lines
}

/// The header row with one column per case, and the separator row.
fn header(page: &Page<'_>, before: &[&str], after: &[&str]) -> [String; 2] {
    let titles = page.columns.iter().map(|column| column.title.as_str());
    let names = before.iter().copied().chain(titles);
    let left = |count: usize| "---|".repeat(count);
    [
        table_row(names.chain(after.iter().copied())),
        format!(
            "|{}{}{}",
            left(before.len()),
            "---:|".repeat(page.columns.len()),
            left(after.len())
        ),
    ]
}

fn table_row<'a>(cells: impl Iterator<Item = &'a str>) -> String {
    let cells: Vec<String> = cells.map(plain).collect();
    format!("| {} |", cells.join(" | "))
}

fn files(page: &Page<'_>) -> Vec<String> {
    let mut lines = vec!["## Case files".to_owned()];
    for column in &page.columns {
        let fence = fence(&column.lines);
        lines.extend([
            String::new(),
            format!("{}, without comments:", plain(&column.name)),
            String::new(),
            format!("{fence}toml"),
            column.lines.clone(),
            fence,
        ]);
    }
    lines
}

/// A text in backticks, with more backticks than the text contains.
fn fence(text: &str) -> String {
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    "`".repeat(longest.max(2) + 1)
}

/// Samples of a closed form, as in the command `tolerance`.
const SAMPLES: usize = 10_000;
/// Samples of a method that shares the load: a solve takes a hundred times as long.
const FEW_SAMPLES: usize = 1000;
/// Seed of the command `tolerance`.
const SEED: u64 = 1;
/// Quantities of variants in addition to the headline quantities.
const OF_VARIANTS: [&str; 4] =
    ["total_deviation", "static_te_peak_to_peak", "mesh_force_factor", "steady_back_strikes"];

/// The studies of a case.
#[derive(Debug, Default)]
pub struct Studies {
    variants: Option<Comparison>,
    tolerance: Option<(Tolerance, Samples)>,
}

struct StudyTable {
    title: String,
    names: Vec<String>,
    rows: Vec<Vec<String>>,
    sentences: Vec<String>,
}

impl Studies {
    /// Computes the studies of the case: its `[variants]` and its `[spread]`. `go_on` receives the
    /// number of solved points and their total.
    ///
    /// # Errors
    /// [`Stopped`] if `go_on` returns false.
    pub fn of(
        case: &Case,
        inputs: &Inputs,
        go_on: &dyn Fn(usize, usize) -> bool,
    ) -> Result<Studies, Stopped> {
        let variants = variants(case, inputs, go_on)?;
        let is_stopped = AtomicBool::new(false);
        let control = Control {
            jobs: None,
            go_on: &|| !is_stopped.load(Ordering::Relaxed),
            progress: &|done, of| is_stopped.store(!go_on(done, of), Ordering::Relaxed),
        };
        let samples = if inputs.method.shares_load() || inputs.method == Method::Auto {
            FEW_SAMPLES
        } else {
            SAMPLES
        };
        let size = Size { samples, seed: SEED, ranked: Some(0) };
        let study = Tolerance::of(case, inputs, &[], size).ok();
        let sampled = study.map(|study| {
            let samples = study.run(inputs, &control)?;
            Ok((study, samples))
        });
        Ok(Studies { variants, tolerance: sampled.transpose()? })
    }

    fn tables(&self, case: &Case) -> Vec<StudyTable> {
        let variants = self.variants.iter().map(of_variants);
        let tolerance = self.tolerance.iter();
        let tolerance = tolerance.map(|(study, samples)| of_tolerance(case, study, samples));
        variants.chain(tolerance).collect()
    }
}

/// The case and its variants; `None` without variants.
fn variants(
    case: &Case,
    inputs: &Inputs,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<Option<Comparison>, Stopped> {
    if case.variants.is_empty() {
        return Ok(None);
    }
    let cases: Vec<(&str, Case)> = std::iter::once(("case", case.clone()))
        .chain(case.variants.iter().map(|one| (one.name.as_str(), case.with(one))))
        .collect();
    let methods = cases.iter().filter_map(|(_, case)| Some(case.inputs().ok()?.method));
    let methods: Vec<Method> = methods.chain([inputs.method]).collect();
    let others = OF_VARIANTS.iter().filter_map(|key| Quantity::find(key));
    let selection = Selection {
        only: distinct(headline(case, &methods).into_iter().chain(others)),
        stations: false,
    };
    let count = cases.len();
    let solved = cases.into_iter().enumerate().map(|(at, (name, case))| {
        if !go_on(at, count) {
            return Err(Stopped);
        }
        let found = case.inputs().and_then(|inputs| {
            Report::solve(name.to_owned(), case.clone(), inputs, selection.clone())
                .map_err(|refusal| vec![Problem::from(&refusal).at_given(&case)])
        });
        Ok(ComparedCase {
            name: name.to_owned(),
            file: String::new(),
            variant: (at > 0).then(|| name.to_owned()),
            case,
            found: found.map_err(|problems| problems.into_iter().map(refused).collect()),
        })
    });
    let columns = solved.collect::<Result<Vec<_>, _>>()?;
    Ok(Some(Comparison { columns, selection }))
}

fn refused(problem: Problem) -> Refused {
    Refused { line: format!("{}: {}: {}", problem.field, problem.cause, problem.fix), problem }
}

fn of_variants(comparison: &Comparison) -> StudyTable {
    let columns = comparison.columns.iter();
    let names = columns.clone().map(|column| sanitize(&column.name));
    let cells = |row: &Row| {
        let values = row.values.iter().zip(&row.differences);
        let values = values.map(|(value, difference)| match difference.as_str() {
            "" => sanitize(value),
            difference => format!("{} ({difference})", sanitize(value)),
        });
        let label = [sanitize(&row.label), sanitize(&row.symbol)];
        let cells = label.into_iter().chain(values);
        cells.chain([row.unit.to_owned()]).collect()
    };
    let refused = columns.filter_map(|column| Some((&column.name, column.found.as_ref().err()?)));
    let sentences = refused.flat_map(|(name, all)| {
        let lines = all.iter().map(move |one| format!("{name}: {}", one.line));
        lines.map(|line| sanitize(&line))
    });
    StudyTable {
        title: "Variants, with the differences from the case".to_owned(),
        names: [String::new(), String::new()]
            .into_iter()
            .chain(names)
            .chain([String::new()])
            .collect(),
        rows: comparison.brief().iter().map(cells).collect(),
        sentences: sentences.collect(),
    }
}

fn of_tolerance(case: &Case, study: &Tolerance, samples: &Samples) -> StudyTable {
    let summary = study.summary(samples);
    let design = &study.design;
    let percentiles = PERCENTILES.iter().map(|percent| format!("P{percent}"));
    let names = ["quantity", ""].map(str::to_owned).into_iter();
    let figures = ["mean", "standard deviation", "unit"].map(str::to_owned);
    let names = names.chain(percentiles).chain(figures).collect();
    let rows = summary.quantities.iter().filter_map(|of| {
        let (quantity, found) = (of.quantity, of.figures.as_ref()?);
        let ends = [found.range.0, found.range.1].into_iter();
        let unit = common_unit(quantity, ends, System::Metric);
        let shown = |value: f64| shown_with(quantity, value, unit);
        let values = found.percentiles.iter().map(|one| one.value);
        let values = values.chain([found.mean.value, found.deviation]);
        let label = [quantity.label, quantity.symbol].map(str::to_owned);
        let cells = label.into_iter().chain(values.map(|value| shown(value).number));
        let unit = shown(found.mean.value).unit.to_owned();
        Some(cells.chain([unit]).collect())
    });
    let refused = design.samples - summary.solved;
    let refused = if refused == 0 { String::new() } else { format!(", {refused} refused") };
    let spread = case.spread.iter().map(|spread| {
        let field = FIELDS.iter().position(|field| field.key == spread.field);
        let value = field.and_then(|field| case.effective(field));
        format!("{} {}, {}", spread.field, value.unwrap_or_default(), spread.in_words())
    });
    let spread: Vec<String> = spread.map(|words| sanitize(&words)).collect();
    let contact = summary.contact.map(|found| chance("corner contact", &found));
    let limits = summary.limits.iter().filter_map(|limit| {
        let name = format!("{} > {}", limit.quantity.key, sanitize(&limit.limit.text));
        Some(chance(&name, limit.probability.as_ref()?))
    });
    StudyTable {
        title: format!("Tolerance, {} samples{refused}, seed {SEED}", design.samples),
        names,
        rows: rows.collect(),
        sentences: [format!("Spread: {}.", spread.join("; "))]
            .into_iter()
            .chain(contact)
            .chain(limits)
            .collect(),
    }
}

fn chance(what: &str, Estimate { value, from, to }: &Estimate) -> String {
    let percent = |part: &f64| format!("{:.1}", 100.0 * part);
    let (value, from, to) = (percent(value), percent(from), percent(to));
    format!("Probability of {what}: {value} % (95 % interval {from} to {to} %).")
}
