//! Commands that solve cases and show the results: `solve`, `check`, `explain`, `compare`, `plot`,
//! `report`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::file::read_bytes;
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, Document};
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::options::{
    Cases, Changes, Destination, Edits, Only, Quantities, Setting, Settings, by_method, formats,
    methods, one_quantity, station_count,
};
use crate::cli::output::{Done, Exit, Failure, check_out, follow, write_to};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Refusal, Solution, Stage, Stages};
use crate::report::compare::{ComparedCase, Comparison};
use crate::report::digest::{STAGES, sentence};
use crate::report::explain::{explain, render, write_json};
use crate::report::export::{ENDINGS, format_of, is_picture, render as render_report};
use crate::report::page;
use crate::report::pictures::{NoPicture, Picture, find, pictures};
use crate::report::solve::compared;
use crate::report::verdict::{self, Standing, refused, stages, verdicts};
use crate::report::{self, Selection, data, svg, sweep, text};
use crate::study::shard::Format;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};

/// The options of the command.
#[derive(Debug, Args)]
pub struct Solve {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// The quantities
    #[command(flatten)]
    pub only: Only,
    /// Print the stations as well, in this many intervals between D and E, or auto
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = station_count)]
    pub stations: Option<String>,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json, Format::Csv]))]
    pub format: Format,
}

impl Solve {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let mut edits = self.input.changes.edits();
        let stations = self.stations.iter();
        let stations = stations.map(|value| Setting::by("--stations", "model.stations", value));
        edits.settings.extend(stations);
        let (format, only) = (self.format, self.only.quantities());
        let whole_json = format == Format::Json && only.is_empty();
        let selection = Selection { only, stations: self.stations.is_some() || whole_json };
        let mut is_first = true;
        cases::each(&self.input.cases, streams, |path, streams| {
            let opened = cases::open(path, &edits, &[], streams)?;
            let Opened { name, document, inputs, .. } = &opened;
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
            write!(out, "{blank}{}", text::render(&report.with_others()))
        }
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Check {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json]))]
    pub format: Format,
}

impl Check {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let edits = self.input.changes.edits();
        cases::each(&self.input.cases, streams, |path, streams| {
            let opened = cases::open(path, &edits, &[], streams)?;
            check(&opened, self.format, streams.output.as_mut())
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

/// Solves the stages of the limits and, unless the model refuses the other stages, of the verdict on
/// the contact.
fn solve_limited(case: &Case, inputs: &Inputs) -> Result<(Solution, Option<String>), Refusal> {
    let needed = stages(case);
    match model::solve(inputs, needed.and(STAGES).and(Stages::of(Stage::Clearing))) {
        Ok(solution) => {
            let outcome = sentence(&solution, System::Metric, None);
            Ok((solution, Some(outcome)))
        }
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
    pub quantity: &'static Quantity,
    /// The case file, - for standard input (default: Table 1 of Zhou & Chen 2014)
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json]))]
    pub format: Format,
}

impl Explain {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let edits = self.changes.edits();
        let mut opened = match &self.case {
            Some(path) => cases::open(path, &edits, &[], streams),
            None => cases::changed(BUILT_IN.to_owned(), Document::table_1(), &edits),
        }?;
        opened.need([self.quantity]);
        let Opened { name, document, inputs, .. } = &opened;
        let solution = model::solve(inputs, Stages::of(self.quantity.stage))
            .map_err(|refusal| opened.refused(&refusal))?;
        let page = explain(self.quantity, &document.case, inputs, &solution);
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
    /// The quantities
    #[command(flatten)]
    pub only: Only,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Csv, Format::Json, Format::Md]))]
    pub format: Format,
}

/// A file, and a case of it with the changes of the command line.
type Edited = (String, Edits, Document);

