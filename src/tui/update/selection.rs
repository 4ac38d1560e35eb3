//! Keeps the selection of the results on its quantity when rows appear or disappear.

use crate::tui::app::App;
use crate::tui::panes::results::{followed, place_of};
use crate::tui::solver::Answer;

/// Shows an answer in its tab.
pub(super) fn take(app: &mut App, answer: Answer) {
    let serial = answer.serial;
    let before = app.tab_of(serial).and_then(|tab| {
        let answer = tab.answer.as_ref()?;
        place_of(answer, tab.results, None)
    });
    app.take(answer);
    if let Some(tab) = app.tab_of(serial)
        && let Some(answer) = &tab.answer
    {
        tab.results = followed(tab.results, before, answer);
    }
}
