//! Export of the report or a picture to a file, and copies to the clipboard of the user's terminal.

use std::path::{Path, PathBuf};

use crate::report::export as exports;
use crate::report::pictures::{Picture, find};
use crate::report::{self, Report, Selection};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::ascii;
use crate::tui::commands::Command;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::path::ExportTo;
use crate::tui::dialogs::question::Question;
use crate::tui::jobs::{ExportFault, Exporting, Job, Reporting, RunningExport};
use crate::tui::keys::Place;
use crate::tui::layout::Pane;
use crate::tui::line::Line;
use crate::tui::panes::chart;
use crate::tui::rows::{self, Row};

/// Terminals refuse or cut a longer text.
const MOST_BYTES: usize = 48 * 1024;

/// Asks for the file: a picture if a chart or the teeth have the focus, otherwise the report.
pub(super) fn ask(app: &mut App) -> Vec<Effect> {
    if refuse_faulty(app) {
        return Vec::new();
    }
    let ending = match app.layout.focus() {
        Pane::Chart | Pane::Teeth => "svg",
        _ => "html",
    };
    let beside = app.tab.path.as_deref().unwrap_or(Path::new("case.toml"));
    let input = Line::named(beside.with_extension(ending).display().to_string());
    app.prompts.push(Prompt::Export(ExportTo { input }));
    Vec::new()
}

/// Starts the export on the worker.
pub(super) fn begin(app: &mut App, path: PathBuf, replaces: bool) -> Vec<Effect> {
    let inputs = match app.tab.inputs() {
        _ if path.as_os_str().is_empty() => {
            app.complain("a file needs a name");
            return Vec::new();
        }
        Some(inputs) => inputs.clone(),
        None => {
            refuse_faulty(app);
            return Vec::new();
        }
    };
    if let Some(running) = &app.exporting {
        let running = ascii::printable(&running.path.display().to_string()).into_owned();
        app.complain(format!("the export to {running} still runs: wait for its end"));
        return Vec::new();
    }
    let is_picture = exports::is_picture(&path);
    let picture = picture(app).filter(|_| is_picture);
    if is_picture && picture.is_none() {
        let [chart, teeth] = [Pane::Chart, Pane::Teeth].map(|pane| app.key_of(Command::Show(pane)));
        app.complain(format!(
            "not exported: no chart is visible. {chart} and {teeth} show the chart and the teeth; \
                {} write the report",
            exports::ENDINGS
        ));
        return Vec::new();
    }
    let exporting = Exporting {
        path,
        replaces,
        name: app.tab.name(),
        document: app.tab.as_edited(),
        inputs,
        picture,
    };
    app.exporting = Some(RunningExport { path: exporting.path.clone(), picture });
    app.say("exporting");
    vec![Effect::Job(Job::Export(Box::new(exporting)))]
}

/// Reports the result of an export.
pub(super) fn done(app: &mut App, path: &Path, result: Result<(), ExportFault>) {
    let picture = app.exporting.take().and_then(|running| running.picture);
    if app.prompts.last().is_some_and(Prompt::is_about_running_export) {
        app.prompts.pop();
    }
    let is_asking = app.prompts.last().is_some_and(Prompt::is_export);
    match result {
        Ok(()) => {
            if is_asking {
                app.prompts.pop();
            }
            let subject = picture.map_or_else(String::new, |picture| format!(" {picture}"));
            app.say(format!("exported{subject} to {}", path.display()));
        }
        Err(ExportFault::Exists) => {
            app.message = None;
            app.prompts.push(Prompt::Ask(Question::export_exists(path)));
        }
        Err(ExportFault::Failed(reason)) => app.complain(format!("not exported: {reason}")),
    }
}

/// Copies the focused value: in the form its text, in chart and teeth the reading at the cursor,
/// otherwise the selected result.
pub(super) fn copy_value(app: &mut App) -> Vec<Effect> {
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
    let Some(quantity) = app.results().marked() else {
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
pub(super) fn copy_results(app: &mut App) -> Vec<Effect> {
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
pub(super) fn copy_report(app: &mut App, text: String) -> Vec<Effect> {
    copy(app, text, "the report of the results")
}

/// The picture of the focused pane, otherwise of the visible chart, otherwise of the visible teeth.
fn picture(app: &App) -> Option<Picture> {
    let plan = app.layout.plan();
    let is_visible = |pane: &Pane| !plan.area(*pane).is_empty();
    let focused = Some(app.layout.focus()).filter(|pane| matches!(pane, Pane::Chart | Pane::Teeth));
    let visible = || [Pane::Chart, Pane::Teeth].into_iter().find(is_visible);
    find(match focused.or_else(visible)? {
        Pane::Teeth => "teeth",
        _ => app.chart.key(),
    })
}

fn refuse_faulty(app: &mut App) -> bool {
    let Some(&(field, _)) = app.tab.problems.first() else {
        return false;
    };
    app.focus_on(field);
    app.complain("not exported: complete the fields marked with ! or as required first");
    true
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
