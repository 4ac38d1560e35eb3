//! Opens cases for a command and reports their problems.

use super::Streams;
use super::options::{Edits, Setting};
use super::output::{Exit, Failure};
use crate::case::fields::FIELDS;
use crate::case::file::{MOST_MODEL_BYTES, ReadError, read_bytes};
use crate::case::rexs::{self, Imported};
use crate::case::{Acting, Case, Document, Problem, partial_relevance, relevance};
use crate::model::{Inputs, Quantity, Refusal};
use crate::report::compare::Refused;
use crate::report::pictures::Unsolved;
use std::path::{Path, PathBuf};

/// A case that is ready to solve.
pub(super) struct Opened {
    /// The name as the user gave it.
    pub(super) name: String,
    pub(super) document: Document,
    pub(super) inputs: Inputs,
    /// The changes of the command line.
    edits: Edits,
}

impl Opened {
    /// Tells method `auto` to compute these quantities, which the user names.
    pub(super) fn need(&mut self, quantities: impl IntoIterator<Item = &'static Quantity>) {
        let stages = quantities.into_iter().map(|quantity| quantity.stage);
        self.inputs = self.inputs.clone().needing(stages);
    }

    /// Why a varied field changes no result, or only some of them.
    pub(super) fn without_effect(&self, field: usize, inputs: &Inputs) -> Option<String> {
        let (name, key) = (&self.name, FIELDS[field].key);
        match relevance(field, inputs) {
            Acting::Yes => {
                partial_relevance(field, inputs).map(|why| format!("{name}: {key}: {why}"))
            }
            Acting::No(why) | Acting::Beside(why) => {
                Some(format!("{name}: {key} changes no quantity: {why}"))
            }
        }
    }

    /// The case, to solve for a report or a picture.
    pub(super) fn unsolved(&self) -> Unsolved<'_> {
        Unsolved { name: &self.name, case: &self.document.case, inputs: &self.inputs }
    }

    /// Reports a refusal of the model at the field that its fix names first.
    pub(super) fn refused(&self, refusal: &Refusal, streams: &mut Streams) -> Exit {
        let problem = Problem::from(refusal).at_given(&self.document.case);
        self.report_problem(problem, streams);
        Exit::BadCase
    }

    /// Reports a problem of the case at its place.
    pub(super) fn report_problem(&self, problem: Problem, streams: &mut Streams) {
        streams.say(&placed(&self.document, problem, &self.edits));
    }
}

/// Runs a command on each case. The exit code is the greatest of all.
pub(super) fn each(
    paths: &[PathBuf],
    mut run: impl FnMut(&Path) -> Result<Exit, Failure>,
) -> Result<Exit, Failure> {
    paths.iter().try_fold(Exit::Done, |worst, path| match run(path) {
        Ok(exit) | Err(Failure::Reported(exit)) => Ok(worst.max(exit)),
        Err(failure) => Err(failure),
    })
}

/// Reads a case and applies the changes of the command line.
pub(super) fn open(path: &Path, edits: &Edits, streams: &mut Streams) -> Result<Opened, Exit> {
    let document = read(path, streams)?;
    changed(path.display().to_string(), document, edits, streams)
}

/// Reads a case whose missing values may be among the varied fields. `varied` has the index of each
/// field with one of its values.
pub(super) fn open_varied(
    path: &Path,
    edits: &Edits,
    varied: &[(usize, String)],
    streams: &mut Streams,
) -> Result<Opened, Exit> {
    let mut document = read(path, streams)?;
    for (field, value) in varied {
        if document.case.effective(*field).is_none() {
            // An invalid value is reported later with its point.
            drop(document.case.set(FIELDS[*field].key, value));
        }
    }
    changed(path.display().to_string(), document, edits, streams)
}

/// Refuses to set a field that a study varies.
pub(super) fn keep_varied(settings: &[Setting], varied: &[&str]) -> Result<(), Failure> {
    let is_varied = |setting: &&Setting| {
        varied.iter().any(|key| *key == setting.key || Case::are_exclusive(key, &setting.key))
    };
    match settings.iter().find(is_varied) {
        Some(setting) => Err(Failure::Usage(format!(
            "{}: --vary replaces this value: leave one of them out",
            setting.written()
        ))),
        None => Ok(()),
    }
}

/// Reads a case that may lack values, or the only spur stage of a model.
pub(super) fn read(path: &Path, streams: &mut Streams) -> Result<Document, Exit> {
    if rexs::is_model(path) {
        return Ok(read_model(path, None, streams)?.document);
    }
    Document::read_draft(path).map_err(|error| unread(&error, streams))
}

