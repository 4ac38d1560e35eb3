//! The study pane: its requests, their computation, its cursor, range and second field.

use std::time::{Duration, Instant};

use super::{edit, panes};
use crate::case::Problem;
use crate::case::fields::FIELDS;
use crate::model::inputs::Method;
use crate::model::{Inputs, QUANTITIES, Quantity};
use crate::report::tolerance::ToleranceReport;
use crate::study::batch::{self, Batch, Control, Points, Refusals, Stopped, solve_all};
use crate::study::sample::Design;
use crate::study::sweep::Grid;
use crate::study::tolerance::{Samples, Size, Tolerance};
use crate::tui::app::App;
use crate::tui::app::actions::{Running, Work};
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::picker::Picker;
use crate::tui::jobs::Slot;
use crate::tui::layout::Pane;
use crate::tui::panes::study::range::{MOST_ZOOM, RangeOf, Steps};
use crate::tui::panes::study::{self, CURVE_POINTS, map_points};
use crate::tui::rows::{self, Row};
use crate::tui::study::{
    End, GridParameters, Layer, LayerFound, LayerSource, SAMPLES, StudyParameters, StudyRequest,
    StudyResults, ToleranceParameters,
};

/// Time between two messages of a grid.
const STEP: Duration = Duration::from_millis(40);
/// Time between two messages of a tolerance study, whose summary takes longer.
const PAGE_STEP: Duration = Duration::from_millis(250);

/// The methods of the overlaid curves.
const METHODS: [Method; 4] = [Method::Exact, Method::Paper, Method::Static, Method::Dynamic];

/// Requests the visible study if it differs from the last one; stops a hidden one.
pub(super) fn request(app: &mut App) {
    if !app.layout.plan().shows(Pane::Study) {
        app.cancel(Slot::Study);
        return;
    }
    let parameters = match parameters(app, quantity(app)) {
        Ok(parameters) => parameters,
        Err(obstacle) => {
            app.cancel(Slot::Study);
            app.tab.study.obstacle = Some(obstacle);
            return;
        }
    };
    app.tab.study.obstacle = None;
    // A hidden study, or one that another tab replaced, was stopped before its end.
    if let Some(request) = &app.tab.study.request
        && request.parameters == parameters
        && (app.tab.study.is_over() || app.runs(Slot::Study, request.serial))
    {
        return;
    }
    let (tab, requested) = (app.tab.id, parameters.clone());
    let failed = End::Failed("internal error: the study failed".to_owned());
    let work = Work::in_steps(Slot::Study, move |running| compute(tab, &requested, running));
    let serial = app.start(work.or(move |app| ended(app, tab, failed)));
    app.tab.study.start(StudyRequest { serial, parameters });
}

fn quantity(app: &App) -> Option<&'static Quantity> {
    app.results().marked().or_else(|| Quantity::find("impact_force"))
}

/// The study of the focused field and the selected result.
///
/// # Errors
/// Returns the reason if there is no study.
fn parameters(app: &App, quantity: Option<&'static Quantity>) -> Result<StudyParameters, String> {
    let tab = &app.tab;
    let inputs = tab.inputs().ok_or("No study: a field has an error. Alt-E goes to that field.")?;
    let quantity = quantity.ok_or("No result is selected.")?;
    if app.study.is_tolerance {
        return tolerance_parameters(app, inputs, quantity);
    }
    let field = field(app).ok_or("A limit has no range: go to a field of the form.")?;
    let (across, up) = map_points(app.layout.plan().area(Pane::Study));
    let second = app.study.second.filter(|second| *second != field);
    let place = RangeOf { case: &tab.case, units: app.settings.units, zoom: app.study.zoom };
    let axis_of = |field, steps| place.axis(field, steps);
    let axes = match second {
        Some(second) => {
            vec![axis_of(second, Steps::Round(up))?, axis_of(field, Steps::Round(across))?]
        }
        None => vec![axis_of(field, Steps::Equal(CURVE_POINTS))?],
    };
    let axes = Grid::of(axes)
        .map_err(|problem| {
            let problem = problem.for_form();
            format!("{}: s in this pane leaves the map.", problem.cause)
        })?
        .axes;
    let mut layers = layers(app, inputs, quantity);
    if axes.len() > 1 {
        layers.truncate(1);
    }
    Ok(StudyParameters::Grid(GridParameters { axes, layers }))
}

