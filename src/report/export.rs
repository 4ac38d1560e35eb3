//! Solved cases as a file: a page, a table or data, chosen by the file extension.

use std::io;
use std::path::Path;

use super::charts::Solved;
use super::page::{Page, Studies, Subject};
use super::pictures::Unsolved;
use super::{Report, data};
use crate::model::Refusal;

/// Whether the file extension selects a picture.
#[must_use]
pub fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
}

/// The format of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReportFormat {
    /// A page for browsers and printers.
    Html,
    /// A page as text.
    Markdown,
    /// A table in SI units.
    Csv,
    /// One object per case in SI units.
    Json,
}

impl ReportFormat {
    /// The extensions, as an error message lists them.
    pub const ENDINGS: &str = ".html, .md, .csv or .json";

    /// The format of a file extension.
    #[must_use]
    pub fn of(path: &Path) -> Option<ReportFormat> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "html" | "htm" => ReportFormat::Html,
            "md" | "markdown" => ReportFormat::Markdown,
            "csv" => ReportFormat::Csv,
            "json" | "jsonl" => ReportFormat::Json,
            _ => return None,
        })
    }

    /// Whether it is a page for a reader.
    #[must_use]
    pub const fn is_page(self) -> bool {
        matches!(self, ReportFormat::Html | ReportFormat::Markdown)
    }

    /// Whether it includes the stations.
    #[must_use]
    pub const fn has_stations(self) -> bool {
        !matches!(self, ReportFormat::Csv)
    }

    /// Renders the cases.
    ///
    /// # Errors
    /// Errors of a template or a value that cannot be written.
    pub fn render(self, subjects: &[Subject]) -> io::Result<String> {
        let reports = || subjects.iter().filter_map(|subject| subject.solved.own());
        let mut bytes = Vec::new();
        match self {
            ReportFormat::Html => return Page::of(subjects).html().map_err(io::Error::other),
            ReportFormat::Markdown => {
                return Page::of(subjects).markdown().map_err(io::Error::other);
            }
            ReportFormat::Csv => {
                for (at, report) in reports().enumerate() {
                    data::write_csv(report, at == 0, &mut bytes)?;
                }
            }
            ReportFormat::Json => {
                for report in reports() {
                    data::write_json(report, &mut bytes)?;
                }
            }
        }
        String::from_utf8(bytes).map_err(io::Error::other)
    }
}

/// Computes the parts of a solved case that a format shows. A page includes the studies of the case
/// and a second method; HTML also includes the dynamic factor over speed. `go_on` receives the
/// number of computed parts and their total.
///
/// # Errors
/// [`Refusal::Stopped`] if `go_on` returns false.
pub fn subject(
    report: Report,
    file: String,
    format: ReportFormat,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<Subject, Refusal> {
    if !format.is_page() {
        let solved = Solved { reports: vec![report], ..Solved::default() };
        return Ok(Subject { solved, studies: Studies::default(), file });
    }
    let report = report.with_others();
    let source = Unsolved { name: &report.name, case: &report.case, inputs: &report.inputs };
    let studies = Studies::of(source.case, source.inputs, go_on).map_err(|_| Refusal::Stopped)?;
    if format == ReportFormat::Markdown {
        let solved = Solved { reports: vec![report], ..Solved::default() };
        return Ok(Subject { solved, studies, file });
    }
    // A pair without steady motion has no chart over speed.
    let speeds = match source.speeds(go_on) {
        Err(Refusal::Stopped) => return Err(Refusal::Stopped),
        found => found.ok(),
    };
    let path = Some(source.path());
    let solved = Solved { speeds, path, ..Solved::with_other_method(report) };
    Ok(Subject { solved, studies, file })
}
