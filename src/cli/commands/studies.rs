//! Commands of studies: a sweep and a tolerance study, which can be split into shards, and questions
//! about one case.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::cli::options::{CaseFile, Destination, Only, StudyOptions, TABLES, count, formats};
use crate::cli::questions::{NoAnswer, Question, within};
use crate::cli::{Done, Exit, Failure, Opened, Streams, check_out, follow, write_text, write_to};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::page::is_picture;
use crate::report::studies::{self, Take};
use crate::report::svg::draw;
use crate::report::swept;
use crate::report::table::Named;
use crate::report::verdict::Absence;
use crate::study::axis::{ADDED, Axis, Grid, add_by_sign};
use crate::study::batch::{Points, Refusals, solve_all};
use crate::study::seek::headline;
use crate::study::shard::{
    Complete, Format, Header, Kind, PointsRequest, Request, ShardWriter, Study, in_order,
};
use crate::study::tolerance::{self, MOST_SAMPLES, Size, USUAL_SAMPLES};
use clap::Args;

/// Formats of a sweep.
const SWEPT: &[Format] = &[Format::Csv, Format::Json];

/// The options of the command.
#[derive(Debug, Args)]
pub struct Sweep {
    /// Vary a field over a range, such as 'operation.speed=500..3000 rpm', or over a list, such as
    /// 'driven.teeth=20,30,40'; of several fields the first varies slowest; fields with commas
    /// between them have the same values, such as 'driver.grade,driven.grade=5..9'
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
    /// Format of the output (default: csv, or that of the extension of --out)
    #[arg(long, value_parser = formats(SWEPT))]
    format: Option<Format>,
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
        let format = self.running.format(self.format, SWEPT, true)?.unwrap_or(Format::Csv);
        let of =
            |axis: &Axis| axis.fields().map(|field| (field, axis.with_unit(0))).collect::<Vec<_>>();
        let first = grid.axes.iter().flat_map(of);
        let mut opened = self.input.open(&first.collect::<Vec<_>>(), streams)?;
        let mut quantities = self.only.quantities();
        opened.need(quantities.iter().copied());
        streams.say_all(idle(&grid, &opened));
        let methods = grid.methods(&opened.inputs);
        if quantities.is_empty() {
            quantities = headline(&opened.document.case, &methods);
            if methods.contains(&Method::Auto) {
                streams.say(
                    "auto selects the method of each point (column method); an empty cell belongs \
                     to another method",
                );
            }
        } else if methods.contains(&Method::Auto) {
            let in_motion = |known: &&&Quantity| !Method::Static.stages().has(known.stage);
            streams.say_all(quantities.iter().filter(in_motion).map(|known| {
                let key = known.key;
                format!(
                    "{key}: if the choice of auto (column method) lacks it, dynamic computes it"
                )
            }));
        }
        streams.say_all(absent(&quantities, &grid, &opened));
        streams.say_all(add_by_sign(&grid.axes, &opened.inputs).then(|| ADDED.to_owned()));
        let points = PointsRequest::Sweep { vary: vary.clone(), points: points.clone(), log: *log };
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
    drop(grid.writer()(0, &mut inputs));
    let fields = grid.axes.iter().flat_map(Axis::fields);
    fields.filter_map(|field| opened.without_effect(field, &inputs)).collect()
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
    /// Format of the output (default: text, or that of the extension of --out)
    #[arg(long, value_parser = formats(TABLES))]
    format: Option<Format>,
    /// How the study runs
    #[command(flatten)]
    running: StudyOptions,
}

impl Tolerance {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Tolerance { samples, seed, ranking, .. } = *self;
        let size = within("samples", samples, 2, MOST_SAMPLES);
        size.map_err(|misuse| Failure::misused(&misuse))?;
        self.running.destination.check(&self.input.case)?;
        let format = self.running.format(self.format, TABLES, false)?.unwrap_or(Format::Text);
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
        let (request, quantities) = ((format, points), study.quantities.clone());
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
        self.destination.format(None, &[format], format == Format::Csv)?;
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
    let mut refusals = Refusals::default();
    let is_drawn = out.is_some_and(is_picture);
    let is_table = matches!(study.kind, Kind::Sweep(_)) || study.request.format == Format::Csv;
    if is_table && !is_drawn {
        write_to(out, streams, |sink| studies::write(study, rows, sink).map(|all| refusals = all))?;
    } else {
        // Figures take time, during which a signal must still end the program; therefore they are
        // complete before the file is created.
        let mut text = Vec::new();
        refusals = studies::write(study, rows, &mut text)?;
        if is_drawn {
            let name = study.request.name.as_str();
            let caption = Named { name, title: study.case.title() }.caption();
            let csv = String::from_utf8_lossy(&text);
            let drawn = swept::picture(&csv, &study.quantities, &caption);
            let (drawn, remark) = drawn.map_err(|reason| Failure::of_case(name, &reason))?;
            streams.say_all(remark.map(|remark| format!("{name}: {remark}")));
            text = drawn.into_bytes();
        }
        write_to(out, streams, |sink| sink.write_all(&text))?;
    }
    for refused in &refusals.0 {
        streams.say(&format!("{}: {}", study.request.name, refused.sentence(study.points())));
    }
    let is_all = refusals.total() == study.points().count();
    Ok(if is_all { Exit::BadCase } else { Exit::Done })
}

/// The options of a command that asks a question about one case.
#[derive(Debug, Args)]
pub struct Asked<Q: Args + Question> {
    /// The question
    #[command(flatten)]
    question: Q,
    /// The case
    #[command(flatten)]
    input: CaseFile,
    /// Format of the output (default: text, or that of the extension of --out)
    #[arg(long, value_parser = formats(Q::FORMATS))]
    format: Option<Format>,
    /// The file
    #[command(flatten)]
    destination: Destination,
}

impl<Q: Args + Question> Asked<Q> {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let Asked { question, input, format, destination } = self;
        let varied = question.varied().map_err(|misuse| Failure::misused(&misuse))?;
        destination.check(&input.case)?;
        let format = destination.format(*format, Q::FORMATS, Q::IS_DRAWN)?;
        let opened = input.open(&varied, streams)?;
        let inputs = &opened.inputs;
        streams
            .say_all(varied.iter().filter_map(|(field, _)| opened.without_effect(*field, inputs)));
        let found = follow(Q::PARTS, |go_on| question.answer(inputs, go_on))?;
        let found = found.map_err(|none| match none {
            NoAnswer::Misused(misuse) => Failure::misused(&misuse),
            NoAnswer::Refused(refusal) => opened.refused(&refusal),
            NoAnswer::Failed(reason) => opened.failed(&reason),
        })?;
        let out = destination.out.as_deref();
        if let Some(chart) = found.picture(inputs).filter(|_| format.is_none()) {
            if let Ok(chart) = &chart {
                write_text(out, streams, &draw(chart, &opened.named().caption()))?;
            }
            let done = opened.write(&*found, Format::Text, None, streams)?;
            return chart.map(|_| done).map_err(|reason| opened.failed(&reason));
        }
        opened.write(&*found, format.unwrap_or(Format::Text), out, streams)?;
        if format == Some(Format::Csv) {
            let remarks = found.remarks().into_iter();
            streams.say_all(remarks.map(|remark| format!("{}: {remark}", opened.name)));
        }
        Ok(Exit::Done)
    }
}
