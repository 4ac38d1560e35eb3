//! Studies and comparisons of the case: its requests, their computation, and the use of what they
//! find; the benchmark of every setting; the variants and the baseline.

use std::time::{Duration, Instant};

use super::{edit, key_of, panes};
use crate::case::fields::{FIELDS, index_of};
use crate::case::{Case, Evaluator, Limit, Problem, Variant};
use crate::model::inputs::Method;
use crate::model::{Inputs, QUANTITIES, Quantity, Refusal, Solution, Stage, Stages};
use crate::report::solve::common_method;
use crate::report::tolerance::ToleranceReport;
use crate::report::trade::conclusion;
use crate::study::axis::{Axis, Grid};
use crate::study::batch::{self, Batch, Control, Points, Refusals, solve_all};
use crate::study::tolerance::{Design, Samples, Size, Tolerance};
use crate::study::trade::{Trade, trade};
use crate::tui::app::App;
use crate::tui::app::actions::{Choice, Running, Slot, Work};
use crate::tui::app::dialogs::Prompt;
use crate::tui::app::dialogs::picker::{Item, Picker};
use crate::tui::app::dialogs::question::PathDialog;
use crate::tui::app::panes::results;
use crate::tui::app::panes::study::range::{self, CURVE_POINTS, MOST_ZOOM, RangeOf, Steps};
use crate::tui::app::panes::study::{
    self, End, GridParameters, Layer, LayerFound, StudyParameters, StudyRequest, StudyResults,
    StudyState, ToleranceParameters, map_points,
};
use crate::tui::app::panes::trade::{Traded, nearest, stepped};
use crate::tui::layout::{Pane, is_too_small};
use crate::tui::rows::{self, Row};
use crate::tui::session::age;
use crate::tui::solver::{Answer, Baseline, Variants};
use crate::tui::text::Line;

/// The title and the instruction of the dialog for a range.
const RANGE: &str = "Range of the study";
const HOW: &str = "A range such as 1000..3000 rpm, or a list such as 500, 1000, 2000 rpm; then, if \
    wanted, `, 31 points` and `, log`. KEY = before it chooses the field. A second range after a \
    semicolon makes a map.";

/// The title and the instruction of the dialog for the samples.
const SAMPLES: &str = "Samples of the tolerance";
const HOW_MANY: &str = "A number from 2 to 1000000. More samples narrow the intervals and take \
    longer.";
/// Greatest number of samples whose page is computed while they arrive.
const MOST_SAMPLES: usize = 1_000_000;

/// Time between two messages of a grid.
const STEP: Duration = Duration::from_millis(40);
/// Time between two messages of a tolerance study, whose summary takes longer.
const PAGE_STEP: Duration = Duration::from_millis(250);

/// The methods of the overlaid curves.
const METHODS: [Method; 4] = [Method::Exact, Method::Paper, Method::Static, Method::Dynamic];

