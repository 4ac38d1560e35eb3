//! Export of the report or a picture to a file, and copies to the clipboard of the user's terminal.

use std::io;
use std::path::{Path, PathBuf};

use super::{key_of, studies};
use crate::case::file::{self, SaveError};
use crate::case::units::System;
use crate::case::{Document, Problem};
use crate::model::Refusal;
use crate::report::charts::{Picture, find};
use crate::report::page as exports;
use crate::report::page::{Page, Settings};
use crate::report::solve::{Subject, Unsolved};
use crate::report::studies::{Take, table_of, write as write_study};
use crate::report::svg;
use crate::report::table::{Named, Table};
use crate::report::{self, Report, Selection};
use crate::study::batch;
use crate::study::shard::{Format, Kind, PointsRequest, Request, Study};
use crate::study::tolerance::USUAL_RANKED;
use crate::tui::app::App;
use crate::tui::app::actions::{Choice, Content, Effect, Running, Slot, Work};
use crate::tui::app::dialogs::Prompt;
use crate::tui::app::dialogs::page::Page as TextPage;
use crate::tui::app::dialogs::question::{PathDialog, Question};
use crate::tui::app::panes::chart;
use crate::tui::app::panes::study::{self, Layer, LayerFound, StudyParameters, range};
use crate::tui::layout::Pane;
use crate::tui::rows::{self, Row};
use crate::tui::store::at_home;
use crate::tui::text::Line;

/// Terminals refuse or cut a longer text.
const MOST_BYTES: usize = 48 * 1024;

/// The title and the instruction of the dialog.
const EXPORT: &str = "Export";
const HOW: &str = "A name or a path; ~ is the home folder. The file extension selects the content: \
    .html, .md, .csv and .json write the report, .svg writes the visible chart or the teeth; in \
    the study, .csv, .json and .svg write its points.";

/// Title of the question before the workbench ends during an export.
pub(super) const EXPORT_RUNS: &str = "An export runs";

/// Asks for the file: a picture if a chart or the teeth have the focus, otherwise the report.
pub(super) fn ask(app: &mut App) {
    if refuse_faulty(app) {
        return;
    }
    let beside = app.tab.path.as_deref().unwrap_or(Path::new("case.toml"));
    let input = Line::named(beside.with_extension(usual_ending(app)).display().to_string());
    let done = |app: &mut App, name: &str, _| begin(app, name.trim().into(), false);
    app.prompts.push(Prompt::Path(PathDialog::new(EXPORT, HOW, input, done)));
}

fn usual_ending(app: &App) -> &'static str {
    match app.layout.focus {
        Pane::Chart | Pane::Teeth => "svg",
        Pane::Study => "csv",
        _ => "html",
    }
}

/// Starts the export. A name without an extension gets the usual one.
pub(super) fn begin(app: &mut App, mut path: PathBuf, replaces: bool) {
    if path.as_os_str().is_empty() {
        return app.complain("a file needs a name");
    }
    if path.extension().is_none() {
        path.set_extension(usual_ending(app));
    }
    if refuse_faulty(app) {
        return;
    }
    if let Some(running) = &app.exporting {
        let running = app.in_message(running);
        return app.complain(format!("the export to {running} still runs: wait for its end"));
    }
    let (subject, content) = match content(app, &path) {
        Ok(content) => content,
        Err(reason) => return app.complain(format!("not exported: {reason}")),
    };
    let target = at_home(&path);
    let target = std::path::absolute(&target).unwrap_or(target);
    app.say(format!("writing {}", app.in_message(&path)));
    app.exporting = Some(path);
    let write = move |running: &Running<'_>| {
        let path = running.path.to_owned();
        let found = write(&path, content, replaces, running);
        Some((path, found))
    };
    let (own, failed) = (target.clone(), subject.clone());
    let work =
        Work::new(Slot::Export, write, move |app, (path, found)| done(app, &path, &subject, found));
    let internal = || Err(Some("internal error".to_owned()));
    app.start(work.or(move |app| done(app, &own, &failed, internal())).at(target));
}

