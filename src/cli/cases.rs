//! Cases opened for a command, with what is wrong with them said.

use super::{Exit, Setting, Streams};
use crate::case::file::ReadError;
use crate::case::{Document, Problem};
use crate::model::{Inputs, Refusal};
use std::path::Path;

/// A case that can be solved.
pub(super) struct Opened {
    /// As the user named it.
    pub(super) name: String,
    pub(super) document: Document,
    pub(super) inputs: Inputs,
}

impl Opened {
    /// Say why the model refuses the case, at the field where the mend begins.
    pub(super) fn refused(&self, refusal: &Refusal, streams: &mut Streams) -> Exit {
        let (field, cause, mend) = (refusal.field().to_owned(), refusal.to_string(), refusal.mend().to_owned());
        streams.say(&self.document.fault(Problem { field, cause, mend }).to_string());
        Exit::BadCase
    }
}

/// Read a case and change what the settings name.
pub(super) fn open(path: &Path, settings: &[Setting], streams: &mut Streams) -> Result<Opened, Exit> {
    let document = Document::read(path).map_err(|error| unread(&error, streams))?;
    changed(path.display().to_string(), document, settings, streams)
}

/// A document as it is once the settings have changed what they name.
pub(super) fn changed(name: String, mut document: Document, settings: &[Setting], streams: &mut Streams) -> Result<Opened, Exit> {
    for Setting { key, value } in settings {
        document.case.set(key, value).map_err(|problem| {
            streams.say(&format!("--set: {problem}"));
            Exit::Usage
        })?;
    }
    match document.case.inputs() {
        // Nothing waits for a report, so it is given the digits.
        Ok(inputs) => Ok(Opened { name, document, inputs }),
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

/// What the settings put out of order; a field that was set is wrong on the command line and not in the file.
fn unfit(document: &Document, problems: Vec<Problem>, settings: &[Setting], streams: &mut Streams) -> Exit {
    for problem in problems {
        let set = settings.iter().any(|setting| setting.key == problem.field);
        let message = if set { format!("--set: {problem}") } else { document.fault(problem).to_string() };
        streams.say(&message);
    }
    Exit::BadCase
}
