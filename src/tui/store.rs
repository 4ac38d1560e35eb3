//! Files: reading and writing cases, looking into folders, and keeping what is typed.

pub mod autosave;
pub mod case_search;
mod clock;
pub mod folder;
pub mod journal_writer;
mod journals;
pub mod lock;
pub mod preview;
pub mod recents;
pub mod state;

use std::env;
use std::path::{Path, PathBuf};

use super::recovery;
use crate::case::Document;
use crate::case::changes::{self, Change};
use crate::case::file::{ReadError, SaveError};
use crate::case::sanitize::sanitize;

const ONLY_SPACING: &str = "Every field is the same: only comments or spacing differ.";

/// Why a case was not written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SaveFault {
    /// A file of that name is there: what it says otherwise than the form, a line each.
    Exists(Vec<String>),
    /// Someone else changed the file since it was read: what it says otherwise than the form, a
    /// line each.
    Changed(Vec<String>),
    /// Another session has the file open, which these words name.
    Held(String),
    /// The reason, in words.
    Failed(String),
}

/// A save that is asked for.
#[derive(Debug, Clone)]
pub struct Saving {
    /// The document, with the case as the form has it.
    pub document: Document,
    /// Where to.
    pub path: PathBuf,
    /// What may be written over.
    pub over: Over,
}

/// What a save may write over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Over {
    /// Nothing: a file of that name is not to be touched.
    Nothing,
    /// The file that was opened, as long as nobody else changed it.
    Own,
    /// Whatever is there.
    Anything,
}

/// What the workbench begins with.
#[derive(Debug)]
pub struct Opening {
    /// The document.
    pub document: Document,
    /// Where it was read from.
    pub path: Option<PathBuf>,
    /// What the user must be told about what was asked for.
    pub trouble: Option<Trouble>,
}

/// What could not be opened, and its faults.
#[derive(Debug)]
pub struct Trouble {
    /// The path.
    pub path: PathBuf,
    /// The faults, a line each.
    pub faults: Vec<String>,
    /// Whether the user asked for it, rather than it being the last one.
    pub was_asked: bool,
}

/// The document of the built-in case.
#[must_use]
pub fn built_in() -> Document {
    Document::table_1()
}

/// The case that was asked for, else the last one, else the built-in one.
#[must_use]
pub fn opening(asked: Option<PathBuf>) -> Opening {
    let was_asked = asked.is_some();
    let Some(path) = asked.or_else(recents::last) else {
        return Opening {
            document: built_in(),
            path: None,
            trouble: None,
        };
    };
    match load(&path) {
        Ok(document) => {
            recents::add(&path);
            Opening {
                document: *document,
                path: Some(path),
                trouble: None,
            }
        }
        Err(faults) => {
            let trouble = Trouble {
                path,
                faults,
                was_asked,
            };
            Opening {
                document: built_in(),
                path: None,
                trouble: Some(trouble),
            }
        }
    }
}

pub(super) fn load(path: &Path) -> Result<Box<Document>, Vec<String>> {
    // Standard input is the keyboard here: reading a case from it would wait for ever.
    if path == Path::new("-") {
        return Err(vec![
            "standard input is no case for the workbench: name a file, or use tipstrike solve -"
                .to_owned(),
        ]);
    }
    let document = match Document::read_draft(path) {
        Err(ReadError::NewerFormat(_)) => Document::read_newer(path),
        document => document,
    };
    let document = document.map_err(|error| error.to_string());
    document.map(Box::new).map_err(|faults| {
        faults
            .lines()
            .map(|fault| without_name(path, fault))
            .collect()
    })
}

// What shows the faults has the name in its title.
fn without_name(path: &Path, fault: &str) -> String {
    let name = format!("{}:", sanitize(&path.display().to_string()));
    fault
        .strip_prefix(&name)
        .unwrap_or(fault)
        .trim_start()
        .to_owned()
}

pub(super) fn save(saving: &Saving) -> Result<Box<Document>, SaveFault> {
    let Saving {
        document,
        path,
        over,
        ..
    } = saving;
    // What is no file is told as such, rather than asked about.
    if *over == Over::Nothing && path.symlink_metadata().is_ok() && !path.is_dir() {
        return Err(SaveFault::Exists(occupied(saving)));
    }
    let mut document = document.clone();
    let written = if *over == Over::Anything {
        document.save_over(path)
    } else {
        document.save(path)
    };
    written
        .map(|()| Box::new(document))
        .map_err(|error| match error {
            SaveError::ChangedOnDisk(_) => {
                SaveFault::Changed(differences(saving, ONLY_SPACING, |change| {
                    by_whom(saving, change)
                }))
            }
            SaveError::AlreadyThere(_) => SaveFault::Exists(occupied(saving)),
            other => SaveFault::Failed(other.to_string()),
        })
}

/// What the file says otherwise than the form, a line each, with a remark; the words for nothing.
fn differences(saving: &Saving, same: &str, remark: impl Fn(&Change) -> String) -> Vec<String> {
    let theirs = match Document::read_draft(&saving.path) {
        Ok(theirs) => theirs.case,
        Err(error) => {
            return error
                .to_string()
                .lines()
                .take(1)
                .map(|line| format!("It is no valid case: {line}"))
                .collect();
        }
    };
    let lines = changes::between(&theirs, &saving.document.case)
        .into_iter()
        .map(|change| {
            let (there, here) = (
                recovery::shown(change.from.as_deref()),
                recovery::shown(change.to.as_deref()),
            );
            format!(
                "{}: {there} in the file, {here} here{}",
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

fn occupied(saving: &Saving) -> Vec<String> {
    differences(saving, "Every field in it is as in the form.", |_| {
        String::new()
    })
}

// Who changed it, of a file that both began with.
fn by_whom(saving: &Saving, change: &Change) -> String {
    let before = changes::text_of(saving.document.loaded(), &change.key);
    let by = match (before == change.from, before == change.to) {
        (true, _) => "changed here",
        (_, true) => "changed there",
        (false, false) => "changed here and there",
    };
    format!(" ({by})")
}

/// The path of a save, with the home folder in place of `~`. The file that was opened is called
/// what it is called.
pub(super) fn expanded(saving: &Saving) -> PathBuf {
    if saving.over == Over::Own {
        saving.path.clone()
    } else {
        at_home(&saving.path)
    }
}

pub(super) fn at_home(path: &Path) -> PathBuf {
    let home = env::var_os("HOME")
        .map(PathBuf::from)
        .filter(|home| home.is_absolute());
    match (path.strip_prefix("~"), home) {
        (Ok(rest), Some(home)) => home.join(rest),
        _ => path.to_owned(),
    }
}
