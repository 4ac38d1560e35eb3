//! `check`: compares each case with its own limits.

use crate::case::Case;
use crate::case::sanitize::sanitize;
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{Cases, FormatOption, Listing};
use crate::model::{self, Inputs, Refusal, Solution};
use crate::report::verdict::{
    Standing, Verdict, refused, stages, stages_beside, verdicts, write_json,
};
use clap::Args;
use std::io::{self, Write};

const AFTER_HELP: &str = "A limit on impact_force applies to the free impact in every \
    method. With static and dynamic, the verdict also prints the force by the method; a separate \
    limit can be set on that force. Without corner contact every limit on the impact is met. If a \
    quantity has no value, the verdict is `unknown` with the reason, and the exit code is 1. \
    JSON: one object per verdict, in SI units.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let edits = options.input.changes.edits();
    let mut worst = Exit::Done;
    for path in &options.input.cases {
        let exit = match cases::open(path, &edits, streams) {
            Ok(opened) => check(&opened, options.output.format, streams)?,
            Err(exit) => exit,
        };
        worst = worst.max(exit);
    }
    Ok(worst)
}

fn check(opened: &Opened, format: Listing, streams: &mut Streams) -> Result<Exit, Failure> {
    let case = &opened.document.case;
    let (verdicts, refusal, method) = match solve(case, &opened.inputs) {
        Ok(solution) => (verdicts(case, &solution), solution.withheld, solution.method),
        Err(refusal) => (refused(case, &refusal), Some(refusal), opened.inputs.method),
    };
    let is_settled = verdicts.iter().all(|verdict| verdict.standing != Standing::Unknown)
        && !verdicts.is_empty();
    let refusal = refusal.filter(|_| !is_settled);
    if refusal.is_none() || !verdicts.is_empty() {
        match format {
            Listing::Text => tell(&verdicts, &opened.name, &mut streams.output)?,
            Listing::Json => write_json(&verdicts, &opened.name, method, &mut streams.output)?,
        }
    }
    if let Some(refusal) = refusal {
        return Ok(opened.refused(&refusal, streams));
    }
    let holds = verdicts.iter().all(|verdict| verdict.standing.holds());
    Ok(if holds { Exit::Done } else { Exit::Exceeded })
}

fn tell(verdicts: &[Verdict], name: &str, out: &mut dyn Write) -> io::Result<()> {
    let name = sanitize(name);
    if verdicts.is_empty() {
        return writeln!(out, "ok {name}: no limits");
    }
    verdicts
        .iter()
        .try_for_each(|verdict| writeln!(out, "{} {name}: {verdict}", verdict.standing.word()))
}

/// Solves the stages of the limits and of their counterparts in the method.
fn solve(case: &Case, inputs: &Inputs) -> Result<Solution, Refusal> {
    let needed = stages(case);
    let solution = model::solve(inputs, needed)?;
    let whole = needed.and(stages_beside(case, solution.method));
    if needed.covers(whole) { Ok(solution) } else { model::solve(inputs, whole).or(Ok(solution)) }
}
