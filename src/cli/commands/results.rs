//! Commands that solve cases and show the results: `solve`, `check`, `explain`, `compare`, `plot`,
//! `report`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::sanitize::sanitize;
use crate::case::{Case, Document, Problem};
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::options::{
    CaseFile, Cases, Changes, Destination, Edits, FormatChoice, FormatOption, Listing,
    OutputFormat, Quantities, QuantityList, Setting, Settings, by_method, methods, station_count,
};
use crate::cli::output::{Exit, Failure, check_out, follow, write_to};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Refusal, Solution, Stages};
use crate::report::compare::{Column, Comparison};
use crate::report::explain::{explain, render, write_json};
use crate::report::export::{ReportFormat, subject};
use crate::report::pictures::{NoPicture, find, pictures};
use crate::report::verdict::{self, Standing, Verdict, refused, stages, stages_beside, verdicts};
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
    let edits = edits_to_solve(options);
    let selection = selected(options);
    let (mut first, mut worst) = (true, Exit::Done);
    for path in &options.input.cases {
        let report = cases::open(path, &edits, streams)
            .and_then(|opened| solve_opened(&opened, &selection, streams));
        match report {
            Ok(report) => {
                print(&report, options.output.format, first, streams.output.as_mut())?;
                first = false;
            }
            Err(exit) => worst = worst.max(exit),
        }
    }
    Ok(worst)
}

/// The changes of the command line, including `--stations` as a field.
fn edits_to_solve(options: &SolveOptions) -> Edits {
    let stations =
        options.stations.clone().map(|value| Setting::by("--stations", "model.stations", &value));
    let mut edits = options.input.changes.edits();
    edits.settings.extend(stations);
    edits
}

fn selected(options: &SolveOptions) -> Selection {
    let only = distinct(options.only.iter().flatten().copied());
    let whole_json = options.output.format == OutputFormat::Json && only.is_empty();
    Selection { only, stations: options.stations.is_some() || whole_json }
}

fn solve_opened(
    opened: &Opened,
    selection: &Selection,
    streams: &mut Streams,
) -> Result<Report, Exit> {
    let Opened { name, document, inputs, .. } = opened;
    let solved =
        Report::solve(name.clone(), document.case.clone(), inputs.clone(), selection.clone());
    match solved.and_then(in_full) {
        Ok(report) => Ok(report),
        Err(refusal) => Err(opened.refused(&refusal, streams)),
    }
}

/// Refuses a report that lacks a requested quantity if the model withheld results.
fn in_full(report: Report) -> Result<Report, Refusal> {
    let missing = report.values().count() < report.selection.only.len();
    match report.solution.withheld {
        Some(refusal) if missing => Err(refusal),
        _ => Ok(report),
    }
}

fn print(
    report: &Report,
    format: OutputFormat,
    first: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    match format {
        OutputFormat::Text if first => text::write(report, out),
        OutputFormat::Text => writeln!(out).and_then(|()| text::write(report, out)),
        OutputFormat::Json => data::write_json(report, out),
        OutputFormat::Csv => data::write_csv(report, first, out),
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
    let mut worst = Exit::Done;
    for path in &options.input.cases {
        let exit = match cases::open(path, &edits, streams) {
            Ok(opened) => check(&opened, options.output.format, streams)?,
            Err(exit) => exit,
        };
        worst = worst.max(exit);
    }
    Ok(worst)
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
        match format {
            Listing::Text => tell(&verdicts, &opened.name, &mut streams.output)?,
            Listing::Json => {
                verdict::write_json(&verdicts, &opened.name, method, &mut streams.output)?;
            }
        }
    }
    if let Some(refusal) = refusal {
        return Ok(opened.refused(&refusal, streams));
    }
    let holds = verdicts.iter().all(|verdict| verdict.standing.holds());
    Ok(if holds { Exit::Done } else { Exit::Exceeded })
}

