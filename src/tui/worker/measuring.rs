//! The worker of the benchmark.

use std::io;

use super::latest::{Running, Send, Worker};
use crate::model::Refusal;
use crate::study::trade::{Trade, TradeParameters, trade};
use crate::tui::actions::Action;
use crate::tui::jobs::{BenchmarkProgress, End, Measuring};

/// Starts the worker.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(send: Send) -> io::Result<Worker<Measuring>> {
    Worker::start("benchmark", send, measure, |measuring| {
        of(measuring, None, Some(End::Failed("internal error".to_owned())))
    })
}

/// Runs the benchmark to its end and sends each step.
pub fn measure(measuring: &Measuring, running: Running<'_>) {
    let parameters =
        TradeParameters { within: measuring.inputs.within, patience: measuring.patience };
    let mut report = |sofar: &Trade| {
        (running.send)(of(measuring, Some(sofar.clone()), None));
    };
    let found = trade(&measuring.inputs, &parameters, running.is_wanted, &mut report);
    let (trade, end) = match found {
        Ok(trade) => (Some(trade), End::Whole),
        Err(Refusal::Stopped) => (None, End::Stopped),
        Err(refusal) => (None, End::Failed(refusal.to_string())),
    };
    (running.send)(of(measuring, trade, Some(end)));
}

fn of(measuring: &Measuring, trade: Option<Trade>, end: Option<End>) -> Action {
    Action::Measured(Box::new(BenchmarkProgress {
        serial: measuring.serial,
        trade: trade.map(Box::new),
        end,
    }))
}

#[cfg(test)]
mod tests {
    use std::cell::{Cell, RefCell};
    use std::sync::Arc;
    use std::sync::mpsc::channel;

    use super::*;
    use crate::case::Case;
    use crate::study::trade::Patience;

    fn measuring(serial: u64) -> Measuring {
        Measuring { serial, inputs: Case::table_1().inputs().unwrap(), patience: Patience::ONCE }
    }

    /// The messages of a benchmark while `go_on` returns true.
    fn sent(
        measuring: &Measuring,
        go_on: &dyn Fn(&BenchmarkProgress) -> bool,
    ) -> Vec<BenchmarkProgress> {
        let (all, is_wanted) = (RefCell::new(Vec::new()), Cell::new(true));
        let send = |action| {
            if let Action::Measured(measured) = action {
                is_wanted.set(go_on(&measured));
                all.borrow_mut().push(*measured);
            }
        };
        let running = Running { is_wanted: &|| is_wanted.get(), send: &send };
        measure(measuring, running);
        all.into_inner()
    }

    #[test]
    fn the_measured_settings_grow_until_the_end() {
        let (sender, receiver) = channel();
        let worker = start(Arc::new(move |action| sender.send(action).is_ok())).unwrap();
        worker.request(measuring(7));
        let mut known = 0;
        for action in receiver {
            let Action::Measured(measured) = action else { panic!("{action:?}") };
            assert_eq!(measured.serial, 7);
            let trade = measured.trade.expect("a trade");
            assert!(trade.settings.len() >= known);
            known = trade.settings.len();
            if let Some(end) = measured.end {
                assert_eq!((end, known), (End::Whole, trade.planned));
                return;
            }
        }
    }

    #[test]
    fn a_stop_keeps_the_settings_measured_so_far() {
        let count = |measured: &BenchmarkProgress| {
            let trade = measured.trade.as_ref();
            trade.map_or(0, |trade| trade.settings.len())
        };
        let all = sent(&measuring(1), &|measured| count(measured) != 3);
        assert_eq!(all.last().map(|last| last.end.clone()), Some(Some(End::Stopped)));
        assert_eq!(all.iter().map(count).max(), Some(3));
    }

    #[test]
    fn a_case_that_no_method_solves_reports_the_reason() {
        let mut refused = measuring(2);
        refused.inputs.centre_distance = Some(0.01);
        let end = sent(&refused, &|_| true).into_iter().find_map(|measured| measured.end);
        assert!(matches!(end, Some(End::Failed(reason)) if reason.contains("centre distance")));
    }
}
