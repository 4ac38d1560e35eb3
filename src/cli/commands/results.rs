//! Commands that solve cases and show the results: `solve`, `check`, `explain`, `compare`, `plot`,
//! `report`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::sanitize::sanitize;
use crate::case::{Case, Document};
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::options::{
    CaseFile, Cases, Changes, Destination, Edits, FormatChoice, FormatOption, Listing,
    OutputFormat, Quantities, QuantityList, Setting, Settings, by_method, methods, station_count,
};
use crate::cli::output::{Exit, Failure, check_out, follow, write_to};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Refusal, Solution, Stages};
use crate::report::compare::{ComparedCase, Comparison};
use crate::report::explain::{explain, render, write_json};
use crate::report::export::{ReportFormat, subject};
use crate::report::pictures::{NoPicture, find, pictures};
use crate::report::verdict::{self, Standing, refused, stages, stages_beside, verdicts};
use crate::report::{Report, Selection, data, text};
use crate::study::condition::distinct;
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum, ValueHint};

const SOLVE_HELP: &str = "CSV: one row per case and one column per quantity in SI units, such as `impact_force [N]`; with --stations \
    one row per station. JSON: one object per case and line, in SI units; missing values are absent.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = SOLVE_HELP)]
pub struct SolveOptions {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// Print only these quantities, by name or symbol, and run only the stages that they need;
    /// `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// Print the stations as well, in this many intervals between D and E, or auto
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = station_count)]
    pub stations: Option<String>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<OutputFormat>,
}

pub(super) fn run_solve(options: &SolveOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let mut edits = options.input.changes.edits();
    let stations = options.stations.iter();
    let stations = stations.map(|value| Setting::by("--stations", "model.stations", value));
    edits.settings.extend(stations);
    let format = options.output.format;
    let only = distinct(options.only.iter().flatten().copied());
    let whole_json = format == OutputFormat::Json && only.is_empty();
    let selection = Selection { only, stations: options.stations.is_some() || whole_json };
    let mut is_first = true;
    cases::each(&options.input.cases, |path| {
        let opened = cases::open(path, &edits, streams)?;
        let Opened { name, document, inputs, .. } = &opened;
        let (case, inputs) = (document.case.clone(), inputs.clone());
        let solved = Report::solve(name.clone(), case, inputs, selection.clone());
        let report =
            solved.and_then(in_full).map_err(|refusal| opened.refused(&refusal, streams))?;
        print(report, format, std::mem::take(&mut is_first), streams.output.as_mut())?;
        Ok(Exit::Done)
    })
}

/// Refuses a report that lacks a requested quantity if the model withheld results.
fn in_full(report: Report) -> Result<Report, Refusal> {
    let missing = report.values().count() < report.selection.only.len();
    match report.solution.withheld {
        Some(refusal) if missing => Err(refusal),
        _ => Ok(report),
    }
}

fn print(report: Report, format: OutputFormat, first: bool, out: &mut dyn Write) -> io::Result<()> {
    match format {
        OutputFormat::Text => {
            let blank = if first { "" } else { "\n" };
            out.write_all(blank.as_bytes())?;
            text::write(&report.with_others(), out)
        }
        OutputFormat::Json => data::write_json(&report, out),
        OutputFormat::Csv => data::write_csv(&report, first, out),
    }
}

const CHECK_HELP: &str = "A limit on impact_force applies to the free impact in every \
    method. With static and dynamic, the verdict also prints the force by the method; a separate \
    limit can be set on that force. Without corner contact every limit on the impact is met. If a \
    quantity has no value, the verdict is `unknown` with the reason, and the exit code is 1. \
    JSON: one object per verdict, in SI units.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = CHECK_HELP)]
