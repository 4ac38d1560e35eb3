//! Jobs that must not delay the screen: reading folders and files, explaining and exporting
//! results.

use std::path::PathBuf;

use super::store::preview::Viewport;
use super::variants::VariantsRequest;
use crate::case::units::System;
use crate::case::{Case, Document};
use crate::model::{Inputs, Quantity};
use crate::report::Report;
use crate::report::explain::Page;
use crate::report::pictures::Picture;
use crate::study::relief::{Demand, Specification};

/// A job of the worker. Its result is an action.
#[derive(Debug, Clone)]
pub enum Job {
    /// List a folder: the folder of the browser, and the folders typed after it.
    Folder(PathBuf, String),
    /// Find the cases below a folder.
    Search(PathBuf, String),
    /// Preview a file or a folder.
    Preview(Viewport, System),
    /// List the recent cases.
    Recents,
    /// Solve the examples for their digests.
    Examples(System),
    /// Explain a result.
    Explain(Box<Explaining>),
    /// Export results to a file.
    Export(Box<Exporting>),
    /// Solve the variants.
    Variants(Box<VariantsRequest>),
    /// Find the tip relief to specify.
    Relief(Box<ReliefRequest>),
    /// Write the report of the results as Markdown.
    Markdown(Box<Reporting>),
}

/// A request to explain a result.
#[derive(Debug, Clone)]
pub struct Explaining {
    /// The result.
    pub(crate) quantity: &'static Quantity,
    pub(crate) case: Case,
    /// The pair.
    pub(crate) inputs: Inputs,
}

/// A search for the tip relief to specify.
#[derive(Debug, Clone, PartialEq)]
pub struct ReliefRequest {
    /// The demand on the relief.
    pub(crate) demand: Demand,
    /// The pair.
    pub(crate) inputs: Inputs,
}

/// A search and its specification, or the reason of its failure.
pub(crate) type ReliefAnswer = (ReliefRequest, Result<Box<Specification>, String>);

/// Results for a report.
#[derive(Debug, Clone)]
pub struct Reporting {
    /// The solved case.
    pub report: Report,
    /// The text of the case file.
    pub file: String,
}

/// A request to export results to a file.
#[derive(Debug, Clone)]
pub struct Exporting {
    /// The file; its extension selects the format.
    pub path: PathBuf,
    /// Whether it may overwrite an existing file.
    pub(crate) replaces: bool,
    /// The name of the case.
    pub(crate) name: String,
    /// The case with the text of its file.
    pub(crate) document: Document,
    /// The pair.
    pub(crate) inputs: Inputs,
    /// The picture; `None` for a report.
    pub(crate) picture: Option<Picture>,
}

/// A running export.
#[derive(Debug, Clone)]
pub(crate) struct RunningExport {
    pub(crate) path: PathBuf,
    /// The picture, unless it is a report.
    pub(crate) picture: Option<Picture>,
}

/// Why an export failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExportFault {
    /// The file exists.
    Exists,
    /// Another fault, as a sentence.
    Failed(String),
}

/// The explanation of a result, or the reason of its absence.
#[derive(Debug, Clone)]
pub struct Explained {
    /// The result.
    pub(crate) quantity: &'static Quantity,
    pub(crate) page: Result<Box<Page>, String>,
}

impl Job {
    /// Number of kinds.
    pub(super) const KINDS: usize = 10;

    /// The kind of the search for the tip relief.
    pub(super) const RELIEF: usize = 8;

    /// The kind and its name. A new job replaces a waiting job of the same kind.
    pub(super) const fn kind(&self) -> (usize, &'static str) {
        match self {
            Job::Folder(..) => (0, "folders"),
            Job::Preview(..) => (1, "previews"),
            Job::Recents => (2, "recents"),
            Job::Examples(_) => (3, "examples"),
            Job::Explain(_) => (4, "explain"),
            Job::Search(..) => (5, "search"),
            Job::Export(_) => (6, "export"),
            Job::Variants(_) => (7, "variants"),
            Job::Relief(_) => (Job::RELIEF, "relief"),
            Job::Markdown(_) => (9, "report"),
        }
    }
}
