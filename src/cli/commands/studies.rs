//! Commands of studies: a sweep and a tolerance study, which can be split into shards, and questions
//! about one case.

use std::cell::Cell;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::cli::options::{
    CaseFile, Destination, Edits, Only, StudyOptions, TABLES, Threads, WORDS, count, formats,
};
use crate::cli::{
    self, Done, Exit, Failure, Opened, Streams, check_out, follow, write_text, write_to,
};
use crate::model::{Inputs, Quantity};
use crate::numeric::decimal::shortest;
use crate::report::page::is_picture;
use crate::report::studies::{self, RowWriter, SeekReport, StiffnessReport};
use crate::report::svg::draw;
use crate::report::table::Named;
use crate::report::tolerance::ToleranceReport;
use crate::report::verdict::Absence;
use crate::study::axis::{Axis, AxisRange, Grid, Sampling};
use crate::study::batch::{Points, Refusals, Row, solve_all, with_unit};
use crate::study::excitation::{Excitation as Exported, POINTS};
use crate::study::relief::{Criterion, Demand, NoRelief, demand, specify};
use crate::study::seek::{Condition, USUAL_SCAN, headline, seek};
use crate::study::shard::{
    Complete, Format, Header, Kind, PointsRequest, Request, ShardWriter, Study, in_order,
};
use crate::study::stiffness::{LEAST_POINTS, MOST_POINTS, compare_flanks, compare_path};
use crate::study::tolerance::{self, MOST_SAMPLES, Samples, Size, USUAL_SAMPLES};
use crate::study::trade::{self, STEADY};
use clap::Args;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Sweep {
    /// Vary a field over a range, such as 'operation.speed=500..3000 rpm', or over a list, such as
    /// 'driven.teeth=20,30,40'; of several fields the first varies slowest
    #[arg(long, required = true, value_name = "KEY=FROM..TO")]
    vary: Vec<String>,
    /// Number of points of each range, both ends included; default 101, or every whole number.
    /// Give it once for all ranges, or once for each
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    points: Vec<usize>,
    /// Use equal ratios between the points of a range instead of equal steps
    #[arg(long)]
    log: bool,
    /// The case
    #[command(flatten)]
    input: CaseFile,
    /// The quantities
    #[command(flatten)]
    only: Only,
    /// Format of the output
    #[arg(long, default_value = "csv", value_parser = formats([Format::Csv, Format::Json]))]
    format: Format,
    /// How the study runs
    #[command(flatten)]
    running: StudyOptions,
}

impl Sweep {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Sweep { vary, points, log, .. } = self;
        let grid = Grid::parse(vary, points, *log)
            .map_err(|(text, problem)| Failure::of_option("--vary", text, &problem))?;
        self.running.destination.check(&self.input.case)?;
        let is_drawn = self.running.destination.is_picture();
        self.running.destination.fits(self.format, self.format == Format::Csv)?;
        let first = grid.axes.iter().map(|axis| (axis.field, axis.with_unit(0)));
        let mut opened = self.input.open(&first.collect::<Vec<_>>(), streams)?;
        let mut quantities = self.only.quantities();
        opened.need(quantities.iter().copied());
        streams.say_all(idle(&grid, &opened));
        if quantities.is_empty() {
            quantities = headline(&opened.document.case, &grid.methods(&opened.inputs));
        }
        streams.say_all(absent(&quantities, &grid, &opened));
        let points = PointsRequest::Sweep { vary: vary.clone(), points: points.clone(), log: *log };
        let format = if is_drawn { Format::Csv } else { self.format };
        let study = of_case(opened, quantities, (format, points), Kind::Sweep(grid));
        run_study(&study, &self.running, streams)
    }
}

/// The quantities that no method of the sweep computes.
fn absent(quantities: &[&Quantity], grid: &Grid, opened: &Opened) -> Vec<String> {
    let methods = grid.methods(&opened.inputs);
    let absent = quantities.iter().filter_map(|quantity| {
        let mut reasons = methods.iter().map(|&method| Absence::by_method(quantity, method));
        let reason = reasons.next()??;
        let is_absent = reasons.all(|reason| reason.is_some());
        is_absent.then(|| format!("{} has no values: {reason}", quantity.key))
    });
    absent.collect()
}

