//! A request to solve a case, and the answer with every method.

use std::cell::{Cell, RefCell};
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::case::Evaluator;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Note, Outcome, QUANTITIES, Refusal, Solution, Stage, Stages};
use crate::study::stiffness::{PATH_POINTS, PathComparison, compare_path};

/// After this time the workbench shows the closed form until the slower method is finished.
const PATIENCE: Duration = Duration::from_millis(30);

/// Panics or blocks forever if a test requests a fault at this place.
#[cfg(debug_assertions)]
#[expect(clippy::panic, reason = "a test requests the fault")]
pub(super) fn on_demand(place: &str) {
    match std::env::var("TIPSTRIKE_FAULT").unwrap_or_default() {
        asked if asked == place => panic!("a fault on demand"),
        asked if asked.strip_prefix("stuck ") == Some(place) => loop {
            std::thread::park();
        },
        _ => {}
    }
}

/// Does nothing.
#[cfg(not(debug_assertions))]
pub(super) fn on_demand(_place: &str) {}

/// A request to solve a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Number of the request, which identifies outdated answers.
    pub serial: u64,
    /// The pair.
    pub inputs: Inputs,
    /// The visible part of the results.
    pub wanted: Wanted,
}

/// The visible part of the results.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The stages of the visible results.
    pub stages: Stages,
    /// Whether the chart of the mesh stiffness is visible.
    pub(crate) stiffness: bool,
    /// Whether method `paper` is visible beside another method.
    pub(crate) paper: bool,
}

impl Wanted {
    pub(crate) const NOTHING: Wanted =
        Wanted { stages: Stages::NONE, stiffness: false, paper: false };

    /// Whether this part contains another one.
    pub(crate) fn covers(self, other: Wanted) -> bool {
        self.stages.covers(other.stages)
            && self.stiffness >= other.stiffness
            && self.paper >= other.paper
    }
}

/// The results of every method for a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The serial of the request.
    pub serial: u64,
    /// The present stages, if the methods have them: the requested stages, or these without the
    /// late stages while the worker computes them.
    pub stages: Stages,
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
    pub fn of(&self, method: Method) -> Option<&Solution> {
        self.result(method)?.as_ref().ok()
    }

    fn result(&self, method: Method) -> Option<&Result<Solution, Refusal>> {
        self.methods.iter().find(|(own, _)| *own == method).map(|(_, result)| result)
    }

    /// The method of this answer to compare with another active method: the same one if it was
    /// solved.
    pub(crate) fn beside(&self, active: Method) -> Method {
        if self.of(active).is_some() { active } else { self.active }
    }

    /// Whether the incoming tooth strikes, by the active method.
    pub(crate) fn strikes(&self) -> bool {
        self.of(self.active).is_some_and(|solution| solution.outcome == Outcome::CornerContact)
    }

    /// Whether a stage was solved by a method.
    pub(crate) fn has(&self, method: Method, stage: Stage) -> bool {
        self.of(method).is_some() && method.stages().has(stage) && self.stages.has(stage)
    }

    /// The value of every quantity by the active method.
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
    pub(crate) fn refusal(&self) -> Option<&Refusal> {
        self.result(self.active)?.as_ref().err()
    }
}

/// Pinned results.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// The name of the case.
    pub name: String,
    /// Its results.
    pub answer: Answer,
}

/// Solved variants.
#[derive(Debug, Clone)]
pub(crate) struct Variants {
    /// The serial of the request.
    pub(crate) serial: u64,
    /// The case by the method of the variants, if `auto` chose another method for the case alone.
    pub(crate) case: Option<Answer>,
    /// The name of each variant, and its results or the reason of their absence.
    pub(crate) columns: Vec<(String, Result<Solution, String>)>,
}

/// Solves with the closed forms and with the method of the case, which may take long.
pub fn answer(request: &Request) -> Answer {
    let evaluator = &mut Evaluator::default();
    let mut last = None;
    solve(evaluator, request, &mut |answer| last = Some(answer.clone()), &|_| true);
    last.unwrap_or_else(|| at_once(evaluator, request, Instant::now()).with_notes())
}

