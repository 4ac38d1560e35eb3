//! Writes a shard of a study to a file for `gather`.

use super::Streams;
use super::exit::{Exit, Failure};
use super::options::StudyOptions;
use super::output::Sink;
use super::progress::Running;
use crate::study::batch::{Batch, solve_all};
use crate::study::shard::{Request, Shard, ShardWriter};
use std::io;

/// Solves the points of a shard and writes them.
pub(super) fn run(
    shard: Shard,
    request: &Request,
    batch: &Batch,
    options: &StudyOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let mut sink = Sink::open(options.destination.out.as_deref(), streams.output.as_mut())?;
    let running = Running::new("points", options.threads.jobs);
    match body(shard, request, batch, &running, &mut sink) {
        Ok(true) => sink.finish().map(|()| Exit::Done),
        Ok(false) => Err(Failure::Interrupted),
        Err(error) => Err(sink.failure(error)),
    }
}

/// Writes the shard. Returns false if the study was stopped.
fn body(
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
