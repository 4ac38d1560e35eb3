//! Solved cases side by side as one page: HTML with charts, or Markdown. The first sheet has the
//! verdict, the inputs, the main results and charts; the appendix has the rest.

use super::data::{self, subject, verdict};
use super::{Report, common_unit, grouped, is_default, shown_with, unit_of_gears, value};
use crate::case::fields::{Absent, Field, Kind, index_of};
use crate::case::file::without_comments;
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::{self, System};
use crate::case::{Case, FIELDS};
use crate::model::quantities::conditions::helical;
use crate::model::{Inputs, Quantity};
use crate::report::charts::NamedCase;
use crate::report::charts::{PATTERN, Picture, find, pictures};
use crate::report::compare::Comparison;
use crate::report::relief::{BEGINS, RELIEF, begins, drawn, tolerance, tolerances};
use crate::report::solve::Subject;
use crate::report::table::{Cell, Column, Table};
use crate::report::tolerance::{distributions, probabilities, samples as samples_of};
use crate::report::verdict::verdicts;
use crate::study::relief::TipReliefs;
use crate::study::seek::distinct;
use crate::study::shard::Format;
use crate::study::statistics::PERCENTILES;
use crate::study::tolerance::{Samples, Tolerance};
use askama::Template;
use std::fmt::Write;
use std::io;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// What a page shows.
#[derive(Debug, Clone, Default)]
#[cfg_attr(feature = "cli", derive(clap::Args))]
pub struct Settings {
    /// Title of the page (default: the title of the case)
    #[cfg_attr(feature = "cli", arg(long, value_name = "TEXT"))]
    pub title: Option<String>,
    /// Leave out all results, further charts, sources and case files; studies stay
    #[cfg_attr(feature = "cli", arg(long))]
    pub no_appendix: bool,
    /// Units of the page; .csv and .json are in SI
    #[cfg_attr(feature = "cli", arg(long, value_name = "SYSTEM", default_value = "metric"))]
    pub units: System,
    /// Size of the printed sheets (default: that of the printer)
    #[cfg_attr(feature = "cli", arg(long, value_name = "SIZE"))]
    pub paper: Option<Paper>,
}

/// Sizes of printed sheets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Paper {
    /// 210 mm x 297 mm
    A4,
    /// 8.5 in x 11 in
    Letter,
}

/// Fields that the page shows even with their defaults, because they define the pair.
const DEFINING: [&str; 8] = [
    "pressure_angle",
    "profile_shift",
    "tip_diameter",
    "root_diameter",
    "young",
    "poisson",
    "density",
    "tip_relief",
];

/// The results on the first sheet; those of the free impact by their counterparts in the method.
/// The results with a limit follow.
const MAIN_RESULTS: [&str; 25] = [
    "contact_ratio",
    "overlap_ratio",
    "axial_force",
    "face_load_factor",
    "static_peak_line_load",
    "centre_distance",
    "working_pressure_angle",
    "mesh_force",
    "total_deviation",
    "clearing_relief",
    "approach_angle_driver",
    "impact_force",
    "static_peak_force",
    "dynamic_peak_force",
    "impact_duration",
    "normal_velocity",
    "sliding_velocity",
    "static_te_peak_to_peak",
    "dynamic_te_peak_to_peak",
    "mesh_force_factor",
    "tooth_force_factor",
    "mesh_stiffness",
    "mesh_frequency",
    "natural_frequency",
    "resonance_speed",
];

/// The pictures of the first sheet: the first of them that the case has, three and the teeth of a
/// single case, four of several cases. The others are in the appendix.
const MAIN_PICTURES: [&str; 5] = ["force", PATTERN, RELIEF, "transmission_error", "gap"];
/// Their number, with the teeth.
const ON_FIRST_SHEET: usize = 4;

