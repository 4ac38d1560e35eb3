//! Workers of the jobs, one thread for each kind, and the export of results to a file.

use std::io;
use std::path::{Path, PathBuf};

use super::{Send, Worker};
use crate::case::file::{self, SaveError};
use crate::case::units::System;
use crate::case::{Case, EXAMPLES, Evaluator};
use crate::model::{self, Inputs, Refusal, Stages};
use crate::report::charts::Solved;
use crate::report::digest::Digest;
use crate::report::explain;
use crate::report::export;
use crate::report::page::Page;
use crate::report::pictures::{NoPicture, Unsolved};
use crate::report::solve::{self, Subject};
use crate::study::relief::{NoRelief, specify};
use crate::study::shard::Format;
use crate::tui::actions::Action;
use crate::tui::jobs::{
    Explained, Explaining, ExportFault, Exporting, Job, ReliefAnswer, ReliefRequest, Reporting,
};
use crate::tui::solver::{Variants, VariantsRequest};
use crate::tui::store::{self, at_home, folder};

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
        Job::Model(path) => {
            let path = at_home(&path);
            let result = store::load(&path);
            Action::Loaded(path, result)
        }
        Job::Recents => Action::Recents(store::looked_at(store::recents())),
        Job::Examples(system) => Action::Examples(examples(system, go_on)?),
        Job::Export(exporting) => {
            let (path, result) = write_export(&exporting, go_on);
            Action::Exported(path, result)
        }
        Job::Explain(explaining) => Action::Explained(Box::new(explained(*explaining))),
        Job::Relief(request) => Action::Relieved(Box::new(relieved(*request, go_on)?)),
        Job::Markdown(reporting) => Action::Reported(markdown(*reporting)),
        Job::Variants(request) => Action::Compared(Box::new(compared(*request, go_on)?)),
    })
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

fn markdown(reporting: Reporting) -> String {
    let solved = Solved { reports: vec![reporting.report.with_others()], ..Solved::default() };
    let subject = Subject { solved, file: reporting.file, ..Subject::default() };
    Page::of(&[subject]).markdown().unwrap_or_else(|error| error.to_string())
}

fn examples(system: System, go_on: &dyn Fn(f64) -> bool) -> Option<Vec<Digest>> {
    let digest = |case: &Case| match case.inputs() {
        Ok(inputs) => solve::digest(case, &inputs, system, go_on),
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

/// Solves the case and writes the file. Returns the full path.
fn write_export(
    exporting: &Exporting,
    go_on: &dyn Fn(f64) -> bool,
) -> (PathBuf, Result<(), ExportFault>) {
    let path = at_home(&exporting.path);
    let path = std::path::absolute(&path).unwrap_or(path);
    if !exporting.replaces && path.symlink_metadata().is_ok() {
        return (path, Err(ExportFault::Exists));
    }
    let written = export_text(exporting, &path, go_on).map_err(ExportFault::Failed);
    let written = written.and_then(|text| {
        file::write(&path, text.as_bytes(), exporting.replaces).map_err(|error| match error {
            SaveError::AlreadyThere(_) => ExportFault::Exists,
            error => ExportFault::Failed(error.to_string()),
        })
    });
    (path, written)
}

fn export_text(
    exporting: &Exporting,
    path: &Path,
    go_on: &dyn Fn(f64) -> bool,
) -> Result<String, String> {
    let source = Unsolved {
        name: &exporting.name,
        case: &exporting.document.case,
        inputs: &exporting.inputs,
    };
    let go_on = |done: usize, of: usize| go_on(done as f64 / of.max(1) as f64);
    if let Some(picture) = exporting.picture {
        return picture.of_case(source, &go_on).map_err(|reason| match reason {
            NoPicture::Refused(refusal) => refused(&refusal),
            NoPicture::Absent(reason) => reason,
        });
    }
    let Some(format) = export::format_of(path) else {
        return Err(format!(
            "unknown file extension: use {} for the report, or .svg for the picture",
            export::ENDINGS
        ));
    };
    let report = source.solve(format != Format::Csv).map_err(|refusal| refused(&refusal))?;
    let subject = solve::subject(report, exporting.document.render(), format, &go_on);
    let subject = subject.map_err(|refusal| refused(&refusal))?;
    export::render(format, &[subject]).map_err(|error| error.to_string())
}

fn refused(refusal: &Refusal) -> String {
    match refusal {
        Refusal::Stopped => "the export is stopped".to_owned(),
        refusal => format!("{refusal}: {}", refusal.fix()),
    }
}
