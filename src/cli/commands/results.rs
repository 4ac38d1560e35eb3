//! Commands that solve cases and show the results, and commands that write new cases and reference
//! pages.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::file::{self, SaveError, read_bytes};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, Document, EXAMPLES, Example, FIELDS};
use crate::cli::options::{
    Cases, Changes, Destination, Edits, Only, Quantities, Setting, Settings, TABLES, WORDS,
    by_method, formats, methods, one_quantity, station_count,
};
use crate::cli::questions::count_within;
use crate::cli::{
    self, Arguments, Done, Exit, Failure, Opened, Streams, check_out, follow, write_text,
};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Refusal, Solution, Stage, Stages};
use crate::report::charts::{Picture, find, pictures};
use crate::report::compare::ComparedCase;
use crate::report::digest::{STAGES, sentence};
use crate::report::explain::{explain, render, stages_of, write_json};
use crate::report::page::render as render_report;
use crate::report::solve::{self, compared, comparison};
use crate::report::table::{Named, item};
use crate::report::verdict::{self, Standing, refused, stages, verdicts};
use crate::report::{self, Selection, data, fields, page, swept};
use crate::study::shard::Format;
use crate::study::tolerance::MOST_SAMPLES;
use clap::builder::{PossibleValuesParser, Resettable, TypedValueParser};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Solve {
    /// The cases
    #[command(flatten)]
    input: Cases,
    /// The quantities
    #[command(flatten)]
    only: Only,
    /// Print the stations as well, in this many intervals between D and E, or auto
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = station_count)]
    stations: Option<String>,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(TABLES))]
    format: Format,
}

impl Solve {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let stations = self.stations.as_ref();
        let stations = stations.map(|value| Setting::new("model.stations", value));
        let (format, only) = (self.format, self.only.quantities());
        let whole_json = format == Format::Json && only.is_empty();
        let selection = Selection { only, stations: self.stations.is_some() || whole_json };
        let mut is_first = true;
        self.input.each(stations, streams, |opened, streams| {
            let Opened { name, document, inputs, .. } = opened;
            let (case, inputs) = (document.case.clone(), inputs.clone());
            let report = report::Report::solve(name.clone(), case, inputs, selection.clone())
                .and_then(in_full)
                .map_err(|refusal| opened.refused(&refusal))?;
            print(report, format, std::mem::take(&mut is_first), streams.output.as_mut())?;
            Ok(Exit::Done)
        })
    }
}

/// Refuses a report that lacks a requested quantity if the model withheld results.
fn in_full(report: report::Report) -> Result<report::Report, Refusal> {
    let missing = report.values().count() < report.selection.only.len();
    match report.solution.withheld {
        Some(refusal) if missing => Err(refusal),
        _ => Ok(report),
    }
}

fn print(
    report: report::Report,
    format: Format,
    first: bool,
    out: &mut dyn Write,
) -> io::Result<()> {
    match format {
        Format::Json => data::write_json(&report, out),
        Format::Csv => data::write_csv(&report, first, out),
        Format::Text | Format::Md | Format::Html => {
            let blank = if first { "" } else { "\n" };
            write!(out, "{blank}{}", data::render(&report.with_others()))
        }
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Check {
    /// The cases
    #[command(flatten)]
    input: Cases,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(WORDS))]
    format: Format,
}

impl Check {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        self.input.each(None, streams, |opened, streams| {
            check(opened, self.format, streams.output.as_mut())
        })
    }
}