/// A case of the page.
struct PageCase<'a> {
    report: &'a Report,
    title: String,
    verdict: Vec<String>,
    /// Whether each limit is met, with its word and its sentence.
    limits: Vec<(bool, &'static str, String)>,
    notes: Vec<String>,
    studies: Vec<Table>,
    /// The file without its comments.
    lines: String,
    file: &'a str,
}

#[derive(Template)]
#[template(path = "report.html", config = "assets/askama.toml")]
struct Html<'a> {
    page: &'a Page<'a>,
    charts: Vec<String>,
    further: Vec<String>,
    /// The meanings of the marks in `charts`.
    marks: String,
}

/// Marks of pictures with their meanings; the axes name E.
const MARKS: [(&str, &str); 8] = [
    ("D", "D is the first contact of the driven tip."),
    ("D'", "D' is the driven tip at the end of the impact."),
    ("", "The path of contact begins at E, A in ISO 21771."),
    ("E z+", "E z+ and E z- are E at the ends of the face, at positive and negative z."),
    ("B", "B is its end, E in ISO 21771."),
    ("P", "P is the pitch point."),
    ("N1", "The line of action touches the base circle of the driver at N1."),
    ("N2", "The line of action touches the base circle of the driven gear at N2."),
];

/// The content of a page, without its pictures.
#[derive(Template)]
#[template(path = "report.md", config = "assets/askama.toml")]
pub struct Page<'a> {
    subjects: &'a [Subject],
    has_appendix: bool,
    paper: &'static str,
    title: String,
    version: &'static str,
    date: String,
    cases: Vec<PageCase<'a>>,
    inputs: Table,
    main: Vec<Table>,
    results: Vec<Table>,
    units: System,
}

/// The date of today in UTC, or of `SOURCE_DATE_EPOCH` for pages with the same bytes on every day.
fn today() -> String {
    let given = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|text| text.parse().ok());
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    date(given.unwrap_or_else(now) / 86_400)
}

/// The date some days after 1970-01-01, by years that begin in March.
fn date(days: u64) -> String {
    let days = days.min(1 << 22) + 719_468;
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let (of_month, is_next) = (day - (153 * month + 2) / 5 + 1, month / 10);
    let (year, month) = (400 * era + year + is_next, month + 3 - 12 * is_next);
    format!("{year}-{month:02}-{of_month:02}")
}