pub struct CheckOptions {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run_check(options: &CheckOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let edits = options.input.changes.edits();
    cases::each(&options.input.cases, |path| {
        check(&cases::open(path, &edits, streams)?, options.output.format, streams)
    })
}

fn check(opened: &Opened, format: Listing, streams: &mut Streams) -> Result<Exit, Failure> {
    let case = &opened.document.case;
    let (verdicts, refusal, method) = match solve_limited(case, &opened.inputs) {
        Ok(solution) => (verdicts(case, &solution), solution.withheld, solution.method),
        Err(refusal) => (refused(case, &refusal), Some(refusal), opened.inputs.method),
    };
    let is_settled = verdicts.iter().all(|verdict| verdict.standing != Standing::Unknown)
        && !verdicts.is_empty();
    let refusal = refusal.filter(|_| !is_settled);
    if refusal.is_none() || !verdicts.is_empty() {
        let (name, out) = (&opened.name, streams.output.as_mut());
        match format {
            Listing::Json => verdict::write_json(&verdicts, name, method, out)?,
            Listing::Text if verdicts.is_empty() => {
                writeln!(out, "ok {}: no limits", sanitize(name))?;
            }
            Listing::Text => verdicts.iter().try_for_each(|verdict| {
                writeln!(out, "{} {}: {verdict}", verdict.standing.word(), sanitize(name))
            })?,
        }
    }
    if let Some(refusal) = refusal {
        return Ok(opened.refused(&refusal, streams));
    }
    let holds = verdicts.iter().all(|verdict| verdict.standing.holds());
    Ok(if holds { Exit::Done } else { Exit::Exceeded })
}

/// Solves the stages of the limits and of their counterparts in the method.
fn solve_limited(case: &Case, inputs: &Inputs) -> Result<Solution, Refusal> {
    let needed = stages(case);
    let solution = model::solve(inputs, needed)?;
    let whole = needed.and(stages_beside(case, solution.method));
    if needed.covers(whole) { Ok(solution) } else { model::solve(inputs, whole).or(Ok(solution)) }
}

/// The name of the built-in case.
const BUILT_IN: &str = "Table 1 of Zhou & Chen 2014";

/// The options of the command.
#[derive(Debug, Args)]
pub struct ExplainOptions {
    /// Name or symbol of the quantity; `tipstrike fields --results` lists all quantities
    #[arg(value_name = "QUANTITY", hide_possible_values = true, value_parser = Quantities)]
    pub quantity: &'static Quantity,
    /// The case file, - for standard input (default: Table 1 of Zhou & Chen 2014)
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run_explain(
    options: &ExplainOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let edits = options.changes.edits();
    let opened = match &options.case {
        Some(path) => cases::open(path, &edits, streams),
        None => cases::changed(BUILT_IN.to_owned(), Document::table_1(), &edits, streams),
    }?;
    let Opened { name, document, inputs, .. } = &opened;
    let inputs = &inputs.clone().needing([options.quantity.stage]);
    let solution = model::solve(inputs, Stages::of(options.quantity.stage))
        .map_err(|refusal| opened.refused(&refusal, streams))?;
    let page = explain(options.quantity, &document.case, inputs, &solution);
    match options.output.format {
        Listing::Text => streams.output.write_all(render(&page, name).as_bytes())?,
        Listing::Json => write_json(&page, name, &mut streams.output)?,
    }
    Ok(Exit::Done)
}

const COMPARE_HELP: &str = "A variant is a table [variants.NAME] of the case file with the keys \
    that it changes, such as \"driven.tip_relief\" = \"48 um\". The first column is the reference \
    of all differences. A difference is in the unit of the quantity, or in percent if the \
    quantity cannot be negative and its value is at most ten times the reference. A refused case \
    or variant keeps its column, with the reason. CSV: one row per quantity in SI units. JSON: \
    one object in SI units; missing values are absent.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = COMPARE_HELP)]
pub struct CompareOptions {
    /// Case files, each with its variants; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// Compare only these variants
    #[arg(long = "variant", value_name = "NAME,...", value_delimiter = ',')]
    pub variants: Vec<String>,
    /// Use this method instead of the methods of the cases
    #[arg(long, value_parser = methods())]
    method: Option<Method>,
    /// Change a field of every case and variant, such as "operation.speed=3000 rpm"
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Settings)]
    settings: Vec<Setting>,
    /// Compare only these quantities, by name or symbol; `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<CompareFormat>,
}

/// Format of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CompareFormat {
    /// Tables for a person
    Text,
    /// One row per quantity
    Csv,
    /// One object
    Json,
    /// Tables in Markdown
    Md,
}

impl FormatChoice for CompareFormat {
    const DEFAULT: &str = "text";
}

/// A file, and a case of it with the changes of the command line.
type Edited = (String, Edits, Document);

pub(super) fn run_compare(
    options: &CompareOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let selection =
        Selection { only: distinct(options.only.iter().flatten().copied()), stations: false };
    let mut found = Vec::new();
    let worst = cases::each(&options.cases, |path| {
        let document = cases::read(path, streams)?;
        found.extend(edited(options, path, &document).map_err(|line| {
            streams.say(&line);
            Exit::Usage
        })?);
        Ok(Exit::Done)
    })?;
    let cases = follow("cases", |report| {
        let count = found.len();
        let wanted = found.into_iter().enumerate().take_while(|(at, _)| report(*at, count));
        wanted.map(|(_, edited)| solve(edited, &selection)).collect::<Vec<_>>()
    });
    if cases.len() < 2 && worst == Exit::Done {
        let name = cases.first().map_or("", |case| case.name.as_str());
        return Err(Failure::Usage(format!(
            "{name}: the case has no variants: name a second case, or add a table [variants.NAME]"
        )));
    }
    if cases.is_empty() {
        return Ok(worst);
    }
    let comparison = Comparison { cases, selection };
    let out = streams.output.as_mut();
    match options.output.format {
        CompareFormat::Text => comparison.write(out)?,
        CompareFormat::Csv => comparison.write_csv(out)?,
        CompareFormat::Json => comparison.write_json(out)?,
        CompareFormat::Md => comparison.write_markdown(out)?,
    }
    comparison.refusals().for_each(|line| streams.say(&line));
    Ok(if comparison.is_all_refused() { worst.max(Exit::BadCase) } else { worst })
}

