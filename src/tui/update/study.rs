//! The study pane: its requests to the worker, its cursor, range and second field.

use super::edit;
use crate::case::fields::FIELDS;
use crate::model::inputs::Method;
use crate::model::{Inputs, QUANTITIES, Quantity};
use crate::study::sweep::Grid;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::picker::{List, Picker};
use crate::tui::layout::Pane;
use crate::tui::panes::study::range::{MOST_ZOOM, RangeOf, Steps};
use crate::tui::panes::study::{self, CURVE_POINTS, StudyCommand, map_points};
use crate::tui::rows::{self, Row};
use crate::tui::study::{
    End, GridParameters, Layer, LayerSource, StudyKey, StudyParameters, StudyPart, StudyRequest,
    ToleranceParameters,
};
use crate::tui::tab::Tab;

/// The methods of the overlaid curves.
const METHODS: [Method; 4] = [Method::Exact, Method::Paper, Method::Static, Method::Dynamic];

/// Requests the visible study if it differs from the last one; stops a hidden one.
pub(super) fn request(app: &mut App) -> Vec<Effect> {
    if app.layout.plan().area(Pane::Study).is_empty() {
        return stop_running(app);
    }
    let quantity = quantity(app);
    let key = key(app, quantity);
    if app.tab.study.key.as_ref() == Some(&key) {
        return Vec::new();
    }
    let parameters = match parameters(app, quantity) {
        Ok(parameters) => parameters,
        Err(obstacle) => {
            let effects = stop_running(app);
            (app.tab.study.obstacle, app.tab.study.key) = (Some(obstacle), Some(key));
            return effects;
        }
    };
    (app.tab.study.obstacle, app.tab.study.key) = (None, Some(key));
    let request = app.tab.study.request.as_ref();
    if request.is_some_and(|request| request.parameters == parameters) {
        return Vec::new();
    }
    forget_running(app);
    app.last_serial += 1;
    let serial = app.last_serial;
    let request = StudyRequest { serial, parameters };
    app.tab.study.start(request.clone());
    app.studying = Some(serial);
    vec![Effect::Study(Box::new(request))]
}

/// The state that decides the study.
fn key(app: &App, quantity: Option<&Quantity>) -> StudyKey {
    let tab = &app.tab;
    StudyKey {
        serial: tab.serial,
        is_valid: tab.problems.is_empty(),
        row: tab.form.focus,
        quantity: quantity.map(|quantity| quantity.key),
        solved_by: tab.answer.as_ref().map(|answer| answer.active),
        baseline: app.baseline.as_ref().map(|baseline| baseline.answer.serial),
        second: app.study.second,
        zoom: app.study.zoom,
        units: app.settings.units,
        is_tolerance: app.study.is_tolerance,
        area: app.layout.plan().area(Pane::Study),
    }
}

fn stop_running(app: &mut App) -> Vec<Effect> {
    if forget_running(app) { vec![Effect::CancelStudy] } else { Vec::new() }
}

/// Forgets the running study, so that its tab requests it again once it is visible. Returns whether
/// a study was running.
fn forget_running(app: &mut App) -> bool {
    let Some(serial) = app.studying.take() else {
        return false;
    };
    if let Some(tab) = tab_of(app, serial) {
        (tab.study.request, tab.study.key) = (None, None);
    }
    true
}

/// The tab of a study.
fn tab_of(app: &mut App, serial: u64) -> Option<&mut Tab> {
    let mut tabs = std::iter::once(&mut app.tab).chain(&mut app.others);
    tabs.find(|tab| tab.study.runs(serial))
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
        return tolerance(app, inputs, quantity);
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

fn tolerance(app: &App, inputs: &Inputs, quantity: &Quantity) -> Result<StudyParameters, String> {
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

/// Adds the next results.
pub(super) fn take(app: &mut App, part: StudyPart) {
    let is_over = part.end.is_some();
    let failed = match &part.end {
        Some(End::Failed(reason)) => Some(reason.clone()),
        _ => None,
    };
    if is_over && app.studying == Some(part.serial) {
        app.studying = None;
        if let Some(reason) = failed {
            app.complain(reason);
        }
    }
    if let Some(tab) = tab_of(app, part.serial) {
        tab.study.take(part);
    }
}

/// Esc: stops the running study.
pub(super) fn stop(app: &mut App) -> Option<Effect> {
    app.studying.take()?;
    app.say("the study is stopped; its results stay");
    Some(Effect::CancelStudy)
}

pub(super) fn run(app: &mut App, command: StudyCommand) -> Vec<Effect> {
    match command {
        StudyCommand::Scroll(by) => app.study.top = study::scrolled(&app.study(), by),
        StudyCommand::Page(by) => app.study.top = study::paged(&app.study(), by),
        StudyCommand::Move(across, up) => {
            let cursor = study::moved(&app.study(), across, up);
            app.tab.study.cursor = cursor.or(app.tab.study.cursor);
        }
        StudyCommand::Zoom(_) | StudyCommand::Reset if app.study.is_tolerance => {
            app.say("the tolerance has no range to zoom");
        }
        StudyCommand::Zoom(by) => {
            app.study.zoom = (app.study.zoom + by).clamp(-MOST_ZOOM, MOST_ZOOM);
        }
        StudyCommand::Reset => app.study.zoom = 0,
        StudyCommand::Second if app.study.second.take().is_some() => (),
        StudyCommand::Second => app.prompts.push(Prompt::Pick(Picker::new(List::SecondField))),
        StudyCommand::Tolerance => {
            app.study.is_tolerance = !app.study.is_tolerance;
            app.study.top = 0;
        }
        StudyCommand::Take => return accept(app),
    }
    Vec::new()
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
fn accept(app: &mut App) -> Vec<Effect> {
    let values = study::at_cursor(&app.study());
    if values.is_empty() || app.study.is_tolerance {
        app.say("no value under the cursor");
        return Vec::new();
    }
    if app.tab.study.cursor.is_none() {
        app.say("the cursor is at the present value: move it to another one");
        return Vec::new();
    }
    let mut case = app.tab.case.clone();
    for (field, text) in &values {
        if let Err(problem) = case.set(FIELDS[*field].key, text) {
            app.complain(problem.for_form().to_string());
            return Vec::new();
        }
    }
    let worded: Vec<String> = values
        .iter()
        .map(|(field, text)| format!("{} = {text}", FIELDS[*field].full_label()))
        .collect();
    app.tab.study.cursor = None;
    let outcome = edit::undone_by(app, &case);
    let effects = edit::replace(app, case);
    app.say(format!("{}{outcome}", worded.join(", ")));
    effects
}