impl<'a> Page<'a> {
    /// The page of some cases; empty without cases.
    pub fn of(subjects: &'a [Subject], settings: &Settings) -> Page<'a> {
        let units = settings.units;
        let cases = subjects.iter().filter_map(|subject| PageCase::of(subject, units));
        let cases: Vec<PageCase> = cases.collect();
        let title = match (&settings.title, cases.as_slice()) {
            (Some(title), _) => sanitize(title),
            (None, []) => String::new(),
            (None, [only]) => only.title.clone(),
            (None, several) => format!("{} gear pairs side by side", several.len()),
        };
        let (inputs, (main, results)) = (inputs(&cases, units), results(&cases, units));
        Page {
            subjects,
            has_appendix: !settings.no_appendix,
            paper: match settings.paper {
                None => "",
                Some(Paper::A4) => "size:A4;",
                Some(Paper::Letter) => "size:letter;",
            },
            title,
            version: env!("CARGO_PKG_VERSION"),
            date: today(),
            cases,
            inputs,
            main,
            results,
            units,
        }
    }

    /// Renders a self-contained HTML page.
    ///
    /// # Errors
    /// Errors of the template.
    pub fn html(&self) -> Result<String, askama::Error> {
        let cases = self.subjects.iter().zip(&self.cases).map(|(subject, case)| {
            (if self.is_single() { "" } else { case.title.as_str() }, subject)
        });
        let cases: Vec<NamedCase> = cases.collect();
        // A picture of one case is drawn once for each, with its title.
        let drawn = |picture: Picture| -> Vec<String> {
            let sets: Vec<&[NamedCase]> =
                if picture.is_of_one_case { cases.chunks(1).collect() } else { vec![&cases[..]] };
            let title = |cases: &[NamedCase]| match cases {
                [(title, _)] => (*title).to_owned(),
                _ => String::new(),
            };
            let draw = |cases: &[NamedCase]| picture.draw(cases, &title(cases), self.units).ok();
            sets.into_iter().filter_map(draw).collect()
        };
        let is_main = |picture: &Picture| MAIN_PICTURES.contains(&picture.key);
        let mut charts: Vec<String> =
            MAIN_PICTURES.iter().filter_map(|key| find(key)).flat_map(drawn).collect();
        let count = ON_FIRST_SHEET - usize::from(self.is_single());
        let mut further = charts.split_off(charts.len().min(count));
        let others = pictures().filter(|picture| picture.is_on_page && !is_main(picture));
        for picture in others {
            let is_first = picture.key == "teeth" && self.is_single();
            let place = if is_first { &mut charts } else { &mut further };
            place.extend(drawn(picture));
        }
        let is_marked = |mark: &str| {
            let text = format!(">{mark}</text>");
            mark.is_empty() || charts.iter().any(|chart| chart.contains(&text))
        };
        let marks = MARKS.iter().filter(|(mark, _)| is_marked(mark)).map(|(_, meaning)| *meaning);
        let marks = marks.collect::<Vec<_>>().join(" ");
        Html { page: self, charts, further, marks }.render()
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
        Table::new("", self.main[0].columns.clone()).with(rows)
    }

    fn is_single(&self) -> bool {
        self.cases.len() == 1
    }

    fn is_helical(&self) -> bool {
        self.cases.iter().any(|case| helical(&case.report.inputs))
    }

    fn has_notes(&self) -> bool {
        self.cases.iter().any(|case| !case.notes.is_empty())
    }

    /// Whether the studies are a few lines, which fit on the first sheet.
    fn has_short_studies(&self) -> bool {
        let has_no_rows = |case: &PageCase| case.studies.iter().all(|study| study.rows.is_empty());
        self.is_single() && self.has_studies() && self.cases.iter().all(has_no_rows)
    }

    fn has_studies(&self) -> bool {
        self.cases.iter().any(|case| !case.studies.is_empty())
    }
}

impl PageCase<'_> {
    fn of(subject: &Subject, units: System) -> Option<PageCase<'_>> {
        let report = subject.own()?;
        let mut case = report.case.clone();
        for limit in &mut case.limits {
            // A relative limit by the symbol of its result, whatever name the file has.
            if let (Some(of), Some((factor, _))) = (limit.of, limit.text.split_once(" x ")) {
                limit.text = format!("{factor} x {}", of.symbol);
            }
        }
        let limits = verdicts(&case, &report.solution).into_iter().map(|verdict| {
            let sentence = with_labels(&verdict.sentence(units));
            (verdict.standing.holds(), verdict.standing.word(), sentence)
        });
        let limits = limits.collect();
        Some(PageCase {
            report,
            title: report.named().heading().trim_end_matches(".toml").to_owned(),
            verdict: verdict(report, units),
            limits,
            notes: notes(report),
            studies: tables(subject, &report.case, units),
            lines: without_comments(&subject.file),
            file: &subject.file,
        })
    }

    /// The texts of the table `[about]`; then name, method and notes of the case.
    fn about(&self) -> Vec<Vec<String>> {
        let report = self.report;
        let method = report.solution.method.name();
        // The heading of a case without title is its name.
        let mut line = match report.case.title() {
            "" => format!("Method {method}"),
            _ => format!("{}, method {method}", self.file_name()),
        };
        let notes = one_line(report.text("notes"));
        if !notes.is_empty() {
            line = format!("{line}. {notes}");
        }
        let about = report.case.about.iter();
        let about = about.map(|(key, text)| {
            let mut name = sanitize(key).replace('_', " ");
            if let Some(first) = name.get_mut(..1) {
                first.make_ascii_uppercase();
            }
            format!("{name}: {}", one_line(text))
        });
        [about.collect(), vec![line]].into_iter().filter(|line| !line.is_empty()).collect()
    }

    /// The notes without the marks of Markdown.
    fn plain_notes(&self) -> Vec<String> {
        self.notes.iter().map(|note| note.replace('`', "")).collect()
    }

    /// The file's name without folders.
    fn file_name(&self) -> String {
        sanitize(self.report.name.rsplit('/').next().unwrap_or_default())
    }

    /// More backticks than the file contains.
    fn fence(&self) -> String {
        let longest = self.lines.split(|c| c != '`').map(str::len).max().unwrap_or(0);
        "`".repeat(longest.max(2) + 1)
    }

    /// The whole file as a data URL that a browser can save.
    fn link(&self) -> String {
        let mut address = "data:text/plain;charset=utf-8,".to_owned();
        for byte in self.file.bytes() {
            if byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte) {
                address.push(char::from(byte));
            } else {
                let _ = write!(address, "%{byte:02X}");
            }
        }
        address
    }
}

