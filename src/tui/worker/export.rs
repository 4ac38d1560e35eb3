//! Exports results to a file: a report, or a picture of a chart or the teeth.

use std::path::{Path, PathBuf};

use crate::case::file::{self, SaveError};
use crate::model::Refusal;
use crate::report::export::{self, ReportFormat};
use crate::report::pictures::{NoPicture, Picture, Unsolved};
use crate::tui::jobs::{ExportFault, Exporting};
use crate::tui::store::at_home;

/// The content of the file.
enum Subject {
    Picture(Picture),
    Report(ReportFormat),
}

/// Solves the case and writes the file. Returns the full path.
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
    let format = ReportFormat::of(path);
    let subject = match (exporting.picture, format) {
        (Some(picture), _) => Subject::Picture(picture),
        (None, Some(format)) => Subject::Report(format),
        (None, None) => {
            return Err(format!(
                "unknown file extension: use {} for the report, or .svg for the picture",
                ReportFormat::ENDINGS
            ));
        }
    };
    let source = Unsolved {
        name: &exporting.name,
        case: &exporting.document.case,
        inputs: &exporting.inputs,
    };
    let go_on = |done: usize, of: usize| go_on(done as f64 / of.max(1) as f64);
    let format = match subject {
        Subject::Picture(picture) => {
            return picture.of_case(source, &go_on).map_err(|reason| match reason {
                NoPicture::Refused(refusal) => refused(&refusal),
                NoPicture::Absent(reason) => reason,
            });
        }
        Subject::Report(format) => format,
    };
    let report = source.solve(format.has_stations());
    let report = report.map_err(|refusal| refused(&refusal))?;
    let file = exporting.document.render();
    let subject = export::subject(report, file, format, &go_on);
    let subject = subject.map_err(|refusal| refused(&refusal))?;
    format.render(&[subject]).map_err(|error| error.to_string())
}

fn refused(refusal: &Refusal) -> String {
    match refusal {
        Refusal::Stopped => "the export is stopped".to_owned(),
        refusal => format!("{refusal}: {}", refusal.fix()),
    }
}
