//! A request to solve a case, and the answer of every method.

mod methods;

use std::sync::Arc;
use std::time::Duration;

pub use methods::answer;
pub(crate) use methods::answer_without_fields;
pub(super) use methods::{cleared, solved, with_stiffness};

use crate::case::Case;
use crate::model::inputs::Method;
use crate::model::{Inputs, Note, Outcome, QUANTITIES, Refusal, Solution, Stage, Stages};
use crate::study::stiffness::PathComparison;

/// After this time the closed form's answer is shown in place of that of a slow method.
pub(super) const PATIENCE: Duration = Duration::from_millis(30);

/// A case to be solved.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Counts the edits, so that a late answer is known as such.
    pub serial: u64,
    /// The case.
    pub case: Case,
    /// The pair that it describes.
    pub inputs: Inputs,
    /// The stages whose results are in sight.
    pub stages: Stages,
    /// Whether the chart of the mesh stiffness is in sight.
    pub stiffness: bool,
}

/// What the methods say of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The request's.
    pub serial: u64,
    /// The stages that it holds, as far as the methods have them: those that were asked for, or all
    /// but the late ones while those are still being computed.
    pub stages: Stages,
    /// The stages that were asked for.
    pub requested: Stages,
    /// The pair, as it was solved.
    pub inputs: Inputs,
    /// The method whose results stand first: that of the case, or `exact` while that one is not
    /// done.
    pub active: Method,
    /// The method that is still being solved.
    pub pending: Option<Method>,
    /// What it took.
    pub cost: Cost,
    /// Every method, cheapest first.
    pub methods: Vec<(Method, Result<Solution, Refusal>)>,
    /// What a reader must know beside the active result.
    pub notes: Vec<Note>,
    /// The mesh stiffness by every model, or why there is none; `None` until it is computed.
    pub stiffness: Option<MeshStiffness>,
}

/// The mesh stiffness by every model, or why there is none.
pub(crate) type MeshStiffness = Result<Arc<PathComparison>, Refusal>;

/// A value of each quantity, in SI, in the order of [`QUANTITIES`].
pub(crate) type Values = Box<[Option<f64>]>;

/// What an answer took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Stages that ran, over all methods; the others still held.
    pub(crate) stages: usize,
    /// Time, in us.
    pub(crate) micros: u64,
}

impl Answer {
    /// The solution of a method, where there is one.
    #[must_use]
    pub fn of(&self, method: Method) -> Option<&Solution> {
        self.methods
            .iter()
            .find(|(own, _)| *own == method)
            .and_then(|(_, result)| result.as_ref().ok())
    }

    /// The method of this one that another's active method is held against: the same one, where it
    /// was solved.
    #[must_use]
    pub(crate) fn beside(&self, active: Method) -> Method {
        if self.of(active).is_some() {
            active
        } else {
            self.active
        }
    }

    /// Whether the incoming tooth strikes, by the active method.
    #[must_use]
    pub(crate) fn strikes(&self) -> bool {
        self.of(self.active)
            .is_some_and(|solution| solution.outcome == Outcome::CornerContact)
    }

    /// Whether no stage that was asked for is still to come.
    #[must_use]
    pub(crate) fn is_whole(&self) -> bool {
        self.stages.covers(self.requested)
    }

    /// Whether a stage that was asked for is still to come.
    #[must_use]
    pub fn lacks(&self, stage: Stage) -> bool {
        self.requested.has(stage) && !self.stages.has(stage)
    }

    /// What the active method finds of every quantity.
    #[must_use]
    pub(crate) fn values(&self) -> Values {
        let solution = self.of(self.active);
        QUANTITIES
            .iter()
            .map(|quantity| solution.and_then(quantity.value))
            .collect()
    }

    /// The refusal of the active method, where it refuses.
    #[must_use]
    pub(crate) fn refusal(&self) -> Option<&Refusal> {
        self.methods
            .iter()
            .find(|(own, _)| *own == self.active)
            .and_then(|(_, result)| result.as_ref().err())
    }
}
