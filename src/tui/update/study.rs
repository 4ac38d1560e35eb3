//! The study pane: what it asks of the worker, its cursor, range and second field.

use super::{edit, solve};
use crate::case::fields::FIELDS;
use crate::model::inputs::Method;
use crate::model::{Inputs, QUANTITIES, Quantity};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::picker::{List, Picker};
use crate::tui::pane::Pane;
use crate::tui::panes::results;
use crate::tui::panes::study::range::{MOST_ZOOM, axis};
use crate::tui::panes::study::{self, CURVE_POINTS, StudyCommand, map_points};
use crate::tui::rows::{self, Row};
use crate::tui::study::{
    End, GridQuestion, Layer, Question, StudyPart, StudyRequest, ToleranceQuestion, Whose,
};

/// The methods of the overlaid curves.
const METHODS: [Method; 4] = [
    Method::Exact,
    Method::Paper,
    Method::Static,
    Method::Dynamic,
];

/// Asks for the study in sight, if it is another one than the last; stops the one out of sight.
pub(super) fn ask(app: &mut App) -> Vec<Effect> {
    if app.layout.plan().area(Pane::Study).is_empty() {
        return stop_unseen(app);
    }
    let question = match question(app) {
        Ok(question) => Some(question),
        Err(obstacle) => {
            app.tab.study.obstacle = Some(obstacle);
            None
        }
    };
    if question.is_some() {
        app.tab.study.obstacle = None;
    }
    let asked = app.tab.study.asked.as_ref();
    match question {
        Some(question) if asked.is_some_and(|asked| asked.question == question) => Vec::new(),
        Some(question) => {
            app.last_serial += 1;
            let serial = app.last_serial;
            let request = StudyRequest { serial, question };
            app.tab.study.asked = Some(request.clone());
            app.studying = Some(serial);
            vec![Effect::Study(Box::new(request))]
        }
        None => stop_unseen(app),
    }
}

fn stop_unseen(app: &mut App) -> Vec<Effect> {
    if app.studying.take().is_none() {
        return Vec::new();
    }
    app.tab.study.asked = None;
    vec![Effect::CancelStudy]
}

/// The study of the focused field and the selected result.
///
/// # Errors
/// Why there is none.
fn question(app: &App) -> Result<Question, String> {
    let tab = &app.tab;
    let inputs = tab
        .inputs()
        .ok_or("No study: a field has an error. Alt-E goes to that field.")?;
    let quantity = results::marked(&app.results())
        .or_else(|| Quantity::find("impact_force"))
        .ok_or("No result is selected.")?;
    if app.study.is_tolerance {
        return tolerance(app, inputs, quantity);
    }
    let field = field(app).ok_or("A limit has no range: go to a field of the form.")?;
    let (across, up) = map_points(app.layout.plan().area(Pane::Study));
    let second = app.study.second.filter(|second| *second != field);
    let points = if second.is_some() {
        across
    } else {
        CURVE_POINTS
    };
    let first = axis(&tab.case, field, app.study.zoom, points)?;
    let axes = match second {
        Some(second) => vec![axis(&tab.case, second, app.study.zoom, up)?, first],
        None => vec![first],
    };
    let mut layers = layers(app, inputs, quantity);
    if axes.len() > 1 {
        layers.truncate(1);
    }
    Ok(Question::Grid(GridQuestion { axes, layers }))
}

fn tolerance(app: &App, inputs: &Inputs, quantity: &Quantity) -> Result<Question, String> {
    if app.tab.case.spread.is_empty() {
        return Err("The case has no [spread]: add lines such as \"deviations.base_pitch\" = { normal = \"4 um\" } \
            to its file, and open it again. d shows the field over its range."
            .to_owned());
    }
    Ok(Question::Tolerance(Box::new(ToleranceQuestion {
        name: app.tab.short_name(),
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

/// The active method, the others, the baseline.
fn layers(app: &App, inputs: &Inputs, quantity: &'static Quantity) -> Vec<Layer> {
    let active = inputs.method;
    let found = app
        .tab
        .answer
        .as_ref()
        .map_or(active, |answer| answer.active);
    let first = Layer {
        whose: Whose::Active(active),
        inputs: inputs.clone(),
        quantity: quantity.key,
    };
    let other = |method: Method| {
        let own = counterpart(quantity, found, method)?;
        let inputs = Inputs {
            method,
            ..inputs.clone()
        };
        Some(Layer {
            whose: Whose::Other(method),
            inputs,
            quantity: own.key,
        })
    };
    let others = METHODS
        .into_iter()
        .filter(|method| *method != active && *method != found);
    let pinned = app.baseline.as_ref().map(|baseline| Layer {
        whose: Whose::Baseline,
        inputs: baseline.answer.inputs.clone(),
        quantity: quantity.key,
    });
    let others = others.filter_map(other);
    std::iter::once(first).chain(others).chain(pinned).collect()
}

/// A quantity of one method as another method finds it.
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

/// The next results.
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
    app.tab.study.take(part);
}

/// Esc: stops the study that runs.
pub(super) fn stop(app: &mut App) -> Option<Effect> {
    app.studying.take()?;
    app.say("the study is stopped; its results stay");
    Some(Effect::CancelStudy)
}

pub(super) fn run(app: &mut App, command: StudyCommand) -> Vec<Effect> {
    match command {
        StudyCommand::Move(across, up) if app.study.is_tolerance => {
            let by = if up == 0 { across } else { -up };
            app.study.top = study::scrolled(&app.study(), by);
        }
        StudyCommand::Move(across, up) => {
            app.study.cursor = study::moved(&app.study(), across, up).or(app.study.cursor);
        }
        StudyCommand::Zoom(by) => {
            app.study.zoom = (app.study.zoom + by).clamp(-MOST_ZOOM, MOST_ZOOM);
            app.study.cursor = None;
        }
        StudyCommand::Reset => (app.study.zoom, app.study.cursor) = (0, None),
        StudyCommand::Second if app.study.second.take().is_some() => app.study.cursor = None,
        StudyCommand::Second => app
            .prompts
            .push(Prompt::Pick(Picker::new(List::SecondField))),
        StudyCommand::Tolerance => {
            app.study.is_tolerance = !app.study.is_tolerance;
            app.study.top = 0;
        }
        StudyCommand::Take => return accept(app),
    }
    Vec::new()
}

/// The second field of the map.
pub(super) fn choose(app: &mut App, field: usize) {
    if self::field(app) == Some(field) {
        app.complain("the second field is the focused one: choose another");
        return;
    }
    (app.study.second, app.study.cursor, app.study.is_tolerance) = (Some(field), None, false);
}

/// Takes the values under the cursor into the form, as one edit.
fn accept(app: &mut App) -> Vec<Effect> {
    let values = study::at_cursor(&app.study());
    if values.is_empty() || app.study.is_tolerance {
        app.say("no value under the cursor");
        return Vec::new();
    }
    let mut case = app.tab.case.clone();
    for (field, text) in &values {
        if let Err(problem) = case.set(FIELDS[*field].key, text) {
            app.complain(problem.to_string());
            return Vec::new();
        }
    }
    let worded: Vec<String> = values
        .iter()
        .map(|(field, text)| format!("{} = {text}", FIELDS[*field].full_label()))
        .collect();
    app.study.cursor = None;
    let effects = edit::replace(app, case);
    app.say(format!("{}; u undoes", worded.join(", ")));
    if effects.is_empty() {
        solve(None)
    } else {
        effects
    }
}
