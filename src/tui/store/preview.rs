//! Previews of files and folders: a case with its verdict, or its faults.

use std::path::{Path, PathBuf};

use super::{at_home, folder, load, without_name};
use crate::case::units::System;
use crate::case::{Document, Example};
use crate::report::digest::Digest;

/// Greatest number of shown faults; further faults are counted.
const MOST_FAULTS: usize = 20;

/// The target of a preview.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Viewport {
    /// A case file.
    File(PathBuf),
    /// A folder.
    Folder(PathBuf),
    /// An example.
    Example(&'static Example),
}

/// The preview of a file or a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Preview {
    /// A case, and whether it has a newer format.
    Case(Digest, bool),
    /// The required values that are missing from a case.
    Draft(Vec<String>),
    /// The first faults of a file, and the number of further ones.
    Faults(Vec<String>, usize),
    /// A folder, with its numbers of cases and folders.
    Folder(usize, usize),
}

/// Computes a preview; returns `None` if `go_on` returns false.
#[must_use]
pub(crate) fn of(sight: &Viewport, system: System, go_on: &dyn Fn(f64) -> bool) -> Option<Preview> {
    match sight {
        Viewport::File(path) => of_file(&at_home(path), system, go_on),
        Viewport::Folder(path) => Some(of_folder(&at_home(path))),
        Viewport::Example(example) => {
            of_document(&example.document(), Path::new(example.name), system, go_on)
        }
    }
}

fn of_folder(path: &Path) -> Preview {
    match folder::entries(path) {
        Ok(entries) => {
            let cases = entries.iter().filter(|entry| !entry.is_folder).count();
            Preview::Folder(cases, entries.len() - cases)
        }
        Err(reason) => Preview::Faults(vec![reason], 0),
    }
}

fn of_file(path: &Path, system: System, go_on: &dyn Fn(f64) -> bool) -> Option<Preview> {
    let document = match load(path) {
        Ok(document) => document,
        Err(faults) => return Some(first_of(faults)),
    };
    of_document(&document, path, system, go_on)
}

fn of_document(
    document: &Document,
    path: &Path,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Preview> {
    match document.case.inputs() {
        Ok(inputs) => {
            let digest = Digest::solve(&document.case, &inputs, system, go_on)?;
            Some(Preview::Case(digest, document.is_newer()))
        }
        Err(problems) if !document.is_newer() => {
            let fields = problems.iter().map(|problem| problem.for_form().field);
            Some(Preview::Draft(fields.collect()))
        }
        Err(problems) => {
            let faults = problems
                .into_iter()
                .map(|problem| without_name(path, &document.fault(problem).to_string()));
            Some(first_of(faults.collect()))
        }
    }
}

fn first_of(mut faults: Vec<String>) -> Preview {
    let more = faults.len().saturating_sub(MOST_FAULTS);
    faults.truncate(MOST_FAULTS);
    Preview::Faults(faults, more)
}
