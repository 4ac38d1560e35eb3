//! The result of opening a case: whether another session has it open, and unsaved edits of an
//! earlier session.

use std::path::{Path, PathBuf};

use crate::case::changes::{self, Change};
use crate::case::{Case, Document};

/// The message for a case of a newer format.
pub(crate) const NEWER: &str =
    "read-only: newer format; fields that this version does not know are hidden";

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
    #[must_use]
    pub fn of(id: usize, access: Access) -> Claim {
        Claim { id, access, offers: Vec::new(), notices: Vec::new() }
    }

    /// Whether the claim has no message for the user.
    #[must_use]
    pub(crate) fn is_silent(&self) -> bool {
        self.access == Access::Own && self.offers.is_empty() && self.notices.is_empty()
    }
}

impl Access {
    /// The initial access to a document.
    #[must_use]
    pub(crate) fn of(document: &Document) -> Access {
        if document.is_newer() { Access::Newer } else { Access::Own }
    }

    /// The mark beside the name of the case.
    #[must_use]
    pub(crate) fn mark(&self) -> &'static str {
        match self {
            Access::Own => "",
            Access::Held(_) | Access::Newer => " *read-only*",
        }
    }
}

/// A change on one line: the present value and the new one.
#[must_use]
pub(crate) fn line(change: &Change) -> String {
    format!(
        "{}: {} -> {}",
        changes::label(&change.key),
        shown(change.from.as_deref()),
        shown(change.to.as_deref())
    )
}

/// The first changes on one line, and the number of the others.
#[must_use]
pub(crate) fn summary(changes: &[Change]) -> String {
    const MOST: usize = 3;
    let first: Vec<_> = changes.iter().take(MOST).map(line).collect();
    let more = changes.len().saturating_sub(MOST);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    if first.is_empty() { "no value changes".to_owned() } else { first.join("; ") + &more }
}

/// A text cut to one short line; `(empty)` without a text.
#[must_use]
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