fn check(opened: &Opened, format: Format, out: &mut dyn Write) -> Done {
    let (case, name) = (&opened.document.case, &opened.name);
    let (verdicts, refusal, outcome, method) = match solve_limited(case, &opened.inputs) {
        Ok((solution, outcome)) => {
            let verdicts = verdicts(case, &solution);
            let is_open = verdicts.iter().any(|verdict| verdict.standing == Standing::Unknown);
            (verdicts, solution.withheld.filter(|_| is_open), outcome, solution.method)
        }
        Err(refusal) => (refused(case, &refusal), Some(refusal), None, opened.inputs.method),
    };
    if refusal.is_none() || !verdicts.is_empty() {
        let shown = sanitize(name);
        if format == Format::Json {
            verdict::write_json(&verdicts, name, (method, outcome.as_deref()), out)?;
        } else {
            if let Some(outcome) = outcome {
                writeln!(out, "{shown}: {outcome}")?;
            }
            if verdicts.is_empty() {
                writeln!(out, "ok {shown}: no limits")?;
            }
            for verdict in &verdicts {
                writeln!(out, "{} {shown}: {verdict}", verdict.standing.word())?;
            }
        }
    }
    if let Some(refusal) = refusal {
        return Err(opened.refused(&refusal));
    }
    let holds = verdicts.iter().all(|verdict| verdict.standing.holds());
    Ok(if holds { Exit::Done } else { Exit::Exceeded })
}

/// Solves the stages of the limits and of the verdict on the contact. If the model refuses those of the
/// verdict, the limits alone.
fn solve_limited(case: &Case, inputs: &Inputs) -> Result<(Solution, Option<String>), Refusal> {
    let needed = stages(case);
    match model::solve(inputs, needed.and(STAGES).and(Stages::of(Stage::Clearing))) {
        Ok(solution) => {
            let outcome = sentence(&solution, System::Metric, false);
            Ok((solution, Some(outcome)))
        }
        Err(refusal) if case.limits.is_empty() => Err(refusal),
        Err(_) => Ok((model::solve(inputs, needed)?, None)),
    }
}

/// The name of the built-in case.
const BUILT_IN: &str = "Table 1 of Zhou & Chen 2014";

/// The options of the command.
#[derive(Debug, Args)]
pub struct Explain {
    /// Name or symbol of the quantity; `tipstrike fields --results` lists all quantities
    #[arg(value_name = "QUANTITY", hide_possible_values = true, value_parser = one_quantity())]
    quantity: &'static Quantity,
    /// The case file, - for standard input (default: Table 1 of Zhou & Chen 2014)
    #[arg(value_name = "CASE")]
    case: Option<PathBuf>,
    /// The changes of the case
    #[command(flatten)]
    changes: Changes,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(WORDS))]
    format: Format,
}

impl Explain {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let edits = self.changes.edits();
        let mut opened = match &self.case {
            Some(path) => cli::open(path, &edits, &[], streams),
            None => cli::changed(BUILT_IN.to_owned(), Document::table_1(), &edits),
        }?;
        opened.need([self.quantity]);
        let Opened { name, document, inputs, .. } = &opened;
        let (wanted, case) = (stages_of(self.quantity, inputs.method), &document.case);
        let page = follow("fields", |go_on| {
            let solution = model::solve_while(inputs, wanted, &|_| go_on(0, FIELDS.len()))?;
            Ok(explain(self.quantity, case, inputs, &solution, go_on))
        })?;
        let page = page.map_err(|refusal: Refusal| opened.refused(&refusal))?;
        match self.format {
            Format::Json => write_json(&page, name, &mut streams.output)?,
            _ => streams.output.write_all(render(&page, name).as_bytes())?,
        }
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Compare {
    /// Case files, each with its variants; - is standard input
    #[arg(required = true, value_name = "CASE")]
    cases: Vec<PathBuf>,
    /// Compare only these variants
    #[arg(long = "variant", value_name = "NAME,...", value_delimiter = ',')]
    variants: Vec<String>,
    /// Use this method instead of the methods of the cases
    #[arg(long, value_parser = methods())]
    method: Option<Method>,
    /// Change a field of every case and variant, such as "operation.speed=3000 rpm"
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Settings)]
    settings: Vec<Setting>,
    /// The quantities
    #[command(flatten)]
    only: Only,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(&[Format::Text, Format::Csv, Format::Json, Format::Md]))]
    format: Format,
}

/// A file, and a case of it with the changes of the command line.
type Edited = (String, Edits, Document);

