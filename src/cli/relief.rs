//! The tip relief to specify for a case.

use super::cases::{self, Opened};
use super::progress::follow;
use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Format, Relief as Options, Streams};
use crate::report::specification::ReliefReport;
use crate::study::relief::{Demand, NoRelief, Specification, specify};
use std::io;

pub(super) fn run(options: &Options, streams: &mut Streams) -> io::Result<Exit> {
    let out = options.out.as_deref();
    if let Some(refusal) = overwrites(out, &[&options.case]) {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let opened = match cases::open(&options.case, &options.changes.edits(), streams) {
        Ok(opened) => opened,
        Err(exit) => return Ok(exit),
    };
    let demand = Demand {
        loads: options.load,
        tolerance: options.tolerance,
    };
    let found = follow("% of the budget", |report| {
        specify(&opened.inputs, &demand, &|part| {
            report((100.0 * part) as usize, 100)
        })
    });
    let found = match found {
        Ok(found) => found,
        Err(NoRelief::Refused(refusal)) => return Ok(opened.refused(&refusal, streams)),
        Err(none) => {
            streams.say(&format!("{}: {none}", opened.name));
            return Ok(Exit::BadCase);
        }
    };
    write(options, &opened, &found, streams)
        .map(|()| Exit::Done)
        .or_else(|failure| failure.report(streams))
}

fn write(
    options: &Options,
    opened: &Opened,
    found: &Specification,
    streams: &mut Streams,
) -> Result<(), Failure> {
    let report = ReliefReport {
        name: &opened.name,
        title: opened.document.case.title(),
        method: opened.inputs.method,
        found,
    };
    let out = options.out.as_deref();
    let mut sink = Sink::open(out, streams.output.as_mut()).map_err(Failure::File)?;
    let written = match options.format {
        Format::Text => report.write(&mut sink),
        Format::Json => report.write_json(&mut sink),
        Format::Csv => report.write_csv(&mut sink),
    };
    written.map_err(|error| sink.failure(error))?;
    sink.finish()
}