/// The notes on the gears, without advice for the user of the program.
fn notes(report: &Report) -> Vec<String> {
    let notes = report.notes.iter().filter(|note| !note.is_general);
    notes.map(|note| with_labels(&note.message)).collect()
}

/// A sentence with the labels of fields and quantities in place of their keys.
fn with_labels(sentence: &str) -> String {
    let word = |word: &str| {
        let key = word.trim_end_matches([',', ';', '.', ':']);
        let quantity = || Quantity::find(key).filter(|found| found.key == key && key.contains('_'));
        let label = index_of(key).map(|at| FIELDS[at].full_label());
        let label = label.or_else(|| Some(quantity()?.label.to_owned()));
        label.map_or_else(|| word.to_owned(), |label| label + &word[key.len()..])
    };
    sanitize(&sentence.split(' ').map(word).collect::<Vec<_>>().join(" "))
}

/// Columns of labels and symbols, then one of numbers for each header.
fn columns(name: &'static str, headers: impl IntoIterator<Item = String>) -> Vec<Column> {
    let numbers = headers.into_iter().map(|header| Column::text("", header).to_the_right());
    let names = [Column::text("label", name), Column::text("symbol", "")];
    names.into_iter().chain(numbers).collect()
}

fn titles<'a>(cases: &'a [PageCase]) -> impl Iterator<Item = String> + 'a {
    cases.iter().map(|case| case.title.clone())
}

