//! Opens cases for a command and places their problems.

use super::Streams;
use super::options::{CaseFile, Edits, Setting};
use super::output::{Done, Exit, Failure};
use crate::case::fields::FIELDS;
use crate::case::file::{MOST_MODEL_BYTES, ReadError, read_bytes};
use crate::case::rexs::{self, Imported};
use crate::case::{Acting, Case, Document, Problem, partial_relevance, relevance};
use crate::model::{Inputs, Quantity, Refusal};
use crate::report::results::Named;
use crate::report::solve::Unsolved;
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

    /// The case by its name and title.
    pub(super) fn named(&self) -> Named<'_> {
        Named { name: &self.name, title: self.document.case.title() }
    }

    /// The case, to solve for a report or a picture.
    pub(super) fn unsolved(&self) -> Unsolved<'_> {
        Unsolved { name: &self.name, case: &self.document.case, inputs: &self.inputs }
    }

    /// A refusal of the model at the field that its fix names first.
    pub(super) fn refused(&self, refusal: &Refusal) -> Failure {
        self.faulty(Problem::from(refusal).at_given(&self.document.case))
    }

    /// Why a study of the case has no result.
    pub(super) fn failed(&self, reason: &impl std::fmt::Display) -> Failure {
        Failure::new(Exit::BadCase, format!("{}: {reason}", self.name))
    }

    /// A problem of the case at its place.
    pub(super) fn faulty(&self, problem: Problem) -> Failure {
        Failure::new(Exit::BadCase, placed(&self.document, problem, &self.edits))
    }
}

impl CaseFile {
    /// Opens the case. `varied` has the index of each field that a study varies, with one of its
    /// values.
    pub(super) fn open(
        &self,
        varied: &[(usize, String)],
        streams: &mut Streams,
    ) -> Result<Opened, Failure> {
        open(&self.case, &self.changes.edits(), varied, streams)
    }
}

/// Runs a command on each case and reports its failures. The exit code is the greatest of all.
pub(super) fn each(
    paths: &[PathBuf],
    streams: &mut Streams,
    mut run: impl FnMut(&Path, &mut Streams) -> Done,
) -> Done {
    paths.iter().try_fold(Exit::Done, |worst, path| match run(path, streams) {
        Ok(exit) => Ok(worst.max(exit)),
        Err(Failure::Reported(exit, lines)) => {
            streams.say_all(&lines);
            Ok(worst.max(exit))
        }
        Err(failure) => Err(failure),
    })
}

/// Reads a case and applies the changes of the command line. `varied` has the index of each field
/// that a study varies, with one of its values for a case that lacks them.
pub(super) fn open(
    path: &Path,
    edits: &Edits,
    varied: &[(usize, String)],
    streams: &mut Streams,
) -> Result<Opened, Failure> {
    for (field, _) in varied {
        keep_varied(&edits.settings, FIELDS[*field].key)?;
    }
    let mut document = read(path, streams)?;
    for (field, value) in varied {
        if document.case.effective(*field).is_none() {
            // An invalid value is reported later with its point.
            drop(document.case.set(FIELDS[*field].key, value));
        }
    }
    changed(path.display().to_string(), document, edits)
}

/// Refuses to set a field that a study varies.
fn keep_varied(settings: &[Setting], key: &str) -> Result<(), Failure> {
    let is_varied =
        |setting: &&Setting| key == setting.key || Case::are_exclusive(key, &setting.key);
    let Some(setting) = settings.iter().find(is_varied) else { return Ok(()) };
    let written = setting.written();
    Err(Failure::usage(format!("{written}: --vary replaces this value: leave one of them out")))
}

/// Reads a case that may lack values, or the only spur stage of a model.
pub(super) fn read(path: &Path, streams: &mut Streams) -> Result<Document, Failure> {
    if rexs::is_model(path) {
        return Ok(read_model(path, None, streams)?.document);
    }
    Ok(Document::read_draft(path)?)
}

/// Reads a stage of a model, and reports the stages and the empty fields.
pub(super) fn read_model(
    path: &Path,
    stage: Option<&str>,
    streams: &mut Streams,
) -> Result<Imported, Failure> {
    let bytes = read_bytes(path, MOST_MODEL_BYTES)?;
    let imported = rexs::import(path, &bytes, stage)
        .map_err(|refusal| Failure::new(Exit::BadCase, refusal))?;
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
) -> Result<Opened, Failure> {
    edit(&mut document, edits)?;
    match document.case.inputs() {
        Ok(inputs) => {
            Ok(Opened { name: named(name, edits), document, inputs, edits: edits.clone() })
        }
        Err(mut problems) => {
            problems.sort_by_key(|problem| document.place(&problem.field));
            let lines = problems.into_iter().map(|problem| placed(&document, problem, edits));
            Err(Failure::Reported(Exit::BadCase, lines.collect()))
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

/// Applies the variant and the settings to the case.
pub(super) fn edit(document: &mut Document, edits: &Edits) -> Result<(), Failure> {
    if let Some(name) = &edits.variant {
        let variant = document.case.variant(name).cloned().map_err(|problem| {
            let option = format!("{}, --variant", document.name());
            Failure::of_option(&option, name, &problem)
        })?;
        document.case = document.case.with(&variant);
    }
    let settings = &edits.settings;
    for (index, setting) in settings.iter().enumerate() {
        let is_partner = |other: &&Setting| Case::are_exclusive(&other.key, &setting.key);
        if let Some(other) = settings[..index].iter().find(is_partner) {
            let (written, key) = (setting.written(), &other.key);
            return Err(Failure::usage(format!(
                "{written}: --set {key} excludes this field: remove one of the two --set options"
            )));
        }
        let set = document.case.set(&setting.key, &setting.value);
        set.map_err(|problem| Failure::usage(on_command_line(setting, &problem)))?;
    }
    Ok(())
}

/// A problem at its place: on the command line for a changed field, otherwise in the file; a
/// changed field may also contradict another field.
pub(super) fn placed(document: &Document, problem: Problem, edits: &Edits) -> String {
    let settings = &edits.settings;
    if let Some(setting) = settings.iter().rev().find(|setting| setting.key == problem.field) {
        return format!("{}, {}", document.name(), on_command_line(setting, &problem));
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

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Failure {
        match error {
            ReadError::Bad(faults) => {
                Failure::Reported(Exit::BadCase, faults.iter().map(ToString::to_string).collect())
            }
            ReadError::NewerFormat(_) => Failure::new(Exit::NewerFormat, error),
            _ => Failure::new(Exit::Unreadable, error),
        }
    }
}
