//! The worker of the charts with their own axes: sends a chart as it grows.

use std::io;
use std::time::{Duration, Instant};

use super::latest::{Running, Send, Worker};
use crate::model::compliance::model_of;
use crate::model::inputs::Method;
use crate::model::solve::speeds;
use crate::model::{Inputs, Refusal, Stage, Stages, solve_while};
use crate::report::tooth_chart::{absence, tooth_chart};
use crate::report::whine::charts::spectra;
use crate::study::stiffness::{FLANK_POINTS, compare_flanks};
use crate::tui::actions::Action;
use crate::tui::jobs::{ChartPart, ChartRequest, ChartValues, WorkerChart};

/// Time between two messages of a growing curve.
const STEP: Duration = Duration::from_millis(150);

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(send: Send) -> io::Result<Worker<ChartRequest>> {
    Worker::start("charts", send, draw, |request| {
        let reason = "internal error: the chart failed".to_owned();
        action(request, Some(ChartValues::Refused(reason)), true)
    })
}

/// Computes a chart to its end and sends its values.
pub fn draw(request: &ChartRequest, running: Running<'_>) {
    let found = match request.chart {
        WorkerChart::ToothCompliance(gear) => tooth_compliance(gear, &request.inputs),
        WorkerChart::Spectrum => spectrum(&request.inputs, running),
        WorkerChart::Speed => over_speed(request, running),
    };
    let found = match found {
        Ok(found) => Some(found),
        Err(Refusal::Stopped) => None,
        Err(refusal) => Some(ChartValues::Refused(format!("{refusal}: {}", refusal.fix()))),
    };
    (running.send)(action(request, found, true));
}

fn action(request: &ChartRequest, found: Option<ChartValues>, is_over: bool) -> Action {
    let serial = request.serial;
    Action::Charted(Box::new(ChartPart { serial, found, is_over }))
}

fn tooth_compliance(gear: usize, inputs: &Inputs) -> Result<ChartValues, Refusal> {
    let flanks = compare_flanks(inputs, FLANK_POINTS)?;
    let own = model_of(inputs);
    Ok(match tooth_chart(gear, &flanks, own) {
        Some(_) => ChartValues::Flanks(Box::new(flanks), own),
        None => ChartValues::Refused(format!("No chart: {}.", absence(gear, &flanks))),
    })
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
    Ok(ChartValues::Spectra(spectra("", &solution)))
}

fn over_speed(request: &ChartRequest, running: Running<'_>) -> Result<ChartValues, Refusal> {
    let mut sent = Instant::now();
    let curve = speeds(&request.inputs, &mut |curve| {
        if sent.elapsed() >= STEP {
            sent = Instant::now();
            let so_far = ChartValues::Speeds(Box::new(curve.clone()));
            (running.send)(action(request, Some(so_far), false));
        }
        (running.is_wanted)()
    })?;
    Ok(ChartValues::Speeds(Box::new(curve)))
}