/// The fields that differ from their defaults in a case, and those that define the pair. A field of
/// both gears is one row, the driver first.
fn inputs(cases: &[PageCase], units: System) -> Table {
    let has_relief = |case: &PageCase| {
        let Inputs { driver, driven, .. } = &case.report.inputs;
        driver.tip_relief + driven.tip_relief > 0.0
    };
    let is_relieved = cases.iter().any(has_relief);
    let rows = FIELDS.iter().enumerate().filter_map(|(at, field)| {
        let defines = match field.name() {
            "relief_shape" => is_relieved,
            "driver_hand" => cases.iter().any(|case| helical(&case.report.inputs)),
            name => DEFINING.contains(&name),
        };
        let fields: Vec<usize> = match field.table() {
            "" | "driven" => return None,
            "driver" => [Some(at), index_of(&format!("driven.{}", field.name()))]
                .into_iter()
                .flatten()
                .collect(),
            _ => vec![at],
        };
        let texts = cases.iter().map(|case| {
            // A spur pair has no hand.
            let is_absent = field.name() == "driver_hand" && !helical(&case.report.inputs);
            let text =
                |field| if is_absent { (None, true) } else { input(field, case.report, units) };
            fields.iter().map(|&field| text(field)).collect::<Vec<(Option<String>, bool)>>()
        });
        let texts: Vec<_> = texts.collect();
        let mut all = texts.iter().flatten();
        let is_shown = all.clone().any(|(_, is_default)| !is_default)
            || defines && all.any(|(text, _)| text.is_some());
        let values = texts.iter().map(|texts| {
            let words = texts.iter().map(|(text, _)| text.as_deref().unwrap_or("–"));
            let mut words: Vec<&str> = words.collect();
            words.dedup();
            let is_default = texts.iter().all(|(_, is_default)| *is_default);
            let text = words.join(" / ");
            if is_default { Cell::Default(text) } else { Cell::Text(text) }
        });
        let symbols: Vec<&str> =
            fields.iter().map(|&field| cases[0].report.case.symbol(field)).collect();
        let names = [field.label.to_owned(), symbols.join(" / ")].map(Cell::from);
        is_shown.then(|| names.into_iter().chain(values).collect())
    });
    let places = BEGINS.iter().filter(|_| is_relieved);
    let places = places.map(|(label, symbol, unit, place)| {
        let of = |case: &PageCase| {
            let geometry = &case.report.solution.geometry;
            let reliefs = TipReliefs::of_case(&case.report.inputs, geometry);
            let found = begins(*place, &reliefs, geometry, tolerances(&case.report.case));
            let drawn = |value| drawn(value, unit, units);
            let text = |at: usize| match (reliefs.amounts[at], found[at]) {
                (0.0, _) => "–".to_owned(),
                (_, [own, 0.0]) => drawn(own),
                (_, [own, by]) => format!("{} ±{}", drawn(own), drawn(by)),
            };
            Cell::Default(match reliefs.amounts {
                [0.0, 0.0] => "–".to_owned(),
                _ => format!("{} / {} {}", text(0), text(1), units.unit(unit)),
            })
        };
        let names = [format!("tip relief {label}"), (*symbol).to_owned()].map(Cell::from);
        names.into_iter().chain(cases.iter().map(of)).collect()
    });
    Table::new("", columns("input", titles(cases))).with(rows.chain(places))
}

/// Significant digits of an input.
const DIGITS: usize = 6;

/// The text of a field, given, computed from other fields or by default, and whether the case does
/// not change it.
fn input(at: usize, report: &Report, units: System) -> (Option<String>, bool) {
    const TOLERANCE_DIGITS: usize = 4;
    let (case, field) = (&report.case, &FIELDS[at]);
    let unit = units.unit(field.usual_unit());
    let shown = |value| System::Metric.text(value, unit, DIGITS);
    let derived = case.derived(at, &report.inputs).map(shown);
    let words = matches!(field.absent, Absent::Without(_)) && case.text(at).is_none();
    let usual = || Some(field.text_in(case.effective(at)?, unit)).filter(|_| !words);
    let text = derived.or_else(|| Some(given(case.text(at)?, field, units))).or_else(usual);
    let off = Some(tolerance(case, field.key)).filter(|off| *off > 0.0);
    let with_tolerance = |text: String| match (off, units::split(&text, "")) {
        (Some(off), Ok((_, unit))) => {
            format!("{text} ±{}", System::Metric.text(off, unit, TOLERANCE_DIGITS))
        }
        _ => text,
    };
    (text.map(with_tolerance), is_default(at, case))
}

/// A given value as written, or in the unit of a system if its unit belongs to the other system.
fn given(text: &str, field: &Field, units: System) -> String {
    let metric = field.usual_unit();
    let has_both = System::Inch.unit(metric) != metric;
    let converted = || {
        let Kind::Number(dimension, ..) = field.kind else { return None };
        let is_metric = units::is_metric(units::written_unit(text, dimension)?);
        let is_other = has_both && is_metric == (units == System::Inch);
        let value = units::parse(text, dimension, metric).ok().filter(|_| is_other)?;
        Some(units.text(value, metric, DIGITS))
    };
    converted().unwrap_or_else(|| sanitize(text))
}

