//! A benchmark of every method on a case: error against time.

use crate::model::Inputs;
use crate::study::trade::{Patience, Setting, Trade};

/// A measurement that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Measuring {
    /// Tells it from the others.
    pub serial: u64,
    /// The pair.
    pub inputs: Inputs,
    /// How long each setting is timed.
    pub patience: Patience,
}

/// What is known of a measurement.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The measurement's.
    pub serial: u64,
    /// What is measured so far; nothing where that did not change.
    pub trade: Option<Box<Trade>>,
    /// How it ended, where it did.
    pub end: Option<End>,
}

/// How a measurement ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// All is measured.
    Whole,
    /// It was stopped.
    Stopped,
    /// The model refuses the case, or the program failed.
    Failed(String),
}

/// Error and time of every setting, on the case as it was then.
#[derive(Debug, Clone)]
pub struct Traded {
    /// The measurement's.
    pub(crate) serial: u64,
    /// The pair as it was then.
    pub(crate) inputs: Inputs,
    /// What is measured so far.
    pub trade: Option<Trade>,
    /// The setting on which the mark stands.
    pub marked: Option<Setting>,
}

/// How the pane shows a measurement.
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
    /// Whether the case is another one by now, but for the setting.
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
