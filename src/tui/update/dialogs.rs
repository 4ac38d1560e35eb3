//! Keys, mouse and results for the topmost dialog, and the effects of its outcome.

use super::{edit, export, files, panes, run, solve, study, variants};
use crate::model::Quantity;
use crate::tui::actions::{Action, Effect};
use crate::tui::app::App;
use crate::tui::dialogs::picker::Pick;
use crate::tui::dialogs::{Dialog, Outcome, Prompt, Surroundings};

/// Passes control to the topmost dialog; `None` if there is no dialog.
pub(super) fn with<T>(
    app: &mut App,
    act: impl FnOnce(&mut dyn Dialog, &Surroundings<'_>) -> T,
) -> Option<T> {
    let mut prompt = app.prompts.pop()?;
    let result = act(prompt.dialog_mut(), &app.surroundings());
    app.prompts.push(prompt);
    Some(result)
}

/// Handles Enter.
pub(super) fn accept(app: &mut App) -> Vec<Effect> {
    let outcome = with(app, |dialog, around| dialog.accept(around));
    outcome.map_or_else(Vec::new, |outcome| decided(app, outcome))
}

/// Handles a letter that is a command of the dialog; `None` if it is text for a line.
pub(super) fn letter(app: &mut App, letter: char) -> Option<Vec<Effect>> {
    let outcome = app.prompts.last_mut()?.dialog_mut().letter(letter)?;
    Some(decided(app, outcome))
}

/// Passes on the result of a job.
pub(super) fn receive(app: &mut App, result: Action) {
    if let Some(prompt) = app.prompts.last_mut() {
        prompt.dialog_mut().receive(result);
    }
}

/// The job that previews a new selection.
pub(super) fn preview(app: &mut App) -> Option<Effect> {
    let units = app.settings.units;
    app.prompts.last_mut()?.dialog_mut().preview(units)
}

fn decided(app: &mut App, outcome: Outcome) -> Vec<Effect> {
    match outcome {
        Outcome::Effects(effects) => effects,
        Outcome::Open(path) => files::open(app, path),
        Outcome::Choose(choice) => files::choose(app, choice),
        Outcome::SaveAs(name, next) => files::save_under(app, &name, next),
        Outcome::Relief(values) => edit::take_relief(app, &values),
        Outcome::Export(name) => export::begin(app, name.trim().into(), false),
        Outcome::CursorTo(angle) => panes::move_cursor(app, angle),
        Outcome::Pick(chosen) => pick(app, chosen),
        Outcome::GoTo(field) => {
            app.prompts.clear();
            panes::go_to(app, field);
            Vec::new()
        }
    }
}

fn pick(app: &mut App, pick: Pick) -> Vec<Effect> {
    let prompt = app.prompts.pop();
    match pick {
        Pick::Variant => {
            let name = match &prompt {
                Some(Prompt::Pick(picker)) => picker.variant_name().unwrap_or_default(),
                _ => "",
            };
            variants::keep(app, name)
        }
        Pick::Run(command) => run(app, command),
        Pick::Begin(example) => solve(files::begin_example(app, example)),
        Pick::Make(gears, material) => edit::make_of_material(app, gears, material),
        Pick::Limit(key) => {
            Quantity::find(key).map_or_else(Vec::new, |quantity| edit::hold_limit(app, quantity))
        }
        Pick::Second(field) => {
            study::choose(app, field);
            Vec::new()
        }
        Pick::Show(key) => {
            panes::show_result(app, key);
            Vec::new()
        }
        Pick::Go(field) => {
            panes::go_to(app, field);
            Vec::new()
        }
    }
}
