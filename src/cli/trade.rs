//! Speed against accuracy of every method on one case.

use super::cases::{self, Opened};
use super::progress::follow;
use super::{Exit, Listing, Streams, Trading};
use crate::report::trade::{TradeReport, write, write_json};
use crate::study::trade::{Patience, Question, Trade, trade};
use std::cell::Cell;
use std::io;

pub(super) fn run(options: &Trading, streams: &mut Streams) -> io::Result<Exit> {
    let opened = match cases::open(&options.case, &options.edits, streams) {
        Ok(opened) => opened,
        Err(exit) => return Ok(exit),
    };
    let question = Question {
        within: options.within.unwrap_or(opened.inputs.within),
        patience: Patience::STEADY,
    };
    let found = follow("settings", |report| {
        let (done, planned) = (Cell::new(0), Cell::new(1));
        let mut show = |sofar: &Trade| {
            done.set((sofar.part * sofar.planned as f64) as usize);
            planned.set(sofar.planned);
        };
        let go_on = || report(done.get(), planned.get());
        trade(&opened.inputs, &question, &go_on, &mut show)
    });
    let Opened { name, document, .. } = &opened;
    let title = document.case.title();
    match found {
        Err(refusal) => Ok(opened.refused(&refusal, streams)),
        Ok(trade) => {
            let report = TradeReport {
                name,
                title,
                trade: &trade,
            };
            match options.format {
                Listing::Text => write(&report, streams.output.as_mut())?,
                Listing::Json => write_json(&report, streams.output.as_mut())?,
            }
            Ok(Exit::Done)
        }
    }
}
