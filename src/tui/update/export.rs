//! Export of the report or a picture to a file.

use std::path::{Path, PathBuf};

use crate::report::export::{self as exports, ReportFormat};
use crate::report::pictures::{Picture, find};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::ascii;
use crate::tui::commands::Command;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::path::ExportTo;
use crate::tui::dialogs::question::Question;
use crate::tui::jobs::{ExportFault, Exporting, Job, RunningExport};
use crate::tui::layout::Pane;
use crate::tui::line::Line;

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
            ReportFormat::ENDINGS
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

fn refuse_faulty(app: &mut App) -> bool {
    let Some(&(field, _)) = app.tab.problems.first() else {
        return false;
    };
    app.focus_on(field);
    app.complain("not exported: complete the fields marked with ! or as required first");
    true
}
