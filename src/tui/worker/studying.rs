//! The workers that send their results as they arrive: of the studies, of the charts with their own
//! axes, and of the benchmark.

use std::io;
use std::time::{Duration, Instant};

use super::{Running, Send, Worker};
use crate::case::Problem;
use crate::model::compliance::model_of;
use crate::model::inputs::Method;
use crate::model::solve::speeds;
use crate::model::{Inputs, Quantity, Refusal, Stage, Stages, solve_while};
use crate::report::charts::{chart_of_spectra, spectra, speed_chart, tooth_chart};
use crate::report::tolerance::ToleranceReport;
use crate::study::batch::{self, Batch, Control, Points, Refusals, Row, Stopped, solve_all};
use crate::study::sample::Design;
use crate::study::stiffness::{FLANK_POINTS, compare_flanks};
use crate::study::sweep::Grid;
use crate::study::tolerance::{Samples, Size, Tolerance};
use crate::study::trade::{Trade, trade};
use crate::tui::actions::Action;
use crate::tui::jobs::{
    BenchmarkProgress, ChartPart, ChartRequest, ChartValues, End as BenchmarkEnd, Measuring,
    WorkerChart,
};
use crate::tui::study::{
    End, Found, GridParameters, Layer, LayerFound, SAMPLES, StudyParameters, StudyPart,
    StudyRequest, ToleranceParameters,
};

/// Time between two messages of a grid.
const STEP: Duration = Duration::from_millis(40);
/// Time between two messages of a tolerance study, whose summary takes longer.
const PAGE_STEP: Duration = Duration::from_millis(250);

/// Time between two messages of a growing curve.
const CHART_STEP: Duration = Duration::from_millis(150);

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

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start_charts(send: Send) -> io::Result<Worker<ChartRequest>> {
    Worker::start("charts", send, draw_chart, |request| {
        let reason = "internal error".to_owned();
        chart_action(request, Some(Err(reason)), true)
    })
}

/// Computes a chart to its end and sends its values.
pub fn draw_chart(request: &ChartRequest, running: Running<'_>) {
    let found = match request.chart {
        WorkerChart::ToothCompliance(gear) => tooth_compliance(gear, &request.inputs),
        WorkerChart::Spectrum => spectrum(&request.inputs, running),
        WorkerChart::Speed => over_speed(request, running),
    };
    let found = match found {
        Ok(found) => Some(found),
        Err(Refusal::Stopped) => None,
        Err(refusal) => Some(Err(format!("{refusal}: {}", refusal.fix()))),
    };
    (running.send)(chart_action(request, found, true));
}

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start_benchmark(send: Send) -> io::Result<Worker<Measuring>> {
    Worker::start("benchmark", send, measure, |measuring| {
        benchmark_action(measuring, None, Some(BenchmarkEnd::Failed("internal error".to_owned())))
    })
}

