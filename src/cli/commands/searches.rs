//! Commands that answer one question of one case: `seek`, `relief`, `stiffness`, `trade`.

use std::cell::Cell;

use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::options::{CaseFile, Destination, Edits, Threads, count, formats};
use crate::cli::output::{Done, Exit, Failure, follow};
use crate::model::Inputs;
use crate::numeric::decimal::shortest;
use crate::report::relief::ReliefReport;
use crate::report::seek::SeekReport;
use crate::report::stiffness::{StiffnessReport, no_field};
use crate::report::svg::draw;
use crate::study::axis::{AxisRange, Sampling, with_unit};
use crate::study::condition::Condition;
use crate::study::relief::{Criterion, Demand, NoRelief, demand, specify};
use crate::study::seek::{USUAL_SCAN, seek};
use crate::study::shard::Format;
use crate::study::stiffness::{LEAST_POINTS, MOST_POINTS, compare_flanks, compare_path};
use crate::study::trade::{self as study, STEADY};
use clap::{Args, ValueHint};
use std::io::Write;
use std::path::PathBuf;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Seek {
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
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json]))]
    pub format: Format,
    /// The threads
    #[command(flatten)]
    pub threads: Threads,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

impl Seek {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Seek { input, vary, until, points, destination, .. } = self;
        let bad_range = |problem| Failure::of_option("--vary", vary, &problem);
        let bad_condition = |problem| Failure::of_option("--until", until, &problem);
        let range = AxisRange::parse(vary).map_err(bad_range)?;
        let condition = Condition::parse(until).map_err(bad_condition)?;
        destination.check(&input.case)?;
        destination.fits(self.format)?;
        let first = (range.field, with_unit(&shortest(range.from), &range.unit));
        let mut opened = input.open(&[first], streams)?;
        opened.need(condition.quantity());
        streams.say_all(opened.without_effect(range.field, &opened.inputs));
        condition.check(opened.inputs.method).map_err(bad_condition)?;
        let scan = range.axis(Sampling { points: Some(*points), is_log: false });
        let scan = scan.map_err(bad_range)?;
        let found = follow("points", |go_on| {
            seek(&opened.inputs, &range, &condition, scan, &self.threads.control(go_on))
        })??;
        let report = SeekReport {
            method: opened.inputs.method.name(),
            range: &range,
            condition: &condition,
            found: &found,
        };
        destination.write(streams, |sink| opened.named().write(&report, self.format, sink))
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Relief {
    /// Loads that the relief must serve, in percent of the load of the case
    #[arg(
        long,
        value_name = "A..B",
        default_value = "25..110%",
        value_parser = demand::loads,
        allow_hyphen_values = true
    )]
    pub load: (f64, f64),
    /// Loads with their shares of the time, in place of the range, such as
    /// '50%:0.2, 100%:0.7, 130%:0.1'
    #[arg(
        long,
        value_name = "LOAD:SHARE,...",
        value_parser = Spectrum::parse,
        conflicts_with = "load",
        allow_hyphen_values = true
    )]
    pub spectrum: Option<Spectrum>,
    /// Manufacturing tolerance of each amount, plus and minus, such as '5 um'
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "5 um",
        value_parser = demand::tolerance,
        allow_hyphen_values = true
    )]
    pub tolerance: f64,
    /// Manufacturing tolerance of each length along the path of contact, plus and minus, such as
    /// '0.2 mm' (default: one step of a length)
    #[arg(
        long,
        value_name = "LENGTH",
        value_parser = demand::tolerance,
        allow_hyphen_values = true
    )]
    pub tolerance_length: Option<f64>,
    /// Deviation of the misalignment over the face width, plus and minus, such as '10 um'
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "0 um",
        value_parser = demand::tolerance,
        allow_hyphen_values = true
    )]
    pub misalignment: f64,
    /// The figure to minimise
    #[arg(long, value_name = "FIGURE", default_value = "te")]
    pub minimise: Criterion,
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json, Format::Csv]))]
    pub format: Format,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

