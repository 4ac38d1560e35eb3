//! Solves the points of a study in parallel, returns their rows in order, and counts the refused
//! points by their reason.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use crate::case::{Evaluator, Problem, violated_rule};
use crate::model::inputs::Method;
use crate::model::{Inputs, Outcome, Quantity, Refusal, Stages};
use serde::{Deserialize, Serialize};
use smallvec::{SmallVec, smallvec};

/// How often the progress is reported.
const TICK: Duration = Duration::from_millis(50);
/// Number of chunks per thread. Progress and remaining time count whole chunks, and the last chunks
/// are short, so that no thread waits long for another. 512 chunks cost no more time than 64.
const CHUNKS: usize = 512;
/// Greatest number of points of a chunk.
const LONGEST: usize = 1024;

/// A number and its unit, in the syntax of a case file.
pub fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") }
}

/// See [`Points::writer`].
pub type Writer<'a> = Box<dyn FnMut(usize, &mut Inputs) -> Result<(), Problem> + 'a>;

/// The points of a study.
pub trait Points: Sync {
    /// The number of points.
    fn count(&self) -> usize;

    /// A point as settings, such as `operation.speed = 500 rpm, driven.tip_relief = 16 um`.
    fn point(&self, index: usize) -> String {
        let values = self.columns().into_iter().zip(self.cells(index));
        let settings =
            values.map(|((key, unit), value)| format!("{key} = {}", with_unit(&value, unit)));
        settings.collect::<Vec<_>>().join(", ")
    }

    /// The columns that describe a point: name and unit, which is empty for texts.
    fn columns(&self) -> Vec<(String, &str)> {
        Vec::new()
    }

    /// The cells of a point in these columns.
    fn cells(&self, _index: usize) -> Vec<String> {
        Vec::new()
    }

    /// Whether the points differ only in load and deviations.
    fn have_same_gears(&self) -> bool {
        false
    }

    /// A function that writes the values of a point into inputs of the case or of another point. It
    /// returns an error if a field does not accept its value.
    fn writer(&self) -> Writer<'_>;
}

/// A study: one case, its points, and the quantities to compute at each.
#[derive(Clone, Copy)]
pub struct Batch<'a> {
    /// The case.
    pub inputs: &'a Inputs,
    /// The points.
    pub points: &'a dyn Points,
    /// The quantities; no others are computed.
    pub quantities: &'a [&'static Quantity],
}

/// How a study runs and how the caller follows it.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Number of threads; by default one per core.
    pub jobs: Option<usize>,
    /// Receives the number of solved points and the total, about twenty times a second, and returns
    /// whether to continue.
    pub go_on: &'a dyn Fn(usize, usize) -> bool,
}

impl Control<'static> {
    /// All cores, without cancellation and without progress.
    pub const PLAIN: Control<'static> = Control { jobs: None, go_on: &|_, _| true };
}

/// How a point ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum PointOutcome {
    /// The model solved the point.
    Solved(#[serde(with = "SolvedOutcome")] Outcome),
    /// The case or the model refuses the point.
    Refused,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Outcome")]
enum SolvedOutcome {
    CornerContact,
    NoCornerContact,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Method")]
enum SolvedMethod {
    Paper,
    Exact,
    Static,
    Dynamic,
    Auto,
}

impl PointOutcome {
    /// The name in a report.
    pub fn name(self) -> &'static str {
        match self {
            PointOutcome::Solved(outcome) => outcome.name(),
            PointOutcome::Refused => "refused",
        }
    }
}

/// The quantities of a point; one or two are stored in place.
pub type RowValues = SmallVec<[Option<f64>; 2]>;

/// The results of a point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// The outcome at the entry.
    pub outcome: PointOutcome,
    /// The outcome at the exit, if the method computes it.
    pub exit_outcome: Option<PointOutcome>,
    /// The method that solved the point, or the requested method of a refused point.
    #[serde(with = "SolvedMethod")]
    pub method: Method,
    /// The quantities in SI, in their order; none of a refused point has a value.
    pub values: RowValues,
    /// Why the point is refused.
    pub refusal: Option<Box<Problem>>,
}

