//! Jobs that must not delay the screen: reading folders and files, explaining and exporting
//! results.

use std::path::PathBuf;

use super::solver::VariantsRequest;
use super::store::folder::Viewport;
use crate::case::units::System;
use crate::case::{Case, Document};
use crate::model::{Inputs, Quantity};
use crate::report::Report;
use crate::report::chart::Chart;
use crate::report::charts;
use crate::report::explain::Page;
use crate::report::pictures::Picture;
use crate::study::relief::{Demand, Specification};
use crate::study::trade::{Setting, Trade};

/// A job of the worker. Its result is an action.
#[derive(Debug, Clone)]
pub enum Job {
    /// List a folder: the folder of the browser, and the folders typed after it.
    Folder(PathBuf, String),
    /// Find the cases below a folder.
    Search(PathBuf, String),
    /// Preview a file or a folder.
    Preview(Viewport, System),
    /// Read a model of another program as a case; the heaviest takes longer than a frame.
    Model(PathBuf),
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
    pub(super) const KINDS: usize = 11;

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
            Job::Model(_) => (10, "model"),
        }
    }
}

/// A request for a benchmark.
#[derive(Debug, Clone, PartialEq)]
pub struct Measuring {
    /// The serial of the request.
    pub serial: u64,
    /// The pair.
    pub inputs: Inputs,
    /// How long each setting is timed.
    pub patience: std::time::Duration,
}

/// Results of a running or finished benchmark.
#[derive(Debug, Clone)]
pub struct BenchmarkProgress {
    /// The serial of the benchmark.
    pub serial: u64,
    /// The results so far; `None` if they have not changed.
    pub trade: Option<Box<Trade>>,
    /// How the benchmark ended, if it has ended.
    pub end: Option<End>,
}

/// How a benchmark ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// All settings are measured.
    Whole,
    /// The user stopped it.
    Stopped,
    /// The model refuses the case, or the program failed.
    Failed(String),
}

/// The benchmark of a case, with error and time of every setting.
#[derive(Debug, Clone)]
pub struct Traded {
    /// The serial of the benchmark.
    pub(crate) serial: u64,
    /// The pair at the time of the request.
    pub(crate) inputs: Inputs,
    /// The results so far.
    pub trade: Option<Trade>,
    /// The selected setting.
    pub marked: Option<Setting>,
}

/// The view of the trade pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) enum TradeView {
    /// Error against time of every setting.
    #[default]
    Chart,
    /// Time and error of every method with every compliance.
    Table,
}

impl TradeView {
    /// The other view.
    #[must_use]
    pub(crate) fn other(self) -> TradeView {
        match self {
            TradeView::Chart => TradeView::Table,
            TradeView::Table => TradeView::Chart,
        }
    }
}

impl Traded {
    /// Whether the case has changed since the benchmark, apart from its setting.
    #[must_use]
    pub(crate) fn is_stale(&self, inputs: &Inputs) -> bool {
        let Inputs {
            method,
            tooth_compliance,
            contact_compliance,
            tolerance,
            within,
            stations,
            station_tolerance,
            accurate,
            ..
        } = inputs.clone();
        Inputs {
            method,
            tooth_compliance,
            contact_compliance,
            tolerance,
            within,
            stations,
            station_tolerance,
            accurate,
            ..self.inputs.clone()
        } != *inputs
    }
}

/// A chart with its own axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WorkerChart {
    /// Compliance of a tooth of the driver (0) or of the driven gear (1) over its flank.
    ToothCompliance(usize),
    /// Harmonics of the transmission error.
    Spectrum,
    /// Dynamic factor over speed.
    Speed,
}

impl WorkerChart {
    /// Every chart, in their order after the charts of the stations.
    pub const ALL: [WorkerChart; 4] = [
        WorkerChart::ToothCompliance(0),
        WorkerChart::ToothCompliance(1),
        WorkerChart::Spectrum,
        WorkerChart::Speed,
    ];

    /// The key, as in `plot --chart`.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            WorkerChart::ToothCompliance(gear) => charts::TOOTH_KEYS[gear],
            WorkerChart::Spectrum => charts::SPECTRUM,
            WorkerChart::Speed => charts::SPEED,
        }
    }

    /// The name and the description in lists, and the description in the status line.
    #[must_use]
    pub fn words(self) -> [&'static str; 3] {
        const TOOTH: &str = "The deflection of the loaded tooth per unit load; surface includes the \
            contact. C is the pitch circle.";
        match self {
            WorkerChart::ToothCompliance(0) => [
                "Driver tooth compliance",
                "Show the compliance of a tooth of the driver over its flank, by every model.",
                TOOTH,
            ],
            WorkerChart::ToothCompliance(_) => [
                "Driven tooth compliance",
                "Show the compliance of a tooth of the driven gear over its flank, by every model.",
                TOOTH,
            ],
            WorkerChart::Spectrum => [
                "Spectrum",
                "Show the harmonics of the transmission error at rest and in motion.",
                "The amplitude of each harmonic of the mesh frequency, at rest and in motion.",
            ],
            WorkerChart::Speed => [
                "Dynamic factor over speed",
                "Show the dynamic factor over speed, up and down, with the resonances.",
                "N is the mesh frequency over the natural frequency. N = 1, 1/2 and 1/3 mark the \
                    resonances.",
            ],
        }
    }
}

/// A request for a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartRequest {
    /// Unique serial of the request.
    pub serial: u64,
    /// The chart.
    pub chart: WorkerChart,
    /// The pair.
    pub inputs: Inputs,
}

/// The chart, or the reason why there is none.
pub(super) type ChartValues = Result<Chart, String>;

/// A part of the result of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct ChartPart {
    /// The serial of the request.
    pub serial: u64,
    /// The values so far; `None` if the computation ends without values.
    pub found: Option<ChartValues>,
    /// Whether the computation has ended.
    pub is_over: bool,
}

/// The chart of a case: the last request and its values.
#[derive(Debug, Clone, Default)]
pub struct ChartWork {
    /// The last request.
    pub request: Option<ChartRequest>,
    /// The values; those of an earlier request until the first values of the last one arrive.
    pub found: Option<(WorkerChart, ChartValues)>,
    /// Whether the worker still computes the last request.
    pub is_running: bool,
}

impl ChartWork {
    /// Adds a part of the result of the last request.
    pub fn take(&mut self, part: ChartPart) {
        let Some(request) = self.request.as_ref().filter(|request| request.serial == part.serial)
        else {
            return;
        };
        if let Some(found) = part.found {
            self.found = Some((request.chart, found));
        }
        self.is_running = !part.is_over;
    }

    /// The computed part of the chart.
    #[must_use]
    pub fn drawn(&self, chart: WorkerChart) -> Option<&Chart> {
        self.values(chart)?.as_ref().ok()
    }

    /// The reason why there is no chart.
    #[must_use]
    pub fn missing(&self, chart: WorkerChart) -> String {
        match self.values(chart) {
            Some(Err(reason)) => format!("No chart: {reason}."),
            _ if self.is_running => "Computing.".to_owned(),
            _ => "The form is not valid: no chart.".to_owned(),
        }
    }

    fn values(&self, chart: WorkerChart) -> Option<&ChartValues> {
        let (_, found) = self.found.as_ref().filter(|(own, _)| *own == chart)?;
        Some(found)
    }
}