/// The loads of a spectrum with their shares; one argument has all of them.
#[derive(Debug, Clone)]
pub struct Spectrum(Vec<(f64, f64)>);

impl Spectrum {
    fn parse(text: &str) -> Result<Spectrum, String> {
        demand::spectrum(text).map(Spectrum)
    }
}

impl Relief {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Relief { input, destination, .. } = self;
        destination.check(&input.case)?;
        if !destination.is_picture() {
            destination.fits(self.format)?;
        }
        let opened = input.open(&[], streams)?;
        let demand = Demand {
            loads: self.load,
            spectrum: self.spectrum.as_ref().map_or(Vec::new(), |spectrum| spectrum.0.clone()),
            tolerance: self.tolerance,
            tolerance_length: self.tolerance_length,
            misalignment: self.misalignment,
            minimise: self.minimise,
        };
        let found = follow("% of the budget", |go_on| {
            specify(&opened.inputs, &demand, &|part| go_on((100.0 * part) as usize, 100))
        })?;
        let found = found.map_err(|none| match none {
            NoRelief::Refused(refusal) => opened.refused(&refusal),
            none => opened.failed(&none),
        })?;
        let report = ReliefReport { method: opened.inputs.method, found: &found };
        if destination.is_picture() {
            let chart = report.chart(&opened.inputs).map_err(|reason| opened.failed(&reason))?;
            let picture = draw(&chart);
            return destination.write(streams, |sink| sink.write_all(picture.as_bytes()));
        }
        destination.write(streams, |sink| opened.named().write(&report, self.format, sink))
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Stiffness {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// The changes of the case
    #[command(flatten)]
    pub edits: Edits,
    /// Number of radii on each flank, from the form circle to the tip
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 9, value_parser = point_count)]
    pub points: usize,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json, Format::Csv]))]
    pub format: Format,
}

impl Stiffness {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let opened = cases::open(&self.case, &self.edits, &[], streams)?;
        let refused = |refusal| opened.refused(&refusal);
        let flanks = compare_flanks(&opened.inputs, self.points).map_err(refused)?;
        let path = compare_path(&opened.inputs, self.points).map_err(refused)?;
        let report = StiffnessReport { flanks: &flanks, path: &path };
        opened.named().write(&report, self.format, streams.output.as_mut())?;
        if self.format == Format::Csv {
            let (name, gears) = (&opened.name, flanks.gears.iter());
            streams
                .say_all(gears.filter_map(|gear| {
                    Some(format!("{name}: {}: {}", gear.gear, no_field(gear)?))
                }));
        }
        Ok(Exit::Done)
    }
}

/// Parses a number of radii on a flank.
fn point_count(text: &str) -> Result<usize, String> {
    let range = LEAST_POINTS..=MOST_POINTS;
    let count = text.parse().ok().filter(|count| range.contains(count));
    count.ok_or_else(|| format!("write a number from {LEAST_POINTS} to {MOST_POINTS}"))
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Trade {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// The changes of the case
    #[command(flatten)]
    pub edits: Edits,
    /// Greatest error of the recommended setting, such as 5% or 0.05 (default: model.within of
    /// the case)
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true, value_parser = part)]
    pub within: Option<f64>,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json]))]
    pub format: Format,
}

impl Trade {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let opened = cases::open(&self.case, &self.edits, &[], streams)?;
        let within = self.within.unwrap_or(opened.inputs.within);
        let inputs = Inputs { within, ..opened.inputs.clone() };
        let found = follow("settings", |report| {
            let (done, planned) = (Cell::new(0), Cell::new(1));
            let mut show = |sofar: &study::Trade| {
                done.set(sofar.settings.len());
                planned.set(sofar.planned);
            };
            let go_on = || report(done.get(), planned.get());
            study::trade(&inputs, STEADY, &go_on, &mut show)
        })?;
        let trade = found.map_err(|refusal| opened.refused(&refusal))?;
        opened.named().write(&trade, self.format, streams.output.as_mut())?;
        Ok(Exit::Done)
    }
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