/// The subject of an export, and its content.
fn content(app: &App, path: &Path) -> Result<(String, Content), String> {
    let is_picture = exports::is_picture(path);
    let is_data = matches!(exports::format_of(path), Some(Format::Csv | Format::Json));
    let picture = picture(app).filter(|_| is_picture);
    let has_focus = app.layout.focus == Pane::Study;
    let is_alone = picture.is_none() && app.layout.plan().shows(Pane::Study);
    if has_focus && (is_picture || is_data) || is_picture && is_alone {
        return study_content(app, path);
    }
    if is_picture && picture.is_none() {
        let [chart, teeth] = ["chart", "teeth"].map(|name| key_of(app, name));
        return Err(format!(
            "no chart is visible. {chart} and {teeth} show the chart and the teeth; {} write the \
                report",
            exports::ENDINGS
        ));
    }
    let inputs = app.tab.inputs().cloned().ok_or("a field has an error")?;
    let (name, document, units) = (app.tab.name(), app.tab.as_edited(), app.settings.units);
    let subject = picture.map_or_else(String::new, |picture| format!(": {picture}"));
    let samples = app.tab.study.state.samples;
    let content = move |running: &Running<'_>| {
        let source = Unsolved { name: &name, case: &document.case, inputs: &inputs };
        let go_on = |_, _| running.is_wanted();
        match picture {
            Some(picture) => picture
                .of_case(source, units, &go_on)
                .map_err(|refusal| refused(&refusal))
                .flatten(),
            None => report_text(source, &document, running.path, (units, samples), &go_on),
        }
    };
    Ok((subject, Box::new(content)))
}

/// What `tipstrike sweep` or `tipstrike tolerance` writes for the shown study, or its picture.
fn study_content(app: &App, path: &Path) -> Result<(String, Content), String> {
    if exports::is_picture(path) {
        let chart = study::picture(app).ok_or("there is no curve to draw")?;
        if !app.tab.study.is_over() {
            return Err("the study still runs: wait for its end, or stop it".to_owned());
        }
        let caption = Named { name: &app.tab.name(), title: app.tab.case.title() }.caption();
        let draw = move |_: &Running<'_>| Ok(svg::draw(&chart, &caption));
        return Ok((": the picture of the study".to_owned(), Box::new(draw)));
    }
    let format = exports::format_of(path).unwrap_or(Format::Csv);
    let (request, _) = repeated(app, format)?;
    let mut case = app.tab.case.clone();
    case.drop_empty(None);
    let (spread, mut curves) = (case.spread, app.tab.study.curves());
    curves.truncate(if format == Format::Csv { usize::MAX } else { 1 });
    let content = move |running: &Running<'_>| {
        let refused = |problem: Problem| format!("{}: {}", problem.cause, problem.fix);
        let mut study = Study::restore(&request).map_err(refused)?;
        if let Kind::Tolerance(tolerance) = &study.kind {
            // The samples have the quantities of the limits too.
            study.quantities.clone_from(&tolerance.quantities);
        }
        let needed = study.quantities.iter().map(|quantity| quantity.stage);
        study.inputs = study.inputs.needing(needed);
        let mut out = Vec::new();
        let written = match &curves[..] {
            [curve] => {
                // Samples depend on the order of the distributions.
                let known = if study.case.spread == spread { &curve.rows[..] } else { &[] };
                let rows = |take: Take| rows_of(&study, running, known, take);
                write_study(&study, rows, &mut out).map(drop)
            }
            curves => {
                table_of_curves(study, curves, running).and_then(|table| table.write_csv(&mut out))
            }
        };
        written.map_err(|error| error.to_string())?;
        String::from_utf8(out).map_err(|error| error.to_string())
    };
    let lines = if format == Format::Json { " as JSON Lines, one object per line" } else { "" };
    Ok((format!(": the study{lines} (y copies its command)"), Box::new(content)))
}

/// The rows of a study; those that the pane has solved are not solved again.
fn rows_of(
    study: &Study,
    running: &Running<'_>,
    known: &[batch::Row],
    take: Take,
) -> io::Result<()> {
    let count = study.points().count();
    if known.len() == count {
        return take(0, known);
    }
    let mut written = Ok(());
    let solved = studies::solve(&study.batch(), count, running, &mut |first, rows| {
        written = take(first, rows);
        written.is_ok()
    });
    written?;
    solved.map_err(|_| io::ErrorKind::Interrupted.into())
}

/// The points of a study, with a column of each other curve behind that of the study, and its
/// outcome and method at the end. These, and a name that the table has already, have the name of the
/// curve before them.
fn table_of_curves(
    mut study: Study,
    curves: &[LayerFound],
    running: &Running<'_>,
) -> io::Result<Table> {
    let own = study.points().columns().len();
    let mut table: Option<Table> = None;
    for (at, LayerFound { layer, rows, .. }) in curves.iter().enumerate() {
        study.quantities = layer.quantity().into_iter().collect();
        let needed = study.quantities.iter().map(|quantity| quantity.stage);
        study.inputs = layer.inputs.clone().needing(needed);
        let mut all = Vec::new();
        rows_of(&study, running, rows, &mut |_, rows| {
            all.extend_from_slice(rows);
            Ok(())
        })?;
        let other = table_of(&study, 0, &all);
        let Some(table) = &mut table else {
            table = Some(other);
            continue;
        };
        for (index, mut column) in other.columns.into_iter().enumerate().skip(own) {
            if index > own || table.columns.iter().any(|known| known.key == column.key) {
                column.key = format!("{} {}", layer.name(), column.key).into();
            }
            let place = if index == own { own + at } else { table.columns.len() };
            table.columns.insert(place, column);
            for (row, other) in table.rows.iter_mut().zip(&other.rows) {
                row.insert(place, other[index].clone());
            }
        }
    }
    Ok(table.unwrap_or_default())
}

