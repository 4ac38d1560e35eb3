//! Saving a case, and the difference between its file and the form.

use std::path::PathBuf;

use super::recovery;
use crate::case::Document;
use crate::case::changes::{self, Change};
use crate::case::file::{ReadError, SaveError, Saved};
use crate::tui::store::at_home;

/// The step after a save or after discarding edits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// Continue with this case.
    Stay,
    /// Quit the workbench.
    Quit,
    /// Save the remaining cases, then quit the workbench.
    SaveRest,
    /// Close this case.
    Close,
    /// Open this file instead of the case.
    Load(PathBuf),
}

const ONLY_SPACING: &str = "Every field is the same: only comments or spacing differ.";
const ALL_THE_SAME: &str = "The file and the form have the same values.";

/// A case that was written.
#[derive(Debug, Clone)]
pub struct Written {
    /// The document with its present text in the file.
    pub document: Document,
    /// The result of the write.
    pub(crate) saved: Saved,
}

/// Why a case was not written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SaveFault {
    /// A file with this name exists; its differences from the form, one line per field.
    Exists(Vec<String>),
    /// Another program has changed the file since it was read; its differences from the form, one
    /// line per field.
    Changed(Vec<String>),
    /// Another session has the file open: its process, machine and age.
    Held(String),
    /// Another reason, as text.
    Failed(String),
}

/// A requested save.
#[derive(Debug, Clone)]
pub struct Saving {
    /// The document with the case of the form.
    pub(crate) document: Document,
    /// The file to write.
    pub path: PathBuf,
    /// The content of the file that the save may overwrite.
    pub(crate) over: Over,
}

/// The content of a file that a save may overwrite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Over {
    /// Nothing: an existing file is not overwritten.
    Nothing,
    /// The content that was read, if no other program has changed it.
    Own,
    /// Any content.
    Anything,
}

impl Saving {
    /// Replaces `~` by the home folder, except in the path of the open file.
    pub(super) fn expand(&mut self) {
        if self.over != Over::Own {
            self.path = at_home(&self.path);
        }
    }

    /// Writes the case. The caller must have the lock.
    pub(super) fn write(&self) -> Result<Box<Written>, SaveFault> {
        let path = &self.path;
        // The write refuses a pipe or a device without a question.
        if self.over == Over::Nothing && path.symlink_metadata().is_ok() && !path.is_dir() {
            return Err(SaveFault::Exists(self.occupied()));
        }
        let mut document = self.document.clone();
        let result = if self.over == Over::Anything {
            document.save_over(path)
        } else {
            document.save(path)
        };
        match result {
            Ok(saved) => Ok(Box::new(Written { document, saved })),
            Err(SaveError::ChangedOnDisk(_)) => {
                let lines = self.differences(ONLY_SPACING, |change| self.by_whom(change));
                Err(SaveFault::Changed(lines))
            }
            Err(SaveError::AlreadyThere(_)) => Err(SaveFault::Exists(self.occupied())),
            Err(other) => Err(SaveFault::Failed(other.to_string())),
        }
    }

    /// The differences of the file from the form: one line per field with a remark, or `same`.
    fn differences(&self, same: &str, remark: impl Fn(&Change) -> String) -> Vec<String> {
        let theirs = match Document::read_draft(&self.path) {
            Ok(theirs) => theirs.case,
            Err(error) => {
                let is_case = !matches!(error, ReadError::Bad(_) | ReadError::NewerFormat(_));
                let error = error.to_string();
                let first = error.lines().next().unwrap_or_default();
                let cause = if is_case {
                    ""
                } else {
                    "It is not a valid case: "
                };
                return vec![format!("{cause}{first}")];
            }
        };
        let lines = changes::between(&theirs, &self.document.case)
            .into_iter()
            .map(|change| {
                let (there, here) = (
                    recovery::shown(change.from.as_deref()),
                    recovery::shown(change.to.as_deref()),
                );
                format!(
                    "{}: {there} in the file, {here} in the form{}",
                    changes::label(&change.key),
                    remark(&change)
                )
            });
        let lines: Vec<_> = lines.collect();
        if lines.is_empty() {
            vec![same.to_owned()]
        } else {
            lines
        }
    }

    fn occupied(&self) -> Vec<String> {
        self.differences(ALL_THE_SAME, |_| String::new())
    }

    /// Where the field was changed since the document was read.
    fn by_whom(&self, change: &Change) -> String {
        let before = changes::text_of(self.document.loaded(), &change.key);
        let by = match (before == change.from, before == change.to) {
            (true, _) => "changed in the form",
            (_, true) => "changed in the file",
            (false, false) => "changed in both",
        };
        format!(" ({by})")
    }
}