/// Requests the visible study if it differs from the last one; stops a hidden one.
pub(super) fn request(app: &mut App) {
    let is_visible = app.layout.plan().shows(Pane::Study);
    app.tab.study.waits &= app.layout.focus != Pane::Study;
    let waits = app.tab.study.waits;
    app.tab.study.state.opened =
        if is_visible && !waits { app.tab.study.state.opened.or(focused(app)) } else { None };
    let key = if app.has_line() { "Esc 6" } else { "6" };
    let unstarted = || Err(format!("No study of this case yet: {key} starts it."));
    let wanted = || if waits { unstarted() } else { parameters(app) };
    let Some(parameters) = is_visible.then(wanted) else {
        app.cancel(Slot::Study);
        return;
    };
    app.tab.study.obstacle = parameters.as_ref().err().cloned();
    let Ok(parameters) = parameters else {
        app.cancel(Slot::Study);
        return;
    };
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

/// The study of the field and of the chosen or selected result; the error is the
/// reason why there is no study.
fn parameters(app: &App) -> Result<StudyParameters, String> {
    let tab = &app.tab;
    let inputs = tab
        .inputs()
        .ok_or("No study: a field is empty or has an error. Alt-E goes to that field.")?;
    let chosen = app.tab.study.state.quantity.and_then(Quantity::find);
    // A selected result that the choice of `auto` lacks stays that of the study.
    let selected = tab.results.selected.filter(|_| inputs.method == Method::Auto);
    let selected = selected.and_then(Quantity::find).or_else(|| app.marked_result());
    // A run over the speed for each point takes minutes: only a chosen result gets one.
    let selected = selected.filter(|quantity| quantity.stage != Stage::SpeedRun);
    let quantity = chosen.or(selected).or_else(|| app.listed_results().first().copied());
    let quantity =
        quantity.or_else(|| Quantity::find("impact_force")).ok_or("No result is selected.")?;
    if app.tab.study.state.is_tolerance {
        let (mut case, inputs) = (tab.case.clone(), inputs.clone());
        case.drop_empty(None);
        // The samples read neither.
        (case.about, case.variants) = (Vec::new(), Vec::new());
        if case.spread.is_empty() {
            return Err("The case has no [spread]: Alt-D gives a field a distribution. \
                d in this pane shows the field over its range."
                .to_owned());
        }
        // The samples have the quantities of the limits beside that of the study.
        let is_limited = case.limits.iter().flat_map(Limit::quantities).any(|own| own == quantity);
        let before = app.tab.study.sampled().filter(|_| is_limited);
        let samples = app.tab.study.state.samples(&inputs);
        let (quantity, units) = (before.unwrap_or(quantity.key), app.settings.units);
        let parameters = ToleranceParameters { case, inputs, quantity, samples, units };
        return Ok(StudyParameters::Tolerance(Box::new(parameters)));
    }
    let field = field(app).ok_or("A limit has no range: go to a field of the form.")?;
    let (across, up) = map_points(app.layout.plan().area(Pane::Study));
    let place = range_of(app);
    let axis_of =
        |field, steps| match app.tab.study.state.ranges.iter().find(|axis| axis.field == field) {
            Some(typed) => Ok(typed.clone()),
            None => place.axis(field, steps),
        };
    let axes = match app.tab.study.state.second.filter(|second| *second != field) {
        Some(second) => {
            vec![axis_of(second, Steps::Round(up))?, axis_of(field, Steps::Round(across))?]
        }
        None => vec![axis_of(field, Steps::Equal(CURVE_POINTS))?],
    };
    let refused =
        |problem: Problem| format!("{}: s in this pane leaves the map.", problem.for_form().cause);
    let axes = Grid::of(axes).map_err(refused)?.axes;
    let mut layers = layers(app, inputs, quantity);
    if axes.len() > 1 {
        layers.truncate(1);
    }
    Ok(StudyParameters::Grid(GridParameters { axes, layers }))
}

/// Goes to the study; from the form, of the focused field unless a field is chosen.
pub(super) fn open(app: &mut App) {
    if app.layout.focus == Pane::Form {
        app.tab.study.state.opened = focused(app);
    }
    panes::show(app, Pane::Study);
}

/// The chosen field, otherwise the focused field when the pane opened.
fn field(app: &App) -> Option<usize> {
    app.tab.study.state.field.or(app.tab.study.state.opened).or(focused(app))
}

fn focused(app: &App) -> Option<usize> {
    match rows::row(&app.tab.case, app.tab.form.focus) {
        Row::Field(field) => Some(field),
        Row::Spread(spread) => index_of(spread.field),
        Row::Limit(_) => None,
    }
}

/// The curves: the active method, the other methods, the baseline.
fn layers(app: &App, inputs: &Inputs, quantity: &'static Quantity) -> Vec<Layer> {
    let active = inputs.method;
    let solved_by = app.tab.answer.as_ref().map_or(active, |answer| answer.active);
    let layer = |is_baseline, inputs: Inputs, by| {
        let quantity = counterpart(quantity, solved_by, by)?.key;
        Some(Layer { is_baseline, inputs, quantity })
    };
    let first = Layer { is_baseline: false, inputs: inputs.clone(), quantity: quantity.key };
    // A quantity that the choice of `auto` lacks is computed by the fastest method that has it.
    let has_it = |method: &Method| method.stages().has(quantity.stage);
    let computes = Some(solved_by).filter(|method| active != Method::Auto || has_it(method));
    let computes = computes.or_else(|| METHODS.into_iter().find(has_it));
    let is_other = |method: &Method| {
        (*method != Method::Paper || app.shows_every_method)
            && ![active, solved_by].contains(method)
            && computes != Some(*method)
    };
    let others = METHODS.into_iter().filter(is_other);
    let others =
        others.filter_map(|method| layer(false, Inputs { method, ..inputs.clone() }, method));
    // Each method that shares the load has the same load at rest.
    let is_at_rest =
        quantity.also.is_none() && matches!(quantity.stage, Stage::Static | Stage::StaticSpectrum);
    let others = others.filter(|other| !is_at_rest || other.quantity != quantity.key);
    let pinned = app.baseline.as_ref().map(|baseline| &baseline.answer);
    let pinned = pinned.and_then(|answer| layer(true, answer.inputs.clone(), answer.active));
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
    app.tab.study.state.top = study::scrolled(app, by);
}

pub(super) fn move_cursor(app: &mut App, across: isize, up: isize) {
    let cursor = study::moved(app, across, up);
    app.tab.study.cursor = cursor.or(app.tab.study.cursor);
}

/// Halves or doubles the range; a usual range replaces a typed one.
pub(super) fn zoom(app: &mut App, by: i32) {
    if app.tab.study.state.is_tolerance {
        return app.say("the tolerance has no range to zoom");
    }
    app.tab.study.state.ranges.clear();
    app.tab.study.state.zoom = (app.tab.study.state.zoom + by).clamp(-MOST_ZOOM, MOST_ZOOM);
}

/// Asks for the range of the study.
pub(super) fn ask_range(app: &mut App) {
    show_grid(app);
    let axes = parameters(app).map(|parameters| parameters.axes().to_vec());
    let typed: Vec<String> = axes.unwrap_or_default().iter().rev().map(range::typed).collect();
    let input = Line::whole(typed.join("; "));
    let done = |app: &mut App, text: &str, _| set_range(app, text);
    let dialog = PathDialog::new(RANGE, HOW, input, done);
    app.prompts.push(Prompt::Path(PathDialog { meaning: Some(meaning), ..dialog }));
}

/// The points that a typed text means, with their units.
fn meaning(app: &App, text: &str) -> (Result<String, String>, Option<String>) {
    let axes = range::typed_axes(range_of(app), [field(app), app.tab.study.state.second], text);
    (axes.map(|axes| summary(&axes)), None)
}

fn summary(axes: &[Axis]) -> String {
    let words = |axis: &Axis| {
        let (label, count) = (FIELDS[axis.field].full_label(), axis.points.len());
        let [from, to] = [0, count - 1].map(|at| axis.with_unit(at));
        format!("{label}: {count} points from {from} to {to}")
    };
    axes.iter().map(words).collect::<Vec<_>>().join("; ")
}

fn range_of(app: &App) -> RangeOf<'_> {
    RangeOf { case: &app.tab.case, units: app.settings.units, zoom: app.tab.study.state.zoom }
}

