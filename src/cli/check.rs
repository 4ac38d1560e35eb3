//! Each case held against its own limits.

use super::cases::{self, Opened};
use super::{Check, Exit, Streams};
use crate::case::Case;
use crate::case::visible::visible;
use crate::model::{self, Inputs, Refusal, Solution};
use crate::report::verdict::{Standing, refused, stages, stages_beside, verdicts};
use std::io::{self, Write};

pub(super) fn run(options: &Check, streams: &mut Streams) -> io::Result<Exit> {
    let settings = options.changes.settings();
    let mut worst = Exit::Done;
    for path in &options.cases {
        let exit = match cases::open(path, &settings, streams) {
            Ok(opened) => check(&opened, streams)?,
            Err(exit) => exit,
        };
        worst = worst.max(exit);
    }
    Ok(worst)
}

fn check(opened: &Opened, streams: &mut Streams) -> io::Result<Exit> {
    let case = &opened.document.case;
    let (verdicts, refusal) = match solve(case, &opened.inputs) {
        Ok(solution) => (verdicts(case, &solution), solution.withheld),
        Err(refusal) => (refused(case, &refusal), Some(refusal)),
    };
    for verdict in &verdicts {
        writeln!(streams.output, "{} {}: {verdict}", verdict.standing.word(), visible(&opened.name))?;
    }
    let is_settled = verdicts.iter().all(|verdict| verdict.standing != Standing::Unknown) && !verdicts.is_empty();
    if let Some(refusal) = refusal.filter(|_| !is_settled) {
        return Ok(opened.refused(&refusal, streams));
    }
    if verdicts.is_empty() {
        writeln!(streams.output, "ok {}: no limits", visible(&opened.name))?;
    }
    let holds = verdicts.iter().all(|verdict| verdict.standing.holds());
    Ok(if holds { Exit::Done } else { Exit::Exceeded })
}

/// As far as the limits need it, and what the rung itself finds beside them, where it does.
fn solve(case: &Case, inputs: &Inputs) -> Result<Solution, Refusal> {
    let needed = stages(case);
    let solution = model::solve(inputs, needed)?;
    let whole = needed.and(stages_beside(case, solution.rung));
    if needed.covers(whole) { Ok(solution) } else { model::solve(inputs, whole).or(Ok(solution)) }
}
