//! Selections from lists: a material for a gear, a limit for a result.

use super::edit;
use crate::case::fields::index_of;
use crate::case::{FIELDS, Limit};
use crate::model::Quantity;
use crate::report;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::ascii::symbol;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::picker::{List, Picker};
use crate::tui::form_aids::materials::{self, Material};
use crate::tui::form_aids::step_limit;
use crate::tui::jobs::Job;
use crate::tui::layout::Pane;
use crate::tui::panes::results;
use crate::tui::rows::{self, Row};

/// Opens the list of materials for the gear of the focused field, otherwise for both gears.
pub(super) fn materials(app: &mut App) {
    let gears: &[&str] = match rows::row(&app.tab.case, app.tab.form.focus) {
        Row::Field(field) if FIELDS[field].table() == "driver" => &["driver"],
        Row::Field(field) if FIELDS[field].table() == "driven" => &["driven"],
        _ => &["driver", "driven"],
    };
    app.prompts.push(Prompt::Pick(Picker::new(List::Materials(gears))));
}

/// Opens the list of examples.
pub(super) fn examples(app: &mut App) -> Vec<Effect> {
    app.prompts.push(Prompt::Pick(Picker::new(List::Examples(Vec::new()))));
    vec![Effect::Job(Job::Examples(app.settings.units))]
}

/// Sets the material of the gears as one edit, which undo reverts.
pub(super) fn make(app: &mut App, gears: &[&str], material: &Material) -> Vec<Effect> {
    let mut case = app.tab.case.clone();
    let made = gears.iter().try_for_each(|gear| materials::apply(&mut case, gear, material));
    if let Err(problem) = made {
        app.complain(problem.for_form().to_string());
        return Vec::new();
    }
    let is_other = case != app.tab.case;
    let effects = edit::replace(app, case);
    let whose = if let [gear] = gears { gear } else { "both gears" };
    let verb = if is_other { "from" } else { "unchanged, from" };
    app.say(format!("{whose}: {} {verb} {}", assignments(app, material), material.name));
    effects
}

// The values that a material sets, with their symbols.
fn assignments(app: &App, material: &Material) -> String {
    let values = material.texts().map(|(name, text)| {
        let field = FIELDS.iter().find(|field| field.name() == name);
        let name =
            field.map_or("", |field| field.symbol.trim_end_matches(|c: char| c.is_ascii_digit()));
        format!("{} {text}", symbol(name, app.look.ascii))
    });
    values.join(", ")
}

/// Sets a limit on the selected result if the results have the focus, otherwise opens the list of
/// results.
pub(super) fn limit(app: &mut App) -> Vec<Effect> {
    if let Some(quantity) =
        results::marked(&app.results()).filter(|_| app.layout.focus() == Pane::Results)
    {
        return hold(app, quantity);
    }
    app.prompts.push(Prompt::Pick(Picker::new(List::Limits)));
    Vec::new()
}

/// Goes to the limit of a quantity; a new limit starts with the present value of the quantity.
pub(super) fn hold(app: &mut App, quantity: &'static Quantity) -> Vec<Effect> {
    let mut effects = Vec::new();
    if rows::of_limit(&app.tab.case, quantity.key).is_none() {
        let mut case = app.tab.case.clone();
        case.write_limit(quantity.key, &beginning(app, quantity));
        effects = edit::replace(app, case);
    }
    app.layout.focus_on(Pane::Form);
    app.is_editing = true;
    let row = rows::of_limit(&app.tab.case, quantity.key).or_else(|| index_of("model.method"));
    app.focus_on(row.unwrap_or(app.tab.form.focus));
    effects
}

// The printed value of the quantity, rounded up so that the limit is met.
fn beginning(app: &App, quantity: &'static Quantity) -> String {
    let value = app
        .tab
        .answer
        .as_ref()
        .and_then(|answer| report::value(quantity, answer.of(answer.active)?));
    let Some(value) = value else {
        return String::new();
    };
    let text = report::shown_in(quantity, value, app.settings.units).to_string();
    let is_below = Limit::new(quantity.key, &text).is_ok_and(|limit| limit.value < value);
    let raised = step_limit(&text, quantity.key, 1).filter(|_| is_below);
    raised.unwrap_or(text)
}