/// Studies the typed ranges.
pub(super) fn set_range(app: &mut App, text: &str) {
    // From the form the range is that of the focused field.
    let in_form = focused(app).filter(|_| app.layout.focus == Pane::Form);
    let fields = [in_form.or(field(app)), app.tab.study.state.second];
    match range::typed_axes(range_of(app), fields, text) {
        Ok(axes) => {
            app.close_titled(RANGE);
            show_grid(app);
            // Field and result stay while the focus or the choice of `auto` changes.
            app.tab.study.state.field = axes.first().map(|axis| axis.field);
            let marked = app.marked_result().map(|quantity| quantity.key);
            app.tab.results.selected = app.tab.results.selected.or(marked);
            app.tab.study.state.second = axes.get(1).map(|axis| axis.field);
            app.say(summary(&axes));
            app.tab.study.state.ranges = axes;
        }
        Err(reason) => app.complain(reason),
    }
}

/// Asks for the number of samples of the tolerance.
pub(super) fn ask_samples(app: &mut App) {
    let input = Line::whole(app.tab.study.state.samples(&app.tab.inputs_so_far).to_string());
    let done = |app: &mut App, text: &str, _| set_samples(app, text);
    app.prompts.push(Prompt::Path(PathDialog::new(SAMPLES, HOW_MANY, input, done)));
}

