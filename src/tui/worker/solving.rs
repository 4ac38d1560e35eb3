//! The worker of the solves. A later request interrupts a slow method, and the closed form is shown
//! meanwhile.

use std::cell::Cell;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use super::{Send, Worker, on_demand};
use crate::case::Evaluator;
use crate::model::Stage;
use crate::tui::app::actions::Action;
use crate::tui::solver::{Answer, PATIENCE, Request, cleared, solved, with_stiffness};

/// A solve that takes longer shows its progress.
const LONG: Duration = Duration::from_millis(400);
/// Time between two reports of the progress.
const STEP: Duration = Duration::from_millis(200);

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(send: Send) -> io::Result<Worker<Request>> {
    let mut evaluator = Evaluator::default();
    Worker::start("solver", send, move |request: Request, is_wanted, send| {
        let found = catch_unwind(AssertUnwindSafe(|| {
            on_demand("solver");
            solve(&mut evaluator, &request, is_wanted, send)
        }));
        match found {
            Ok(Some(answer)) => send(Action::Solved(Box::new(answer))),
            Ok(None) => (),
            Err(_) => send(Action::SolverFailed(request.serial)),
        }
    })
}

// Sends intermediate answers of a slow solve and returns the last one.
fn solve(
    evaluator: &mut Evaluator,
    request: &Request,
    is_wanted: &dyn Fn() -> bool,
    send: &dyn Fn(Action),
) -> Option<Answer> {
    let begun = Instant::now();
    let (waiting, next_progress) = (Cell::new(Some(begun + PATIENCE)), Cell::new(begun + LONG));
    let go_on = |part: f64, at_once: &dyn Fn() -> Answer| {
        let now = Instant::now();
        if waiting.get().is_some_and(|until| now > until) {
            waiting.set(None);
            send(Action::Solved(Box::new(at_once())));
        } else if now > next_progress.get() {
            next_progress.set(now + STEP);
            send(Action::Solving(request.serial, part));
        }
        is_wanted()
    };
    let answer = solved(evaluator, request, begun, &go_on)?;
    if request.stiffness {
        // The elastic fields of new gears are slow, and the results must not wait for them.
        send(Action::Solved(Box::new(answer.clone())));
        if !is_wanted() {
            return None;
        }
    }
    let mut answer = with_stiffness(request, answer);
    // The other results do not wait for the motion over the speed.
    let has_speeds = answer.active.stages().has(Stage::SpeedRun);
    let first = has_speeds.then(|| request.stages.without(Stage::SpeedRun));
    for stages in first.into_iter().chain([request.stages]) {
        if answer.stages.covers(stages) || answer.refusal().is_some() {
            continue;
        }
        send(Action::Solved(Box::new(answer.clone())));
        let request = Request { stages, ..request.clone() };
        answer = cleared(evaluator, &request, answer, begun, &|_| is_wanted())?;
    }
    Some(Answer { stages: request.stages, ..answer })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use std::sync::mpsc::{Receiver, channel};

    use super::*;
    use crate::case::Case;
    use crate::model::Stages;
    use crate::model::inputs::Method;

    fn request(serial: u64) -> Request {
        let case = Case::table_1();
        Request {
            serial,
            inputs: case.inputs().expect("Table 1 is valid"),
            case,
            stages: Stages::EVERY,
            stiffness: false,
        }
    }

    fn started() -> (Worker<Request>, Receiver<Action>) {
        let (sender, actions) = channel();
        let worker = start(Arc::new(move |action| sender.send(action).is_ok()));
        (worker.expect("a thread"), actions)
    }

    #[test]
    fn a_later_request_interrupts_a_slow_method_which_shows_the_closed_form() {
        let (solver, replies) = started();
        let mut slow = request(1);
        (slow.inputs.method, slow.inputs.tolerance, slow.inputs.warmup_cycles) =
            (Method::Dynamic, 1e-12, 10_000);
        // Without damping the motion never becomes steady.
        slow.inputs.damping_ratio = 0.0;
        solver.request(slow);
        let first = replies.recv().expect("an answer");
        assert!(
            matches!(&first, Action::Solved(answer) if answer.pending == Some(Method::Dynamic) && answer.active == Method::Exact)
        );
        solver.request(request(2));
        let second = replies.recv().expect("an answer");
        assert!(
            matches!(&second, Action::Solved(answer) if answer.serial == 2 && answer.pending.is_none()),
            "{second:?}"
        );
    }

    #[test]
    fn the_required_relief_follows_an_answer_that_is_already_shown() {
        let (solver, replies) = started();
        for (serial, method, expected) in [
            (1, Method::Exact, vec![true]),
            (2, Method::Static, vec![false, true]),
            (3, Method::Auto, vec![false, true]),
        ] {
            let mut asked = request(serial);
            asked.inputs.method = method;
            solver.request(asked);
            let mut found = Vec::new();
            while found.last() != Some(&true) {
                let Ok(Action::Solved(answer)) = replies.recv() else {
                    continue;
                };
                // A surplus answer to the previous request would fail here.
                assert_eq!(answer.serial, serial);
                let clearing = answer.of(answer.active).and_then(|solution| solution.clearing);
                if answer.pending.is_none() {
                    assert_eq!(clearing.is_none(), answer.lacks(Stage::Clearing));
                    found.push(clearing.is_some_and(|clearing| clearing.relief.is_some()));
                }
            }
            assert_eq!(found, expected, "{}", method.name());
        }
    }

    #[test]
    fn the_relief_at_rest_is_present_during_the_search_in_motion() {
        let (solver, replies) = started();
        let mut asked = request(1);
        asked.inputs.method = Method::Dynamic;
        solver.request(asked);
        let first = replies.iter().find_map(|reply| match reply {
            Action::Solved(answer) if answer.pending.is_none() => Some(answer),
            _ => None,
        });
        let answer = first.expect("an answer");
        let relief = |method| answer.of(method).and_then(|solution| solution.clearing);
        assert!(answer.lacks(Stage::Clearing) && relief(Method::Dynamic).is_none());
        assert!(relief(Method::Static).is_some_and(|clearing| clearing.relief.is_some()));
    }
}
