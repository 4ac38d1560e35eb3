//! Commands of studies that can be split into shards: `sweep`, `tolerance`, `gather`.

use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use crate::cli::Streams;
use crate::cli::cases::Opened;
use crate::cli::options::{CaseFile, Destination, Only, StudyOptions, count, formats};
use crate::cli::output::{Done, Exit, Failure, check_out, follow, write_to};
use crate::model::Quantity;
use crate::report::absence::Absence;
use crate::report::export::is_picture;
use crate::report::results::Named;
use crate::report::svg::draw;
use crate::report::sweep::{self, RowWriter};
use crate::report::tolerance::ToleranceReport;
use crate::study::axis::Axis;
use crate::study::batch::{Points, Refusals, Row, solve_all};
use crate::study::condition::headline;
use crate::study::shard::{
    Complete, Format, Header, Kind, PointsRequest, Request, ShardWriter, Study, in_order,
};
use crate::study::sweep::Grid;
use crate::study::tolerance::{self, MOST_SAMPLES, Samples, Size, USUAL_SAMPLES};
use clap::{Args, ValueHint};

/// The options of the command.
#[derive(Debug, Args)]
pub struct Sweep {
    /// Vary a field over a range, such as 'operation.speed=500..3000 rpm', or over a list, such as
    /// 'driven.teeth=20,30,40'; of several fields the first varies slowest
    #[arg(long, required = true, value_name = "KEY=FROM..TO")]
    pub vary: Vec<String>,
    /// Number of points of each range, both ends included; default 101, or every whole number.
    /// Given once for all ranges, or once for each
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub points: Vec<usize>,
    /// Use equal ratios between the points of a range instead of equal steps
    #[arg(long)]
    pub log: bool,
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The quantities
    #[command(flatten)]
    pub only: Only,
    /// Format of the output
    #[arg(long, default_value = "csv", value_parser = formats([Format::Csv, Format::Json]))]
    pub format: Format,
    /// How the study runs
    #[command(flatten)]
    pub running: StudyOptions,
}

impl Sweep {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Sweep { vary, points, log, .. } = self;
        let grid = Grid::parse(vary, points, *log)
            .map_err(|(text, problem)| Failure::of_option("--vary", text, &problem))?;
        self.running.destination.check(&self.input.case)?;
        let is_drawn = self.running.destination.is_picture();
        if !is_drawn {
            self.running.destination.fits(self.format)?;
        }
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
    pub samples: usize,
    /// Seed of the samples; the same seed gives the same samples
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// Number of samples for the ranking of the fields (default: 4096, at most --samples; 0: no
    /// ranking). Each sample needs one solve per field, plus one
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub ranking: Option<usize>,
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The quantities
    #[command(flatten)]
    pub only: Only,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json, Format::Csv]))]
    pub format: Format,
    /// How the study runs
    #[command(flatten)]
    pub running: StudyOptions,
}

impl Tolerance {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Tolerance { samples, seed, ranking, .. } = *self;
        if !(2..=MOST_SAMPLES).contains(&samples) {
            let fix = format!("--samples {samples}: write a number from 2 to {MOST_SAMPLES}");
            return Err(Failure::usage(fix));
        }
        self.running.destination.check(&self.input.case)?;
        self.running.destination.fits(self.format)?;
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
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
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
        if !(self.destination.is_picture() && study.request.format == Format::Csv) {
            self.destination.fits(study.request.format)?;
        }
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
                let drawn = sweep::drawn(&String::from_utf8_lossy(&table), &study.quantities);
                let name = &study.request.name;
                let drawn = drawn
                    .map_err(|reason| Failure::new(Exit::BadCase, format!("{name}: {reason}")))?;
                write_to(out, streams, |sink| sink.write_all(draw(&drawn).as_bytes()))?;
            } else {
                write_to(out, streams, |sink| write(sink))?;
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
