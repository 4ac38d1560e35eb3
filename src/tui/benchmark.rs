//! A benchmark of every method on a case: error against time.

use crate::model::Inputs;
use crate::study::trade::{Patience, Trade};

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
