//! Each case held against its own limits.

use super::cases::{self, Opened};
use super::{Check, Exit, Streams};
use crate::case::visible::visible;
use crate::model::{self, Quantity, Stages};
use crate::report::verdict::{Standing, Verdict, verdicts};
use std::io::{self, Write};

pub(super) fn run(options: &Check, streams: &mut Streams) -> io::Result<Exit> {
    let mut worst = Exit::Done;
    for path in &options.cases {
        let exit = match cases::open(path, &[], streams) {
            Ok(opened) => check(&opened, streams)?,
            Err(exit) => exit,
        };
        worst = worst.max(exit);
    }
    Ok(worst)
}

fn check(opened: &Opened, streams: &mut Streams) -> io::Result<Exit> {
    let solution = match model::solve(&opened.inputs, stages(opened)) {
        Ok(solution) => solution,
        Err(refusal) => return Ok(opened.refused(&refusal, streams)),
    };
    let verdicts = verdicts(&opened.document.case, &solution);
    let unknown = verdicts.iter().any(|verdict| verdict.standing == Standing::Unknown);
    if let Some(refusal) = solution.withheld.filter(|_| unknown) {
        return Ok(opened.refused(&refusal, streams));
    }
    let broken: Vec<&Verdict> = verdicts.iter().filter(|verdict| !verdict.standing.holds()).collect();
    let (word, exit) = if broken.is_empty() { ("ok", Exit::Done) } else { ("EXCEEDED", Exit::Exceeded) };
    let told = if broken.is_empty() { verdicts.iter().collect() } else { broken };
    writeln!(streams.output, "{word} {}: {}", visible(&opened.name), list(&told))?;
    Ok(exit)
}

fn stages(opened: &Opened) -> Stages {
    let limited = opened.document.case.limits.iter().filter_map(|limit| Quantity::find(limit.quantity));
    limited.fold(Stages::of(model::Stage::Geometry), |stages, quantity| stages.and(Stages::of(quantity.stage)))
}

fn list(verdicts: &[&Verdict]) -> String {
    if verdicts.is_empty() {
        return "no limits".to_owned();
    }
    verdicts.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
