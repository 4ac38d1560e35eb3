//! The mouse, where the user wants it: a click brings the focus or the cursor, the wheel scrolls.

use ratatui::layout::Position;

use super::{chart, cursor, panes, teeth};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::layout;
use crate::tui::pane::Pane;
use crate::tui::prompt::Prompt;
use crate::tui::view::chart::angle_at;
use crate::tui::view::{self, explain, form, popup, results};

/// A press: into a field, onto a result, onto the chart, onto the name of a pane out of sight.
pub(super) fn click(app: &mut App, at: Position) -> Vec<Effect> {
    if let Some(pane) = view::named_at(app, at).filter(|_| app.prompts.is_empty()) {
        panes::show(app, pane);
        return Vec::new();
    }
    let Some(pane) = pane_at(app, at).filter(|_| app.prompts.is_empty()) else { return Vec::new() };
    let area = layout::plan(app.size, app.panes).area(pane);
    panes::show(app, pane);
    match pane {
        Pane::Form => {
            if let Some(field) = form::field_at(app, area, at) {
                app.is_editing = true;
                app.focus_on(field);
            }
        }
        Pane::Results => {
            if let Some(row) = results::row_at(app, area, at) {
                app.tab.row = row;
            }
        }
        Pane::Chart => {
            if let Some(angle) = angle_at(app, area, at) {
                app.cursor = Some(angle);
                return cursor::stop(app);
            }
        }
        Pane::Teeth | Pane::Trade => (),
    }
    Vec::new()
}

/// A turn of the wheel by so many lines downwards.
pub(super) fn wheel(app: &mut App, at: Position, by: isize) {
    match app.prompts.last_mut() {
        Some(Prompt::Read(page)) => popup::scroll(page, by, app.size),
        Some(Prompt::Explain(page)) => explain::scroll(page, by, app.size, app.look.ascii),
        Some(Prompt::Browse(browser)) => browser.mark(by),
        Some(Prompt::Pick(picker)) => picker.mark(by),
        Some(Prompt::Ask(_) | Prompt::SaveAs(..) | Prompt::Aim(_)) => (),
        None => match pane_at(app, at) {
            Some(Pane::Form) => app.tab.form_top = form::scrolled(app, by),
            Some(Pane::Results) => app.tab.results_top = results::scrolled(app, by),
            Some(Pane::Chart) => chart::zoom(app, if by < 0 { 1 } else { -1 }),
            Some(Pane::Teeth) => teeth::zoom(app, if by < 0 { 1 } else { -1 }),
            _ => (),
        },
    }
}

fn pane_at(app: &App, at: Position) -> Option<Pane> {
    let plan = layout::plan(app.size, app.panes);
    Pane::ALL.into_iter().find(|&pane| plan.area(pane).contains(at))
}
