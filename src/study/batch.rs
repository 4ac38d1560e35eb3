//! Solves the points of a study in parallel, returns their rows in order, and counts the refused
//! points by their reason.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::Duration;

use crate::case::{Evaluator, Problem, violated_rule};
use crate::model::{Inputs, Outcome, Quantity, Refusal, Solution, Stages};

/// How often the progress is reported.
const TICK: Duration = Duration::from_millis(50);

/// The points of a study.
pub trait Points: Sync {
    /// The number of points.
    fn count(&self) -> usize;

    /// A point as settings, such as `operation.speed = 500 rpm, driven.tip_relief = 16 um`.
    fn point(&self, _index: usize) -> String {
        String::new()
    }

    /// A function that writes points into inputs on one thread.
    fn sequence(&self) -> Sequence<'_>;
}

/// Writes the values of the point with an index into inputs of the case or of another point. Fails
/// if a field does not accept its value.
pub type Sequence<'a> = Box<dyn FnMut(usize, &mut Inputs) -> Result<(), Problem> + 'a>;

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
    /// Whether to continue. Every thread calls it at every point and during a long solve.
    pub go_on: &'a (dyn Fn() -> bool + Sync),
    /// Receives the number of solved points and the total, about twenty times a second.
    pub progress: &'a dyn Fn(usize, usize),
}

impl Control<'static> {
    /// All cores, without cancellation and without progress.
    pub const PLAIN: Control<'static> =
        Control { jobs: None, go_on: &|| true, progress: &|_, _| {} };
}

/// How a point ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointOutcome {
    /// The model solved the point.
    Solved(Outcome),
    /// The case or the model refuses the point.
    Refused,
}

impl PointOutcome {
    /// Every outcome.
    pub const ALL: [PointOutcome; 3] = [
        PointOutcome::Solved(Outcome::CornerContact),
        PointOutcome::Solved(Outcome::NoCornerContact),
        PointOutcome::Refused,
    ];

    /// The name in a report.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            PointOutcome::Solved(outcome) => outcome.name(),
            PointOutcome::Refused => "refused",
        }
    }
}

/// Consecutive points with their results.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Rows {
    /// Index of the first point.
    pub first: usize,
    /// How each point ended.
    pub outcomes: Vec<PointOutcome>,
    /// Values in SI, point by point; NaN marks an absent value.
    values: Vec<f64>,
    /// Index and reason of each refused point.
    pub refusals: Vec<(usize, Problem)>,
}

impl Rows {
    /// No rows yet; the first row to add has index `first`.
    #[must_use]
    pub fn starting_at(first: usize) -> Rows {
        Rows { first, ..Rows::default() }
    }

    /// Adds a row with the values of every quantity.
    pub fn push(&mut self, outcome: PointOutcome, values: impl IntoIterator<Item = Option<f64>>) {
        self.outcomes.push(outcome);
        let values = values.into_iter().map(|value| value.unwrap_or(f64::NAN));
        self.values.extend(values);
    }

    /// The values of every quantity, point by point; NaN marks an absent value.
    #[must_use]
    pub fn all_values(&self) -> &[f64] {
        &self.values
    }

    /// The indices of the points.
    #[must_use]
    pub fn range(&self) -> Range<usize> {
        self.first..self.first + self.outcomes.len()
    }

    /// The values of a row in the order of the quantities.
    pub fn values(&self, row: usize) -> impl Iterator<Item = Option<f64>> {
        let width = self.values.len().checked_div(self.outcomes.len()).unwrap_or(0);
        let cells = &self.values[row * width..(row + 1) * width];
        cells.iter().map(|&value| Some(value).filter(|value| !value.is_nan()))
    }

    /// Why a row was refused.
    #[must_use]
    pub fn refusal(&self, row: usize) -> Option<&Problem> {
        let index = self.first + row;
        let at = self.refusals.binary_search_by_key(&index, |(at, _)| *at);
        at.ok().map(|at| &self.refusals[at].1)
    }
}

/// The study was stopped before its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stopped;

