//! Saving a case, the difference between its file and the form, and the result of opening a case:
//! whether another session has it open, and unsaved edits of an ended session.

use std::path::{Path, PathBuf};

use crate::case::changes::{self, Change};
use crate::case::file::{MOST_BYTES, ReadError, SaveError, Saved, followed, read_bytes};
use crate::case::stamp::Stamp;
use crate::case::{Case, Document};

const ONLY_SPACING: &str = "Every field is the same: only comments or spacing differ.";
const ALL_THE_SAME: &str = "The file and the form have the same values.";

/// The message for a case of a newer format.
pub(crate) const NEWER: &str =
    "read-only: newer format; fields that this version does not know are hidden";

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
    /// A file with this name exists.
    Exists(Found),
    /// Another program has changed the file since it was read.
    Changed(Found),
    /// Another session has the file open: its process, machine and age.
    Held(String),
    /// Another reason, as text.
    Failed(String),
}

/// The content of a file that a save would overwrite.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// The stamp of the content; `None` if the file cannot be read.
    pub stamp: Option<Stamp>,
    /// The differences from the form, one line per field.
    pub lines: Vec<String>,
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
    /// The content that the user saw, which has this stamp if it can be read.
    Seen(Option<Stamp>),
}

impl Saving {
    /// Writes the case. The caller must have the lock.
    pub(super) fn write(&self) -> Result<Box<Written>, SaveFault> {
        let path = &self.path;
        let is_there = path.symlink_metadata().is_ok() && !path.is_dir();
        let mut document = self.document.clone();
        let result = match self.over {
            // The write refuses a pipe or a device without a question.
            Over::Nothing if is_there => return Err(self.conflict(false)),
            Over::Seen(seen) if is_there && stamp_of(path) != seen => {
                return Err(self.conflict(document.path() == followed(path).ok().as_deref()));
            }
            Over::Seen(_) => document.save_over(path),
            Over::Nothing | Over::Own => document.save(path),
        };
        match result {
            Ok(saved) => Ok(Box::new(Written { document, saved })),
            Err(SaveError::ChangedOnDisk(_)) => Err(self.conflict(true)),
            Err(SaveError::AlreadyThere(_)) => Err(self.conflict(false)),
            Err(other) => Err(SaveFault::Failed(other.to_string())),
        }
    }

    /// Why the file is not overwritten: its own file was changed, or another file exists; with one
    /// line per field that differs from the form.
    fn conflict(&self, is_own: bool) -> SaveFault {
        // The stamp first: a change before the next line then asks again.
        let stamp = stamp_of(&self.path);
        let mut lines = match Document::read_draft(&self.path) {
            Ok(theirs) => {
                let line = |change: Change| {
                    let (there, here) =
                        (shown(change.from.as_deref()), shown(change.to.as_deref()));
                    let before = changes::text_of(self.document.loaded(), &change.key);
                    let by = match (before == change.from, before == change.to) {
                        _ if !is_own => "",
                        (true, _) => " (changed in the form)",
                        (_, true) => " (changed in the file)",
                        (false, false) => " (changed in both)",
                    };
                    let label = changes::label(&change.key);
                    format!("{label}: {there} in the file, {here} in the form{by}")
                };
                changes::between(&theirs.case, &self.document.case).into_iter().map(line).collect()
            }
            Err(error) => {
                let is_case = !matches!(error, ReadError::Bad(_) | ReadError::NewerFormat(_));
                let error = error.to_string();
                let first = error.lines().next().unwrap_or_default();
                let cause = if is_case { "" } else { "It is not a valid case: " };
                vec![format!("{cause}{first}")]
            }
        };
        if lines.is_empty() {
            lines.push(if is_own { ONLY_SPACING } else { ALL_THE_SAME }.to_owned());
        }
        let found = Found { stamp, lines };
        if is_own { SaveFault::Changed(found) } else { SaveFault::Exists(found) }
    }
}

/// Whether this session may write the file of a case.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Access {
    /// The session may write the file.
    #[default]
    Own,
    /// Another session has the file open: its process, machine and age.
    Held(String),
    /// The case has a newer format that this version does not fully know.
    Newer,
}

/// An open case and its form.
#[derive(Debug, Clone, Copy)]
pub struct OpenCase<'a> {
    /// Unique among open cases.
    pub(crate) id: usize,
    /// Its file.
    pub(crate) path: Option<&'a Path>,
    /// The text of the file.
    pub(crate) document: &'a Document,
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// Whether the header marks it as open elsewhere.
    pub(crate) is_held: bool,
}

/// The result of opening a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// The id of the open case.
    pub id: usize,
    /// Whether its file may be written.
    pub access: Access,
    /// Unsaved edits of earlier sessions, the latest first.
    pub offers: Vec<Offer>,
    /// Messages for the user, one sentence each.
    pub notices: Vec<String>,
}

/// Unsaved edits of an earlier session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offer {
    /// The journal of the edits.
    pub journal: PathBuf,
    /// Age of the journal as text.
    pub age: String,
    /// The edits, each from the present value in the file to the typed text.
    pub changes: Vec<Change>,
    /// Whether the file has changed since the edits.
    pub is_file_changed: bool,
}

impl Claim {
    /// A claim without offers and notices.
    pub fn of(id: usize, access: Access) -> Claim {
        Claim { id, access, offers: Vec::new(), notices: Vec::new() }
    }

    /// Whether the claim has no message for the user.
    pub(crate) fn is_silent(&self) -> bool {
        self.access == Access::Own && self.offers.is_empty() && self.notices.is_empty()
    }
}

impl Access {
    /// The initial access to a document.
    pub(crate) fn of(document: &Document) -> Access {
        if document.is_newer() { Access::Newer } else { Access::Own }
    }

    /// The mark beside the name of the case.
    pub(crate) fn mark(&self) -> &'static str {
        match self {
            Access::Own => "",
            Access::Held(_) | Access::Newer => " *read-only*",
        }
    }
}

/// A change on one line: the present value and the new one.
pub(crate) fn line(change: &Change) -> String {
    format!(
        "{}: {} -> {}",
        changes::label(&change.key),
        shown(change.from.as_deref()),
        shown(change.to.as_deref())
    )
}

/// The first changes on one line, and the number of the others.
pub(crate) fn summary(changes: &[Change]) -> String {
    const MOST: usize = 3;
    let first: Vec<_> = changes.iter().take(MOST).map(line).collect();
    let more = changes.len().saturating_sub(MOST);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    if first.is_empty() { "no value changes".to_owned() } else { first.join("; ") + &more }
}

/// A text cut to one short line; `(empty)` without a text.
pub(crate) fn shown(text: Option<&str>) -> String {
    const MOST: usize = 40;
    match text {
        None => "(empty)".to_owned(),
        Some(text) if text.chars().count() > MOST => {
            text.chars().take(MOST - 1).chain(['…']).collect()
        }
        Some(text) => text.to_owned(),
    }
}

fn stamp_of(path: &Path) -> Option<Stamp> {
    read_bytes(path, MOST_BYTES).ok().map(|bytes| Stamp::of(&bytes))
}