/// The varied fields that change no result.
fn idle(grid: &Grid, opened: &Opened) -> Vec<String> {
    let mut inputs = opened.inputs.clone();
    if grid.methods(&inputs).len() > 1 {
        return Vec::new();
    }
    // The values of a grid are checked when it is made.
    drop(grid.put(0, &mut inputs));
    let warning = |axis: &Axis| opened.without_effect(axis.field, &inputs);
    grid.axes.iter().filter_map(warning).collect()
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Tolerance {
    /// Number of samples
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SAMPLES, value_parser = count)]
    samples: usize,
    /// Seed of the samples; the same seed gives the same samples
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
    /// Number of samples for the ranking of the fields (default: 4096, at most --samples; 0: no
    /// ranking). Each sample needs one solve per field, plus one
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    ranking: Option<usize>,
    /// The case
    #[command(flatten)]
    input: CaseFile,
    /// The quantities
    #[command(flatten)]
    only: Only,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(TABLES))]
    format: Format,
    /// How the study runs
    #[command(flatten)]
    running: StudyOptions,
}

impl Tolerance {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Tolerance { samples, seed, ranking, .. } = *self;
        if !(2..=MOST_SAMPLES).contains(&samples) {
            let fix = format!("--samples {samples}: write a number from 2 to {MOST_SAMPLES}");
            return Err(Failure::usage(fix));
        }
        self.running.destination.check(&self.input.case)?;
        self.running.destination.fits(self.format, false)?;
        let mut opened = self.input.open(&[], streams)?;
        let only = self.only.quantities();
        opened.need(only.iter().copied());
        let size = Size { samples, seed, ranked: ranking };
        let study = tolerance::Tolerance::of(&opened.document.case, &opened.inputs, &only, size);
        let study = study.map_err(|problem| opened.faulty(problem))?;
        for spread in &study.design.distributions {
            streams.say_all(opened.without_effect(spread.field, &opened.inputs));
        }
        let points = PointsRequest::Tolerance { samples, seed, ranked: study.design.ranked };
        let (request, quantities) = ((self.format, points), study.quantities.clone());
        let study = of_case(opened, quantities, request, Kind::Tolerance(study));
        run_study(&study, &self.running, streams)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Gather {
    /// Files that --shard wrote, in any order
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The file
    #[command(flatten)]
    destination: Destination,
}

impl Gather {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let files: Vec<&Path> = self.files.iter().map(AsRef::as_ref).collect();
        let out = self.destination.out.as_deref();
        check_out(out, &files)?;
        let gathered = files.iter().map(|file| Complete::read(file)).collect::<Result<_, _>>();
        let shards = gathered.and_then(in_order).map_err(|error| match error.kind() {
            ErrorKind::InvalidData => Failure::new(Exit::BadCase, error),
            _ => Failure::new(Exit::Unreadable, error),
        })?;
        let Header { shard, request, .. } = &shards[0].header;
        let study = Study::restore(request)
            .map_err(|problem| Failure::new(Exit::BadCase, format!("shard {shard}: {problem}")))?;
        let format = study.request.format;
        self.destination.fits(format, format == Format::Csv)?;
        let count = study.points().count();
        write_study(&study, out, streams, |take| {
            shards
                .iter()
                .try_for_each(|shard| shard.rows(shard.header.shard.range(count).start, take))
        })
    }
}

fn of_case(
    opened: Opened,
    quantities: Vec<&'static Quantity>,
    (format, points): (Format, PointsRequest),
    kind: Kind,
) -> Study {
    let case = opened.document.render();
    let keys = quantities.iter().map(|known| known.key.to_owned()).collect();
    let Opened { name, document, inputs, .. } = opened;
    let request = Request { name, case, quantities: keys, format, points };
    Study { request, case: document.case, inputs, quantities, kind }
}

/// Receives the rows of a study in order.
type Take<'a> = &'a mut dyn FnMut(usize, &[Row]) -> io::Result<()>;

/// Solves the points of a study and writes the results, or writes one of its shards.
fn run_study(study: &Study, options: &StudyOptions, streams: &mut Streams) -> Done {
    let out = options.destination.out.as_deref();
    let what = match (&study.kind, options.shard) {
        (Kind::Tolerance(_), None) => "solves",
        _ => "points",
    };
    let count = study.points().count();
    // A stop is an interrupted write.
    let solve = |range, take: Take| {
        let mut written = Ok(());
        let solved = follow(what, |go_on| {
            let control = options.threads.control(go_on);
            solve_all(&study.batch(), range, &control, &mut |first, rows| {
                written = take(first, rows);
                written.is_ok()
            })
        });
        written?;
        if matches!(solved, Ok(Ok(()))) { Ok(()) } else { Err(ErrorKind::Interrupted.into()) }
    };
    let Some(shard) = options.shard else {
        return write_study(study, out, streams, |take| solve(0..count, take));
    };
    write_to(out, streams, |sink| {
        let mut writer = ShardWriter::begin(shard, &study.request, sink)?;
        solve(shard.range(count), &mut |_, rows| writer.write(rows))?;
        writer.finish()
    })
}