impl Compare {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let selection = Selection { only: self.only.quantities(), stations: false };
        let mut edited: Vec<Edited> = Vec::new();
        let worst = cli::each(&self.cases, streams, |path, streams| {
            let document = cli::read(path, streams)?;
            let all = document.case.variants.iter().map(|variant| &variant.name);
            let named = self.variants.iter();
            let variants: Vec<&String> =
                if named.len() == 0 { all.collect() } else { named.collect() };
            let names = std::iter::once(None).chain(variants.into_iter().map(Some));
            let of_file = names.map(|variant| {
                let settings = self.settings.iter().cloned().chain(by_method(self.method));
                let edits = Edits { variant: variant.cloned(), settings: settings.collect() };
                let mut document = document.clone();
                cli::edit(&mut document, &edits)?;
                Ok((path.display().to_string(), edits, document))
            });
            edited.extend(of_file.collect::<Result<Vec<_>, Failure>>()?);
            Ok(Exit::Done)
        })?;
        let cases: Vec<ComparedCase> = follow("cases", |go_on| {
            let wanted = edited.iter().enumerate().take_while(|(at, _)| go_on(*at, edited.len()));
            wanted.map(|(_, edited)| solve_edited(edited, &selection)).collect()
        })?;
        if cases.len() < 2 && worst == Exit::Done {
            let name = cases.first().map_or("", |case| case.name.as_str());
            return Err(Failure::usage(format!(
                "{name}: the case has no variants: name a second case, or add a table [variants.NAME]"
            )));
        }
        if cases.is_empty() {
            return Ok(worst);
        }
        let comparison = comparison(cases, selection);
        let out = streams.output.as_mut();
        match self.format {
            Format::Text => comparison.write(out)?,
            Format::Csv => comparison.write_csv(out)?,
            Format::Json => comparison.write_json(out)?,
            Format::Md | Format::Html => comparison.write_markdown(out)?,
        }
        for (case, (_, edits, document)) in comparison.cases.iter().zip(&edited) {
            for problem in case.found.as_ref().err().into_iter().flatten() {
                streams.say(&cli::placed(document, problem.clone(), edits));
            }
        }
        let is_all_refused = comparison.cases.iter().all(|case| case.found.is_err());
        Ok(if is_all_refused { worst.max(Exit::BadCase) } else { worst })
    }
}

fn solve_edited((file, edits, document): &Edited, selection: &Selection) -> ComparedCase {
    let name = cli::named(file.clone(), edits);
    let mut solved = compared(name, document.case.clone(), selection);
    if let Err(problems) = &mut solved.found {
        problems.sort_by_key(|problem| document.place(&problem.field));
    }
    ComparedCase { file: file.clone(), variant: edits.variant.clone(), ..solved }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Plot {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", required_unless_present = "sweep")]
    case: Option<PathBuf>,
    /// The changes of the case
    #[command(flatten)]
    changes: Changes,
    /// The chart to draw
    #[arg(long, value_name = "NAME", default_value = "force", value_parser = charts())]
    chart: Picture,
    /// Draw the CSV file of a sweep instead of a case
    #[arg(long, value_name = "FILE", conflicts_with_all = ["case", "chart", "variant", "method", "settings"])]
    sweep: Option<PathBuf>,
    /// Draw only these quantities of the sweep
    #[arg(long, value_name = "QUANTITY,...", requires = "sweep", hide_possible_values = true, value_parser = Quantities)]
    only: Vec<Vec<&'static Quantity>>,
    /// The file
    #[command(flatten)]
    destination: Destination,
}

fn charts() -> impl TypedValueParser<Value = Picture> {
    PossibleValuesParser::new(pictures().map(|picture| picture.key))
        .try_map(|key| find(&key).ok_or("no such chart"))
}

impl Plot {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Plot { chart, destination, .. } = self;
        let out = destination.out.as_deref();
        destination.format(None, &[], true)?;
        let source = self.sweep.as_deref().or(self.case.as_deref()).unwrap_or(Path::new("-"));
        destination.check(source)?;
        let text = if self.sweep.is_some() {
            let bytes = read_bytes(source, MOST_SWEEP_BYTES)?;
            let only: Vec<&Quantity> = self.only.iter().flatten().copied().collect();
            let name = source.display().to_string();
            let caption = Named { name: &name, title: "" }.caption();
            let drawn = swept::picture(&String::from_utf8_lossy(&bytes), &only, &caption);
            let (drawn, remark) = drawn.map_err(|reason| Failure::of_case(&name, &reason))?;
            streams.say_all(remark.map(|remark| format!("{name}: {remark}")));
            drawn
        } else {
            let opened = cli::open(source, &self.changes.edits(), &[], streams)?;
            let source = opened.unsolved();
            let drawn = follow("parts", |go_on| chart.of_case(source, System::Metric, go_on))?;
            let drawn = drawn.map_err(|refusal| opened.refused(&refusal))?;
            drawn.map_err(|reason| opened.failed(&reason))?
        };
        write_text(out, streams, &text)
    }
}

