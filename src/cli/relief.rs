//! The tip relief to specify for a case.

use super::cases::{self, Opened};
use super::progress::{Bar, Interrupt};
use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Format, Relief as Options, Streams};
use crate::case::fields::index_of;
use crate::model::Refusal;
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
    let (bar, interrupt) = (Bar::new("% of the budget"), Interrupt::heeded());
    let found = specify(&opened.inputs, &demand, &|part| {
        bar.set((100.0 * part) as usize, 100);
        interrupt.go_on()
    });
    bar.clear();
    let found = match found {
        Ok(found) => found,
        Err(NoRelief::Refused(Refusal::Stopped)) => {
            Interrupt::end();
            return Err(io::ErrorKind::Interrupted.into());
        }
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
        title: index_of("title")
            .and_then(|field| opened.document.case.text(field))
            .unwrap_or_default(),
        method: opened.inputs.method.name(),
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
