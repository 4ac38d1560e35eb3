//! `solve`: solves cases and prints the results.

use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{
    Cases, Edits, FormatOption, OutputFormat, QuantityList, Setting, station_count,
};
use crate::model::Quantity;
use crate::model::Refusal;
use crate::report::{Report, Selection, data, text};
use crate::study::condition::distinct;
use clap::Args;
use std::io::{self, Write};

const AFTER_HELP: &str = "CSV: one row per case and one column per quantity in SI units, such as `impact_force [N]`; with --stations \
    one row per station. JSON: one object per case and line, in SI units; missing values are absent.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
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

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let edits = edits(options);
    let selection = selection(options);
    let (mut first, mut worst) = (true, Exit::Done);
    for path in &options.input.cases {
        let report = cases::open(path, &edits, streams)
            .and_then(|opened| solve(&opened, &selection, streams));
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
fn edits(options: &Options) -> Edits {
    let stations =
        options.stations.clone().map(|value| Setting::by("--stations", "model.stations", &value));
    let mut edits = options.input.changes.edits();
    edits.settings.extend(stations);
    edits
}

fn selection(options: &Options) -> Selection {
    let only = distinct(options.only.iter().flatten().copied());
    let whole_json = options.output.format == OutputFormat::Json && only.is_empty();
    Selection { only, stations: options.stations.is_some() || whole_json }
}

fn solve(opened: &Opened, selection: &Selection, streams: &mut Streams) -> Result<Report, Exit> {
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
