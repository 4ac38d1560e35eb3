//! The shards of a study put together into the output of the whole.

use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Gather, Streams, sweep, tolerance};
use crate::case::Problem;
use crate::report::sweep::{SweepTable, TableFormat};
use crate::report::tolerance::ToleranceReport;
use crate::study::batch::Points;
use crate::study::refusals::Refusals;
use crate::study::request::{Request, Restored, Study};
use crate::study::shard::{Complete, Unfit, in_order};
use crate::study::sweep::Grid;
use crate::study::tolerance::{Samples, Tolerance};
use std::io;
use std::path::Path;

pub(super) fn run(options: &Gather, streams: &mut Streams) -> io::Result<Exit> {
    let files: Vec<&Path> = options.files.iter().map(AsRef::as_ref).collect();
    let out = options.out.as_deref();
    if let Some(refusal) = overwrites(out, &files) {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let shards = files.iter().map(|file| Complete::read(file));
    let shards = match shards.collect::<Result<Vec<_>, _>>().and_then(in_order) {
        Ok(shards) => shards,
        Err(unfit) => return Ok(report(unfit, streams)),
    };
    let request = shards[0].header.request.clone();
    let restored = match request.restore() {
        Ok(restored) => restored,
        Err(problem) => return Ok(unrestored(&shards[0], &problem, streams)),
    };
    match write(&shards, &request, &restored, out, streams) {
        Ok(exit) => Ok(exit),
        Err(failure) => failure.report(streams),
    }
}

fn report(unfit: Unfit, streams: &mut Streams) -> Exit {
    let (line, exit) = match unfit {
        Unfit::Unreadable(line) => (line, Exit::Unreadable),
        Unfit::Wrong(line) => (line, Exit::BadCase),
    };
    streams.say(&line);
    exit
}

fn unrestored(shard: &Complete, problem: &Problem, streams: &mut Streams) -> Exit {
    let line = format!("shard {}: {problem}", shard.header.shard);
    report(Unfit::Wrong(line), streams)
}

fn write(
    shards: &[Complete],
    request: &Request,
    restored: &Restored,
    out: Option<&Path>,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let mut sink = Sink::open(out, streams.output.as_mut()).map_err(Failure::File)?;
    match &restored.study {
        Study::Sweep(grid) => {
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
            let samples = samples(shards, study).map_err(Failure::Stream)?;
            let report = ToleranceReport {
                name: &request.name,
                case: &restored.case,
                method: restored.inputs.method.name(),
                study,
                samples: &samples,
            };
            tolerance::write_as(&request.format, &report, &mut sink)
                .map_err(|error| sink.failure(error))?;
            sink.finish()?;
            Ok(tolerance::report(&report, streams))
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