/// Reads a stage of a model, and reports the stages and the empty fields.
pub(super) fn read_model(
    path: &Path,
    stage: Option<&str>,
    streams: &mut Streams,
) -> Result<Imported, Exit> {
    let bytes = read_bytes(path, MOST_MODEL_BYTES).map_err(|error| unread(&error, streams))?;
    let imported = rexs::import(path, &bytes, stage).map_err(|refusal| {
        streams.say(&refusal);
        Exit::BadCase
    })?;
    let name = path.display();
    for stage in &imported.stages {
        let mark = if stage.id == imported.stage { ", imported" } else { "" };
        streams.say(&format!("{name}: stage {}: {}{mark}", stage.label(), stage.kind));
    }
    for remark in &imported.remarks {
        streams.say(&format!("{name}: {remark}"));
    }
    for (field, reason) in &imported.absent {
        streams.say(&format!("{name}: {field} stays empty: {reason}"));
    }
    Ok(imported)
}

/// A document with the changes of the command line.
pub(super) fn changed(
    name: String,
    mut document: Document,
    edits: &Edits,
    streams: &mut Streams,
) -> Result<Opened, Exit> {
    edit(&mut document, edits).map_err(|line| {
        streams.say(&line);
        Exit::Usage
    })?;
    match document.case.inputs() {
        Ok(inputs) => {
            Ok(Opened { name: named(name, edits), document, inputs, edits: edits.clone() })
        }
        Err(problems) => {
            for refused in refused(&document, problems, edits) {
                streams.say(&refused.line);
            }
            Err(Exit::BadCase)
        }
    }
}

/// The name of a case with its variant.
pub(super) fn named(name: String, edits: &Edits) -> String {
    match &edits.variant {
        Some(variant) => format!("{name}:{variant}"),
        None => name,
    }
}

/// The problems of a case in the order of the file, each with its line.
pub(super) fn refused(
    document: &Document,
    mut problems: Vec<Problem>,
    edits: &Edits,
) -> Vec<Refused> {
    problems.sort_by_key(|problem| document.place(&problem.field));
    let placed =
        |problem: Problem| Refused { line: placed(document, problem.clone(), edits), problem };
    problems.into_iter().map(placed).collect()
}

/// Applies the variant and the settings to the case. Returns the problem of an invalid one.
pub(super) fn edit(document: &mut Document, edits: &Edits) -> Result<(), String> {
    if let Some(name) = &edits.variant {
        let found = document.case.variant(name).cloned();
        let variant = found.map_err(|problem| {
            let (file, Problem { cause, fix, .. }) = (document.name(), problem);
            format!("{file}, --variant {name}: {cause}: {fix}")
        })?;
        document.case = document.case.with(&variant);
    }
    let settings = &edits.settings;
    for (index, setting) in settings.iter().enumerate() {
        let is_partner = |other: &&Setting| Case::are_exclusive(&other.key, &setting.key);
        if let Some(other) = settings[..index].iter().find(is_partner) {
            let (written, key) = (setting.written(), &other.key);
            return Err(format!(
                "{written}: --set {key} excludes this field: remove one of the two --set options"
            ));
        }
        let set = document.case.set(&setting.key, &setting.value);
        set.map_err(|problem| on_command_line(setting, &problem))?;
    }
    Ok(())
}

fn unread(error: &ReadError, streams: &mut Streams) -> Exit {
    if let ReadError::Bad(faults) = error {
        for fault in faults {
            streams.say(&fault.to_string());
        }
        return Exit::BadCase;
    }
    streams.say(&error.to_string());
    match error {
        ReadError::NewerFormat(_) => Exit::NewerFormat,
        _ => Exit::Unreadable,
    }
}

/// A problem at its place: on the command line for a changed field, otherwise in the file; a
/// changed field may also contradict another field.
fn placed(document: &Document, problem: Problem, edits: &Edits) -> String {
    let settings = &edits.settings;
    if let Some(setting) = settings.iter().rev().find(|setting| setting.key == problem.field) {
        let worded = on_command_line(setting, &problem);
        return format!("{}, {worded}", document.name());
    }
    let variant = edits.variant.as_deref();
    // The key of the variant's override, if there is one.
    let own = variant.and_then(|name| document.case.variant(name).ok());
    let own = own.filter(|own| own.overrides(&problem.field));
    let field = own.map_or_else(|| problem.field.clone(), |own| own.place(&problem.field));
    let fault = document.fault(Problem { field, ..problem });
    let variant = variant.map(|name| format!("--variant {name}"));
    let written: Vec<String> =
        variant.into_iter().chain(settings.iter().map(Setting::written)).collect();
    if written.is_empty() {
        fault.to_string()
    } else {
        format!("{fault} (with {})", written.join(" "))
    }
}

fn on_command_line(setting: &Setting, problem: &Problem) -> String {
    format!("{}: {}: {}", setting.written(), problem.cause, problem.fix)
}
