//! Enter in a prompt.

use super::{browse, catalogue, cursor, files, page, panes, run, solve, tabs};
use crate::model::Quantity;
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::pick::Pick;
use crate::tui::prompt::Prompt;

/// What the topmost prompt is for.
pub(super) fn accept(app: &mut App) -> Vec<Effect> {
    match app.prompts.last().cloned() {
        Some(Prompt::Browse(_)) => browse::accept(app),
        Some(Prompt::Explain(explanation)) => page::accept(app, &explanation),
        Some(Prompt::Aim(input)) => cursor::take_aim(app, input.value()),
        Some(Prompt::SaveAs(input, next)) => files::save_under(app, input.value(), next),
        Some(Prompt::Ask(question)) => match question.buttons.get(question.marked) {
            Some((_, choice)) => files::choose(app, choice.clone()),
            None => Vec::new(),
        },
        Some(Prompt::Pick(picker)) => match picker.fitting().into_iter().nth(picker.marked) {
            Some(item) => pick(app, item.pick),
            None => Vec::new(),
        },
        Some(Prompt::Read(_)) | None => Vec::new(),
    }
}

fn pick(app: &mut App, pick: Pick) -> Vec<Effect> {
    app.prompts.pop();
    match pick {
        Pick::Run(command) => run(app, command),
        Pick::Begin(example) => solve(tabs::begin(app, example)),
        Pick::Make(gears, material) => catalogue::make(app, gears, material),
        Pick::Limit(key) => {
            Quantity::find(key).map_or_else(Vec::new, |quantity| catalogue::hold(app, quantity))
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