/// Shows the results of the closed forms, of the method of the case and, for `dynamic`, of the load
/// at rest: the answer that is present after [`PATIENCE`], before each part that others must not wait
/// for, and at the end. `None` if `go_on` returns false.
pub(super) fn solve(
    evaluator: &mut Evaluator,
    request: &Request,
    show: &mut dyn FnMut(&Answer),
    go_on: &dyn Fn(f64) -> bool,
) -> Option<()> {
    let (begun, wanted) = (Instant::now(), request.wanted);
    let mut answer = at_once(evaluator, request, begun);
    if let Some(method) = answer.pending {
        let (show, waits) = (RefCell::new(&mut *show), Cell::new(true));
        let go_on = |part| {
            if begun.elapsed() > PATIENCE && waits.replace(false) {
                (*show.borrow_mut())(&answer.clone().with_notes());
            }
            go_on(part)
        };
        // A slow method is solved without its late stages.
        let stages = wanted.stages.except(Stages::LATE);
        let found =
            Refusal::unless_stopped(evaluator.solve(&request.inputs, method, stages, &go_on))
                .ok()?;
        // If the program chose the method, the chosen method is active.
        let active = found.as_ref().map_or(method, |solution| solution.method);
        // The edit did not change the late stages that are present.
        let present = found.as_ref().map_or(Stages::NONE, |solution| {
            solution.stages.and(wanted.stages.except(active.stages()))
        });
        let stages = stages.and(present.within(wanted.stages));
        let mut solved = Vec::new();
        if active == Method::Dynamic {
            // The required relief of the load at rest is fast to compute and is compared with that
            // of the motion.
            let stages = wanted.stages.without(Stage::StaticSpectrum);
            let rest = evaluator.solve(&request.inputs, Method::Static, stages, &|_| go_on(1.0));
            solved.push((Method::Static, Refusal::unless_stopped(rest).ok()?));
        }
        solved.push((active, found));
        answer = Answer { active, pending: None, stages, ..answer };
        answer.methods.retain(|(known, _)| *known != active);
        answer.methods.extend(solved);
        answer.cost = Cost { stages: stages_run(&answer.methods), micros: micros(begun) };
    }
    answer = answer.with_notes();
    if wanted.stiffness {
        // The finite elements of new gears are slow.
        show(&answer);
        if !go_on(1.0) {
            return None;
        }
        answer.stiffness = Some(compare_path(&request.inputs, PATH_POINTS).map(Arc::new));
    }
    // The motion over the speed is last.
    let has_speeds = answer.active.stages().has(Stage::SpeedRun);
    let first = has_speeds.then(|| wanted.stages.without(Stage::SpeedRun));
    for stages in first.into_iter().chain([wanted.stages]) {
        if answer.stages.covers(stages) || answer.refusal().is_some() {
            continue;
        }
        show(&answer);
        let (inputs, method) = (&request.inputs, request.inputs.method);
        let found = Refusal::unless_stopped(evaluator.solve(inputs, method, stages, go_on)).ok()?;
        answer.cost.stages += found.as_ref().map_or(0, |solution| solution.ran.iter().count());
        answer.cost.micros = micros(begun);
        answer.methods.retain(|(known, _)| *known != answer.active);
        answer.methods.push((answer.active, found));
        answer = Answer { stages, ..answer }.with_notes();
    }
    answer.stages = wanted.stages;
    show(&answer);
    Some(())
}

