//! Opens cases for a command and prints what is wrong with them.

use super::{Exit, Setting, Streams};
use crate::case::fields::FIELDS;
use crate::case::file::{MOST_MODEL_BYTES, ReadError, read_bytes};
use crate::case::rexs::{self, Imported};
use crate::case::{Case, Document, Problem};
use crate::model::{Inputs, Refusal};
use std::path::Path;

/// A case that can be solved.
pub(super) struct Opened {
    /// As the user named it.
    pub(super) name: String,
    pub(super) document: Document,
    pub(super) inputs: Inputs,
    /// What the command line changed.
    settings: Vec<Setting>,
}

impl Opened {
    /// Say why the model refuses the case, at the field where the fix begins.
    pub(super) fn refused(&self, refusal: &Refusal, streams: &mut Streams) -> Exit {
        self.report_problem(refusal.into(), streams);
        Exit::BadCase
    }

    /// Report a problem of the case at its place.
    pub(super) fn report_problem(&self, problem: Problem, streams: &mut Streams) {
        streams.say(&placed(&self.document, problem, &self.settings));
    }
}

/// Read a case and change what the settings name.
pub(super) fn open(
    path: &Path,
    settings: &[Setting],
    streams: &mut Streams,
) -> Result<Opened, Exit> {
    let document = read(path, streams)?;
    changed(path.display().to_string(), document, settings, streams)
}

/// Read a case whose missing values may be among those that a study varies, each given as the place
/// of its field and one of its values.
pub(super) fn open_varied(
    path: &Path,
    settings: &[Setting],
    varied: &[(usize, String)],
    streams: &mut Streams,
) -> Result<Opened, Exit> {
    let mut document = read(path, streams)?;
    for (field, value) in varied {
        if document.case.effective(*field).is_none() {
            // A value that does not fit is reported with its point.
            drop(document.case.set(FIELDS[*field].key, value));
        }
    }
    changed(path.display().to_string(), document, settings, streams)
}

/// Why a field cannot be set: a study varies it.
pub(super) fn set_and_varied(settings: &[Setting], varied: &[&str]) -> Option<String> {
    let is_varied = |setting: &&Setting| {
        varied
            .iter()
            .any(|key| *key == setting.key || Case::are_exclusive(key, &setting.key))
    };
    let setting = settings.iter().find(is_varied)?;
    let written = setting.written();
    Some(format!(
        "{written}: --vary replaces this value: leave one of them out"
    ))
}

/// Reads a case whose values may be missing yet, or the only spur stage of a model.
fn read(path: &Path, streams: &mut Streams) -> Result<Document, Exit> {
    if rexs::is_model(path) {
        return Ok(read_model(path, None, streams)?.document);
    }
    Document::read_draft(path).map_err(|error| unread(&error, streams))
}

/// Reads a stage of a model, and reports the stages and the fields that stay empty.
pub(super) fn read_model(
    path: &Path,
    stage: Option<&str>,
    streams: &mut Streams,
) -> Result<Imported, Exit> {
    let bytes = read_bytes(path, MOST_MODEL_BYTES).map_err(|error| unread(&error, streams))?;
    let imported = rexs::import(path, &bytes, stage).map_err(|refusal| {
        streams.say(&refusal.to_string());
        Exit::BadCase
    })?;
    let name = path.display();
    for stage in &imported.stages {
        let mark = if stage.id == imported.stage {
            ", imported"
        } else {
            ""
        };
        streams.say(&format!(
            "{name}: stage {}: {}{mark}",
            stage.label(),
            stage.kind
        ));
    }
    for remark in &imported.remarks {
        streams.say(&format!("{name}: {remark}"));
    }
    for (field, reason) in &imported.absent {
        streams.say(&format!("{name}: {field} stays empty: {reason}"));
    }
    Ok(imported)
}

/// A document as it is once the settings have changed what they name.
pub(super) fn changed(
    name: String,
    mut document: Document,
    settings: &[Setting],
    streams: &mut Streams,
) -> Result<Opened, Exit> {
    for (index, setting) in settings.iter().enumerate() {
        if let Some(other) = settings[..index]
            .iter()
            .find(|other| Case::are_exclusive(&other.key, &setting.key))
        {
            streams.say(&format!(
                "{}: {} is set as well: leave one of them out",
                setting.written(),
                other.key
            ));
            return Err(Exit::Usage);
        }
        document
            .case
            .set(&setting.key, &setting.value)
            .map_err(|problem| {
                streams.say(&on_command_line(setting, &problem));
                Exit::Usage
            })?;
    }
    match document.case.inputs() {
        // Nothing waits for a report, so it is given the digits.
        Ok(inputs) => Ok(Opened {
            name,
            document,
            inputs,
            settings: settings.to_vec(),
        }),
        Err(problems) => Err(unfit(&document, problems, settings, streams)),
    }
}

fn unread(error: &ReadError, streams: &mut Streams) -> Exit {
    match error {
        ReadError::Bad(faults) => {
            for fault in faults {
                streams.say(&fault.to_string());
            }
            Exit::BadCase
        }
        ReadError::NewerFormat(_) => {
            streams.say(&error.to_string());
            Exit::NewerFormat
        }
        _ => {
            streams.say(&error.to_string());
            Exit::Unreadable
        }
    }
}

/// Report what is missing from the file, and what the settings make inconsistent.
fn unfit(
    document: &Document,
    mut problems: Vec<Problem>,
    settings: &[Setting],
    streams: &mut Streams,
) -> Exit {
    problems.sort_by_key(|problem| document.place(&problem.field));
    for problem in problems {
        streams.say(&placed(document, problem, settings));
    }
    Exit::BadCase
}

/// A problem at its place: a field that was set is wrong on the command line and not in the file;
/// another may be wrong beside what was set.
fn placed(document: &Document, problem: Problem, settings: &[Setting]) -> String {
    match settings
        .iter()
        .rev()
        .find(|setting| setting.key == problem.field)
    {
        Some(setting) => format!(
            "{}, {}",
            document.name(),
            on_command_line(setting, &problem)
        ),
        None if settings.is_empty() => document.fault(problem).to_string(),
        None => {
            let written: Vec<String> = settings.iter().map(Setting::written).collect();
            format!("{} (with {})", document.fault(problem), written.join(" "))
        }
    }
}

fn on_command_line(setting: &Setting, problem: &Problem) -> String {
    format!("{}: {}: {}", setting.written(), problem.cause, problem.fix)
}