/// Samples the tolerance with the typed number of samples.
pub(super) fn set_samples(app: &mut App, text: &str) {
    match text.trim().parse() {
        Ok(count @ 2..=MOST_SAMPLES) => {
            app.close_titled(SAMPLES);
            show_grid(app);
            let StudyState { is_tolerance, samples, top, .. } = &mut app.tab.study.state;
            (*is_tolerance, *samples, *top) = (true, Some(count), 0);
        }
        _ => app.complain(format!("type a number of samples from 2 to {MOST_SAMPLES}")),
    }
}

// Shows the pane with a curve, a map or a table.
fn show_grid(app: &mut App) {
    app.tab.study.state.is_tolerance = false;
    if app.layout.focus != Pane::Study {
        panes::show(app, Pane::Study);
    }
}

/// Opens the list of fields for the study. Its first line is the focused field of the form.
pub(super) fn first(app: &mut App) {
    let follow =
        Choice::of(|app| (app.tab.study.state.field, app.tab.study.state.opened) = (None, None));
    let about = "study the focused field of the form".to_owned();
    let picker = Picker::fields("Field of the study", false, |app, field| {
        (app.tab.study.state.field, app.tab.study.state.is_tolerance) = (Some(field), false);
        app.tab.study.state.second = app.tab.study.state.second.filter(|second| *second != field);
    });
    app.pick(picker.after(Item::named(follow, "focused field".to_owned(), about)));
}

/// Chooses a second field, or leaves the map.
pub(super) fn second(app: &mut App) {
    if app.tab.study.state.second.take().is_none() {
        let picker = Picker::fields("Second field of the map", false, |app, field| {
            if self::field(app) == Some(field) {
                return app.complain("the second field is the first one: choose another");
            }
            (app.tab.study.state.second, app.tab.study.state.is_tolerance) = (Some(field), false);
        });
        app.pick(picker);
    }
}

/// Opens the list of results for the study. Its first line follows the selected result again.
pub(super) fn result(app: &mut App) {
    let follow = Choice::of(|app| app.tab.study.state.quantity = None);
    let about = "the study follows the selected result of pane 2".to_owned();
    let picker = Picker::results("Result of the study", |app, quantity| {
        app.tab.study.state.quantity = Some(quantity.key);
    });
    app.pick(picker.after(Item::named(follow, "selected result".to_owned(), about)));
}

/// Shows the tolerance, or the curve again.
pub(super) fn tolerance(app: &mut App) {
    let is_shown = app.layout.focus == Pane::Study && app.tab.study.state.is_tolerance;
    show_grid(app);
    (app.tab.study.state.is_tolerance, app.tab.study.state.top) = (!is_shown, 0);
}

