//! `stiffness`: compares the stiffness models over both flanks of a case with finite elements.

use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{CaseFile, Edits, FormatOption, OutputFormat};
use crate::report::stiffness::{StiffnessReport, no_field, write, write_csv, write_json};
use crate::study::stiffness::compare;
use crate::study::stiffness::{LEAST_POINTS, MOST_POINTS};
use clap::Args;

const AFTER_HELP: &str = "The finite elements are plane strain on the whole gear, as in tooth_compliance = \"finite-element\". CSV: one row \
    per gear and radius, in SI units; a cell is empty where a model does not cover the gear. JSON: one object in SI units; missing \
    values are absent, and gaps and refusal give the reason.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The changes of the case
    #[command(flatten)]
    pub edits: Edits,
    /// Number of radii on each flank, from the form circle to the tip
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 9, value_parser = point_count)]
    pub points: usize,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<OutputFormat>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let opened = cases::open(&options.input.case, &options.edits, streams)?;
    let comparison = compare(&opened.inputs, options.points)
        .map_err(|refusal| opened.refused(&refusal, streams))?;
    let Opened { name, document, .. } = &opened;
    let report = StiffnessReport { name, title: document.case.title(), comparison: &comparison };
    match options.output.format {
        OutputFormat::Text => write(&report, streams.output.as_mut())?,
        OutputFormat::Json => write_json(&report, streams.output.as_mut())?,
        OutputFormat::Csv => {
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

/// Parses a number of radii on a flank.
fn point_count(text: &str) -> Result<usize, String> {
    let range = LEAST_POINTS..=MOST_POINTS;
    let count = text.parse().ok().filter(|count| range.contains(count));
    count.ok_or_else(|| format!("write a number from {LEAST_POINTS} to {MOST_POINTS}"))
}
