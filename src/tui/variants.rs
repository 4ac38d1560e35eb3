//! The variants of a case, solved beside it.

use crate::model::{Inputs, Solution, Stages};

/// Variants for the worker.
#[derive(Debug, Clone)]
pub struct VariantsRequest {
    /// The serial of the request with the case itself.
    pub(crate) serial: u64,
    /// The name of each variant, and its pair or the error in it.
    pub(crate) columns: Vec<(String, Result<Inputs, String>)>,
    /// The stages to solve.
    pub(crate) stages: Stages,
}

/// Solved variants.
#[derive(Debug, Clone)]
pub struct Variants {
    /// That of the request.
    pub(crate) serial: u64,
    /// The name of each variant, and its results or the reason for none.
    pub(crate) columns: Vec<(String, Result<Solution, String>)>,
}
