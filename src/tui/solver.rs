//! The one worker that solves: the latest request wins, a slow method gives way to it, and a fault
//! in it never takes the screen down.

mod methods;

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

pub use methods::{answer, first_answer};
use methods::{cleared, solved};

use super::fault;
use super::latest_request::LatestRequest;
use crate::case::{Case, Evaluator};
use crate::model::inputs::Method;
use crate::model::{Inputs, Note, Outcome, QUANTITIES, Refusal, Solution, Stage, Stages};

/// So long a slow method may take before the closed form's answer is shown in its place.
const PATIENCE: Duration = Duration::from_millis(30);

/// What takes longer is told of, with how much of it is done,
const LONG: Duration = Duration::from_secs(1);
/// and again after so long.
const STEP: Duration = Duration::from_millis(200);

/// The name of the worker's thread.
pub const THREAD: &str = "solver";

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
}

/// What the methods say of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The request's.
    pub serial: u64,
    /// The stages that it holds, as far as the methods have them: those that were asked for, or all
    /// but the least relief while that one is still being sought.
    pub stages: Stages,
    /// The stages that were asked for.
    pub asked: Stages,
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
}

/// A value of each quantity, in SI, in the order of [`QUANTITIES`].
pub type Values = Box<[Option<f64>]>;

/// What an answer took.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Stages that ran, over all methods; the others still held.
    pub stages: usize,
    /// Time, in us.
    pub micros: u64,
}

/// What comes back from the worker.
#[derive(Debug, Clone)]
pub enum Reply {
    /// It is solved.
    Solved(Box<Answer>),
    /// The solve of that serial takes its time; this part of it is done.
    Solving(u64, f64),
    /// The solver failed in a way that it never should.
    Failed(u64),
}

/// The worker's thread. It ends when this is dropped.
#[derive(Debug)]
pub struct Solver {
    slot: Arc<LatestRequest<Request>>,
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
    pub fn beside(&self, active: Method) -> Method {
        if self.of(active).is_some() {
            active
        } else {
            self.active
        }
    }

    /// Whether the incoming tooth strikes, by the active method.
    #[must_use]
    pub fn strikes(&self) -> bool {
        self.of(self.active)
            .is_some_and(|solution| solution.outcome == Outcome::CornerContact)
    }

    /// Whether a stage that was asked for is still to come.
    #[must_use]
    pub fn lacks(&self, stage: Stage) -> bool {
        self.asked.has(stage) && !self.stages.has(stage)
    }

    /// What the active method finds of every quantity.
    #[must_use]
    pub fn values(&self) -> Values {
        let solution = self.of(self.active);
        QUANTITIES
            .iter()
            .map(|quantity| solution.and_then(quantity.value))
            .collect()
    }

    /// The refusal of the active method, where it refuses.
    #[must_use]
    pub fn refusal(&self) -> Option<&Refusal> {
        self.methods
            .iter()
            .find(|(own, _)| *own == self.active)
            .and_then(|(_, result)| result.as_ref().err())
    }
}