/// Writes the values at the cursor into the form, as one edit.
pub(super) fn take(app: &mut App) {
    let values = study::at_cursor(app);
    if values.is_empty() || app.tab.study.state.is_tolerance {
        return app.say("no value under the cursor");
    }
    if app.tab.study.cursor.is_none() {
        return app.say("the cursor is at the present value: move it to another one");
    }
    let worded =
        values.iter().map(|(field, text)| format!("{} = {text}", FIELDS[*field].full_label()));
    let worded = worded.collect::<Vec<_>>().join(", ");
    app.tab.study.cursor = None;
    let values = values.into_iter().map(|(field, text)| (FIELDS[field].key, text));
    edit::set_values(app, &values.collect::<Vec<_>>(), &worded);
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
    let solved = match parameters {
        StudyParameters::Grid(grid) => solve_grid(tab, grid, running),
        StudyParameters::Tolerance(tolerance) => sample(tab, tolerance, running),
    };
    let end = match solved {
        Ok(Ok(())) => End::Whole,
        Ok(Err(_)) => return,
        Err(problem) => End::Failed(format!("{}: {}", problem.cause, problem.fix)),
    };
    running.send(move |app| ended(app, tab, end));
}

/// Solves the points of a study while it is wanted.
pub(super) fn solve(
    batch: &Batch,
    count: usize,
    running: &Running<'_>,
    take: &mut dyn FnMut(usize, &[batch::Row]) -> bool,
) -> Result<(), Refusal> {
    // One core stays free for the main loop and the solver.
    let jobs = Some(batch::jobs(None).saturating_sub(1).max(1));
    solve_all(batch, 0..count, &Control { jobs, go_on: &|_, _| running.is_wanted() }, take)
}

/// The solved part of a study, and the remaining time in words after a second.
fn progress(begun: Instant, solved: usize, count: usize) -> (f64, String) {
    let (part, past) = (solved as f64 / count.max(1) as f64, begun.elapsed().as_secs_f64());
    let left = (past / part * (1.0 - part)).ceil() as u64;
    (part, if past > 1.0 { format!(", {} left", age(left)) } else { String::new() })
}

fn solve_grid(
    tab: usize,
    parameters: &GridParameters,
    running: &Running<'_>,
) -> Result<Result<(), Refusal>, Problem> {
    let (grid, begun) = (Grid::of(parameters.axes.clone())?, Instant::now());
    let all = grid.count() * parameters.layers.len();
    for (at, layer) in parameters.layers.iter().enumerate() {
        let send = |found, solved| {
            let progress = progress(begun, at * grid.count() + solved, all);
            running.send(move |app| change(app, tab, |results| results.add(at, found, progress)));
        };
        let quantities: Vec<&'static Quantity> = layer.quantity().into_iter().collect();
        let inputs = &layer.inputs.clone().needing(quantities.iter().map(|of| of.stage));
        let batch = Batch { inputs, points: &grid, quantities: &quantities };
        let (mut waiting, mut refusals) = (LayerFound::of(layer), Refusals::default());
        let mut sent = Instant::now();
        let solved = solve(&batch, grid.count(), running, &mut |first, rows| {
            refusals.count(first, rows);
            waiting.rows.extend_from_slice(rows);
            if sent.elapsed() > STEP {
                sent = Instant::now();
                waiting.refusals = refusals.clone();
                let found = std::mem::replace(&mut waiting, LayerFound::of(layer));
                send(found, first + rows.len());
            }
            true
        });
        waiting.refusals = refusals;
        send(waiting, grid.count());
        if solved.is_err() {
            return Ok(solved);
        }
    }
    Ok(Ok(()))
}

