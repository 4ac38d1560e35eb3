//! `seek`: finds the values of a field at which a condition changes.

use crate::case::fields::FIELDS;
use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{CaseFile, Changes, Destination, FormatOption, Listing, Threads, count};
use crate::cli::output::{check_out, write_to};
use crate::cli::progress::Running;
use crate::numeric::decimal::shortest;
use crate::report::seek::SeekReport;
use crate::study::axis::{AxisRange, with_unit};
use crate::study::condition::Condition;
use crate::study::seek::USUAL_SCAN;
use crate::study::seek::{SeekError, seek};
use clap::Args;

const AFTER_HELP: &str = "A crossing is a value at which the condition changes, with a bracket of 1e-9 of the value. `always` and `never` \
    are answers for the whole range. Without corner contact a quantity of the impact is below every limit. JSON is one object; its \
    numbers are in the unit of --vary, and those of the quantity in SI.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The field and its range, such as 'deviations.base_pitch=0..40 um'
    #[arg(long, value_name = "KEY=FROM..TO")]
    pub vary: String,
    /// The condition, such as 'impact_force<=2500 N', 'dynamic_contact_lost=true' or
    /// 'outcome=no-corner-contact'
    #[arg(long, value_name = "CONDITION")]
    pub until: String,
    /// Number of points of the first scan; a finer scan finds narrower regions
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SCAN, value_parser = count)]
    pub points: usize,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
    /// The threads
    #[command(flatten)]
    pub threads: Threads,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let (range, condition) = question(options)?;
    let edits = options.changes.edits();
    let key = FIELDS[range.field].key;
    let out = options.destination.out.as_deref();
    cases::keep_varied(&edits.settings, &[key])?;
    check_out(out, &[&options.input.case])?;
    let first = (range.field, with_unit(&shortest(range.from), &range.unit));
    let mut opened = cases::open_varied(&options.input.case, &edits, &[first], streams)?;
    opened.need(condition.quantity());
    if let Some(sentence) = opened.without_effect(range.field, &opened.inputs) {
        streams.say(&sentence);
    }
    condition
        .check(opened.inputs.method)
        .map_err(|problem| Failure::of_option("--until", &options.until, &problem))?;
    let running = Running::new("points", options.threads.jobs);
    let found = running
        .run(|control| seek(&opened.inputs, &range, &condition, options.points, control))
        .map_err(|unfound| match unfound {
            SeekError::Stopped => Failure::Interrupted,
            SeekError::Bad(problem) => Failure::of_option("--vary", &options.vary, &problem),
        })?;
    let report = SeekReport {
        name: &opened.name,
        title: opened.document.case.title(),
        method: opened.inputs.method.name(),
        range: &range,
        condition: &condition,
        found: &found,
    };
    write_to(out, streams.output.as_mut(), |sink| match options.output.format {
        Listing::Text => report.write(sink),
        Listing::Json => report.write_json(sink),
    })?;
    Ok(Exit::Done)
}

/// The range and the condition.
fn question(options: &Options) -> Result<(AxisRange, Condition), Failure> {
    let range = AxisRange::parse(&options.vary)
        .map_err(|problem| Failure::of_option("--vary", &options.vary, &problem))?;
    let condition = Condition::parse(&options.until)
        .map_err(|problem| Failure::of_option("--until", &options.until, &problem))?;
    Ok((range, condition))
}
