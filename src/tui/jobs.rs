//! Jobs that must not delay the screen: reading folders and files, explaining a result.

use std::path::PathBuf;

use super::store::preview::Viewport;
use crate::case::Case;
use crate::case::units::System;
use crate::model::{Inputs, Quantity};
use crate::report::explain::Page;

/// A job. Its result is an action.
#[derive(Debug, Clone)]
pub enum Job {
    /// What stands in a folder: where the browser is, and the folders typed after it.
    Folder(PathBuf, String),
    /// Which cases stand below a folder.
    Below(PathBuf, String),
    /// What a file or a folder holds.
    Preview(Viewport, System),
    /// Which cases were open last.
    Recents,
    /// What the examples are.
    Examples(System),
    /// Where a result comes from.
    Explain(Box<Asked>),
}

/// A result to be explained.
#[derive(Debug, Clone)]
pub struct Asked {
    /// The result.
    pub quantity: &'static Quantity,
    pub case: Case,
    /// The pair that it describes.
    pub inputs: Inputs,
}

/// The explanation of a result, or why there is none.
#[derive(Debug, Clone)]
pub struct Explained {
    /// The result.
    pub quantity: &'static Quantity,
    pub page: Result<Box<Page>, String>,
}

impl Job {
    /// How many kinds there are.
    pub(super) const KINDS: usize = 6;

    /// The kind and its name. Of a kind the latest job replaces the others.
    pub(super) const fn kind(&self) -> (usize, &'static str) {
        match self {
            Job::Folder(..) => (0, "folders"),
            Job::Preview(..) => (1, "previews"),
            Job::Recents => (2, "recents"),
            Job::Examples(_) => (3, "examples"),
            Job::Explain(_) => (4, "explain"),
            Job::Below(..) => (5, "search"),
        }
    }
}