fn sample(
    tab: usize,
    parameters: &ToleranceParameters,
    running: &Running<'_>,
) -> Result<Result<(), Refusal>, Problem> {
    let ToleranceParameters { case, inputs, quantity, samples, units } = parameters;
    let size = Size { samples: *samples, seed: 1, ranked: None };
    let only: Vec<&'static Quantity> = Quantity::find(quantity).into_iter().collect();
    let study = Tolerance::of(case, inputs, &only, size)?;
    let (count, begun) = (study.design.count(), Instant::now());
    // The page of the samples so far; the ranking needs all samples.
    let send = |samples: &Samples| {
        let solved = samples.outcomes.len();
        if solved < 2 {
            return;
        }
        let design = Design {
            samples: solved.min(study.design.samples),
            ranked: if solved < count { 0 } else { study.design.ranked },
            ..study.design.clone()
        };
        let so_far = Tolerance { design, ..study.clone() };
        let report = ToleranceReport { case, method: inputs.method, study: &so_far, samples };
        let mut page = report.lines_for_screen(*units);
        let refused = samples.refusals.0.iter().map(|refused| refused.sentence(&so_far.design));
        page.extend(refused);
        let mut progress = progress(begun, solved, count);
        if solved >= study.design.samples {
            progress.1.push_str(", ranking the fields");
        }
        running.send(move |app| {
            change(app, tab, |results| (results.page, results.progress) = (page, progress));
        });
    };
    let needing = &inputs.clone().needing(only.iter().map(|of| of.stage));
    let batch = Batch { inputs: needing, points: &study.design, quantities: &study.quantities };
    let (mut samples, mut all, mut sent) = (Samples::of(&study), Vec::new(), Instant::now());
    let solved = solve(&batch, count, running, &mut |first, rows| {
        samples.add(first, rows);
        all.extend_from_slice(rows);
        if sent.elapsed() > PAGE_STEP {
            sent = Instant::now();
            send(&samples);
        }
        true
    });
    send(&samples);
    running.send(move |app| {
        change(app, tab, |results| results.layers[0].rows = all);
    });
    Ok(solved)
}

/// Starts the benchmark of every method on the case of the form.
pub(super) fn measure(app: &mut App) {
    let Some(inputs) = app.tab.inputs().cloned() else {
        return app.complain("no benchmark: fix the fields marked with ! first");
    };
    let (tab, own, patience) = (app.tab.id, inputs.clone(), app.patience);
    let take = move |app: &mut App, trade| {
        if let Some(traded) = app.tab_with(tab).and_then(|tab| tab.traded.as_mut()) {
            traded.trade = Some(trade);
        }
    };
    let failed = move |app: &mut App, reason: &str| {
        if conclude(app, tab).is_some() {
            app.complain(format!("no benchmark: {reason}"));
        }
    };
    let work = Work::in_steps(Slot::Benchmark, move |running| {
        let mut report = |sofar: &Trade| {
            let sofar = sofar.clone();
            running.send(move |app| take(app, sofar));
        };
        match trade(&own, patience, &|| running.is_wanted(), &mut report) {
            Ok(trade) => running.send(move |app| {
                take(app, trade);
                if let Some(words) = conclude(app, tab) {
                    app.say(words);
                }
            }),
            Err(Refusal::Stopped) => (),
            Err(refusal) => running.send(move |app| failed(app, &refusal.to_string())),
        }
    });
    let work = app.start(work.or(move |app| failed(app, "internal error")));
    app.tab.traded = Some(Traded { work, inputs, trade: None, marked: None });
}

/// Stops the benchmark; its results so far stay. Returns whether it ran.
pub(super) fn stop_benchmark(app: &mut App) -> bool {
    let has_run = app.cancel(Slot::Benchmark);
    if has_run && conclude(app, app.tab.id).is_some() {
        app.say("the benchmark is stopped; its results stay");
    }
    has_run
}

/// Selects the recommended setting, unless the user has selected one. Returns the conclusion, empty
/// without results, if the tab is the current one.
fn conclude(app: &mut App, tab: usize) -> Option<String> {
    let is_shown = app.tab.id == tab;
    let traded = app.tab_with(tab)?.traded.as_mut()?;
    let words = traded.trade.as_ref().map(|trade| {
        let recommended = trade.recommended().map(|measured| measured.setting);
        traded.marked = traded.marked.or(recommended);
        conclusion(trade)
    });
    is_shown.then(|| words.unwrap_or_default())
}

