//! Results written to a file: a report, or a picture of a chart or the teeth.

use std::path::{Path, PathBuf};

use crate::case::file::{self, SaveError};
use crate::model::Refusal;
use crate::report::charts::{Drawn, find, no_curve, picture, with_other_method};
use crate::report::export::Format;
use crate::report::page::{self, Studies};
use crate::report::svg::teeth::teeth;
use crate::report::whine::charts::{SPECTRUM, SPEED, spectrum, speed};
use crate::report::{Report, Selection};
use crate::study::speeds::speeds;
use crate::tui::jobs::{ExportFault, Exporting, Figure};
use crate::tui::store::at_home;

/// The content of the file.
enum Subject {
    Picture(Figure),
    Report(Format),
}

/// Solves the case and writes the file. Returns the whole path.
pub(super) fn write(
    exporting: &Exporting,
    go_on: &dyn Fn(f64) -> bool,
) -> (PathBuf, Result<(), ExportFault>) {
    let path = at_home(&exporting.path);
    let path = std::path::absolute(&path).unwrap_or(path);
    if !exporting.replaces && path.symlink_metadata().is_ok() {
        return (path, Err(ExportFault::Exists));
    }
    let written = text(exporting, &path, go_on).map_err(ExportFault::Failed);
    let written = written.and_then(|text| {
        file::write(&path, text.as_bytes(), exporting.replaces).map_err(|error| match error {
            SaveError::AlreadyThere(_) => ExportFault::Exists,
            error => ExportFault::Failed(error.to_string()),
        })
    });
    (path, written)
}

fn text(exporting: &Exporting, path: &Path, go_on: &dyn Fn(f64) -> bool) -> Result<String, String> {
    let format = Format::of(path);
    let subject = match (exporting.figure, format) {
        (Some(figure), _) => Subject::Picture(figure),
        (None, Some(format)) => Subject::Report(format),
        (None, None) => {
            return Err(format!(
                "unknown file extension: use {} for the report, or .svg for the picture",
                Format::ENDINGS
            ));
        }
    };
    let selection = Selection {
        only: Vec::new(),
        stations: format.is_none_or(Format::has_stations),
    };
    let case = exporting.document.case.clone();
    let report = Report::solve(
        exporting.name.clone(),
        case,
        exporting.inputs.clone(),
        selection,
    )
    .map_err(|refusal| format!("{refusal}: {}", refusal.fix()))?;
    let format = match subject {
        Subject::Picture(figure) => return drawn(report, figure, go_on),
        Subject::Report(format) => format,
    };
    let reports = if format.is_page() {
        with_other_method(report)
    } else {
        vec![report]
    };
    let file = exporting.document.render();
    let speeds = (format == Format::Html).then(|| speeds(&exporting.inputs, &mut |_| go_on(0.0)));
    let speeds = match speeds {
        Some(Err(Refusal::Stopped)) => return Err("the export is stopped".to_owned()),
        found => found.and_then(Result::ok),
    };
    let case = &exporting.document.case;
    let studies = if format.is_page() {
        let go_on = |done: usize, of: usize| go_on(done as f64 / of.max(1) as f64);
        Studies::of(case, &exporting.inputs, &go_on).map_err(|_| "the export is stopped")?
    } else {
        Studies::default()
    };
    let subject = page::Subject {
        reports,
        speeds,
        studies,
        file,
    };
    format.render(&[subject]).map_err(|error| error.to_string())
}

fn drawn(report: Report, figure: Figure, go_on: &dyn Fn(f64) -> bool) -> Result<String, String> {
    let key = match figure {
        Figure::Teeth => return Ok(teeth(&report.inputs, &report.solution)),
        Figure::Chart(key) => key,
    };
    if key == SPEED {
        let curve = speeds(&report.inputs, &mut |_| go_on(0.0));
        let curve = curve.map_err(|refusal| format!("{refusal}: {}", refusal.fix()))?;
        return speed(&[("", &curve)])
            .ok_or_else(|| "no motion becomes steady: give a greater damping ratio".to_owned());
    }
    let reports = with_other_method(report);
    let drawn = Drawn {
        name: "",
        reports: &reports,
    };
    let found = if key == SPECTRUM {
        spectrum(&[drawn])
    } else {
        find(key).and_then(|graph| picture(graph, &[drawn]))
    };
    found.ok_or_else(|| no_curve(key, &reports))
}