impl Compare {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let selection = Selection { only: self.only.quantities(), stations: false };
        let mut edited: Vec<Edited> = Vec::new();
        let worst = cases::each(&self.cases, streams, |path, streams| {
            let document = cases::read(path, streams)?;
            let all = document.case.variants.iter().map(|variant| &variant.name);
            let named = self.variants.iter();
            let variants: Vec<&String> =
                if named.len() == 0 { all.collect() } else { named.collect() };
            let names = std::iter::once(None).chain(variants.into_iter().map(Some));
            let of_file = names.map(|variant| {
                let settings = self.settings.iter().cloned().chain(by_method(self.method));
                let edits = Edits { variant: variant.cloned(), settings: settings.collect() };
                let mut document = document.clone();
                cases::edit(&mut document, &edits)?;
                Ok((path.display().to_string(), edits, document))
            });
            edited.extend(of_file.collect::<Result<Vec<_>, Failure>>()?);
            Ok(Exit::Done)
        })?;
        let cases: Vec<ComparedCase> = follow("cases", |go_on| {
            let wanted = edited.iter().enumerate().take_while(|(at, _)| go_on(*at, edited.len()));
            wanted.map(|(_, edited)| solve(edited, &selection)).collect()
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
        let comparison = Comparison { cases, selection };
        let out = streams.output.as_mut();
        match self.format {
            Format::Text => comparison.write(out)?,
            Format::Csv => comparison.write_csv(out)?,
            Format::Json => comparison.write_json(out)?,
            Format::Md | Format::Html => comparison.write_markdown(out)?,
        }
        for (case, (_, edits, document)) in comparison.cases.iter().zip(&edited) {
            for problem in case.found.as_ref().err().into_iter().flatten() {
                streams.say(&cases::placed(document, problem.clone(), edits));
            }
        }
        let is_all_refused = comparison.cases.iter().all(|case| case.found.is_err());
        Ok(if is_all_refused { worst.max(Exit::BadCase) } else { worst })
    }
}

fn solve((file, edits, document): &Edited, selection: &Selection) -> ComparedCase {
    let name = cases::named(file.clone(), edits);
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
    #[arg(value_name = "CASE", required_unless_present = "sweep", value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The chart to draw
    #[arg(long, value_name = "NAME", default_value = "force", value_parser = charts())]
    pub chart: Picture,
    /// Draw the CSV file of a sweep instead of a case
    #[arg(long, value_name = "FILE", conflicts_with_all = ["case", "chart", "variant", "method", "settings"], value_hint = ValueHint::FilePath)]
    pub sweep: Option<PathBuf>,
    /// The quantities of the sweep
    #[arg(long, value_name = "QUANTITY,...", requires = "sweep", hide_possible_values = true, value_parser = Quantities)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

fn charts() -> impl TypedValueParser<Value = Picture> {
    PossibleValuesParser::new(pictures().map(|picture| picture.key))
        .try_map(|key| find(&key).ok_or("no such chart"))
}

impl Plot {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Plot { chart, destination, .. } = self;
        let out = destination.out.as_deref();
        if let Some(out) = out.filter(|out| out.extension().is_some() && !is_picture(out)) {
            let out = out.display();
            return Err(Failure::usage(format!(
                "--out {out}: a picture is SVG: use the extension .svg"
            )));
        }
        let source = self.sweep.as_deref().or(self.case.as_deref()).unwrap_or(Path::new("-"));
        destination.check(source)?;
        let text = if self.sweep.is_some() {
            let bytes = read_bytes(source, MOST_SWEEP_BYTES)?;
            let only: Vec<&Quantity> = self.only.iter().flatten().copied().collect();
            let drawn = sweep::drawn(&String::from_utf8_lossy(&bytes), &only);
            let name = source.display();
            svg::draw(
                &drawn
                    .map_err(|reason| Failure::new(Exit::BadCase, format!("{name}: {reason}")))?,
            )
        } else {
            let opened = cases::open(source, &self.changes.edits(), &[], streams)?;
            let source = opened.unsolved();
            let drawn = follow("parts", |go_on| chart.of_case(source, go_on))?;
            drawn.map_err(|reason| match reason {
                NoPicture::Refused(refusal) => opened.refused(&refusal),
                NoPicture::Absent(reason) => opened.failed(&reason),
            })?
        };
        destination.write(streams, |sink| sink.write_all(text.as_bytes()))
    }
}

/// Greatest size of the CSV file of a sweep to draw.
const MOST_SWEEP_BYTES: usize = 64 << 20;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Report {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// What the page shows
    #[command(flatten)]
    pub settings: page::Settings,
    /// File to write; the extension selects the format; replaces an existing file
    #[arg(long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: PathBuf,
}

impl Report {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Report { input: Cases { cases, changes }, settings, out } = self;
        let Some(format) = format_of(out) else {
            return Err(Failure::usage(format!(
                "--out {}: the file extension selects the format: use {}",
                out.display(),
                ENDINGS
            )));
        };
        check_out(Some(out), &cases.iter().map(AsRef::as_ref).collect::<Vec<_>>())?;
        let edits = changes.edits();
        let mut subjects = Vec::new();
        let worst = cases::each(cases, streams, |path, streams| {
            let opened = cases::open(path, &edits, &[], streams)?;
            let (source, file) = (opened.unsolved(), opened.document.render());
            let subject = follow("parts", |go_on| source.subject(file, format, go_on))?;
            subjects.push(subject.map_err(|refusal| opened.refused(&refusal))?);
            Ok(Exit::Done)
        })?;
        if !subjects.is_empty() {
            let text = render_report(format, &subjects, settings)?;
            write_to(Some(out), streams, |sink| sink.write_all(text.as_bytes()))?;
        }
        Ok(worst)
    }
}
