//! The page on one result.

use crate::model::Quantity;
use crate::report;
use crate::tui::app::App;
use crate::tui::prompt::{Page, Prompt};
use crate::tui::view::results;

/// Open the page on the marked result.
pub(super) fn explain(app: &mut App) {
    match results::marked(app) {
        Some(quantity) => {
            let page = Page::new(quantity.label.trim(), lines(app, quantity));
            app.prompts.push(Prompt::Read(page));
        }
        None => app.complain("there are no results to explain"),
    }
}

fn lines(app: &App, quantity: &'static Quantity) -> Vec<String> {
    let value = app.answer.as_ref().and_then(|answer| report::value(quantity, answer.of(answer.active)?));
    let value = value.map_or_else(
        || "none in this case".to_owned(),
        |value| report::shown_in(quantity, value, app.settings.units).to_string(),
    );
    let unit = if quantity.unit == "1" { "a number" } else { quantity.unit };
    [
        ("symbol", quantity.symbol.to_owned()),
        ("value", value),
        ("key", quantity.key.to_owned()),
        ("unit in reports", unit.to_owned()),
        ("equation", quantity.equation.to_owned()),
        ("stage", quantity.stage.name().to_owned()),
    ]
    .map(|(name, text)| format!("{name:<16} {text}"))
    .to_vec()
}