/// The answer of the closed forms, without notes.
fn at_once(evaluator: &mut Evaluator, request: &Request, begun: Instant) -> Answer {
    let asked = request.inputs.method;
    let stages = request.wanted.stages;
    let is_shown =
        |method: &Method| *method != Method::Paper || asked == *method || request.wanted.paper;
    let methods: Vec<_> = Method::CLOSED_FORM
        .into_iter()
        .filter(is_shown)
        .map(|method| (method, evaluator.solve(&request.inputs, method, stages, &|_| true)))
        .collect();
    let pending = Some(asked).filter(|method| !Method::CLOSED_FORM.contains(method));
    Answer {
        serial: request.serial,
        stages,
        inputs: request.inputs.clone(),
        active: if pending.is_some() { Method::Exact } else { asked },
        pending,
        cost: Cost { stages: stages_run(&methods), micros: micros(begun) },
        methods,
        notes: Vec::new(),
        stiffness: None,
    }
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
    use crate::case::Case;

    fn request(method: Method) -> Request {
        let mut inputs = Case::table_1().inputs().expect("Table 1 is valid");
        inputs.method = method;
        let wanted = Wanted { stages: Stages::EVERY, ..Wanted::NOTHING };
        Request { serial: 1, inputs, wanted }
    }

    #[test]
    fn the_method_of_the_case_is_active_and_auto_gives_its_choice() {
        for (method, active) in [
            (Method::Paper, Method::Paper),
            (Method::Static, Method::Static),
            (Method::Auto, Method::Dynamic),
        ] {
            let found = answer(&request(method));
            assert_eq!((found.active, found.pending), (active, None));
            assert!(found.of(active).is_some() && found.of(Method::Exact).is_some());
        }
    }

    /// Every shown answer.
    fn shown(request: &Request, go_on: &dyn Fn(f64) -> bool) -> Vec<Answer> {
        shown_by(&mut Evaluator::default(), request, go_on)
    }

    fn shown_by(
        evaluator: &mut Evaluator,
        request: &Request,
        go_on: &dyn Fn(f64) -> bool,
    ) -> Vec<Answer> {
        let mut shown = Vec::new();
        solve(evaluator, request, &mut |answer| shown.push(answer.clone()), go_on);
        shown
    }

    #[test]
    fn only_visible_methods_are_solved() {
        let mut asked = request(Method::Exact);
        let methods = |asked: &Request| {
            answer(asked).methods.into_iter().map(|(method, _)| method).collect::<Vec<_>>()
        };
        assert_eq!(methods(&asked), [Method::Exact]);
        asked.wanted.paper = true;
        assert_eq!(methods(&asked), Method::CLOSED_FORM);
        assert_eq!(shown(&asked, &|_| true).len(), 1);
    }

    #[test]
    fn a_slow_method_shows_the_closed_form_and_can_be_stopped() {
        let mut slow = request(Method::Dynamic);
        (slow.inputs.tolerance, slow.inputs.warmup_cycles) = (1e-12, 10_000);
        // Without damping the motion never becomes steady.
        slow.inputs.damping_ratio = 0.0;
        let begun = Instant::now();
        let shown = shown(&slow, &|_| begun.elapsed() < 4 * PATIENCE);
        assert_eq!(
            shown.iter().map(|answer| (answer.active, answer.pending)).collect::<Vec<_>>(),
            [(Method::Exact, Some(Method::Dynamic))]
        );
    }

    #[test]
    fn the_required_relief_follows_an_answer_that_is_already_shown() {
        for (method, expected) in [
            (Method::Exact, vec![true]),
            (Method::Static, vec![false, true]),
            (Method::Auto, vec![false, true]),
        ] {
            let shown = shown(&request(method), &|_| true);
            let whole = shown.into_iter().filter(|answer| answer.pending.is_none());
            let found = whole.map(|answer| {
                let clearing = answer.of(answer.active).and_then(|solution| solution.clearing);
                assert_eq!(clearing.is_some(), answer.stages.has(Stage::Clearing));
                clearing.is_some_and(|clearing| clearing.relief.is_some())
            });
            assert_eq!(found.collect::<Vec<_>>(), expected, "{}", method.name());
        }
    }

    #[test]
    fn the_relief_at_rest_is_present_during_the_search_in_motion() {
        let (asked, mut evaluator) = (request(Method::Dynamic), Evaluator::default());
        let shown = shown_by(&mut evaluator, &asked, &|_| true);
        let answer = shown.iter().find(|answer| answer.pending.is_none()).expect("an answer");
        let relief = |method| answer.of(method).and_then(|solution| solution.clearing);
        assert!(!answer.stages.has(Stage::Clearing) && relief(Method::Dynamic).is_none());
        assert!(relief(Method::Static).is_some_and(|clearing| clearing.relief.is_some()));
        let again = shown_by(&mut evaluator, &asked, &|_| true);
        assert_eq!(again.len(), 1);
        let [found, again] = [&shown[shown.len() - 1], &again[0]].map(|it| it.of(Method::Dynamic));
        assert_eq!(found.and_then(|found| found.clearing), again.and_then(|found| found.clearing));
    }
}
