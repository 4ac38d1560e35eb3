//! A request to solve a case, and the answer with every method.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::case::{Case, Evaluator};
use crate::model::compliance::without_field;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Note, Outcome, QUANTITIES, Refusal, Solution, Stage, Stages};
use crate::study::stiffness::{PATH_POINTS, PathComparison, compare_path};

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

    /// The answer with the notes on its active result.
    fn with_notes(self) -> Answer {
        let notes = self.of(self.active).map(|solution| model::notes(&self.inputs, solution));
        Answer { notes: notes.unwrap_or_default(), ..self }
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

/// Solved variants.
#[derive(Debug, Clone)]
pub(crate) struct Variants {
    /// The serial of the request.
    pub(crate) serial: u64,
    /// The name of each variant, and its results or the reason of their absence.
    pub(crate) columns: Vec<(String, Result<Solution, String>)>,
}

/// Solves with the closed forms and with the method of the case, which may take long.
#[must_use]
pub fn answer(request: &Request) -> Answer {
    answer_while(request, &|| true)
}

/// The answer for the first frame of the program, which does not wait for elastic fields: without
/// the stiffness spread, and `None` if the compliance of the pair needs a field.
#[must_use]
pub(crate) fn answer_without_fields(request: &Request) -> Option<Answer> {
    let methods = Method::CLOSED_FORM.into_iter().chain([request.inputs.method]);
    let needs_field = methods.into_iter().any(|method| {
        let inputs = Inputs { method, ..request.inputs.clone() };
        without_field(&inputs).is_some()
    });
    if needs_field {
        return None;
    }
    let quick = Request {
        stages: request.stages.without(Stage::Band),
        stiffness: false,
        ..request.clone()
    };
    let start = Instant::now();
    let answer = answer_while(&quick, &|| start.elapsed() < PATIENCE);
    Some(Answer { requested: request.stages, ..answer })
}

/// The answer with the mesh stiffness by every model, if it is requested.
pub(super) fn with_stiffness(request: &Request, answer: Answer) -> Answer {
    if !request.stiffness {
        return answer;
    }
    let found = compare_path(&request.inputs, PATH_POINTS).map(Arc::new);
    Answer { stiffness: Some(found), ..answer }
}

/// The results of the closed forms, of the method of the case and, for `dynamic`, of the load at
/// rest; a slow method is solved without its late stages. `go_on` may show the present answer;
/// returns `None` if it returns false.
pub(super) fn solved(
    evaluator: &mut Evaluator,
    request: &Request,
    begun: Instant,
    go_on: &dyn Fn(f64, &dyn Fn() -> Answer) -> bool,
) -> Option<Answer> {
    let first = at_once(evaluator, request, begun);
    let Some(method) = first.pending else {
        return Some(first);
    };
    let stages = request.stages.except(Stages::LATE);
    let found =
        evaluator.solve(&request.inputs, method, stages, &|part| go_on(part, &|| first.clone()));
    if matches!(found, Err(Refusal::Stopped)) {
        return None;
    }
    // If the program chose the method, the chosen method is active.
    let active = found.as_ref().map_or(method, |solution| solution.method);
    let mut answer = Answer { active, pending: None, stages, ..first.clone() };
    answer.methods.retain(|(known, _)| *known != active);
    if active == Method::Dynamic {
        // The required relief of the load at rest is fast to compute and is compared with that of
        // the motion.
        let stages = request.stages.without(Stage::StaticSpectrum);
        let shared = evaluator
            .solve(&request.inputs, Method::Static, stages, &|_| go_on(1.0, &|| first.clone()));
        if matches!(shared, Err(Refusal::Stopped)) {
            return None;
        }
        answer.methods.push((Method::Static, shared));
    }
    answer.methods.push((active, found));
    answer.cost = Cost { stages: stages_run(&answer.methods), micros: micros(begun) };
    Some(answer.with_notes())
}

/// The answer with the late stages, if they are requested and missing; `None` if `go_on` returns
/// false.
pub(super) fn cleared(
    evaluator: &mut Evaluator,
    request: &Request,
    mut answer: Answer,
    begun: Instant,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Answer> {
    if answer.is_whole() {
        return Some(answer);
    }
    if answer.refusal().is_some() {
        return Some(Answer { stages: request.stages, ..answer });
    }
    let found = evaluator.solve(&request.inputs, request.inputs.method, request.stages, go_on);
    if matches!(found, Err(Refusal::Stopped)) {
        return None;
    }
    answer.stages = request.stages;
    answer.cost.stages += found.as_ref().map_or(0, |solution| solution.ran.iter().count());
    answer.cost.micros = micros(begun);
    answer.methods.retain(|(known, _)| *known != answer.active);
    answer.methods.push((answer.active, found));
    Some(answer.with_notes())
}

fn answer_while(request: &Request, go_on: &dyn Fn() -> bool) -> Answer {
    let (begun, evaluator) = (Instant::now(), &mut Evaluator::default());
    let Some(found) = solved(evaluator, request, begun, &|_, _| go_on()) else {
        return at_once(evaluator, request, begun);
    };
    let found = cleared(evaluator, request, found.clone(), begun, &|_| go_on()).unwrap_or(found);
    with_stiffness(request, found)
}

/// The answer of the closed forms.
fn at_once(evaluator: &mut Evaluator, request: &Request, begun: Instant) -> Answer {
    let asked = request.inputs.method;
    let methods: Vec<_> = Method::CLOSED_FORM
        .into_iter()
        .map(|method| (method, evaluator.solve(&request.inputs, method, request.stages, &|_| true)))
        .collect();
    let pending = Some(asked).filter(|method| !Method::CLOSED_FORM.contains(method));
    let answer = Answer {
        serial: request.serial,
        stages: request.stages,
        requested: request.stages,
        inputs: request.inputs.clone(),
        active: if pending.is_some() { Method::Exact } else { asked },
        pending,
        cost: Cost { stages: stages_run(&methods), micros: micros(begun) },
        methods,
        notes: Vec::new(),
        stiffness: None,
    };
    answer.with_notes()
}

fn stages_run(methods: &[(Method, Result<Solution, Refusal>)]) -> usize {
    methods
        .iter()
        .filter_map(|(_, found)| found.as_ref().ok())
        .map(|solution| solution.ran.iter().count())
        .sum()
}

fn micros(begun: Instant) -> u64 {
    u64::try_from(begun.elapsed().as_micros()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_method_of_the_case_is_active_and_auto_gives_its_choice() {
        for (method, active) in [
            (Method::Paper, Method::Paper),
            (Method::Static, Method::Static),
            (Method::Auto, Method::Dynamic),
        ] {
            let case = Case::table_1();
            let mut inputs = case.inputs().expect("Table 1 is valid");
            inputs.method = method;
            let asked =
                Request { serial: 1, inputs, case, stages: Stages::EVERY, stiffness: false };
            let found = answer(&asked);
            assert_eq!((found.active, found.pending), (active, None));
            assert!(found.of(active).is_some() && found.of(Method::Exact).is_some());
        }
    }
}
