//! The worker of the charts of whine: sends a chart as it grows.

use std::io;
use std::time::{Duration, Instant};

use super::latest::{Running, Send, Worker};
use crate::model::inputs::Method;
use crate::model::{Inputs, Refusal, Stage, Stages, solve_while};
use crate::report::whine::charts::spectra;
use crate::study::speeds::speeds;
use crate::tui::actions::Action;
use crate::tui::whine::{WhineChart, WhineFound, WhinePart, WhineRequest};

/// Time between two messages of a growing curve.
const STEP: Duration = Duration::from_millis(150);

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(send: Send) -> io::Result<Worker<WhineRequest>> {
    Worker::start("whine", send, whine, |request| {
        let reason = "internal error: the chart failed".to_owned();
        action(request, Some(WhineFound::Refused(reason)), true)
    })
}

/// Computes a chart to its end and sends its values.
pub fn whine(request: &WhineRequest, running: Running<'_>) {
    let found = match request.chart {
        WhineChart::Spectrum => spectrum(&request.inputs, running),
        WhineChart::Speed => over_speed(request, running),
    };
    let found = match found {
        Ok(found) => Some(found),
        Err(Refusal::Stopped) => None,
        Err(refusal) => Some(WhineFound::Refused(format!("{refusal}: {}", refusal.fix()))),
    };
    (running.send)(action(request, found, true));
}

fn action(request: &WhineRequest, found: Option<WhineFound>, is_over: bool) -> Action {
    let serial = request.serial;
    Action::Whined(Box::new(WhinePart {
        serial,
        found,
        is_over,
    }))
}

/// The spectra at rest and, for method `dynamic`, in steady motion. A closed form has no mesh;
/// method `static` replaces it.
fn spectrum(inputs: &Inputs, running: Running<'_>) -> Result<WhineFound, Refusal> {
    let method = match inputs.method {
        Method::Dynamic => Method::Dynamic,
        _ => Method::Static,
    };
    let inputs = Inputs {
        method,
        ..inputs.clone()
    };
    let late = Stages::of(Stage::StaticSpectrum).and(Stages::of(Stage::SteadyMotion));
    let solution = solve_while(&inputs, late, &|_| (running.is_wanted)())?;
    Ok(WhineFound::Spectra(spectra("", &solution)))
}

fn over_speed(request: &WhineRequest, running: Running<'_>) -> Result<WhineFound, Refusal> {
    let mut sent = Instant::now();
    let curve = speeds(&request.inputs, &mut |curve| {
        if sent.elapsed() >= STEP {
            sent = Instant::now();
            let so_far = WhineFound::Speeds(Box::new(curve.clone()));
            (running.send)(action(request, Some(so_far), false));
        }
        (running.is_wanted)()
    })?;
    Ok(WhineFound::Speeds(Box::new(curve)))
}
