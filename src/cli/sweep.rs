//! A case solved over a grid of varied fields.

use super::cases::{self, Opened};
use super::progress::Running;
use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Streams, Sweep, shards};
use crate::case::{Acting, partial_relevance, relevance};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::sweep::SweepTable;
use crate::study::axis::Axis;
use crate::study::batch::{Batch, Points, solve_all};
use crate::study::headline::{distinct, headline};
use crate::study::refusals::Refusals;
use crate::study::request::{PointsRequest, Request};
use crate::study::sweep::Grid;
use std::io;

pub(super) fn run(options: &Sweep, streams: &mut Streams) -> io::Result<Exit> {
    let grid = match Grid::parse(&options.vary, &options.points, options.log) {
        Ok(grid) => grid,
        Err((text, problem)) => {
            streams.say(&format!(
                "--vary {text}: {}: {}",
                problem.cause, problem.fix
            ));
            return Ok(Exit::Usage);
        }
    };
    let out = options.running.out.as_deref();
    if let Some(refusal) = overwrites(out, &[&options.case]) {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let edits = options.changes.edits();
    let keys: Vec<&str> = grid.axes.iter().map(Axis::key).collect();
    if let Some(refusal) = cases::set_and_varied(&edits.settings, &keys) {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let first = grid.axes.iter().map(|axis| (axis.field, axis.with_unit(0)));
    let first: Vec<(usize, String)> = first.collect();
    let opened = match cases::open_varied(&options.case, &edits, &first, streams) {
        Ok(opened) => opened,
        Err(exit) => return Ok(exit),
    };
    for sentence in idle(&grid, &opened) {
        streams.say(&sentence);
    }
    let quantities = quantities(options, &grid, &opened);
    let table = SweepTable {
        grid: &grid,
        quantities: &quantities,
        format: options.format.into(),
    };
    if let Some(shard) = options.running.shard {
        let request = request(options, &opened, &table);
        let batch = batch(&opened, &table);
        return shards::run(shard, &request, &batch, &options.running, streams);
    }
    match write(options, &opened, &table, streams) {
        Ok(refusals) => Ok(report(&table, &refusals, &opened.name, streams)),
        Err(failure) => failure.report(streams),
    }
}

/// Reports the refused points of a sweep that is written.
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
    if refusals.total() == count {
        Exit::BadCase
    } else {
        Exit::Done
    }
}

/// The study for the files of its shards.
fn request(options: &Sweep, opened: &Opened, table: &SweepTable) -> Request {
    Request {
        name: opened.name.clone(),
        case: opened.document.render(),
        quantities: table
            .quantities
            .iter()
            .map(|known| known.key.to_owned())
            .collect(),
        format: table.format.name().to_owned(),
        points: PointsRequest::Sweep {
            vary: options.vary.clone(),
            points: options.points.clone(),
            log: options.log,
        },
    }
}

fn batch<'a>(opened: &'a Opened, table: &SweepTable<'a>) -> Batch<'a> {
    Batch {
        inputs: &opened.inputs,
        points: table.grid,
        quantities: table.quantities,
    }
}

/// The varied fields that change no result.
fn idle(grid: &Grid, opened: &Opened) -> Vec<String> {
    let mut inputs = opened.inputs.clone();
    if grid.methods(&inputs).len() > 1 {
        return Vec::new();
    }
    grid.put(0, &mut inputs);
    let warning = |axis: &Axis| match relevance(axis.field, &inputs) {
        Acting::Yes => partial_relevance(axis.field, &inputs)
            .map(|why| format!("{}: {}: {why}", opened.name, axis.key())),
        Acting::No(why) | Acting::Beside(why) => {
            let (name, key) = (&opened.name, axis.key());
            Some(format!("{name}: {key} changes no quantity: {why}"))
        }
    };
    grid.axes.iter().filter_map(warning).collect()
}

/// The quantities that the user names, else the headline of every method of the grid.
fn quantities(options: &Sweep, grid: &Grid, opened: &Opened) -> Vec<&'static Quantity> {
    if !options.only.is_empty() {
        return distinct(options.only.iter().flatten().copied());
    }
    let methods: Vec<Method> = grid.methods(&opened.inputs);
    headline(&opened.document.case, &methods)
}

/// Solves the points and writes their rows as they arrive.
fn write(
    options: &Sweep,
    opened: &Opened,
    table: &SweepTable,
    streams: &mut Streams,
) -> Result<Refusals, Failure> {
    let out = options.running.out.as_deref();
    let mut sink = Sink::open(out, streams.output.as_mut()).map_err(Failure::File)?;
    let batch = batch(opened, table);
    let running = Running::new("points", options.running.jobs);
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
    if solved.is_err() {
        drop(sink);
        Running::end();
        return Err(Failure::Stream(io::ErrorKind::Interrupted.into()));
    }
    sink.finish().map(|()| refusals)
}