/// Stops a hidden benchmark. A terminal that is briefly too small does not stop it.
pub(super) fn stop_unseen(app: &mut App) {
    let is_own = app.is_measuring() && app.layout.plan().shows(Pane::Trade);
    if !is_own && !is_too_small(app.layout.size) {
        app.cancel(Slot::Benchmark);
    }
}

/// Switches between chart and table. The selection moves to a setting that the view shows.
pub(super) fn switch_view(app: &mut App) {
    app.is_trade_table = !app.is_trade_table;
    if let Some(traded) = app.tab.traded.as_mut() {
        traded.marked = nearest(traded, app.is_trade_table).or(traded.marked);
    }
}

/// Moves the selection by `by` settings, in the order of the view.
pub(super) fn step_setting(app: &mut App, by: isize) {
    let is_table = app.is_trade_table;
    if let Some(traded) = app.tab.traded.as_mut() {
        traded.marked = stepped(traded, is_table, by).or(traded.marked);
    }
}

/// Writes the selected setting into the case.
pub(super) fn take_setting(app: &mut App) {
    let setting = match &app.tab.traded {
        Some(Traded { marked: Some(setting), .. }) => *setting,
        Some(_) => return app.say("no setting is selected: the arrow keys select one"),
        None => return app.say("no benchmark yet: m runs it"),
    };
    let mut case = app.tab.case.clone();
    setting.apply(&mut case);
    edit::replace_saying(app, case, &format!("method {setting}"));
}

/// Saves the edits since the last save as a variant and shows the case without them. Without edits,
/// loads the variant with this name into the form.
pub(super) fn keep_variant(app: &mut App, name: &str) {
    if let Err(problem) = Variant::check_name(name) {
        return app.complain(format!("{}: {}", problem.cause, problem.fix));
    }
    let variant = Variant::between(name, app.tab.document.loaded(), &app.tab.case);
    if variant.overrides.is_empty() {
        let Ok(variant) = app.tab.case.variant(name) else {
            let key = key_of(app, "variant");
            return app.say(format!("no edits to keep: change a field, then type {key} NAME"));
        };
        let case = app.tab.case.with(variant);
        return edit::replace_saying(app, case, &format!("the form shows variant {name}"));
    }
    if !app.tab.problems.is_empty() {
        return app.complain("a field has an error: correct it before the edits become a variant");
    }
    let count = variant.overrides.len();
    let edits = if count == 1 { "edit" } else { "edits" };
    let mut case = app.tab.document.loaded().clone();
    case.variants.clone_from(&app.tab.case.variants);
    case.about.clone_from(&app.tab.case.about);
    case.keep_variant(variant);
    edit::replace(app, case);
    app.say(format!(
        "variant {name} now has {count} {edits}; the form shows the saved case; Ctrl-Z undoes"
    ));
}

const SOLVING: &str = "solving the variants";

/// Shows the variants beside the case, the next variants, or the methods again.
pub(super) fn next_variants(app: &mut App) {
    let count = app.tab.case.variants.len();
    if count == 0 {
        let key = key_of(app, "variant");
        return app.say(format!("the case has no variants: {key} NAME saves the edits as one"));
    }
    let page = results::variants_page(app);
    app.first_variant = match app.first_variant {
        None => Some(0),
        Some(first) if first + page < count => Some(first + page),
        Some(_) => None,
    };
    if app.first_variant.is_some() && app.tab.variants.is_none() {
        app.say(SOLVING);
    }
    app.follow();
}

