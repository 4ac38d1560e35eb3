//! Commands of studies that can be split into shards: `sweep`, `tolerance`, `gather`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::Problem;
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::options::{
    CaseFile, Changes, Destination, FormatOption, OutputFormat, QuantityList, RowFormat,
    StudyOptions, count,
};
use crate::cli::output::{Exit, Failure, Running, Sink, check_out, write_to};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::absence::Absence;
use crate::report::sweep::{SweepTable, TableFormat};
use crate::report::tolerance::{ToleranceReport, is_all_refused};
use crate::study::axis::Axis;
use crate::study::batch::{Batch, Control, Points, Refusals, solve_all};
use crate::study::condition::{distinct, headline};
use crate::study::shard::{
    Complete, PointsRequest, Request, Restored, Shard, ShardError, ShardWriter, Study, in_order,
};
use crate::study::sweep::Grid;
use crate::study::tolerance::{MOST_SAMPLES, Samples, Size, Tolerance, USUAL_SAMPLES};
use clap::{Args, ValueHint};

const SWEEP_HELP: &str = "CSV has one row per point: the varied fields in the units of --vary, then the quantities in SI units, then the \
    outcome. A cell is empty where a quantity has no value, such as an impact force without corner contact. A refused point has the outcome \
    `refused` and no values; standard error counts the refused points and gives the reason. JSON is one object per line and point. \
    Without --only the quantities are those of [limits], else the impact force of the method.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = SWEEP_HELP)]
pub struct SweepOptions {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// Vary a field over a range, such as 'operation.speed=500..3000 rpm', or over a list, such as
    /// 'driven.teeth=20,30,40'; of several fields the first varies slowest
    #[arg(long, required = true, value_name = "KEY=FROM..TO")]
    pub vary: Vec<String>,
    /// Number of points of each range, both ends included; default 101, or every whole number.
    /// Given once for all ranges, or once for each
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub points: Vec<usize>,
    /// Use equal ratios between the points of a range instead of equal steps
    #[arg(long)]
    pub log: bool,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// Compute only these quantities, by name or symbol; `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<RowFormat>,
    /// How the study runs
    #[command(flatten)]
    pub running: StudyOptions,
}

pub(super) fn run_sweep(options: &SweepOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let grid = Grid::parse(&options.vary, &options.points, options.log)
        .map_err(|(text, problem)| Failure::of_option("--vary", text, &problem))?;
    let out = options.running.destination.out.as_deref();
    check_out(out, &[&options.input.case])?;
    let edits = options.changes.edits();
    let keys: Vec<&str> = grid.axes.iter().map(Axis::key).collect();
    cases::keep_varied(&edits.settings, &keys)?;
    let first = grid.axes.iter().map(|axis| (axis.field, axis.with_unit(0)));
    let first: Vec<(usize, String)> = first.collect();
    let mut opened = cases::open_varied(&options.input.case, &edits, &first, streams)?;
    opened.need(options.only.iter().flatten().copied());
    for sentence in idle(&grid, &opened) {
        streams.say(&sentence);
    }
    let quantities = quantities(options, &grid, &opened);
    for sentence in absent(&quantities, &grid, &opened) {
        streams.say(&sentence);
    }
    let table =
        SweepTable { grid: &grid, quantities: &quantities, format: options.output.format.into() };
    if let Some(shard) = options.running.shard {
        let request = sweep_request(options, &opened, &table);
        let batch = batch(&opened, &table);
        return run_shard(shard, &request, &batch, &options.running, streams);
    }
    let refusals = write_points(options, &opened, &table, streams)?;
    Ok(report_sweep(&table, &refusals, &opened.name, streams))
}

/// Reports the refused points of a written sweep.
fn report_sweep(
    table: &SweepTable,
    refusals: &Refusals,
    name: &str,
    streams: &mut Streams,
) -> Exit {
    let count = table.grid.count();
    for refused in &refusals.0 {
        streams.say(&format!("{name}: {}", table.refused(refused, count)));
    }
    if refusals.total() == count { Exit::BadCase } else { Exit::Done }
}

/// The request for the shard files of the study.
fn sweep_request(options: &SweepOptions, opened: &Opened, table: &SweepTable) -> Request {
    Request {
        name: opened.name.clone(),
        case: opened.document.render(),
        quantities: table.quantities.iter().map(|known| known.key.to_owned()).collect(),
        format: table.format.name().to_owned(),
        points: PointsRequest::Sweep {
            vary: options.vary.clone(),
            points: options.points.clone(),
            log: options.log,
        },
    }
}

