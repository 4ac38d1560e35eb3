//! Export of the report or a picture to a file, and copies to the clipboard of the user's terminal.

use std::path::{Path, PathBuf};

use super::key_of;
use crate::case::file::{self, SaveError};
use crate::model::Refusal;
use crate::report::export as exports;
use crate::report::page::{Page, Settings};
use crate::report::pictures::{NoPicture, Picture, find};
use crate::report::solve::{Subject, Unsolved};
use crate::report::{self, Report, Selection};
use crate::tui::app::App;
use crate::tui::app::actions::{Effect, Running, Work};
use crate::tui::ascii;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::path::PathDialog;
use crate::tui::dialogs::question::Question;
use crate::tui::jobs::{Exporting, Job, Slot};
use crate::tui::keys::Place;
use crate::tui::layout::Pane;
use crate::tui::line::Line;
use crate::tui::panes::chart;
use crate::tui::rows::{self, Row};
use crate::tui::store::at_home;

/// Terminals refuse or cut a longer text.
const MOST_BYTES: usize = 48 * 1024;

/// Asks for the file: a picture if a chart or the teeth have the focus, otherwise the report.
pub(super) fn ask(app: &mut App) {
    if refuse_faulty(app) {
        return;
    }
    let ending = match app.layout.focus() {
        Pane::Chart | Pane::Teeth => "svg",
        _ => "html",
    };
    let beside = app.tab.path.as_deref().unwrap_or(Path::new("case.toml"));
    let input = Line::named(beside.with_extension(ending).display().to_string());
    app.prompts.push(Prompt::Path(PathDialog { input, save: None }));
}

/// Starts the export.
pub(super) fn begin(app: &mut App, path: PathBuf, replaces: bool) {
    if path.as_os_str().is_empty() {
        return app.complain("a file needs a name");
    }
    // The dialog keeps its extension behind a typed name: `force.svg.html` is `force.svg`.
    let has_extension =
        |stem: &&Path| exports::is_picture(stem) || exports::format_of(stem).is_some();
    let typed = path.file_stem().map(Path::new).filter(has_extension);
    let path = typed.map_or_else(|| path.clone(), |typed| path.with_file_name(typed));
    let Some(inputs) = app.tab.inputs().cloned() else {
        refuse_faulty(app);
        return;
    };
    if let Some(running) = &app.exporting {
        let running = ascii::printable(&running.display().to_string()).into_owned();
        return app.complain(format!("the export to {running} still runs: wait for its end"));
    }
    let is_picture = exports::is_picture(&path);
    let picture = picture(app).filter(|_| is_picture);
    if is_picture && picture.is_none() {
        let [chart, teeth] = ["chart", "teeth"].map(|name| key_of(app, name));
        return app.complain(format!(
            "not exported: no chart is visible. {chart} and {teeth} show the chart and the teeth; \
                {} write the report",
            exports::ENDINGS
        ));
    }
    let exporting = Exporting {
        path,
        replaces,
        name: app.tab.name(),
        document: app.tab.as_edited(),
        inputs,
        picture,
    };
    app.exporting = Some(exporting.path.clone());
    app.say("exporting");
    app.start_job(Job::Export(Box::new(exporting)));
}

/// Why an export failed.
enum ExportFault {
    /// The file exists.
    Exists,
    /// Another fault, as a sentence.
    Failed(String),
}

/// The work of an export: solves the case and writes the file.
pub(super) fn work(exporting: Exporting) -> Work {
    let path = at_home(&exporting.path);
    let path = std::path::absolute(&path).unwrap_or(path);
    let (own, picture) = (path.clone(), exporting.picture);
    let write = move |running: &Running<'_>| Some(write(&exporting, &path, running));
    let internal = || Err(ExportFault::Failed("internal error".to_owned()));
    let failed = own.clone();
    Work::new(Slot::Export, write, move |app, result| done(app, &own, picture, result))
        .or(move |app| done(app, &failed, picture, internal()))
}

