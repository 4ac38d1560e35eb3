//! What keeps typed values safe, as the state sees it: who else has the case open, and edits that
//! were kept for it.

use std::path::{Path, PathBuf};

use crate::case::changes::{self, Change};
use crate::case::{Case, Document};

/// What there is to say of a case of a newer format.
pub const NEWER: &str = "read-only: of a newer format; only what this version knows is shown";

/// Whether this workbench may write the file of a case.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Access {
    /// It may.
    #[default]
    Own,
    /// Another session has it open, which these words name.
    Held(String),
    /// It is of a newer format, of which not everything is understood.
    Newer,
}

/// A case that is open, and what the form makes of it.
#[derive(Debug, Clone, Copy)]
pub struct OpenCase<'a> {
    /// Tells it from other open ones.
    pub id: usize,
    /// Its file.
    pub path: Option<&'a Path>,
    /// The text of the file.
    pub document: &'a Document,
    /// What the form says.
    pub case: &'a Case,
    /// Whether it is shown as open elsewhere.
    pub is_held: bool,
}

/// What was found out when a case was opened.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// Which of the open ones.
    pub id: usize,
    /// Whether its file may be written.
    pub access: Access,
    /// Edits that were kept for it, the latest first.
    pub offers: Vec<Offer>,
    /// What else there is to say, a line each.
    pub notices: Vec<String>,
}

/// Edits that an earlier session could not save.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offer {
    /// The journal that holds them.
    pub journal: PathBuf,
    /// How long ago they were kept, in words.
    pub age: String,
    /// From what the file says now to what was typed.
    pub changes: Vec<Change>,
    /// Whether the file was changed since they were typed.
    pub is_file_changed: bool,
}

impl Claim {
    /// A claim with nothing to tell but the access.
    #[must_use]
    pub fn of(id: usize, access: Access) -> Claim {
        Claim {
            id,
            access,
            offers: Vec::new(),
            notices: Vec::new(),
        }
    }

    /// Whether there is nothing in it to tell.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        self.access == Access::Own && self.offers.is_empty() && self.notices.is_empty()
    }
}

impl Access {
    /// How a document is open at first.
    #[must_use]
    pub fn of(document: &Document) -> Access {
        if document.is_newer() {
            Access::Newer
        } else {
            Access::Own
        }
    }

    /// The mark beside the name of the case.
    #[must_use]
    pub fn mark(&self) -> &'static str {
        match self {
            Access::Own => "",
            Access::Held(_) | Access::Newer => " *read-only*",
        }
    }
}

/// A change in a line: what stands there now, and what would.
#[must_use]
pub fn line(change: &Change) -> String {
    format!(
        "{}: {} -> {}",
        changes::label(&change.key),
        shown(change.from.as_deref()),
        shown(change.to.as_deref())
    )
}

/// Changes in a sentence: the first ones, and how many more there are.
#[must_use]
pub fn told(changes: &[Change]) -> String {
    const MOST: usize = 3;
    let first: Vec<_> = changes.iter().take(MOST).map(line).collect();
    let more = changes.len().saturating_sub(MOST);
    let more = if more > 0 {
        format!("; and {more} more")
    } else {
        String::new()
    };
    if first.is_empty() {
        "nothing that is written".to_owned()
    } else {
        first.join("; ") + &more
    }
}

/// A text in a line, short, and the words for none.
#[must_use]
pub fn shown(text: Option<&str>) -> String {
    const MOST: usize = 40;
    match text {
        None => "(empty)".to_owned(),
        Some(text) if text.chars().count() > MOST => {
            text.chars().take(MOST - 1).chain(['…']).collect()
        }
        Some(text) => text.to_owned(),
    }
}