/// Greatest size of the CSV file of a sweep to draw.
const MOST_SWEEP_BYTES: usize = 64 << 20;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Report {
    /// The cases
    #[command(flatten)]
    input: Cases,
    /// What the page shows
    #[command(flatten)]
    settings: page::Settings,
    /// Number of tolerance samples of a case with [spread] (default: 10000; 1000 by a method that
    /// shares the load, 100 over the face width)
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count_within::<2, MOST_SAMPLES>)]
    samples: Option<usize>,
    /// File to write, or - for standard output; replaces an existing file
    #[arg(long, required = true, value_name = "FILE")]
    out: PathBuf,
    /// Format of the output (default: html, or that of the extension of --out)
    #[arg(long, value_parser = formats(PAGES))]
    format: Option<Format>,
}

/// Formats of a report.
const PAGES: &[Format] = &[Format::Html, Format::Md, Format::Csv, Format::Json];

impl Report {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Report { input, settings, samples, out, format } = self;
        let destination = Destination { out: Some(out.clone()) };
        let format = destination.format(*format, PAGES, false)?.unwrap_or(Format::Html);
        check_out(Some(out), &input.cases.iter().map(AsRef::as_ref).collect::<Vec<_>>())?;
        let mut subjects = Vec::new();
        let worst = input.each(None, streams, |opened, streams| {
            if samples.is_some() && opened.document.case.spread.is_empty() {
                let name = opened.document.name();
                streams.say(&format!("{name}: --samples is not used: no [spread]"));
            }
            let (source, file) = (opened.unsolved(), opened.document.render());
            let subject = follow("parts", |go_on| source.subject(file, format, *samples, go_on))?;
            subjects.push(subject.map_err(|refusal| opened.refused(&refusal))?);
            Ok(Exit::Done)
        })?;
        if !subjects.is_empty() {
            let text = render_report(format, &subjects, settings)?;
            write_text(Some(out), streams, &text)?;
        }
        Ok(worst)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct New {
    /// Start from this example instead of an empty case
    #[arg(long, value_name = "EXAMPLE", value_parser = examples())]
    from: Option<&'static Example>,
    /// List the examples instead, each with its pair and its verdict
    #[arg(long, conflicts_with_all = ["from", "file"])]
    list: bool,
    /// File to write (default: standard output); must not exist yet
    file: Option<PathBuf>,
}

impl New {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        if self.list {
            list(streams.output.as_mut())?;
            return Ok(Exit::Done);
        }
        let text = self.from.map_or_else(
            || Document::new(Case::fresh()).render(),
            |example| example.text.to_owned(),
        );
        write_case(self.file.as_deref(), &text, streams)
    }
}

