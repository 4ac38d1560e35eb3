//! A case whose fields are spread around their values.

use super::cases::{self, Opened};
use super::progress::Running;
use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Format, Streams, Tolerance as Options};
use crate::case::Problem;
use crate::report::tolerance::{ToleranceReport, is_all_refused};
use crate::study::tolerance::{MOST_SAMPLES, Samples, Size, Tolerance};
use std::io;

pub(super) fn run(options: &Options, streams: &mut Streams) -> io::Result<Exit> {
    let out = options.running.out.as_deref();
    if let Some(refusal) = size_problem(options).or_else(|| overwrites(out, &[&options.case])) {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let opened = match cases::open(&options.case, &options.changes.settings(), streams) {
        Ok(opened) => opened,
        Err(exit) => return Ok(exit),
    };
    let study = match study(options, &opened) {
        Ok(study) => study,
        Err(problem) => {
            opened.report_problem(problem, streams);
            return Ok(Exit::BadCase);
        }
    };
    let running = Running::new("solves", options.running.jobs);
    let Ok(samples) = running.run(|control| study.run(&opened.inputs, control)) else {
        Running::end();
        return Err(io::ErrorKind::Interrupted.into());
    };
    match write(options, &opened, &study, &samples, streams) {
        Ok(()) if is_all_refused(&samples) => Ok(Exit::BadCase),
        Ok(()) => Ok(Exit::Done),
        Err(failure) => failure.report(streams),
    }
}

fn size_problem(options: &Options) -> Option<String> {
    let is_possible = (2..=MOST_SAMPLES).contains(&options.samples);
    (!is_possible).then(|| {
        let samples = options.samples;
        format!("--samples {samples}: write a number from 2 to {MOST_SAMPLES}")
    })
}

fn study(options: &Options, opened: &Opened) -> Result<Tolerance, Problem> {
    let only: Vec<_> = options.only.iter().flatten().copied().collect();
    let size = Size {
        samples: options.samples,
        seed: options.seed,
        ranked: options.ranking,
    };
    Tolerance::of(&opened.document.case, &opened.inputs, &only, size)
}

fn write(
    options: &Options,
    opened: &Opened,
    study: &Tolerance,
    samples: &Samples,
    streams: &mut Streams,
) -> Result<(), Failure> {
    let report = ToleranceReport {
        name: &opened.name,
        case: &opened.document.case,
        method: opened.inputs.method.name(),
        study,
        samples,
    };
    for refused in &samples.refusals.0 {
        streams.say(&format!("{}: {}", opened.name, report.refused(refused)));
    }
    let out = options.running.out.as_deref();
    let mut sink = Sink::open(out, streams.output.as_mut()).map_err(Failure::File)?;
    let written = match options.format {
        Format::Text => report.write(&mut sink),
        Format::Json => report.write_json(&mut sink),
        Format::Csv => report.write_csv(&mut sink),
    };
    written.map_err(|error| sink.failure(error))?;
    sink.finish()
}
