//! A request to solve a case, and the answer with every method.

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

/// After this time the workbench shows the closed form until the slower method is finished.
pub(super) const PATIENCE: Duration = Duration::from_millis(30);

/// A request to solve a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Number of the request, which identifies outdated answers.
    pub serial: u64,
    /// The case.
    pub case: Case,
    /// The pair.
    pub inputs: Inputs,
    /// The stages of the visible results.
    pub stages: Stages,
    /// Whether the chart of the mesh stiffness is visible.
    pub stiffness: bool,
}

/// The results of every method for a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The serial of the request.
    pub serial: u64,
    /// The present stages, if the methods have them: the requested stages, or these without the
    /// late stages while the worker computes them.
    pub stages: Stages,
    /// The requested stages.
    pub requested: Stages,
    /// The solved pair.
    pub inputs: Inputs,
    /// The method of the main results: the method of the case, or `exact` until that method is
    /// finished.
    pub active: Method,
    /// The method that the worker still solves.
    pub pending: Option<Method>,
    /// The cost of the answer.
    pub cost: Cost,
    /// Every method, fastest first.
    pub methods: Vec<(Method, Result<Solution, Refusal>)>,
    /// Notes on the active result.
    pub notes: Vec<Note>,
    /// The mesh stiffness by every model, or the refusal; `None` until it is computed.
    pub stiffness: Option<MeshStiffness>,
}

/// The mesh stiffness by every model, or the refusal.
pub(crate) type MeshStiffness = Result<Arc<PathComparison>, Refusal>;

/// A value of each quantity, in SI, in the order of [`QUANTITIES`].
pub(crate) type Values = Box<[Option<f64>]>;

/// The cost of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Number of stages that ran, over all methods; the others were cached.
    pub(crate) stages: usize,
    /// Run time, in us.
    pub(crate) micros: u64,
}

impl Answer {
    /// The solution of a method, if any.
    #[must_use]
    pub fn of(&self, method: Method) -> Option<&Solution> {
        self.methods
            .iter()
            .find(|(own, _)| *own == method)
            .and_then(|(_, result)| result.as_ref().ok())
    }

    /// The method of this answer to compare with another active method: the same one if it was
    /// solved.
    #[must_use]
    pub(crate) fn beside(&self, active: Method) -> Method {
        if self.of(active).is_some() { active } else { self.active }
    }

    /// Whether the incoming tooth strikes, by the active method.
    #[must_use]
    pub(crate) fn strikes(&self) -> bool {
        self.of(self.active).is_some_and(|solution| solution.outcome == Outcome::CornerContact)
    }

    /// Whether all requested stages are present.
    #[must_use]
    pub(crate) fn is_whole(&self) -> bool {
        self.stages.covers(self.requested)
    }

    /// Whether a requested stage is missing.
    #[must_use]
    pub fn lacks(&self, stage: Stage) -> bool {
        self.requested.has(stage) && !self.stages.has(stage)
    }

    /// The value of every quantity by the active method.
    #[must_use]
    pub(crate) fn values(&self) -> Values {
        let solution = self.of(self.active);
        QUANTITIES.iter().map(|quantity| quantity.finite_value(solution?)).collect()
    }

    /// The refusal of the active method, if it refuses the case.
    #[must_use]
    pub(crate) fn refusal(&self) -> Option<&Refusal> {
        self.methods
            .iter()
            .find(|(own, _)| *own == self.active)
            .and_then(|(_, result)| result.as_ref().err())
    }
}
