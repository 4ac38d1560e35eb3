//! `relief`: finds the tip relief to specify for a case.

use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{CaseFile, Changes, Destination, FormatOption, OutputFormat};
use crate::cli::output::{check_out, write_to};
use crate::cli::progress::follow;
use crate::report::specification::ReliefReport;
use crate::study::relief;
use crate::study::relief::{Demand, NoRelief, specify};
use clap::Args;

const AFTER_HELP: &str = "Corner contact counts before the start and after the end of the path of contact, at the greatest load, with \
    each relief off by the tolerance to either side. Among the reliefs without corner contact the command chooses the one with the \
    smallest maximum transmission error (peak to peak, at rest, without base pitch deviations) over six loads of the range. Amounts are \
    multiples of 0.5 um, lengths are round numbers. With method dynamic the motion must have no corner contact either. CSV has one row per choice \
    and point of the map, JSON is one object; both are in SI units.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// Loads that the relief must serve, in percent of the load of the case
    #[arg(
        long,
        value_name = "A..B",
        default_value = "25..110%",
        value_parser = relief::loads,
        allow_hyphen_values = true
    )]
    pub load: (f64, f64),
    /// Manufacturing tolerance of each relief, plus and minus, such as '5 um'
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "5 um",
        value_parser = relief::tolerance,
        allow_hyphen_values = true
    )]
    pub tolerance: f64,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<OutputFormat>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = options.destination.out.as_deref();
    check_out(out, &[&options.input.case])?;
    let opened = cases::open(&options.input.case, &options.changes.edits(), streams)?;
    let demand = Demand { loads: options.load, tolerance: options.tolerance };
    let found = follow("% of the budget", |report| {
        specify(&opened.inputs, &demand, &|part| report((100.0 * part) as usize, 100))
    });
    let found = found.map_err(|none| match none {
        NoRelief::Refused(refusal) => opened.refused(&refusal, streams),
        none => {
            streams.say(&format!("{}: {none}", opened.name));
            Exit::BadCase
        }
    })?;
    let report = ReliefReport {
        name: &opened.name,
        title: opened.document.case.title(),
        method: opened.inputs.method,
        found: &found,
    };
    write_to(out, streams.output.as_mut(), |sink| match options.output.format {
        OutputFormat::Text => report.write(sink),
        OutputFormat::Json => report.write_json(sink),
        OutputFormat::Csv => report.write_csv(sink),
    })?;
    Ok(Exit::Done)
}