/// Runs the benchmark to its end and sends each step.
pub fn measure(measuring: &Measuring, running: Running<'_>) {
    let mut report = |sofar: &Trade| {
        (running.send)(benchmark_action(measuring, Some(sofar.clone()), None));
    };
    let found = trade(&measuring.inputs, measuring.patience, running.is_wanted, &mut report);
    let (trade, end) = match found {
        Ok(trade) => (Some(trade), BenchmarkEnd::Whole),
        Err(Refusal::Stopped) => (None, BenchmarkEnd::Stopped),
        Err(refusal) => (None, BenchmarkEnd::Failed(refusal.to_string())),
    };
    (running.send)(benchmark_action(measuring, trade, Some(end)));
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
    take: &mut dyn FnMut(usize, &[Row]) -> bool,
) -> Result<(), Stopped> {
    // One core stays free for the main loop and the solver.
    let cores = batch::jobs(None);
    let jobs = Some(cores.saturating_sub(1).max(1));
    solve_all(batch, 0..count, &Control { jobs, go_on: &|_, _| (running.is_wanted)() }, take)
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
    let solved = solve(&batch, grid.count(), running, &mut |first, rows| {
        refusals.count(first, rows);
        waiting.outcomes.extend(rows.iter().map(|row| row.outcome));
        waiting.values.extend(rows.iter().map(|row| row.values.first().copied().flatten()));
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
    let solved = solve(&batch, count, running, &mut |first, rows| {
        samples.add(first, rows);
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
        case: &parameters.case,
        method: parameters.inputs.method,
        study: &so_far,
        samples,
    };
    let mut lines = report.lines_for_screen();
    let refused = samples.refusals.0.iter().map(|refused| refused.sentence(&so_far.design));
    lines.extend(refused);
    Found::Page(lines, solved as f64 / count as f64)
}

fn chart_action(request: &ChartRequest, found: Option<ChartValues>, is_over: bool) -> Action {
    let serial = request.serial;
    Action::Charted(Box::new(ChartPart { serial, found, is_over }))
}

fn tooth_compliance(gear: usize, inputs: &Inputs) -> Result<ChartValues, Refusal> {
    Ok(tooth_chart(gear, &compare_flanks(inputs, FLANK_POINTS)?, model_of(inputs)))
}

/// The spectra at rest and, for method `dynamic`, in steady motion. A closed form has no mesh;
/// method `static` replaces it.
fn spectrum(inputs: &Inputs, running: Running<'_>) -> Result<ChartValues, Refusal> {
    let method = match inputs.method {
        Method::Dynamic => Method::Dynamic,
        _ => Method::Static,
    };
    let inputs = Inputs { method, ..inputs.clone() };
    let late = Stages::of(Stage::StaticSpectrum).and(Stages::of(Stage::SteadyMotion));
    let solution = solve_while(&inputs, late, &|_| (running.is_wanted)())?;
    Ok(Ok(chart_of_spectra(spectra("", &solution))))
}

fn over_speed(request: &ChartRequest, running: Running<'_>) -> Result<ChartValues, Refusal> {
    let mut sent = Instant::now();
    let curve = speeds(&request.inputs, &mut |curve| {
        if sent.elapsed() >= CHART_STEP {
            sent = Instant::now();
            let so_far = speed_chart(&[("", curve)]).ok().map(Ok);
            (running.send)(chart_action(request, so_far, false));
        }
        (running.is_wanted)()
    })?;
    Ok(speed_chart(&[("", &curve)]))
}

fn benchmark_action(
    measuring: &Measuring,
    trade: Option<Trade>,
    end: Option<BenchmarkEnd>,
) -> Action {
    Action::Measured(Box::new(BenchmarkProgress {
        serial: measuring.serial,
        trade: trade.map(Box::new),
        end,
    }))
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};
    use std::sync::Arc;
    use std::sync::mpsc::channel;

    use super::*;
    use crate::case::Case;
    use std::time::Duration;

    fn measuring(serial: u64) -> Measuring {
        Measuring { serial, inputs: Case::table_1().inputs().unwrap(), patience: Duration::ZERO }
    }

    /// The messages of a benchmark while `go_on` returns true.
    fn sent(
        measuring: &Measuring,
        go_on: &dyn Fn(&BenchmarkProgress) -> bool,
    ) -> Vec<BenchmarkProgress> {
        let (all, is_wanted) = (RefCell::new(Vec::new()), Cell::new(true));
        let send = |action| {
            if let Action::Measured(measured) = action {
                is_wanted.set(go_on(&measured));
                all.borrow_mut().push(*measured);
            }
        };
        let running = Running { is_wanted: &|| is_wanted.get(), send: &send };
        measure(measuring, running);
        all.into_inner()
    }

    #[test]
    fn the_measured_settings_grow_until_the_end() {
        let (sender, receiver) = channel();
        let worker = start_benchmark(Arc::new(move |action| sender.send(action).is_ok())).unwrap();
        worker.request(measuring(7));
        let mut known = 0;
        for action in receiver {
            let Action::Measured(measured) = action else { panic!("{action:?}") };
            assert_eq!(measured.serial, 7);
            let trade = measured.trade.expect("a trade");
            assert!(trade.settings.len() >= known);
            known = trade.settings.len();
            if let Some(end) = measured.end {
                assert_eq!((end, known), (BenchmarkEnd::Whole, trade.planned));
                return;
            }
        }
    }

    #[test]
    fn a_stop_keeps_the_settings_measured_so_far() {
        let count = |measured: &BenchmarkProgress| {
            let trade = measured.trade.as_ref();
            trade.map_or(0, |trade| trade.settings.len())
        };
        let all = sent(&measuring(1), &|measured| count(measured) != 3);
        assert_eq!(all.last().map(|last| last.end.clone()), Some(Some(BenchmarkEnd::Stopped)));
        assert_eq!(all.iter().map(count).max(), Some(3));
    }

    #[test]
    fn a_case_that_no_method_solves_reports_the_reason() {
        let mut refused = measuring(2);
        refused.inputs.centre_distance = Some(0.01);
        let end = sent(&refused, &|_| true).into_iter().find_map(|measured| measured.end);
        assert!(
            matches!(end, Some(BenchmarkEnd::Failed(reason)) if reason.contains("centre distance"))
        );
    }
}
