//! `tolerance`: samples the distributions of a case.

use crate::case::Problem;
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{Changes, FormatOption, OutputFormat, QuantityList, StudyOptions, count};
use crate::cli::output::{check_out, write_to};
use crate::cli::progress::Running;
use crate::cli::shards;
use crate::model::Quantity;
use crate::report::tolerance::{ToleranceReport, is_all_refused};
use crate::study::batch::{Batch, Control};
use crate::study::shard::{PointsRequest, Request};
use crate::study::tolerance::USUAL_SAMPLES;
use crate::study::tolerance::{MOST_SAMPLES, Size, Tolerance};
use clap::{Args, ValueHint};
use std::io::Write;
use std::path::{Path, PathBuf};

const AFTER_HELP: &str = "A distribution is a line of [spread]: the field in quotes, then { \
    normal = WIDTH } with the standard deviation, or { uniform = WIDTH }, { triangular = WIDTH } \
    or { truncated = WIDTH } (a normal distribution cut off at three standard deviations) with \
    half the span, or { grade = CLASS } with a flank tolerance class of ISO 1328-1, for a base \
    pitch deviation. CSV has one row per solve in SI units: the samples (set a), then the points \
    of the ranking (set b, and b:FIELD with the value of b in that field). JSON is one object in \
    SI units.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// Case file with [spread]; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// Number of samples
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SAMPLES, value_parser = count)]
    pub samples: usize,
    /// Seed of the samples; the same seed gives the same samples
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// Number of samples for the ranking of the fields (default: 4096, at most --samples; 0: no
    /// ranking). Each sample needs one solve per field, plus one
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub ranking: Option<usize>,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// Compute only these quantities and those of [limits], by name or symbol
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<OutputFormat>,
    /// How the study runs
    #[command(flatten)]
    pub running: StudyOptions,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = options.running.destination.out.as_deref();
    check_size(options)?;
    check_out(out, &[&options.case])?;
    let mut opened = cases::open(&options.case, &options.changes.edits(), streams)?;
    opened.need(options.only.iter().flatten().copied());
    let study = study(options, &opened).map_err(|problem| {
        opened.report_problem(problem, streams);
        Exit::BadCase
    })?;
    for spread in &study.design.distributions {
        if let Some(sentence) = opened.without_effect(spread.field, &opened.inputs) {
            streams.say(&sentence);
        }
    }
    if let Some(shard) = options.running.shard {
        let request = request(options, &opened, &study);
        let batch =
            Batch { inputs: &opened.inputs, points: &study.design, quantities: &study.quantities };
        return shards::run(shard, &request, &batch, &options.running, streams);
    }
    let solve = |control: &Control| study.run(&opened.inputs, control);
    let samples = Running::new("solves", options.running.threads.jobs).run(solve)?;
    let whole = ToleranceReport {
        name: &opened.name,
        case: &opened.document.case,
        method: opened.inputs.method.name(),
        study: &study,
        samples: &samples,
    };
    write(name_of(options.output.format), &whole, out, streams)
}

/// Writes a study in a format, and reports its refused samples.
pub(super) fn write(
    format: &str,
    whole: &ToleranceReport,
    out: Option<&Path>,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    // Rows are written as they arrive. The figures take time, during which a signal must still end
    // the program; therefore they are complete before the file is created.
    let mut figures = Vec::new();
    match format {
        "json" => whole.write_json(&mut figures),
        "csv" => Ok(()),
        _ => whole.write(&mut figures),
    }
    .map_err(Failure::Stream)?;
    write_to(out, streams.output.as_mut(), |sink| match format {
        "csv" => whole.write_csv(sink),
        _ => sink.write_all(&figures),
    })?;
    Ok(report(whole, streams))
}

/// Reports the refused samples of a written study.
fn report(whole: &ToleranceReport, streams: &mut Streams) -> Exit {
    for refused in &whole.samples.refusals.0 {
        streams.say(&format!("{}: {}", whole.name, whole.refused(refused)));
    }
    if is_all_refused(whole.samples) { Exit::BadCase } else { Exit::Done }
}

/// The request for the shard files of the study.
fn request(options: &Options, opened: &Opened, study: &Tolerance) -> Request {
    Request {
        name: opened.name.clone(),
        case: opened.document.render(),
        quantities: study.quantities.iter().map(|known| known.key.to_owned()).collect(),
        format: name_of(options.output.format).to_owned(),
        points: PointsRequest::Tolerance {
            samples: study.design.samples,
            seed: study.design.seed,
            ranked: study.design.ranked,
        },
    }
}

/// The name of a format on the command line.
fn name_of(format: OutputFormat) -> &'static str {
    match format {
        OutputFormat::Text => "text",
        OutputFormat::Json => "json",
        OutputFormat::Csv => "csv",
    }
}

fn check_size(options: &Options) -> Result<(), Failure> {
    let samples = options.samples;
    if (2..=MOST_SAMPLES).contains(&samples) {
        return Ok(());
    }
    Err(Failure::Usage(format!("--samples {samples}: write a number from 2 to {MOST_SAMPLES}")))
}

fn study(options: &Options, opened: &Opened) -> Result<Tolerance, Problem> {
    let only: Vec<_> = options.only.iter().flatten().copied().collect();
    let size = Size { samples: options.samples, seed: options.seed, ranked: options.ranking };
    Tolerance::of(&opened.document.case, &opened.inputs, &only, size)
}
