//! Solves cases for reports: every result exists before it is rendered.

use super::compare::ComparedCase;
use super::digest::Digest;
use super::{Report, Selection, verdict};
use crate::case::units::System;
use crate::case::{Case, Evaluator, Problem};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Refusal, Stage, Stages};

impl Report {
    /// Solves the case as far as the selection and the outcome of the method need it.
    ///
    /// # Errors
    /// The refusal of the model.
    pub fn solve(
        name: String,
        case: Case,
        inputs: Inputs,
        selection: Selection,
    ) -> Result<Report, Refusal> {
        let inputs = inputs.needing(selection.only.iter().map(|quantity| quantity.stage));
        let solution =
            model::solve(&inputs, selection.stages().and(inputs.method.deciding_stages()))?;
        Ok(Report::of(name, case, inputs, solution, selection))
    }

    /// The report with the load at rest, if `dynamic` governs, and the closed forms. A method that
    /// refuses the case is left out.
    #[must_use]
    pub fn with_others(mut self) -> Report {
        let governing = self.solution.method;
        let stages = Stages::of(Stage::Clearing).and(Stages::of(Stage::Impact));
        let at_rest = (governing == Method::Dynamic).then_some(Method::Static);
        let methods = at_rest.into_iter().chain([Method::Exact, Method::Paper]);
        let methods = methods.filter(|&method| method != governing);
        if self.selection.is_whole() {
            self.others = methods
                .filter_map(|method| {
                    model::solve(&Inputs { method, ..self.inputs.clone() }, stages).ok()
                })
                .collect();
        }
        self
    }
}

/// Solves a case for a comparison.
#[must_use]
pub fn compared(name: String, case: Case, selection: &Selection) -> ComparedCase {
    let found = case.inputs().and_then(|inputs| {
        Report::solve(name.clone(), case.clone(), inputs, selection.clone())
            .map_err(|refusal| vec![Problem::from(&refusal).at_given(&case)])
    });
    ComparedCase { name, file: String::new(), variant: None, case, found }
}

/// Solves a case as far as its digest needs it: outcome, notes and limits. Returns `None` if `go_on`
/// returns false.
#[must_use]
pub fn digest(
    case: &Case,
    inputs: &Inputs,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Digest> {
    let shared = match inputs.method {
        Method::Static => Stages::of(Stage::Static),
        Method::Dynamic | Method::Auto => Stages::of(Stage::Dynamic),
        Method::Paper | Method::Exact => Stages::NONE,
    };
    let stages = verdict::stages(case).and(Stages::CLOSED_FORM).and(shared);
    match Evaluator::default().solve(inputs, inputs.method, stages, go_on) {
        Err(Refusal::Stopped) => None,
        found => Some(Digest::of(case, inputs, found.as_ref(), system)),
    }
}
