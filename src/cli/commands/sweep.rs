//! `sweep`: solves a case over a grid of varied fields.

use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{
    CaseFile, Changes, FormatOption, QuantityList, RowFormat, StudyOptions, count,
};
use crate::cli::output::{Sink, check_out};
use crate::cli::progress::Running;
use crate::cli::shards;
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::absence::Absence;
use crate::report::sweep::SweepTable;
use crate::study::axis::Axis;
use crate::study::batch::{Batch, Points, Refusals, solve_all};
use crate::study::condition::{distinct, headline};
use crate::study::shard::{PointsRequest, Request};
use crate::study::sweep::Grid;
use clap::Args;

const AFTER_HELP: &str = "CSV has one row per point: the varied fields in the units of --vary, then the quantities in SI units, then the \
    outcome. A cell is empty where a quantity has no value, such as an impact force without corner contact. A refused point has the outcome \
    `refused` and no values; standard error counts the refused points and gives the reason. JSON is one object per line and point. \
    Without --only the quantities are those of [limits], else the impact force of the method.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
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

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
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
        let request = request(options, &opened, &table);
        let batch = batch(&opened, &table);
        return shards::run(shard, &request, &batch, &options.running, streams);
    }
    let refusals = write(options, &opened, &table, streams)?;
    Ok(report(&table, &refusals, &opened.name, streams))
}

/// Reports the refused points of a written sweep.
pub(super) fn report(
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
fn request(options: &Options, opened: &Opened, table: &SweepTable) -> Request {
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
fn quantities(options: &Options, grid: &Grid, opened: &Opened) -> Vec<&'static Quantity> {
    if !options.only.is_empty() {
        return distinct(options.only.iter().flatten().copied());
    }
    let methods: Vec<Method> = grid.methods(&opened.inputs);
    headline(&opened.document.case, &methods)
}

/// Solves the points and writes their rows as they arrive.
fn write(
    options: &Options,
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
