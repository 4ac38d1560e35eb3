//! Mark and scrolling of the results stay with their quantity when others come or go.

use crate::tui::app::App;
use crate::tui::solver::Answer;
use crate::tui::tab::Tab;
use crate::tui::view::results::{Listed, place_of};

/// Show an answer in its tab; the mark stays on its quantity, and on its line of the screen. Where
/// nothing was marked, and while the quantity is gone or has no value any more, the top is shown.
pub(super) fn take(app: &mut App, answer: Answer) {
    let serial = answer.serial;
    let before = app.tab_of(serial).and_then(|tab| place_of(tab, None));
    app.take(answer);
    if let Some(tab) = app.tab_of(serial) {
        follow(tab, before);
    }
}

// From the quantity that was marked.
fn follow(tab: &mut Tab, before: Option<Listed>) {
    let marked = before.filter(|_| tab.row > 0);
    let Some(key) = marked.map(|marked| marked.key).or(tab.lost) else {
        return;
    };
    let had_value = marked.is_none_or(|marked| marked.has_value);
    if let Some(now) = place_of(tab, Some(key)).filter(|now| now.has_value || !had_value) {
        let above = marked.map_or(0, |marked| marked.line.saturating_sub(tab.results_top));
        (tab.row, tab.results_top, tab.lost) = (now.row, now.line.saturating_sub(above), None);
    } else {
        (tab.row, tab.results_top, tab.lost) = (0, 0, Some(key));
    }
}
