//! The values of a field at which a condition changes.

use super::cases::{self, Opened};
use super::progress::Running;
use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Listing, Seek, Streams};
use crate::case::fields::FIELDS;
use crate::numeric::decimal::shortest;
use crate::report::seek::SeekReport;
use crate::study::axis::{AxisRange, with_unit};
use crate::study::condition::Condition;
use crate::study::seek::{Found, Unfound, seek};
use std::io;

pub(super) fn run(options: &Seek, streams: &mut Streams) -> io::Result<Exit> {
    let (range, condition) = match question(options) {
        Ok(question) => question,
        Err(line) => {
            streams.say(&line);
            return Ok(Exit::Usage);
        }
    };
    let edits = options.changes.edits();
    let key = FIELDS[range.field].key;
    let out = options.out.as_deref();
    if let Some(refusal) =
        cases::set_and_varied(&edits.settings, &[key]).or_else(|| overwrites(out, &[&options.case]))
    {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let first = (range.field, with_unit(&shortest(range.from), &range.unit));
    let opened = match cases::open_varied(&options.case, &edits, &[first], streams) {
        Ok(opened) => opened,
        Err(exit) => return Ok(exit),
    };
    if let Err(problem) = condition.check(opened.inputs.method) {
        streams.say(&format!(
            "--until {}: {}: {}",
            options.until, problem.cause, problem.fix
        ));
        return Ok(Exit::Usage);
    }
    let running = Running::new("points", options.jobs);
    let found = running.run(|control| {
        match seek(&opened.inputs, &range, &condition, options.points, control) {
            Err(Unfound::Stopped) => Err(crate::study::batch::Stopped),
            Err(Unfound::Bad(problem)) => Ok(Err(problem)),
            Ok(found) => Ok(Ok(found)),
        }
    });
    match found {
        Err(_) => {
            Running::end();
            Err(io::ErrorKind::Interrupted.into())
        }
        Ok(Err(problem)) => {
            streams.say(&format!(
                "--vary {}: {}: {}",
                options.vary, problem.cause, problem.fix
            ));
            Ok(Exit::Usage)
        }
        Ok(Ok(found)) => write(options, &opened, (&range, &condition), &found, streams)
            .map(|()| Exit::Done)
            .or_else(|failure| failure.report(streams)),
    }
}

/// The range and the condition, or the line that says what is wrong with them.
fn question(options: &Seek) -> Result<(AxisRange, Condition), String> {
    let range = AxisRange::parse(&options.vary).map_err(|problem| {
        format!(
            "--vary {}: {}: {}",
            options.vary, problem.cause, problem.fix
        )
    })?;
    let condition = Condition::parse(&options.until).map_err(|problem| {
        format!(
            "--until {}: {}: {}",
            options.until, problem.cause, problem.fix
        )
    })?;
    Ok((range, condition))
}

fn write(
    options: &Seek,
    opened: &Opened,
    (range, condition): (&AxisRange, &Condition),
    found: &Found,
    streams: &mut Streams,
) -> Result<(), Failure> {
    let report = SeekReport {
        name: &opened.name,
        title: opened.document.case.title(),
        method: opened.inputs.method.name(),
        range,
        condition,
        found,
    };
    let out = options.out.as_deref();
    let mut sink = Sink::open(out, streams.output.as_mut()).map_err(Failure::File)?;
    let written = match options.format {
        Listing::Text => report.write(&mut sink),
        Listing::Json => report.write_json(&mut sink),
    };
    written.map_err(|error| sink.failure(error))?;
    sink.finish()
}