fn write(exporting: &Exporting, path: &Path, running: &Running<'_>) -> Result<(), ExportFault> {
    if !exporting.replaces && path.symlink_metadata().is_ok() {
        return Err(ExportFault::Exists);
    }
    let text = text(exporting, path, &|_, _| running.is_wanted()).map_err(ExportFault::Failed)?;
    file::write(path, text.as_bytes(), exporting.replaces).map_err(|error| match error {
        SaveError::AlreadyThere(_) => ExportFault::Exists,
        error => ExportFault::Failed(error.to_string()),
    })
}

fn text(
    exporting: &Exporting,
    path: &Path,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<String, String> {
    let refused = |refusal: &Refusal| format!("{refusal}: {}", refusal.fix());
    let Exporting { name, document, inputs, picture, .. } = exporting;
    let source = Unsolved { name, case: &document.case, inputs };
    if let Some(picture) = picture {
        return picture.of_case(source, go_on).map_err(|reason| match reason {
            NoPicture::Refused(refusal) => refused(&refusal),
            NoPicture::Absent(reason) => reason,
        });
    }
    let format = exports::format_of(path).ok_or_else(|| {
        let endings = exports::ENDINGS;
        format!("unknown file extension: use {endings} for the report, or .svg for the picture")
    })?;
    let subject = source.subject(document.render(), format, go_on);
    let subject = subject.map_err(|refusal| refused(&refusal))?;
    exports::render(format, &[subject], &Settings::default()).map_err(|error| error.to_string())
}

/// Reports the result of an export.
fn done(app: &mut App, path: &Path, picture: Option<Picture>, result: Result<(), ExportFault>) {
    app.exporting = None;
    if app.prompts.last().is_some_and(Prompt::is_about_running_export) {
        app.prompts.pop();
    }
    match result {
        Ok(()) => {
            if app.prompts.last().is_some_and(Prompt::is_export) {
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
pub(super) fn copy_value(app: &mut App) {
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
            return app.complain("no cursor and no value to copy: h and l show the cursor");
        };
        let reading = chart::readout(&app.charts(), cursor);
        return copy(app, reading, "the reading at the cursor");
    }
    let Some(quantity) = app.results().marked() else {
        return app.complain("there are no results to copy");
    };
    let value = app
        .tab
        .answer
        .as_ref()
        .and_then(|answer| report::value(quantity, answer.of(answer.active)?));
    let text = value
        .map(|value| report::shown_in(quantity, value, app.settings.units).to_string())
        .unwrap_or_default();
    copy(app, text, quantity.label.trim());
}

/// Requests the report of the active method as Markdown: title, verdict, inputs, and results with
/// their units.
pub(super) fn copy_results(app: &mut App) {
    let answer = app.tab.answer.as_ref().filter(|_| !app.tab.is_stale());
    let solved = answer.and_then(|answer| Some((answer, answer.of(answer.active)?)));
    let Some((answer, solution)) = solved else {
        return app.complain("there are no valid results to copy");
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
    let markdown = |_: &Running<'_>| {
        let subjects = [Subject::of(report.with_others(), file)];
        let page = Page::of(&subjects, &Settings::default());
        Some(page.markdown().unwrap_or_else(|error| error.to_string()))
    };
    app.start(Work::new(Slot::Report, markdown, |app, text| {
        copy(app, text, "the report of the results");
    }));
}

/// The picture of the focused pane, otherwise of the visible chart, otherwise of the visible teeth.
fn picture(app: &App) -> Option<Picture> {
    let plan = app.layout.plan();
    let is_visible = |pane: &Pane| plan.shows(*pane);
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

fn copy(app: &mut App, text: String, what: &str) {
    if text.is_empty() {
        return app.complain(format!("{what}: there is nothing to copy"));
    }
    if text.len() > MOST_BYTES {
        let bytes = text.len();
        return app.complain(format!(
            "{what}: {bytes} bytes are too long for the clipboard of a terminal"
        ));
    }
    let copied = if text.lines().count() > 1 {
        what.to_owned()
    } else {
        ascii::printable(&text).into_owned()
    };
    app.say(format!("copied {copied}"));
    app.want(Effect::Copy(text));
}