/// The commands that repeat the curves of the shown study, one per line.
fn command(app: &App) -> Result<String, String> {
    Ok(repeated(app, Format::Csv)?.1)
}

/// The request of the shown study, and its commands.
fn repeated(app: &App, format: Format) -> Result<(Request, String), String> {
    let study = app.tab.study.request.as_ref().filter(|_| app.tab.study.obstacle.is_none());
    // Of the other curves, the baseline is another case.
    let mut others = Vec::new();
    let (quantity, points, options) = match &study.ok_or("there is no study")?.parameters {
        StudyParameters::Grid(grid) => {
            let quantity = grid.layers.first().map_or("", |layer| layer.quantity);
            others.extend(grid.layers.iter().skip(1).filter(|layer| !layer.is_baseline));
            // One option for all ranges.
            let is_log = grid.axes.iter().any(|axis| axis.is_log);
            let vary = grid.axes.iter().map(|axis| range::vary(axis, is_log));
            let (vary, points): (Vec<_>, Vec<_>) = vary.unzip();
            let points: Vec<usize> = points.into_iter().flatten().collect();
            let varied = vary.iter().map(|text| format!(" --vary '{text}'"));
            let counted = points.iter().map(|count| format!(" --points {count}"));
            let log = is_log.then(|| " --log".to_owned());
            let options = varied.chain(counted).chain(log).collect::<String>();
            (quantity, PointsRequest::Sweep { vary, points, log: is_log }, options)
        }
        StudyParameters::Tolerance(of) => {
            let (samples, ranked) = (of.samples, USUAL_RANKED.min(of.samples));
            let points = PointsRequest::Tolerance { samples, seed: 1, ranked };
            (of.quantity, points, format!(" --samples {samples}"))
        }
    };
    let word = if app.tab.study.state.is_tolerance { "tolerance" } else { "sweep" };
    let ending = if format == Format::Json { "json" } else { "csv" };
    let (name, case) = (app.tab.name(), app.tab.as_edited().render());
    let shell_name = name.replace('\'', r"'\''");
    let command = |method: &str, quantity: &str| {
        format!(
            "tipstrike {word}{options}{method} --only {quantity} --format {ending} '{shell_name}'"
        )
    };
    let of_layer = |layer: &Layer| {
        command(&format!(" --method {}", layer.inputs.method.name()), layer.quantity)
    };
    let commands = [command("", quantity)].into_iter().chain(others.into_iter().map(of_layer));
    let commands = commands.collect::<Vec<_>>().join("\n");
    let quantities = vec![quantity.to_owned()];
    Ok((Request { name, case, quantities, format, points }, commands))
}

fn refused(refusal: &Refusal) -> String {
    format!("{refusal}: {}", refusal.fix())
}