/// The main results, and all results in groups, in the order of the method of the first case.
fn results(cases: &[PageCase], units: System) -> (Vec<Table>, Vec<Table>) {
    let mut columns = columns("quantity", titles(cases));
    columns.extend(["unit", "source"].map(|key| Column::text(key, key)));
    let main = Table::new("", columns);
    let Some(method) = cases.first().map(|case| case.report.solution.method) else {
        return (vec![main], Vec::new());
    };
    let row = |quantity: &'static Quantity| {
        let values = |of| cases.iter().map(move |case| value(of, &case.report.solution));
        let unit = unit_of_gears(quantity, |of| values(of).flatten(), units);
        let shown = |value| shown_with(quantity, value, unit);
        let unit = shown(values(quantity).flatten().last()?).unit;
        let text = |value: Option<f64>| {
            value.map_or(Cell::None("–".into()), |value| Cell::Text(shown(value).number))
        };
        let texts = values(quantity).map(text);
        let names = [quantity.label_in(method).trim(), quantity.symbol_in(method)].map(Cell::from);
        let source = [unit, quantity.equation].map(Cell::from);
        Some(names.into_iter().chain(texts).chain(source).collect())
    };
    let own = |key: &&str| {
        let quantity = Quantity::find(key)?;
        if quantity.is_of_free_impact() { quantity.by(method) } else { Some(quantity) }
    };
    let limited = cases.iter().flat_map(|case| &case.report.case.limits);
    let limited = limited.map(|limit| limit.quantity);
    let is_listed =
        |quantity: &&Quantity| cases.iter().any(|case| quantity.is_listed(&case.report.solution));
    let main_results = MAIN_RESULTS.iter().filter_map(own).filter(is_listed);
    let shown = distinct(main_results.chain(limited));
    let is_ideal = |of: &&Quantity| subject(of, method) == Some("without-deviations");
    let (ideal, passage): (Vec<_>, Vec<_>) = shown.into_iter().partition(is_ideal);
    let all =
        grouped(method, &main.columns, |quantity| is_listed(&quantity).then(|| row(quantity))?);
    let tables = [("", passage), ("Without base pitch deviations", ideal)].map(|(title, of)| {
        Table::new(title, main.columns.clone()).with(of.into_iter().filter_map(row))
    });
    (tables.into_iter().filter(|table| !table.rows.is_empty()).collect(), all)
}

/// The tables of the studies of a case.
fn tables(subject: &Subject, case: &Case, units: System) -> Vec<Table> {
    let variants = subject.variants.iter().map(|comparison| of_variants(comparison, units));
    let tolerance = subject.tolerance.iter();
    let tolerance = tolerance.map(|(study, samples)| of_tolerance(case, study, samples, units));
    variants.chain(tolerance).collect()
}

fn of_variants(comparison: &Comparison, units: System) -> Table {
    let names = comparison.cases.iter().map(|case| sanitize(&case.name));
    let mut columns = columns("", names);
    columns.push(Column::text("unit", ""));
    let outcomes = comparison.cases.iter().map(|case| case.outcome().replace('-', " ").into());
    let blank = || std::iter::once(Cell::from(""));
    let verdict = std::iter::once("at the entry".into()).chain(blank()).chain(outcomes);
    let verdict = verdict.chain(blank()).collect();
    let tables = comparison.tables(units);
    let rows = tables.iter().flat_map(|table| &table.rows).map(|row| {
        let [symbol, label, unit] = [2, 3, 4].map(|at: usize| row[at].clone());
        let values = (0..comparison.cases.len()).map(|at| comparison.value(row, at).into());
        [label, symbol].into_iter().chain(values).chain([unit]).collect()
    });
    // The verdict of the case is on the first sheet.
    let notes = comparison.cases.iter().skip(1);
    let notes = notes.map(|case| format!("{}: {}", sanitize(&case.name), case.described(units)));
    Table {
        notes: notes.collect(),
        ..Table::new("Variants, with the differences from the case", columns)
            .with(std::iter::once(verdict).chain(rows))
    }
}

