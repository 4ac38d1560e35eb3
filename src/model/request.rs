//! What a solve is asked for, and what of an earlier one still holds.

use super::Solution;
use super::inputs::Inputs;
use super::stage::{Stage, Stages};

/// An earlier solve of the same method, and the stages whose results no longer hold.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// What was found.
    pub solution: &'a Solution,
    /// What the edits since then reach.
    pub stale: Stages,
}

/// What a solve is asked for.
pub(super) struct Request<'a> {
    pub(super) inputs: &'a Inputs,
    pub(super) wanted: Stages,
    pub(super) earlier: Option<Earlier<'a>>,
}

impl<'a> Request<'a> {
    /// The earlier solution, where this stage's result of it still holds.
    pub(super) fn kept(&self, stage: Stage) -> Option<&'a Solution> {
        let Earlier { solution, stale } = self.earlier?;
        (solution.stages.has(stage) && !stale.has(stage)).then_some(solution)
    }
}
