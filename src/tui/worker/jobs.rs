//! Workers of the jobs, one thread for each kind.

use std::io;

use super::export;
use super::latest::{Send, Worker};
use crate::case::units::System;
use crate::case::{Case, EXAMPLES, Evaluator};
use crate::model::{self, Inputs, Refusal, Stages};
use crate::report::digest::Digest;
use crate::report::explain;
use crate::report::page::{Page, Studies, Subject};
use crate::study::relief::{NoRelief, specify};
use crate::tui::actions::Action;
use crate::tui::jobs::{
    Explained, Explaining, ExportFault, Job, ReliefAnswer, ReliefRequest, Reporting,
};
use crate::tui::solver::{Variants, VariantsRequest};
use crate::tui::store::{folder, recents};

/// Starts the worker of a kind of jobs.
///
/// # Errors
/// Returns an error if the system cannot start a thread.
pub(crate) fn start(name: &'static str, send: Send) -> io::Result<Worker<Job>> {
    Worker::start(
        name,
        send,
        |job: &Job, running| {
            if let Some(action) = perform(job.clone(), &|_| (running.is_wanted)()) {
                (running.send)(action);
            }
        },
        failed,
    )
}

fn failed(job: &Job) -> Action {
    const FAULT: &str = "internal error";
    if let Job::Export(exporting) = job {
        let fault = ExportFault::Failed(FAULT.to_owned());
        return Action::Exported(exporting.path.clone(), Err(fault));
    }
    let (_, name) = job.kind();
    Action::Failed(format!("{FAULT}: {name} cannot be shown"))
}

/// Runs a job. Returns `None` if `go_on` returns false.
#[must_use]
pub fn perform(job: Job, go_on: &dyn Fn(f64) -> bool) -> Option<Action> {
    Some(match job {
        Job::Folder(base, typed) => Action::Listed(Box::new(folder::list(base, typed))),
        Job::Search(base, typed) => Action::Found(Box::new(folder::find(base, typed, go_on)?)),
        Job::Preview(sight, system) => {
            let preview = folder::preview(&sight, system, go_on)?;
            Action::Previewed(sight, Box::new(preview))
        }
        Job::Recents => Action::Recents(recents::looked_at(recents::list())),
        Job::Examples(system) => Action::Examples(examples(system, go_on)?),
        Job::Export(exporting) => {
            let (path, result) = export::write(&exporting, go_on);
            Action::Exported(path, result)
        }
        Job::Explain(explaining) => Action::Explained(Box::new(explained(*explaining))),
        Job::Relief(request) => Action::Relieved(Box::new(relieved(*request, go_on)?)),
        Job::Markdown(reporting) => Action::Reported(markdown(*reporting)),
        Job::Variants(request) => Action::Compared(Box::new(compared(*request, go_on)?)),
    })
}

fn markdown(reporting: Reporting) -> String {
    let subject = Subject {
        reports: vec![reporting.report],
        speeds: None,
        studies: Studies::default(),
        file: reporting.file,
    };
    Page::of(&[subject]).markdown()
}

fn examples(system: System, go_on: &dyn Fn(f64) -> bool) -> Option<Vec<Digest>> {
    let digest = |case: &Case| match case.inputs() {
        Ok(inputs) => Digest::solve(case, &inputs, system, go_on),
        Err(_) => Some(Digest::default()),
    };
    EXAMPLES.iter().map(|example| digest(&example.document().case)).collect()
}

// As in `tipstrike compare`.
fn compared(request: VariantsRequest, go_on: &dyn Fn(f64) -> bool) -> Option<Variants> {
    let stages = request.stages;
    let solved =
        |inputs: &Inputs| match Evaluator::default().solve(inputs, inputs.method, stages, go_on) {
            Err(Refusal::Stopped) => None,
            found => Some(found.map_err(|refusal| format!("{refusal}: {}", refusal.fix()))),
        };
    let columns = request.columns.into_iter().map(|(name, inputs)| {
        let found = match &inputs {
            Ok(inputs) => solved(inputs)?,
            Err(problem) => Err(problem.clone()),
        };
        Some((name, found))
    });
    Some(Variants { serial: request.serial, columns: columns.collect::<Option<_>>()? })
}

// As in `tipstrike relief`.
fn relieved(request: ReliefRequest, go_on: &dyn Fn(f64) -> bool) -> Option<ReliefAnswer> {
    let found = match specify(&request.inputs, &request.demand, go_on) {
        Ok(found) => Ok(Box::new(found)),
        Err(NoRelief::Refused(Refusal::Stopped)) => return None,
        Err(none) => Err(none.to_string()),
    };
    Some((request, found))
}

// As in `tipstrike explain`.
fn explained(explaining: Explaining) -> Explained {
    let Explaining { quantity, case, inputs } = explaining;
    let inputs = inputs.needing([quantity.stage]);
    let page = match model::solve(&inputs, Stages::of(quantity.stage)) {
        Ok(solution) => Ok(Box::new(explain::explain(quantity, &case, &inputs, &solution))),
        Err(refusal) => Err(format!("Not solved: {refusal}. Correction: {}.", refusal.fix())),
    };
    Explained { quantity, page }
}
