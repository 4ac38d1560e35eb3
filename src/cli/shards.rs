//! A part of a study as a file, for `gather`.

use super::arguments;
use super::progress::Running;
use super::sink::{Failure, Sink};
use super::{Exit, Streams};
use crate::study::batch::{Batch, solve_all};
use crate::study::request::Request;
use crate::study::shard::{Shard, ShardWriter};
use std::io;

/// Solves the points of a shard and writes it.
pub(super) fn run(
    shard: Shard,
    request: &Request,
    batch: &Batch,
    options: &arguments::Running,
    streams: &mut Streams,
) -> io::Result<Exit> {
    match write(shard, request, batch, options, streams) {
        Ok(()) => Ok(Exit::Done),
        Err(failure) => failure.report(streams),
    }
}

fn write(
    shard: Shard,
    request: &Request,
    batch: &Batch,
    options: &arguments::Running,
    streams: &mut Streams,
) -> Result<(), Failure> {
    let mut sink =
        Sink::open(options.out.as_deref(), streams.output.as_mut()).map_err(Failure::File)?;
    let running = Running::new("points", options.jobs);
    let solved = body(shard, request, batch, &running, &mut sink);
    match solved {
        Ok(true) => sink.finish(),
        Ok(false) => {
            drop(sink);
            Running::end();
            Err(Failure::Stream(io::ErrorKind::Interrupted.into()))
        }
        Err(error) => Err(sink.failure(error)),
    }
}

/// Whether the shard came to its end.
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
