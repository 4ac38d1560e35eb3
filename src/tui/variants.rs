//! The variants of a case, solved for the comparison with the case.

use crate::model::{Inputs, Solution, Stages};

/// A request to solve variants.
#[derive(Debug, Clone)]
pub struct VariantsRequest {
    /// The serial of the request for the case.
    pub(crate) serial: u64,
    /// The name of each variant, and its pair or the error in it.
    pub(crate) columns: Vec<(String, Result<Inputs, String>)>,
    /// The stages to solve.
    pub(crate) stages: Stages,
}

/// Solved variants.
#[derive(Debug, Clone)]
pub struct Variants {
    /// The serial of the request.
    pub(crate) serial: u64,
    /// The name of each variant, and its results or the reason of their absence.
    pub(crate) columns: Vec<(String, Result<Solution, String>)>,
}