/// Solves the points of a range and passes their rows, with the index of the first of them, to
/// `take` in order, as soon as they are ready. The rows do not depend on the number of threads.
/// `take` returns whether to continue.
///
/// # Errors
/// [`Refusal::Stopped`] if [`Control::go_on`] or `take` returns false.
pub fn solve_all(
    batch: &Batch,
    range: Range<usize>,
    control: &Control,
    take: &mut dyn FnMut(usize, &[Row]) -> bool,
) -> Result<(), Refusal> {
    let jobs = jobs(control.jobs);
    let size = (range.len() / (jobs * CHUNKS)).clamp(1, LONGEST);
    let (next, is_stopped) = (AtomicUsize::new(range.start), AtomicBool::new(false));
    let (send, receive) = mpsc::channel::<(usize, Vec<Row>)>();
    let work = |send: mpsc::Sender<_>| {
        let mut solver = PointSolver::new(batch);
        let goes_on = || !is_stopped.load(Ordering::Relaxed);
        loop {
            let first = next.fetch_add(size, Ordering::Relaxed);
            let chunk = first..range.end.min(first + size);
            let rows = chunk.map(|index| solver.solve(index, &goes_on));
            let Ok(rows) = rows.collect::<Result<Vec<Row>, Refusal>>() else { return };
            if rows.is_empty() || send.send((first, rows)).is_err() {
                return;
            }
        }
    };
    let collect = &mut || {
        let (mut early, mut next, mut done) = (BTreeMap::new(), range.start, 0);
        while next < range.end {
            if !(control.go_on)(done, range.len()) {
                return Err(Refusal::Stopped);
            }
            match receive.recv_timeout(TICK) {
                Ok((first, rows)) => {
                    done += rows.len();
                    early.insert(first, rows);
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Err(Refusal::Stopped),
            }
            while let Some(rows) = early.remove(&next) {
                if !take(next, &rows) {
                    return Err(Refusal::Stopped);
                }
                next += rows.len();
            }
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs.min(range.len()) {
            let (work, send) = (&work, send.clone());
            scope.spawn(move || work(send));
        }
        drop(send);
        let collected = collect();
        is_stopped.store(true, Ordering::Relaxed);
        collected
    })
}

/// The number of threads of a study.
pub fn jobs(wanted: Option<usize>) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    wanted.unwrap_or_else(cores).max(1)
}

/// Solves points one after the other; a stage with unchanged inputs reuses its result.
struct PointSolver<'a> {
    batch: &'a Batch<'a>,
    write: Writer<'a>,
    inputs: Inputs,
    evaluator: Evaluator,
    wanted: Stages,
}

impl<'a> PointSolver<'a> {
    fn new(batch: &'a Batch<'a>) -> PointSolver<'a> {
        let stages = batch.quantities.iter().map(|quantity| quantity.stages());
        PointSolver {
            batch,
            write: batch.points.writer(),
            // No quantity reads the stations.
            inputs: Inputs { stations: Some(1), ..batch.inputs.clone() },
            evaluator: Evaluator::new(batch.points.have_same_gears()),
            wanted: stages.fold(Stages::NONE, Stages::and),
        }
    }

    fn solve(&mut self, index: usize, goes_on: &dyn Fn() -> bool) -> Result<Row, Refusal> {
        match self.row(index, goes_on) {
            _ if !goes_on() => Err(Refusal::Stopped),
            Ok(row) => Ok(row),
            Err(problem) => Ok(Row {
                outcome: PointOutcome::Refused,
                exit_outcome: None,
                method: self.inputs.method,
                values: smallvec![None; self.batch.quantities.len()],
                refusal: Some(Box::new(problem.at_given_diameter(&self.inputs))),
            }),
        }
    }

    /// The row of a solved point. A quantity that is absent refuses the point as it refuses a
    /// plain solve.
    fn row(&mut self, index: usize, goes_on: &dyn Fn() -> bool) -> Result<Row, Problem> {
        let (quantities, inputs) = (self.batch.quantities, &mut self.inputs);
        (self.write)(index, inputs)?;
        inputs.stations = Some(1);
        // The rules are of the gears, and the case does not violate them.
        if !self.evaluator.has_same_gears
            && let Some(problem) = violated_rule(inputs)
        {
            return Err(problem);
        }
        let wanted = self.wanted.and(inputs.method.deciding_stages());
        let solved = self.evaluator.solve_kept(inputs, inputs.method, wanted, &|_| goes_on());
        let solved = solved.map_err(|refusal| Problem::from(&refusal))?;
        let values: RowValues =
            quantities.iter().map(|quantity| quantity.finite_value(solved)).collect();
        match solved.withheld.filter(|_| values.contains(&None)) {
            Some(refusal) => Err(Problem::from(&refusal)),
            None => Ok(Row {
                outcome: PointOutcome::Solved(solved.outcome),
                exit_outcome: solved.exit_outcome().map(PointOutcome::Solved),
                method: solved.method,
                values,
                refusal: None,
            }),
        }
    }
}

/// Refused points whose problems differ only in their numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// Number of points.
    pub count: usize,
    /// Index of the first point.
    pub first: usize,
    /// The problem of the first point.
    pub problem: Problem,
}

impl Refused {
    /// The refused points in one sentence.
    pub fn sentence(&self, points: &dyn Points) -> String {
        let Refused { count, first, problem } = self;
        let which = if *count == 1 { "" } else { "the first " };
        let (of, point) = (points.count(), points.point(*first));
        format!("{count} of {of} points refused, {which}at {point}: {problem}")
    }
}

/// Every reason, in the order of the first points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Refusals(pub Vec<Refused>);

impl Refusals {
    /// Counts the refused points of these rows.
    pub fn count(&mut self, first: usize, rows: &[Row]) {
        for (index, row) in (first..).zip(rows) {
            let Some(problem) = row.refusal.as_deref() else { continue };
            match self.0.iter_mut().find(|other| other.problem.is_like(problem)) {
                Some(same) => same.count += 1,
                None => self.0.push(Refused { count: 1, first: index, problem: problem.clone() }),
            }
        }
    }

    /// How many points are refused.
    pub fn total(&self) -> usize {
        self.0.iter().map(|refused| refused.count).sum()
    }
}