fn tolerance_parameters(
    app: &App,
    inputs: &Inputs,
    quantity: &Quantity,
) -> Result<StudyParameters, String> {
    if app.tab.case.spread.is_empty() {
        return Err("The case has no [spread]: add a line [spread] and below it lines such as \
            \"deviations.base_pitch\" = { normal = \"4 um\" } to its file, and open it again. d in this pane shows the field over its range."
            .to_owned());
    }
    Ok(StudyParameters::Tolerance(Box::new(ToleranceParameters {
        case: app.tab.case.clone(),
        inputs: inputs.clone(),
        quantity: quantity.key,
    })))
}

/// The focused field of the form.
fn field(app: &App) -> Option<usize> {
    match rows::row(&app.tab.case, app.tab.form.focus) {
        Row::Field(field) => Some(field),
        Row::Limit(_) => None,
    }
}

/// The curves: the active method, the other methods, the baseline.
fn layers(app: &App, inputs: &Inputs, quantity: &'static Quantity) -> Vec<Layer> {
    let active = inputs.method;
    let answer = app.tab.answer.as_ref();
    let solved_by = answer.map_or(active, |answer| answer.active);
    let first = Layer {
        source: LayerSource::Active(active),
        inputs: inputs.clone(),
        quantity: quantity.key,
    };
    let other = |method: Method| {
        let own = counterpart(quantity, solved_by, method)?;
        let inputs = Inputs { method, ..inputs.clone() };
        Some(Layer { source: LayerSource::Other(method), inputs, quantity: own.key })
    };
    let others = METHODS.into_iter().filter(|method| *method != active && *method != solved_by);
    let pinned = app.baseline.as_ref().and_then(|baseline| {
        let answer = &baseline.answer;
        Some(Layer {
            source: LayerSource::Baseline,
            inputs: answer.inputs.clone(),
            quantity: counterpart(quantity, solved_by, answer.active)?.key,
        })
    });
    let others = others.filter_map(other);
    std::iter::once(first).chain(others).chain(pinned).collect()
}

/// The counterpart of a quantity in another method.
fn counterpart(
    quantity: &'static Quantity,
    of: Method,
    other: Method,
) -> Option<&'static Quantity> {
    let is_own = |free: &&'static Quantity| {
        free.is_of_free_impact() && free.by(of).is_some_and(|own| own.key == quantity.key)
    };
    match QUANTITIES.iter().find(is_own) {
        Some(free) => free.by(other),
        None => other.stages().has(quantity.stage).then_some(quantity),
    }
}

/// Esc: stops the running study. Returns whether it ran.
pub(super) fn stop(app: &mut App) -> bool {
    let has_run = app.cancel(Slot::Study);
    if has_run {
        ended(app, app.tab.id, End::Stopped);
        app.say("the study is stopped; its results stay");
    }
    has_run
}

pub(super) fn scroll(app: &mut App, by: isize) {
    app.study.top = study::scrolled(&app.study(), by);
}

pub(super) fn page(app: &mut App, by: isize) {
    app.study.top = study::paged(&app.study(), by);
}

pub(super) fn move_cursor(app: &mut App, across: isize, up: isize) {
    let cursor = study::moved(&app.study(), across, up);
    app.tab.study.cursor = cursor.or(app.tab.study.cursor);
}

/// Halves or doubles the range.
pub(super) fn zoom(app: &mut App, by: i32) {
    if app.study.is_tolerance {
        app.say("the tolerance has no range to zoom");
    } else {
        app.study.zoom = (app.study.zoom + by).clamp(-MOST_ZOOM, MOST_ZOOM);
    }
}

pub(super) fn reset_range(app: &mut App) {
    zoom(app, -app.study.zoom);
}

/// Chooses a second field, or leaves the map.
pub(super) fn second(app: &mut App) {
    if app.study.second.take().is_none() {
        app.prompts.push(Prompt::Pick(Picker::second_field()));
    }
}

/// Goes to the tolerance; in the study, shows the tolerance or the curve again.
pub(super) fn tolerance(app: &mut App) {
    let is_elsewhere = app.layout.focus() != Pane::Study;
    if is_elsewhere {
        panes::show(app, Pane::Study);
    }
    app.study.is_tolerance = is_elsewhere || !app.study.is_tolerance;
    app.study.top = 0;
}