fn tell(verdicts: &[Verdict], name: &str, out: &mut dyn Write) -> io::Result<()> {
    let name = sanitize(name);
    if verdicts.is_empty() {
        return writeln!(out, "ok {name}: no limits");
    }
    verdicts
        .iter()
        .try_for_each(|verdict| writeln!(out, "{} {name}: {verdict}", verdict.standing.word()))
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

impl CompareOptions {
    /// The changes of every case, for a variant or for the case itself.
    fn edits(&self, variant: Option<&str>) -> Edits {
        let settings = self.settings.iter().cloned();
        Edits {
            variant: variant.map(str::to_owned),
            settings: settings.chain(by_method(self.method)).collect(),
        }
    }
}

pub(super) fn run_compare(
    options: &CompareOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let selection =
        Selection { only: distinct(options.only.iter().flatten().copied()), stations: false };
    let (mut cases, mut worst) = (Vec::new(), Exit::Done);
    for path in &options.cases {
        let found = cases::read(path, streams)
            .and_then(|document| edited(options, path, &document, streams));
        match found {
            Ok(found) => cases.extend(found),
            Err(exit) => worst = worst.max(exit),
        }
    }
    let columns = follow("cases", |report| {
        let count = cases.len();
        let cases = cases.into_iter().enumerate();
        let wanted = cases.take_while(|(at, _)| report(*at, count));
        wanted.map(|(_, case)| case.solve(&selection)).collect::<Vec<_>>()
    });
    if columns.len() < 2 && worst == Exit::Done {
        let name = columns.first().map_or("", |column| column.name.as_str());
        return Err(Failure::Usage(format!(
            "{name}: the case has no variants: name a second case, or add a table [variants.NAME]"
        )));
    }
    if columns.is_empty() {
        return Ok(worst);
    }
    write_comparison(&Comparison { columns, selection }, options.output.format, streams)
        .map(|exit| exit.max(worst))
}

fn write_comparison(
    comparison: &Comparison,
    format: CompareFormat,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let out = streams.output.as_mut();
    match format {
        CompareFormat::Text => comparison.write(out)?,
        CompareFormat::Csv => comparison.write_csv(out)?,
        CompareFormat::Json => comparison.write_json(out)?,
        CompareFormat::Md => comparison.write_markdown(out)?,
    }
    for line in comparison.refusals() {
        streams.say(&line);
    }
    Ok(if comparison.is_all_refused() { Exit::BadCase } else { Exit::Done })
}

/// A case, or one of its variants, with the changes of the command line.
struct Edited {
    file: String,
    edits: Edits,
    document: Document,
}

/// The case itself, then its variants.
fn edited(
    options: &CompareOptions,
    path: &Path,
    document: &Document,
    streams: &mut Streams,
) -> Result<Vec<Edited>, Exit> {
    let all = document.case.variants.iter().map(|variant| &variant.name);
    let variants: Vec<&String> =
        if options.variants.is_empty() { all.collect() } else { options.variants.iter().collect() };
    let names = std::iter::once(None).chain(variants.into_iter().map(|name| Some(name.as_str())));
    let edited = names.map(|variant| {
        let (mut document, edits) = (document.clone(), options.edits(variant));
        cases::edit(&mut document, &edits)?;
        Ok(Edited { file: path.display().to_string(), edits, document })
    });
    edited.collect::<Result<_, String>>().map_err(|line| {
        streams.say(&line);
        Exit::Usage
    })
}

impl Edited {
    fn solve(self, selection: &Selection) -> Column {
        let Edited { file, edits, document } = self;
        let (case, name) = (&document.case, cases::named(file.clone(), &edits));
        let solved = case.inputs().and_then(|inputs| {
            Report::solve(name.clone(), case.clone(), inputs, selection.clone())
                .map_err(|refusal| vec![Problem::from(&refusal).at_given(case)])
        });
        let found = solved.map_err(|problems| cases::refused(&document, problems, &edits));
        Column { name, file, variant: edits.variant, case: document.case, found }
    }
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

/// Solves a case with every quantity, and the stations on request.
fn solve_to_draw(opened: &Opened, stations: bool, streams: &mut Streams) -> Result<Report, Exit> {
    let solved = opened.unsolved().solve(stations);
    solved.map_err(|refusal| opened.refused(&refusal, streams))
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
    let cases: Vec<&Path> = options.input.cases.iter().map(AsRef::as_ref).collect();
    check_out(Some(&options.out), &cases)?;
    let edits = options.input.changes.edits();
    let (mut subjects, mut worst) = (Vec::new(), Exit::Done);
    for path in cases {
        let solved = cases::open(path, &edits, streams).and_then(|opened| {
            let report = solve_to_draw(&opened, format.has_stations(), streams)?;
            let file = opened.document.render();
            // Ctrl-C ends the program.
            let subject = follow("parts", |go_on| subject(report, file, format, go_on));
            subject.map_err(|refusal| opened.refused(&refusal, streams))
        });
        match solved {
            Ok(subject) => subjects.push(subject),
            Err(exit) => worst = worst.max(exit),
        }
    }
    if subjects.is_empty() {
        return Ok(worst);
    }
    let text = format.render(&subjects)?;
    write_to(Some(&options.out), streams.output.as_mut(), |sink| sink.write_all(text.as_bytes()))?;
    Ok(worst)
}
