//! Copying to the clipboard of the user's terminal.

use crate::report::{self, Report, Selection};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::ascii;
use crate::tui::jobs::{Job, Reporting};
use crate::tui::keys::Place;
use crate::tui::layout::Pane;
use crate::tui::panes::{chart, results};
use crate::tui::rows::{self, Row};

/// Terminals refuse or cut a longer text.
const MOST_BYTES: usize = 48 * 1024;

/// Copies the focused value: in the form its text, in chart and teeth the reading at the cursor,
/// otherwise the selected result.
pub(super) fn value(app: &mut App) -> Vec<Effect> {
    if app.layout.focus() == Pane::Form {
        let text = match rows::row(&app.tab.case, app.tab.form.focus) {
            Row::Field(field) => app.tab.case.effective(field).unwrap_or_default().to_owned(),
            Row::Limit(limit) => limit.text.clone(),
        };
        let label = rows::full_label(&app.tab.case, app.tab.form.focus);
        return copy(app, text, &label);
    }
    if Place::CURSOR.meets(app.layout.focus().place()) {
        let Some(cursor) = app.cursor else {
            app.complain("no cursor and no value to copy: h and l show the cursor");
            return Vec::new();
        };
        let reading = chart::readout(&app.charts(), cursor);
        return copy(app, reading, "the reading at the cursor");
    }
    let Some(quantity) = results::marked(&app.results()) else {
        app.complain("there are no results to copy");
        return Vec::new();
    };
    let value = app
        .tab
        .answer
        .as_ref()
        .and_then(|answer| report::value(quantity, answer.of(answer.active)?));
    let text = value
        .map(|value| report::shown_in(quantity, value, app.settings.units).to_string())
        .unwrap_or_default();
    copy(app, text, quantity.label.trim())
}

/// Requests the report of the active method as Markdown: title, verdict, inputs, and results with
/// their units.
pub(super) fn results(app: &mut App) -> Vec<Effect> {
    let answer = app.tab.answer.as_ref().filter(|_| !app.tab.is_stale());
    let solved = answer.and_then(|answer| Some((answer, answer.of(answer.active)?)));
    let Some((answer, solution)) = solved else {
        app.complain("there are no valid results to copy");
        return Vec::new();
    };
    let report = Report::of(
        app.tab.name(),
        app.tab.case.clone(),
        answer.inputs.clone(),
        solution.clone(),
        Selection::default(),
    );
    let file = app.tab.as_edited().render();
    app.say("preparing the report of the results");
    vec![Effect::Job(Job::Markdown(Box::new(Reporting { report, file })))]
}

/// Copies the prepared report.
pub(super) fn report(app: &mut App, text: String) -> Vec<Effect> {
    copy(app, text, "the report of the results")
}

fn copy(app: &mut App, text: String, what: &str) -> Vec<Effect> {
    if text.is_empty() {
        app.complain(format!("{what}: there is nothing to copy"));
        return Vec::new();
    }
    if text.len() > MOST_BYTES {
        app.complain(format!(
            "{what}: {} bytes are too long for the clipboard of a terminal",
            text.len()
        ));
        return Vec::new();
    }
    let copied = if text.lines().count() > 1 {
        what.to_owned()
    } else {
        ascii::printable(&text).into_owned()
    };
    app.say(format!("copied {copied}"));
    vec![Effect::Copy(text)]
}
