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

/// A job. Its result is an action.
#[derive(Debug, Clone)]
pub enum Job {
    /// What stands in a folder: where the browser is, and the folders typed after it.
    Folder(PathBuf, String),
    /// Which cases stand below a folder.
    Below(PathBuf, String),
    /// What a file or a folder holds.
    Preview(Viewport, System),
    /// Which cases were open last.
    Recents,
    /// What the examples are.
    Examples(System),
    /// Where a result comes from.
    Explain(Box<Explaining>),
    /// Write results to a file.
    Export(Box<Exporting>),
    /// The results of the variants.
    Variants(Box<VariantsRequest>),
    /// The tip relief to specify.
    Relief(Box<ReliefRequest>),
    /// The report of the results as Markdown.
    Markdown(Box<Reporting>),
}

/// A result to be explained.
#[derive(Debug, Clone)]
pub struct Explaining {
    /// The result.
    pub(crate) quantity: &'static Quantity,
    pub(crate) case: Case,
    /// The pair that it describes.
    pub(crate) inputs: Inputs,
}

/// A search for the tip relief to specify.
#[derive(Debug, Clone, PartialEq)]
pub struct ReliefRequest {
    /// What it must serve.
    pub(crate) demand: Demand,
    /// The pair.
    pub(crate) inputs: Inputs,
}

/// A search and its answer, or why there is none.
pub(crate) type ReliefAnswer = (ReliefRequest, Result<Box<Specification>, String>);

/// Results for a report.
#[derive(Debug, Clone)]
pub struct Reporting {
    /// The solved case.
    pub report: Report,
    /// The text of the case file.
    pub file: String,
}

/// Results to be written to a file.
#[derive(Debug, Clone)]
pub struct Exporting {
    /// The file; its ending chooses the format.
    pub path: PathBuf,
    /// Whether it may replace a file of that name.
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

/// An export that runs.
#[derive(Debug, Clone)]
pub(crate) struct RunningExport {
    pub(crate) path: PathBuf,
    /// The picture, unless it is a report.
    pub(crate) picture: Option<Picture>,
}

/// Why an export was not written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ExportFault {
    /// There is a file of that name.
    Exists,
    /// Anything else, in a sentence.
    Failed(String),
}

/// The explanation of a result, or why there is none.
#[derive(Debug, Clone)]
pub struct Explained {
    /// The result.
    pub(crate) quantity: &'static Quantity,
    pub(crate) page: Result<Box<Page>, String>,
}

impl Job {
    /// How many kinds there are.
    pub(super) const KINDS: usize = 10;

    /// The kind of the search for the tip relief.
    pub(super) const RELIEF: usize = 8;

    /// The kind and its name. Of a kind the latest job replaces the others.
    pub(super) const fn kind(&self) -> (usize, &'static str) {
        match self {
            Job::Folder(..) => (0, "folders"),
            Job::Preview(..) => (1, "previews"),
            Job::Recents => (2, "recents"),
            Job::Examples(_) => (3, "examples"),
            Job::Explain(_) => (4, "explain"),
            Job::Below(..) => (5, "search"),
            Job::Export(_) => (6, "export"),
            Job::Variants(_) => (7, "variants"),
            Job::Relief(_) => (Job::RELIEF, "relief"),
            Job::Markdown(_) => (9, "report"),
        }
    }
}