fn batch<'a>(opened: &'a Opened, table: &SweepTable<'a>) -> Batch<'a> {
    Batch { inputs: &opened.inputs, points: table.grid, quantities: table.quantities }
}

/// The quantities that no method of the sweep computes.
fn absent(quantities: &[&Quantity], grid: &Grid, opened: &Opened) -> Vec<String> {
    let methods = grid.methods(&opened.inputs);
    let absent = quantities.iter().filter_map(|quantity| {
        let mut reasons = methods.iter().map(|&method| Absence::by_method(quantity, method));
        let reason = reasons.next()??;
        let is_absent = reasons.all(|reason| reason.is_some());
        is_absent.then(|| format!("{} has no values: {reason}", quantity.key))
    });
    absent.collect()
}

/// The varied fields that change no result.
fn idle(grid: &Grid, opened: &Opened) -> Vec<String> {
    let mut inputs = opened.inputs.clone();
    if grid.methods(&inputs).len() > 1 {
        return Vec::new();
    }
    grid.put(0, &mut inputs);
    let warning = |axis: &Axis| opened.without_effect(axis.field, &inputs);
    grid.axes.iter().filter_map(warning).collect()
}

/// The quantities that the user names, otherwise the headline quantities of every method of the
/// grid.
fn quantities(options: &SweepOptions, grid: &Grid, opened: &Opened) -> Vec<&'static Quantity> {
    if !options.only.is_empty() {
        return distinct(options.only.iter().flatten().copied());
    }
    let methods: Vec<Method> = grid.methods(&opened.inputs);
    headline(&opened.document.case, &methods)
}

/// Solves the points and writes their rows as they arrive.
fn write_points(
    options: &SweepOptions,
    opened: &Opened,
    table: &SweepTable,
    streams: &mut Streams,
) -> Result<Refusals, Failure> {
    let out = options.running.destination.out.as_deref();
    let mut sink = Sink::open(out, streams.output.as_mut())?;
    let batch = batch(opened, table);
    let running = Running::new("points", options.running.threads.jobs);
    let mut refusals = Refusals::default();
    let mut written = table.begin(&mut sink);
    let mut take = |rows| {
        refusals.count(&rows);
        written = table.write(&rows, &mut sink);
        written.is_ok()
    };
    let solved =
        running.run(|control| solve_all(&batch, 0..table.grid.count(), control, &mut take));
    written.map_err(|error| sink.failure(error))?;
    solved?;
    sink.finish().map(|()| refusals)
}

const TOLERANCE_HELP: &str = "A distribution is a line of [spread]: the field in quotes, then { \
    normal = WIDTH } with the standard deviation, or { uniform = WIDTH }, { triangular = WIDTH } \
    or { truncated = WIDTH } (a normal distribution cut off at three standard deviations) with \
    half the span, or { grade = CLASS } with a flank tolerance class of ISO 1328-1, for a base \
    pitch deviation. CSV has one row per solve in SI units: the samples (set a), then the points \
    of the ranking (set b, and b:FIELD with the value of b in that field). JSON is one object in \
    SI units.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = TOLERANCE_HELP)]