impl Solver {
    /// Start the worker, which tells each reply until `tell` says that nobody listens.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(tell: impl Fn(Reply) -> bool + Send + 'static) -> std::io::Result<Solver> {
        let mut evaluator = Evaluator::default();
        let solve = move |request: &Request, wanted: Wanted<'_>| {
            let begun = Instant::now();
            let (waiting, told) = (Cell::new(Some(begun + PATIENCE)), Cell::new(begun + LONG));
            let go_on = |part: f64, at_once: &dyn Fn() -> Answer| {
                let now = Instant::now();
                if waiting.get().is_some_and(|until| now > until) {
                    waiting.set(None);
                    wanted.tell(Reply::Solved(Box::new(at_once())));
                } else if now > told.get() {
                    told.set(now + STEP);
                    wanted.tell(Reply::Solving(request.serial, part));
                }
                wanted.is_wanted()
            };
            let answer = solved(&mut evaluator, request, begun, &go_on)?;
            if answer.lacks(Stage::Clearing) && answer.strikes() {
                wanted.tell(Reply::Solved(Box::new(answer.clone())));
            }
            cleared(&mut evaluator, request, answer, begun, &|_| {
                wanted.is_wanted()
            })
        };
        Solver::start_with(solve, tell)
    }

    /// Start the worker with another way to solve, which may tell an answer before its last one,
    /// and is told when it is wanted no more.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start_with(
        mut solve: impl FnMut(&Request, Wanted<'_>) -> Option<Answer> + Send + 'static,
        tell: impl Fn(Reply) -> bool + Send + 'static,
    ) -> std::io::Result<Solver> {
        let slot = Arc::new(LatestRequest::default());
        let theirs: Arc<LatestRequest<Request>> = Arc::clone(&slot);
        thread::Builder::new()
            .name(THREAD.to_owned())
            .spawn(move || {
                while let Some(request) = theirs.take() {
                    let wanted = Wanted {
                        slot: &theirs,
                        tell: &tell,
                    };
                    let reply = attempt(&mut solve, &request, wanted);
                    if reply.is_some_and(|reply| !tell(reply)) {
                        return;
                    }
                }
            })?;
        Ok(Solver { slot })
    }

    /// Ask for a solve, in place of one that has not begun.
    pub fn ask(&self, request: Request) {
        self.slot.put(request);
    }

    /// What is being solved is not wanted any more.
    pub fn stop(&self) {
        self.slot.stop();
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        self.slot.close();
    }
}

/// Whether an answer is still wanted, and whom to tell one that is not the last.
#[derive(Clone, Copy)]
pub struct Wanted<'a> {
    slot: &'a LatestRequest<Request>,
    tell: &'a dyn Fn(Reply) -> bool,
}

impl Wanted<'_> {
    /// Whether no later request has come.
    #[must_use]
    pub fn is_wanted(&self) -> bool {
        self.slot.is_idle()
    }

    /// Tell what stands until the last answer is there.
    pub fn tell(&self, reply: Reply) {
        // Whether anybody listens shows when the last one is told.
        let _ = (self.tell)(reply);
    }
}

