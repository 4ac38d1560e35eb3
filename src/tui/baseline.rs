//! Pinned results, the reference of comparisons.

use super::solver::Answer;
use crate::case::Case;

/// Pinned results.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// The tab of the results while it is open.
    pub(crate) tab: usize,
    /// The name of the case.
    pub name: String,
    /// Whether the name is the name of a file.
    pub(crate) is_file: bool,
    pub(crate) case: Case,
    /// Its results.
    pub answer: Answer,
}
