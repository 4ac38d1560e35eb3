//! The stiffness models over both flanks of a case beside finite elements.

use super::cases::{self, Opened};
use super::{Exit, Format, Stiffness, Streams};
use crate::report::stiffness::{StiffnessReport, no_field, write, write_csv, write_json};
use crate::study::stiffness::compare;
use std::io;

pub(super) fn run(options: &Stiffness, streams: &mut Streams) -> io::Result<Exit> {
    let opened = match cases::open(&options.case, &options.edits, streams) {
        Ok(opened) => opened,
        Err(exit) => return Ok(exit),
    };
    let comparison = match compare(&opened.inputs, options.points) {
        Ok(comparison) => comparison,
        Err(refusal) => return Ok(opened.refused(&refusal, streams)),
    };
    let Opened { name, document, .. } = &opened;
    let report = StiffnessReport {
        name,
        title: document.case.title(),
        comparison: &comparison,
    };
    match options.format {
        Format::Text => write(&report, streams.output.as_mut())?,
        Format::Json => write_json(&report, streams.output.as_mut())?,
        Format::Csv => {
            write_csv(&comparison, streams.output.as_mut())?;
            for gear in &comparison.gears {
                if let Some(sentence) = no_field(gear) {
                    streams.say(&format!("{name}: {}: {sentence}", gear.gear));
                }
            }
        }
    }
    Ok(Exit::Done)
}