/// The case itself, then its variants.
fn edited(
    options: &CompareOptions,
    path: &Path,
    document: &Document,
) -> Result<Vec<Edited>, String> {
    let all = document.case.variants.iter().map(|variant| &variant.name);
    let variants: Vec<&String> =
        if options.variants.is_empty() { all.collect() } else { options.variants.iter().collect() };
    let names = std::iter::once(None).chain(variants.into_iter().map(Some));
    let edited = names.map(|variant| {
        let settings = options.settings.iter().cloned().chain(by_method(options.method));
        let edits = Edits { variant: variant.cloned(), settings: settings.collect() };
        let mut document = document.clone();
        cases::edit(&mut document, &edits)?;
        Ok((path.display().to_string(), edits, document))
    });
    edited.collect()
}

fn solve((file, edits, document): Edited, selection: &Selection) -> ComparedCase {
    let (case, name) = (document.case.clone(), cases::named(file.clone(), &edits));
    let place = |problems| cases::refused(&document, problems, &edits);
    let solved = ComparedCase::solve(name, case, selection, place);
    ComparedCase { file, variant: edits.variant.clone(), ..solved }
}

const PLOT_HELP: &str = "The chart shows the method of the case. If the method has no \
    such chart, the command draws another method: load_share of paper and exact shows static; \
    impact_energy of static and dynamic shows exact. The legend names the method. The chart speed \
    shows method dynamic at the torque of the case, with the speed rising and falling. The \
    picture follows the light or dark setting of the browser.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = PLOT_HELP)]
pub struct PlotOptions {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The chart to draw
    #[arg(long, value_name = "NAME", default_value = "force", value_parser = charts())]
    pub chart: String,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

pub(super) fn run_plot(options: &PlotOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = options.destination.out.as_deref();
    if let (Some(out), Some(ending)) = (out, out.and_then(Path::extension))
        && !ending.eq_ignore_ascii_case("svg")
    {
        let out = out.display();
        return Err(Failure::Usage(format!(
            "--out {out}: a picture is SVG: use the extension .svg"
        )));
    }
    check_out(out, &[&options.input.case])?;
    let opened = cases::open(&options.input.case, &options.changes.edits(), streams)?;
    let text = draw(&opened, options, streams)?;
    write_to(out, streams.output.as_mut(), |sink| sink.write_all(text.as_bytes()))?;
    Ok(Exit::Done)
}

fn draw(opened: &Opened, options: &PlotOptions, streams: &mut Streams) -> Result<String, Exit> {
    let Some(picture) = find(&options.chart) else {
        return Err(Exit::Usage);
    };
    let source = opened.unsolved();
    let drawn = if picture.needs_speeds() {
        follow("speeds", |go_on| picture.of_case(source, go_on))
    } else {
        picture.of_case(source, &|_, _| true)
    };
    drawn.map_err(|reason| match reason {
        NoPicture::Refused(refusal) => opened.refused(&refusal, streams),
        NoPicture::Absent(reason) => {
            streams.say(&format!("{}: {reason}", opened.name));
            Exit::BadCase
        }
    })
}

fn charts() -> PossibleValuesParser {
    PossibleValuesParser::new(pictures().map(|picture| picture.key))
}

const REPORT_HELP: &str = "The HTML page needs no other file: verdict, inputs, results, charts, \
    teeth, limits, notes and the case files; one case prints on two A4 pages. Markdown has the \
    same without charts. CSV and JSON are those of `solve`, JSON with the stations.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = REPORT_HELP)]
pub struct ReportOptions {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// File to write; the extension selects the format; replaces an existing file
    #[arg(long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: PathBuf,
}

pub(super) fn run_report(options: &ReportOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let Some(format) = ReportFormat::of(&options.out) else {
        return Err(Failure::Usage(format!(
            "--out {}: the file extension selects the format: use {}",
            options.out.display(),
            ReportFormat::ENDINGS
        )));
    };
    let paths: Vec<&Path> = options.input.cases.iter().map(AsRef::as_ref).collect();
    check_out(Some(&options.out), &paths)?;
    let edits = options.input.changes.edits();
    let mut subjects = Vec::new();
    let worst = cases::each(&options.input.cases, |path| {
        let opened = cases::open(path, &edits, streams)?;
        let solved = opened.unsolved().solve(format.has_stations());
        // Ctrl-C ends the program.
        let found = solved.and_then(|report| {
            let file = opened.document.render();
            follow("parts", |go_on| subject(report, file, format, go_on))
        });
        subjects.push(found.map_err(|refusal| opened.refused(&refusal, streams))?);
        Ok(Exit::Done)
    })?;
    if !subjects.is_empty() {
        let text = format.render(&subjects)?;
        write_to(Some(&options.out), streams.output.as_mut(), |sink| {
            sink.write_all(text.as_bytes())
        })?;
    }
    Ok(worst)
}
