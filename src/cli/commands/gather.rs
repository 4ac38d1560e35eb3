//! `gather`: combines the shards of a study into the output of the whole study.

use super::{sweep, tolerance};
use crate::case::Problem;
use crate::cli::Streams;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::Destination;
use crate::cli::output::{Sink, check_out};
use crate::report::sweep::{SweepTable, TableFormat};
use crate::report::tolerance::ToleranceReport;
use crate::study::batch::{Points, Refusals};
use crate::study::shard::{Complete, Request, Restored, ShardError, Study, in_order};
use crate::study::sweep::Grid;
use crate::study::tolerance::{Samples, Tolerance};
use clap::{Args, ValueHint};
use std::io;
use std::path::{Path, PathBuf};

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
    /// Files that --shard wrote, in any order
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let files: Vec<&Path> = options.files.iter().map(AsRef::as_ref).collect();
    let out = options.destination.out.as_deref();
    check_out(out, &files)?;
    let shards = files.iter().map(|file| Complete::read(file));
    let shards = shards.collect::<Result<Vec<_>, _>>().and_then(in_order);
    let shards = shards.map_err(|unfit| report(unfit, streams))?;
    let request = shards[0].header.request.clone();
    let restored =
        request.restore().map_err(|problem| unrestored(&shards[0], &problem, streams))?;
    write(&shards, &request, &restored, out, streams)
}

fn report(unfit: ShardError, streams: &mut Streams) -> Exit {
    let (line, exit) = match unfit {
        ShardError::Unreadable(line) => (line, Exit::Unreadable),
        ShardError::Wrong(line) => (line, Exit::BadCase),
    };
    streams.say(&line);
    exit
}

fn unrestored(shard: &Complete, problem: &Problem, streams: &mut Streams) -> Exit {
    let line = format!("shard {}: {problem}", shard.header.shard);
    report(ShardError::Wrong(line), streams)
}

fn write(
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
            Ok(sweep::report(&table, &refusals, &request.name, streams))
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
            tolerance::write(&request.format, &report, out, streams)
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
