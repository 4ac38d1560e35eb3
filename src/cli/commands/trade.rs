//! `trade`: measures accuracy against run time of every method on one case.

use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{CaseFile, Edits, FormatOption, Listing};
use crate::cli::progress::follow;
use crate::report::trade::{TradeReport, write, write_json};
use crate::study::trade::{Patience, Trade, TradeParameters, trade};
use clap::Args;
use std::cell::Cell;

const AFTER_HELP: &str = "Each setting is timed on this machine. Its total error is the greatest relative difference of first contact, \
    forces and curve from the finest setting of method dynamic. The model error is that of the finest setting of the same method; \
    the rest is numerical. Where no method finds corner contact, no setting is recommended. JSON is one object in SI units; missing \
    values are absent.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The case
    #[command(flatten)]
    pub input: CaseFile,
    /// The changes of the case
    #[command(flatten)]
    pub edits: Edits,
    /// Greatest error of the recommended setting, such as 5% or 0.05 (default: model.within of
    /// the case)
    #[arg(long, value_name = "ERROR", allow_negative_numbers = true, value_parser = part)]
    pub within: Option<f64>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let opened = cases::open(&options.input.case, &options.edits, streams)?;
    let parameters = TradeParameters {
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
        trade(&opened.inputs, &parameters, &go_on, &mut show)
    });
    let trade = found.map_err(|refusal| opened.refused(&refusal, streams))?;
    let report =
        TradeReport { name: &opened.name, title: opened.document.case.title(), trade: &trade };
    match options.output.format {
        Listing::Text => write(&report, streams.output.as_mut())?,
        Listing::Json => write_json(&report, streams.output.as_mut())?,
    }
    Ok(Exit::Done)
}

/// Parses a fraction: "5%" or 0.05.
fn part(text: &str) -> Result<f64, String> {
    let (number, whole) =
        text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |number| (number.trim(), 100.0));
    let value = number
        .parse::<f64>()
        .ok()
        .map(|number| number / whole)
        .filter(|part| part.is_finite() && *part > 0.0);
    value.ok_or_else(|| "write a number above 0, such as 5% or 0.05".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_written_with_or_without_its_sign() {
        assert_eq!((part("5%"), part("0.05"), part(" 0.5 % ")), (Ok(0.05), Ok(0.05), Ok(0.005)));
        assert!(
            ["", "%", "five", "-1%", "0", "nan", "inf%"].iter().all(|text| part(text).is_err())
        );
    }
}