/// Solves the points of a range and passes their rows to `take` in order, as soon as they are
/// ready. The rows do not depend on the number of threads. `take` returns whether to continue.
///
/// # Errors
/// [`Stopped`] if [`Control::go_on`] or `take` returns false.
pub fn solve_all(
    batch: &Batch,
    range: Range<usize>,
    control: &Control,
    take: &mut dyn FnMut(Rows) -> bool,
) -> Result<(), Stopped> {
    let jobs = jobs(control.jobs);
    let shared = Shared {
        batch: *batch,
        chunks: chunks(&range, jobs),
        range,
        next: AtomicUsize::new(0),
        stopped: AtomicBool::new(false),
        go_on: control.go_on,
    };
    let solved: Vec<Solved> =
        (0..jobs.min(shared.chunks.len())).map(|_| Solved::default()).collect();
    let (send, receive) = mpsc::channel();
    std::thread::scope(|scope| {
        for solved in &solved {
            let (shared, send) = (&shared, send.clone());
            scope.spawn(move || work(shared, &solved.0, &send));
        }
        drop(send);
        collect((&shared, &solved), &receive, control, take)
    })
}

/// The number of threads of a study.
#[must_use]
pub fn jobs(wanted: Option<usize>) -> usize {
    let cores = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    wanted.unwrap_or_else(cores).max(1)
}

/// State that the threads of a study share.
struct Shared<'a> {
    batch: Batch<'a>,
    range: Range<usize>,
    chunks: Vec<Range<usize>>,
    next: AtomicUsize,
    stopped: AtomicBool,
    go_on: &'a (dyn Fn() -> bool + Sync),
}

/// The number of points that a thread has solved, in a cache line of its own: the threads count
/// every point, and one line for all of them would take a tenth of a closed-form study.
#[derive(Default)]
#[repr(align(128))]
struct Solved(AtomicUsize);

impl Shared<'_> {
    fn goes_on(&self) -> bool {
        !self.stopped.load(Ordering::Relaxed) && (self.go_on)()
    }
}

/// Orders the chunks and reports the progress.
fn collect(
    (shared, solved): (&Shared, &[Solved]),
    receive: &Receiver<(usize, Rows)>,
    control: &Control,
    take: &mut dyn FnMut(Rows) -> bool,
) -> Result<(), Stopped> {
    let (mut early, mut next) = (BTreeMap::new(), 0);
    while next < shared.chunks.len() {
        match receive.recv_timeout(TICK) {
            Ok((chunk, rows)) => drop(early.insert(chunk, rows)),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return Err(Stopped),
        }
        while let Some(rows) = early.remove(&next) {
            next += 1;
            if !take(rows) {
                shared.stopped.store(true, Ordering::Relaxed);
                return Err(Stopped);
            }
        }
        let done = solved.iter().map(|solved| solved.0.load(Ordering::Relaxed));
        (control.progress)(done.sum(), shared.range.len());
        if !shared.goes_on() {
            shared.stopped.store(true, Ordering::Relaxed);
            return Err(Stopped);
        }
    }
    Ok(())
}

/// One thread: solves chunks until none is left.
fn work(shared: &Shared, solved: &AtomicUsize, send: &Sender<(usize, Rows)>) {
    let mut solver = PointSolver::new(shared.batch);
    loop {
        let chunk = shared.next.fetch_add(1, Ordering::Relaxed);
        let Some(points) = shared.chunks.get(chunk) else {
            return;
        };
        let mut rows = Rows::starting_at(points.start);
        rows.outcomes.reserve(points.len());
        rows.values.reserve(points.len() * shared.batch.quantities.len());
        for index in points.clone() {
            if solver.solve(index, &mut rows, &|| shared.goes_on()) == Err(Stopped) {
                return;
            }
            // No other thread writes this number.
            solved.store(solved.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
        }
        if send.send((chunk, rows)).is_err() {
            return;
        }
    }
}

/// Solves points one after the other; a stage with unchanged inputs reuses its result.
struct PointSolver<'a> {
    batch: Batch<'a>,
    sequence: Sequence<'a>,
    inputs: Inputs,
    evaluator: Evaluator,
    wanted: Stages,
}

