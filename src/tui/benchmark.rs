//! A benchmark of every method on a case: accuracy against run time.

use crate::model::Inputs;
use crate::study::trade::{Patience, Setting, Trade};

/// A request for a benchmark.
#[derive(Debug, Clone, PartialEq)]
pub struct Measuring {
    /// The serial of the request.
    pub serial: u64,
    /// The pair.
    pub inputs: Inputs,
    /// How long each setting is timed.
    pub patience: Patience,
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
