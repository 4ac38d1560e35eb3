//! A request for a solve: the inputs, the stages to compute, and the results of an earlier solve.

use std::cell::Cell;

use super::Solution;
use super::inputs::Inputs;
use super::stage::{Stage, Stages};

/// An earlier solve by the same method.
#[derive(Debug, Clone, Copy)]
pub struct Earlier<'a> {
    /// Its inputs.
    pub inputs: &'a Inputs,
    /// Its results.
    pub solution: &'a Solution,
}

pub(super) struct Request<'a> {
    pub(super) inputs: &'a Inputs,
    pub(super) wanted: Stages,
    pub(super) earlier: Option<Earlier<'a>>,
    /// The stages whose results differ from the earlier ones.
    pub(super) changed: Cell<Stages>,
}

impl<'a> Request<'a> {
    /// The earlier solution if its result of this stage is still valid: the stage has the same
    /// inputs from the case and from other stages.
    pub(super) fn kept(&self, stage: Stage) -> Option<&'a Solution> {
        let Earlier { inputs, solution } = self.earlier?;
        let is_valid = solution.stages.has(stage)
            && stage.depends_on().within(self.changed.get()) == Stages::NONE
            && stage.has_equal_inputs(self.inputs, inputs);
        is_valid.then_some(solution)
    }

    /// Records whether a new result equals the earlier one, by the comparison `same`.
    pub(super) fn note(&self, stage: Stage, same: impl FnOnce(&Solution) -> bool) {
        let is_same = self
            .earlier
            .is_some_and(|earlier| earlier.solution.stages.has(stage) && same(earlier.solution));
        if !is_same {
            self.changed.set(self.changed.get().with(stage));
        }
    }
}