/// Writes the results of a study and reports its refused points. Rows are written as they arrive.
fn write_study(
    study: &Study,
    out: Option<&Path>,
    streams: &mut Streams,
    rows: impl FnOnce(Take) -> io::Result<()>,
) -> Done {
    let refusals = match (&study.kind, study.request.format) {
        (Kind::Tolerance(tolerance), format) if format != Format::Csv => {
            let mut samples = Samples::of(tolerance);
            rows(&mut |first, rows| {
                samples.add(first, rows);
                Ok(())
            })?;
            let report = ToleranceReport {
                case: &study.case,
                method: study.inputs.method,
                study: tolerance,
                samples: &samples,
            };
            // The figures take time, during which a signal must still end the program; therefore
            // they are complete before the file is created.
            let mut figures = Vec::new();
            let case = Named { name: &study.request.name, title: study.case.title() };
            case.write(&report, format, &mut figures)?;
            write_to(out, streams, |sink| sink.write_all(&figures))?;
            samples.refusals
        }
        _ => {
            let (writer, mut refusals) = (RowWriter(study), Refusals::default());
            let write = |sink: &mut dyn Write| {
                writer.begin(sink)?;
                rows(&mut |first, rows| {
                    refusals.count(first, rows);
                    writer.write(first, rows, sink)
                })
            };
            if out.is_some_and(is_picture) {
                let mut table = Vec::new();
                write(&mut table)?;
                let drawn = studies::drawn(&String::from_utf8_lossy(&table), &study.quantities);
                let name = &study.request.name;
                let drawn = drawn.map_err(|reason| Failure::of_case(name, &reason))?;
                write_text(out, streams, &draw(&drawn))?;
            } else {
                write_to(out, streams, write)?;
            }
            refusals
        }
    };
    for refused in &refusals.0 {
        streams.say(&format!("{}: {}", study.request.name, refused.sentence(study.points())));
    }
    let is_all = refusals.total() == study.points().count();
    Ok(if is_all { Exit::BadCase } else { Exit::Done })
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Seek {
    /// The field and its range, such as 'deviations.base_pitch=0..40 um'
    #[arg(long, value_name = "KEY=FROM..TO")]
    vary: String,
    /// The condition, such as 'impact_force<=2500 N', 'dynamic_contact_lost=true' or
    /// 'outcome=no-corner-contact'
    #[arg(long, value_name = "CONDITION")]
    until: String,
    /// Number of points of the first scan; a finer scan finds narrower regions
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SCAN, value_parser = count)]
    points: usize,
    /// The case
    #[command(flatten)]
    input: CaseFile,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(WORDS))]
    format: Format,
    /// The threads
    #[command(flatten)]
    threads: Threads,
    /// The file
    #[command(flatten)]
    destination: Destination,
}

impl Seek {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Seek { input, vary, until, points, destination, .. } = self;
        let bad_range = |problem| Failure::of_option("--vary", vary, &problem);
        let bad_condition = |problem| Failure::of_option("--until", until, &problem);
        let range = AxisRange::parse(vary).map_err(bad_range)?;
        let condition = Condition::parse(until).map_err(bad_condition)?;
        destination.check(&input.case)?;
        destination.fits(self.format, false)?;
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
        opened.write(&report, self.format, destination.out.as_deref(), streams)
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
    load: (f64, f64),
    /// Loads with their shares of the time, in place of the range, such as
    /// '50%:0.2, 100%:0.7, 130%:0.1'
    #[arg(
        long,
        value_name = "LOAD:SHARE,...",
        value_parser = Spectrum::parse,
        conflicts_with = "load",
        allow_hyphen_values = true
    )]
    spectrum: Option<Spectrum>,
    /// Manufacturing tolerance of each amount, plus and minus, such as '5 um'
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "5 um",
        value_parser = demand::tolerance,
        allow_hyphen_values = true
    )]
    tolerance: f64,
    /// Manufacturing tolerance of each length along the path of contact, plus and minus, such as
    /// '0.2 mm' (default: one step of a length)
    #[arg(
        long,
        value_name = "LENGTH",
        value_parser = demand::tolerance,
        allow_hyphen_values = true
    )]
    tolerance_length: Option<f64>,
    /// Deviation of the misalignment over the face width, plus and minus, such as '10 um'
    #[arg(
        long,
        value_name = "LENGTH",
        default_value = "0 um",
        value_parser = demand::tolerance,
        allow_hyphen_values = true
    )]
    misalignment: f64,
    /// The figure to minimise
    #[arg(long, value_name = "FIGURE", default_value = "te")]
    minimise: Criterion,
    /// The case
    #[command(flatten)]
    input: CaseFile,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(TABLES))]
    format: Format,
    /// The file
    #[command(flatten)]
    destination: Destination,
}

