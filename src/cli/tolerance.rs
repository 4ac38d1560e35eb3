//! A case whose fields are spread around their values.

use super::cases::{self, Opened};
use super::progress::Running;
use super::sink::{Failure, Sink, overwrites};
use super::{Exit, Format, Streams, Tolerance as Options, shards};
use crate::case::Problem;
use crate::report::tolerance::{ToleranceReport, is_all_refused};
use crate::study::batch::Batch;
use crate::study::request::{PointsRequest, Request};
use crate::study::tolerance::{MOST_SAMPLES, Size, Tolerance};
use std::io::{self, Write};

pub(super) fn run(options: &Options, streams: &mut Streams) -> io::Result<Exit> {
    let out = options.running.out.as_deref();
    if let Some(refusal) = size_problem(options).or_else(|| overwrites(out, &[&options.case])) {
        streams.say(&refusal);
        return Ok(Exit::Usage);
    }
    let opened = match cases::open(&options.case, &options.changes.edits(), streams) {
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
    if let Some(shard) = options.running.shard {
        let request = request(options, &opened, &study);
        let batch = Batch {
            inputs: &opened.inputs,
            points: &study.design,
            quantities: &study.quantities,
        };
        return shards::run(shard, &request, &batch, &options.running, streams);
    }
    let running = Running::new("solves", options.running.jobs);
    let Ok(samples) = running.run(|control| study.run(&opened.inputs, control)) else {
        Running::end();
        return Err(io::ErrorKind::Interrupted.into());
    };
    let whole = ToleranceReport {
        name: &opened.name,
        case: &opened.document.case,
        method: opened.inputs.method.name(),
        study: &study,
        samples: &samples,
    };
    match write(options, &whole, streams) {
        Ok(()) => Ok(report(&whole, streams)),
        Err(failure) => failure.report(streams),
    }
}

/// Reports the refused samples of a study that is written.
pub(super) fn report(whole: &ToleranceReport, streams: &mut Streams) -> Exit {
    for refused in &whole.samples.refusals.0 {
        streams.say(&format!("{}: {}", whole.name, whole.refused(refused)));
    }
    if is_all_refused(whole.samples) {
        Exit::BadCase
    } else {
        Exit::Done
    }
}

/// The study for the files of its shards.
fn request(options: &Options, opened: &Opened, study: &Tolerance) -> Request {
    Request {
        name: opened.name.clone(),
        case: opened.document.render(),
        quantities: study
            .quantities
            .iter()
            .map(|known| known.key.to_owned())
            .collect(),
        format: name_of(options.format).to_owned(),
        points: PointsRequest::Tolerance {
            samples: study.design.samples,
            seed: study.design.seed,
            ranked: study.design.ranked,
        },
    }
}

/// The name of a format on the command line.
fn name_of(format: Format) -> &'static str {
    match format {
        Format::Text => "text",
        Format::Json => "json",
        Format::Csv => "csv",
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

fn write(options: &Options, whole: &ToleranceReport, streams: &mut Streams) -> Result<(), Failure> {
    let out = options.running.out.as_deref();
    let mut sink = Sink::open(out, streams.output.as_mut()).map_err(Failure::File)?;
    write_as(name_of(options.format), whole, &mut sink).map_err(|error| sink.failure(error))?;
    sink.finish()
}

/// Writes a study in the format of that name.
pub(super) fn write_as(
    format: &str,
    whole: &ToleranceReport,
    out: &mut dyn Write,
) -> io::Result<()> {
    match format {
        "json" => whole.write_json(out),
        "csv" => whole.write_csv(out),
        _ => whole.write(out),
    }
}