impl<'a> PointSolver<'a> {
    fn new(batch: Batch<'a>) -> PointSolver<'a> {
        let stages = batch.quantities.iter();
        PointSolver {
            sequence: batch.points.sequence(),
            inputs: batch.inputs.clone(),
            evaluator: Evaluator::default(),
            wanted: stages
                .fold(Stages::NONE, |stages, quantity| stages.and(Stages::of(quantity.stage))),
            batch,
        }
    }

    /// Adds the row of a point. A quantity that is absent refuses the point as it refuses a plain
    /// solve.
    fn solve(
        &mut self,
        index: usize,
        rows: &mut Rows,
        go_on: &dyn Fn() -> bool,
    ) -> Result<(), Stopped> {
        if !go_on() {
            return Err(Stopped);
        }
        let quantities = self.batch.quantities;
        let refused = match self.point(index, go_on) {
            Ok(solution) => {
                let values = || quantities.iter().map(|quantity| quantity.finite_value(solution));
                match solution.withheld {
                    Some(refusal) if values().any(|value| value.is_none()) => refusal.into(),
                    _ => {
                        rows.push(PointOutcome::Solved(solution.outcome), values());
                        return Ok(());
                    }
                }
            }
            Err(refused) => refused,
        };
        let Unsolved::Refused(problem) = refused else { return Err(Stopped) };
        rows.push(PointOutcome::Refused, quantities.iter().map(|_| None));
        rows.refusals.push((index, problem.at_given_diameter(&self.inputs)));
        Ok(())
    }

    fn point(&mut self, index: usize, go_on: &dyn Fn() -> bool) -> Result<&Solution, Unsolved> {
        (self.sequence)(index, &mut self.inputs)?;
        // No quantity reads the stations.
        self.inputs.stations = Some(1);
        let wanted = self.wanted.and(self.inputs.method.deciding_stages());
        if let Some(problem) = violated_rule(&self.inputs) {
            return Err(problem.into());
        }
        let (inputs, method) = (&self.inputs, self.inputs.method);
        Ok(self.evaluator.solve_kept(inputs, method, wanted, &|_| go_on())?)
    }
}

enum Unsolved {
    Refused(Problem),
    Stopped,
}

impl From<Problem> for Unsolved {
    fn from(problem: Problem) -> Unsolved {
        Unsolved::Refused(problem)
    }
}

impl From<Refusal> for Unsolved {
    fn from(refusal: Refusal) -> Unsolved {
        match refusal {
            Refusal::Stopped => Unsolved::Stopped,
            refused => Unsolved::Refused(Problem::from(&refused)),
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
    /// The reason at the first point.
    pub problem: Problem,
}

impl Refused {
    /// The refused points in one sentence.
    #[must_use]
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
    pub fn count(&mut self, rows: &Rows) {
        for (first, problem) in &rows.refusals {
            let is_same = |other: &&mut Refused| other.problem.is_like(problem);
            match self.0.iter_mut().find(is_same) {
                Some(same) => same.count += 1,
                None => self.0.push(Refused { count: 1, first: *first, problem: problem.clone() }),
            }
        }
    }

    /// How many points are refused.
    #[must_use]
    pub fn total(&self) -> usize {
        self.0.iter().map(|refused| refused.count).sum()
    }
}

/// Greatest number of points of a chunk.
const LONGEST: usize = 8192;

/// A chunk is this fraction of a thread's share of the remaining points, so that the last chunks
/// are short and no thread waits long for another.
const PARTS_OF_SHARE: usize = 4;

/// The shortest chunk is this fraction of a thread's share of all points: each chunk wakes the
/// thread that collects the rows.
const MOST_PARTS: usize = 1024;

/// The chunks of a range for a number of threads, in order.
pub(super) fn chunks(range: &Range<usize>, jobs: usize) -> Vec<Range<usize>> {
    let shortest = (range.len() / (jobs * MOST_PARTS)).clamp(1, LONGEST);
    let after = |first: usize| {
        let part = (range.end - first) / (jobs * PARTS_OF_SHARE);
        first..(first + part.clamp(shortest, LONGEST)).min(range.end)
    };
    let is_left = |chunk: &Range<usize>| !chunk.is_empty();
    std::iter::successors(Some(after(range.start)), |chunk| Some(after(chunk.end)))
        .take_while(is_left)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_the_range_once_and_end_with_short_ones() {
        for (range, jobs) in [(0..0, 2), (7..8, 4), (3..100_003, 2), (0..1_000, 64)] {
            let found = chunks(&range, jobs);
            let ends = found.iter().map(|chunk| chunk.end);
            let firsts: Vec<usize> = found.iter().map(|chunk| chunk.start).collect();
            let expected: Vec<usize> = std::iter::once(range.start).chain(ends).collect();
            assert_eq!(firsts, expected[..found.len()]);
            assert_eq!(expected.last(), Some(&range.end));
            let short = 1.max(range.len() / (jobs * MOST_PARTS));
            let is_short = |chunk: &Range<usize>| chunk.len() <= short;
            assert!(found.last().is_none_or(is_short), "{found:?}");
            assert!(found.iter().all(|chunk| chunk.len() <= LONGEST));
        }
    }
}
