//! Commands that answer one question of one case: `seek`, `relief`, `stiffness`, `trade`.

use std::cell::Cell;

use crate::case::fields::FIELDS;
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::options::{
    CaseFile, Changes, Destination, Edits, FormatOption, Listing, OutputFormat, Threads, count,
};
use crate::cli::output::{Exit, Failure, Running, check_out, follow, write_to};
use crate::numeric::decimal::shortest;
use crate::report::seek::SeekReport;
use crate::report::specification::ReliefReport;
use crate::report::stiffness::{StiffnessReport, no_field, write, write_csv, write_json};
use crate::report::trade::{self, TradeReport};
use crate::study::axis::{AxisRange, with_unit};
use crate::study::condition::Condition;
use crate::study::relief::{self, Demand, NoRelief, specify};
use crate::study::seek::{SeekError, USUAL_SCAN, seek};
use crate::study::stiffness::{LEAST_POINTS, MOST_POINTS, compare};
use crate::study::trade::{STEADY, Trade, TradeParameters, trade};
use clap::Args;

const SEEK_HELP: &str = "A crossing is a value at which the condition changes, with a bracket of 1e-9 of the value. `always` and `never` \
    are answers for the whole range. Without corner contact a quantity of the impact is below every limit. JSON is one object; its \
    numbers are in the unit of --vary, and those of the quantity in SI.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = SEEK_HELP)]
pub struct SeekOptions {
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

pub(super) fn run_seek(options: &SeekOptions, streams: &mut Streams) -> Result<Exit, Failure> {
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
fn question(options: &SeekOptions) -> Result<(AxisRange, Condition), Failure> {
    let range = AxisRange::parse(&options.vary)
        .map_err(|problem| Failure::of_option("--vary", &options.vary, &problem))?;
    let condition = Condition::parse(&options.until)
        .map_err(|problem| Failure::of_option("--until", &options.until, &problem))?;
    Ok((range, condition))
}

const RELIEF_HELP: &str = "Corner contact counts before the start and after the end of the path of contact, at the greatest load, with \
    each relief off by the tolerance to either side. Among the reliefs without corner contact the command chooses the one with the \
    smallest maximum transmission error (peak to peak, at rest, without base pitch deviations) over six loads of the range. Amounts are \
    multiples of 0.5 um, lengths are round numbers. With method dynamic the motion must have no corner contact either. CSV has one row per choice \
    and point of the map, JSON is one object; both are in SI units.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = RELIEF_HELP)]
pub struct ReliefOptions {
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

pub(super) fn run_relief(options: &ReliefOptions, streams: &mut Streams) -> Result<Exit, Failure> {
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

const STIFFNESS_HELP: &str = "The finite elements are plane strain on the whole gear, as in tooth_compliance = \"finite-element\". CSV: one row \
    per gear and radius, in SI units; a cell is empty where a model does not cover the gear. JSON: one object in SI units; missing \
    values are absent, and gaps and refusal give the reason.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = STIFFNESS_HELP)]
pub struct StiffnessOptions {
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

pub(super) fn run_stiffness(
    options: &StiffnessOptions,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let opened = cases::open(&options.input.case, &options.edits, streams)?;
    let comparison = compare(&opened.inputs, options.points)
        .map_err(|refusal| opened.refused(&refusal, streams))?;
    let Opened { name, document, .. } = &opened;
    let report = StiffnessReport { name, title: document.case.title(), comparison: &comparison };
    match options.output.format {
        OutputFormat::Text => write(&report, streams.output.as_mut())?,
        OutputFormat::Json => write_json(&report, streams.output.as_mut())?,
        OutputFormat::Csv => {
            write_csv(&comparison.flanks, streams.output.as_mut())?;
            for gear in &comparison.flanks.gears {
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

const TRADE_HELP: &str = "Each setting is timed on this machine. Its total error is the greatest relative difference of first contact, \
    forces and curve from the finest setting of method dynamic. The model error is that of the finest setting of the same method; \
    the rest is numerical. Where no method finds corner contact, no setting is recommended. JSON is one object in SI units; missing \
    values are absent.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = TRADE_HELP)]
pub struct TradeOptions {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The changes of the case
    #[command(flatten)]
    pub edits: Edits,
    /// Greatest error of the recommended setting, such as 5% or 0.05 (default: model.within of
    /// the case)
    #[arg(long, value_name = "ERROR", allow_negative_numbers = true, value_parser = part)]
    pub within: Option<f64>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run_trade(options: &TradeOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let opened = cases::open(&options.input.case, &options.edits, streams)?;
    let parameters = TradeParameters {
        within: options.within.unwrap_or(opened.inputs.within),
        patience: STEADY,
    };
    let found = follow("settings", |report| {
        let (done, planned) = (Cell::new(0), Cell::new(1));
        let mut show = |sofar: &Trade| {
            done.set(sofar.settings.len());
            planned.set(sofar.planned);
        };
        let go_on = || report(done.get(), planned.get());
        trade(&opened.inputs, &parameters, &go_on, &mut show)
    });
    let trade = found.map_err(|refusal| opened.refused(&refusal, streams))?;
    let report =
        TradeReport { name: &opened.name, title: opened.document.case.title(), trade: &trade };
    match options.output.format {
        Listing::Text => trade::write(&report, streams.output.as_mut())?,
        Listing::Json => trade::write_json(&report, streams.output.as_mut())?,
    }
    Ok(Exit::Done)
}

/// Parses a fraction: "5%" or 0.05.
fn part(text: &str) -> Result<f64, String> {
    let (number, whole) =
        text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |number| (number.trim(), 100.0));
    let value = number
        .parse::<f64>()
        .ok()
        .map(|number| number / whole)
        .filter(|part| part.is_finite() && *part > 0.0);
    value.ok_or_else(|| "write a number above 0, such as 5% or 0.05".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_written_with_or_without_its_sign() {
        assert_eq!((part("5%"), part("0.05"), part(" 0.5 % ")), (Ok(0.05), Ok(0.05), Ok(0.005)));
        assert!(
            ["", "%", "five", "-1%", "0", "nan", "inf%"].iter().all(|text| part(text).is_err())
        );
    }
}