fn of_tolerance(case: &Case, study: &Tolerance, samples: &Samples, units: System) -> Table {
    let summary = study.summary(samples);
    let percentiles = PERCENTILES.iter().map(|percent| format!("P{percent}"));
    let figures = ["mean", "standard deviation"].map(str::to_owned);
    let mut columns = columns("quantity", percentiles.chain(figures));
    columns.push(Column::text("unit", "unit"));
    let rows = summary.quantities.iter().filter_map(|of| {
        let (quantity, found) = (of.quantity, of.figures.as_ref()?);
        if found.is_constant() {
            return None;
        }
        let ends = [found.range.0, found.range.1].into_iter();
        let unit = common_unit(quantity, ends, units);
        let shown = |value: f64| shown_with(quantity, value, unit);
        let values = found.percentiles.iter().map(|one| one.value);
        let values = values.chain([found.mean.value, found.deviation]);
        let names = [quantity.label, quantity.symbol].map(Cell::from).into_iter();
        let cells = names.chain(values.map(|value| shown(value).number.into()));
        Some(cells.chain([shown(found.mean.value).unit.into()]).collect())
    });
    let spread = distributions(case).into_iter();
    let spread: Vec<String> = spread.map(|(field, text)| format!("{field} {text}")).collect();
    let spread = with_labels(&format!("Spread: {}.", spread.join("; ")));
    let chances = probabilities(&summary).into_iter();
    let chances =
        chances.map(|(name, text)| format!("Probability of {name} (95 % interval): {text}."));
    let title = format!("Tolerance, {}", samples_of(study, &summary));
    Table {
        notes: [spread].into_iter().chain(chances).collect(),
        ..Table::new(title, columns).with(rows)
    }
}

/// The extensions of reports, as an error message lists them.
pub const ENDINGS: &str = ".html, .md, .csv or .json";

/// Whether the file extension selects a picture.
pub fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
}

/// The format of a report with this file extension.
pub fn format_of(path: &Path) -> Option<Format> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    Some(match ending.as_str() {
        "html" | "htm" => Format::Html,
        "md" | "markdown" => Format::Md,
        "csv" => Format::Csv,
        "json" | "jsonl" => Format::Json,
        _ => return None,
    })
}

/// Renders cases in a format.
///
/// # Errors
/// Errors of a template or a value that cannot be written.
pub fn render(format: Format, subjects: &[Subject], settings: &Settings) -> io::Result<String> {
    let mut bytes = Vec::new();
    for (at, report) in subjects.iter().filter_map(Subject::own).enumerate() {
        match format {
            Format::Html => return Page::of(subjects, settings).html().map_err(io::Error::other),
            Format::Md | Format::Text => {
                return Page::of(subjects, settings).markdown().map_err(io::Error::other);
            }
            Format::Csv => data::write_csv(report, at == 0, &mut bytes)?,
            Format::Json => data::write_json(report, &mut bytes)?,
        }
    }
    String::from_utf8(bytes).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_given_value_is_in_the_units_of_the_page() {
        for (key, text, units, expected) in [
            ("deviations.base_pitch", "16 um", System::Inch, "0.629921 thou"),
            ("operation.torque", "70 Nm", System::Inch, "51.6294 lbf ft"),
            ("operation.speed", "2000 rpm", System::Inch, "2000 rpm"),
            ("pair.module", "0.20 in", System::Inch, "0.20 in"),
            ("pair.module", "0.2 in", System::Metric, "5.08 mm"),
            ("pair.module", "5.0 mm", System::Metric, "5.0 mm"),
            ("pair.diametral_pitch", "8 1/in", System::Metric, "8 1/in"),
            ("driver.teeth", "20", System::Inch, "20"),
        ] {
            assert_eq!(given(text, &FIELDS[index_of(key).unwrap()], units), expected);
        }
    }

    #[test]
    fn days_are_counted_with_leap_years() {
        let known = [(0, "1970-01-01"), (19_782, "2024-02-29"), (20_818, "2026-12-31")];
        for (days, text) in known {
            assert_eq!(date(days), text);
        }
    }
}
