//! The worker of the studies: sends their results as they arrive.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::latest::{Running, Send, Worker};
use crate::case::Problem;
use crate::model::Quantity;
use crate::report::tolerance::ToleranceReport;
use crate::study::batch::{self, Batch, Control, Points, Rows, Stopped, solve_all};
use crate::study::design::Design;
use crate::study::refusals::Refusals;
use crate::study::sweep::Grid;
use crate::study::tolerance::{Samples, Size, Tolerance};
use crate::tui::actions::Action;
use crate::tui::study::{
    End, Found, GridParameters, Layer, LayerFound, SAMPLES, StudyParameters, StudyPart,
    StudyRequest, ToleranceParameters,
};

/// Time between two messages of a grid.
const STEP: Duration = Duration::from_millis(40);
/// Time between two messages of a tolerance study, whose summary takes longer.
const PAGE_STEP: Duration = Duration::from_millis(250);

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(send: Send) -> io::Result<Worker<StudyRequest>> {
    Worker::start("study", send, study, |request| {
        let reason = "internal error: the study failed".to_owned();
        action(request, Found::Nothing, Some(End::Failed(reason)))
    })
}

/// Computes a study to its end and sends its results.
pub fn study(request: &StudyRequest, running: Running<'_>) {
    let done = match &request.parameters {
        StudyParameters::Grid(grid) => solve_grid(request, grid, running),
        StudyParameters::Tolerance(tolerance) => sample(request, tolerance, running),
    };
    let end = match done {
        Ok(()) => End::Whole,
        Err(Unfinished::Stopped) => End::Stopped,
        Err(Unfinished::Refused(problem)) => {
            End::Failed(format!("{}: {}", problem.cause, problem.fix))
        }
    };
    (running.send)(action(request, Found::Nothing, Some(end)));
}

enum Unfinished {
    Stopped,
    Refused(Problem),
}

impl From<Stopped> for Unfinished {
    fn from(_: Stopped) -> Unfinished {
        Unfinished::Stopped
    }
}

fn action(request: &StudyRequest, found: Found, end: Option<End>) -> Action {
    let serial = request.serial;
    Action::Studied(Box::new(StudyPart { serial, found, end }))
}

/// Solves the points of a study while it is wanted.
fn solve(
    batch: &Batch,
    count: usize,
    running: Running<'_>,
    take: &mut dyn FnMut(Rows) -> bool,
) -> Result<(), Stopped> {
    let is_stopped = AtomicBool::new(!(running.is_wanted)());
    // One core stays free for the main loop and the solver.
    let cores = batch::jobs(None);
    let control = Control {
        jobs: Some(cores.saturating_sub(1).max(1)),
        go_on: &|| !is_stopped.load(Ordering::Relaxed),
        progress: &|_, _| is_stopped.store(!(running.is_wanted)(), Ordering::Relaxed),
    };
    solve_all(batch, 0..count, &control, take)
}

fn solve_grid(
    request: &StudyRequest,
    parameters: &GridParameters,
    running: Running<'_>,
) -> Result<(), Unfinished> {
    let grid = Grid::of(parameters.axes.clone()).map_err(Unfinished::Refused)?;
    for (at, layer) in parameters.layers.iter().enumerate() {
        solve_layer(&grid, layer, running, &mut |found| {
            (running.send)(action(request, Found::Points(found, at), None));
        })?;
    }
    Ok(())
}

fn solve_layer(
    grid: &Grid,
    layer: &Layer,
    running: Running<'_>,
    send: &mut dyn FnMut(LayerFound),
) -> Result<(), Stopped> {
    let quantities: Vec<&'static Quantity> = layer.quantity().into_iter().collect();
    let inputs = &layer.inputs.clone().needing(quantities.iter().map(|of| of.stage));
    let batch = Batch { inputs, points: grid, quantities: &quantities };
    let (mut waiting, mut refusals) = (LayerFound::default(), Refusals::default());
    let mut sent = Instant::now();
    let solved = solve(&batch, grid.count(), running, &mut |rows| {
        refusals.count(&rows);
        waiting.outcomes.extend(&rows.outcomes);
        let values = (0..rows.outcomes.len()).map(|row| rows.values(row).next().flatten());
        waiting.values.extend(values);
        if sent.elapsed() > STEP {
            sent = Instant::now();
            waiting.refusals = refusals.clone();
            send(std::mem::take(&mut waiting));
        }
        true
    });
    waiting.refusals = refusals;
    send(waiting);
    solved
}

fn sample(
    request: &StudyRequest,
    parameters: &ToleranceParameters,
    running: Running<'_>,
) -> Result<(), Unfinished> {
    let size = Size { samples: SAMPLES, seed: 1, ranked: None };
    let only: Vec<&'static Quantity> = Quantity::find(parameters.quantity).into_iter().collect();
    let study = Tolerance::of(&parameters.case, &parameters.inputs, &only, size)
        .map_err(Unfinished::Refused)?;
    let inputs = &parameters.inputs.clone().needing(only.iter().map(|of| of.stage));
    let batch = Batch { inputs, points: &study.design, quantities: &study.quantities };
    let (mut samples, mut sent) = (Samples::of(&study), Instant::now());
    let count = study.design.count();
    let solved = solve(&batch, count, running, &mut |rows| {
        samples.add(&rows);
        let is_due = sent.elapsed() > PAGE_STEP && samples.outcomes.len() > 1;
        if is_due {
            sent = Instant::now();
            (running.send)(action(request, page(parameters, &study, &samples), None));
        }
        true
    });
    if samples.outcomes.len() > 1 {
        (running.send)(action(request, page(parameters, &study, &samples), None));
    }
    Ok(solved?)
}

/// The page of the samples so far; the ranking needs all samples.
fn page(parameters: &ToleranceParameters, study: &Tolerance, samples: &Samples) -> Found {
    let (solved, count) = (samples.outcomes.len(), study.design.count());
    let so_far = Tolerance {
        design: Design {
            samples: solved.min(study.design.samples),
            ranked: if solved < count { 0 } else { study.design.ranked },
            ..study.design.clone()
        },
        ..study.clone()
    };
    let report = ToleranceReport {
        name: &parameters.name,
        case: &parameters.case,
        method: parameters.inputs.method.name(),
        study: &so_far,
        samples,
    };
    let mut bytes = Vec::new();
    // Writing into memory does not fail.
    drop(report.write_for_screen(&mut bytes));
    let mut lines: Vec<String> =
        String::from_utf8_lossy(&bytes).lines().map(str::to_owned).collect();
    let refused = samples.refusals.0.iter().map(|refused| report.refused(refused));
    lines.extend(refused);
    Found::Page(lines, solved as f64 / count as f64)
}