/// Writes a case to a file that must not exist yet, or to standard output.
fn write_case(file: Option<&Path>, text: &str, streams: &mut Streams) -> Done {
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams.output.write_all(text.as_bytes())?,
        Some(path) => file::write(path, text.as_bytes(), false).map_err(|error| match error {
            SaveError::AlreadyThere(name) => {
                let line = format!("{name}: the file exists: choose another name");
                Failure::new(Exit::Unreadable, line)
            }
            other => other.into(),
        })?,
    }
    Ok(Exit::Done)
}

/// The examples, each with its title, its pair and its verdict.
fn list(out: &mut dyn Write) -> io::Result<()> {
    let width = EXAMPLES.iter().map(|example| example.name.len()).max().unwrap_or(0);
    for example in EXAMPLES {
        let case = example.document().case;
        let digest = case
            .inputs()
            .ok()
            .and_then(|inputs| solve::digest(&case, &inputs, System::Metric, &|_| true))
            .unwrap_or_default();
        writeln!(out, "{:width$}  {}", example.name, digest.title)?;
        let limits = digest.limits.iter();
        let limits = limits.map(|(standing, limit)| format!("{} {limit}", standing.word()));
        let sentences = [format!("{}; {}", digest.pair, digest.load), digest.outcome.clone()];
        let mark = format!("{:width$}  ", "");
        for line in sentences.into_iter().chain(limits).flat_map(|text| item(&mark, &text)) {
            writeln!(out, "{line}")?;
        }
    }
    Ok(())
}

fn examples() -> impl TypedValueParser<Value = &'static Example> {
    PossibleValuesParser::new(EXAMPLES.iter().map(|example| example.name))
        .try_map(|name| Example::find(&name))
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Import {
    /// REXS model (.rexs, .rexsj or .rexsz); - is standard input
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    /// Import the stage with this id (default: the first stage of two external
    /// cylindrical gears)
    #[arg(long, value_name = "ID")]
    stage: Option<String>,
    /// File to write (default: standard output); must not exist yet
    #[arg(long, value_name = "CASE")]
    out: Option<PathBuf>,
}

impl Import {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let imported = cli::read_model(&self.model, self.stage.as_deref(), streams)?;
        write_case(self.out.as_deref(), &imported.document.render(), streams)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Fields {
    /// List the quantities instead: the names for --only and [limits]
    #[arg(long)]
    results: bool,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(WORDS))]
    format: Format,
}

impl Fields {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let out = streams.output.as_mut();
        let is_json = self.format == Format::Json;
        if self.results {
            fields::write_quantities(is_json, out)?;
        } else {
            fields::write_fields(is_json, out)?;
        }
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Schema {
    /// Write the schema of `solve --format json` instead
    #[arg(long)]
    results: bool,
}

impl Schema {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let out = streams.output.as_mut();
        if self.results {
            fields::write_results(out)?;
        } else {
            fields::write_case(out)?;
        }
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

impl Completions {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let mut program = Arguments::command();
        // The generator panics if its writer fails, and therefore writes to memory.
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut program, "tipstrike", &mut script);
        streams.output.write_all(&script)?;
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Man {
    /// The page of this command
    command: Option<String>,
}

impl Man {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let page = page(self.command.as_deref()).ok_or_else(|| {
            Failure::usage(format!(
                "man: there is no command {}: `tipstrike help` lists them",
                self.command.as_deref().unwrap_or_default()
            ))
        })?;
        let source = format!("tipstrike {}", env!("CARGO_PKG_VERSION"));
        let out = &mut streams.output;
        clap_mangen::Man::new(page).source(source).render(out)?;
        writeln!(out, ".SH \"EXIT STATUS\"")?;
        for (exit, meaning) in Exit::MEANINGS {
            writeln!(out, ".TP\n\\fB{}\\fR\n{meaning}", exit as u8)?;
        }
        Ok(Exit::Done)
    }
}

fn page(name: Option<&str>) -> Option<clap::Command> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    match name {
        // The help ends with the exit codes, which have a separate section in the manual page.
        None => Some(program.after_help(Resettable::Reset)),
        Some(name) => program.find_subcommand(name).cloned(),
    }
}