/// Solves the visible variants, unless they are solved already; where the method is `auto`, by the
/// most detailed method of all columns, as `compare` does.
pub(super) fn request_variants(app: &mut App) {
    let is_shown = app.layout.plan().shows(Pane::Results);
    app.first_variant = app.first_variant.filter(|first| *first < app.tab.case.variants.len());
    let tab = &app.tab;
    let (serial, id) = (tab.serial, tab.id);
    let is_known = tab.variants.as_ref().is_some_and(|found| found.serial == serial);
    // A request of another tab replaces this request.
    let runs = app.comparing == Some(serial) && app.is_busy(Slot::Variants);
    let is_wanted = is_shown && app.first_variant.is_some() && tab.problems.is_empty();
    let waits = tab.inputs_so_far.method == Method::Auto && !tab.is_settled;
    if !is_wanted || is_known || runs || waits {
        return;
    }
    let (case, own) = (tab.case.clone(), tab.inputs_so_far.method);
    let (chosen, answer) = (tab.chosen.filter(|_| own == Method::Auto), tab.answer.clone());
    app.comparing = Some(serial);
    let solve = move |running: &Running<'_>| {
        let solved = |case: &Case, by_auto: Method| {
            let found = case.inputs().map(|inputs| {
                let is_auto = inputs.method == Method::Auto;
                let method = if is_auto { by_auto } else { inputs.method };
                let (stages, go_on) = (Pane::Results.needs(), |_| running.is_wanted());
                Evaluator::default().solve(&inputs, method, stages, &go_on)
            });
            Some(match found {
                Err(problems) => Err(problems.first().map(Problem::to_string).unwrap_or_default()),
                Ok(Err(Refusal::Stopped)) => return None,
                Ok(found) => found.map_err(|refusal| format!("{refusal}: {}", refusal.fix())),
            })
        };
        let variants = case.variants.iter().map(|variant| (&variant.name, case.with(variant)));
        let variants: Vec<_> = variants.collect();
        let all = variants.iter().map(|(_, variant)| solved(variant, Method::Auto));
        let mut all = all.collect::<Option<Vec<_>>>()?;
        let own = chosen.or(Some(own).filter(|own| *own != Method::Auto));
        let methods = all.iter().flatten().map(|solution| solution.method);
        let method = common_method(methods.chain(own));
        for (found, (_, variant)) in all.iter_mut().zip(&variants) {
            let is_other = |own: &Solution| own.choice.is_some() && own.method != method;
            if found.as_ref().is_ok_and(is_other) {
                *found = solved(variant, method)?;
            }
        }
        let again = match answer.filter(|_| chosen.is_some_and(|chosen| chosen != method)) {
            Some(answer) => {
                let own = solved(&case, method)?.ok();
                own.map(|own| Answer { active: method, methods: vec![(method, Ok(own))], ..answer })
            }
            None => None,
        };
        let names = variants.iter().map(|(name, _)| (*name).clone());
        Some(Variants { serial, case: again, columns: names.zip(all).collect() })
    };
    app.start(Work::new(Slot::Variants, solve, move |app, found| {
        if let Some(tab) = app.tab_with(id) {
            tab.variants = Some(found);
            app.message.take_if(|message| message.text == SOLVING);
            app.follow();
        }
    }));
}

/// Pins the results of the current case, or unpins the pinned ones.
pub(super) fn toggle_baseline(app: &mut App) {
    if let Some(baseline) = app.baseline.take() {
        app.say(format!("baseline {} unpinned", baseline.name));
    } else if app.tab.is_stale() || app.tab.answer.is_none() {
        app.complain("there are no valid results to pin: fix the form first");
    } else {
        app.is_pinning = true;
        pin_baseline(app);
    }
}

/// Pins the requested results as soon as they are complete.
pub(super) fn pin_baseline(app: &mut App) {
    let is_whole = app.has_results(Stages::NONE) && app.tab.requested.covers(app.wanted());
    let answer = app.tab.answer.as_ref().filter(|_| app.is_pinning && is_whole);
    if let Some(answer) = answer {
        let baseline = Baseline { name: app.tab.short_name(), answer: answer.clone() };
        let (name, key) = (baseline.name.clone(), key_of(app, "baseline"));
        (app.is_pinning, app.baseline) = (false, Some(baseline));
        app.say(format!(
            "baseline: {name} as it is now; edits show their difference; {key} unpins"
        ));
    }
}