/// The loads of a spectrum with their shares; one argument has all of them.
#[derive(Debug, Clone)]
struct Spectrum(Vec<(f64, f64)>);

impl Spectrum {
    fn parse(text: &str) -> Result<Spectrum, String> {
        demand::spectrum(text).map(Spectrum)
    }
}

impl Relief {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Relief { input, destination, .. } = self;
        destination.check(&input.case)?;
        destination.fits(self.format, true)?;
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
        if destination.is_picture() {
            let chart = found.chart(&opened.inputs).map_err(|reason| opened.failed(&reason))?;
            return write_text(destination.out.as_deref(), streams, &draw(&chart));
        }
        opened.write(&found, self.format, destination.out.as_deref(), streams)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Stiffness {
    /// Case file; - is standard input
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// The changes of the case
    #[command(flatten)]
    edits: Edits,
    /// Number of radii on each flank, from the form circle to the tip
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 9, value_parser = count_within::<LEAST_POINTS, MOST_POINTS>)]
    points: usize,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(TABLES))]
    format: Format,
}

impl Stiffness {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let opened = cli::open(&self.case, &self.edits, &[], streams)?;
        let refused = |refusal| opened.refused(&refusal);
        let flanks = compare_flanks(&opened.inputs, self.points).map_err(refused)?;
        let path = compare_path(&opened.inputs, self.points).map_err(refused)?;
        let report = StiffnessReport { flanks: &flanks, path: &path };
        opened.write(&report, self.format, None, streams)?;
        if self.format == Format::Csv {
            let (name, gears) = (&opened.name, flanks.gears.iter());
            streams.say_all(
                gears.filter_map(|gear| {
                    Some(format!("{name}: {}: {}", gear.gear, gear.no_field()?))
                }),
            );
        }
        Ok(Exit::Done)
    }
}

/// Parses a number of points between two limits.
fn count_within<const LEAST: usize, const MOST: usize>(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (LEAST..=MOST).contains(count));
    count.ok_or_else(|| format!("write a number from {LEAST} to {MOST}"))
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Excitation {
    /// The case
    #[command(flatten)]
    input: CaseFile,
    /// Number of places in a base pitch
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = POINTS[1], value_parser = count_within::<{ POINTS[0] }, { POINTS[2] }>)]
    points: usize,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(TABLES))]
    format: Format,
    /// The file
    #[command(flatten)]
    destination: Destination,
}

impl Excitation {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Excitation { input, destination, .. } = self;
        destination.check(&input.case)?;
        destination.fits(self.format, false)?;
        let opened = input.open(&[], streams)?;
        let found = follow("places", |go_on| Exported::of(&opened.inputs, self.points, go_on))?;
        let found = found.map_err(|refusal| opened.refused(&refusal))?;
        opened.write(&found, self.format, destination.out.as_deref(), streams)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Trade {
    /// Case file; - is standard input
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// The changes of the case
    #[command(flatten)]
    edits: Edits,
    /// Greatest error of the recommended setting, such as 5% or 0.05 (default: model.within of
    /// the case)
    #[arg(long, value_name = "ERROR", allow_hyphen_values = true, value_parser = part)]
    within: Option<f64>,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats(WORDS))]
    format: Format,
}

impl Trade {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let opened = cli::open(&self.case, &self.edits, &[], streams)?;
        let within = self.within.unwrap_or(opened.inputs.within);
        let inputs = Inputs { within, ..opened.inputs.clone() };
        let found = follow("settings", |report| {
            let (done, planned) = (Cell::new(0), Cell::new(1));
            let mut show = |sofar: &trade::Trade| {
                done.set(sofar.settings.len());
                planned.set(sofar.planned);
            };
            let go_on = || report(done.get(), planned.get());
            trade::trade(&inputs, STEADY, &go_on, &mut show)
        })?;
        let trade = found.map_err(|refusal| opened.refused(&refusal))?;
        opened.write(&trade, self.format, None, streams)
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