/// Selects the second field of the map.
pub(super) fn choose(app: &mut App, field: usize) {
    if self::field(app) == Some(field) {
        app.complain("the second field is the focused one: choose another");
        return;
    }
    (app.study.second, app.study.is_tolerance) = (Some(field), false);
}

/// Writes the values at the cursor into the form, as one edit.
pub(super) fn take(app: &mut App) {
    let values = study::at_cursor(&app.study());
    if values.is_empty() || app.study.is_tolerance {
        return app.say("no value under the cursor");
    }
    if app.tab.study.cursor.is_none() {
        return app.say("the cursor is at the present value: move it to another one");
    }
    let mut case = app.tab.case.clone();
    for (field, text) in &values {
        if let Err(problem) = case.set(FIELDS[*field].key, text) {
            return app.complain(problem.for_form().to_string());
        }
    }
    let worded: Vec<String> = values
        .iter()
        .map(|(field, text)| format!("{} = {text}", FIELDS[*field].full_label()))
        .collect();
    app.tab.study.cursor = None;
    let outcome = edit::undone_by(app, &case);
    edit::replace(app, case);
    app.say(format!("{}{outcome}", worded.join(", ")));
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

/// Changes the results of the study of a tab.
fn change(app: &mut App, tab: usize, change: impl FnOnce(&mut StudyResults)) {
    if let Some(results) = app.tab_with(tab).and_then(|tab| tab.study.results()) {
        change(results);
    }
}

fn ended(app: &mut App, tab: usize, end: End) {
    if let End::Failed(reason) = &end {
        app.complain(reason.clone());
    }
    change(app, tab, |results| results.end = Some(end));
}

/// Computes a study for a tab and sends its results as they arrive.
fn compute(tab: usize, parameters: &StudyParameters, running: &Running<'_>) {
    let done = match parameters {
        StudyParameters::Grid(grid) => solve_grid(tab, grid, running),
        StudyParameters::Tolerance(tolerance) => sample(tab, tolerance, running),
    };
    let end = match done {
        Ok(()) => End::Whole,
        Err(Unfinished::Stopped) => return,
        Err(Unfinished::Refused(problem)) => {
            End::Failed(format!("{}: {}", problem.cause, problem.fix))
        }
    };
    running.send(move |app| ended(app, tab, end));
}

/// Solves the points of a study while it is wanted.
fn solve(
    batch: &Batch,
    count: usize,
    running: &Running<'_>,
    take: &mut dyn FnMut(usize, &[batch::Row]) -> bool,
) -> Result<(), Stopped> {
    // One core stays free for the main loop and the solver.
    let cores = batch::jobs(None);
    let jobs = Some(cores.saturating_sub(1).max(1));
    solve_all(batch, 0..count, &Control { jobs, go_on: &|_, _| running.is_wanted() }, take)
}

fn solve_grid(
    tab: usize,
    parameters: &GridParameters,
    running: &Running<'_>,
) -> Result<(), Unfinished> {
    let grid = Grid::of(parameters.axes.clone()).map_err(Unfinished::Refused)?;
    for (at, layer) in parameters.layers.iter().enumerate() {
        solve_layer(&grid, layer, running, &mut |found| {
            running.send(move |app| change(app, tab, |results| results.add(at, found)));
        })?;
    }
    Ok(())
}

fn solve_layer(
    grid: &Grid,
    layer: &Layer,
    running: &Running<'_>,
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
    tab: usize,
    parameters: &ToleranceParameters,
    running: &Running<'_>,
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
            send_page(tab, sampled(parameters, &study, &samples), running);
        }
        true
    });
    if samples.outcomes.len() > 1 {
        send_page(tab, sampled(parameters, &study, &samples), running);
    }
    Ok(solved?)
}

fn send_page(tab: usize, (lines, part): (Vec<String>, f64), running: &Running<'_>) {
    let page = move |results: &mut StudyResults| (results.page, results.part) = (lines, part);
    running.send(move |app| change(app, tab, page));
}

/// The page of the samples so far, and the solved part; the ranking needs all samples.
fn sampled(
    parameters: &ToleranceParameters,
    study: &Tolerance,
    samples: &Samples,
) -> (Vec<String>, f64) {
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
    (lines, solved as f64 / count as f64)
}