fn report_text(
    source: Unsolved<'_>,
    document: &Document,
    path: &Path,
    (units, samples): (System, Option<usize>),
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<String, String> {
    let format = exports::format_of(path).ok_or_else(|| {
        let endings = exports::ENDINGS;
        format!("unknown file extension: use {endings} for the report, or .svg for the picture")
    })?;
    let subject = source.subject(document.render(), format, samples, go_on);
    let subject = subject.map_err(|refusal| refused(&refusal))?;
    let settings = Settings { units, ..Settings::default() };
    exports::render(format, &[subject], &settings).map_err(|error| error.to_string())
}

/// Writes the content. The error is the reason, or `None` if the file exists.
fn write(
    path: &Path,
    content: Content,
    replaces: bool,
    running: &Running<'_>,
) -> Result<(), Option<String>> {
    if !replaces && path.symlink_metadata().is_ok() {
        return Err(None);
    }
    let text = content(running).map_err(Some)?;
    file::write(path, text.as_bytes(), replaces).map_err(|error| match error {
        SaveError::AlreadyThere(_) => None,
        error => Some(error.to_string()),
    })
}

/// Reports the result of an export.
fn done(app: &mut App, path: &Path, subject: &str, result: Result<(), Option<String>>) {
    app.exporting = None;
    app.close_titled(EXPORT_RUNS);
    let path = path.to_owned();
    match result {
        Ok(()) => {
            app.close_titled(EXPORT);
            app.say(format!("exported to {}{subject}", app.in_message(&path)));
        }
        Err(None) => {
            app.message = None;
            let text = format!("{} exists. Overwrite replaces it with the export.", path.display());
            let over = Choice::of(move |app| begin(app, path.clone(), true));
            let kept = Choice::of(|app| app.say("not exported; the file stays as it was"));
            let buttons = [("Overwrite", over), ("Cancel", kept)];
            app.ask(Question::new("The file exists", text, buttons));
        }
        Err(Some(reason)) => app.complain(format!("not exported: {reason}")),
    }
}

/// Copies the focused value: in the form its text, in chart and teeth the reading at the cursor, in
/// the study the command that repeats it, otherwise the selected result.
pub(super) fn copy_value(app: &mut App) {
    let (case, row) = (&app.tab.case, app.tab.form.focus);
    let found = match app.layout.focus {
        Pane::Form => {
            let text = match rows::row(case, row) {
                Row::Field(field) => case.effective(field).unwrap_or_default(),
                _ => rows::text(case, row).unwrap_or_default(),
            };
            Ok((text.to_owned(), rows::full_label(case, row)))
        }
        Pane::Chart | Pane::Teeth => match app.cursor {
            Some(cursor) => {
                Ok((chart::readout(app.charts(), cursor), "the reading at the cursor".to_owned()))
            }
            None => Err("no cursor and no value to copy: h and l show the cursor".to_owned()),
        },
        Pane::Study => return copy_command(app),
        Pane::Results | Pane::Trade => {
            let quantity = app.marked_result();
            let found = quantity.map(|quantity| {
                let value = app.tab.solution();
                let value = value.and_then(|solution| report::value(quantity, solution));
                let shown = |value| report::shown_in(quantity, value, app.settings.units);
                let text = value.map(|value| shown(value).to_string());
                (text.unwrap_or_default(), quantity.label.trim().to_owned())
            });
            found.ok_or_else(|| "there are no results to copy".to_owned())
        }
    };
    match found {
        Ok((text, what)) => copy(app, text, &what),
        Err(reason) => app.complain(reason),
    }
}

/// Copies the command that repeats the study, and shows it.
fn copy_command(app: &mut App) {
    let command = match command(app) {
        Ok(command) => command,
        Err(reason) => return app.complain(reason),
    };
    let copied = "The clipboard of the terminal has this text.";
    let first = "Save the case before the command runs: it reads the file.";
    let about = if app.tab.is_unsaved() { vec![copied, first] } else { vec![copied] };
    let commands = command.lines().flat_map(|line| [line, ""]);
    let lines = commands.chain(about).map(str::to_owned).collect();
    copy(app, command, "the command of the study");
    app.prompts.push(Prompt::Read(TextPage::new("Command of the study", Some(lines))));
}

/// Requests the report of the active method as Markdown: title, verdict, inputs, and results with
/// their units.
pub(super) fn copy_results(app: &mut App) {
    let Some((answer, solution)) = app.tab.answer.as_ref().zip(app.tab.present()) else {
        return app.complain("there are no valid results to copy");
    };
    let (name, case, inputs) = (app.tab.name(), app.tab.case.clone(), answer.inputs.clone());
    let report = Report::of(name, case, inputs, solution.clone(), Selection::default());
    let (file, units) = (app.tab.as_edited().render(), app.settings.units);
    app.say("preparing the report of the results");
    let markdown = move |_: &Running<'_>| {
        let subjects = [Subject::of(report.with_others(), file)];
        let page = Page::of(&subjects, &Settings { units, ..Settings::default() });
        Some(page.markdown().unwrap_or_else(|error| error.to_string()))
    };
    app.start(Work::new(Slot::Report, markdown, |app, text| {
        copy(app, text, "the report of the results");
    }));
}

/// The picture of the focused pane, otherwise of the visible chart, otherwise of the visible teeth.
fn picture(app: &App) -> Option<Picture> {
    let (plan, focus) = (app.layout.plan(), app.layout.focus);
    let panes = [focus, Pane::Chart, Pane::Teeth].into_iter();
    let mut pictures = panes.filter(|pane| matches!(pane, Pane::Chart | Pane::Teeth));
    let pane = pictures.find(|pane| *pane == focus || plan.shows(*pane))?;
    find(if pane == Pane::Teeth { "teeth" } else { app.chart.key() })
}

fn refuse_faulty(app: &mut App) -> bool {
    let faulty = app.tab.problems.first().map(|(row, _)| *row);
    if let Some(row) = faulty {
        app.focus_on(row);
        app.complain("not exported: complete the fields marked with ! or as required first");
    }
    faulty.is_some()
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
    let is_long = text.lines().count() > 1 || app.layout.focus == Pane::Study;
    app.say(format!("copied {}", if is_long { what } else { &text }));
    app.want(Effect::Copy(text));
}
