//! The worker that measures error and time of every method: one measurement at a time, which stops
//! when told.

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use crate::model::{Inputs, Refusal};
use crate::study::trade::{Patience, Question, Trade, trade};

/// A measurement that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Measuring {
    /// Tells it from the others.
    pub serial: u64,
    /// The pair.
    pub inputs: Inputs,
    /// How long each setting is timed.
    pub patience: Patience,
}

/// What is known of a measurement.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The measurement's.
    pub serial: u64,
    /// What is measured so far; nothing where that did not change.
    pub trade: Option<Box<Trade>>,
    /// How it ended, where it did.
    pub end: Option<End>,
}

/// How a measurement ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// All is measured.
    Whole,
    /// It was stopped.
    Stopped,
    /// The model refuses the case, or the program failed.
    Failed(String),
}

/// Measures in a thread of its own, so that solving goes on.
pub struct TradeWorker {
    tell: Arc<dyn Fn(Measured) -> bool + Send + Sync>,
    stop: Arc<AtomicBool>,
}

impl TradeWorker {
    /// Nothing is measured yet; `tell` takes what is known, until it says that nobody listens.
    pub fn new(tell: impl Fn(Measured) -> bool + Send + Sync + 'static) -> TradeWorker {
        TradeWorker {
            tell: Arc::new(tell),
            stop: Arc::default(),
        }
    }

    /// Begin, and stop what was measured before.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn begin(&mut self, measuring: Measuring) -> io::Result<()> {
        self.stop();
        self.stop = Arc::default();
        let (tell, stop) = (Arc::clone(&self.tell), Arc::clone(&self.stop));
        thread::Builder::new()
            .name("trade_worker".to_owned())
            .spawn(move || measure(&measuring, &stop, &*tell))?;
        Ok(())
    }

    /// Stop what is measured.
    pub fn stop(&self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

impl Drop for TradeWorker {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// Measure to the end, telling each step.
pub fn measure(measuring: &Measuring, stop: &AtomicBool, tell: &dyn Fn(Measured) -> bool) {
    let serial = measuring.serial;
    let question = Question {
        within: measuring.inputs.within,
        patience: measuring.patience,
    };
    let go_on = || !stop.load(Ordering::Relaxed);
    let mut told = |sofar: &Trade| {
        if !tell(Measured {
            serial,
            trade: Some(Box::new(sofar.clone())),
            end: None,
        }) {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let found = catch_unwind(AssertUnwindSafe(|| {
        trade(&measuring.inputs, &question, &go_on, &mut told)
    }));
    let (trade, end) = match found {
        Ok(Ok(trade)) => (Some(Box::new(trade)), End::Whole),
        Ok(Err(Refusal::Stopped)) => (None, End::Stopped),
        Ok(Err(refusal)) => (None, End::Failed(refusal.to_string())),
        Err(_) => (None, End::Failed("a fault of the program".to_owned())),
    };
    tell(Measured {
        serial,
        trade,
        end: Some(end),
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use std::sync::mpsc::channel;

    fn measuring(serial: u64) -> Measuring {
        Measuring {
            serial,
            inputs: Case::table_1().inputs().unwrap(),
            patience: Patience::ONCE,
        }
    }

    #[test]
    fn what_is_known_grows_until_the_end() {
        let (sender, receiver) = channel();
        let mut trade_worker = TradeWorker::new(move |measured| sender.send(measured).is_ok());
        trade_worker.begin(measuring(7)).unwrap();
        let mut known = 0;
        for measured in receiver {
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
    fn it_stops_when_told_and_keeps_what_it_has() {
        let stop = AtomicBool::new(false);
        let (sender, receiver) = channel();
        measure(&measuring(1), &stop, &|measured: Measured| {
            if measured
                .trade
                .as_ref()
                .is_some_and(|trade| trade.settings.len() == 3)
            {
                stop.store(true, Ordering::Relaxed);
            }
            sender.send(measured).is_ok()
        });
        let all: Vec<Measured> = receiver.try_iter().collect();
        assert_eq!(
            all.last().map(|last| last.end.clone()),
            Some(Some(End::Stopped))
        );
        let most = all
            .iter()
            .filter_map(|measured| measured.trade.as_ref())
            .map(|trade| trade.settings.len())
            .max();
        assert_eq!(most, Some(3));
    }

    #[test]
    fn a_case_that_no_method_solves_says_why() {
        let mut refused = measuring(2);
        refused.inputs.centre_distance = Some(0.01);
        let (sender, receiver) = channel();
        measure(&refused, &AtomicBool::new(false), &|measured| {
            sender.send(measured).is_ok()
        });
        let end = receiver.try_iter().find_map(|measured| measured.end);
        assert!(matches!(end, Some(End::Failed(reason)) if reason.contains("centre distance")));
    }
}