fn attempt(
    mut solve: impl FnMut(&Request, Wanted<'_>) -> Option<Answer>,
    request: &Request,
    wanted: Wanted<'_>,
) -> Option<Reply> {
    let solve = || {
        fault::on_demand(THREAD);
        solve(request, wanted)
    };
    match catch_unwind(AssertUnwindSafe(solve)) {
        Ok(answer) => answer.map(|answer| Reply::Solved(Box::new(answer))),
        Err(_) => Some(Reply::Failed(request.serial)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Sender, channel};

    fn request(serial: u64) -> Request {
        let case = Case::table_1();
        Request {
            serial,
            inputs: case.inputs().expect("Table 1 is valid"),
            case,
            stages: Stages::EVERY,
        }
    }

    fn teller(sender: Sender<Reply>) -> impl Fn(Reply) -> bool + Send + 'static {
        move |reply| sender.send(reply).is_ok()
    }

    #[test]
    fn a_panic_is_told_and_the_next_request_is_solved() {
        let (sender, replies) = channel();
        let solve = |request: &Request, _: Wanted<'_>| {
            assert!(request.serial != 1, "planted");
            Some(answer(request))
        };
        let solver = Solver::start_with(solve, teller(sender)).expect("a thread");
        solver.ask(request(1));
        assert!(matches!(replies.recv(), Ok(Reply::Failed(1))));
        solver.ask(request(2));
        assert!(matches!(replies.recv(), Ok(Reply::Solved(answer)) if answer.serial == 2));
    }

    #[test]
    fn the_latest_request_wins() {
        let (begun, has_begun) = channel();
        let (go, gate) = channel::<()>();
        let (sender, replies) = channel();
        let solve = move |request: &Request, _: Wanted<'_>| {
            begun.send(request.serial).expect("the test listens");
            gate.recv().expect("the test goes on");
            Some(answer(request))
        };
        let solver = Solver::start_with(solve, teller(sender)).expect("a thread");
        solver.ask(request(1));
        assert_eq!(has_begun.recv(), Ok(1));
        (2..=9).for_each(|serial| solver.ask(request(serial)));
        go.send(())
            .and_then(|()| go.send(()))
            .expect("the worker listens");
        let serials: Vec<_> = replies
            .iter()
            .take(2)
            .map(|reply| {
                if let Reply::Solved(answer) = reply {
                    answer.serial
                } else {
                    0
                }
            })
            .collect();
        assert_eq!(serials, [1, 9]);
    }

    #[test]
    fn a_slow_method_gives_way_to_a_later_request_and_shows_the_closed_form_meanwhile() {
        let (sender, replies) = channel();
        let solver = Solver::start(teller(sender)).expect("a thread");
        let mut slow = request(1);
        (
            slow.inputs.method,
            slow.inputs.tolerance,
            slow.inputs.warmup_cycles,
        ) = (Method::Dynamic, 1e-12, 10_000);
        // Nothing comes to rest.
        slow.inputs.damping_ratio = 0.0;
        solver.ask(slow);
        let first = replies.recv().expect("an answer");
        assert!(
            matches!(&first, Reply::Solved(answer) if answer.pending == Some(Method::Dynamic) && answer.active == Method::Exact)
        );
        solver.ask(request(2));
        let second = replies.recv().expect("an answer");
        assert!(
            matches!(&second, Reply::Solved(answer) if answer.serial == 2 && answer.pending.is_none()),
            "{second:?}"
        );
    }

    #[test]
    fn the_least_relief_follows_an_answer_that_stands_already_and_then_nothing() {
        let (sender, replies) = channel();
        let solver = Solver::start(teller(sender)).expect("a thread");
        for (serial, method, expected) in [
            (1, Method::Exact, vec![true]),
            (2, Method::Static, vec![false, true]),
            (3, Method::Auto, vec![false, true]),
        ] {
            let mut asked = request(serial);
            asked.inputs.method = method;
            solver.ask(asked);
            let mut told = Vec::new();
            while told.last() != Some(&true) {
                let Ok(Reply::Solved(answer)) = replies.recv() else {
                    continue;
                };
                // An answer too many to the request before would stand here.
                assert_eq!(answer.serial, serial);
                let clearing = answer
                    .of(answer.active)
                    .and_then(|solution| solution.clearing);
                if answer.pending.is_none() {
                    assert_eq!(clearing.is_none(), answer.lacks(Stage::Clearing));
                    told.push(clearing.is_some_and(|clearing| clearing.relief.is_some()));
                }
            }
            assert_eq!(told, expected, "{}", method.name());
        }
    }

    #[test]
    fn the_relief_at_rest_is_known_while_that_in_motion_is_sought() {
        let (sender, replies) = channel();
        let solver = Solver::start(teller(sender)).expect("a thread");
        let mut asked = request(1);
        asked.inputs.method = Method::Dynamic;
        solver.ask(asked);
        let first = replies.iter().find_map(|reply| match reply {
            Reply::Solved(answer) if answer.pending.is_none() => Some(answer),
            _ => None,
        });
        let answer = first.expect("an answer");
        let relief = |method| answer.of(method).and_then(|solution| solution.clearing);
        assert!(answer.lacks(Stage::Clearing) && relief(Method::Dynamic).is_none());
        assert!(relief(Method::Static).is_some_and(|clearing| clearing.relief.is_some()));
    }

    #[test]
    fn the_method_of_the_case_stands_first_and_auto_is_told_by_its_choice() {
        for (method, active) in [
            (Method::Paper, Method::Paper),
            (Method::Static, Method::Static),
            (Method::Auto, Method::Dynamic),
        ] {
            let mut asked = request(1);
            asked.inputs.method = method;
            let found = answer(&asked);
            assert_eq!((found.active, found.pending), (active, None));
            assert!(found.of(active).is_some() && found.of(Method::Exact).is_some());
        }
    }
}
