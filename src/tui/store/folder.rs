//! What the file browser shows: the content of a folder, the cases found below it, and previews.

use std::collections::VecDeque;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::{at_home, load, without_name};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Document, Example, rexs};
use crate::report::digest::Digest;
use crate::report::solve;

/// Greatest number of listed entries.
const MOST: usize = 50_000;

/// Greatest depth of the search.
const DEEPEST: usize = 6;
/// Greatest number of entries to visit.
const MOST_ENTRIES: usize = 50_000;
/// Greatest number of cases to find.
const MOST_CASES: usize = 2_000;
/// Greatest duration of the search.
const LONGEST: Duration = Duration::from_secs(2);

/// Greatest number of shown faults; further faults are counted.
const MOST_FAULTS: usize = 20;

/// An entry of a folder.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// Folders sort after cases.
    pub(crate) is_folder: bool,
    /// Its name as text.
    pub(crate) name: String,
    /// The name in lower case.
    pub(crate) folded: String,
    /// Its name, which need not be valid text.
    pub(crate) file: OsString,
}

/// The content of a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// The folder of the browser, and the folders typed after it.
    pub asked: (PathBuf, String),
    /// The full path of the folder.
    pub(crate) folder: PathBuf,
    /// The entries, including hidden ones; or the error of reading.
    pub entries: Result<Vec<Entry>, String>,
    /// Whether the list is incomplete.
    pub(crate) is_cut: bool,
}

impl Entry {
    /// Whether a file with this name is a case, or a model that can be imported as a case.
    #[must_use]
    pub(crate) fn is_case(file: &Path) -> bool {
        let is_toml = |ending: &std::ffi::OsStr| ending.eq_ignore_ascii_case("toml");
        file.extension().is_some_and(is_toml) || rexs::is_model(file)
    }

    fn of(entry: &fs::DirEntry) -> Option<Entry> {
        let file = entry.file_name();
        let kind = entry.file_type().ok()?;
        // Only a link needs another system call.
        let is_folder = kind.is_dir() || kind.is_symlink() && entry.path().is_dir();
        let is_case = !is_folder && Entry::is_case(Path::new(&file));
        let name = sanitize(&file.to_string_lossy());
        (is_folder || is_case).then(|| Entry { is_folder, folded: name.to_lowercase(), name, file })
    }
}

/// A case in a folder below.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct FoundCase {
    /// Depth of its folder below the start.
    pub(crate) depth: usize,
    /// The relative path as text.
    pub name: String,
    /// The path in lower case.
    pub(crate) folded: String,
    pub(crate) way: PathBuf,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SearchResult {
    /// The folder of the browser, and the folders typed after it.
    pub asked: (PathBuf, String),
    /// The cases, the nearest first.
    pub cases: Vec<FoundCase>,
    /// Whether the search ended at a limit.
    pub is_cut: bool,
}

impl FoundCase {
    fn of(way: PathBuf, depth: usize) -> FoundCase {
        let name = sanitize(&way.to_string_lossy());
        FoundCase { depth, folded: name.to_lowercase(), name, way }
    }
}

impl SearchResult {
    /// The path of a case, relative to the browser.
    #[must_use]
    pub(crate) fn path(&self, case: &FoundCase) -> PathBuf {
        beneath(&self.asked.0, &self.asked.1).join(&case.way)
    }
}

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
pub(crate) enum Preview {
    /// A case, and whether it has a newer format.
    Case(Digest, bool),
    /// The required values that are missing from a case.
    Draft(Vec<String>),
    /// The first faults of a file, and the number of further ones.
    Faults(Vec<String>, usize),
    /// A folder, with its numbers of cases and folders.
    Folder(usize, usize),
}

/// Lists a folder.
#[must_use]
pub fn list(asked: (PathBuf, String), place: PathBuf) -> Listing {
    let folder = fs::canonicalize(&place).or_else(|_| std::path::absolute(&place)).unwrap_or(place);
    let found = entries(&folder);
    let is_cut = found.as_ref().is_ok_and(|entries| entries.len() >= MOST);
    Listing { asked, folder, entries: found, is_cut }
}

/// The typed folder; by default the present folder.
pub(crate) fn place_of(base: &Path, typed: &str) -> PathBuf {
    let place = at_home(&beneath(base, typed));
    if place.as_os_str().is_empty() { PathBuf::from(".") } else { place }
}

/// The path of a text typed into a browser of `base`; `~` and `/` make it absolute.
#[must_use]
pub fn beneath(base: &Path, typed: &str) -> PathBuf {
    if typed.starts_with('~') { PathBuf::from(typed) } else { base.join(typed) }
}

/// The folders and cases of a folder, sorted by name.
///
/// # Errors
/// The error of reading, as text.
pub(crate) fn entries(folder: &Path) -> Result<Vec<Entry>, String> {
    let found =
        fs::read_dir(folder).map_err(|error| format!("This folder cannot be read: {error}."))?;
    let mut entries: Vec<_> =
        found.flatten().filter_map(|entry| Entry::of(&entry)).take(MOST).collect();
    entries.sort();
    Ok(entries)
}

/// Searches for cases; returns `None` if `go_on` returns false. Skips hidden folders and does not
/// follow links.
#[must_use]
pub fn find(
    asked: (PathBuf, String),
    top: &Path,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<SearchResult> {
    let (began, mut entries) = (Instant::now(), 0);
    let (mut cases, mut is_cut) = (Vec::new(), false);
    let mut ahead = VecDeque::from([(PathBuf::new(), 0)]);
    while let Some((way, depth)) = ahead.pop_front() {
        if !go_on(0.0) {
            return None;
        }
        if entries >= MOST_ENTRIES || cases.len() >= MOST_CASES || began.elapsed() > LONGEST {
            is_cut = true;
            break;
        }
        for entry in look(&top.join(&way)).take(MOST_ENTRIES - entries) {
            entries += 1;
            let way = way.join(entry.file_name());
            match kind_of(&entry) {
                EntryKind::Folder if depth < DEEPEST => ahead.push_back((way, depth + 1)),
                EntryKind::Case if depth > 0 => cases.push(FoundCase::of(way, depth)),
                EntryKind::Folder => is_cut = true,
                EntryKind::Case | EntryKind::Other => (),
            }
        }
    }
    cases.sort();
    cases.truncate(MOST_CASES);
    Some(SearchResult { asked, cases, is_cut })
}

/// Computes a preview; returns `None` if `go_on` returns false.
#[must_use]
pub(crate) fn preview(
    sight: &Viewport,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Preview> {
    match sight {
        Viewport::File(path) => of_file(&at_home(path), system, go_on),
        Viewport::Folder(path) => Some(of_folder(&at_home(path))),
        Viewport::Example(example) => {
            of_document(&example.document(), Path::new(example.name), system, go_on)
        }
    }
}

enum EntryKind {
    Folder,
    Case,
    Other,
}

fn look(folder: &Path) -> impl Iterator<Item = fs::DirEntry> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}

fn kind_of(entry: &fs::DirEntry) -> EntryKind {
    let is_hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
    match entry.file_type() {
        Ok(kind) if kind.is_dir() && !is_hidden => EntryKind::Folder,
        Ok(kind)
            if kind.is_file() && !is_hidden && Entry::is_case(Path::new(&entry.file_name())) =>
        {
            EntryKind::Case
        }
        _ => EntryKind::Other,
    }
}

fn of_folder(path: &Path) -> Preview {
    match entries(path) {
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
            let digest = solve::digest(&document.case, &inputs, system, go_on)?;
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
