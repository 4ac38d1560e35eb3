//! Pinned results, which all others are compared with.

use super::solver::Answer;
use crate::case::Case;

/// Pinned results.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// The tab in which it was, for as long as that is open.
    pub(crate) tab: usize,
    /// The name of the case.
    pub name: String,
    /// Whether that is the name of a file.
    pub(crate) is_file: bool,
    pub(crate) case: Case,
    /// Its results.
    pub answer: Answer,
}
