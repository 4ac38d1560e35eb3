//! The one worker that solves: the latest request wins, and a fault in it never takes the screen down.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread;

use super::fault;
use crate::model::inputs::Rung;
use crate::model::{self, Inputs, Note, Refusal, Solution, Stages};

/// The name of the worker's thread.
pub const THREAD: &str = "solver";

/// A case to be solved.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Counts the edits, so that a late answer is known as such.
    pub serial: u64,
    /// The pair.
    pub inputs: Inputs,
    /// The stages whose results are in sight.
    pub stages: Stages,
}

/// What the rungs say of a request.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The request's.
    pub serial: u64,
    /// The stages that were asked for.
    pub stages: Stages,
    /// The rung that the case asks for.
    pub active: Rung,
    /// Every rung, cheapest first.
    pub rungs: Vec<(Rung, Result<Solution, Refusal>)>,
    /// What a reader must know beside the active result.
    pub notes: Vec<Note>,
}

/// What comes back from the worker.
#[derive(Debug, Clone, PartialEq)]
pub enum Reply {
    /// It is solved.
    Solved(Box<Answer>),
    /// The solver failed in a way that it never should.
    Failed(u64),
}

/// The worker's thread. It ends when this is dropped.
#[derive(Debug)]
pub struct Solver {
    desk: Arc<Desk>,
}

#[derive(Debug, Default)]
struct Desk {
    tray: Mutex<Tray>,
    bell: Condvar,
}

#[derive(Debug, Default)]
struct Tray {
    request: Option<Request>,
    closed: bool,
}

impl Answer {
    /// The solution of a rung, where there is one.
    #[must_use]
    pub fn of(&self, rung: Rung) -> Option<&Solution> {
        self.rungs.iter().find(|(own, _)| *own == rung).and_then(|(_, result)| result.as_ref().ok())
    }

    /// The refusal of the active rung, where it refuses.
    #[must_use]
    pub fn refusal(&self) -> Option<&Refusal> {
        self.rungs.iter().find(|(own, _)| *own == self.active).and_then(|(_, result)| result.as_ref().err())
    }
}

impl Solver {
    /// Start the worker, which tells each reply until `tell` says that nobody listens.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(tell: impl Fn(Reply) -> bool + Send + 'static) -> std::io::Result<Solver> {
        Solver::start_with(answer, tell)
    }

    /// Start the worker with another way to solve.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start_with(
        solve: impl Fn(&Request) -> Answer + Send + 'static,
        tell: impl Fn(Reply) -> bool + Send + 'static,
    ) -> std::io::Result<Solver> {
        let desk = Arc::new(Desk::default());
        let theirs = Arc::clone(&desk);
        thread::Builder::new().name(THREAD.to_owned()).spawn(move || {
            while let Some(request) = theirs.next() {
                if !tell(attempt(&solve, &request)) {
                    return;
                }
            }
        })?;
        Ok(Solver { desk })
    }

    /// Ask for a solve, in place of one that has not begun.
    pub fn ask(&self, request: Request) {
        self.desk.change(|tray| tray.request = Some(request));
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        self.desk.change(|tray| tray.closed = true);
    }
}

impl Desk {
    fn change(&self, change: impl FnOnce(&mut Tray)) {
        change(&mut self.tray.lock().unwrap_or_else(PoisonError::into_inner));
        self.bell.notify_one();
    }

    fn next(&self) -> Option<Request> {
        let mut tray = self.tray.lock().unwrap_or_else(PoisonError::into_inner);
        loop {
            if tray.closed {
                return None;
            }
            if let Some(request) = tray.request.take() {
                return Some(request);
            }
            tray = self.bell.wait(tray).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Solve with the closed forms, which cost nothing, and the rung of the case: their difference is what the engineer came for.
#[must_use]
pub fn answer(request: &Request) -> Answer {
    let active = request.inputs.rung;
    let mut inputs = request.inputs.clone();
    let sharing = Some(active).filter(|rung| rung.shares_load());
    let rungs: Vec<_> = Rung::CLOSED_FORM
        .into_iter()
        .chain(sharing)
        .map(|rung| {
            inputs.rung = rung;
            (rung, model::solve(&inputs, request.stages))
        })
        .collect();
    let mut answer = Answer { serial: request.serial, stages: request.stages, active, rungs, notes: Vec::new() };
    answer.notes = answer.of(active).map(|solution| model::notes(&request.inputs, solution)).unwrap_or_default();
    answer
}

fn attempt(solve: &impl Fn(&Request) -> Answer, request: &Request) -> Reply {
    let solve = || {
        fault::on_demand(THREAD);
        solve(request)
    };
    catch_unwind(AssertUnwindSafe(solve)).map_or(Reply::Failed(request.serial), |answer| Reply::Solved(Box::new(answer)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use std::sync::mpsc::{Sender, channel};

    fn request(serial: u64) -> Request {
        Request { serial, inputs: Case::table_1().inputs().expect("Table 1 is valid"), stages: Stages::EVERY }
    }

    fn teller(sender: Sender<Reply>) -> impl Fn(Reply) -> bool + Send + 'static {
        move |reply| sender.send(reply).is_ok()
    }

    #[test]
    fn a_panic_is_told_and_the_next_request_is_solved() {
        let (sender, replies) = channel();
        let solve = |request: &Request| {
            assert!(request.serial != 1, "planted");
            answer(request)
        };
        let solver = Solver::start_with(solve, teller(sender)).expect("a thread");
        solver.ask(request(1));
        assert_eq!(replies.recv(), Ok(Reply::Failed(1)));
        solver.ask(request(2));
        assert!(matches!(replies.recv(), Ok(Reply::Solved(answer)) if answer.serial == 2));
    }

    #[test]
    fn the_latest_request_wins() {
        let (begun, has_begun) = channel();
        let (go, gate) = channel::<()>();
        let (sender, replies) = channel();
        let solve = move |request: &Request| {
            begun.send(request.serial).expect("the test listens");
            gate.recv().expect("the test goes on");
            answer(request)
        };
        let solver = Solver::start_with(solve, teller(sender)).expect("a thread");
        solver.ask(request(1));
        assert_eq!(has_begun.recv(), Ok(1));
        (2..=9).for_each(|serial| solver.ask(request(serial)));
        go.send(()).and_then(|()| go.send(())).expect("the worker listens");
        let serials: Vec<_> =
            replies.iter().take(2).map(|reply| if let Reply::Solved(answer) = reply { answer.serial } else { 0 }).collect();
        assert_eq!(serials, [1, 9]);
    }
}