pub struct ToleranceOptions {
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

pub(super) fn run_tolerance(
    options: &ToleranceOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
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
        let request = tolerance_request(options, &opened, &study);
        let batch =
            Batch { inputs: &opened.inputs, points: &study.design, quantities: &study.quantities };
        return run_shard(shard, &request, &batch, &options.running, streams);
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
    write_samples(name_of(options.output.format), &whole, out, streams)
}

/// Writes a study in a format, and reports its refused samples.
fn write_samples(
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
    Ok(report_samples(whole, streams))
}

/// Reports the refused samples of a written study.
fn report_samples(whole: &ToleranceReport, streams: &mut Streams) -> Exit {
    for refused in &whole.samples.refusals.0 {
        streams.say(&format!("{}: {}", whole.name, whole.refused(refused)));
    }
    if is_all_refused(whole.samples) { Exit::BadCase } else { Exit::Done }
}

/// The request for the shard files of the study.
fn tolerance_request(options: &ToleranceOptions, opened: &Opened, study: &Tolerance) -> Request {
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

fn check_size(options: &ToleranceOptions) -> Result<(), Failure> {
    let samples = options.samples;
    if (2..=MOST_SAMPLES).contains(&samples) {
        return Ok(());
    }
    Err(Failure::Usage(format!("--samples {samples}: write a number from 2 to {MOST_SAMPLES}")))
}

fn study(options: &ToleranceOptions, opened: &Opened) -> Result<Tolerance, Problem> {
    let only: Vec<_> = options.only.iter().flatten().copied().collect();
    let size = Size { samples: options.samples, seed: options.seed, ranked: options.ranking };
    Tolerance::of(&opened.document.case, &opened.inputs, &only, size)
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct GatherOptions {
    /// Files that --shard wrote, in any order
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

pub(super) fn run_gather(options: &GatherOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let files: Vec<&Path> = options.files.iter().map(AsRef::as_ref).collect();
    let out = options.destination.out.as_deref();
    check_out(out, &files)?;
    let shards = files.iter().map(|file| Complete::read(file));
    let shards = shards.collect::<Result<Vec<_>, _>>().and_then(in_order);
    let shards = shards.map_err(|unfit| report_unfit(unfit, streams))?;
    let request = shards[0].header.request.clone();
    let restored =
        request.restore().map_err(|problem| unrestored(&shards[0], &problem, streams))?;
    write_gathered(&shards, &request, &restored, out, streams)
}

fn report_unfit(unfit: ShardError, streams: &mut Streams) -> Exit {
    let (line, exit) = match unfit {
        ShardError::Unreadable(line) => (line, Exit::Unreadable),
        ShardError::Wrong(line) => (line, Exit::BadCase),
    };
    streams.say(&line);
    exit
}

fn unrestored(shard: &Complete, problem: &Problem, streams: &mut Streams) -> Exit {
    let line = format!("shard {}: {problem}", shard.header.shard);
    report_unfit(ShardError::Wrong(line), streams)
}

fn write_gathered(
    shards: &[Complete],
    request: &Request,
    restored: &Restored,
    out: Option<&Path>,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    match &restored.study {
        Study::Sweep(grid) => {
            let mut sink = Sink::open(out, streams.output.as_mut())?;
            let table = SweepTable {
                grid,
                quantities: &restored.quantities,
                format: TableFormat::named(&request.format),
            };
            let refusals =
                rows_of_sweep(shards, &table, &mut sink).map_err(|error| sink.failure(error))?;
            sink.finish()?;
            Ok(report_sweep(&table, &refusals, &request.name, streams))
        }
        Study::Tolerance(study) => {
            let samples = samples(shards, study)?;
            let report = ToleranceReport {
                name: &request.name,
                case: &restored.case,
                method: restored.inputs.method.name(),
                study,
                samples: &samples,
            };
            write_samples(&request.format, &report, out, streams)
        }
    }
}

fn rows_of_sweep(shards: &[Complete], table: &SweepTable, sink: &mut Sink) -> io::Result<Refusals> {
    let mut refusals = Refusals::default();
    table.begin(sink)?;
    let grid: &Grid = table.grid;
    for shard in shards {
        let first = shard.header.shard.range(grid.count()).start;
        shard.rows(first, &mut |rows| {
            refusals.count(&rows);
            table.write(&rows, sink)
        })?;
    }
    Ok(refusals)
}

fn samples(shards: &[Complete], study: &Tolerance) -> io::Result<Samples> {
    let mut samples = Samples::of(study);
    for shard in shards {
        let first = shard.header.shard.range(study.design.count()).start;
        shard.rows(first, &mut |rows| {
            samples.add(&rows);
            Ok(())
        })?;
    }
    Ok(samples)
}

/// Solves the points of a shard and writes them.
fn run_shard(
    shard: Shard,
    request: &Request,
    batch: &Batch,
    options: &StudyOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let mut sink = Sink::open(options.destination.out.as_deref(), streams.output.as_mut())?;
    let running = Running::new("points", options.threads.jobs);
    match write_shard(shard, request, batch, &running, &mut sink) {
        Ok(true) => sink.finish().map(|()| Exit::Done),
        Ok(false) => Err(Failure::Interrupted),
        Err(error) => Err(sink.failure(error)),
    }
}

/// Writes the shard. Returns false if the study was stopped.
fn write_shard(
    shard: Shard,
    request: &Request,
    batch: &Batch,
    running: &Running,
    sink: &mut Sink,
) -> io::Result<bool> {
    let mut writer = ShardWriter::begin(shard, request, sink)?;
    let mut written = Ok(());
    let range = shard.range(batch.points.count());
    let solved = running.run(|control| {
        solve_all(batch, range, control, &mut |rows| {
            written = writer.write(&rows);
            written.is_ok()
        })
    });
    written?;
    if solved.is_err() {
        return Ok(false);
    }
    writer.finish().map(|()| true)
}
