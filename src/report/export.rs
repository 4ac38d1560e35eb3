//! Solved cases as a file: a page, a table or data, chosen by the file extension.

use std::io;
use std::path::Path;

use super::data;
use super::page::{Page, Settings};
use super::solve::Subject;
use crate::study::shard::Format;

/// The extensions of reports, as an error message lists them.
pub const ENDINGS: &str = ".html, .md, .csv or .json";

/// Whether the file extension selects a picture.
#[must_use]
pub fn is_picture(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg"))
}

/// The format of a report with this file extension.
#[must_use]
pub fn format_of(path: &Path) -> Option<Format> {
    let ending = path.extension()?.to_str()?.to_ascii_lowercase();
    Some(match ending.as_str() {
        "html" | "htm" => Format::Html,
        "md" | "markdown" => Format::Md,
        "csv" => Format::Csv,
        "json" | "jsonl" => Format::Json,
        _ => return None,
    })
}

/// Renders cases in a format.
///
/// # Errors
/// Errors of a template or a value that cannot be written.
pub fn render(format: Format, subjects: &[Subject], settings: &Settings) -> io::Result<String> {
    let mut bytes = Vec::new();
    for (at, report) in subjects.iter().filter_map(Subject::own).enumerate() {
        match format {
            Format::Html => return Page::of(subjects, settings).html().map_err(io::Error::other),
            Format::Md | Format::Text => {
                return Page::of(subjects, settings).markdown().map_err(io::Error::other);
            }
            Format::Csv => data::write_csv(report, at == 0, &mut bytes)?,
            Format::Json => data::write_json(report, &mut bytes)?,
        }
    }
    String::from_utf8(bytes).map_err(io::Error::other)
}
